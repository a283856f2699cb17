//! All rates of a field from one run: the order in which its vertices go.

use std::sync::OnceLock;

use super::Error;
use super::distortion::Place;
use super::extract::{Extract, extract};
use super::flow::{Certificate, Effort, NEVER, decibels, rank, solve};
use super::height_field::HeightField;
use super::lattice::Lattice;
use super::layout::Site;
use super::max_error::{self, Left};
use super::rate;
use super::vertical::{VerticalError, measure};
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use crate::workers::Workers;

/// How a field is decomposed.
#[derive(Debug, Clone, PartialEq)]
pub struct DecompositionOptions {
    /// Sweeps of the flow before the [gap](Approximation::certified_gap) is looked at, and between two looks, 2 at
    /// least. Eight are enough for most terrain.
    pub sweeps: u32,
    /// The gap, in decibels, at which it is good enough: where a fifth of the vertices is left.
    pub gap: f64,
    /// Sweeps at most, whatever the gap.
    pub max_sweeps: u32,
    /// How many threads to use; 0: as many as the machine has. The result is the same.
    pub threads: usize,
}

impl Default for DecompositionOptions {
    fn default() -> Self {
        Self { sweeps: 8, gap: 0.03, max_sweeps: 64, threads: 0 }
    }
}

/// How much of a field is wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Detail {
    /// That many vertices at most, and as many as there can be below.
    Vertices(usize),
    /// That part of the samples that are not void, above 0 and at most 1.
    Ratio(f64),
    /// Vertices that cost no more than this together, by the costs of [`Decomposition::with_costs`]; each costs 1
    /// without.
    Cost(f64),
    /// As few vertices as there are in the order of the decomposition with this root mean square of the vertical
    /// error over all samples, in the unit of the heights (weighted, if samples have an importance).
    Rms(f64),
    /// As few vertices as there can be with no sample farther from the surface, vertically.
    MaxError(f64),
}

/// A field with the order in which its vertices go, from all of them to the corners alone.
///
/// Each mesh that is taken from it is conforming, and its vertices are among those of each finer one. For fields
/// of 2^d + 1 rows and columns the coarsest is the square of the four corners; others keep the corners of a grid of
/// quads that covers them, and are cut off at their edges, where vertices are made that lie on samples, but between
/// heights.
///
/// Memory: 16 bytes a sample; 24 while it is made.
#[derive(Debug)]
pub struct Decomposition {
    lattice: Lattice,
    /// By how much the squared error grows with each vertex, by number, over [`Lattice::squared_unit`].
    deltas: Vec<f32>,
    /// The slopes at which vertices go, by number: none less than that of its children.
    slopes: Vec<f32>,
    /// The vertices in the order in which they go; last those that must not.
    order: Vec<u32>,
    removable: usize,
    certificate: Certificate,
    /// What each vertex costs, by number, where that is not 1 for all.
    costs: Option<Vec<f32>>,
    /// Of all samples together; over the same unit as heights' squares.
    weight: f64,
    /// The squared error after every [`NOTED`] vertices, once somebody asks.
    noted: OnceLock<Vec<f64>>,
}

/// Every so many vertices the squared error is noted.
const NOTED: usize = 256;

/// A mesh in the place of a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Approximation {
    /// East, north, up; with texture coordinates.
    pub mesh: Mesh,
    /// For each vertex the sample it lies on: row times columns plus column.
    pub samples: Vec<u32>,
    /// The sum of the squared vertical errors of all samples, each times its importance, as tracked: what is
    /// measured agrees with it to rounding.
    pub squared_error: f64,
    /// The root of its mean.
    pub rms: f64,
    /// How far, in decibels, the squared error can be above that of the best conforming mesh of as many vertices:
    /// proven for this field, by a bound on all such meshes. Infinite if nothing is known.
    pub certified_gap: f64,
}

impl Decomposition {
    /// Decomposes a field. Time linear in the samples but for one sort: about 0.1 s for each million.
    pub fn new(
        field: HeightField,
        options: &DecompositionOptions,
        monitor: &mut Monitor,
    ) -> Result<Self, Error> {
        let workers = Workers::new(options.threads)?;
        monitor.report(0.0)?;
        let lattice = Lattice::new(field);
        let deltas = lattice.deltas(&workers, monitor, 0.0..0.3)?;
        let effort = Effort { sweeps: options.sweeps, most: options.max_sweeps, gap: options.gap };
        let report = |done: f32| monitor.report(0.3 + 0.5 * done);
        let (slopes, certificate) = solve(lattice.layout(), &deltas, &effort, &workers, report)?;
        monitor.report(0.8)?;
        let decomposition = Self::of_slopes(lattice, deltas, slopes, certificate, &workers);
        monitor.report(1.0)?;
        Ok(decomposition)
    }

    /// Decomposes a field whose samples cost what they are said to, in the order of the heights, in place of 1 each:
    /// positive and finite. What is least for a given error is then what is left costs together. Sweeps go up to
    /// [`DecompositionOptions::max_sweeps`], on one thread, and there is no certificate: the
    /// [gap](Approximation::certified_gap) is infinite.
    pub fn with_costs(
        field: HeightField,
        costs: &[f32],
        options: &DecompositionOptions,
        monitor: &mut Monitor,
    ) -> Result<Self, Error> {
        let (columns, rows) = (field.columns(), field.rows());
        if costs.len() != field.heights().len() {
            return Err(Error::SampleCount { what: "costs", count: costs.len(), columns, rows });
        }
        if let Some(sample) = costs.iter().position(|cost| !(cost.is_finite() && *cost > 0.0)) {
            let (value, column, row) = (costs[sample], sample % columns, sample / columns);
            return Err(Error::NotFinite { what: "cost", value, column, row });
        }
        let workers = Workers::new(options.threads)?;
        monitor.report(0.0)?;
        let lattice = Lattice::new(field);
        let deltas = lattice.deltas(&workers, monitor, 0.0..0.3)?;
        let layout = lattice.layout();
        // What lies beyond the field costs what lies nearest in it does.
        let cost = |vertex: usize| {
            let Site { x, y, .. } = layout.site(vertex);
            costs[y.min(rows - 1) * columns + x.min(columns - 1)]
        };
        let by_vertex: Vec<f32> = (0..layout.vertices()).map(cost).collect();
        let report = |done: f32| monitor.report(0.3 + 0.5 * done);
        let slopes = rate::solve(layout, &deltas, &by_vertex, options.max_sweeps, report)?;
        let decomposition = Self::of_slopes(lattice, deltas, slopes, Certificate::none(), &workers);
        monitor.report(1.0)?;
        Ok(Self { costs: Some(by_vertex), ..decomposition })
    }

    /// The order of given slopes, none less than that of a child; finer levels first where slopes are equal.
    pub(crate) fn of_slopes(
        lattice: Lattice,
        deltas: Vec<f32>,
        slopes: Vec<f32>,
        certificate: Certificate,
        workers: &Workers,
    ) -> Self {
        let mut keys = workers.list(slopes.len(), |vertex| key(&slopes, vertex));
        workers.sort(&mut keys);
        let order = workers.list(keys.len(), |place| !(keys[place] as u32));
        drop(keys);
        let removable = order.partition_point(|&vertex| slopes[vertex as usize] < NEVER);
        let weight = total_weight(&lattice);
        Self {
            lattice,
            deltas,
            slopes,
            order,
            removable,
            certificate,
            costs: None,
            weight,
            noted: OnceLock::new(),
        }
    }

    /// What it is made of: the grid, the slopes of [`of_slopes`](Self::of_slopes), and the proof.
    #[cfg(feature = "io")]
    pub(crate) fn parts(&self) -> (&Lattice, &[f32], &Certificate) {
        (&self.lattice, &self.slopes, &self.certificate)
    }

    /// The field.
    pub fn field(&self) -> &HeightField {
        self.lattice.field()
    }

    /// How many samples are not void.
    pub fn samples(&self) -> usize {
        let field = self.field();
        field.heights().len() - field.voids()
    }

    /// The mesh with as much detail as is wanted. For vertices and ratios of fields of 2^d + 1 rows and columns
    /// without voids, time and memory are linear in what comes out; for others that is done a few times. The
    /// first RMS costs a walk over all vertices; a maximum error takes n log n.
    ///
    /// With voids there is a least number of vertices, those that keep triangles off them: it is what comes out
    /// when fewer are asked for.
    pub fn at(&self, detail: Detail) -> Result<Approximation, Error> {
        let count = |vertices| self.approximation(self.removed_for(vertices));
        match detail {
            Detail::Vertices(vertices) => Ok(count(vertices)),
            Detail::Ratio(ratio) => Ok(count(self.part(ratio)?)),
            Detail::Cost(cost) => Ok(self.approximation(self.removed_for_cost(cost)?)),
            Detail::Rms(rms) => Ok(self.approximation(self.removed_within(self.squared(rms)?))),
            Detail::MaxError(bound) => {
                let left = self.within(self.removable, check_error("maximum error", bound)?);
                Ok(self.of_set(&left))
            }
        }
    }

    /// The mesh with as much detail as is wanted where no sample is farther from it than `bound`: the vertices that
    /// the bound needs, filled up in the order of the decomposition. If the bound needs more than is asked for, it
    /// has more. A few times as much work as for a maximum error alone, some twenty for an RMS.
    pub fn at_within(&self, detail: Detail, bound: f64) -> Result<Approximation, Error> {
        let bound = check_error("maximum error", bound)?;
        let few = |vertices: usize| {
            let count = |removed| self.extract_set(&self.within(removed, bound)).places.len();
            let removed = self.fewest_removed(vertices, self.removed_for(vertices), count);
            Ok(self.of_set(&self.within(removed, bound)))
        };
        match detail {
            Detail::Vertices(vertices) => few(vertices),
            Detail::Ratio(ratio) => few(self.part(ratio)?),
            Detail::Cost(cost) => few(self.extract(self.removed_for_cost(cost)?).places.len()),
            Detail::MaxError(other) => {
                self.at(Detail::MaxError(check_error("maximum error", other)?.min(bound)))
            }
            Detail::Rms(rms) => {
                let limit = self.squared(rms)?;
                let is_enough = |removed| self.squared_error_of(&self.within(removed, bound)) <= limit;
                Ok(self.of_set(&self.within(last(self.removable, is_enough), bound)))
            }
        }
    }

    /// What is measured between the field and what was taken from it, sample by sample. Linear in the samples.
    pub fn measure(&self, taken: &Approximation) -> VerticalError {
        let columns = self.field().columns() as u32;
        let places: Vec<Place> =
            taken.samples.iter().map(|&sample| [sample % columns, sample / columns]).collect();
        let heights: Vec<f32> = taken.mesh.positions().iter().map(|&[_, _, height]| height).collect();
        measure(self.field(), &places, &heights, taken.mesh.triangles())
    }

    /// How many vertices have to go so that no more than so many are left: as few as can be.
    fn removed_for(&self, vertices: usize) -> usize {
        let layout = self.lattice.layout();
        if self.lattice.fits() {
            let corners: usize = layout.base().iter().map(|quads| quads + 1).product();
            return (corners + self.order.len()).saturating_sub(vertices).min(self.removable);
        }
        // As if each that lies in the field were a vertex of the mesh, and none were made at its edges.
        let mut inside = 0;
        let stays = |&&vertex: &&u32| {
            let Site { x, y, .. } = layout.site(vertex as usize);
            inside += usize::from(self.lattice.is_inside([x as u32, y as u32]));
            inside <= vertices
        };
        let left = self.order.iter().rev().take_while(stays).count();
        let count = |removed| self.extract(removed).places.len();
        self.fewest_removed(vertices, self.order.len() - left, count)
    }

    /// How many vertices have to go so that a mesh has no more than so many, by `count`, which tells how many it has
    /// then: as few as can be, or all that may.
    fn fewest_removed(&self, vertices: usize, guess: usize, count: impl Fn(usize) -> usize) -> usize {
        /// With each vertex that goes, about one goes: seldom more steps are taken. Then what is left is halved.
        const STEPS: u32 = 8;
        // More must go than `low`, and no more need to than `high`.
        let (mut low, mut high) = (None, self.removable);
        let (mut removed, mut back) = (guess.min(self.removable), 1);
        for step in 0.. {
            let found = count(removed);
            if found > vertices {
                low = Some(removed);
            } else {
                high = removed;
            }
            let first = low.map_or(0, |low| low + 1);
            if first >= high {
                break;
            }
            let next = if found == vertices {
                // Some that go are no vertices of the mesh: they lie beyond the field, or only voids need them.
                back *= 2;
                high.saturating_sub(back / 2).max(first)
            } else {
                (removed + found).saturating_sub(vertices)
            };
            removed = match step < STEPS && (first..high).contains(&next) {
                true => next,
                false => first + (high - first) / 2,
            };
        }
        high
    }

    /// How many vertices have to go so that the others cost no more than that.
    fn removed_for_cost(&self, limit: f64) -> Result<usize, Error> {
        if limit.is_nan() || limit < 0.0 {
            return Err(Error::Target { what: "cost", value: limit, expected: "it must not be negative" });
        }
        let cost = |&vertex: &u32| self.costs.as_ref().map_or(1.0, |costs| f64::from(costs[vertex as usize]));
        let mut left = 0.0;
        let stays = |vertex: &&u32| {
            left += cost(vertex);
            left <= limit
        };
        Ok((self.order.len() - self.order.iter().rev().take_while(stays).count()).min(self.removable))
    }

    /// How many vertices may go within a squared error.
    fn removed_within(&self, limit: f64) -> usize {
        let limit = limit / self.lattice.squared_unit();
        let noted = self.noted();
        // The error may fall a little on its way; what comes last counts.
        let Some(note) = noted.iter().rposition(|&error| error <= limit) else { return 0 };
        let (mut removed, mut error) = (note * NOTED, noted[note]);
        let mut found = removed;
        for &vertex in self.order[removed..self.removable].iter().take(NOTED) {
            removed += 1;
            error += f64::from(self.deltas[vertex as usize]);
            if error <= limit {
                found = removed;
            }
        }
        found
    }

    /// The squared error once so many vertices are gone.
    pub(crate) fn squared_error(&self, removed: usize) -> f64 {
        let note = removed / NOTED;
        let rest = self.order[note * NOTED..removed].iter();
        let error =
            rest.fold(self.noted()[note], |error, &vertex| error + f64::from(self.deltas[vertex as usize]));
        error.max(0.0) * self.lattice.squared_unit()
    }

    /// The least squared error of any conforming mesh that lacks so many vertices.
    pub(crate) fn bound(&self, removed: usize) -> f64 {
        self.certificate.bound(removed) * self.lattice.squared_unit()
    }

    fn noted(&self) -> &[f64] {
        self.noted.get_or_init(|| {
            let mut error = 0.0;
            let mut notes = vec![0.0];
            for vertices in self.order[..self.removable].chunks_exact(NOTED) {
                error += vertices.iter().map(|&vertex| f64::from(self.deltas[vertex as usize])).sum::<f64>();
                notes.push(error);
            }
            notes
        })
    }

    fn part(&self, ratio: f64) -> Result<usize, Error> {
        match ratio > 0.0 && ratio <= 1.0 {
            true => Ok((ratio * self.samples() as f64).round() as usize),
            false => {
                let expected = "it must be above 0 and at most 1";
                Err(Error::Target { what: "ratio", value: ratio, expected })
            }
        }
    }

    fn squared(&self, rms: f64) -> Result<f64, Error> {
        Ok(check_error("RMS", rms)?.powi(2) * self.weight)
    }

    pub(super) fn root_mean(&self, squared_error: f64) -> f64 {
        if self.weight > 0.0 { (squared_error / self.weight).sqrt() } else { 0.0 }
    }

    /// How many vertices may go.
    pub(super) fn removable(&self) -> usize {
        self.removable
    }

    /// The vertices that are left once so many are gone, and those that the bound needs.
    pub(crate) fn within(&self, removed: usize, bound: f64) -> Left {
        let cut = self.cut(removed);
        max_error::least(&self.lattice, bound, |vertex| key(&self.slopes, vertex) >= cut)
    }

    /// The key that is the first to stay.
    fn cut(&self, removed: usize) -> u64 {
        self.order.get(removed).map_or(u64::MAX, |&vertex| key(&self.slopes, vertex as usize))
    }

    pub(crate) fn extract(&self, removed: usize) -> Extract {
        let cut = self.cut(removed);
        extract(&self.lattice, |vertex| key(&self.slopes, vertex) >= cut)
    }

    /// The mesh of so many vertices.
    pub(super) fn places(&self, vertices: usize) -> Extract {
        self.extract(self.removed_for(vertices))
    }

    fn approximation(&self, removed: usize) -> Approximation {
        self.finish(self.extract(removed), self.squared_error(removed), removed)
    }

    fn extract_set(&self, left: &Left) -> Extract {
        extract(&self.lattice, |vertex| left.contains(vertex))
    }

    fn of_set(&self, left: &Left) -> Approximation {
        let removed = (0..self.order.len()).filter(|&vertex| !left.contains(vertex)).count();
        self.finish(self.extract_set(left), self.squared_error_of(left), removed)
    }

    fn squared_error_of(&self, left: &Left) -> f64 {
        let gone = self.deltas.iter().enumerate().filter(|&(vertex, _)| !left.contains(vertex));
        gone.map(|(_, &delta)| f64::from(delta)).sum::<f64>().max(0.0) * self.lattice.squared_unit()
    }

    fn finish(&self, extract: Extract, squared_error: f64, removed: usize) -> Approximation {
        let columns = self.field().columns() as u32;
        Approximation {
            mesh: extract.to_mesh(self.field()),
            samples: extract.places.iter().map(|[x, y]| y * columns + x).collect(),
            squared_error,
            rms: self.root_mean(squared_error),
            certified_gap: decibels(squared_error, self.bound(removed)),
        }
    }
}

#[cfg(test)]
impl Decomposition {
    pub(crate) fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    pub(crate) fn order(&self) -> &[u32] {
        &self.order
    }

    pub(crate) fn is_forced(&self, vertex: usize) -> bool {
        self.slopes[vertex] >= NEVER
    }
}

/// By what vertices are ordered: slopes, and where they are equal the finer levels first, whose numbers are higher.
fn key(slopes: &[f32], vertex: usize) -> u64 {
    u64::from(rank(slopes[vertex])) << 32 | u64::from(!(vertex as u32))
}

fn total_weight(lattice: &Lattice) -> f64 {
    let field = lattice.field();
    let heights = field.heights().iter();
    match field.importance() {
        None => (field.heights().len() - field.voids()) as f64,
        Some(importance) => {
            let known = heights.zip(importance).filter(|(height, _)| !height.is_nan());
            known.map(|(_, &weight)| f64::from(weight)).sum()
        }
    }
}

fn check_error(what: &'static str, value: f64) -> Result<f64, Error> {
    match value >= 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(Error::Target { what, value, expected: "it must be finite and not negative" }),
    }
}

/// The last number up to `most` for which something holds that holds up to some number; 0 if for none.
fn last(most: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, most);
    while low < high {
        let middle = low + (high - low).div_ceil(2);
        match holds(middle) {
            true => low = middle,
            false => high = middle - 1,
        }
    }
    low
}
