//! Whether a simplified mesh is as sound as the one it was made from: the checker behind the tests of
//! every engine and the command line's `--verify`.

use super::statistics::{Flaws, first_duplicate, has_zero_area};
use super::topology::{Edge, Topology, first_non_manifold_vertex, is_face, visit_edges};
use super::{Mesh, Rings};

/// What is wrong with an output. Each names one place in it; counts are of the whole output and of the
/// whole input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// A vertex that no triangle uses.
    #[error("no triangle uses vertex {vertex}")]
    UnreferencedVertex {
        /// The first of them.
        vertex: usize,
    },
    /// More triangles that name a vertex twice.
    #[error("triangle {triangle} names a vertex twice: {output} do, {input} in the input")]
    DegenerateTriangles {
        /// The first of them.
        triangle: usize,
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// More triangles of zero area.
    #[error("triangle {triangle} has no area: {output} have none, {input} in the input")]
    ZeroAreaTriangles {
        /// The first of them.
        triangle: usize,
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// More triangles on the vertices of another.
    #[error("triangle {triangle} is there already: {output} duplicates, {input} in the input")]
    DuplicateTriangles {
        /// The first of them.
        triangle: usize,
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// More edges with more than two faces.
    #[error(
        "the edge from vertex {} to {} has more than two faces: {output} edges have, {input} in the input",
        vertices[0], vertices[1]
    )]
    NonManifoldEdges {
        /// The ends of the first of them.
        vertices: [u32; 2],
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// More edges whose two faces disagree in orientation.
    #[error(
        "the faces at the edge from vertex {} to {} disagree in orientation: \
         at {output} edges they do, at {input} in the input",
        vertices[0], vertices[1]
    )]
    InconsistentEdges {
        /// The ends of the first of them.
        vertices: [u32; 2],
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// More vertices whose faces form several fans.
    #[error(
        "the faces at vertex {vertex} form several fans: at {output} vertices they do, at {input} in the input"
    )]
    NonManifoldVertices {
        /// The first of them.
        vertex: u32,
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// Another number of pieces.
    #[error("there are {output} components, {input} in the input")]
    Components {
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// Another number of boundary loops.
    #[error("there are {output} boundary loops, {input} in the input")]
    BoundaryLoops {
        /// How many the output has.
        output: usize,
        /// How many the input has.
        input: usize,
    },
    /// Another Euler characteristic: with components and loops kept, another number of handles.
    #[error("the Euler characteristic is {output}, {input} in the input")]
    EulerCharacteristic {
        /// That of the output.
        output: i64,
        /// That of the input.
        input: i64,
    },
}

/// Checks that `output`, a simplification of `input`, has
///
/// - no vertex that no triangle uses,
/// - no more degenerate, zero-area and duplicate triangles than the input,
/// - no more non-manifold edges, non-manifold vertices and inconsistent edges than the input (where a
///   non-manifold edge has lost a face, an inconsistent one may have taken its place),
/// - and, if `topology_kept` and the input is clean, the input's number of components, its number of
///   boundary loops and its Euler characteristic.
///
/// An input is clean if it is an oriented manifold without degenerate and duplicate triangles (it may
/// well have unused vertices and triangles of zero area). Of any other input nothing can be said:
/// a legal collapse may merge two non-manifold features into one. That indices are in range and
/// positions finite is true of every [`Mesh`].
///
/// Returns the first violation, in the order above. Takes the time and memory of two
/// [`Mesh::topology`].
pub fn verify(input: &Mesh, output: &Mesh, topology_kept: bool) -> Result<(), Violation> {
    let rings = Rings::new(output);
    if let Some(vertex) = (0..rings.vertices()).find(|&vertex| rings.corners(vertex).is_empty()) {
        return Err(Violation::UnreferencedVertex { vertex });
    }
    let had = Findings::new(input, &Rings::new(input));
    let has = Findings::new(output, &rings);
    verify_flaws(output, had.flaws, has.flaws)?;
    verify_manifold(output, &rings, had.topology, has.topology)?;
    if topology_kept && had.is_clean() { verify_topology(had.topology, has.topology) } else { Ok(()) }
}

struct Findings {
    flaws: Flaws,
    topology: Topology,
}

impl Findings {
    fn new(mesh: &Mesh, rings: &Rings) -> Self {
        Self { flaws: Flaws::new(mesh, rings), topology: Topology::new(mesh, rings) }
    }

    fn is_clean(&self) -> bool {
        self.topology.is_oriented_manifold()
            && self.flaws.degenerate_triangles == 0
            && self.flaws.duplicate_triangles == 0
    }
}

fn verify_flaws(mesh: &Mesh, had: Flaws, has: Flaws) -> Result<(), Violation> {
    let first = |is_bad: &dyn Fn(&[u32; 3]) -> bool| mesh.triangles().iter().position(is_bad);
    let (output, input) = (has.degenerate_triangles, had.degenerate_triangles);
    if output > input
        && let Some(triangle) = first(&|triangle| !is_face(triangle))
    {
        return Err(Violation::DegenerateTriangles { triangle, output, input });
    }
    let (output, input) = (has.zero_area_triangles, had.zero_area_triangles);
    if output > input
        && let Some(triangle) = first(&|triangle| has_zero_area(mesh, triangle))
    {
        return Err(Violation::ZeroAreaTriangles { triangle, output, input });
    }
    let (output, input) = (has.duplicate_triangles, had.duplicate_triangles);
    if output > input
        && let Some(triangle) = first_duplicate(mesh)
    {
        return Err(Violation::DuplicateTriangles { triangle, output, input });
    }
    Ok(())
}

fn verify_manifold(mesh: &Mesh, rings: &Rings, had: Topology, has: Topology) -> Result<(), Violation> {
    let (output, input) = (has.non_manifold_edges, had.non_manifold_edges);
    if output > input
        && let Some(vertices) = first_edge(mesh, rings, |edge| edge.is_non_manifold())
    {
        return Err(Violation::NonManifoldEdges { vertices, output, input });
    }
    let (output, input) = (has.non_manifold_vertices, had.non_manifold_vertices);
    if output > input
        && let Some(vertex) = first_non_manifold_vertex(mesh, rings)
    {
        return Err(Violation::NonManifoldVertices { vertex, output, input });
    }
    let (output, input) = (has.inconsistent_edges, had.inconsistent_edges);
    let vanished = had.non_manifold_edges.saturating_sub(has.non_manifold_edges);
    if output > input + vanished
        && let Some(vertices) = first_edge(mesh, rings, |edge| edge.is_inconsistent())
    {
        return Err(Violation::InconsistentEdges { vertices, output, input });
    }
    Ok(())
}

fn first_edge(mesh: &Mesh, rings: &Rings, is_bad: impl Fn(&Edge<'_>) -> bool) -> Option<[u32; 2]> {
    let mut first = None;
    visit_edges(mesh, rings, |edge| {
        if first.is_none() && is_bad(&edge) {
            first = Some(edge.vertices);
        }
    });
    first
}

fn verify_topology(had: Topology, has: Topology) -> Result<(), Violation> {
    if has.components != had.components {
        return Err(Violation::Components { output: has.components, input: had.components });
    }
    if has.boundary_loops != had.boundary_loops {
        return Err(Violation::BoundaryLoops { output: has.boundary_loops, input: had.boundary_loops });
    }
    let (output, input) = (has.euler_characteristic(), had.euler_characteristic());
    if output != input {
        return Err(Violation::EulerCharacteristic { output, input });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::shapes;
    use super::*;

    /// A mesh of six vertices, no three of them in line.
    fn six(triangles: &[[u32; 3]]) -> Mesh {
        let positions = (0..6).map(|i| [i as f32, (i * i) as f32, (i * i * i) as f32]).collect();
        Mesh::new(positions, triangles.to_vec()).unwrap()
    }

    /// `input` with more `triangles` on new vertices.
    fn joined(a: &Mesh, b: &Mesh) -> Mesh {
        let offset = a.positions().len() as u32;
        let moved = b.triangles().iter().map(|triangle| triangle.map(|vertex| vertex + offset));
        let positions = [a.positions(), b.positions()].concat();
        Mesh::new(positions, a.triangles().iter().copied().chain(moved).collect()).unwrap()
    }

    #[test]
    fn an_unused_vertex_is_found() {
        let output = six(&[[0, 1, 2], [2, 1, 4], [4, 1, 5]]);
        let violation = Violation::UnreferencedVertex { vertex: 3 };
        assert_eq!(verify(&output, &output, false), Err(violation), "even where the input has it");
        assert_eq!(violation.to_string(), "no triangle uses vertex 3");
    }

    #[test]
    fn each_new_flaw_is_found_and_each_old_one_forgiven() {
        let clean = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]];
        let with = |more: &[[u32; 3]]| six(&[&clean[..], more].concat());
        let (output, input) = (1, 0);
        let cases = [
            (with(&[[1, 5, 1]]), Violation::DegenerateTriangles { triangle: 4, output, input }),
            (with(&[[3, 1, 2]]), Violation::DuplicateTriangles { triangle: 4, output, input }),
            (with(&[[1, 2, 5]]), Violation::NonManifoldEdges { vertices: [1, 2], output, input }),
            (
                six(&[[0, 1, 2], [0, 3, 4], [3, 5, 4]]),
                Violation::NonManifoldVertices { vertex: 0, output, input },
            ),
            (
                six(&[[0, 1, 2], [1, 2, 3], [2, 3, 4], [4, 3, 5]]),
                Violation::InconsistentEdges { vertices: [1, 2], output: 2, input },
            ),
        ];
        for (output, violation) in cases {
            assert_eq!(verify(&six(&clean), &output, false), Err(violation));
            assert_eq!(verify(&output, &output, true), Ok(()), "forgiven: {violation}");
        }
    }

    #[test]
    fn a_new_triangle_without_area_is_found() {
        let input = shapes::plane(2);
        let mut positions = input.positions().to_vec();
        positions[0] = positions[1];
        let output = Mesh::new(positions, input.triangles().to_vec()).unwrap();
        let violation = Violation::ZeroAreaTriangles { triangle: 0, output: 1, input: 0 };
        assert_eq!(verify(&input, &output, false), Err(violation));
        assert_eq!(verify(&output, &output, true), Ok(()));
        assert_eq!(violation.to_string(), "triangle 0 has no area: 1 have none, 0 in the input");
    }

    #[test]
    fn another_topology_is_found_where_it_must_be_kept() {
        let (sphere, plane, torus) = (shapes::sphere(2), shapes::plane(3), shapes::torus(8, 5));
        let cases = [
            (&sphere, &joined(&sphere, &sphere), Violation::Components { output: 2, input: 1 }),
            (&plane, &sphere, Violation::BoundaryLoops { output: 0, input: 1 }),
            (&sphere, &torus, Violation::EulerCharacteristic { output: 0, input: 2 }),
        ];
        for (input, output, violation) in cases {
            assert_eq!(verify(input, output, true), Err(violation));
            assert_eq!(verify(input, output, false), Ok(()));
        }
    }

    #[test]
    fn nothing_is_asked_of_the_topology_of_an_unclean_input() {
        let plane = shapes::plane(3);
        for flaw in [[[0, 0, 1]].as_slice(), &[[0, 1, 2], [0, 1, 2]], &[[0, 1, 2], [1, 2, 3]]] {
            let input = joined(&plane, &six(flaw));
            assert_eq!(verify(&input, &plane, true), Ok(()), "{flaw:?}");
        }
        // Neither an unused vertex nor a triangle without area makes it unclean.
        let mut positions = plane.positions().to_vec();
        positions[0] = positions[1];
        positions.push([0.0; 3]);
        let input = Mesh::new(positions, plane.triangles().to_vec()).unwrap();
        let violation = Violation::BoundaryLoops { output: 0, input: 1 };
        assert_eq!(verify(&input, &shapes::sphere(2), true), Err(violation));
    }

    #[test]
    fn an_edge_that_lost_a_face_may_be_inconsistent() {
        let pages = six(&[[0, 1, 2], [0, 1, 3], [1, 0, 4]]);
        let left = six(&[[0, 1, 2], [0, 1, 3]]);
        let used =
            |mesh: &Mesh| Mesh::new(mesh.positions()[..4].to_vec(), mesh.triangles().to_vec()).unwrap();
        assert_eq!(verify(&pages, &used(&left), true), Ok(()));
        let sound = used(&six(&[[0, 1, 2], [1, 0, 3]]));
        let violation = Violation::InconsistentEdges { vertices: [0, 1], output: 1, input: 0 };
        assert_eq!(verify(&sound, &used(&left), true), Err(violation));
    }

    proptest! {
        #[test]
        fn every_mesh_without_unused_vertices_is_as_sound_as_itself(
            triangles in prop::collection::vec([0u32..6, 0..6, 0..6], 1..20)
        ) {
            let dirty = six(&[triangles.as_slice(), &[[0, 1, 2], [3, 4, 5]]].concat());
            prop_assert_eq!(verify(&dirty, &dirty, true), Ok(()));
        }
    }
}
