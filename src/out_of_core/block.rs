//! A block in memory, and what is done to it there.
//!
//! Vertices that are shared with other blocks stay, bit for bit, and so do all that are joined to one by an
//! edge. The second is what keeps the whole a manifold: a block cannot see that an edge it makes between two
//! shared vertices is made in another block as well. As it is, no collapse makes one: of its two vertices
//! neither is joined to a shared one. So what the link condition says of the block is true of the whole.

use super::OutOfCoreError;
use super::journal::{Block, Directory, Done, Part};
use super::stored::{Appended, Columns, Ranked, Stored, Triangles, Vertices, vertex_of};
use super::vertex_set::{VertexBits, VertexSet};
use crate::hqms::{Options, Target, Topology, prices, simplify};
use crate::io::ply::Carried;
use crate::mesh::{Mesh, select};
use crate::monitor::Monitor;

/// From one price to the next, a block loses so much of its triangles...
const STEP: f64 = 0.5;
/// ...down to so much less than the whole is to: a part that is flat goes further than the whole.
const DEPTH: f64 = 1.0 / 8.0;
/// No block is followed to fewer triangles.
const FEWEST: usize = 16;

/// A block in memory.
pub(super) struct Loaded {
    mesh: Mesh,
    /// For each vertex its index in the whole mesh.
    names: Vec<u32>,
    ranks: Vec<u32>,
    /// Those that stay.
    locked: Vec<u32>,
}

impl Loaded {
    /// The block of a round whose triangles begin with the one of index `first`.
    pub(super) fn new(
        stored: &Stored,
        round: usize,
        block: &Block,
        first: usize,
        shared: &VertexSet,
        directory: &Directory,
    ) -> Result<Self, OutOfCoreError> {
        let mut own = VertexBits::new(0..stored.vertices);
        let mut triangles = Vec::with_capacity(block.triangles);
        let mut on_disk = Triangles::open(&directory.path(Part::Blocks, round), first, block.triangles)?;
        while let Some(corners) = on_disk.next()? {
            corners.iter().for_each(|&vertex| own.insert(vertex));
            triangles.push(corners);
        }
        let own = VertexSet::new(own);
        let mut names = Vec::with_capacity(own.count());
        names.extend(own.iter());
        for vertex in triangles.as_flattened_mut() {
            // All corners were put in.
            *vertex = own.place(*vertex).unwrap_or_default();
        }
        drop(own);
        let mut vertices =
            Vertices::open(&directory.path(Part::Vertices, round), stored.carried, stored.vertices, 0)?;
        let mut columns = Columns::new(stored.carried, names.len());
        names.iter().try_for_each(|&name| vertices.get(name).map(|bytes| columns.push(bytes)))?;

        let Ranked { mesh, ranks, order } = columns.into_mesh(triangles)?;
        let names = select(&names, &order);

        let is_shared: Vec<bool> = names.iter().map(|&name| shared.place(name).is_some()).collect();
        let mut stays = vec![false; names.len()];
        for corners in
            mesh.triangles().iter().filter(|corners| corners.iter().any(|&v| is_shared[v as usize]))
        {
            corners.iter().for_each(|&vertex| stays[vertex as usize] = true);
        }
        let locked = (0..).zip(stays).filter(|(_, stays)| *stays).map(|(vertex, _)| vertex).collect();
        Ok(Self { mesh, names, ranks, locked })
    }

    /// The engine's options for the block.
    ///
    /// Seams between attributes are kept closed where both sides lie in the block, and it cannot be seen where
    /// they do not: so all borders stay, until all of the mesh is in one block.
    fn options(&mut self, options: &Options, target: Target) -> Options {
        let may_have_seams = *self.mesh.attributes() != Default::default() && options.keep_seams;
        Options {
            target,
            topology: Topology::Keep,
            lock_boundary: options.lock_boundary || may_have_seams,
            locked: std::mem::take(&mut self.locked),
            track_sources: true,
            ..options.clone()
        }
    }

    /// What the block costs on the way from all of it to less than `share` of it.
    pub(super) fn prices(
        mut self,
        options: &Options,
        share: f64,
        monitor: &mut Monitor,
    ) -> Result<Vec<(usize, f32)>, OutOfCoreError> {
        let all = self.mesh.triangles().len();
        let least = ((all as f64 * share * DEPTH) as usize).max(FEWEST);
        let counts = std::iter::successors(Some(all), |&count| Some((count as f64 * STEP) as usize));
        let counts: Vec<usize> = counts.skip(1).take_while(|&count| count >= least).collect();
        let options = self.options(options, Target::Ratio(1.0));
        let mut prices = prices(&self.mesh, &options, &counts, monitor)?;
        // What cannot be met is met no further.
        prices.dedup_by_key(|(count, _)| *count);
        for (_, price) in &mut prices {
            // JSON has no infinity.
            *price = price.clamp(-1000.0, 1000.0);
        }
        Ok(prices)
    }

    /// Simplifies the block to `goal` triangles and appends what is left, with the vertices that are of this
    /// block alone, to `rest`.
    pub(super) fn simplify(
        mut self,
        options: &Options,
        goal: usize,
        shared: &VertexSet,
        rest: Rest,
        monitor: &mut Monitor,
    ) -> Result<Done, OutOfCoreError> {
        let options = self.options(options, Target::Triangles(goal));
        let Self { mesh, names, ranks, .. } = self;
        let result = simplify(&mesh, &options, monitor)?;
        drop((mesh, options));
        let mut own = 0;
        let mut indices = Vec::with_capacity(result.mesh.positions().len());
        for (vertex, source) in result.sources.iter().flatten().enumerate() {
            let index = match shared.place(names[*source as usize]) {
                Some(index) => index as usize,
                None => {
                    let rank = ranks[*source as usize];
                    rest.vertices.vertex(rank, &vertex_of(&result.mesh, vertex), rest.carried)?;
                    own += 1;
                    rest.next + own - 1
                }
            };
            indices.push(index as u32);
        }
        for corners in result.mesh.triangles() {
            rest.triangles.triangle(corners.map(|vertex| indices[vertex as usize]))?;
        }
        Ok(Done { triangles: result.mesh.triangles().len(), vertices: own, error: result.error })
    }
}

/// Where what is left of a block goes.
pub(super) struct Rest<'a> {
    pub(super) vertices: &'a mut Appended,
    pub(super) triangles: &'a mut Appended,
    pub(super) carried: Carried,
    /// The index of the next vertex that is appended.
    pub(super) next: usize,
}
