//! Which samples of a grid a triangle covers.
//!
//! Corners are samples, so all of this is exact: no sample between two triangles is lost or counted twice, however
//! thin they are. A sample on an edge belongs to the triangle that has the edge at its left or on top, as in
//! hardware rasterisers; on the *rim*, where no other triangle could have it, to the one there is. Corners belong
//! to no triangle: they are the affair of whoever knows the vertices.

use std::ops::Range;

/// A sample by its column and row.
pub(crate) type Place = [i32; 2];

/// Twice the area of a triangle, positive if it is counter-clockwise seen from above with row 0 in the north.
pub(crate) fn twice_area([a, b, c]: [Place; 3]) -> i64 {
    let across = |from: Place, to: Place| i64::from(to[0] - from[0]);
    let down = |from: Place, to: Place| i64::from(to[1] - from[1]);
    across(a, c) * down(a, b) - across(a, b) * down(a, c)
}

/// The rows of samples that a triangle owns, from the top down: each row and its columns.
pub(crate) struct Rows {
    /// The row before the next.
    row: i32,
    last: i32,
    left: Side,
    right: Side,
    /// Where the left and the right side turn towards the bottom.
    turns: [Place; 2],
    bottom: Place,
    is_bottom_rim: bool,
}

impl Rows {
    /// The rows of a triangle that is counter-clockwise and has an area. `rim[k]` says whether the edge from
    /// corner `k` to the next is on the rim.
    #[inline(always)]
    pub(crate) fn of(corners: [Place; 3], rim: [bool; 3]) -> Self {
        // From the top (its left end, where it is an edge), one side runs down at the left and one at the right.
        let above = |a: usize, b: usize| (corners[a][1], corners[a][0]) < (corners[b][1], corners[b][0]);
        let top = match (above(0, 1), above(1, 2), above(2, 0)) {
            (true, _, false) => 0,
            (false, true, _) => 1,
            _ => 2,
        };
        let (at_left, at_right) = ((top + 1) % 3, (top + 2) % 3);
        let (is_bottom_rim, is_right_rim) = (rim[at_left], rim[at_right]);
        let (top, at_left, at_right) = (corners[top], corners[at_left], corners[at_right]);

        let bottom = if at_left[1] > at_right[1] { at_left } else { at_right };
        let is_owned_bottom = at_left[1] == at_right[1] && is_bottom_rim;
        let last = if is_owned_bottom { bottom[1] } else { bottom[1] - 1 };
        let left = Side::new(top, at_left, false);
        if top[1] == at_right[1] {
            // The first row is the edge at the top, and both sides begin with a turn.
            let right = Side::new(at_right, bottom, is_bottom_rim);
            return Self {
                row: top[1] - 1,
                last,
                left,
                right,
                turns: [top, at_right],
                bottom,
                is_bottom_rim,
            };
        }
        let right = Side::new(top, at_right, is_right_rim);
        Self { row: top[1], last, left, right, turns: [at_left, at_right], bottom, is_bottom_rim }
    }
}

impl Iterator for Rows {
    type Item = (i32, Range<i32>);

    #[inline(always)]
    fn next(&mut self) -> Option<(i32, Range<i32>)> {
        self.row += 1;
        if self.row > self.last {
            return None;
        }
        let [at_left, at_right] = self.turns;
        let start = if self.row == at_left[1] {
            self.left = Side::new(at_left, self.bottom, false);
            at_left[0] + 1
        } else {
            self.left.advance()
        };
        let end = if self.row == at_right[1] {
            self.right = Side::new(at_right, self.bottom, self.is_bottom_rim);
            at_right[0]
        } else {
            self.right.advance()
        };
        Some((self.row, start..end))
    }
}

/// An edge that is walked down row by row.
///
/// It crosses a row at `numerator / height` columns from `origin`: whole numbers below 2^32, as columns times
/// rows are. Where that is no whole number it is at least `1 / height` away from one, which is far more than a
/// product with the reciprocal may be wrong; so a numerator moved by a quarter is rounded as it should be, to
/// either side of an exact crossing as the sign of the quarter says.
struct Side {
    origin: i32,
    numerator: f64,
    step: f64,
    reciprocal: f64,
}

impl Side {
    /// The edge down from one place to another. A sample on it is at its right, unless `beyond`.
    #[inline(always)]
    fn new(from: Place, to: Place, beyond: bool) -> Self {
        let origin = from[0].min(to[0]);
        let height = f64::from(to[1] - from[1]);
        let quarter = if beyond { 0.25 } else { -0.25 };
        // One column more, because what is rounded towards zero then is rounded up.
        let numerator = f64::from(from[0] - origin + 1) * height + quarter;
        Self { origin, numerator, step: f64::from(to[0] - from[0]), reciprocal: 1.0 / height }
    }

    /// The first column right of the edge in the next row.
    #[inline(always)]
    fn advance(&mut self) -> i32 {
        self.numerator += self.step;
        self.origin + (self.numerator * self.reciprocal) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::{Place, Rows, twice_area};
    use proptest::prelude::*;

    /// A triangle counter-clockwise, or none if it is flat.
    fn turned([a, b, c]: [Place; 3]) -> Option<[Place; 3]> {
        match twice_area([a, b, c]) {
            0 => None,
            area if area > 0 => Some([a, b, c]),
            _ => Some([a, c, b]),
        }
    }

    /// Whether a triangle owns a sample, by the rule: it does if a point a little to the right, and by far less below,
    /// is inside, or if the sample is on the rim; never if it is a corner.
    fn owns(corners: [Place; 3], rim: [bool; 3], sample: Place) -> bool {
        let beside = |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            // How the area with the edge changes as the sample goes right, and down.
            let (right, below) = ((to[1] - from[1]).signum(), (from[0] - to[0]).signum());
            (twice_area([from, to, sample]), if right == 0 { below } else { right }, rim[k])
        };
        !corners.contains(&sample)
            && (0..3).map(beside).all(|(area, shifted, rim)| area > 0 || area == 0 && (rim || shifted > 0))
    }

    proptest! {
        #[test]
        fn rows_are_those_of_the_rule(
            places in prop::array::uniform3(prop::array::uniform2(0i32..9)),
            rim in prop::array::uniform3(any::<bool>()),
        ) {
            let Some(corners) = turned(places) else { return Ok(()) };
            let mut owned: Vec<Place> = Rows::of(corners, rim)
                .flat_map(|(row, columns)| columns.map(move |column| [column, row]))
                .collect();
            prop_assert!(owned.is_sorted_by_key(|&[column, row]| (row, column)));
            let mut all: Vec<Place> = (0..9).flat_map(|row| (0..9).map(move |column| [column, row])).collect();
            all.retain(|&sample| owns(corners, rim, sample));
            owned.dedup();
            prop_assert_eq!(owned, all);
        }

        /// The ends of each row against whole numbers, in grids as wide and as high as there can be.
        #[test]
        fn rows_of_great_triangles_are_exact(
            bits in 1u32..31,
            parts in prop::array::uniform3(prop::array::uniform2(0.0f64..=1.0)),
            rim in prop::array::uniform3(any::<bool>()),
        ) {
            let extent = [(1i64 << (31 - bits)) - 1, (1i64 << bits) - 1];
            let places = parts.map(|part| [0, 1].map(|axis| (part[axis] * extent[axis] as f64) as i32));
            let Some(corners) = turned(places) else { return Ok(()) };
            let rows = Rows::of(corners, rim);
            // All rows of low triangles, and the first and the last of high ones.
            let last = corners.iter().map(|corner| corner[1]).max().unwrap();
            for (row, columns) in rows.take(5000).chain(Rows::of(corners, rim).skip_while(|&(row, _)| row < last - 9))
            {
                for column in [columns.start - 1, columns.start, columns.end - 1, columns.end] {
                    let is_in = columns.contains(&column);
                    prop_assert_eq!(owns(corners, rim, [column, row]), is_in, "{} {}", row, column);
                }
            }
        }
    }
}
