//! The mesh while it is being simplified: the one mutable copy, in few bytes.
//!
//! Per vertex 16 bytes of position and error and 1 of flags, per face 12 bytes of corners: 21 bytes a triangle
//! of a closed mesh. To that come, for a time, 4 bytes a vertex for [`Surface::classify`] or the map of
//! [`Surface::compact`], and the rings of the tiles that are worked on.

mod classify;
mod compact;
mod remains;
mod rings;

use super::HalfEdge;
use super::attributes::{AttributeRows, AttributeWeights};
use super::half_edge::Terms;
pub(crate) use super::load::unit_scale;
use super::load::{Faces, ordered_faces, scatter};
use super::tile::{Columns, Shared, Tile};
use super::wedges::{WedgeNames, Wedges};
use crate::mesh::places::Places;
use crate::mesh::topology::is_face;
use crate::mesh::{Attributes, Mesh};
use crate::workers::Workers;
use glam::{Vec3, Vec4};
pub(crate) use remains::Remains;
pub(crate) use rings::{Rings, SampledRings, Spans, are_coherent};
use std::borrow::Cow;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Three corners. Atomic only so that tiles that work side by side may read the faces between
/// them: a face is written by the one tile that holds all of its vertices, and a relaxed access
/// costs what a plain one does. A face is dead when its first two corners are equal.
pub(crate) type Face = [AtomicU32; 3];

/// What is known about a vertex: bits of [`Surface::flags`].
pub(crate) mod flag {
    /// On an edge with more faces in one direction than in the other: a border, a change of
    /// orientation, or an edge of three faces. An edge with as many of each, such as the one along
    /// which two solids touch, does not show here; the link condition does not let it collapse.
    pub(crate) const BOUNDARY: u8 = 1;
    /// Target of a collapse in this pass.
    pub(crate) const USED: u8 = 2;
    /// Gone.
    pub(crate) const DEAD: u8 = 4;
    /// Must not move.
    pub(crate) const LOCKED: u8 = 8;
    /// The cheapest collapse of the vertex was not legal when last tried.
    pub(crate) const BLOCKED: u8 = 16;
    /// Has, or once had, several wedges.
    pub(crate) const SEAM: u8 = 32;
    /// Its wedges go along seams only.
    pub(crate) const PROTECTED: u8 = 64;
    /// To be kept as long as others can go.
    pub(crate) const PRIORITY: u8 = 128;
    /// At an open edge that lies on others, nobody knows how: it must not move, and what lies there must not
    /// vanish. What is locked goes along no seam, so that to protect it says this.
    pub(crate) const TANGLED: u8 = LOCKED | PROTECTED;
}

/// Marks a vertex that has no successor.
pub(crate) const NONE: u32 = u32::MAX;

/// A surface at an earlier time.
#[derive(Clone)]
pub(crate) struct Snapshot {
    points: Vec<Vec4>,
    faces: Vec<[u32; 3]>,
    wedges: Vec<[u32; 3]>,
    flags: Vec<u8>,
    attributes: Attributes,
    attribute_errors: Vec<f32>,
    origins: Option<Vec<u32>>,
    sources: Option<Vec<u32>>,
    collapses: Option<Vec<HalfEdge>>,
}

/// How a mesh is to be taken over.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Setting<'a> {
    /// Where each vertex shall go in memory.
    pub(crate) rank: Option<&'a [u32]>,
    /// Vertices that must not move.
    pub(crate) locked: &'a [u32],
    pub(crate) track: Track,
    /// Vertices stay where they are: attributes are left in the mesh, and what follows counts.
    pub(crate) half_edge: bool,
    /// Which vertices are one.
    pub(crate) places: Option<&'a Places>,
    /// The group of each triangle.
    pub(crate) groups: Option<&'a [u32]>,
    pub(crate) weights: AttributeWeights,
    pub(crate) cross_seams: bool,
    pub(crate) protected: &'a [u32],
    pub(crate) prioritized: &'a [u32],
}

/// What to remember of where vertices came from.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Track {
    pub(crate) origins: bool,
    pub(crate) sources: bool,
    /// Half-edge collapses, in the names of the input's vertices; needs the sources.
    pub(crate) collapses: bool,
}

/// A mesh in the course of its simplification.
pub(crate) struct Surface {
    /// For each vertex its position and, as the fourth coordinate, the estimated distance of its
    /// surroundings from the input: sixteen bytes are read at once where twelve are not.
    pub(crate) points: Vec<Vec4>,
    pub(crate) faces: Vec<Face>,
    pub(crate) flags: Vec<u8>,
    pub(crate) attributes: Attributes,
    /// What each vertex was collapsed into, in this pass; empty when nobody asked for origins.
    pub(crate) merged: Vec<u32>,
    /// For each vertex of the input the vertex it is in now, or [`NONE`].
    origins: Option<Vec<u32>>,
    /// For each vertex the one of the input that it was.
    pub(crate) sources: Option<Vec<u32>>,
    /// Half-edge collapses so far, in the names of the input's vertices.
    pub(crate) collapses: Option<Vec<HalfEdge>>,
    /// Where vertices stay: for each vertex the next one of those that its target has absorbed in this
    /// pass, or [`NONE`]; so a target may absorb several, as its place does not depend on them. Empty
    /// where vertices move.
    pub(crate) absorbed: Vec<u32>,
    /// The wedges of the faces' corners; empty where each vertex has one.
    pub(crate) wedges: Vec<Face>,
    wedge_names: WedgeNames,
    rows: Option<AttributeRows>,
    /// For each vertex the estimated difference of the attributes around it from the input, weighted; empty
    /// where they have no weight.
    pub(crate) attribute_errors: Vec<f32>,
    cross_seams: bool,
    /// Of blocks of faces, while tiles look at them.
    spans: Spans,
    /// Of all vertices, while the surface is fitted to the input.
    rings: Rings,
    /// Positions are multiplied by this power of two, and divided by it in the end.
    scale: f32,
}

impl Surface {
    /// Takes `mesh` over, without its degenerate triangles, scaled by a power of two to edges of about unit
    /// length: in the memory of its triangles where it is given away and they are in a good order.
    pub(crate) fn new(mesh: Cow<Mesh>, setting: &Setting, workers: &Workers) -> Self {
        let &Setting { rank, track, half_edge, places, .. } = setting;
        let scale = unit_scale(&mesh);
        let count = mesh.positions().len();
        let place = |vertex: u32| {
            let vertex = places.map_or(vertex, |places| places.first[vertex as usize]);
            rank.map_or(vertex, |rank| rank[vertex as usize])
        };
        let mut flags = vec![0; count];
        let tangled = places.map_or(&[][..], |places| &places.tangled);
        for (vertices, flag) in [
            (setting.locked, flag::LOCKED),
            (tangled, flag::TANGLED),
            (setting.protected, flag::PROTECTED),
            (setting.prioritized, flag::PRIORITY),
        ] {
            vertices.iter().for_each(|&vertex| flags[place(vertex) as usize] |= flag);
        }
        let (wedge_names, wedges) = if half_edge {
            WedgeNames::new(&mesh, places, setting.groups)
        } else {
            (WedgeNames::default(), None)
        };
        // Two corners at one position are one to whoever does the collapses again.
        let whole = |triangle: &[u32; 3]| match places {
            Some(places) => is_face(&triangle.map(|vertex| places.positions[vertex as usize])),
            None => is_face(triangle),
        };
        let rows = half_edge.then(|| AttributeRows::new(&mesh, setting.weights, scale)).flatten();
        let (positions, triangles, attributes) = match mesh {
            Cow::Borrowed(mesh) => {
                let attributes = if half_edge { Attributes::default() } else { mesh.attributes().clone() };
                (Cow::Borrowed(mesh.positions()), Cow::Borrowed(mesh.triangles()), attributes)
            }
            Cow::Owned(mesh) => {
                let (positions, triangles, attributes) = mesh.into_parts();
                (Cow::Owned(positions), Cow::Owned(triangles), attributes)
            }
        };
        let scaled = positions.iter().map(|&position| (Vec3::from(position) * scale).extend(0.0));
        let points = match rank {
            None => scaled.collect(),
            Some(rank) => scatter(scaled, rank),
        };
        drop(positions);
        let Faces { faces, wedges } =
            ordered_faces(triangles, wedges.as_deref(), count, rank.is_some(), whole, place, workers);
        let merges = track.origins && !half_edge;
        Self {
            points,
            faces,
            flags,
            attributes: match rank {
                None => attributes,
                Some(rank) => Attributes {
                    normals: attributes.normals.map(|normals| scatter(normals.into_iter(), rank)),
                    colors: attributes.colors.map(|colors| scatter(colors.into_iter(), rank)),
                    uvs: attributes.uvs.map(|uvs| scatter(uvs.into_iter(), rank)),
                },
            },
            merged: if merges { (0..count as u32).collect() } else { Vec::new() },
            origins: merges.then(|| (0..count as u32).map(place).collect()),
            sources: track.sources.then(|| match rank {
                None => (0..count as u32).collect(),
                Some(rank) => scatter(0..count as u32, rank),
            }),
            collapses: track.collapses.then(Vec::new),
            absorbed: if half_edge { vec![NONE; count] } else { Vec::new() },
            wedges,
            wedge_names,
            attribute_errors: if rows.is_some() { vec![0.0; count] } else { Vec::new() },
            rows,
            cross_seams: setting.cross_seams,
            spans: Spans::default(),
            rings: Rings::default(),
            scale,
        }
    }

    /// Positions are the input's times this.
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// For each vertex of the input the vertex it is in since the last [`compact`](Self::compact), or [`NONE`],
    /// if that is tracked.
    pub(crate) fn origins(&self) -> Option<&[u32]> {
        self.origins.as_deref()
    }

    /// Finds the rings of all vertices, which [`ring`](Self::ring) needs: of the faces as they are now.
    pub(crate) fn find_rings(&mut self) {
        self.rings = Rings::new(&self.faces, &Spans::default(), 0..self.points.len() as u32);
    }

    /// Gives the rings' memory back.
    pub(crate) fn drop_rings(&mut self) {
        self.rings = Rings::default();
    }

    /// The corners of the faces around a vertex, as `face << 2 | corner`, in the order of the faces. Needs the
    /// rings.
    #[inline(always)]
    pub(crate) fn ring(&self, vertex: u32) -> impl Iterator<Item = u32> + '_ {
        self.rings.around(vertex).iter().copied()
    }

    /// The vertices of a face.
    #[inline(always)]
    pub(crate) fn corners(&self, face: u32) -> [u32; 3] {
        corners(&self.faces[face as usize])
    }

    /// Gives a face other vertices. The rings then have to be found anew.
    pub(crate) fn set_corners(&mut self, face: u32, vertices: [u32; 3]) {
        self.faces[face as usize] = vertices.map(AtomicU32::new);
    }

    /// The vertex at a corner.
    #[inline(always)]
    pub(crate) fn vertex(&self, corner: u32) -> u32 {
        self.faces[(corner >> 2) as usize][(corner & 3) as usize].load(Relaxed)
    }

    /// How many vertices the result has.
    pub(crate) fn vertex_count(&self) -> usize {
        if self.wedges.is_empty() {
            return self.flags.iter().filter(|flags| *flags & flag::DEAD == 0).count();
        }
        // A name is mostly one vertex's; where the surface was parted, several have it.
        let mut owners = vec![NONE; self.wedge_names.vertex_count()];
        let mut further = Vec::new();
        let faces = self.faces.iter().zip(&self.wedges).filter(|(face, _)| is_alive(face));
        for (vertex, wedge) in faces.flat_map(|(face, wedges)| corners(face).into_iter().zip(corners(wedges)))
        {
            let name = self.wedge_names.vertex(wedge);
            let owner = &mut owners[name as usize];
            if *owner == NONE {
                *owner = vertex;
            } else if *owner != vertex {
                further.push((name, vertex));
            }
        }
        further.sort_unstable();
        further.dedup();
        owners.into_iter().filter(|owner| *owner != NONE).count() + further.len()
    }

    /// What decides where a vertex goes, where vertices stay.
    pub(crate) fn terms(&self) -> Terms<'_> {
        let Self { faces, wedges, sources, wedge_names, rows, cross_seams, .. } = self;
        terms(faces, wedges, sources.as_deref(), wedge_names, rows.as_ref(), *cross_seams)
    }

    /// The whole surface as one tile, without rings.
    pub(crate) fn whole(&mut self) -> Tile<'_> {
        self.spans = Spans::default();
        self.cut(std::iter::empty()).remove(0)
    }

    /// The surface cut into tiles before each of the vertices `cuts`, which ascend. Tiles have no rings yet.
    pub(crate) fn tiles(&mut self, cuts: impl Iterator<Item = usize>, workers: &Workers) -> Vec<Tile<'_>> {
        let mut cuts = cuts.peekable();
        // A single tile has all faces.
        self.spans = if cuts.peek().is_some() { Spans::new(&self.faces, workers) } else { Spans::default() };
        self.cut(cuts)
    }

    /// The rings of `count` vertices strided over all.
    pub(crate) fn sampled_rings(&self, count: usize, workers: &Workers) -> SampledRings {
        SampledRings::new(&self.faces, self.points.len(), count, workers)
    }

    fn cut(&mut self, cuts: impl Iterator<Item = usize>) -> Vec<Tile<'_>> {
        let Self { faces, wedges, sources, wedge_names, rows, cross_seams, .. } = self;
        let terms = terms(faces, wedges, sources.as_deref(), wedge_names, rows.as_ref(), *cross_seams);
        let Attributes { normals, colors, uvs } = &mut self.attributes;
        let columns = Columns {
            points: &mut self.points,
            flags: &mut self.flags,
            merged: &mut self.merged,
            absorbed: &mut self.absorbed,
            attribute_errors: &mut self.attribute_errors,
            normals: normals.as_deref_mut().unwrap_or_default(),
            colors: colors.as_deref_mut().unwrap_or_default(),
            uvs: uvs.as_deref_mut().unwrap_or_default(),
        };
        let shared = Shared { faces, spans: &self.spans, terms };
        let whole = Tile::new(columns, shared, self.collapses.is_some());
        let mut tiles = vec![whole];
        for cut in cuts {
            if let Some(last) = tiles.pop() {
                tiles.extend(last.split(cut));
            }
        }
        tiles
    }

    /// Adds to what was collapsed, if that is tracked.
    pub(crate) fn remember(&mut self, collapses: impl IntoIterator<Item = HalfEdge>) {
        if let Some(all) = &mut self.collapses {
            all.extend(collapses);
        }
    }

    /// Gives memory back that a larger surface needed.
    pub(crate) fn shrink(&mut self) {
        self.points.shrink_to_fit();
        self.faces.shrink_to_fit();
        self.wedges.shrink_to_fit();
        self.flags.shrink_to_fit();
        self.absorbed.shrink_to_fit();
        self.sources.iter_mut().for_each(Vec::shrink_to_fit);
    }

    /// What [`restore`](Self::restore) needs to come back to a compacted surface as it is.
    pub(crate) fn snapshot(&self) -> Snapshot {
        Snapshot {
            points: self.points.clone(),
            faces: self.faces.iter().map(corners).collect(),
            wedges: self.wedges.iter().map(corners).collect(),
            flags: self.flags.clone(),
            attribute_errors: self.attribute_errors.clone(),
            attributes: self.attributes.clone(),
            origins: self.origins.clone(),
            sources: self.sources.clone(),
            collapses: self.collapses.clone(),
        }
    }

    /// Back to a snapshot.
    pub(crate) fn restore(&mut self, snapshot: Snapshot) {
        if self.origins.is_some() {
            self.merged = (0..snapshot.points.len() as u32).collect();
        }
        self.points = snapshot.points;
        self.faces = snapshot.faces.into_iter().map(|face| face.map(AtomicU32::new)).collect();
        self.wedges = snapshot.wedges.into_iter().map(|face| face.map(AtomicU32::new)).collect();
        if !self.absorbed.is_empty() {
            self.absorbed = vec![NONE; self.points.len()];
        }
        self.flags = snapshot.flags;
        self.attribute_errors = snapshot.attribute_errors;
        self.attributes = snapshot.attributes;
        self.origins = snapshot.origins;
        self.sources = snapshot.sources;
        self.collapses = snapshot.collapses;
    }

    /// Whether there are seams that vertices do not cross.
    pub(crate) fn keeps_seams(&self) -> bool {
        !self.wedges.is_empty() && !self.cross_seams
    }

    /// From now on vertices may go across seams, but for those that are protected.
    pub(crate) fn cross_seams(&mut self) {
        self.cross_seams = true;
        self.flags.iter_mut().for_each(|flags| *flags &= !flag::BLOCKED);
    }

    /// Sets the errors of the vertices to those of the corners of `triangles`, which are those of the living faces
    /// in their order. What was not legal before may be so now.
    #[cfg(feature = "deviation")]
    pub(crate) fn set_errors(&mut self, triangles: &[[u32; 3]], errors: &[f32]) {
        let Self { points, faces, flags, scale, .. } = self;
        points.iter_mut().for_each(|point| point.w = 0.0);
        for (face, triangle) in faces.iter().filter(|face| is_alive(face)).map(corners).zip(triangles) {
            for (vertex, corner) in face.into_iter().zip(triangle) {
                // Vertices of the mesh may be one on the surface.
                let error = &mut points[vertex as usize].w;
                *error = error.max(errors[*corner as usize] * *scale);
            }
        }
        flags.iter_mut().for_each(|flags| *flags &= !flag::BLOCKED);
    }
}

/// What decides where a vertex goes, of a surface of which other parts may be in use.
fn terms<'a>(
    faces: &'a [Face],
    corners: &'a [Face],
    sources: Option<&'a [u32]>,
    names: &'a WedgeNames,
    rows: Option<&'a AttributeRows>,
    cross_seams: bool,
) -> Terms<'a> {
    let wedges = Wedges { faces, corners, sources: sources.unwrap_or_default(), names };
    Terms { wedges, rows, cross_seams }
}

/// Whether a face has not been collapsed.
#[inline(always)]
pub(crate) fn is_alive(face: &Face) -> bool {
    face[0].load(Relaxed) != face[1].load(Relaxed)
}

/// The corners of a face.
fn corners(face: &Face) -> [u32; 3] {
    face.each_ref().map(|corner| corner.load(Relaxed))
}

const NEXT: [u32; 4] = [1, 2, 0, 0];
const PREVIOUS: [u32; 4] = [2, 0, 1, 0];

/// The corner after `corner` in its face: each is `face << 2 | corner`.
#[inline(always)]
pub(crate) fn next_corner(corner: u32) -> u32 {
    corner & !3 | NEXT[(corner & 3) as usize]
}

/// The corner before `corner` in its face.
#[inline(always)]
pub(crate) fn previous_corner(corner: u32) -> u32 {
    corner & !3 | PREVIOUS[(corner & 3) as usize]
}

/// The vertices at the corners after and before `corner`.
#[inline(always)]
pub(crate) fn neighbours(faces: &[Face], corner: u32) -> (u32, u32) {
    let face = &faces[(corner >> 2) as usize];
    let corner = (corner & 3) as usize;
    (face[NEXT[corner] as usize].load(Relaxed), face[PREVIOUS[corner] as usize].load(Relaxed))
}

/// Whether a ring, given by its corners, lies on an edge that [`flag::BOUNDARY`] is for.
///
/// In a closed and oriented ring, each neighbour is once the next corner and once the previous one;
/// so the hashes of the next less those of the previous cancel, and elsewhere they do so once in 2³²
/// rings by chance.
#[inline(always)]
pub(crate) fn is_open(faces: &[Face], corners: impl Iterator<Item = u32>) -> bool {
    let balance = corners.fold(0u32, |balance, corner| {
        let (next, previous) = neighbours(faces, corner);
        balance.wrapping_add(hash(next)).wrapping_sub(hash(previous))
    });
    balance != 0
}

/// A mixture of the bits of a vertex, not linear, so that sums of them say which were added.
#[inline(always)]
fn hash(vertex: u32) -> u32 {
    let mixed = vertex.wrapping_mul(0x9E37_79B1);
    mixed ^ mixed >> 15
}
