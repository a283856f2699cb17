//! Where a point is nearest to one triangle, in double precision.

use glam::DVec3;

/// Below this squared sine of the angle at the first corner, a triangle counts as its edges: the
/// barycentric test would divide noise by noise, and the surface left out is thinner than 1e-10 of
/// its length.
const FLAT: f64 = 1e-20;

/// The normal, its length twice the area, or `None` for a triangle without area.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    (normal.length_squared() > FLAT * ab.length_squared() * ac.length_squared()).then_some(normal)
}

/// Squared distance from `point` to the triangle, which may be degenerate.
pub(super) fn distance_squared(point: DVec3, corners: [DVec3; 3]) -> f64 {
    match foot(point, corners) {
        Some(foot) => foot.height_squared,
        None => nearest_on_edges(point, corners).1,
    }
}

/// The point of the triangle nearest to `point`. Where rounding misleads, another point of the triangle,
/// but always one of it, to the last digits.
pub(super) fn nearest_point(point: DVec3, corners: [DVec3; 3]) -> DVec3 {
    match foot(point, corners) {
        Some(Foot { towards: [b, c], .. }) => {
            corners[0] + (corners[1] - corners[0]) * b + (corners[2] - corners[0]) * c
        }
        None => nearest_on_edges(point, corners).0,
    }
}

/// Where a point is over the inside of a triangle.
struct Foot {
    /// Weights of the second and the third corner.
    towards: [f64; 2],
    height_squared: f64,
}

/// `None` where the nearest point is on an edge.
fn foot(point: DVec3, corners: [DVec3; 3]) -> Option<Foot> {
    let [a, b, c] = corners;
    let normal = normal(corners)?;
    let from_a = point - a;
    let area = normal.length_squared();
    let towards_c = (b - a).cross(from_a).dot(normal);
    let towards_b = from_a.cross(c - a).dot(normal);
    (towards_c >= 0.0 && towards_b >= 0.0 && towards_c + towards_b <= area).then(|| {
        let height = from_a.dot(normal);
        Foot { towards: [towards_b / area, towards_c / area], height_squared: height * height / area }
    })
}

/// The nearest point on the edges, and its squared distance.
fn nearest_on_edges(point: DVec3, [a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let on_each = [[a, b], [b, c], [c, a]].map(|[start, end]| {
        let nearest = on_segment(point, start, end);
        (nearest, point.distance_squared(nearest))
    });
    on_each.into_iter().fold(on_each[0], |best, other| if other.1 < best.1 { other } else { best })
}

fn on_segment(point: DVec3, start: DVec3, end: DVec3) -> DVec3 {
    let along = end - start;
    let length = along.length_squared();
    let at = if length > 0.0 { ((point - start).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    start + along * at
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        // Small whole numbers make slivers, repeated corners and points on edges common.
        (-3..=3i32, -3..=3i32, -3..=3i32).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()))
    }

    /// Distance by descending along barycentric coordinates: a different road to the same number.
    fn searched(point: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
        let along = |u: f64| {
            let (start, end) = (a.lerp(b, u), a.lerp(c, u));
            narrow(|v| point.distance(start.lerp(end, v)))
        };
        narrow(along)
    }

    /// Minimum of a convex function on `0..=1`.
    fn narrow(value: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..100 {
            let third = (high - low) / 3.0;
            if value(low + third) <= value(high - third) { high -= third } else { low += third }
        }
        value(low).min(value(high))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn distance_is_the_minimum_over_the_triangle(p in point(), a in point(), b in point(), c in point()) {
            let found = distance_squared(p, [a, b, c]).sqrt();
            let expected = searched(p, [a, b, c]);
            prop_assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
            let nearest = nearest_point(p, [a, b, c]);
            prop_assert!((nearest.distance(p) - found).abs() < 1e-9, "{nearest} is not {found} away");
            prop_assert!(searched(nearest, [a, b, c]) < 1e-6, "{nearest} is not of the triangle");
        }
    }

    #[test]
    fn a_needle_counts_as_its_edges() {
        let needle = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1e-13, 0.0)];
        assert_eq!(normal(needle), None);
        assert_eq!(distance_squared(DVec3::new(0.25, 0.0, 2.0), needle), 4.0);
    }
}
