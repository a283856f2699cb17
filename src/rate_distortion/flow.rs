//! At which slope each vertex goes: all rates at once, by letting distortion flow from children to parents.
//!
//! Balmelli, Vetterli and Liebling, section 2.1, remove the merging domain with the least slope, distortion over
//! rate, again and again, and update the domains of all ancestors after each. That walks down the lower convex hull
//! of all pairs of rate and distortion that sets of vertices can have, if a set holds with each vertex all of its
//! descendants. As distortion is additive (`distortion.rs`), the hull is that of a maximum-closure problem in a
//! graph in which no vertex has more than two parents, and is found for all slopes at once, as an isotonic
//! regression: the numbers `x` nearest to the vertices' own distortions in the sense of least squares for which no
//! vertex has less than its children.
//!
//! Its dual is a flow from children to parents: `x` of a vertex is its own distortion, plus what its children give,
//! less what it gives. A *star* is a vertex with its children. The best flow in a star for given surroundings is
//! known in closed form: children that have more than the parent are levelled with it, as water would be. Sweeps of
//! this up and down the levels converge quickly, and at any time there is a proof of how good the result is:
//!
//! **The certificate.** In a set with `k` vertices removed, flows inside cancel; what flows out of the set came
//! from nowhere else, since flows go to parents and removed sets hold all descendants. So the distortion of each
//! such set is at least the sum of its `x`, which is at least the sum of the `k` smallest `x` of all.

use super::layout::Layout;
use crate::workers::Workers;

/// More than any distortion: vertices that must not go. Sums of five of them are still finite.
pub(crate) const NEVER: f32 = f32::MAX / 16.0;

/// A hierarchy, by its stars: vertices with their children.
pub(crate) trait Hierarchy {
    /// How many levels there are; children of level `l` are on level `l + 1`.
    fn levels(&self) -> u32;

    /// Does an operation on the stars of all vertices of a level that is not the last. Stars that have a child in
    /// common must come in an order that no number of threads changes.
    fn stars<O: Operation>(&self, level: u32, flow: &mut Flow, workers: &Workers);
}

/// What is done with a star of two or four children.
pub(crate) trait Operation {
    /// Takes what the parent and its children have and what they give to it, and says what they have and give then.
    fn on<const N: usize>(parent: f32, slopes: [f32; N], given: [f32; N]) -> (f32, [f32; N], [f32; N]);
}

/// What each vertex has, and what it gives to its parents.
#[derive(Debug, Clone)]
pub(crate) struct Flow {
    pub(crate) slopes: Vec<f32>,
    /// To the first and to the second parent.
    pub(crate) given: [Vec<f32>; 2],
}

impl Flow {
    /// No flow at all, of vertices with these changes of distortion; infinite for those that must not go.
    pub(crate) fn new(hierarchy: &impl Hierarchy, deltas: &[f32], workers: &Workers) -> Self {
        let slopes = workers.list(deltas.len(), |vertex| deltas[vertex].clamp(-NEVER, NEVER));
        let mut flow = Self { slopes, given: [vec![0.0; deltas.len()], vec![0.0; deltas.len()]] };
        // What must stay keeps all that it hangs on: what lies below such a vertex flows around it.
        if flow.slopes.contains(&NEVER) {
            flow.up::<Keep>(hierarchy, workers);
        }
        flow
    }

    /// Levels all stars twice, from the finest to the coarsest and back.
    pub(crate) fn sweep_twice(&mut self, hierarchy: &impl Hierarchy, workers: &Workers) {
        self.up::<Level>(hierarchy, workers);
        (1..hierarchy.levels()).for_each(|level| hierarchy.stars::<Level>(level, self, workers));
    }

    /// What each vertex has, raised to what its descendants have, so that each goes after them.
    pub(crate) fn raised(&mut self, hierarchy: &impl Hierarchy, workers: &Workers) -> Vec<f32> {
        let slopes = workers.list(self.slopes.len(), |vertex| self.slopes[vertex]);
        self.up::<Raise>(hierarchy, workers);
        std::mem::replace(&mut self.slopes, slopes)
    }

    fn up<O: Operation>(&mut self, hierarchy: &impl Hierarchy, workers: &Workers) {
        (1..hierarchy.levels()).rev().for_each(|level| hierarchy.stars::<O>(level, self, workers));
    }
}

/// The larger of two; which of the two, if one is no number, does not matter here, and asking costs.
#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The level of a star: what the parent has once children that have more are levelled with it.
///
/// That is the largest mean of the parent and any of its children, and the mean with the k largest is the largest
/// of those with k.
#[inline(always)]
fn level_of<const N: usize>(parent: f32, mut children: [f32; N]) -> f32 {
    let mut sort = |i: usize, j: usize| {
        let (a, b) = (children[i], children[j]);
        (children[i], children[j]) = (larger(a, b), smaller(a, b));
    };
    // A sorting network, the largest first.
    match N {
        2 => sort(0, 1),
        4 => {
            sort(0, 1);
            sort(2, 3);
            sort(0, 2);
            sort(1, 3);
            sort(1, 2);
        }
        _ => unreachable!("a star has two or four children"),
    }
    const PARTS: [f32; 5] = [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0];
    let (mut level, mut sum) = (parent, parent);
    for (child, part) in children.into_iter().zip(&PARTS[1..]) {
        sum += child;
        level = larger(level, sum * part);
    }
    level
}

/// Levels a star.
struct Level;

impl Operation for Level {
    #[inline(always)]
    fn on<const N: usize>(parent: f32, slopes: [f32; N], given: [f32; N]) -> (f32, [f32; N], [f32; N]) {
        // As if nothing were given yet.
        let parent = parent - given.into_iter().reduce(|a, b| a + b).unwrap_or(0.0);
        let have: [f32; N] = std::array::from_fn(|i| slopes[i] + given[i]);
        let level = level_of(parent, have);
        let keep = have.map(|have| smaller(have, level));
        (level, keep, std::array::from_fn(|i| have[i] - keep[i]))
    }
}

/// Keeps the parent of a child that must not go.
struct Keep;

impl Operation for Keep {
    #[inline(always)]
    fn on<const N: usize>(parent: f32, slopes: [f32; N], given: [f32; N]) -> (f32, [f32; N], [f32; N]) {
        let is_needed = slopes.iter().any(|&slope| slope >= NEVER);
        (if is_needed { NEVER } else { parent }, slopes, given)
    }
}

/// Raises the parent to its children.
struct Raise;

impl Operation for Raise {
    #[inline(always)]
    fn on<const N: usize>(parent: f32, slopes: [f32; N], given: [f32; N]) -> (f32, [f32; N], [f32; N]) {
        (slopes.into_iter().fold(parent, larger), slopes, given)
    }
}

/// Levels with fewer vertices than this are not worth a trip to another thread.
const LEAST_PARALLEL: usize = 1 << 13;

impl Hierarchy for Layout {
    fn levels(&self) -> u32 {
        Layout::levels(self)
    }

    fn stars<O: Operation>(&self, level: u32, flow: &mut Flow, workers: &Workers) {
        let [columns, _] = self.squares(level);
        let pair = 2 * columns + 1;
        let workers = if self.level(level).len() < LEAST_PARALLEL { &Workers::Caller } else { workers };
        if level % 2 == 1 {
            // Rows of centres next to each other have a row of children in common.
            for row in [0, 1] {
                let bands =
                    Band::of(self, level, flow).skip(row * columns, row * pair).cut(2 * columns, 2 * pair);
                workers.map(bands, |mut band| band.centres::<O>(columns));
            }
            return;
        }
        // Two rows of edges beside one row of centres, one horizontal and one vertical, have children in common.
        let centres = 2 * columns;
        let mut first = Band::of(self, level, flow);
        first.slopes = &mut first.slopes[..centres];
        first.rim::<O>(0);
        let horizontal = Band::of(self, level, flow).skip(pair, centres).cut(pair, 2 * centres);
        workers.map(horizontal, |mut band| match band.slopes.len() == 2 * centres {
            true => band.axis::<O>(centres, false),
            false => band.rim::<O>(1),
        });
        let vertical = Band::of(self, level, flow).skip(columns, 0).cut(pair, 2 * centres);
        workers.map(vertical, |mut band| band.axis::<O>(centres, true));
    }
}

/// A part of a level of a grid, and what lies below it: the parents, and the children with what they give to their
/// first and to their second parents.
struct Band<'a> {
    parents: &'a mut [f32],
    slopes: &'a mut [f32],
    given: [&'a mut [f32]; 2],
}

impl<'a> Band<'a> {
    fn of(layout: &Layout, level: u32, flow: &'a mut Flow) -> Self {
        let (parents, children) = (layout.level(level), layout.level(level + 1));
        let (above, below) = flow.slopes.split_at_mut(children.start);
        Self {
            parents: &mut above[parents],
            slopes: &mut below[..children.len()],
            given: flow.given.each_mut().map(|given| &mut given[children.clone()]),
        }
    }

    /// Without the first `parents` parents and `children` children.
    fn skip(self, parents: usize, children: usize) -> Self {
        let Self { parents: all, slopes, given } = self;
        Self {
            parents: &mut all[parents..],
            slopes: &mut slopes[children..],
            given: given.map(|given| &mut given[children..]),
        }
    }

    /// Bands that start `parents` parents and `children` children apart.
    fn cut(self, parents: usize, children: usize) -> Vec<Self> {
        let [first, second] = self.given.map(|given| given.chunks_mut(children));
        let below = self.slopes.chunks_mut(children).zip(first.zip(second));
        let both = self.parents.chunks_mut(parents).zip(below);
        both.map(|(parents, (slopes, (first, second)))| Self { parents, slopes, given: [first, second] })
            .collect()
    }

    /// The star of a parent, and of children that give to it as to their first (0) or second (1).
    #[inline(always)]
    fn star<O: Operation, const N: usize>(&mut self, parent: usize, children: [(usize, usize); N]) {
        let slopes = children.map(|(child, _)| self.slopes[child]);
        let given = children.map(|(child, slot)| self.given[slot][child]);
        let (level, slopes, given) = O::on(self.parents[parent], slopes, given);
        self.parents[parent] = level;
        for (i, (child, slot)) in children.into_iter().enumerate() {
            self.slopes[child] = slopes[i];
            self.given[slot][child] = given[i];
        }
    }

    /// The stars of a row of `columns` centres, whose children are on the edges above, left, right and below.
    fn centres<O: Operation>(&mut self, columns: usize) {
        let (left, below) = (columns, 2 * columns + 1);
        // Neighbours share a child. Every second one is done first, so that none waits for the one before.
        for start in [0, 1] {
            for i in (start..columns).step_by(2) {
                self.star::<O, 4>(i, [(i, 1), (below + i, 0), (left + i, 1), (left + i + 1, 0)]);
            }
        }
    }

    /// The stars of a row of midpoints between two rows of `centres` centres, which are their children. Those of
    /// vertical edges start and end at the rim.
    fn axis<O: Operation>(&mut self, centres: usize, vertical: bool) {
        let rim = usize::from(vertical);
        let inner = rim..rim + centres / 2 - rim;
        let (upper, lower) = self.slopes.split_at_mut(centres);
        let [lower_given, upper_given] = &mut self.given;
        let upper = pairs_of(&mut upper[rim..]).iter_mut().zip(pairs_of(&mut upper_given[rim..centres]));
        let lower = pairs_of(&mut lower[rim..]).iter_mut().zip(pairs_of(&mut lower_given[centres + rim..]));
        let children = upper.zip(lower);
        for (parent, ((upper, upper_given), (lower, lower_given))) in
            self.parents[inner.clone()].iter_mut().zip(children)
        {
            let joined = |upper: [f32; 2], lower: [f32; 2]| [upper[0], upper[1], lower[0], lower[1]];
            let (level, slopes, given) =
                O::on(*parent, joined(*upper, *lower), joined(*upper_given, *lower_given));
            *parent = level;
            (*upper, *lower) = ([slopes[0], slopes[1]], [slopes[2], slopes[3]]);
            (*upper_given, *lower_given) = ([given[0], given[1]], [given[2], given[3]]);
        }
        if vertical {
            self.star::<O, 2>(0, [(0, 1), (centres, 0)]);
            self.star::<O, 2>(inner.end, [(centres - 1, 1), (2 * centres - 1, 0)]);
        }
    }

    /// The stars of a row of midpoints at the rim, with one row of children, which give by `slot`.
    fn rim<O: Operation>(&mut self, slot: usize) {
        for parent in 0..self.slopes.len() / 2 {
            self.star::<O, 2>(parent, [(2 * parent, slot), (2 * parent + 1, slot)]);
        }
    }
}

/// A row, two by two; what is left over at its end is not part of it.
fn pairs_of(row: &mut [f32]) -> &mut [[f32; 2]] {
    row.as_chunks_mut().0
}

/// How little distortion a set of vertices of some size can make at least: the sum of as many of the smallest
/// slopes (see the [module](self)).
///
/// Slopes are counted by their leading bits, which takes no sorting; of the last of them that count, each is taken
/// as the least with these bits, by which the bound is at most a hundredth of those too low.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Certificate {
    /// How many slopes there are below each class and in it, and what their sum is.
    sums: Vec<(u64, f64)>,
}

/// How many leading bits a class is made of: sign, exponent and seven of the fraction.
const CLASS_BITS: u32 = 16;

/// Slopes are counted so many at a time, each time in a table of its own.
const PART: usize = 1 << 21;

fn class(slope: f32) -> usize {
    (rank(slope) >> (32 - CLASS_BITS)) as usize
}

/// A class that slopes are in.
#[cfg(feature = "io")]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Class {
    pub(crate) number: u32,
    /// How many slopes there are in it and in those before, and their sum.
    pub(crate) count: u64,
    pub(crate) sum: f64,
}

#[cfg(feature = "io")]
impl Certificate {
    /// How many classes there are.
    pub(crate) const CLASSES: u32 = 1 << CLASS_BITS;

    /// The classes that slopes are in, in their order.
    pub(crate) fn classes(&self) -> Vec<Class> {
        let mut before = 0;
        let classes = self.sums.iter().zip(0..).filter(|((count, _), _)| {
            let is_new = *count > before;
            before = *count;
            is_new
        });
        classes.map(|(&(count, sum), number)| Class { number, count, sum }).collect()
    }

    /// From classes whose numbers, below 2^16, and whose counts grow.
    pub(crate) fn of_classes(classes: &[Class]) -> Self {
        let mut sums = vec![(0, 0.0); 1 << CLASS_BITS];
        let ends = classes.iter().skip(1).map(|class| class.number as usize).chain([sums.len()]);
        let parts: Vec<_> = classes.iter().zip(ends).collect();
        for (class, end) in parts {
            sums[class.number as usize..end].fill((class.count, class.sum));
        }
        Self { sums }
    }
}

impl Certificate {
    /// From slopes that are not raised.
    pub(crate) fn new(slopes: &[f32], workers: &Workers) -> Self {
        let counted = workers.map(slopes.chunks(PART).collect(), |slopes: &[f32]| {
            let mut sums = vec![(0, 0.0); 1 << CLASS_BITS];
            for &slope in slopes {
                let (count, sum) = &mut sums[class(slope)];
                *count += 1;
                *sum += f64::from(slope);
            }
            sums
        });
        let mut parts = counted.into_iter();
        let mut sums = parts.next().unwrap_or_else(|| vec![(0, 0.0); 1 << CLASS_BITS]);
        for part in parts {
            for ((count, sum), (more, added)) in sums.iter_mut().zip(part) {
                *count += more;
                *sum += added;
            }
        }
        let (mut all, mut total) = (0, 0.0);
        for (count, sum) in &mut sums {
            all += *count;
            total += *sum;
            (*count, *sum) = (all, total);
        }
        Self { sums }
    }

    /// Nothing is known: what is least may be 0.
    pub(crate) fn none() -> Self {
        Self { sums: Vec::new() }
    }

    /// How many slopes there are.
    fn count(&self) -> u64 {
        self.sums.last().map_or(0, |&(count, _)| count)
    }

    /// The least distortion that `removed` vertices can make.
    pub(crate) fn bound(&self, removed: usize) -> f64 {
        let removed = removed as u64;
        let class = self.sums.partition_point(|&(count, _)| count <= removed);
        let (whole, sum) = match class.checked_sub(1) {
            Some(before) => self.sums[before],
            None => (0, 0.0),
        };
        if whole == removed || class >= self.sums.len() {
            return sum;
        }
        sum + (removed - whole) as f64 * f64::from(of_rank((class as u32) << (32 - CLASS_BITS)))
    }
}

/// Sweeps until it is known that at some rate the distortion is no more than so many decibels above the least one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Effort {
    /// Sweeps before the first look, and between two; even.
    pub(crate) sweeps: u32,
    /// The most of them.
    pub(crate) most: u32,
    /// In decibels.
    pub(crate) gap: f64,
}

/// The slopes at which the vertices with these changes of distortion go, none less than that of a child, and the
/// proof of how good they are. `report` hears of the part of the sweeps that is done, and may end it.
pub(crate) fn solve<E>(
    hierarchy: &impl Hierarchy,
    deltas: &[f32],
    effort: &Effort,
    workers: &Workers,
    mut report: impl FnMut(f32) -> Result<(), E>,
) -> Result<(Vec<f32>, Certificate), E> {
    let mut flow = Flow::new(hierarchy, deltas, workers);
    let mut done = 0;
    loop {
        for _ in 0..effort.sweeps.div_ceil(2).max(1) {
            flow.sweep_twice(hierarchy, workers);
            done += 2;
            report(done as f32 / effort.most.max(done) as f32)?;
        }
        let certificate = Certificate::new(&flow.slopes, workers);
        let slopes = flow.raised(hierarchy, workers);
        if done >= effort.most || gap(deltas, &slopes, &certificate, workers) <= effort.gap {
            return Ok((slopes, certificate));
        }
    }
}

/// The part of the vertices that is left where the gap is looked at.
const WATCHED: f64 = 0.2;

/// By how many decibels the distortion is above the bound where about a fifth of the vertices is left.
fn gap(deltas: &[f32], slopes: &[f32], certificate: &Certificate, workers: &Workers) -> f64 {
    // The slope below which that many are: by classes, as they are, for which nothing is sorted.
    let raised = Certificate::new(slopes, workers);
    let wanted = ((1.0 - WATCHED) * raised.count() as f64) as u64;
    let last = raised.sums.partition_point(|&(count, _)| count < wanted);
    let parts = slopes.chunks(PART).zip(deltas.chunks(PART)).collect();
    let summed = workers.map(parts, |(slopes, deltas): (&[f32], &[f32])| {
        let all = slopes.iter().zip(deltas);
        let gone = all.filter(|&(&slope, _)| class(slope) <= last && slope < NEVER);
        gone.fold((0, 0.0), |(count, sum), (_, &delta)| (count + 1, sum + f64::from(delta)))
    });
    let (removed, distortion) =
        summed.into_iter().fold((0, 0.0), |all, part| (all.0 + part.0, all.1 + part.1));
    decibels(distortion, certificate.bound(removed))
}

/// How far a distortion is above a lower bound of it, in decibels.
pub(crate) fn decibels(distortion: f64, bound: f64) -> f64 {
    match distortion > bound {
        true if bound > 0.0 => 10.0 * (distortion / bound).log10(),
        true => f64::INFINITY,
        false => 0.0,
    }
}

/// The bits of a number, such that they are ordered as the numbers are.
pub(crate) fn rank(value: f32) -> u32 {
    // Both zeros are one.
    let bits = (value + 0.0).to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The number with such bits.
pub(crate) fn of_rank(rank: u32) -> f32 {
    f32::from_bits(if rank >> 31 == 1 { rank & !(1 << 31) } else { !rank })
}
