//! Which samples of a grid a triangle covers.
//!
//! Corners are samples, so all of this is exact: no sample between two triangles is lost or counted twice, however
//! thin they are. A sample on an edge belongs to the triangle that has the edge at its left or on top, as in
//! hardware rasterisers; on the *rim*, where no other triangle could have it, to the one there is. Corners belong
//! to no triangle: they are the affair of whoever knows the vertices.

use std::cmp::Ordering;
use std::ops::Range;

/// A sample by its column and row.
pub(crate) type Place = [i32; 2];

/// Twice the area of a triangle, positive if it is counter-clockwise seen from above with row 0 in the north.
pub(crate) fn twice_area([a, b, c]: [Place; 3]) -> i64 {
    let across = |from: Place, to: Place| i64::from(to[0] - from[0]);
    let down = |from: Place, to: Place| i64::from(to[1] - from[1]);
    across(a, c) * down(a, b) - across(a, b) * down(a, c)
}

/// Calls `visit` with each row and the columns in it that a triangle owns, from the top down.
///
/// The triangle is counter-clockwise and has an area. `rim[k]` says whether the edge from corner `k` to the next
/// is on the rim. Linear in the rows.
#[inline]
pub(crate) fn visit_rows(corners: [Place; 3], rim: [bool; 3], mut visit: impl FnMut(i32, Range<i32>)) {
    // From the top (its left end, where it is an edge), one side runs down at the left and one at the right.
    let above = |a: usize, b: usize| (corners[a][1], corners[a][0]) < (corners[b][1], corners[b][0]);
    let top = match (above(0, 1), above(1, 2), above(2, 0)) {
        (true, _, false) => 0,
        (false, true, _) => 1,
        _ => 2,
    };
    let (at_left, at_right) = ((top + 1) % 3, (top + 2) % 3);
    let (across_rim, right_rim) = (rim[at_left], rim[at_right]);
    let (top, at_left, at_right) = (corners[top], corners[at_left], corners[at_right]);

    let mut left = Side::new(top, at_left, false);
    if top[1] == at_right[1] {
        visit(top[1], top[0] + 1..at_right[0]);
        let mut right = Side::new(at_right, at_left, across_rim);
        (top[1] + 1..at_left[1]).for_each(|row| visit(row, left.advance()..right.advance()));
        return;
    }
    let mut right = Side::new(top, at_right, right_rim);
    let middle = at_left[1].min(at_right[1]);
    (top[1] + 1..middle).for_each(|row| visit(row, left.advance()..right.advance()));
    match at_left[1].cmp(&at_right[1]) {
        Ordering::Equal => {
            if across_rim {
                visit(middle, at_left[0] + 1..at_right[0]);
            }
        }
        Ordering::Less => {
            visit(middle, at_left[0] + 1..right.advance());
            left = Side::new(at_left, at_right, false);
            (middle + 1..at_right[1]).for_each(|row| visit(row, left.advance()..right.advance()));
        }
        Ordering::Greater => {
            visit(middle, left.advance()..at_right[0]);
            right = Side::new(at_right, at_left, across_rim);
            (middle + 1..at_left[1]).for_each(|row| visit(row, left.advance()..right.advance()));
        }
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
    #[inline]
    fn new(from: Place, to: Place, beyond: bool) -> Self {
        let origin = from[0].min(to[0]);
        let height = f64::from(to[1] - from[1]);
        let quarter = if beyond { 0.25 } else { -0.25 };
        // One column more, because what is rounded towards zero then is rounded up.
        let numerator = f64::from(from[0] - origin + 1) * height + quarter;
        Self { origin, numerator, step: f64::from(to[0] - from[0]), reciprocal: 1.0 / height }
    }

    /// The first column right of the edge in the next row.
    #[inline]
    fn advance(&mut self) -> i32 {
        self.numerator += self.step;
        self.origin + (self.numerator * self.reciprocal) as i32
    }
}
