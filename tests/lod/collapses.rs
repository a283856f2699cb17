//! Lists of collapses, and what they leave of a mesh, done in the plainest way.

use decimesh::hqms::HalfEdge;
use decimesh::mesh::shapes;
use decimesh::multiple_choice::{Cost, Decimation, Selection};
use decimesh::{Mesh, Monitor};
use proptest::prelude::*;

use crate::meshes::{attributed, dirty_mesh, noise, torn_mesh};

/// A mesh and collapses that it allows.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) mesh: Mesh,
    pub(crate) collapses: Vec<HalfEdge>,
}

impl Case {
    fn at_one_place(&self, a: u32, b: u32) -> bool {
        self.mesh.positions()[a as usize] == self.mesh.positions()[b as usize]
    }

    fn is_whole(&self, &[a, b, c]: &[u32; 3]) -> bool {
        !self.at_one_place(a, b) && !self.at_one_place(b, c) && !self.at_one_place(c, a)
    }

    /// The triangles after none of the collapses, and after each.
    fn replayed(&self) -> Vec<Vec<[u32; 3]>> {
        let mut triangles = self.mesh.triangles().to_vec();
        triangles.retain(|triangle| self.is_whole(triangle));
        let mut levels = vec![triangles.clone()];
        for collapse in &self.collapses {
            for corner in triangles.as_flattened_mut() {
                if *corner == collapse.source {
                    *corner = collapse.target;
                }
            }
            triangles.retain(|triangle| self.is_whole(triangle));
            levels.push(triangles.clone());
        }
        levels
    }

    /// The levels from coarse to fine that a progressive mesh must have, their triangles sorted.
    pub(crate) fn levels(&self) -> Vec<Vec<[u32; 3]>> {
        let mut levels = self.replayed();
        let inside = |done: usize| {
            done > 0
                && done < self.collapses.len()
                && self.at_one_place(self.collapses[done - 1].source, self.collapses[done].source)
        };
        let mut done = 0..;
        levels.retain(|_| !inside(done.next().unwrap()));
        levels.iter_mut().for_each(|triangles| triangles.sort_unstable());
        levels.reverse();
        levels
    }
}

/// Collapses of any vertex into any other; those at one place often follow one another.
fn any_collapses(mesh: &Mesh, share: f64, seed: u64) -> Vec<HalfEdge> {
    let mut alive: Vec<u32> = (0..mesh.positions().len() as u32).collect();
    let count = (alive.len() as f64 * share) as usize;
    let mut collapses = Vec::new();
    let mut place = [f32::NAN; 3];
    for index in 0..count {
        let random = |salt: u64, below: usize| (noise(seed ^ salt << 32, index) % below as u64) as usize;
        if alive.len() < 2 {
            break;
        }
        let at_place = alive.iter().position(|&vertex| mesh.positions()[vertex as usize] == place);
        let source = at_place.filter(|_| random(1, 4) > 0).unwrap_or(random(2, alive.len()));
        let source = alive.swap_remove(source);
        place = mesh.positions()[source as usize];
        collapses.push(HalfEdge { source, target: alive[random(3, alive.len())] });
    }
    collapses
}

/// A sheet whose middle row is doubled: a seam, with other attributes on either side.
pub(crate) fn seamed(cells: usize) -> Mesh {
    let (mut positions, mut triangles, _) = shapes::plane(cells).into_parts();
    let side = (cells + 1) as u32;
    let first = cells as u32 / 2 * side;
    let doubled = positions.len() as u32;
    positions.extend_from_within(first as usize..(first + side) as usize);
    for triangle in &mut triangles {
        if triangle.iter().any(|&vertex| vertex >= first + side) {
            for corner in triangle {
                if (first..first + side).contains(corner) {
                    *corner = *corner - first + doubled;
                }
            }
        }
    }
    attributed(Mesh::new(positions, triangles).unwrap(), 5)
}

/// Torn, dirty and seamed meshes, with attributes and without.
pub(crate) fn mesh() -> impl Strategy<Value = Mesh> {
    let mesh = prop_oneof![3 => dirty_mesh(), 2 => torn_mesh(), 1 => (2usize..7).prop_map(seamed)];
    (mesh, any::<bool>(), any::<u64>())
        .prop_map(|(mesh, bare, seed)| if bare { mesh } else { attributed(mesh, seed) })
}

/// Any mesh with any collapses, or with those of an engine.
pub(crate) fn case() -> impl Strategy<Value = Case> {
    (mesh(), 0.0..1.2, any::<bool>(), any::<u64>()).prop_map(|(mesh, share, engine, seed)| {
        let collapses = if engine {
            let mut decimation = Decimation::new(&mesh, Cost::Quadric, Selection::LazyHeap);
            decimation.reduce_to(4, &mut Monitor::silent()).unwrap();
            decimation.collapses().to_vec()
        } else {
            any_collapses(&mesh, share, seed)
        };
        Case { mesh, collapses }
    })
}
