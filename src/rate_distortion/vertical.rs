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
