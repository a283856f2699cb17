//! A run: passes until the target is near, then the finish.

use super::finish::Finish;
use super::goal::Goal;
use super::order::rank;
#[cfg(feature = "io")]
use super::pass::price;
use super::pass::{TILE, Threshold, ranked_pass};
use super::refine::refine;
use super::{
    AttributeWeights, Options, Placement, Selection, Simplified, SimplifyError, StoppedBy, Target, Topology,
    replacement,
};
use crate::collapse::surface::{Remains, Setting, Snapshot, Surface, Track, flag};
use crate::collapse::{Counts, Rules};
use crate::mesh::Mesh;
use crate::mesh::places::places;
use crate::mesh::weld::seams;
use crate::monitor::{Cancelled, Monitor};
use crate::workers::Workers;
use glam::Vec3A;
use std::borrow::Cow;
use std::ops::Range;

/// The finish begins when the surface is this many times larger than the goal: with 1.5 the error is the same
/// within 1 %, and small meshes take twice as long, or three times...
const FINISH_RATIO: f32 = 1.05;
/// ...or this many times where vertices stay, and if no more than one vertex in so many is left, which makes its
/// time a small part of the whole, this many...
const FINISH_RATIO_HALF_EDGE: f32 = 1.15;
const FINISH_SHARE: usize = 16;
const FINISH_RATIO_SMALL_PART: f32 = 1.5;
/// ...and has at most so many vertices: its heap takes ten times as long as a pass.
const FINISH_VERTICES: usize = 12_000;
/// Fewer tiles than this are the work of one thread.
const FEW_TILES: usize = 4;
/// So few vertices are finished however far the goal is; so many where vertices stay.
const FEW_VERTICES: usize = 1000;
const FEW_VERTICES_HALF_EDGE: usize = 1000;
/// A run may have to come back to where the surface was this many times larger than the goal.
const STUCK_RATIO: f32 = 10.0;
/// At more vertices than this, the way back is not kept: it takes memory, and so large a surface
/// does not get stuck before its end.
const STUCK_VERTICES: usize = 50_000;
/// Below this share of its vertices to remove, a surface that is too large for the finish ends
/// with a ranked pass.
const RANKED_SHARE: f32 = 0.1;
/// Where vertices stay, a surface that is small enough for the finish goes there after a pass that removes a
/// smaller share of the vertices, and less than half of what is left to remove: passes to come would do ever
/// less, at the same price.
const SLOW: f32 = 0.15;
/// A pass that removes a smaller share of the vertices makes no progress worth another.
const STALLED: f32 = 0.002;

/// How far a vertex may be placed outside the bounds of the input, as a share of their diagonal.
const OVERSHOOT: f32 = 0.25;

/// The share of the time that a run takes before the refinement.
const REFINE_BEGINS: f32 = 0.65;

/// A simplification under way.
pub(crate) struct Run<'a> {
    options: &'a Options,
    /// Needed to the end where no vertex moves or the result is fitted to it, and only there.
    input: Option<Cow<'a, Mesh>>,
    /// Of the input.
    triangles: usize,
    vertices: usize,
    surface: Surface,
    counts: Counts,
    workers: Workers,
    /// Where vertices may be placed.
    extent: [Vec3A; 2],
    threshold: Threshold,
    locked: usize,
    passes: usize,
    topology_changed: bool,
}

impl<'a> Run<'a> {
    /// A mesh of its own is given up as soon as it may be.
    pub(crate) fn new(mesh: Cow<'a, Mesh>, options: &'a Options) -> Result<Self, SimplifyError> {
        check(&mesh, options)?;
        let half_edge = moves_no_vertex(options);
        let places = if half_edge && options.keep_seams { places(&mesh) } else { None };
        let rank = rank(&mesh, places.as_ref(), TILE / 8);
        // Waking others takes longer than they would save.
        let threads = if mesh.positions().len() < FEW_TILES * TILE { 1 } else { options.threads };
        let workers = Workers::new(threads)?;
        let mut locked = options.locked.clone();
        if options.keep_seams && !half_edge {
            locked.extend(seams(&mesh));
        }
        let setting = Setting {
            rank: rank.as_deref(),
            locked: &locked,
            track: Track {
                origins: options.track_origins || options.refine,
                sources: options.track_sources || half_edge,
                collapses: options.track_collapses || options.track_origins && half_edge,
            },
            half_edge,
            places: places.as_ref(),
            groups: options.groups.as_deref(),
            weights: options.attribute_weights,
            cross_seams: options.cross_seams,
            protected: &options.protected,
            prioritized: &options.prioritized,
        };
        let (triangles, vertices) = (mesh.triangles().len(), mesh.positions().len());
        let (mut surface, input) = if half_edge || options.refine {
            (Surface::new(Cow::Borrowed(&mesh), &setting, &workers), Some(mesh))
        } else {
            (Surface::new(mesh, &setting, &workers), None)
        };
        drop((rank, places));
        surface.classify(options.lock_boundary, &workers);
        let counts = Counts { faces: surface.faces.len(), vertices: surface.vertex_count() };
        let locked = surface.flags.iter().filter(|flags| *flags & flag::LOCKED != 0).count();
        let extent = if half_edge { [Vec3A::NEG_INFINITY, Vec3A::INFINITY] } else { extent(&surface) };
        Ok(Self {
            options,
            input,
            triangles,
            vertices,
            surface,
            counts,
            workers,
            extent,
            threshold: Threshold::new(),
            locked,
            passes: 0,
            topology_changed: false,
        })
    }

    /// Goes on until `target` is met, or cannot be. What is reported lies in `share`.
    pub(crate) fn reach(
        &mut self,
        target: Target,
        share: Range<f32>,
        monitor: &mut Monitor,
    ) -> Result<StoppedBy, SimplifyError> {
        check_target(target)?;
        let goal = Goal::new(target, self.triangles);
        let rules = self.rules(target, goal);
        self.recount(goal);
        let start = self.counts;
        let mut report = |counts: Counts| {
            monitor.report(share.start + (share.end - share.start) * progress(goal, start, counts))
        };
        report(self.counts)?;
        let mut checkpoint = None;
        self.approach(goal, &rules, &mut checkpoint, &mut report)?;
        if let Some(checkpoint) = checkpoint.filter(|_| goal.excess(self.counts) > 0) {
            if self.surface.keeps_seams() {
                let rules = Rules { may_relax: false, ..rules };
                self.retry(goal, checkpoint.clone(), |run| {
                    run.surface.cross_seams();
                    run.approach(goal, &rules, &mut None, &mut report)
                })?;
            }
            if goal.excess(self.counts) > 0 {
                let rules = Rules { any_topology: true, ..rules };
                self.topology_changed |=
                    self.retry(goal, checkpoint, |run| run.finish(goal, &rules, &mut report))?;
            }
        }
        monitor.report(share.end)?;
        Ok(match goal {
            Goal::Fewest => StoppedBy::Error,
            _ if goal.excess(self.counts) == 0 => StoppedBy::Target,
            _ => StoppedBy::Stuck,
        })
    }

    fn rules(&self, target: Target, goal: Goal) -> Rules {
        let error_limit = match target {
            Target::MaxError(limit) => limit * self.surface.scale(),
            _ => f32::INFINITY,
        };
        Rules {
            any_topology: false,
            may_relax: self.options.topology == Topology::RelaxIfStuck && goal != Goal::Fewest,
            error_limit,
            half_edge: moves_no_vertex(self.options),
            extent: self.extent,
        }
    }

    /// How many triangles are left, and the binary logarithm of what the next collapses cost, in the units of the
    /// input: an area times a squared distance, which can be compared between parts of a surface.
    #[cfg(feature = "io")]
    pub(crate) fn price(&mut self) -> (usize, f32) {
        let target = Target::Triangles(self.counts.faces);
        let rules = self.rules(target, Goal::new(target, self.triangles));
        let price = price(&mut self.surface, &rules, &self.workers);
        (self.counts.faces, price.log2() - 4.0 * self.surface.scale().log2())
    }

    /// Passes until the goal is near, and the finish. Where the run may have to come back, `checkpoint` is then
    /// what to.
    fn approach(
        &mut self,
        goal: Goal,
        rules: &Rules,
        checkpoint: &mut Option<(Snapshot, Counts)>,
        report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
    ) -> Result<(), Cancelled> {
        let mut stalled = false;
        while goal.excess(self.counts) > 0 && !stalled && !self.is_near(goal) {
            if rules.may_relax && checkpoint.is_none() && self.may_get_stuck(goal) {
                *checkpoint = Some(self.checkpoint());
            }
            let (vertices, wanted) = (self.surface.points.len(), goal.collapses(self.counts));
            let removed = self.pass(goal, rules, report)?;
            let share = removed.vertices as f32 / vertices as f32;
            let slow = rules.half_edge && share < SLOW && 2 * removed.vertices < wanted;
            let finishes = slow && vertices <= FINISH_VERTICES && goal != Goal::Fewest;
            stalled = share < STALLED || finishes;
            self.surface.compact(&self.workers);
            self.counts.remove(removed);
            self.recount(goal);
            self.passes += 1;
            report(self.counts)?;
        }
        if goal.excess(self.counts) > 0 && (goal != Goal::Fewest || self.counts.vertices <= STUCK_VERTICES) {
            if rules.may_relax && checkpoint.is_none() {
                *checkpoint = Some(self.checkpoint());
            }
            self.finish(goal, rules, report)?;
        }
        Ok(())
    }

    /// What a run comes back to that gets stuck, or goes too far.
    pub(super) fn checkpoint(&mut self) -> (Snapshot, Counts) {
        self.surface.shrink();
        (self.surface.snapshot(), self.counts)
    }

    /// Makes an `attempt` from an earlier surface, and comes back if that leads no nearer to the goal; whether it
    /// does.
    fn retry(
        &mut self,
        goal: Goal,
        (snapshot, counts): (Snapshot, Counts),
        attempt: impl FnOnce(&mut Self) -> Result<(), Cancelled>,
    ) -> Result<bool, Cancelled> {
        let kept = (self.surface.snapshot(), self.counts);
        self.surface.restore(snapshot);
        self.counts = counts;
        attempt(self)?;
        let better = goal.excess(self.counts) < goal.excess(kept.1);
        if !better {
            self.surface.restore(kept.0);
            self.counts = kept.1;
        }
        Ok(better)
    }

    /// Whether what is left is for the finish. The paper's selection goes on by itself until so few
    /// vertices are left that its order would lose corners.
    fn is_near(&self, goal: Goal) -> bool {
        let vertices = self.counts.vertices;
        // The time of the finish is that of the surface's vertices, not of the result's.
        let (finished, few, finish_ratio) = if !moves_no_vertex(self.options) {
            (vertices, FEW_VERTICES, FINISH_RATIO)
        } else if vertices <= self.vertices / FINISH_SHARE {
            (self.surface.points.len(), FEW_VERTICES_HALF_EDGE, FINISH_RATIO_SMALL_PART)
        } else {
            (self.surface.points.len(), FEW_VERTICES_HALF_EDGE, FINISH_RATIO_HALF_EDGE)
        };
        let near = goal.ratio(self.counts).is_some_and(|ratio| ratio <= finish_ratio);
        let finishes_early = self.options.selection == Selection::SampledThreshold;
        finished <= few || finishes_early && near && vertices <= FINISH_VERTICES
    }

    fn pass(
        &mut self,
        goal: Goal,
        rules: &Rules,
        report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
    ) -> Result<Counts, Cancelled> {
        let Self { surface, counts, workers, threshold, .. } = self;
        let counts = *counts;
        let mut report = |removed| {
            let mut now = counts;
            now.remove(removed);
            report(now)
        };
        match self.options.selection {
            Selection::ReplacementSelection { records } => {
                replacement::pass(surface, records, counts, goal, rules, &mut report)
            }
            Selection::SampledThreshold => {
                let share = goal.collapses(counts) as f32 / surface.points.len() as f32;
                if share < RANKED_SHARE {
                    Ok(ranked_pass(surface, counts, goal, rules, workers))
                } else {
                    threshold.pass(surface, counts, goal, rules, workers, &mut report)
                }
            }
        }
    }

    /// Whether the surface is so small that the goal may be below what its topology allows. What
    /// the link condition does last is to ruin large parts for the sake of tiny ones: a run that
    /// then gives the condition up has to go back to before that.
    fn may_get_stuck(&self, goal: Goal) -> bool {
        let near = goal.ratio(self.counts).is_some_and(|ratio| ratio <= STUCK_RATIO);
        near && self.counts.vertices <= STUCK_VERTICES.min(self.vertices / 3)
    }

    fn finish(
        &mut self,
        goal: Goal,
        rules: &Rules,
        report: &mut dyn FnMut(Counts) -> Result<(), Cancelled>,
    ) -> Result<(), Cancelled> {
        self.counts = Finish::new(&mut self.surface, self.counts, rules).run(goal, report)?;
        self.surface.compact(&self.workers);
        self.recount(goal);
        self.passes += 1;
        Ok(())
    }

    /// Counts the vertices of the result anew, if they matter and a collapse may remove more than one: what a
    /// pass counts are those that went into others, and not those that were named by what vanished alone.
    fn recount(&mut self, goal: Goal) {
        if matches!(goal, Goal::Vertices(_)) && !self.surface.wedges.is_empty() {
            self.counts.vertices = self.surface.vertex_count();
        }
    }

    /// Back to a checkpoint.
    #[cfg(feature = "deviation")]
    pub(super) fn go_back(&mut self, (snapshot, counts): (Snapshot, Counts)) {
        self.surface.restore(snapshot);
        self.counts = counts;
    }

    /// Sets how much of a maximum error is spent at each vertex of `mesh`, which is the surface as it is now.
    #[cfg(feature = "deviation")]
    pub(super) fn spend(&mut self, mesh: &Mesh, spent: &[f32]) {
        self.surface.set_errors(mesh.triangles(), spent);
    }

    /// The share of the work that is done when the goal is reached.
    pub(crate) fn reached(&self) -> f32 {
        if self.options.refine { REFINE_BEGINS } else { 1.0 }
    }

    /// Fits what is left to the input, if that is asked for. What is reported lies in `share`.
    pub(crate) fn refine(&mut self, share: Range<f32>, monitor: &mut Monitor) -> Result<(), Cancelled> {
        let Some(input) = self.input.as_deref().filter(|_| self.options.refine) else { return Ok(()) };
        let report = |done| monitor.report(share.start + (share.end - share.start) * done);
        refine(&mut self.surface, input, self.extent, &self.workers, report)
    }

    /// The surface as it is now.
    pub(crate) fn result(&self, stopped_by: StoppedBy) -> Result<Simplified, SimplifyError> {
        let unmoved = self.input.as_deref().filter(|_| moves_no_vertex(self.options));
        let Remains { mesh, origins, sources, groups, surface_vertices } = self.surface.to_mesh(unmoved)?;
        let largest = self.surface.points.iter().map(|point| point.w).fold(0.0, f32::max);
        // On a surface as wide as numbers go, the estimate may lie beyond the largest.
        let error = (largest / self.surface.scale()).min(f32::MAX);
        let Self { locked, topology_changed, passes, .. } = *self;
        let tracked = self.options.track_collapses && !topology_changed;
        let collapses = self.surface.collapses.as_ref().filter(|_| tracked).cloned();
        let origins = origins.filter(|_| self.options.track_origins);
        let attribute_error = self.surface.attribute_errors.iter().copied().fold(0.0, f32::max);
        Ok(Simplified {
            mesh,
            stopped_by,
            error,
            attribute_error: (attribute_error / self.surface.scale()).min(f32::MAX),
            locked,
            topology_changed,
            origins,
            sources,
            // No triangle is left to have one where groups were given and none are found.
            groups: groups.or_else(|| self.options.groups.as_ref().map(|_| Vec::new())),
            surface_vertices,
            collapses,
            passes,
        })
    }
}

/// The bounds of the living vertices, with room around them.
fn extent(surface: &Surface) -> [Vec3A; 2] {
    let vertices = surface.points.iter().zip(&surface.flags);
    let alive = vertices.filter(|(_, flags)| *flags & flag::DEAD == 0);
    let [low, high] = alive
        .map(|(&point, _)| Vec3A::from_vec4(point))
        .fold([Vec3A::INFINITY, Vec3A::NEG_INFINITY], |[low, high], point| [low.min(point), high.max(point)]);
    let room = Vec3A::splat(OVERSHOOT * (high - low).length());
    [low - room, high + room]
}

fn moves_no_vertex(options: &Options) -> bool {
    options.placement == Placement::Existing
}

/// How far `now` is from `start` to the goal.
fn progress(goal: Goal, start: Counts, now: Counts) -> f32 {
    let excess = goal.excess(start).max(1) as f32;
    1.0 - goal.excess(now) as f32 / excess
}

fn check(mesh: &Mesh, options: &Options) -> Result<(), SimplifyError> {
    let invalid = |message: String| Err(SimplifyError::InvalidOption(message));
    let vertices = mesh.positions().len();
    for (what, named) in [
        ("locked", &options.locked),
        ("protected", &options.protected),
        ("prioritized", &options.prioritized),
    ] {
        if let Some(vertex) = named.iter().find(|&&vertex| vertex as usize >= vertices) {
            return invalid(format!("{what} vertex {vertex} does not exist: there are {vertices} vertices"));
        }
    }
    let AttributeWeights { normals, uvs, colors } = options.attribute_weights;
    for (what, weight) in [("normals", normals), ("uvs", uvs), ("colors", colors)] {
        if !(weight >= 0.0 && weight.is_finite()) {
            return invalid(format!("the weight of {what} is {weight}, neither 0 nor a positive number"));
        }
    }
    if let Some(groups) = &options.groups {
        let (count, triangles) = (groups.len(), mesh.triangles().len());
        if count != triangles {
            return invalid(format!("there are {count} groups for {triangles} triangles"));
        }
        if !moves_no_vertex(options) {
            return invalid("groups are kept where vertices stay (Placement::Existing) only".into());
        }
    }
    if options.track_collapses && !moves_no_vertex(options) {
        let message = "collapses can be tracked where vertices stay (Placement::Existing) only";
        return invalid(message.into());
    }
    if options.refine && moves_no_vertex(options) {
        return invalid("vertices cannot be refined where they stay (Placement::Existing)".into());
    }
    if options.selection == (Selection::ReplacementSelection { records: 0 }) {
        return invalid("a replacement-selection heap needs a record".into());
    }
    Ok(())
}

fn check_target(target: Target) -> Result<(), SimplifyError> {
    let invalid = |message: String| Err(SimplifyError::InvalidOption(message));
    match target {
        Target::Ratio(ratio) if !(0.0..=1.0).contains(&ratio) => {
            invalid(format!("ratio {ratio} is not between 0 and 1"))
        }
        Target::MaxError(error) if !(error >= 0.0 && error.is_finite()) => {
            invalid(format!("maximum error {error} is not a distance"))
        }
        _ => Ok(()),
    }
}
