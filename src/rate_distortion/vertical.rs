//! How far a surface is from a height field, measured up and down at every sample.

use super::height_field::HeightField;
use super::raster::{Place, Rows, twice_area};

/// What is between the samples of a field and a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VerticalError {
    /// The sum of the squared vertical distances, each times the importance of its sample.
    pub squared: f64,
    /// The sum of the importances: the number of samples measured, where all are equally important.
    pub weight: f64,
    /// The greatest vertical distance, of samples of any importance.
    pub maximum: f64,
    /// How many samples are neither void nor under the surface, and so in none of the sums.
    pub uncovered: usize,
}

impl VerticalError {
    /// The root of the mean squared vertical distance, by importance; 0 if nothing is of any.
    pub fn rms(&self) -> f64 {
        if self.weight > 0.0 { (self.squared / self.weight).sqrt() } else { 0.0 }
    }
}

/// A plane over the grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    place: Place,
    height: f64,
    /// How much it rises with each column and each row.
    pub(crate) slope: [f64; 2],
}

impl Plane {
    /// The plane through three points over corners that have an area.
    #[inline(always)]
    pub(crate) fn through(corners: [Place; 3], heights: [f64; 3]) -> Self {
        let [a, b, c] = corners;
        let reciprocal = -1.0 / twice_area(corners) as f64;
        let [ab, ac] = [b, c].map(|to| [f64::from(to[0] - a[0]), f64::from(to[1] - a[1])]);
        let (rise_b, rise_c) = (heights[1] - heights[0], heights[2] - heights[0]);
        let slope =
            [(rise_b * ac[1] - rise_c * ab[1]) * reciprocal, (rise_c * ab[0] - rise_b * ac[0]) * reciprocal];
        Self { place: a, height: heights[0], slope }
    }

    #[inline(always)]
    pub(crate) fn at(&self, column: i32, row: i32) -> f64 {
        self.height
            + self.slope[1] * f64::from(row - self.place[1])
            + self.slope[0] * f64::from(column - self.place[0])
    }
}

/// The error of a surface over a field, sample by sample.
///
/// `vertices` are columns and rows, `heights` what the surface has there, `triangles` name vertices. Triangles
/// may be turned either way; those without an area cover nothing. A sample that several triangles cover, as on
/// an edge between them, is measured against the first. Linear in samples and triangles, and a bit a sample.
pub fn measure(
    field: &HeightField,
    vertices: &[[u32; 2]],
    heights: &[f32],
    triangles: &[[u32; 3]],
) -> VerticalError {
    let columns = field.columns();
    let mut seen = vec![0u64; field.heights().len().div_ceil(64)];
    let mut error = VerticalError { squared: 0.0, weight: 0.0, maximum: 0.0, uncovered: 0 };
    let mut measured = 0;
    let mut add = |column: i32, row: i32, surface: f64| {
        let sample = row as usize * columns + column as usize;
        let (word, bit) = (&mut seen[sample / 64], 1 << (sample % 64));
        let height = field.heights()[sample];
        if *word & bit != 0 || height.is_nan() {
            return;
        }
        *word |= bit;
        measured += 1;
        let weight = field.importance().map_or(1.0, |importance| f64::from(importance[sample]));
        let distance = (f64::from(height) - surface).abs();
        error.squared += weight * distance * distance;
        error.weight += weight;
        error.maximum = error.maximum.max(distance);
    };
    for triangle in triangles {
        let mut triangle = triangle.map(|vertex| vertex as usize);
        let place = |vertex: usize| vertices[vertex].map(|part| part as i32);
        let area = twice_area(triangle.map(place));
        if area == 0 {
            continue;
        }
        if area < 0 {
            triangle.swap(1, 2);
        }
        let corners = triangle.map(place);
        let plane = Plane::through(corners, triangle.map(|vertex| f64::from(heights[vertex])));
        for (&[column, row], vertex) in corners.iter().zip(triangle) {
            add(column, row, f64::from(heights[vertex]));
        }
        for (row, columns) in Rows::of(corners, [true; 3]) {
            columns.for_each(|column| add(column, row, plane.at(column, row)));
        }
    }
    error.uncovered = field.heights().len() - field.voids() - measured;
    error
}

#[cfg(test)]
mod tests {
    use super::measure;
    use crate::rate_distortion::height_field::HeightField;
    use proptest::prelude::*;

    #[test]
    fn distances_are_summed_sample_by_sample() {
        let mut heights = vec![0.0; 9];
        (heights[4], heights[1], heights[6]) = (3.0, -1.0, f32::NAN);
        let field = HeightField::new(3, 3, heights, Some(f32::NAN)).unwrap();
        let importance = (0..9).map(|sample| if sample == 4 { 0.5 } else { 1.0 }).collect();
        let field = field.with_importance(importance).unwrap();
        let corners = [[0, 0], [2, 0], [0, 2], [2, 2]];
        // One half, turned either way: six samples, one of them void.
        for triangle in [[0, 1, 2], [0, 2, 1]] {
            let error = measure(&field, &corners, &[0.0; 4], &[triangle]);
            assert_eq!((error.squared, error.weight, error.maximum, error.uncovered), (5.5, 4.5, 3.0, 3));
        }
        let error = measure(&field, &corners, &[1.0; 4], &[[0, 2, 1], [1, 2, 3], [3, 3, 0]]);
        assert_eq!((error.squared, error.weight, error.maximum, error.uncovered), (12.0, 7.5, 2.0, 0));
        assert_eq!(error.rms(), (12.0f64 / 7.5).sqrt());
        assert_eq!(measure(&field, &corners, &[0.0; 4], &[]).uncovered, 8);
        assert_eq!(measure(&field, &corners, &[0.0; 4], &[]).rms(), 0.0);
    }

    proptest! {
        /// A fan of triangles over all of a plane field leaves nothing out and makes no error.
        #[test]
        fn a_plane_has_no_error(
            size in prop::array::uniform2(2usize..40),
            slope in prop::array::uniform2(-9i32..9),
            apex in prop::array::uniform2(0.0f64..1.0),
        ) {
            let [columns, rows] = size;
            let height = |column: usize, row: usize| slope[0] as f32 * column as f32 + slope[1] as f32 * row as f32;
            let heights = (0..columns * rows).map(|sample| height(sample % columns, sample / columns)).collect();
            let field = HeightField::new(columns, rows, heights, None).unwrap();
            let (right, bottom) = (columns - 1, rows - 1);
            let apex = [(apex[0] * right as f64) as usize, (apex[1] * bottom as f64) as usize];
            let vertices = [apex, [0, 0], [0, bottom], [right, bottom], [right, 0]];
            let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
            let heights = vertices.map(|[column, row]| height(column, row));
            let vertices = vertices.map(|place| place.map(|part| part as u32));
            let error = measure(&field, &vertices, &heights, &triangles);
            prop_assert!(error.maximum < 1e-9, "{}", error.maximum);
            prop_assert_eq!((error.uncovered, error.weight), (0, (columns * rows) as f64));
        }
    }
}
