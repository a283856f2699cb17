//! Better places for what a simplification leaves: edges are turned and vertices moved to fit points of the
//! input.
//!
//! A collapse puts a vertex where it fits the faces around it best as they were then. Here all of the
//! surface that is left is fitted to the input itself, after Hoppe, DeRose, Duchamp, McDonald and Stuetzle,
//! *Mesh optimization* (SIGGRAPH 1993), sections 4.1 and 4.2: points of the input are projected to the
//! surface, and then, the feet staying what they are in barycentric coordinates, the vertices moved by
//! least squares.
//!
//! Departures:
//! - It is done once, from a simplification that is good already, and not until it converges; the number of
//!   vertices is given, so no energy counts them, and no springs are needed.
//! - Feet are not searched for all over the surface: [`Surface::origins`] knows into which vertex each of
//!   the input's went, and from there it is a few steps ([`fit`]).
//! - What is least is the distance along the normals of the faces, not to the feet: a vertex may slide
//!   along what is flat. All that the vertices around a face need to know of its samples is then in a few
//!   sums ([`fit::Sums`]), and the iteration over the vertices looks at no sample ([`descent`]).
//! - Samples are few, 5 or so a face. Where they are fewer than a face's area asks for, its plane holds it;
//!   and a vertex is held near the input itself ([`anchors`]), as the least squares would else draw the
//!   ends of limbs out into spikes, which no point of the input is far from.
//!
//! Linear time, in the triangles of the input and more so in those of the result: beside the simplification,
//! 0.2 of its time at a hundredth of the triangles, 0.6 at a tenth, up to 3 at a half.

mod anchors;
mod descent;
mod facet;
mod fit;
mod flips;
mod neighbours;
mod samples;

use crate::collapse::surface::{NONE, Surface, flag};
use crate::mesh::Mesh;
use crate::monitor::Cancelled;
use crate::workers::Workers;
use anchors::anchors;
use descent::Descent;
use fit::{Shape, Sums};
use flips::flips;
use glam::Vec3A;
use neighbours::opposites;
use samples::{samples, sort};

/// How often each vertex is moved.
const SWEEPS: usize = 2;

/// Distances below this share of the coordinates and of the edges are rounding: nothing is done for them.
const ROUNDING: f32 = 1e-6;

/// Fits a compact `surface`, which was made of `input` and has its origins, to points of `input`.
/// Vertices that are locked, on a border, or at an edge that is not between two faces stay where they are, and
/// so do all if the sum of the points' squared distances would not fall. No vertex leaves the box between the
/// two corners of the `extent`.
pub(super) fn refine(
    surface: &mut Surface,
    input: &Mesh,
    extent: [Vec3A; 2],
    workers: &Workers,
    mut report: impl FnMut(f32) -> Result<(), Cancelled>,
) -> Result<(), Cancelled> {
    surface.find_rings();
    let across = opposites(surface, workers);
    let fixed = fixed(surface, &across);
    let mut samples = samples(Shape { surface, opposites: &across }, input, workers);
    report(0.4)?;
    let starts = sort(&mut samples, surface.faces.len());
    let mut sums = Shape { surface, opposites: &across }.fit(&mut samples, workers);
    let before = total(&sums);
    report(0.6)?;
    let turned = flips(Shape { surface, opposites: &across }, &samples, &starts, &sums, &fixed, workers);
    for flip in &turned {
        for side in 0..2 {
            surface.set_corners(flip.faces[side], flip.triangles[side]);
            sums[flip.faces[side] as usize] = flip.sums[side];
        }
    }
    if !turned.is_empty() {
        surface.find_rings();
    }
    let anchors = anchors(surface, &samples, &starts, &fixed, workers);
    let mut points = surface.points.clone();
    let descent = Descent::new(surface, &sums, &anchors, &fixed, extent, workers);
    for sweep in 0..SWEEPS {
        descent.sweep(&mut points, sweep % 2 == 1, workers);
    }
    report(0.8)?;
    std::mem::swap(&mut surface.points, &mut points);
    let across = opposites(surface, workers);
    let after = total(&Shape { surface, opposites: &across }.fit(&mut samples, workers));
    // Turned edges alone have made it no worse.
    let is_nearer = after < before;
    if !is_nearer {
        surface.points = points;
    }
    surface.drop_rings();
    // What was not legal may be so now.
    surface.flags.iter_mut().for_each(|flags| *flags &= !flag::BLOCKED);
    report(1.0)
}

/// The sum of the samples' squared distances, each times its weight.
fn total(sums: &[Sums]) -> f64 {
    sums.iter().map(|sums| f64::from(sums.error)).sum()
}

/// Which vertices stay: those that are locked, on a border, or at a side that does not lie between two faces.
fn fixed(surface: &Surface, opposites: &[[u32; 3]]) -> Vec<bool> {
    let stays = |flags: &u8| flags & (flag::LOCKED | flag::BOUNDARY | flag::DEAD) != 0;
    let mut fixed: Vec<bool> = surface.flags.iter().map(stays).collect();
    for (face, opposites) in (0..).zip(opposites) {
        for corner in (0..3).filter(|&corner| opposites[corner] == NONE) {
            let corners = surface.corners(face);
            fixed[corners[(corner + 1) % 3] as usize] = true;
            fixed[corners[(corner + 2) % 3] as usize] = true;
        }
    }
    fixed
}

/// Whether a squared distance says nothing, beside a vertex at `place` and an edge of this `length`.
#[inline(always)]
fn is_rounding(distance_squared: f32, place: Vec3A, length: f32) -> bool {
    distance_squared.sqrt() <= ROUNDING * (place.abs().max_element() + length)
}

/// The places of a face's corners.
#[inline(always)]
fn places(surface: &Surface, face: u32) -> [Vec3A; 3] {
    surface.corners(face).map(|vertex| Vec3A::from_vec4(surface.points[vertex as usize]))
}

#[cfg(test)]
mod tests;
