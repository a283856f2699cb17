//! The showpiece: a knotted column, in parts polished, fluted, beaded and weathered.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::noise::{fractal_noise, ridged_noise};
use super::{Mesh, built, ring_triangles};

/// A trefoil knot carved as a column: polished stretches that simplify to nearly nothing beside flutes,
/// beads and rough stone that do not. Closed, of genus 1, about 3.2 wide.
///
/// It has at most `triangles`, held to `1_000..=200_000_000`, and misses them by less than a ring of the
/// column, which is less than one in a hundred from ten thousand on.
pub fn statue(triangles: usize) -> Mesh {
    let triangles = triangles.clamp(1_000, 200_000_000);
    // The knot is about eleven times as long as the column is round. A whole number of vertices a flute
    // puts one on every ridge.
    let m = FLUTES * ((triangles as f64 / 22.0).sqrt() / FLUTES as f64).round().max(1.0) as usize;
    let n = triangles / (2 * m);
    let positions = (0..n).into_par_iter().flat_map_iter(|i| {
        let ring = Ring::new(i as f64 / n as f64);
        (0..m).map(move |j| ring.point(j as f64 / m as f64))
    });
    built(positions.collect(), ring_triangles(n, m))
}

/// From the axis of the knot to the middle of the torus that it winds round.
const KNOT: f64 = 1.0;
/// From there to the middle of the column.
const WINDING: f64 = 0.45;
/// From there to the surface of the column, unadorned.
const COLUMN: f64 = 0.2;
/// Flutes round the column.
const FLUTES: usize = 12;
/// How many times they, and the rows of vertices, wind about it.
const TWIST: f64 = 4.0;
/// Stretches of ornament along the column.
const STRETCHES: f64 = 9.0;

/// A cross-section of the column: its place in space, and how much of which ornament it has.
#[derive(Debug, Clone, Copy)]
struct Ring {
    along: f64,
    center: [f64; 3],
    normal: [f64; 3],
    binormal: [f64; 3],
    collar: f64,
    flutes: f64,
    beads: f64,
    stone: f64,
}

impl Ring {
    /// The cross-section at `along`, from 0 to 1 once along the knot.
    fn new(along: f64) -> Self {
        let (sin_round, cos_round) = (2.0 * TAU * along).sin_cos();
        let (sin_wind, cos_wind) = (3.0 * TAU * along).sin_cos();
        let radius = KNOT + WINDING * cos_wind;
        // The normal of the torus is at right angles to the knot and comes back to itself, so that the
        // column closes without a twist.
        let normal = [cos_wind * cos_round, cos_wind * sin_round, sin_wind];
        let tangent = unit([
            -2.0 * radius * sin_round - 3.0 * WINDING * sin_wind * cos_round,
            2.0 * radius * cos_round - 3.0 * WINDING * sin_wind * sin_round,
            3.0 * WINDING * cos_wind,
        ]);
        let stretch = along * STRETCHES;
        let within = stretch.fract();
        // Every ornament fades in and out behind the collars.
        let shown = smooth_step(0.06, 0.16, within) * smooth_step(0.06, 0.16, 1.0 - within);
        let share = |kind: usize| if stretch as usize % 3 == kind { shown } else { 0.0 };
        Self {
            along,
            center: [radius * cos_round, radius * sin_round, WINDING * sin_wind],
            normal,
            binormal: cross(normal, tangent),
            collar: collar(within.min(1.0 - within)),
            flutes: share(0),
            beads: share(1) * smooth_step(0.3, 0.34, within.min(1.0 - within)),
            stone: share(2),
        }
    }

    /// The point on the surface at `turn`, from 0 to 1 once round the column, following the twist.
    fn point(&self, turn: f64) -> [f32; 3] {
        let round = (turn - TWIST * self.along).rem_euclid(1.0);
        let (sin, cos) = (TAU * round).sin_cos();
        let direction: [f64; 3] =
            std::array::from_fn(|axis| cos * self.normal[axis] + sin * self.binormal[axis]);
        let at = |radius: f64| -> [f32; 3] {
            std::array::from_fn(|axis| (self.center[axis] + radius * direction[axis]) as f32)
        };
        let mut height = self.collar;
        if self.flutes > 0.0 {
            // Sharp ridges between round grooves.
            let groove = (TAU / 2.0 * FLUTES as f64 * turn).sin().abs();
            height -= 0.028 * self.flutes * groove;
        }
        if self.beads > 0.0 {
            height += 0.02 * self.beads * bead(self.along * 216.0, round * 20.0);
        }
        if self.stone > 0.0 {
            let skin = at(COLUMN);
            let rough = 0.045 * fractal_noise(skin.map(|x| 6.0 * x), 3, 11)
                + 0.02 * ridged_noise(skin.map(|x| 9.0 * x), 4, 23);
            height += self.stone * f64::from(rough);
        }
        at(COLUMN + height)
    }
}

/// A moulding at the end of a stretch: a band with sharp edges and a fillet beside it.
fn collar(distance: f64) -> f64 {
    let band = smooth_step(0.036, 0.033, distance);
    let fillet = (1.0 - ((distance - 0.046) / 0.008).powi(2)).max(0.0).sqrt();
    0.03 * band + 0.014 * fillet
}

/// Half-round beads in staggered rows, one a unit cell.
fn bead(row: f64, column: f64) -> f64 {
    let shifted = column + 0.5 * (row.floor() % 2.0);
    let (x, y) = (2.0 * row.fract() - 1.0, 2.0 * shifted.fract() - 1.0);
    (1.0 - (x * x + y * y) / 0.8).max(0.0).sqrt()
}

/// 0 up to `from`, 1 after `to`, smooth between; falling where `to` is less than `from`.
fn smooth_step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}
