//! All rates of a semi-regular surface from one run.
//!
//! Balmelli, Vetterli and Liebling, as in `distortion.rs` and `flow.rs`, with points in the place of heights: a
//! vertex's residual is its distance in space from where the triangles that stay put its parameters (appendix A
//! measures along a projection, which a closed surface has not).

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use glam::{DVec3, Vec3};

use super::super::decomposition::DecompositionOptions;
use super::super::distortion::{Field, Half, Place, VALID, Value, distortions};
use super::super::flow::{Certificate, Effort, decibels, rank, solve};
use super::forest::{Forest, Spot};
use super::insertion::insertion_order;
use super::stars::Stars;
use super::{SemiRegularError, SemiRegularMesh, mesh};
use crate::mesh::{Mesh, select};
use crate::monitor::Monitor;
use crate::workers::Workers;

/// A semi-regular surface with the order in which its vertices go, down to the corners of its complex.
///
/// Each mesh that is taken from it is conforming: as closed and as manifold as the complex is. Its vertices are a
/// prefix of those of each finer one.
///
/// The error of a vertex is the distance between it and the point at its parameters in the triangles that stay. That
/// is at least its distance from them.
///
/// Memory: 28 bytes a vertex; about 45 while it is made.
#[derive(Debug)]
pub struct SurfaceDecomposition {
    surface: SemiRegularMesh,
    /// The vertices that may go, the last to go first.
    order: Vec<u32>,
    /// For each vertex that may go its place in the order.
    ranks: Vec<u32>,
    /// The squared error with as many vertices of the order as the index says.
    squared_errors: Vec<f64>,
    certificate: Option<Certificate>,
}

/// A mesh in the place of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceApproximation {
    /// Its vertices are in the order in which they go, the last to go first.
    pub mesh: Mesh,
    /// For each vertex the one of the surface that it is.
    pub vertices: Vec<u32>,
    /// The sum of the squared errors of all vertices of the surface, as tracked: what is measured agrees with it
    /// to rounding.
    pub squared_error: f64,
    /// The root of its mean.
    pub rms: f64,
}

impl SurfaceDecomposition {
    /// Decomposes a surface by global distortion. Linear in the vertices but for one sort.
    pub fn new(
        surface: SemiRegularMesh,
        options: &DecompositionOptions,
        monitor: &mut Monitor,
    ) -> Result<Self, SemiRegularError> {
        let workers = Workers::new(options.threads)?;
        monitor.report(0.0)?;
        let deltas = deltas(&surface, &workers);
        monitor.report(0.2)?;
        let stars = Stars::new(&surface.forest);
        let effort = Effort { sweeps: options.sweeps, most: options.max_sweeps, gap: options.gap };
        let report = |done: f32| monitor.report(0.2 + 0.6 * done);
        let (slopes, certificate) = solve(&stars, &deltas, &effort, &workers, report)?;
        monitor.report(0.8)?;
        // The highest slopes stay longest, and of equal ones the coarser levels, whose numbers are lower.
        let mut keys: Vec<u64> =
            slopes.iter().zip(0..).map(|(&slope, vertex)| u64::from(!rank(slope)) << 32 | vertex).collect();
        workers.sort(&mut keys);
        let order = keys.into_iter().map(|key| key as u32).collect();
        let decomposition = Self::of_order(surface, &deltas, order, Some(certificate));
        monitor.report(1.0)?;
        Ok(decomposition)
    }

    /// The order in which greedy insertion by local error, the baseline of the literature, brings the vertices in:
    /// from the corners on, always the vertex that is farthest from the middle of the edge that it splits, after
    /// those without which it cannot be. To compare; n log n.
    pub fn by_greedy_insertion(surface: SemiRegularMesh) -> Self {
        let order = insertion_order(&surface.forest, |vertex| point(&surface, vertex));
        let deltas = deltas(&surface, &Workers::Caller);
        Self::of_order(surface, &deltas, order, None)
    }

    fn of_order(
        surface: SemiRegularMesh,
        deltas: &[f32],
        order: Vec<u32>,
        certificate: Option<Certificate>,
    ) -> Self {
        let mut ranks = vec![0; order.len()];
        for (rank, &vertex) in (0..).zip(&order) {
            ranks[vertex as usize] = rank;
        }
        // Summed from the small end, as they go.
        let mut squared_errors = vec![0.0; order.len() + 1];
        let mut error = 0.0;
        for (kept, &vertex) in order.iter().enumerate().rev() {
            error += f64::from(deltas[vertex as usize]);
            squared_errors[kept] = error;
        }
        Self { surface, order, ranks, squared_errors, certificate }
    }

    /// The surface.
    pub fn surface(&self) -> &SemiRegularMesh {
        &self.surface
    }

    /// How many vertices stay in any case: the corners of the complex.
    pub fn least_vertices(&self) -> usize {
        self.surface.complex().corners()
    }

    /// The mesh of so many vertices; of the least or of all where fewer or more are asked for. Linear in what
    /// comes out.
    pub fn at_vertices(&self, vertices: usize) -> SurfaceApproximation {
        let (corners, kept) = (self.least_vertices(), self.kept(vertices));
        let forest = &self.surface.forest;
        let name = |vertex: usize| match vertex.checked_sub(corners) {
            None => vertex as u32,
            Some(number) => corners as u32 + self.ranks[number],
        };
        let mut triangles = Vec::new();
        forest.visit_triangles(
            |vertex| (self.ranks[vertex - corners] as usize) < kept,
            |triangle| triangles.push(triangle.map(name)),
        );
        let of_order = self.order[..kept].iter().map(|&number| number + corners as u32);
        let vertices: Vec<u32> = (0..corners as u32).chain(of_order).collect();
        SurfaceApproximation {
            mesh: mesh(select(&self.surface.positions, &vertices), triangles),
            vertices,
            squared_error: self.squared_errors[kept].max(0.0),
            rms: self.rms(corners + kept),
        }
    }

    /// The mesh of as few vertices as there are in the order with a root mean square error of `rms` or less, in
    /// units of the positions; of all if there is none, or `rms` is no number. One walk over the order.
    pub fn at_rms(&self, rms: f64) -> SurfaceApproximation {
        let vertices =
            (self.least_vertices()..=self.surface.positions.len()).find(|&count| self.rms(count) <= rms);
        self.at_vertices(vertices.unwrap_or(self.surface.positions.len()))
    }

    /// The sum of the squared errors with so many vertices, as tracked.
    pub fn squared_error(&self, vertices: usize) -> f64 {
        self.squared_errors[self.kept(vertices)].max(0.0)
    }

    /// The root mean square error over all vertices of the surface with so many of them.
    pub fn rms(&self, vertices: usize) -> f64 {
        (self.squared_error(vertices) / self.surface.positions.len() as f64).sqrt()
    }

    /// How far, in decibels of squared error, the mesh of so many vertices can be above the best conforming mesh of
    /// as many: proven. Infinite if nothing is known, as of greedy insertion.
    pub fn certified_gap(&self, vertices: usize) -> f64 {
        let kept = self.kept(vertices);
        self.certificate.as_ref().map_or(f64::INFINITY, |certificate| {
            decibels(self.squared_errors[kept].max(0.0), certificate.bound(self.order.len() - kept))
        })
    }

    fn kept(&self, vertices: usize) -> usize {
        vertices.saturating_sub(self.least_vertices()).min(self.order.len())
    }
}

fn point(surface: &SemiRegularMesh, vertex: usize) -> DVec3 {
    Vec3::from(surface.positions[vertex]).as_dvec3()
}

/// By how much the squared error grows with each vertex that may go, by number from the first of them.
fn deltas(surface: &SemiRegularMesh, workers: &Workers) -> Vec<f32> {
    let forest = &surface.forest;
    let count = forest.vertices() - forest.complex().corners();
    let sides = [(); 2].map(|()| (0..count).map(|_| AtomicU32::new(0)).collect::<Vec<_>>());
    workers.map((0..forest.complex().quads().len() as u32).collect(), |quad| {
        let field = QuadField { surface, quad, sides: &sides };
        let (roots, levels) = (forest.roots().to_vec(), forest.levels());
        // Nobody listens, so nobody cancels.
        distortions(&field, roots, levels, &Workers::Caller, &mut Monitor::silent(), 0.0..1.0).is_ok()
    });
    let [first, second] = sides;
    let value = |bits: AtomicU32| f32::from_bits(bits.into_inner());
    first.into_iter().zip(second).map(|(first, second)| value(first) + value(second)).collect()
}

impl Value for DVec3 {
    fn dot(self, other: Self) -> f64 {
        DVec3::dot(self, other)
    }
}

/// A quad of a surface, as a field of points.
struct QuadField<'a> {
    surface: &'a SemiRegularMesh,
    quad: u32,
    /// What the triangles on either side of the edge that a vertex splits add: each has its own place, so that quads
    /// can be done side by side, and the sum of two numbers does not depend on their order.
    sides: &'a [Vec<AtomicU32>; 2],
}

impl QuadField<'_> {
    fn forest(&self) -> &Forest {
        &self.surface.forest
    }
}

impl Field for QuadField<'_> {
    type Value = DVec3;

    fn known(&self, _place: Place) -> u8 {
        VALID
    }

    fn value(&self, place: Place) -> DVec3 {
        point(self.surface, self.forest().vertex(Spot { quad: self.quad, place }))
    }

    fn weight(&self, _place: Place) -> f64 {
        1.0
    }

    fn is_rim(&self, from: Place, to: Place) -> bool {
        self.forest().is_border(self.quad, from, to)
    }

    fn take(&self, triangle: &Half, change: f32) {
        let number = self.forest().midpoint(self.quad, triangle) - self.forest().complex().corners();
        self.sides[self.forest().slot(self.quad, triangle)][number].store(change.to_bits(), Relaxed);
    }
}
