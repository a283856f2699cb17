//! A surface as a mesh again.

use super::{Face, NONE, Surface, corners, is_alive};
use crate::collapse::HalfEdge;
use crate::mesh::{Mesh, MeshError, select};
use glam::Vec3;
use std::collections::HashMap;
use std::sync::atomic::Ordering::Relaxed;

/// What is left of a mesh: see [`Surface::to_mesh`].
pub(crate) struct Remains {
    pub(crate) mesh: Mesh,
    /// For each vertex of the input the vertex it is in now, or [`NONE`], if that was tracked.
    pub(crate) origins: Option<Vec<u32>>,
    /// For each vertex the one of the input that it was, if that was tracked.
    pub(crate) sources: Option<Vec<u32>>,
    /// The groups of the triangles, if there are groups.
    pub(crate) groups: Option<Vec<u32>>,
    /// For each vertex the first that is the same on the surface, if there may be several.
    pub(crate) surface_vertices: Option<Vec<u32>>,
}

impl Surface {
    /// The surface as a mesh in the scale of the input, without vertices that no face uses. If no
    /// vertex has moved and the sources are known, positions and attributes are those of `input`, bit for
    /// bit.
    pub(crate) fn to_mesh(&self, unmoved: Option<&Mesh>) -> Result<Remains, MeshError> {
        if let (Some(input), Some(sources)) = (unmoved, &self.sources) {
            return self.to_mesh_of(input, sources);
        }
        let alive = || self.faces.iter().filter(|face| is_alive(face)).map(corners);
        let (triangles, map, used) = renumbered(alive, self.points.len());
        let sources = self.sources.as_ref().map(|sources| select(sources, &used));
        let into =
            |origin: &u32| last_merged(&self.merged, *origin).map_or(NONE, |vertex| map[vertex as usize]);
        let origins = self.origins.as_ref().map(|origins| origins.iter().map(into).collect());
        let mesh = Mesh::with_attributes(self.positions(&used), triangles, self.attributes.select(&used))?;
        Ok(Remains { mesh, origins, sources, groups: None, surface_vertices: None })
    }

    /// The surface as a mesh of vertices of `input`, of which each of its own is one of `sources`.
    fn to_mesh_of(&self, input: &Mesh, sources: &[u32]) -> Result<Remains, MeshError> {
        let count = input.positions().len();
        let wedges = || self.faces.iter().zip(&self.wedges).filter(|(face, _)| is_alive(face));
        let (mut groups, mut surface_vertices) = (None, None);
        let (triangles, used) = if self.wedges.is_empty() {
            let alive = || self.faces.iter().filter(|face| is_alive(face)).map(corners);
            let (triangles, _, used) = renumbered(alive, self.points.len());
            (triangles, select(sources, &used))
        } else {
            let group = |wedges: &Face| self.wedge_names.group(wedges[0].load(Relaxed));
            if self.wedge_names.have_groups() {
                groups = wedges().map(|(_, wedges)| group(wedges)).collect();
            }
            let alive =
                || wedges().map(|(_, wedges)| corners(wedges).map(|wedge| self.wedge_names.vertex(wedge)));
            let (mut triangles, _, mut used) = renumbered(alive, count);
            surface_vertices = Some(self.part(&mut triangles, &mut used));
            (triangles, used)
        };
        let origins = self.collapses.as_ref().map(|collapses| origins(collapses, &used, count));
        let (positions, attributes) = (select(input.positions(), &used), input.attributes().select(&used));
        let mesh = Mesh::with_attributes(positions, triangles, attributes)?;
        Ok(Remains { mesh, origins, sources: Some(used), groups, surface_vertices })
    }

    /// Gives each vertex of the surface names of its own: where the surface was parted, several have the same.
    /// `triangles` are those of the living faces, and name vertices that are `used`. For each of these then
    /// the first that is the same on the surface.
    fn part(&self, triangles: &mut [[u32; 3]], used: &mut Vec<u32>) -> Vec<u32> {
        let mut owners = vec![NONE; used.len()];
        let mut further: HashMap<(u32, u32), u32> = HashMap::new();
        let faces = self.faces.iter().filter(|face| is_alive(face)).map(corners);
        let pairs = triangles.as_flattened_mut().iter_mut().zip(faces.flatten());
        for (name, vertex) in pairs {
            let owner = &mut owners[*name as usize];
            if *owner == NONE {
                *owner = vertex;
            } else if *owner != vertex {
                *name = *further.entry((*name, vertex)).or_insert_with(|| {
                    used.push(used[*name as usize]);
                    owners.push(vertex);
                    used.len() as u32 - 1
                });
            }
        }
        let mut first = vec![NONE; self.points.len()];
        let named = |(vertex, owner): (u32, u32)| {
            let first = &mut first[owner as usize];
            if *first == NONE {
                *first = vertex;
            }
            *first
        };
        (0..).zip(owners).map(named).collect()
    }

    /// The positions of `vertices`, in the scale of the input.
    fn positions(&self, vertices: &[u32]) -> Vec<[f32; 3]> {
        let unscale = 1.0 / self.scale;
        let unscaled = |&vertex: &u32| {
            // An optimal placement may lie a little beyond the largest number there is.
            let position = self.points[vertex as usize].truncate() * unscale;
            position.clamp(Vec3::splat(f32::MIN), Vec3::splat(f32::MAX)).to_array()
        };
        vertices.iter().map(unscaled).collect()
    }
}

/// The triangles with their corners numbered as they are used, in ascending order; for each of the `count`
/// numbers that there were the new one, or [`NONE`]; and the old one of each new number.
fn renumbered<I: Iterator<Item = [u32; 3]>>(
    triangles: impl Fn() -> I,
    count: usize,
) -> (Vec<[u32; 3]>, Vec<u32>, Vec<u32>) {
    let mut map = vec![NONE; count];
    triangles().flatten().for_each(|corner| map[corner as usize] = 0);
    let mut used = Vec::with_capacity(map.iter().filter(|successor| **successor == 0).count());
    for (successor, vertex) in map.iter_mut().zip(0..).filter(|(successor, _)| **successor == 0) {
        *successor = used.len() as u32;
        used.push(vertex);
    }
    let mut renamed = Vec::with_capacity(triangles().count());
    renamed.extend(triangles().map(|triangle| triangle.map(|corner| map[corner as usize])));
    (renamed, map, used)
}

/// For each of the input's `vertices` the last one of `sources` that it went into, or [`NONE`].
fn origins(collapses: &[HalfEdge], sources: &[u32], vertices: usize) -> Vec<u32> {
    let mut origins = vec![NONE; vertices];
    for (&source, vertex) in sources.iter().zip(0..) {
        origins[source as usize] = vertex;
    }
    // Backwards, where a target goes is known when its source is come to. A vertex at which the surface was
    // parted has several lives, of which the last counts.
    for &HalfEdge { source, target } in collapses.iter().rev() {
        if origins[source as usize] == NONE {
            origins[source as usize] = origins[target as usize];
        }
    }
    origins
}

/// The end of the chain of collapses that starts at `origin`, unless it vanished.
pub(super) fn last_merged(merged: &[u32], origin: u32) -> Option<u32> {
    let mut vertex = origin;
    while vertex != NONE && merged[vertex as usize] != vertex {
        vertex = merged[vertex as usize];
    }
    (vertex != NONE).then_some(vertex)
}
