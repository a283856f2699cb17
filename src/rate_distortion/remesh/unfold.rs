//! Laying the triangles around a vertex into the plane, so that those that take their place when the vertex
//! goes lie there too.
//!
//! Lee, Sweldens, Schröder, Cowsar and Dobkin, "MAPS: Multiresolution Adaptive Parameterization of Surfaces"
//! (SIGGRAPH 1998), section 3.2: the power of the complex plane that makes the angles around the vertex a full
//! turn, or half of one on a border. Where triangles would fold, the paper chooses others; here the triangles are
//! given, all meeting at the vertex's heir, so the plane gives way: a regular polygon takes them all.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

/// Triangles whose area in the plane is a smaller share of their longest side's square count as folded.
const FLAT: f64 = 1e-3;

/// The places of a ring around a vertex, which comes to lie at the origin: `ring` is counter-clockwise, the first
/// and the last being neighbours unless `is_open` (then at least three). In the plane, all triangles of two
/// neighbours and the origin, and all of two neighbours and `heir` (an index, at either end of an open ring), are
/// counter-clockwise.
pub(super) fn unfold(vertex: DVec3, ring: &[DVec3], is_open: bool, heir: usize) -> Vec<DVec2> {
    let conformal = conformal(vertex, ring, is_open);
    match conformal.filter(|places| is_sound(places, is_open, heir)) {
        Some(places) => places,
        None => regular(ring.len(), is_open),
    }
}

fn conformal(vertex: DVec3, ring: &[DVec3], is_open: bool) -> Option<Vec<DVec2>> {
    let spokes: Vec<DVec3> = ring.iter().map(|&place| place - vertex).collect();
    let angles: Vec<f64> =
        (0..spokes.len()).map(|i| spokes[i].angle_between(spokes[(i + 1) % spokes.len()])).collect();
    let (turn, sum) = match is_open {
        true => (PI, angles[..angles.len() - 1].iter().sum::<f64>()),
        false => (TAU, angles.iter().sum()),
    };
    let power = turn / sum;
    let mean = spokes.iter().map(|spoke| spoke.length()).sum::<f64>() / spokes.len() as f64;
    let mut angle = 0.0;
    let mut places = Vec::with_capacity(ring.len());
    for (spoke, between) in spokes.iter().zip(angles) {
        places.push(DVec2::from_angle(angle) * (spoke.length() / mean).powf(power));
        angle += between * power;
    }
    if is_open && let Some(last) = places.last_mut() {
        // Borders stay straight to the last digit.
        *last = DVec2::new(-last.length(), 0.0);
    }
    places.iter().all(|place| place.is_finite()).then_some(places)
}

fn is_sound(places: &[DVec2], is_open: bool, heir: usize) -> bool {
    let stands = |a: DVec2, b: DVec2, c: DVec2| {
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        (b - a).perp_dot(c - a) > FLAT * longest
    };
    let count = places.len();
    (0..count - usize::from(is_open)).all(|i| {
        let next = (i + 1) % count;
        stands(DVec2::ZERO, places[i], places[next])
            && (i == heir || next == heir || stands(places[heir], places[i], places[next]))
    })
}

fn regular(count: usize, is_open: bool) -> Vec<DVec2> {
    let step = if is_open { PI / (count - 1) as f64 } else { TAU / count as f64 };
    let mut places: Vec<DVec2> = (0..count).map(|i| DVec2::from_angle(step * i as f64)).collect();
    if is_open {
        places[count - 1] = DVec2::new(-1.0, 0.0);
    }
    places
}

/// The weights of `place` for the corners origin, `a` and `b` of a triangle in the plane.
pub(super) fn weights(place: DVec2, a: DVec2, b: DVec2) -> [f64; 3] {
    let area = a.perp_dot(b);
    let (of_a, of_b) = (place.perp_dot(b) / area, a.perp_dot(place) / area);
    [1.0 - of_a - of_b, of_a, of_b]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn all_triangles_stand_upright(
            ring in prop::collection::vec([-3..=3i32, -3..=3, -3..=3], 3..9),
            is_open: bool,
            heir in 0..9usize,
        ) {
            let ring: Vec<DVec3> = ring.iter().map(|at| DVec3::from(at.map(f64::from))).collect();
            let heir = if is_open { heir % 2 * (ring.len() - 1) } else { heir % ring.len() };
            let places = unfold(DVec3::ZERO, &ring, is_open, heir);
            prop_assert!(is_sound(&places, is_open, heir), "{places:?}");
            if is_open {
                prop_assert_eq!((places[0].y, places[ring.len() - 1].y), (0.0, 0.0));
            }
        }
    }

    #[test]
    fn a_flat_ring_keeps_its_shape() {
        let ring = [[2.0, 0.0], [1.0, 2.0], [-2.0, 1.0], [-1.0, -1.0], [1.0, -2.0]].map(DVec2::from);
        let places = unfold(DVec3::Z, &ring.map(|at| at.extend(1.0)), false, 0);
        let scale = ring[0].x / places[0].x;
        for (place, at) in places.into_iter().zip(ring) {
            assert!((place * scale - at).length() < 1e-9);
        }
        let [of_origin, of_a, of_b] = weights(DVec2::new(0.5, 0.25), DVec2::X, DVec2::Y);
        assert_eq!([of_origin, of_a, of_b], [0.25, 0.5, 0.25]);
    }
}
