//! A triangle as points near it see it.

use glam::Vec3A;

/// A face of a valley hides another from what is higher than this share of its distance from the side between
/// them, inverse and squared: where the valley is as narrow as 53 degrees.
const VALLEY: f32 = 4.0;

/// A triangle that has an area.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facet {
    corner: Vec3A,
    /// The sides from the first corner to the others.
    sides: [Vec3A; 2],
    /// How fast the weights of the second and the third corner grow.
    slopes: [Vec3A; 2],
    pub(super) normal: Vec3A,
}

/// The point of a triangle that is nearest to another point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The weights of the corners of which it is the mean: none below 0, 1 in all.
    pub(super) weights: [f32; 3],
    /// How far the other point lies above the triangle's plane.
    pub(super) height: f32,
    pub(super) distance_squared: f32,
}

impl Facet {
    /// `None` if the triangle has no area that single precision knows of.
    #[inline(always)]
    pub(super) fn new([a, b, c]: [Vec3A; 3]) -> Option<Self> {
        let (second, third) = (b - a, c - a);
        let cross = second.cross(third);
        let square = cross.length_squared();
        if square < f32::MIN_POSITIVE {
            return None;
        }
        let inverse = 1.0 / square;
        Some(Self {
            corner: a,
            sides: [second, third],
            slopes: [third.cross(cross) * inverse, cross.cross(second) * inverse],
            normal: cross * inverse.sqrt(),
        })
    }

    /// The weights of the corners of which the foot of `point` on the plane is the mean: one is below 0 if
    /// the foot is outside, beyond the side opposite that corner.
    #[inline(always)]
    pub(super) fn weights(&self, point: Vec3A) -> [f32; 3] {
        let offset = point - self.corner;
        let [second, third] = self.slopes.map(|slope| slope.dot(offset));
        [1.0 - second - third, second, third]
    }

    /// Beyond which sides, each named by the corner opposite, another face may be nearer to `point`, of
    /// which these are the `weights` here: those beyond which it lies, and those that are nearer than it is
    /// high, as two faces of a valley are both below what is between them.
    #[inline(always)]
    pub(super) fn doubtful(&self, point: Vec3A, weights: [f32; 3]) -> [bool; 3] {
        let height = self.normal.dot(point - self.corner);
        let reach = VALLEY * height * height;
        let [second, third] = self.slopes;
        let slopes = [(second + third).length_squared(), second.length_squared(), third.length_squared()];
        [0, 1, 2].map(|side| weights[side] < 0.0 || weights[side] * weights[side] < reach * slopes[side])
    }

    /// The nearest point, if its `weights` are those of a foot inside.
    #[inline(always)]
    pub(super) fn inside(&self, point: Vec3A, weights: [f32; 3]) -> Foot {
        let height = self.normal.dot(point - self.corner);
        Foot { weights, height, distance_squared: height * height }
    }

    /// The nearest point, given the `weights` of the foot on the plane.
    #[inline(always)]
    pub(super) fn nearest(&self, point: Vec3A, weights: [f32; 3]) -> Foot {
        if weights.iter().all(|&weight| weight >= 0.0) {
            self.inside(point, weights)
        } else {
            self.nearest_on_sides(point, weights)
        }
    }

    /// The nearest point of the sides beyond which the foot lies.
    #[inline(never)]
    fn nearest_on_sides(&self, point: Vec3A, weights: [f32; 3]) -> Foot {
        let offset = point - self.corner;
        let corners = [Vec3A::ZERO, self.sides[0], self.sides[1]];
        let height = self.normal.dot(offset);
        let mut best = Foot { weights: [1.0, 0.0, 0.0], height, distance_squared: f32::INFINITY };
        for beyond in (0..3).filter(|&corner| weights[corner] < 0.0) {
            let (from, to) = ((beyond + 1) % 3, (beyond + 2) % 3);
            let side = corners[to] - corners[from];
            let start = offset - corners[from];
            let along = (start.dot(side) / side.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
            let distance_squared = (start - along * side).length_squared();
            if distance_squared < best.distance_squared {
                let mut weights = [0.0; 3];
                weights[from] = 1.0 - along;
                weights[to] = along;
                best = Foot { weights, height, distance_squared };
            }
        }
        best
    }
}
