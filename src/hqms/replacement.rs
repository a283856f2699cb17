//! One pass of the paper's selection: replacement selection through a heap of a few records.
//!
//! Section 3 of the paper. The three substages of section 3.3 are the three steps of generating
//! sorted runs: the first `records` vertices fill the heap, each further one pushes out the
//! cheapest, and in the end the heap is emptied. The contraction flags of Table 2 are: 0, the ring
//! is empty; 1, unmodified; 2, part of a collapse of this pass; 3, `MAXDEG` faces or more.
//!
//! Departures. Rings are the compact ones of the surface rather than arrays of `MAXDEG` indices a
//! vertex (34 bytes a triangle instead of the paper's 66); the largest degree is a rule still.
//! Faces weigh as their area, and a collapse must be legal as everywhere in this house: the paper
//! has neither rule, and loses borders and folds faces without them. The last thousand vertices are
//! left to the finish, as they are in the default: an order of 15 records would lose the corners of
//! flat-faced solids.

use super::goal::Goal;
use crate::collapse::surface::{Surface, flag};
use crate::collapse::tile::{Scratch, Tile};
use crate::collapse::{Counts, Rules};
use crate::monitor::Cancelled;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The paper's bound on the faces of a ring (section 4.1).
const MAXDEG: usize = 20;
/// Vertices between two looks at the monitor.
const BATCH: u32 = 1 << 18;

/// A contraction record `C(r(v_i))`: the bits of its cost, the vertex and the neighbour.
type Record = Reverse<(u32, u32, u32)>;

/// One pass; one level of approximation.
pub(crate) fn pass(
    surface: &mut Surface,
    records: usize,
    counts: Counts,
    goal: Goal,
    rules: &Rules,
    report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
) -> Result<Counts, Cancelled> {
    let mut tile = surface.whole();
    tile.find_rings();
    let mut scratch = Scratch::default();
    let mut heap: BinaryHeap<Record> = BinaryHeap::with_capacity(records.min(tile.vertices().len()) + 1);
    let mut removed = Counts::default();
    let has_wedges = tile.has_wedges();
    let mut spent = 0;
    let excess = goal.excess(counts);
    for vertex in tile.vertices() {
        if vertex % BATCH == 0 {
            report(removed)?;
        }
        let Some(record) = contraction(&tile, vertex, rules, &mut scratch) else { continue };
        heap.push(record);
        if heap.len() > records
            && let Some(record) = heap.pop()
        {
            let counts = execute(&mut tile, record, rules, &mut scratch);
            removed.add(counts);
            spent += goal.measure_at_most(counts, has_wedges);
        }
        if spent >= excess {
            break;
        }
    }
    while spent < excess
        && let Some(record) = heap.pop()
    {
        let counts = execute(&mut tile, record, rules, &mut scratch);
        removed.add(counts);
        spent += goal.measure_at_most(counts, has_wedges);
    }
    let collapses = tile.into_collapses();
    surface.remember(collapses);
    Ok(removed)
}

/// Whether the contraction flag of `vertex` is 1.
fn is_unmodified(tile: &Tile, vertex: u32) -> bool {
    tile.flags(vertex) & (flag::USED | flag::DEAD) == 0 && (1..MAXDEG).contains(&tile.degree(vertex))
}

/// The optimal contraction of a ring: section 3.3, steps 1 to 3.
fn contraction(tile: &Tile, vertex: u32, rules: &Rules, scratch: &mut Scratch) -> Option<Record> {
    if !is_unmodified(tile, vertex)
        || tile.flags(vertex) & flag::LOCKED != 0
        || !tile.gather(vertex, tile.corners(vertex), &mut scratch.source)
    {
        return None;
    }
    // Two rings share the faces of the edge, mostly two.
    let joined = |neighbour| tile.degree(vertex) + tile.degree(neighbour) - 2;
    let eligible = |neighbour| is_unmodified(tile, neighbour) && joined(neighbour) < MAXDEG;
    let (cost, neighbour) = if rules.half_edge {
        tile.cheapest_target(tile.corners(vertex), f32::INFINITY, scratch)
            .filter(|&(_, neighbour)| eligible(neighbour))?
    } else {
        scratch.source.cheapest_neighbour(eligible)?
    };
    Some(Reverse((cost.to_bits(), vertex, neighbour)))
}

/// Executes a record, unless an earlier one has modified one of its vertices: what that removes.
fn execute(tile: &mut Tile, record: Record, rules: &Rules, scratch: &mut Scratch) -> Counts {
    let Reverse((_, source, target)) = record;
    let can = is_unmodified(tile, source)
        && is_unmodified(tile, target)
        && tile.gather(source, tile.corners(source), &mut scratch.source);
    if can { tile.collapse(target, rules, scratch).unwrap_or_default() } else { Counts::default() }
}
