//! A round: the mesh is cut into blocks, these are simplified, and what is left is the mesh of the next round.

use std::ops::{ControlFlow, Range};

use super::OutOfCoreError;
use super::block::{Loaded, Rest};
use super::cut::{cut, read_shared};
use super::journal::{Directory, Journal, Part, Round};
use super::memory::Memory;
use super::shares::{Prices, shares};
use super::stored::{Appended, Stored, TRIANGLE, Vertices, vertex_bytes};
use super::vertex_set::VertexSet;
use crate::hqms::Options;
use crate::monitor::Monitor;

/// How much of a round cutting takes, and finding out prices, about.
const CUTTING: f32 = 0.2;
const PRICING: f32 = 0.5;

/// A shared vertex keeps about four triangles as they are. So that these are at most a quarter of what a round
/// leaves, and blocks do not pay for their seams with all else, it leaves this many for each shared vertex...
const PER_SHARED: f64 = 16.0;
/// ...but does not stop before this share of the triangles.
const LEAST_WORK: f64 = 0.7;

/// A monitor for a part of the work.
pub(super) fn part<'a>(monitor: &'a mut Monitor<'_>, share: Range<f32>) -> Monitor<'a> {
    Monitor::new(move |fraction| match monitor.report(share.start + (share.end - share.start) * fraction) {
        Ok(()) => ControlFlow::Continue(()),
        Err(_) => ControlFlow::Break(()),
    })
}

/// All that a round needs beside the mesh.
pub(super) struct Setting<'a> {
    pub(super) options: &'a Options,
    pub(super) memory: Memory,
    pub(super) directory: &'a Directory,
}

/// Begins a round, or goes on with it, and finishes it.
pub(super) fn run(
    stored: &Stored,
    round: usize,
    goal: usize,
    journal: &mut Journal,
    setting: &Setting,
    monitor: &mut Monitor,
) -> Result<(), OutOfCoreError> {
    let Setting { options, memory, directory } = *setting;
    if journal.rounds.len() == round {
        let mut cut = cut(stored, round, goal, &memory, directory, &mut part(monitor, 0.0..CUTTING))?;
        let seams = (PER_SHARED * cut.shared as f64).min(LEAST_WORK * stored.triangles as f64);
        cut.goal = cut.goal.max(seams as usize);
        journal.rounds.push(cut);
        directory.save(journal)?;
    }
    // The blocks have them all.
    directory.remove(Part::Triangles, round)?;
    let blocks = journal.rounds[round].blocks.len();
    let first = |round: &Round, block: usize| round.blocks[..block].iter().map(|b| b.triangles).sum();
    let shared = read_shared(stored.vertices, round, directory)?;
    let share = |from: f32, to: f32, block: usize| {
        let at = |block: usize| from + (to - from) * block as f32 / blocks as f32;
        at(block)..at(block + 1)
    };

    let ratio = journal.rounds[round].goal as f64 / stored.triangles.max(1) as f64;
    for block in 0..blocks {
        let record = &journal.rounds[round];
        if !record.blocks[block].prices.is_empty() {
            continue;
        }
        let mut monitor = part(monitor, share(CUTTING, PRICING, block));
        let loaded =
            Loaded::new(stored, round, &record.blocks[block], first(record, block), &shared, directory)?;
        let prices = loaded.prices(options, ratio, &mut monitor)?;
        journal.rounds[round].blocks[block].prices = prices;
        directory.save(journal)?;
    }

    let record = &journal.rounds[round];
    let prices: Vec<&Prices> = record.blocks.iter().map(|block| block.prices.as_slice()).collect();
    let shares = shares(&prices, record.goal);
    let goal = |record: &Round, block: usize| {
        // What the blocks before have missed or left is for this one.
        let wanted: usize = shares[..=block].iter().sum();
        let wanted = if block + 1 == blocks { wanted.max(record.goal) } else { wanted };
        wanted.saturating_sub(record.triangles())
    };
    let [mut vertices, mut triangles] = open_next(stored, round, record, &shared, directory)?;
    for block in 0..blocks {
        let record = &journal.rounds[round];
        if record.blocks[block].done.is_some() {
            continue;
        }
        let mut monitor = part(monitor, share(PRICING, 1.0, block));
        let loaded =
            Loaded::new(stored, round, &record.blocks[block], first(record, block), &shared, directory)?;
        let (goal, next) = (goal(record, block), record.vertices());
        let rest = Rest { vertices: &mut vertices, triangles: &mut triangles, carried: stored.carried, next };
        let done = loaded.simplify(options, goal, &shared, rest, &mut monitor)?;
        vertices.sync()?;
        triangles.sync()?;
        journal.rounds[round].blocks[block].done = Some(done);
        directory.save(journal)?;
    }
    Ok(())
}

/// The files of the next round, with all that the journal says is done: at the beginning, this is the vertices
/// that are shared.
fn open_next(
    stored: &Stored,
    round: usize,
    record: &Round,
    shared: &VertexSet,
    directory: &Directory,
) -> Result<[Appended; 2], OutOfCoreError> {
    let path = directory.path(Part::Vertices, round + 1);
    let triangles_path = directory.path(Part::Triangles, round + 1);
    let mut triangles = Appended::open(&triangles_path, record.triangles() * TRIANGLE)?;
    if record.blocks.iter().any(|block| block.done.is_some()) {
        let vertices = Appended::open(&path, record.vertices() * vertex_bytes(stored.carried))?;
        return Ok([vertices, triangles]);
    }
    let mut vertices = Appended::open(&path, 0)?;
    let mut old = Vertices::open(&directory.path(Part::Vertices, round), stored.carried, stored.vertices, 0)?;
    for vertex in shared.iter() {
        vertices.bytes(old.get(vertex)?)?;
    }
    vertices.sync()?;
    triangles.sync()?;
    Ok([vertices, triangles])
}
