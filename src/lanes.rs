//! Four faces at a time: numbers, names, and vectors coordinate by coordinate, side by side.
//!
//! What is worked out for each face around a vertex is the same for all of them, and a vector instruction does
//! it for four at once, where one vector at a time fills three of four lanes and spends half its instructions
//! on moving coordinates. All lanes round as single numbers do, so that nothing depends on the processor; sums
//! over lanes have one order. Eight at a time would not do more: most rings have five to seven faces, and the
//! sums of a quadric then no longer fit the registers.

use glam::{Vec3A, Vec4};
use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// How many faces there are side by side.
pub(crate) const LANES: usize = 4;

/// A number for each of four faces; or what a comparison of two makes: for each whether it holds.
pub(crate) type Numbers = wide::f32x4;

/// One number, or one for each of four faces: what is worked out in the same way for both is written once.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// `number`, for each face.
    fn of(number: f32) -> Self;

    /// Zero in place of what is less.
    fn not_negative(self) -> Self;
}

impl Number for f32 {
    #[inline(always)]
    fn of(number: f32) -> Self {
        number
    }

    #[inline(always)]
    fn not_negative(self) -> Self {
        self.max(0.0)
    }
}

impl Number for Numbers {
    #[inline(always)]
    fn of(number: f32) -> Self {
        Self::splat(number)
    }

    #[inline(always)]
    fn not_negative(self) -> Self {
        self.fast_max(Self::ZERO)
    }
}

/// The name of a vertex for each of four faces.
pub(crate) type Names = wide::u32x4;

/// A vector for each of four faces.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Vectors {
    x: Numbers,
    y: Numbers,
    z: Numbers,
}

/// All ones in the first `count` lanes, nothing in the others.
#[inline(always)]
pub(crate) fn first_lanes(count: usize) -> Names {
    Names::new(FIRST_LANES[count.min(LANES)])
}

const FIRST_LANES: [[u32; LANES]; LANES + 1] = {
    const ALL: u32 = u32::MAX;
    [[0; LANES], [ALL, 0, 0, 0], [ALL, ALL, 0, 0], [ALL, ALL, ALL, 0], [ALL; LANES]]
};

/// The sums over the lanes of four numbers each.
#[inline(always)]
pub(crate) fn sums(numbers: [Numbers; 4]) -> [f32; 4] {
    let [a, b, c, d] = Numbers::transpose(numbers);
    ((a + b) + (c + d)).to_array()
}

/// Brings vectors side by side, and names whose bits are in their last coordinate.
#[inline(always)]
pub(crate) fn named_vectors(vectors: [Vec4; LANES]) -> (Vectors, Names) {
    let rows = vectors.map(|vector| Numbers::new(vector.to_array()));
    let [x, y, z, names] = Numbers::transpose(rows);
    (Vectors { x, y, z }, wide::bytemuck::cast(names))
}

/// The largest of the lanes.
#[inline(always)]
pub(crate) fn largest(numbers: Numbers) -> f32 {
    numbers.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max)
}

impl Vectors {
    #[inline(always)]
    pub(crate) fn splat(vector: Vec3A) -> Self {
        let [x, y, z] = vector.to_array().map(Numbers::splat);
        Self { x, y, z }
    }

    /// Those of four faces or fewer, and nothing for the others.
    #[inline(always)]
    pub(crate) fn filled_up(vectors: &[Vec3A]) -> Self {
        named_vectors(from_fn(|lane| vectors.get(lane).map_or(Vec4::ZERO, |vector| vector.extend(0.0)))).0
    }

    /// What it is where `mask` is all ones, and nothing where it is not.
    #[inline(always)]
    pub(crate) fn masked(self, mask: Names) -> Self {
        let mask: Numbers = wide::bytemuck::cast(mask);
        Self { x: self.x & mask, y: self.y & mask, z: self.z & mask }
    }

    #[inline(always)]
    pub(crate) fn coordinates(self) -> [Numbers; 3] {
        [self.x, self.y, self.z]
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> Numbers {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub(crate) fn length_squared(self) -> Numbers {
        self.dot(self)
    }

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

impl From<[Numbers; 3]> for Vectors {
    #[inline(always)]
    fn from([x, y, z]: [Numbers; 3]) -> Self {
        Self { x, y, z }
    }
}

impl From<Vectors> for [Numbers; 3] {
    #[inline(always)]
    fn from(vectors: Vectors) -> Self {
        vectors.coordinates()
    }
}

impl Add for Vectors {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for Vectors {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul<Numbers> for Vectors {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Numbers) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vectors() -> impl Strategy<Value = Vec<Vec3A>> {
        prop::collection::vec([-9.0f32..9.0, -9.0..9.0, -9.0..9.0].prop_map(Vec3A::from), 0..=LANES)
    }

    proptest! {
        /// To the last bit, and nothing in lanes that have no vector.
        #[test]
        fn a_lane_is_what_its_vector_is(a in vectors(), b in vectors(), factor in -3.0f32..3.0) {
            let lane = |vectors: &[Vec3A], lane: usize| vectors.get(lane).copied().unwrap_or(Vec3A::ZERO);
            let (side_by_side, other) = (Vectors::filled_up(&a), Vectors::filled_up(&b));
            let at = |vectors: Vectors, lane: usize| {
                Vec3A::from(vectors.coordinates().map(|numbers| numbers.to_array()[lane]))
            };
            for index in 0..LANES {
                let (a, b) = (lane(&a, index), lane(&b, index));
                prop_assert_eq!(at(side_by_side, index), a);
                prop_assert_eq!(at(side_by_side.cross(other), index), a.cross(b));
                prop_assert_eq!(at(side_by_side + other, index), a + b);
                prop_assert_eq!(at(side_by_side - other, index), a - b);
                prop_assert_eq!(at(side_by_side * Numbers::splat(factor), index), a * factor);
                prop_assert_eq!(side_by_side.dot(other).to_array()[index], a.x * b.x + a.y * b.y + a.z * b.z);
            }
        }

        #[test]
        fn lanes_are_summed_and_compared(numbers in prop::array::uniform4(prop::array::uniform4(-9.0f32..9.0))) {
            let found = sums(numbers.map(Numbers::new));
            for (numbers, found) in numbers.into_iter().zip(found) {
                prop_assert!((numbers.iter().sum::<f32>() - found).abs() < 1e-5);
                let most = numbers.into_iter().fold(f32::MIN, f32::max);
                prop_assert_eq!(largest(Numbers::new(numbers)), most);
            }
        }

        /// Names are numbers that are no numbers, too.
        #[test]
        fn names_come_through_as_they_are(names in prop::array::uniform4(any::<u32>()), count in 0usize..9) {
            let ways = names.map(|name| Vec3A::ONE.extend(f32::from_bits(name)));
            let (ways, found) = named_vectors(ways);
            prop_assert_eq!(found.to_array(), names);
            let first = first_lanes(count).to_array();
            prop_assert_eq!(first, from_fn(|lane| if lane < count { u32::MAX } else { 0 }));
            let [x, y, z] = ways.masked(first_lanes(count)).coordinates();
            let expected: [f32; LANES] = from_fn(|lane| if lane < count { 1.0 } else { 0.0 });
            prop_assert!([x, y, z].iter().all(|numbers| numbers.to_array() == expected));
        }
    }
}
