//! What it costs a vertex to go into each of its neighbours.

use glam::Vec3A;

use super::fan::Fan;
use crate::lanes::{LANES, Vectors};
use crate::quadric::Quadric;

/// What a half-edge collapse costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cost {
    /// The paper's (section 3.2): the length of the edge times the bend of the fan, each pair of faces
    /// weighted by how near they are. In units of length.
    #[default]
    Visual,
    /// Melax's, which the paper compares with: the length of the edge times the largest bend. In units of
    /// length.
    Melax,
    /// The sum of squared distances, weighted by area, from the planes of the vertex's faces as they are
    /// now (Garland and Heckbert's, without memory). In units of length to the fourth.
    Quadric,
}

/// How much of the squared length of the edge the quadric's cost has, as a share of its trace: among
/// collapses that cost nothing, the shortest goes first.
const DRAWN: f32 = 3e-6;

/// How much two unit normals differ: 0 to 2. Rounding must not make it less: costs are compared by their
/// bits.
fn bend(a: Vec3A, b: Vec3A) -> f32 {
    (1.0 - a.dot(b)).max(0.0)
}

/// Room to work in.
#[derive(Default)]
pub(super) struct Bends {
    /// Of the faces, of unit length.
    normals: Vec<Vec3A>,
    /// The weighted sums of equation 2 for each face as `b`, with the others after it on the rim, and with
    /// those before.
    after: Vec<f32>,
    before: Vec<f32>,
    /// Equation 1, by the distance of two faces.
    weights: Vec<f32>,
}

impl Bends {
    fn set_normals(&mut self, fan: &Fan) {
        self.normals.clear();
        self.normals.extend(fan.crosses.iter().map(|cross| cross.normalize_or_zero()));
    }
}

impl Cost {
    /// The costs of all neighbours of the fan, in their order; infinite where the collapse may not be.
    ///
    /// A border vertex goes along the border alone: the paper leaves that open, and a border that is not
    /// held erodes.
    pub(super) fn of_all(self, fan: &Fan, bends: &mut Bends, costs: &mut Vec<f32>) {
        costs.clear();
        match self {
            Self::Visual => visual(fan, bends, costs),
            Self::Melax => melax(fan, bends, costs),
            Self::Quadric => quadric(fan, costs),
        }
        if !fan.closed {
            let inner = 1..fan.faces();
            costs[inner].fill(f32::INFINITY);
        }
        // What is beyond the numbers there are is no cost.
        costs.iter_mut().filter(|cost| cost.is_nan()).for_each(|cost| *cost = f32::INFINITY);
    }
}

/// Equations 1 to 3. Both sums of every edge come from one look at each pair of faces.
///
/// On the border, where there is one face to compare with, it counts twice, and so does the turn of the
/// border itself.
fn visual(fan: &Fan, bends: &mut Bends, costs: &mut Vec<f32>) {
    bends.set_normals(fan);
    let Bends { normals, after, before, weights } = bends;
    let count = fan.faces();
    after.clear();
    after.resize(count, 0.0);
    before.clear();
    before.resize(count, 0.0);
    weights.clear();
    weights.extend((0..count).map(|steps| count as f32 / (count + steps) as f32));
    for i in 0..count {
        for j in i + 1..count {
            let bend = bend(normals[i], normals[j]);
            let near = weights[j - i];
            let far = if fan.closed { weights[count - (j - i)] } else { near };
            after[i] += bend * near;
            before[j] += bend * near;
            after[j] += bend * far;
            before[i] += bend * far;
        }
    }
    let turn = if fan.closed { 0.0 } else { border_turn(fan) };
    costs.extend((0..fan.neighbours().len()).map(|place| {
        let [left, right] = fan.beside(place);
        let sum = left.map_or(0.0, |face| before[face]) + right.map_or(0.0, |face| after[face]);
        let bend = if fan.is_border(place) { 2.0 * sum + 2.0 * turn } else { sum };
        fan.spokes[place].length() * bend
    }));
}

/// The bend between the outward normals, in the plane of their faces, of both border edges.
fn border_turn(fan: &Fan) -> f32 {
    let last = fan.faces() - 1;
    let first_outward = fan.spokes[0].cross(fan.crosses[0]).normalize_or_zero();
    let last_outward = fan.crosses[last].cross(fan.spokes[last + 1]).normalize_or_zero();
    bend(first_outward, last_outward)
}

/// Melax, *A simple, fast, and effective polygon reduction algorithm*, 1998: for each face of the vertex
/// the nearer of the faces beside the edge, and of these the farthest.
fn melax(fan: &Fan, bends: &mut Bends, costs: &mut Vec<f32>) {
    bends.set_normals(fan);
    let normals = &bends.normals;
    costs.extend((0..fan.neighbours().len()).map(|place| {
        let beside = fan.beside(place);
        let largest = normals.iter().fold(0f32, |largest, &normal| {
            let bends = beside.iter().flatten().map(|&face| 0.5 * bend(normal, normals[face]));
            largest.max(bends.fold(1.0, f32::min))
        });
        fan.spokes[place].length() * largest
    }));
}

fn quadric(fan: &Fan, costs: &mut Vec<f32>) {
    let mut quadric = Quadric::of_faces(fan.crosses.chunks(LANES).map(Vectors::filled_up));
    if !fan.closed {
        quadric.add_border(fan.spokes[0]);
        quadric.add_border(fan.spokes[fan.faces()]);
    }
    let drawn = DRAWN * quadric.trace();
    let spokes = &fan.spokes[..fan.neighbours().len()];
    costs.extend(spokes.iter().map(|&edge| quadric.at(edge) + drawn * edge.length_squared()));
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::super::corners::Corners;
    use super::*;

    /// Equation 2, by its letter: walks from each face beside the edge away from it.
    fn by_the_letter(points: &[DVec3], rim: &[usize], closed: bool, place: usize) -> f64 {
        let count = if closed { rim.len() } else { rim.len() - 1 };
        let normal = |face: usize| {
            let [a, b] = [points[rim[face]], points[rim[(face + 1) % rim.len()]]];
            (a - points[0]).cross(b - points[0]).normalize()
        };
        let mut sum = 0.0;
        let mut add = |beside: usize, other: usize, between: usize| {
            sum += (1.0 - normal(beside).dot(normal(other))) * count as f64 / (count + between) as f64;
        };
        if closed {
            let (right, left) = (place, (place + count - 1) % count);
            (0..count).for_each(|steps| add(right, (right + steps) % count, steps));
            (0..count).for_each(|steps| add(left, (left + count - steps) % count, steps));
        } else if place == 0 {
            (0..count).for_each(|face| add(0, face, face));
        } else {
            (0..count).for_each(|face| add(count - 1, face, count - 1 - face));
        }
        let length = (points[rim[place]] - points[0]).length();
        if closed {
            return length * sum;
        }
        let ends = [points[rim[0]] - points[0], points[rim[count]] - points[0]];
        let outward = [ends[0].cross(normal(0)).normalize(), normal(count - 1).cross(ends[1]).normalize()];
        length * (2.0 * sum + 2.0 * (1.0 - outward[0].dot(outward[1])))
    }

    proptest! {
        #[test]
        fn visual_is_equation_2(
            heights in prop::collection::vec((-0.7f64..0.7, 0.5f64..2.0), 3..9),
            closed in any::<bool>(),
        ) {
            let turn = if closed { std::f64::consts::TAU } else { 5.0 };
            let mut points = vec![DVec3::new(0.1, 0.2, 0.3)];
            points.extend(heights.iter().enumerate().map(|(index, &(height, radius))| {
                let (sine, cosine) = (turn * index as f64 / heights.len() as f64).sin_cos();
                DVec3::new(radius * cosine, radius * sine, height)
            }));
            let count = heights.len() - usize::from(!closed);
            let rim: Vec<usize> = (1..points.len()).collect();
            let faces: Vec<[u32; 3]> = (0..count)
                .map(|face| [0, rim[face] as u32, rim[(face + 1) % rim.len()] as u32])
                .collect();
            let singles: Vec<Vec3A> = points.iter().map(|point| point.as_vec3a()).collect();
            let mut fan = Fan::default();
            prop_assert!(fan.gather(0, &Corners::new(points.len(), &faces), &faces, &singles));
            prop_assert_eq!(fan.closed, closed);
            let mut costs = Vec::new();
            Cost::Visual.of_all(&fan, &mut Bends::default(), &mut costs);
            for (place, &cost) in costs.iter().enumerate() {
                if closed || place == 0 || place == count {
                    let at = rim.iter().position(|&vertex| vertex as u32 == fan.rim[place]).unwrap();
                    let expected = by_the_letter(&points, &rim, closed, at);
                    prop_assert!((f64::from(cost) - expected).abs() < 1e-4 * (1.0 + expected), "{cost} {expected}");
                } else {
                    prop_assert_eq!(cost, f32::INFINITY);
                }
            }
        }
    }
}
