//! The squared vertical error of single triangles: what every decision here rests on.

use super::triangulation::Vertex;
use crate::rate_distortion::height_field::HeightField;
use crate::rate_distortion::raster::{Place, Rows};
use crate::rate_distortion::vertical::Plane;
use std::borrow::Cow;

/// The samples of a field, ready to be summed over without a question about any: voids are samples of weight 0.
pub(super) struct Samples<'a> {
    columns: usize,
    heights: Cow<'a, [f32]>,
    weights: Option<Cow<'a, [f32]>>,
}

impl<'a> Samples<'a> {
    /// Copies heights only of a field with voids.
    pub(super) fn new(field: &'a HeightField) -> Self {
        let (columns, heights) = (field.columns(), field.heights());
        if field.voids() == 0 {
            return Self { columns, heights: heights.into(), weights: field.importance().map(Cow::from) };
        }
        let mut weights = field.importance().map_or_else(|| vec![1.0; heights.len()], <[f32]>::to_vec);
        let mut heights = heights.to_vec();
        for (height, weight) in heights.iter_mut().zip(&mut weights).filter(|(height, _)| height.is_nan()) {
            (*height, *weight) = (0.0, 0.0);
        }
        Self { columns, heights: heights.into(), weights: Some(weights.into()) }
    }

    fn number(&self, [column, row]: Place) -> usize {
        row as usize * self.columns + column as usize
    }

    /// The height of a sample that is not void.
    pub(super) fn height(&self, place: Place) -> f32 {
        self.heights[self.number(place)]
    }

    /// The height and the weight of a sample.
    pub(super) fn at(&self, place: Place) -> (f64, f64) {
        let weight = self.weights.as_ref().map_or(1.0, |weights| f64::from(weights[self.number(place)]));
        (f64::from(self.height(place)), weight)
    }

    /// The weighted sum of squared vertical distances between a triangle and the samples that it owns.
    pub(super) fn squared_error(&self, corners: [Vertex; 3], rim: [bool; 3]) -> f64 {
        let places = corners.map(|vertex| vertex.place);
        let plane = Plane::through(places, corners.map(|vertex| f64::from(vertex.height)));
        let slope = plane.slope[0];
        let mut sum = 0.0;
        for (row, columns) in Rows::of(places, rim) {
            let mut surface = plane.at(columns.start, row);
            let start = row as usize * self.columns;
            let samples = start + columns.start as usize..start + columns.end as usize;
            match &self.weights {
                None => {
                    for &height in &self.heights[samples] {
                        let distance = f64::from(height) - surface;
                        sum += distance * distance;
                        surface += slope;
                    }
                }
                Some(weights) => {
                    for (&height, &weight) in self.heights[samples.clone()].iter().zip(&weights[samples]) {
                        let distance = f64::from(height) - surface;
                        sum += f64::from(weight) * distance * distance;
                        surface += slope;
                    }
                }
            }
        }
        sum
    }

    /// Calls `visit` with each sample that a triangle owns: its place, height and weight.
    pub(super) fn visit(&self, corners: [Vertex; 3], rim: [bool; 3], mut visit: impl FnMut(Place, f64, f64)) {
        for (row, columns) in Rows::of(corners.map(|vertex| vertex.place), rim) {
            for place in columns.map(|column| [column, row]) {
                let (height, weight) = self.at(place);
                visit(place, height, weight);
            }
        }
    }
}
