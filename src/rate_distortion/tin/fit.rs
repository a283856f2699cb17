//! Heights by least squares.
//!
//! The surface is a sum of hat functions, one a vertex, so the heights with the least squared error solve the
//! normal equations: their matrix has an entry for each pair of vertices in a triangle, the weighted sum of the
//! products of their hats over the samples. Solved by conjugate gradients (Hestenes and Stiefel 1952), with the
//! diagonal for a preconditioner, in a fixed order.

use super::residual::Samples;
use super::triangulation::Triangulation;
use crate::monitor::{Cancelled, Monitor};
use crate::rate_distortion::raster::twice_area;

/// More steps than are ever needed: a matrix of hats is well conditioned, for triangles of any shape. So that it is
/// with samples of weight 0 too, ...
const MOST_STEPS: usize = 100;
/// ... each vertex holds on to its height as if with this part of the weight of the samples around. What that costs
/// is a part as small of the error that there was; and heights that the samples do not decide stay where they are.
const HOLD: f64 = 1e-5;
/// When the residual has become so small, by its square, heights change less than is worth a step.
const TOLERANCE: f64 = 1e-10;

/// The products of the hats of a triangle's vertices, summed over its samples.
struct Products {
    names: [usize; 3],
    /// Of each with itself.
    squares: [f64; 3],
    /// Of each with the next.
    mixed: [f64; 3],
}

/// The normal equations for what is added to the heights.
struct Equations {
    triangles: Vec<Products>,
    /// The weights of the vertices' own samples, and of what holds them.
    own: Vec<f64>,
    diagonal: Vec<f64>,
    right: Vec<f64>,
}

impl Equations {
    fn new(mesh: &Triangulation, samples: &Samples) -> Self {
        let count = mesh.vertices.len();
        let (mut own, mut right) = (vec![0.0; count], vec![0.0; count]);
        for (index, vertex) in mesh.vertices.iter().enumerate() {
            if mesh.has_vertex(index as u32) {
                let (height, weight) = samples.at(vertex.place);
                own[index] = weight;
                right[index] = weight * (height - f64::from(vertex.height));
            }
        }
        let mut diagonal = own.clone();
        let mut triangles = Vec::new();
        for triangle in mesh.triangles() {
            let (corners, rim) = mesh.triangle(triangle);
            let names = mesh.names(triangle).map(|name| name as usize);
            let [a, b, c] = corners.map(|vertex| vertex.place);
            let heights = corners.map(|vertex| f64::from(vertex.height));
            let reciprocal = 1.0 / twice_area([a, b, c]) as f64;
            let mut products = Products { names, squares: [0.0; 3], mixed: [0.0; 3] };
            samples.visit(corners, rim, |here, height, weight| {
                // Each from whole numbers, so that a hat is 0 where it ends: a trace of one would decide a height
                // that nothing else does.
                let hats = [[here, b, c], [here, c, a], [here, a, b]]
                    .map(|part| twice_area(part) as f64 * reciprocal);
                let surface: f64 = hats[0] * heights[0] + hats[1] * heights[1] + hats[2] * heights[2];
                for k in 0..3 {
                    products.squares[k] += weight * hats[k] * hats[k];
                    products.mixed[k] += weight * hats[k] * hats[(k + 1) % 3];
                    right[names[k]] += weight * hats[k] * (height - surface);
                }
            });
            (0..3).for_each(|k| diagonal[names[k]] += products.squares[k]);
            triangles.push(products);
        }
        for (diagonal, own) in diagonal.iter_mut().zip(&mut own) {
            let hold = *diagonal * HOLD;
            *own += hold;
            *diagonal += hold;
        }
        Self { triangles, own, diagonal, right }
    }

    /// `result` = the matrix times `vector`.
    fn multiply(&self, vector: &[f64], result: &mut [f64]) {
        for ((result, own), value) in result.iter_mut().zip(&self.own).zip(vector) {
            *result = own * value;
        }
        for Products { names, squares, mixed } in &self.triangles {
            let values = names.map(|name| vector[name]);
            for k in 0..3 {
                let (next, previous) = ((k + 1) % 3, (k + 2) % 3);
                result[names[k]] +=
                    squares[k] * values[k] + mixed[k] * values[next] + mixed[previous] * values[previous];
            }
        }
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Gives the vertices the heights with the least squared error, but for a hundred-thousandth of what it was. `report` is told which part is done.
pub(super) fn fit(
    mesh: &mut Triangulation,
    samples: &Samples,
    monitor: &mut Monitor,
    report: impl Fn(f32) -> f32,
) -> Result<(), Cancelled> {
    monitor.report(report(0.0))?;
    let equations = Equations::new(mesh, samples);
    let count = mesh.vertices.len();
    let precondition = |residual: &[f64], result: &mut [f64]| {
        for ((result, residual), diagonal) in result.iter_mut().zip(residual).zip(&equations.diagonal) {
            *result = if *diagonal > 0.0 { residual / diagonal } else { 0.0 };
        }
    };
    let mut added = vec![0.0; count];
    let mut residual = equations.right.clone();
    let mut preconditioned = vec![0.0; count];
    precondition(&residual, &mut preconditioned);
    let mut direction = preconditioned.clone();
    let mut image = vec![0.0; count];
    let first = product(&residual, &preconditioned);
    let mut norm = first;
    for step in 0..MOST_STEPS {
        monitor.report(report(step as f32 / MOST_STEPS as f32))?;
        if norm <= first * TOLERANCE {
            break;
        }
        equations.multiply(&direction, &mut image);
        let length = norm / product(&direction, &image);
        for index in 0..count {
            added[index] += length * direction[index];
            residual[index] -= length * image[index];
        }
        precondition(&residual, &mut preconditioned);
        let before = std::mem::replace(&mut norm, product(&residual, &preconditioned));
        for (direction, preconditioned) in direction.iter_mut().zip(&preconditioned) {
            *direction = preconditioned + norm / before * *direction;
        }
    }
    for (vertex, added) in mesh.vertices.iter_mut().zip(added) {
        // Of heights near the limits of their type the best may lie beyond.
        vertex.height =
            (f64::from(vertex.height) + added).clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32;
    }
    Ok(())
}
