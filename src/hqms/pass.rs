//! One pass of the default selection: every collapse cheaper than a sampled quantile.
//!
//! Section 3.3 of the paper streams the vertices through a heap of 15 records and executes what
//! comes out. So small a heap gives nearly no global order: the measured error is half as much
//! again as that of a full sort. A threshold that is a quantile of all costs, estimated from a few thousand of them,
//! gives the order of a full sort for the price of a comparison, and needs no record at all.
//! What is kept of the paper's pipeline: quadrics from the faces of the pass alone, the cost at the
//! neighbour with the placement solved only when a collapse is executed, each vertex in at most
//! one collapse a pass, the vertices visited in their order.

use super::goal::Goal;
use crate::collapse::surface::{Surface, flag};
use crate::collapse::tile::{Scratch, Tile};
use crate::collapse::{Counts, Rules};
use crate::monitor::Cancelled;
use crate::workers::Workers;
use multiversion::multiversion;

/// Vertices in a tile: large enough that few rings leave it, small enough to fit the cache and to
/// give every thread several.
pub(crate) const TILE: usize = 16384;
/// Tiles between two looks at the monitor.
const BATCH: usize = 32;
/// A share of the vertices below which a pass is slow: tiles are then given up, in case it is
/// their borders that hold the rest.
const SLOW: f32 = 0.02;
/// The share of the vertices whose costs lie below a threshold, while the surface is more than
/// [`FAR`] times larger than the goal, and near it. Far from the goal a coarse order does: what is
/// taken too early would be taken later anyway. A smaller share near the goal makes 2 to 4 % less
/// error than 0.5 and takes three passes more.
const FAR: f32 = 2.5;
const SHARE_FAR: f32 = 0.8;
const SHARE_NEAR: f32 = 0.3;
/// Where vertices stay, a target may absorb several, and one pass does more: with a larger share the error
/// rises by 0 to 4 %, and a pass is saved.
const SHARE_NEAR_HALF_EDGE: f32 = 0.5;
/// The share of what is left to remove that a pass aims at, so that the last one is a small one.
const AIM: f32 = 0.8;
/// Costs looked at for a threshold, and where a smaller share of the vertices is to go than [`SMALL`], so
/// that the threshold is as sharp there.
const SAMPLES: usize = 4096;
const MANY_SAMPLES: usize = 16384;
const SMALL: f32 = 0.1;
/// Of fewer vertices one in so many is looked at, and one in so many where they stay, as a rough threshold does
/// there, but not fewer than these.
const SPARSE: usize = 8;
const SPARSE_HALF_EDGE: usize = 24;
const FEW_SAMPLES: usize = 512;
/// The most by which a threshold rises after a productive pass, and the share of the vertices that
/// such a pass removes. On scans costs rise by 4 to 8 a pass.
const RISE: f32 = 16.0;
const PRODUCTIVE: f32 = 0.1;
/// The share of the vertices whose costs lie below the price of a surface.
#[cfg(feature = "io")]
const PRICED: f32 = 0.25;
/// No vertex has this cost: the bits of costs are below it.
const UNUSABLE: u32 = u32::MAX;

/// The state that a run carries from pass to pass.
pub(crate) struct Threshold {
    passes: usize,
    /// Collapses of the last pass as a share of those below its threshold.
    yielded: f32,
    slow: bool,
    /// The bits of the last threshold, and whether its pass removed enough that more may be found
    /// near it.
    threshold: u32,
    productive: bool,
}

impl Threshold {
    pub(crate) fn new() -> Self {
        Self { passes: 0, yielded: 0.5, slow: false, productive: false, threshold: 0 }
    }

    /// One pass. Removes at most the goal's excess.
    pub(crate) fn pass(
        &mut self,
        surface: &mut Surface,
        counts: Counts,
        goal: Goal,
        rules: &Rules,
        workers: &Workers,
        report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
    ) -> Result<Counts, Cancelled> {
        let vertices = surface.points.len();
        let far = goal.ratio(counts).is_some_and(|ratio| ratio > FAR);
        let share = match (far, rules.half_edge) {
            (true, _) => SHARE_FAR,
            (false, true) => SHARE_NEAR_HALF_EDGE,
            (false, false) => SHARE_NEAR,
        };
        let wanted = goal.collapses(counts) as f32 / vertices as f32;
        let mut samples = sample(surface, wanted < SMALL, rules, workers);
        if rules.may_relax && seams_hold(surface, &samples, goal, counts) {
            surface.cross_seams();
            samples = sample(surface, wanted < SMALL, rules, workers);
        }
        let usable =
            samples.iter().filter(|(_, cost)| *cost < UNUSABLE).count() as f32 / samples.len() as f32;
        let quantile = f32::min(share * usable, AIM * wanted / self.yielded.max(0.5));
        let threshold = self.restrain(threshold(&samples, quantile));
        let single = vertices < 2 * TILE || self.slow;
        let shift = if self.passes % 2 == 1 { TILE / 2 } else { 0 };
        let cuts = (1..).map(|tile| tile * TILE - shift).take_while(|&cut| !single && cut < vertices);
        let tiles = surface.tiles(cuts, workers);
        let budgets = budgets(&tiles, &samples, threshold, goal, goal.excess(counts));

        let mut removed = Counts::default();
        let mut collapses = Vec::new();
        let mut work: Vec<(Tile, usize)> = tiles.into_iter().zip(budgets).collect();
        while !work.is_empty() {
            let batch = work.drain(..BATCH.min(work.len())).collect();
            let sweep = |(mut tile, budget): (Tile, usize)| {
                tile.find_rings();
                let removed = sweep(&mut tile, threshold, goal, budget, rules);
                (removed, tile.into_collapses())
            };
            for (of_tile, more) in workers.map(batch, sweep) {
                removed.add(of_tile);
                collapses.extend(more);
            }
            report(removed)?;
        }
        surface.remember(collapses);
        let share = removed.vertices as f32 / vertices as f32;
        self.yielded = (share / quantile).clamp(0.05, 0.7);
        self.slow = share < SLOW;
        self.threshold = threshold;
        self.productive = share > PRODUCTIVE;
        self.passes += 1;
        Ok(removed)
    }

    /// A threshold rises slowly while passes are productive. On a solid of flat faces a quantile
    /// would climb into the edges while half the faces can still be had for nothing, as each pass
    /// leaves a half over.
    fn restrain(&self, threshold: u32) -> u32 {
        let highest = f32::from_bits(self.threshold) * RISE;
        if self.productive { threshold.min(highest.to_bits()) } else { threshold }
    }
}

/// Vertices strided over the surface, many or some, with their costs. Those that cannot collapse,
/// or could not in the last pass, are [`UNUSABLE`]: they would pull the threshold down to what is
/// never executed.
fn sample(surface: &mut Surface, many: bool, rules: &Rules, workers: &Workers) -> Vec<(u32, u32)> {
    let vertices = surface.points.len();
    let most = if many { MANY_SAMPLES } else { SAMPLES };
    let sparse = if rules.half_edge { SPARSE_HALF_EDGE } else { SPARSE };
    let count = (vertices / sparse).clamp(FEW_SAMPLES.min(vertices), most);
    let rings = surface.sampled_rings(count, workers);
    let count = rings.count();
    let tile = &surface.whole();
    let blocks: Vec<_> = (0..count).step_by(1024).map(|first| first..(first + 1024).min(count)).collect();
    let of_blocks = workers.map(blocks, |block| {
        let mut scratch = Scratch::default();
        block
            .map(|index| {
                let (vertex, corners) = (rings.vertex(index), rings.around(index));
                let cost = cost(tile, (vertex, corners), flag::BLOCKED, f32::INFINITY, rules, &mut scratch);
                (vertex, cost.map_or(UNUSABLE, |(cost, _)| cost))
            })
            .collect::<Vec<_>>()
    });
    of_blocks.concat()
}

/// What the collapses cost that come next: the cost that a few of the vertices that can go do not exceed, as
/// a cheap collapse here and there says nothing; infinity where none can go. In the scale of the surface.
#[cfg(feature = "io")]
pub(super) fn price(surface: &mut Surface, rules: &Rules, workers: &Workers) -> f32 {
    let mut costs: Vec<u32> =
        sample(surface, true, rules, workers).into_iter().map(|(_, cost)| cost).collect();
    costs.retain(|&cost| cost < UNUSABLE);
    let index = (costs.len() as f32 * PRICED) as usize;
    costs.sort_unstable();
    costs.get(index).map_or(f32::INFINITY, |&cost| f32::from_bits(cost))
}

/// Whether more vertices have nowhere to go, because several seams meet at them, than the goal leaves: what is
/// so at one pass is so at the next.
fn seams_hold(surface: &Surface, samples: &[(u32, u32)], goal: Goal, counts: Counts) -> bool {
    let flags = |vertex: u32| surface.flags[vertex as usize];
    let alive = samples.iter().filter(|(vertex, _)| flags(*vertex) & flag::DEAD == 0).count();
    let is_held = |&&(vertex, cost): &&(u32, u32)| {
        cost == UNUSABLE
            && flags(vertex) & (flag::SEAM | flag::LOCKED | flag::PROTECTED | flag::BLOCKED) == flag::SEAM
    };
    let held = samples.iter().filter(is_held).count();
    surface.keeps_seams() && goal.ratio(counts).is_some_and(|ratio| held as f32 * ratio > alive as f32)
}

/// The bits of the cost that `quantile` of the samples do not exceed, and one more.
fn threshold(samples: &[(u32, u32)], quantile: f32) -> u32 {
    let mut costs: Vec<u32> = samples.iter().map(|&(_, cost)| cost).collect();
    let index = ((costs.len() as f32 * quantile) as usize).min(costs.len() - 1);
    let (_, &mut threshold, _) = costs.select_nth_unstable(index);
    threshold.saturating_add(1)
}

/// The cost with these bits, or infinity.
fn as_cost(threshold: u32) -> f32 {
    f32::from_bits(threshold.min(f32::INFINITY.to_bits()))
}

/// The bits of the cheapest cost of a vertex that may be a source, which has these `corners`, and the neighbour
/// it is at. What costs `limit` or more need not be found.
#[inline(always)]
fn cost(
    tile: &Tile,
    (vertex, corners): (u32, &[u32]),
    unusable: u8,
    limit: f32,
    rules: &Rules,
    scratch: &mut Scratch,
) -> Option<(u32, u32)> {
    if tile.flags(vertex) & (flag::USED | flag::DEAD | flag::LOCKED | unusable) != 0
        || !tile.gather(vertex, corners, &mut scratch.source)
    {
        return None;
    }
    let cheapest = if rules.half_edge {
        tile.cheapest_target(corners, limit, scratch)
    } else {
        scratch.source.cheapest_neighbour(|_| true)
    };
    cheapest.map(|(cost, neighbour)| (cost.to_bits(), neighbour))
}

/// Shares the excess among the tiles as the samples below the threshold are, so that no thread
/// needs to know what the others do and the goal is never overshot.
fn budgets(tiles: &[Tile], samples: &[(u32, u32)], threshold: u32, goal: Goal, excess: usize) -> Vec<usize> {
    if let [_] = tiles {
        return vec![excess];
    }
    let mut chosen =
        samples.iter().filter(|(_, cost)| *cost < threshold).map(|(vertex, _)| *vertex).peekable();
    let weights: Vec<f64> = tiles
        .iter()
        .map(|tile| {
            let mut weight = 0.5;
            while chosen.next_if(|vertex| tile.vertices().contains(vertex)).is_some() {
                weight += 1.0;
            }
            weight
        })
        .collect();
    let sum: f64 = weights.iter().sum();
    let share = |weight: &f64| (excess as f64 * weight / sum) as usize / goal.step() * goal.step();
    weights.iter().map(share).collect()
}

/// Collapses what is below the threshold in a tile, in the order of its vertices. This is where the time goes:
/// compiled once more for processors with wider instructions, which round the same.
#[multiversion(targets("x86_64+avx2+bmi1+bmi2+popcnt"))]
fn sweep(tile: &mut Tile, threshold: u32, goal: Goal, budget: usize, rules: &Rules) -> Counts {
    let mut scratch = Scratch::default();
    let mut removed = Counts::default();
    let mut spent = 0;
    let limit = as_cost(threshold);
    for vertex in tile.vertices() {
        if spent + goal.step() > budget {
            break;
        }
        let found = cost(tile, (vertex, tile.corners(vertex)), 0, limit, rules, &mut scratch);
        let Some((cost, neighbour)) = found else { continue };
        tile.unblock(vertex);
        if cost >= threshold {
            continue;
        }
        let target = if rules.half_edge || tile.is_unused(neighbour) {
            Some(neighbour)
        } else {
            let second = scratch.source.cheapest_neighbour(|neighbour| tile.is_unused(neighbour));
            second.filter(|(cost, _)| cost.to_bits() < threshold).map(|(_, neighbour)| neighbour)
        };
        if let Some(target) = target
            && let Some(counts) = tile.collapse(target, rules, &mut scratch)
        {
            removed.add(counts);
            spent += goal.measure_at_most(counts, tile.has_wedges());
        }
    }
    removed
}

/// One pass that takes the cheapest collapses in their order, each vertex at most once: for the
/// last tenth of a large surface, where a threshold would be too coarse.
pub(crate) fn ranked_pass(
    surface: &mut Surface,
    counts: Counts,
    goal: Goal,
    rules: &Rules,
    workers: &Workers,
) -> Counts {
    let wanted = goal.collapses(counts);
    // Most fail because a neighbour was used before.
    let enough = 6 * wanted + 64;
    let quantile = 1.5 * enough as f32 / surface.points.len() as f32;
    let limit = if rules.half_edge && quantile < 1.0 {
        as_cost(threshold(&sample(surface, true, rules, workers), quantile))
    } else {
        f32::INFINITY
    };
    let mut tile = surface.whole();
    tile.find_rings();
    let mut candidates = Vec::new();
    {
        let tile = &tile;
        let blocks: Vec<_> = tile.vertices().step_by(TILE).collect();
        let of_blocks = workers.map(blocks, |first| {
            let mut scratch = Scratch::default();
            let block = first..(first + TILE as u32).min(tile.vertices().end);
            let cost = |vertex| {
                let (cost, _) = cost(tile, (vertex, tile.corners(vertex)), 0, limit, rules, &mut scratch)?;
                (cost < limit.to_bits()).then_some((cost, vertex))
            };
            block.filter_map(cost).collect::<Vec<_>>()
        });
        of_blocks.into_iter().for_each(|block| candidates.extend(block));
    }
    if enough < candidates.len() {
        candidates.select_nth_unstable(enough);
        candidates.truncate(enough);
    }
    candidates.sort_unstable();
    let mut scratch = Scratch::default();
    let mut removed = Counts::default();
    let mut spent = 0;
    for (_, vertex) in candidates {
        if spent >= goal.excess(counts) {
            break;
        }
        let found = cost(&tile, (vertex, tile.corners(vertex)), 0, f32::INFINITY, rules, &mut scratch);
        if let Some((_, neighbour)) = found
            && let Some(counts) = tile.collapse(neighbour, rules, &mut scratch)
        {
            removed.add(counts);
            spent += goal.measure_at_most(counts, tile.has_wedges());
        }
    }
    let collapses = tile.into_collapses();
    surface.remember(collapses);
    removed
}
