//! Simplification within a guaranteed error: the estimate proposes, the bound disposes.
//!
//! The estimate of [`simplify`](crate::simplify) adds up what each collapse may do, and so says too much of most
//! places, and here and there too little. So the input is simplified in steps. After each, both surfaces are held
//! to each other (`deviation/within.rs`), all of them and not only samples. If no point is beyond the limit, the
//! step is kept, and the next one goes on from it with what was *found* around each vertex in place of what was
//! estimated: as much as is left of the limit may be spent, and more and more of it at a time. If some points are
//! beyond, the step is done over, and where they lie collapses count for more. These places are few, and what is done
//! elsewhere stays nearly the same, so that one or two repetitions mostly settle it.
//!
//! Beside a bisection of the limit of the estimate, or of the number of triangles, by eight bounds each, this
//! leaves 0.2 to 1.1 times as many triangles in about the same time (bunny, fandisk, a turbine).

use crate::deviation::{Apart, Bound, Reference};
use crate::hqms::steps::Steps;
use crate::hqms::{Options, Placement, Simplified, SimplifyError};
use crate::mesh::Mesh;
use crate::monitor::{Cancelled, Monitor};
use crate::workers::Workers;

/// Steps, those that are done over included.
const ATTEMPTS: usize = 8;
/// By how much the share grows of what is left of the limit that a step may spend, as estimated and up to the whole
/// limit: the estimate says too much of most places, and the more of them are full, the less harm does a larger share.
const PACE: f32 = 3.0;
/// The largest such share.
const FASTEST: f32 = 9.0;
/// What is left of the share where a point was beyond the limit.
const RETREAT: f32 = 0.3;
/// A step that leaves more than this of the triangles, at the fastest, is the last.
const STALLED: f64 = 0.99;

/// Share of the progress that taking over the input is, and of each attempt that simplifying is.
const BEGUN: f32 = 0.05;
const SIMPLIFIED: f32 = 0.2;

/// Marks an input vertex that vanished.
const NONE: u32 = u32::MAX;

/// A simplified mesh, and what its distance from the input is guaranteed to be.
#[derive(Debug, Clone)]
pub struct Certified {
    /// The mesh; its [`error`](Simplified::error) is [`Bound::upper`] too, rounded upwards.
    pub simplified: Simplified,
    /// What the two-sided Hausdorff distance lies between; [`upper`](Bound::upper) is at most what was asked for.
    /// It was looked at no more closely than that takes: [`bound`](crate::deviation::bound()) finds a closer one.
    pub bound: Bound,
}

/// Simplifies `mesh` to few triangles whose two-sided Hausdorff distance from it is *proven* to be at most
/// `max_error`, in units of the positions: no point of either surface is farther from the other.
///
/// [`Options::target`] is not looked at; all else is as for [`simplify`](crate::simplify), and the topology is kept.
/// [`Simplified::stopped_by`] is [`StoppedBy::Error`](crate::StoppedBy::Error). Where nothing smaller can be shown to
/// be so close, the input comes back, without the vertices that no triangle uses, at distance 0: so it is
/// for a `max_error` below 2⁻⁴² of the largest coordinate. A degenerate triangle (one with two corners at one place)
/// that sticks out of the rest by more than `max_error` cannot go, and nothing else does then.
///
/// This takes at most nine times what [`bound`](crate::deviation::bound()) takes, and simplifies as often, though
/// less and less: some ten to 200 microseconds a triangle. At its peak it holds about 280 bytes a triangle of a
/// closed mesh, and what is not settled yet: at most 120 bytes for each of 32 parts a triangle and a million. The
/// result is the same, byte for byte, for any number of threads.
///
/// Fails as `simplify` does, and where `max_error` is negative, infinite or not a number, or the result is to be
/// refined. The monitor may cancel.
///
/// ```
/// use decimesh::mesh::shapes;
/// use decimesh::{Monitor, Options, Target, simplify_within};
///
/// let stone = shapes::bumpy_sphere(16, 1);
/// let options = Options::new(Target::Ratio(0.0));
/// let result = simplify_within(&stone, 0.02, &options, &mut Monitor::silent())?;
/// assert!(result.bound.upper <= 0.02);
/// assert!(result.simplified.mesh.triangles().len() < stone.triangles().len());
/// # Ok::<(), decimesh::SimplifyError>(())
/// ```
pub fn simplify_within(
    mesh: &Mesh,
    max_error: f64,
    options: &Options,
    monitor: &mut Monitor,
) -> Result<Certified, SimplifyError> {
    if !(max_error >= 0.0 && max_error.is_finite()) {
        return Err(SimplifyError::InvalidOption(format!("maximum error {max_error} is not a distance")));
    }
    if options.refine {
        let message = "what is certified cannot be refined: vertices that move afterwards are not bounded";
        return Err(SimplifyError::InvalidOption(message.into()));
    }
    let tracked = Options { track_origins: true, ..options.clone() };
    let mut steps = Steps::new(mesh, &tracked)?;
    monitor.report(0.0)?;
    let begin = steps.result()?;
    let mut certified = if begin.mesh.triangles().is_empty() {
        unchanged(mesh, begin, options)?
    } else {
        let workers = Workers::new(options.threads)?;
        let held = Held { mesh, reference: Reference::new(mesh), max_error, workers };
        monitor.report(BEGUN)?;
        let first = held.begin(begin, &mut monitor.part(BEGUN..2.0 * BEGUN))?;
        match first {
            Ok(step) => held.go_on(&mut steps, step, &mut monitor.part(2.0 * BEGUN..1.0))?,
            Err(begin) => unchanged(mesh, begin, options)?,
        }
    };
    monitor.report(1.0)?;
    certified.simplified.error = certified.bound.not_above();
    certified.simplified.origins = certified.simplified.origins.filter(|_| options.track_origins);
    Ok(certified)
}

/// A surface that is within the limit, and what was found around its vertices.
struct Step {
    certified: Certified,
    /// For each vertex how far the surface around it, and what of the input went into it, are from the other.
    farthest: Vec<f32>,
}

/// What all steps are held to.
struct Held<'a> {
    mesh: &'a Mesh,
    reference: Reference<'a>,
    max_error: f64,
    workers: Workers,
}

impl Held<'_> {
    /// The step from which all others start: the surface before any collapse, if that is within the limit, as it
    /// may lack degenerate triangles of the input.
    fn begin(&self, begin: Simplified, monitor: &mut Monitor) -> Result<Result<Step, Simplified>, Cancelled> {
        if is_same_surface(self.mesh, &begin) {
            let farthest = vec![0.0; begin.mesh.positions().len()];
            let bound = Bound { diagonal: self.reference.diagonal(), ..Bound::default() };
            return Ok(Ok(Step { certified: Certified { simplified: begin, bound }, farthest }));
        }
        let apart = self.reference.apart(&begin.mesh, self.max_error, &self.workers, monitor)?;
        Ok(if apart.upper <= self.max_error { Ok(self.step(begin, &apart)) } else { Err(begin) })
    }

    /// Goes on from `step` as far as the limit allows.
    fn go_on(
        &self,
        steps: &mut Steps,
        mut step: Step,
        monitor: &mut Monitor,
    ) -> Result<Certified, SimplifyError> {
        if self.max_error <= self.reference.resolution() {
            return Ok(step.certified);
        }
        let limit = self.max_error.min(f64::from(f32::MAX)) as f32;
        let mut pace = 1.0;
        // For each vertex of the input.
        let mut trust = vec![1.0; self.mesh.positions().len()];
        for attempt in 0..ATTEMPTS {
            let share = |done: f32| (attempt as f32 + done) / ATTEMPTS as f32;
            let simplified = &step.certified.simplified;
            let spent = least(origins(simplified), &trust, simplified.mesh.positions().len())
                .zip(&step.farthest)
                .map(|(trust, farthest)| limit - trust * (pace * (limit - farthest).max(0.0)).min(limit))
                .collect::<Vec<f32>>();
            let mut simplifying = monitor.part(share(0.0)..share(SIMPLIFIED));
            let result = steps.try_within(limit, (&simplified.mesh, &spent), &mut simplifying)?;
            drop(simplifying);
            if result.mesh.triangles().is_empty() {
                break;
            }
            let mut measuring = monitor.part(share(SIMPLIFIED)..share(1.0));
            let apart = self.reference.apart(&result.mesh, self.max_error, &self.workers, &mut measuring)?;
            drop(measuring);
            let next = self.step(result, &apart);
            if apart.upper <= self.max_error {
                let left = next.triangles() as f64 / step.triangles() as f64;
                // Where nothing was collapsed, what is known of the surface stays what it was: at first, that it is
                // the input's.
                if left < 1.0 {
                    steps.keep();
                    step = next;
                }
                if left > STALLED && pace >= FASTEST {
                    break;
                }
                pace = (pace * PACE).min(FASTEST);
            } else {
                let beyond = |vertex: u32| vertex != NONE && next.farthest[vertex as usize] > limit;
                let origins = origins(&next.certified.simplified);
                for (trust, _) in trust.iter_mut().zip(origins).filter(|(_, into)| beyond(**into)) {
                    *trust *= RETREAT;
                }
            }
        }
        Ok(step.certified)
    }

    /// What was found of `simplified`, whether or not that is within the limit.
    fn step(&self, simplified: Simplified, apart: &Apart) -> Step {
        let mut farthest = vec![0.0f32; simplified.mesh.positions().len()];
        let mut note = |vertex: u32, distance: f32| {
            if let Some(farthest) = farthest.get_mut(vertex as usize) {
                *farthest = farthest.max(distance);
            }
        };
        let [of_input, of_result] = &apart.farthest;
        for (triangle, &distance) in simplified.mesh.triangles().iter().zip(of_result) {
            triangle.iter().for_each(|&vertex| note(vertex, distance));
        }
        let origins = origins(&simplified);
        for (triangle, &distance) in self.mesh.triangles().iter().zip(of_input) {
            triangle.iter().for_each(|&vertex| note(origins[vertex as usize], distance));
        }
        let Apart { lower, upper, pieces, .. } = *apart;
        let bound = Bound { lower, upper, pieces, diagonal: self.reference.diagonal() };
        Step { certified: Certified { simplified, bound }, farthest }
    }
}

impl Step {
    fn triangles(&self) -> usize {
        self.certified.simplified.mesh.triangles().len()
    }
}

/// For each vertex of the input the one it went into, which all steps track.
fn origins(simplified: &Simplified) -> &[u32] {
    simplified.origins.as_deref().unwrap_or_default()
}

/// For each of `count` vertices the least of the shares of those that went into it.
fn least(origins: &[u32], values: &[f32], count: usize) -> impl Iterator<Item = f32> {
    let mut least = vec![1.0f32; count];
    for (&into, &value) in origins.iter().zip(values) {
        if let Some(least) = least.get_mut(into as usize) {
            *least = least.min(value);
        }
    }
    least.into_iter()
}

/// Whether a surface on which nothing has been collapsed yet is the input's to the last bit.
fn is_same_surface(mesh: &Mesh, begin: &Simplified) -> bool {
    let stays = |(vertex, &into): (usize, &u32)| {
        into == NONE || begin.mesh.positions()[into as usize] == mesh.positions()[vertex]
    };
    begin.mesh.triangles().len() == mesh.triangles().len() && origins(begin).iter().enumerate().all(stays)
}

/// The input as a result, of which `begin` is what would have been simplified.
fn unchanged(mesh: &Mesh, begin: Simplified, options: &Options) -> Result<Certified, SimplifyError> {
    let (same, sources) = mesh.of_triangles(mesh.triangles())?;
    let mut origins = vec![NONE; mesh.positions().len()];
    for (&source, vertex) in sources.iter().zip(0..) {
        origins[source as usize] = vertex;
    }
    let keeps_sources = options.track_sources || options.placement == Placement::Existing;
    let surface_vertices = begin.surface_vertices.map(|_| same.surface_vertices());
    let bound = Bound { diagonal: same.diagonal(), ..Bound::default() };
    let simplified = Simplified {
        mesh: same,
        origins: Some(origins),
        sources: keeps_sources.then_some(sources),
        groups: options.groups.clone(),
        surface_vertices,
        ..begin
    };
    Ok(Certified { simplified, bound })
}
