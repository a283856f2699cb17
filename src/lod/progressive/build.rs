//! From a list of collapses to splits: the collapses are done one after the other, then all is turned over.

use std::ops::Range;

use super::{Progressive, ProgressiveError};
use crate::hqms::HalfEdge;
use crate::mesh::weld::first_equal;
use crate::mesh::{Mesh, select};

/// No corner, no vertex, or no step: there are fewer than `u32::MAX` of each.
const NONE: u32 = u32::MAX;

impl Progressive {
    /// The levels that `collapses` leave of `mesh`, one after the other.
    ///
    /// Each collapse makes all corners that name its source name its target. A triangle vanishes as soon as
    /// two of its corners are at one place (zero and negative zero are one place). Collapses in a row whose
    /// sources are at one place, as at a seam between attributes, are one step: no level lies between them.
    ///
    /// Fails where a collapse names a vertex that does not exist or is gone, or the same one twice. That its
    /// vertices share an edge is not asked for.
    ///
    /// n log n time in the vertices, linear in the triangles and in the corners that change; about 65 bytes
    /// of memory a triangle of a closed mesh besides the result.
    pub fn new(mesh: &Mesh, collapses: &[HalfEdge]) -> Result<Self, ProgressiveError> {
        Self::with_ends(mesh, collapses, &[])
    }

    /// [`new`](Self::new), where a step ends after so many collapses, in ascending order: two that only happen
    /// to be at one place may be of two levels.
    pub(super) fn with_ends(
        mesh: &Mesh,
        collapses: &[HalfEdge],
        ends: &[usize],
    ) -> Result<Self, ProgressiveError> {
        check(mesh, collapses)?;
        let places = first_equal(mesh.positions());
        let steps = steps(&places, collapses, ends);
        let mut coarsening = Coarsening::new(mesh, places, collapses.len());
        for (step, range) in (0..).zip(&steps) {
            coarsening.collapse(step, &collapses[range.clone()]);
        }
        coarsening.turned_over(mesh, collapses, &steps)
    }
}

fn check(mesh: &Mesh, collapses: &[HalfEdge]) -> Result<(), ProgressiveError> {
    let vertices = mesh.positions().len();
    let mut gone = vec![false; vertices];
    for (collapse, &HalfEdge { source, target }) in collapses.iter().enumerate() {
        for vertex in [source, target] {
            match gone.get(vertex as usize) {
                None => return Err(ProgressiveError::VertexOutOfRange { collapse, vertex, vertices }),
                Some(true) => return Err(ProgressiveError::VertexGone { collapse, vertex }),
                Some(false) => {}
            }
        }
        if source == target {
            return Err(ProgressiveError::IntoItself { collapse, vertex: source });
        }
        gone[source as usize] = true;
    }
    Ok(())
}

/// The collapses of each step, of which some end where they must.
fn steps(places: &[u32], collapses: &[HalfEdge], ends: &[usize]) -> Vec<Range<usize>> {
    let place = |collapse: &HalfEdge| places[collapse.source as usize];
    let mut steps: Vec<Range<usize>> = Vec::new();
    for (index, collapse) in collapses.iter().enumerate() {
        match steps.last_mut() {
            Some(step)
                if place(&collapses[step.start]) == place(collapse)
                    && ends.binary_search(&index).is_err() =>
            {
                step.end = index + 1;
            }
            _ => steps.push(index..index + 1),
        }
    }
    steps
}

/// A mesh that loses vertices.
struct Coarsening {
    places: Vec<u32>,
    /// Of the level reached; those of a vanished triangle as they were before it did.
    corners: Vec<u32>,
    /// The step in which each triangle vanishes; `NONE` while it has not.
    vanished: Vec<u32>,
    /// Triangles that never were.
    degenerate: usize,
    /// The corners that name a vertex, as a list: one for each vertex, and what follows each corner.
    first: Vec<u32>,
    next: Vec<u32>,
    /// What each vertex of the step goes into at its end; any other, into itself.
    into: Vec<u32>,
    /// Corners that changed, those of one collapse after those of another.
    changes: Vec<u32>,
    change_starts: Vec<usize>,
}

impl Coarsening {
    fn new(mesh: &Mesh, places: Vec<u32>, collapses: usize) -> Self {
        let vertices = places.len();
        let corners = mesh.triangles().as_flattened().to_vec();
        let mut change_starts = Vec::with_capacity(collapses + 1);
        change_starts.push(0);
        let mut coarsening = Self {
            vanished: vec![NONE; mesh.triangles().len()],
            degenerate: 0,
            first: vec![NONE; vertices],
            next: vec![NONE; corners.len()],
            into: (0..vertices as u32).collect(),
            changes: Vec::new(),
            change_starts,
            places,
            corners,
        };
        for triangle in 0..mesh.triangles().len() {
            if coarsening.is_degenerate(mesh.triangles()[triangle]) {
                coarsening.degenerate += 1;
            } else {
                for corner in 3 * triangle..3 * triangle + 3 {
                    coarsening.give(corner as u32, coarsening.corners[corner]);
                }
            }
        }
        coarsening
    }

    fn is_degenerate(&self, triangle: [u32; 3]) -> bool {
        let [a, b, c] = triangle.map(|vertex| self.places[vertex as usize]);
        a == b || b == c || c == a
    }

    /// Puts `corner` into the list of `vertex`.
    fn give(&mut self, corner: u32, vertex: u32) {
        self.next[corner as usize] = std::mem::replace(&mut self.first[vertex as usize], corner);
    }

    /// Does the collapses of one step. A triangle has one corner at the place of their sources at most, so
    /// each of its corners changes once, to what the source has become in the end.
    fn collapse(&mut self, step: u32, collapses: &[HalfEdge]) {
        for collapse in collapses.iter().rev() {
            self.into[collapse.source as usize] = self.into[collapse.target as usize];
        }
        for collapse in collapses {
            self.change(step, collapse.source);
            self.change_starts.push(self.changes.len());
        }
    }

    fn change(&mut self, step: u32, source: u32) {
        let target = self.into[source as usize];
        let mut following = std::mem::replace(&mut self.first[source as usize], NONE);
        while following != NONE {
            let corner = following;
            following = self.next[corner as usize];
            let triangle = corner as usize / 3;
            if self.vanished[triangle] != NONE {
                continue;
            }
            self.corners[corner as usize] = target;
            if self.is_degenerate(self.triangle(triangle)) {
                self.corners[corner as usize] = source;
                self.vanished[triangle] = step;
            } else {
                self.changes.push(corner);
                self.give(corner, target);
            }
        }
    }

    fn triangle(&self, triangle: usize) -> [u32; 3] {
        std::array::from_fn(|corner| self.corners[3 * triangle + corner])
    }

    /// The splits that undo the steps, with vertices and triangles in their order.
    fn turned_over(
        self,
        mesh: &Mesh,
        collapses: &[HalfEdge],
        steps: &[Range<usize>],
    ) -> Result<Progressive, ProgressiveError> {
        let (order, names) = self.vertex_order(collapses, steps);
        let (triangle_order, triangle_names, triangle_starts) = self.triangle_order(steps.len());
        let named = |vertex: u32| names[vertex as usize];

        let survivors = order.len() - collapses.len();
        let mut vertex_starts = vec![survivors as u32];
        let mut parents = Vec::with_capacity(collapses.len());
        let mut corner_starts = vec![0];
        let mut corners = Vec::with_capacity(self.changes.len());
        for collapse in steps.iter().rev().flat_map(Range::clone) {
            parents.push(named(self.into[collapses[collapse].source as usize]));
            let changes = &self.changes[self.change_starts[collapse]..self.change_starts[collapse + 1]];
            let first = corners.len();
            corners
                .extend(changes.iter().map(|&corner| triangle_names[corner as usize / 3] * 3 + corner % 3));
            corners[first..].sort_unstable();
            corner_starts.push(corners.len());
        }
        let mut vertices = survivors;
        vertex_starts.extend(steps.iter().rev().map(|range| {
            vertices += range.len();
            vertices as u32
        }));

        let triangles = triangle_order.iter().map(|&triangle| self.triangle(triangle as usize).map(named));
        let positions = select(mesh.positions(), &order);
        let attributes = mesh.attributes().select(&order);
        Ok(Progressive {
            vertices: Mesh::with_attributes(positions, Vec::new(), attributes)?,
            triangles: triangles.collect(),
            vertex_starts,
            triangle_starts,
            parents,
            corner_starts,
            corners,
            marks: Vec::new(),
            order: Some(order),
        })
    }

    /// The vertices in use, those that stay first, then from the last step to the first; and what each is
    /// called then.
    fn vertex_order(&self, collapses: &[HalfEdge], steps: &[Range<usize>]) -> (Vec<u32>, Vec<u32>) {
        const GONE: u32 = NONE - 1;
        let mut names = vec![NONE; self.places.len()];
        let alive =
            (0..).zip(self.corners.chunks_exact(3)).filter(|&(triangle, _)| !self.never_was(triangle));
        // A vanished triangle holds the corners of its last level, which need not be gone.
        for &vertex in alive.flat_map(|(_, corners)| corners) {
            names[vertex as usize] = 0;
        }
        for collapse in collapses {
            names[collapse.target as usize] = 0;
        }
        for collapse in collapses {
            names[collapse.source as usize] = GONE;
        }
        let mut order: Vec<u32> =
            (0..).zip(&names).filter(|&(_, &name)| name == 0).map(|(vertex, _)| vertex).collect();
        let gone = steps.iter().rev().flat_map(Range::clone).map(|collapse| collapses[collapse].source);
        order.extend(gone);
        for (name, &vertex) in (0..).zip(&order) {
            names[vertex as usize] = name;
        }
        (order, names)
    }

    /// Whether `triangle` was degenerate from the start: it is in no list, so its corners never change.
    fn never_was(&self, triangle: usize) -> bool {
        self.vanished[triangle] == NONE && self.is_degenerate(self.triangle(triangle))
    }

    /// The triangles that ever were, those that stay first, then from the last step to the first; what each
    /// is called then, and where those of each split begin.
    fn triangle_order(&self, steps: usize) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
        let split = |vanished: u32| if vanished == NONE { 0 } else { steps - vanished as usize };
        let alive = || (0..self.vanished.len()).filter(|&triangle| !self.never_was(triangle));
        let mut starts = vec![0; steps + 1];
        alive().for_each(|triangle| starts[split(self.vanished[triangle])] += 1);
        let mut next = Vec::with_capacity(steps + 1);
        let mut sum = 0;
        for start in &mut starts {
            next.push(sum);
            sum += *start;
            *start = sum;
        }
        let mut order = vec![0; self.vanished.len() - self.degenerate];
        let mut names = vec![NONE; self.vanished.len()];
        for triangle in alive() {
            let name = &mut next[split(self.vanished[triangle])];
            names[triangle] = *name;
            order[*name as usize] = triangle as u32;
            *name += 1;
        }
        (order, names, starts)
    }
}
