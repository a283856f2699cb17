//! The mesh while it is being simplified: the one mutable copy, in few bytes.
//!
//! Per vertex 16 bytes of position and error, 1 of flags and 4 of offsets; per face 12 bytes of
//! corners and 12 of incidence: about 35 bytes a triangle of a closed mesh. Offsets serve a second
//! time as the map of [`Surface::compact`].

use super::HalfEdge;
use super::tile::{Columns, Shared, Tile};
use crate::mesh::topology::is_face;
use crate::mesh::{Attributes, Mesh, MeshError, select};
use crate::workers::Workers;
use glam::{Vec3, Vec4};
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
}

/// Marks a vertex that has no successor.
pub(crate) const NONE: u32 = u32::MAX;

/// Faces in a block of parallel work over faces.
const FACE_BLOCK: usize = 1 << 15;
/// Vertices in a block of parallel work over vertices.
const VERTEX_BLOCK: usize = 1 << 15;

/// A surface at an earlier time.
pub(crate) struct Snapshot {
    points: Vec<Vec4>,
    faces: Vec<[u32; 3]>,
    flags: Vec<u8>,
    attributes: Attributes,
    origins: Option<Vec<u32>>,
    sources: Option<Vec<u32>>,
    collapses: Option<Vec<HalfEdge>>,
}

/// What is left of a mesh: see [`Surface::to_mesh`].
pub(crate) struct Remains {
    pub(crate) mesh: Mesh,
    /// For each vertex of the input the vertex it is in now, or [`NONE`], if that was tracked.
    pub(crate) origins: Option<Vec<u32>>,
    /// For each vertex the one of the input that it was, if that was tracked.
    pub(crate) sources: Option<Vec<u32>>,
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
    /// Ring of `v`: `incidence[offsets[v]..offsets[v + 1]]`, as `face << 2 | corner`.
    offsets: Vec<u32>,
    incidence: Vec<Face>,
    /// Positions are multiplied by this power of two, and divided by it in the end.
    scale: f32,
}

impl Surface {
    /// Copies `mesh`, without its degenerate triangles, scaled by a power of two to edges of
    /// about unit length. The vertex `v` goes to `rank[v]`, if there is a rank. If vertices shall stay where
    /// they are (`half_edge`), attributes are left in `mesh`.
    pub(crate) fn new(
        mesh: &Mesh,
        rank: Option<&[u32]>,
        locked: &[u32],
        half_edge: bool,
        track: Track,
        workers: &Workers,
    ) -> Self {
        let scale = unit_scale(mesh);
        let count = mesh.positions().len();
        let place = |vertex: u32| rank.map_or(vertex, |rank| rank[vertex as usize]);
        let scaled = mesh.positions().iter().map(|&position| (Vec3::from(position) * scale).extend(0.0));
        let mut flags = vec![0; count];
        for &vertex in locked {
            flags[place(vertex) as usize] |= flag::LOCKED;
        }
        let none = Attributes::default();
        let attributes = if half_edge { &none } else { mesh.attributes() };
        let merges = track.origins && !half_edge;
        Self {
            points: match rank {
                None => scaled.collect(),
                Some(rank) => scatter(scaled, rank),
            },
            faces: ordered_faces(mesh.triangles(), count, rank, workers),
            flags,
            attributes: match rank {
                None => attributes.clone(),
                Some(rank) => Attributes {
                    normals: attributes.normals.as_ref().map(|n| scatter(n.iter().copied(), rank)),
                    colors: attributes.colors.as_ref().map(|c| scatter(c.iter().copied(), rank)),
                    uvs: attributes.uvs.as_ref().map(|uv| scatter(uv.iter().copied(), rank)),
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
            offsets: Vec::new(),
            incidence: Vec::new(),
            scale,
        }
    }

    /// Positions are the input's times this.
    pub(crate) fn scale(&self) -> f32 {
        self.scale
    }

    /// Builds the rings, in time linear in the faces. Within a ring, corners are in face order.
    pub(crate) fn build_rings(&mut self, workers: &Workers) {
        let vertices = self.points.len();
        let Self { faces, offsets, incidence, .. } = self;
        offsets.clear();
        offsets.resize(vertices + 1, 0);
        if incidence.len() > faces.len() {
            incidence.truncate(faces.len());
        } else {
            incidence.resize_with(faces.len(), Face::default);
        }
        // Each worker owns a range of vertices and passes over the faces; blocks of faces that do
        // not touch its range are skipped, which in an ordered mesh is nearly all of them.
        let ranges = if vertices > VERTEX_BLOCK { workers.count() } else { 1 };
        let bound = |range: usize| range * vertices / ranges;
        let spans: Vec<(u32, u32)> = if ranges == 1 {
            vec![(0, NONE); faces.len().div_ceil(FACE_BLOCK)]
        } else {
            workers.map(faces.chunks(FACE_BLOCK).collect(), span)
        };
        let touching = |first: u32, last: u32| {
            let blocks = faces.chunks(FACE_BLOCK).zip(&spans).enumerate();
            blocks
                .filter(move |(_, (_, span))| span.0 < last && span.1 >= first)
                .map(|(index, (block, _))| (index * FACE_BLOCK, block))
        };
        let pieces = split(&mut offsets[..vertices], (1..ranges).map(bound));
        let sums = workers.map(pieces.into_iter().enumerate().collect(), |(range, degrees)| {
            let first = bound(range) as u32;
            let own = degrees.len();
            for (_, block) in touching(first, first + own as u32) {
                for corner in block.iter().flatten() {
                    if let Some(degree) = degrees.get_mut(corner.load(Relaxed).wrapping_sub(first) as usize) {
                        *degree += 1;
                    }
                }
            }
            // Offsets count back from the end of each ring while the rings are filled.
            degrees.iter_mut().fold(0, |sum, degree| {
                *degree += sum;
                *degree
            })
        });
        let starts: Vec<u32> =
            sums.iter().scan(0, |sum, count| Some(std::mem::replace(sum, *sum + count))).collect();
        offsets[vertices] = sums.iter().sum();
        let pieces = split(&mut offsets[..vertices], (1..ranges).map(bound));
        let rings = split(incidence.as_flattened_mut(), starts.iter().skip(1).map(|&start| start as usize));
        let pieces = pieces.into_iter().zip(rings).enumerate().collect();
        workers.map(pieces, |(range, (offsets, ring)): (usize, (&mut [u32], &mut [AtomicU32]))| {
            let first = bound(range) as u32;
            let last = first + offsets.len() as u32;
            let blocks: Vec<_> = touching(first, last).collect();
            for (base, block) in blocks.into_iter().rev() {
                for (index, face) in block.iter().enumerate().rev() {
                    for (corner, vertex) in face.iter().enumerate() {
                        let vertex = vertex.load(Relaxed).wrapping_sub(first) as usize;
                        if let Some(end) = offsets.get_mut(vertex) {
                            *end -= 1;
                            *ring[*end as usize].get_mut() = ((base + index) as u32) << 2 | corner as u32;
                        }
                    }
                }
            }
            for offset in offsets {
                *offset += starts[range];
            }
        });
    }

    /// Gives vertices their [`flag::BOUNDARY`], and locks them if asked; buries those without a
    /// face, and counts these. Needs the rings.
    pub(crate) fn classify(&mut self, lock_boundary: bool, workers: &Workers) -> usize {
        let Self { faces, flags, offsets, incidence, merged, .. } = self;
        let incidence = incidence.as_flattened();
        let (faces, offsets) = (&faces[..], &offsets[..]);
        let blocks: Vec<(usize, &mut [u8])> = flags.chunks_mut(VERTEX_BLOCK).enumerate().collect();
        let unreferenced = workers.map(blocks, |(block, flags)| {
            let first = block * VERTEX_BLOCK;
            let mut unreferenced = 0;
            for (flags, ends) in flags.iter_mut().zip(offsets[first..].windows(2)) {
                let ring = &incidence[ends[0] as usize..ends[1] as usize];
                if is_open(faces, ring.iter().map(|corner| corner.load(Relaxed))) {
                    *flags |= flag::BOUNDARY | if lock_boundary { flag::LOCKED } else { 0 };
                }
                if ring.is_empty() {
                    *flags |= flag::DEAD;
                    unreferenced += 1;
                }
            }
            unreferenced
        });
        for (merged, flags) in merged.iter_mut().zip(flags) {
            if *flags & flag::DEAD != 0 {
                *merged = NONE;
            }
        }
        unreferenced.into_iter().sum()
    }

    /// The whole surface as one tile.
    pub(crate) fn whole(&mut self) -> Tile<'_> {
        self.tiles(std::iter::empty()).remove(0)
    }

    /// The surface cut into tiles before each of the vertices `cuts`, which ascend.
    pub(crate) fn tiles(&mut self, cuts: impl Iterator<Item = usize>) -> Vec<Tile<'_>> {
        let Attributes { normals, colors, uvs } = &mut self.attributes;
        let columns = Columns {
            points: &mut self.points,
            flags: &mut self.flags,
            merged: &mut self.merged,
            absorbed: &mut self.absorbed,
            normals: normals.as_deref_mut().unwrap_or_default(),
            colors: colors.as_deref_mut().unwrap_or_default(),
            uvs: uvs.as_deref_mut().unwrap_or_default(),
        };
        let shared = Shared {
            faces: &self.faces,
            offsets: &self.offsets,
            incidence: self.incidence.as_flattened(),
            sources: self.sources.as_deref().unwrap_or_default(),
        };
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

    /// Drops dead vertices and faces, keeping the order of the others, and ends the pass: no
    /// vertex is used any more. The rings are lost.
    pub(crate) fn compact(&mut self, workers: &Workers) {
        let Self {
            points, faces, flags, attributes, merged, absorbed, origins, sources, offsets: map, ..
        } = self;
        map.clear();
        map.reserve(points.len());
        let mut kept = 0;
        map.extend(flags.iter().map(|flags| {
            let dead = flags & flag::DEAD != 0;
            let successor = if dead { NONE } else { kept };
            kept += u32::from(!dead);
            successor
        }));
        if let Some(origins) = origins {
            for origin in origins.iter_mut().filter(|origin| **origin != NONE) {
                *origin = last_merged(merged, *origin).map_or(NONE, |vertex| map[vertex as usize]);
            }
            merged.clear();
            merged.extend(0..kept);
        }
        retain_alive(points, flags);
        sources.iter_mut().for_each(|sources| retain_alive(sources, flags));
        let Attributes { normals, colors, uvs } = attributes;
        normals.iter_mut().for_each(|normals| retain_alive(normals, flags));
        colors.iter_mut().for_each(|colors| retain_alive(colors, flags));
        uvs.iter_mut().for_each(|uvs| retain_alive(uvs, flags));
        flags.retain(|flags| flags & flag::DEAD == 0);
        if !absorbed.is_empty() {
            absorbed.clear();
            absorbed.resize(flags.len(), NONE);
        }
        flags.iter_mut().for_each(|flags| *flags &= !flag::USED);

        // Blocks of faces are packed in place side by side, and then moved together.
        let map = &map[..];
        let length = faces.len().div_ceil(workers.count()).max(1);
        let counts = workers.map(faces.chunks_mut(length).collect(), |block| pack_faces(block, map));
        let mut kept = 0;
        for (index, count) in counts.into_iter().enumerate() {
            let first = index * length;
            if first != kept {
                (0..count).for_each(|face| faces.swap(kept + face, first + face));
            }
            kept += count;
        }
        faces.truncate(kept);
    }

    /// The surface as a mesh in the scale of the input, without vertices that no face uses. If no
    /// vertex has moved and the sources are known, positions and attributes are those of `input`, bit for
    /// bit.
    pub(crate) fn to_mesh(&self, unmoved: Option<&Mesh>) -> Result<Remains, MeshError> {
        let mut map = vec![NONE; self.points.len()];
        let alive = || self.faces.iter().filter(|face| is_alive(face));
        alive().flatten().for_each(|corner| map[corner.load(Relaxed) as usize] = 0);
        let count = map.iter().filter(|successor| **successor == 0).count();
        let mut used = Vec::with_capacity(count);
        for (successor, vertex) in map.iter_mut().zip(0..).filter(|(successor, _)| **successor == 0) {
            *successor = used.len() as u32;
            used.push(vertex);
        }
        let mut triangles = Vec::with_capacity(alive().count());
        triangles
            .extend(alive().map(|face| face.each_ref().map(|corner| map[corner.load(Relaxed) as usize])));
        let sources = self.sources.as_ref().map(|sources| select(sources, &used));
        let (positions, attributes) = match (unmoved, &sources) {
            (Some(input), Some(sources)) => {
                (select(input.positions(), sources), input.attributes().select(sources))
            }
            _ => (self.positions(&used), self.attributes.select(&used)),
        };
        let into =
            |origin: &u32| last_merged(&self.merged, *origin).map_or(NONE, |vertex| map[vertex as usize]);
        let origins = match (&self.origins, &self.collapses, &sources, unmoved) {
            (None, Some(collapses), Some(sources), Some(input)) => {
                Some(origins(collapses, sources, input.positions().len()))
            }
            (tracked, ..) => tracked.as_ref().map(|origins| origins.iter().map(into).collect()),
        };
        Ok(Remains { mesh: Mesh::with_attributes(positions, triangles, attributes)?, origins, sources })
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

    /// What [`restore`](Self::restore) needs to come back to a compacted surface as it is.
    pub(crate) fn snapshot(&self) -> Snapshot {
        let corners = |face: &Face| face.each_ref().map(|corner| corner.load(Relaxed));
        Snapshot {
            points: self.points.clone(),
            faces: self.faces.iter().map(corners).collect(),
            flags: self.flags.clone(),
            attributes: self.attributes.clone(),
            origins: self.origins.clone(),
            sources: self.sources.clone(),
            collapses: self.collapses.clone(),
        }
    }

    /// Back to a snapshot. Rings are lost.
    pub(crate) fn restore(&mut self, snapshot: Snapshot) {
        if self.origins.is_some() {
            self.merged = (0..snapshot.points.len() as u32).collect();
        }
        self.points = snapshot.points;
        self.faces = snapshot.faces.into_iter().map(|face| face.map(AtomicU32::new)).collect();
        self.flags = snapshot.flags;
        self.attributes = snapshot.attributes;
        self.origins = snapshot.origins;
        self.sources = snapshot.sources;
        self.collapses = snapshot.collapses;
    }

    /// Gives the rings' memory back.
    pub(crate) fn drop_rings(&mut self) {
        self.offsets = Vec::new();
        self.incidence = Vec::new();
    }
}

/// Moves the living faces of a block to its front, their corners renamed by `map`: how many.
fn pack_faces(block: &mut [Face], map: &[u32]) -> usize {
    let mut kept = 0;
    for index in 0..block.len() {
        let [a, b, c] = block[index].each_ref().map(|corner| corner.load(Relaxed));
        // Written always and counted if alive: as fast as the memory, where a branch would miss.
        for (corner, into) in [a, b, c].into_iter().zip(&mut block[kept]) {
            *into.get_mut() = map[corner as usize];
        }
        kept += usize::from(a != b);
    }
    kept
}

/// Whether a face has not been collapsed.
#[inline(always)]
pub(crate) fn is_alive(face: &Face) -> bool {
    face[0].load(Relaxed) != face[1].load(Relaxed)
}

/// The corners after and before `corner`, which is `face << 2 | corner`.
#[inline(always)]
pub(crate) fn neighbours(faces: &[Face], corner: u32) -> (u32, u32) {
    const NEXT: [usize; 4] = [1, 2, 0, 0];
    const PREVIOUS: [usize; 4] = [2, 0, 1, 0];
    let face = &faces[(corner >> 2) as usize];
    let corner = (corner & 3) as usize;
    (face[NEXT[corner]].load(Relaxed), face[PREVIOUS[corner]].load(Relaxed))
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
fn last_merged(merged: &[u32], origin: u32) -> Option<u32> {
    let mut vertex = origin;
    while vertex != NONE && merged[vertex as usize] != vertex {
        vertex = merged[vertex as usize];
    }
    (vertex != NONE).then_some(vertex)
}

/// Faces looked at for the scale.
const SAMPLES: usize = 1024;

/// A power of two that makes edges about one unit long: products of four of them and more then
/// neither overflow nor vanish in single precision, however fine or large the mesh.
pub(crate) fn unit_scale(mesh: &Mesh) -> f32 {
    let position = |vertex: u32| Vec3::from(mesh.positions()[vertex as usize]).as_dvec3();
    let longest = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(position);
        (b - a).length().max((c - b).length()).max((a - c).length())
    };
    let stride = mesh.triangles().len().div_ceil(SAMPLES).max(1);
    let sampled = mesh.triangles().iter().step_by(stride).map(longest);
    let mut lengths: Vec<f64> = sampled.filter(|&length| length > 0.0).collect();
    if lengths.is_empty() {
        return 1.0;
    }
    let middle = lengths.len() / 2;
    let (_, &mut length, _) = lengths.select_nth_unstable_by(middle, f64::total_cmp);
    let exponent = -length.log2().floor();
    // The bits of numbers that are not negative order as these do, and compare four at a time.
    let largest = mesh.positions().as_flattened().iter().map(|x| x.abs().to_bits().cast_signed()).max();
    let room = |largest: f32| 100.0 - f64::from(largest).log2().ceil();
    let mut room_left = room(f32::from_bits(largest.unwrap_or(0).cast_unsigned()));
    if room_left < exponent {
        // Vertices that no triangle uses must not set the scale.
        let used = mesh.triangles().as_flattened().iter().flat_map(|&v| mesh.positions()[v as usize]);
        room_left = room(used.map(f32::abs).fold(0.0, f32::max));
    }
    f32::exp2(exponent.min(room_left).clamp(-126.0, 126.0) as f32)
}

/// `values[v]` goes to `rank[v]`.
fn scatter<T: Copy + Default>(values: impl ExactSizeIterator<Item = T>, rank: &[u32]) -> Vec<T> {
    let mut scattered = vec![T::default(); rank.len()];
    for (value, &place) in values.zip(rank) {
        scattered[place as usize] = value;
    }
    scattered
}

/// The triangles with three corners, renamed by `rank`, if there is one, and then sorted into
/// buckets of 64 vertices by their first corner, so that faces lie in memory as their vertices do.
fn ordered_faces(
    triangles: &[[u32; 3]],
    vertices: usize,
    rank: Option<&[u32]>,
    workers: &Workers,
) -> Vec<Face> {
    let whole = |triangle: &&[u32; 3]| is_face(triangle);
    let Some(rank) = rank else {
        let mut faces = Vec::with_capacity(triangles.iter().filter(whole).count());
        faces.extend(triangles.iter().filter(whole).map(|triangle| triangle.map(AtomicU32::new)));
        return faces;
    };
    // Each worker counts and then places the triangles of a block; within a bucket, blocks follow
    // each other, so that the order is the same for any number of them.
    let renamed = |vertex: u32| rank[vertex as usize];
    let bucket = |triangle: &[u32; 3]| (renamed(triangle[0]) >> 6) as usize;
    let blocks: Vec<_> = triangles.chunks(triangles.len().div_ceil(workers.count()).max(1)).collect();
    let mut counts = workers.map(blocks.clone(), |block| {
        let mut counts = vec![0u32; (vertices >> 6) + 1];
        block.iter().filter(whole).for_each(|triangle| counts[bucket(triangle)] += 1);
        counts
    });
    let mut count = 0;
    for bucket in 0..=vertices >> 6 {
        for counts in &mut counts {
            count += std::mem::replace(&mut counts[bucket], count);
        }
    }
    let mut faces = Vec::new();
    faces.resize_with(count as usize, Face::default);
    let places = &faces[..];
    workers.map(blocks.into_iter().zip(counts).collect(), |(block, mut starts)| {
        for triangle in block.iter().filter(whole) {
            let start = &mut starts[bucket(triangle)];
            for (corner, &vertex) in places[*start as usize].iter().zip(triangle) {
                corner.store(renamed(vertex), Relaxed);
            }
            *start += 1;
        }
    });
    faces
}

/// The smallest and the largest vertex of the faces.
fn span(faces: &[Face]) -> (u32, u32) {
    let corners = faces.iter().flatten().map(|corner| corner.load(Relaxed));
    corners.fold((NONE, 0), |(low, high), corner| (low.min(corner), high.max(corner)))
}

/// Cuts a slice before each of `cuts`, which ascend.
fn split<T>(slice: &mut [T], cuts: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let mut pieces = Vec::new();
    let (mut rest, mut first) = (slice, 0);
    for cut in cuts {
        let (piece, tail) = rest.split_at_mut(cut - first);
        pieces.push(piece);
        (rest, first) = (tail, cut);
    }
    pieces.push(rest);
    pieces
}

/// Moves the values of living vertices to the front.
fn retain_alive<T: Copy>(values: &mut Vec<T>, flags: &[u8]) {
    let mut kept = 0;
    // Written always and counted if alive, as in `pack_faces`.
    for (index, flags) in flags.iter().enumerate() {
        values[kept] = values[index];
        kept += usize::from(flags & flag::DEAD == 0);
    }
    values.truncate(kept);
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
