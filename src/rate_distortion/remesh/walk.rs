//! The nearest point of a surface, found by walking there from a point nearby.
//!
//! A search over the whole surface would jump to the other side of a thin limb; a walk stays on the side it is on.

use glam::DVec3;

use super::chart::{Chart, Foot};

/// A walk that takes more steps than this is lost in rounding.
const STEPS: usize = 1000;

/// Gains below this share of the distance are rounding.
const GAIN: f64 = 1e-12;

impl Chart {
    /// The point nearest to `goal` among all that can be reached from `start` through faces that come nearer and
    /// nearer.
    pub(super) fn walk(&self, start: &Foot, goal: DVec3) -> Foot {
        let mut here = self.nearest_in(start.face, goal);
        for _ in 0..STEPS {
            let names = self.names(here.foot.face);
            let zero = |place: usize| here.foot.weights[place] == 0.0;
            let on = (0..3).filter(|&place| !zero(place)).count();
            let better = match on {
                // Inside.
                3 => None,
                2 => (0..3)
                    .find(|&place| zero(place))
                    .and_then(|place| self.across(here.foot.face, place))
                    .map(|face| self.nearest_in(face, goal)),
                _ => {
                    let vertex = (0..3).find(|&place| !zero(place)).map_or(names[0], |place| names[place]);
                    let all = self.faces_at(vertex).iter().map(|&face| self.nearest_in(face, goal));
                    all.reduce(|best, other| if other.squared < best.squared { other } else { best })
                }
            };
            match better {
                Some(better) if better.squared < here.squared * (1.0 - GAIN) => here = better,
                _ => break,
            }
        }
        here.foot
    }

    /// As [`Chart::walk`], along a border, from a point on it.
    pub(super) fn walk_on_border(&self, start: &Foot, goal: DVec3) -> Foot {
        let border = |face: u32, place: usize| self.across(face, place).is_none();
        // Rounding may have moved a point off its edge a little.
        let edge = (0..3)
            .filter(|&place| border(start.face, place))
            .min_by(|&a, &b| start.weights[a].total_cmp(&start.weights[b]));
        let Some(place) = edge else {
            // At a vertex of the border, in a face without a border edge: begin with an edge at that vertex.
            let names = self.names(start.face);
            let vertex = (0..3).max_by(|&a, &b| start.weights[a].total_cmp(&start.weights[b]));
            let faces = self.faces_at(names[vertex.unwrap_or(0)]);
            let found = faces.iter().find_map(|&face| {
                let place = (0..3).find(|&place| {
                    self.names(face)[place] != names[vertex.unwrap_or(0)] && border(face, place)
                })?;
                Some(self.nearest_on_edge(face, place, goal))
            });
            return found.map_or(*start, |found| self.along_border(found, goal));
        };
        self.along_border(self.nearest_on_edge(start.face, place, goal), goal)
    }

    fn along_border(&self, mut here: Near, goal: DVec3) -> Foot {
        for _ in 0..STEPS {
            let names = self.names(here.foot.face);
            let Some(end) = (0..3).find(|&place| here.foot.weights[place] == 1.0) else { break };
            let edges = self.faces_at(names[end]).iter().flat_map(|&face| {
                let at = self.names(face);
                let places = (0..3).filter(move |&place| at[place] != names[end]);
                places
                    .filter(move |&place| self.across(face, place).is_none())
                    .map(move |place| self.nearest_on_edge(face, place, goal))
            });
            match edges.reduce(|best, other| if other.squared < best.squared { other } else { best }) {
                Some(better) if better.squared < here.squared * (1.0 - GAIN) => here = better,
                _ => break,
            }
        }
        here.foot
    }

    fn nearest_in(&self, face: u32, goal: DVec3) -> Near {
        let weights = nearest(goal, self.corners(face));
        let foot = Foot { face, weights };
        Near { foot, squared: self.point(&foot).distance_squared(goal) }
    }

    /// On the edge opposite a corner.
    fn nearest_on_edge(&self, face: u32, place: usize, goal: DVec3) -> Near {
        let corners = self.corners(face);
        let (a, b) = ((place + 1) % 3, (place + 2) % 3);
        let along = corners[b] - corners[a];
        let length = along.length_squared();
        let at = if length > 0.0 { ((goal - corners[a]).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
        let mut weights = [0.0; 3];
        (weights[a], weights[b]) = (1.0 - at, at);
        let foot = Foot { face, weights };
        Near { foot, squared: self.point(&foot).distance_squared(goal) }
    }
}

#[derive(Clone, Copy)]
struct Near {
    foot: Foot,
    squared: f64,
}

/// The weights of the point of a triangle nearest to `point`; zero, exactly, where it is on an edge or a corner.
/// After Ericson, "Real-Time Collision Detection", section 5.1.5.
fn nearest(point: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let along = |from: DVec3| (ab.dot(point - from), ac.dot(point - from));
    let (d1, d2) = along(a);
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = along(b);
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let of_c = d1 * d4 - d3 * d2;
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let at = d1 / (d1 - d3);
        return [1.0 - at, at, 0.0];
    }
    let (d5, d6) = along(c);
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let of_b = d5 * d2 - d1 * d6;
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let at = d2 / (d2 - d6);
        return [1.0 - at, 0.0, at];
    }
    let of_a = d3 * d6 - d5 * d4;
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        let at = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - at, at];
    }
    let sum = of_a + of_b + of_c;
    [of_a / sum, of_b / sum, of_c / sum]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn place() -> impl Strategy<Value = DVec3> {
        [-3..=3i32, -3..=3, -3..=3].prop_map(|at| DVec3::from(at.map(f64::from)))
    }

    proptest! {
        #[test]
        fn nothing_of_a_triangle_is_nearer(point in place(), a in place(), b in place(), c in place()) {
            prop_assume!((b - a).cross(c - a) != DVec3::ZERO);
            let weights = nearest(point, [a, b, c]);
            prop_assert!(weights.iter().all(|&weight| weight >= 0.0));
            prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let found = (a * weights[0] + b * weights[1] + c * weights[2]).distance(point);
            for i in 0..=20 {
                for j in 0..=20 - i {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    let other = a * (1.0 - u - v) + b * u + c * v;
                    prop_assert!(found <= other.distance(point) + 1e-12);
                }
            }
        }
    }
}
