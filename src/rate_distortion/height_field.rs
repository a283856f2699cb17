//! Heights over a regular grid, as they come: any size, with voids, each sample as important as it is said to be.

use super::Error;

/// Heights over a grid of columns and rows.
///
/// Samples are stored row by row. Row 0 is the northernmost, as in images and in files of elevations, so that
/// in space `x` grows with the column, `y` falls with the row and `z` is the height. A sample may be *void*:
/// nothing is known there, no triangle covers it, and it counts for nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightField {
    columns: usize,
    rows: usize,
    /// Not a number where void.
    heights: Vec<f32>,
    voids: usize,
    spacing: [f32; 2],
    importance: Option<Vec<f32>>,
}

impl HeightField {
    /// More samples than this cannot be named in 32 bits once a grid is filled up to whole quads.
    pub const MAX_SAMPLES: usize = 1 << 31;

    /// A field of `columns` times `rows` heights, one unit apart.
    ///
    /// Samples equal to `no_data` are void; for `Some(f32::NAN)` those that are not a number. All others must
    /// be finite, one at least must not be void, and there must be two columns and two rows at least. Linear;
    /// takes the buffer as it is.
    pub fn new(
        columns: usize,
        rows: usize,
        mut heights: Vec<f32>,
        no_data: Option<f32>,
    ) -> Result<Self, Error> {
        if columns < 2 || rows < 2 {
            return Err(Error::TooSmall { columns, rows });
        }
        let samples = columns.checked_mul(rows).filter(|&samples| samples <= Self::MAX_SAMPLES);
        let samples = samples.ok_or(Error::TooLarge { columns, rows, limit: Self::MAX_SAMPLES })?;
        if heights.len() != samples {
            return Err(Error::SampleCount { what: "heights", count: heights.len(), columns, rows });
        }
        let mut voids = 0;
        for (sample, height) in heights.iter_mut().enumerate() {
            if no_data.is_some_and(|void| *height == void || (void.is_nan() && height.is_nan())) {
                *height = f32::NAN;
                voids += 1;
            } else if !height.is_finite() {
                return Err(Error::NotFinite {
                    what: "height",
                    value: *height,
                    column: sample % columns,
                    row: sample / columns,
                });
            }
        }
        if voids == samples {
            return Err(Error::AllVoid { columns, rows });
        }
        Ok(Self { columns, rows, heights, voids, spacing: [1.0; 2], importance: None })
    }

    /// The same field with its columns and its rows `spacing` apart, in the unit of the heights.
    pub fn with_spacing(self, spacing: [f32; 2]) -> Result<Self, Error> {
        if !spacing.iter().all(|distance| distance.is_normal() && *distance > 0.0) {
            return Err(Error::Spacing { spacing });
        }
        Ok(Self { spacing, ..self })
    }

    /// The same field with a weight for the squared error of each sample, in the order of the heights: finite
    /// and not negative. 1 is what all have without. What matters more (to a viewer, to a simulation, by its
    /// slope or its use) weighs more.
    pub fn with_importance(self, importance: Vec<f32>) -> Result<Self, Error> {
        let Self { columns, rows, .. } = self;
        if importance.len() != self.heights.len() {
            return Err(Error::SampleCount { what: "weights", count: importance.len(), columns, rows });
        }
        if let Some(sample) = importance.iter().position(|weight| !(weight.is_finite() && *weight >= 0.0)) {
            return Err(Error::NotFinite {
                what: "weight",
                value: importance[sample],
                column: sample % columns,
                row: sample / columns,
            });
        }
        Ok(Self { importance: Some(importance), ..self })
    }

    /// How many samples a row has.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The heights, row by row; not a number where void.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// The distance between columns and between rows.
    pub fn spacing(&self) -> [f32; 2] {
        self.spacing
    }

    /// The weights of the samples, if they are not all 1.
    pub fn importance(&self) -> Option<&[f32]> {
        self.importance.as_deref()
    }

    /// How many samples are void.
    pub fn voids(&self) -> usize {
        self.voids
    }

    /// Whether nothing is known at a sample.
    pub fn is_void(&self, column: usize, row: usize) -> bool {
        self.heights[row * self.columns + column].is_nan()
    }

    /// The least and the greatest height.
    pub fn range(&self) -> (f32, f32) {
        self.heights
            .iter()
            .filter(|height| !height.is_nan())
            .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &height| {
                (low.min(height), high.max(height))
            })
    }

    /// Where its samples lie.
    pub(super) fn grid(&self) -> Grid {
        Grid { size: [self.columns, self.rows], spacing: self.spacing }
    }
}

/// Samples in columns and rows, in space and in an image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grid {
    pub(super) size: [usize; 2],
    pub(super) spacing: [f32; 2],
}

impl Grid {
    /// Where something `height` high stands at a sample: east, north, up, the south-west corner at the origin.
    pub(super) fn position(&self, [column, row]: [u32; 2], height: f32) -> [f32; 3] {
        let ([_, rows], [dx, dy]) = (self.size, self.spacing);
        [column as f32 * dx, (rows - 1 - row as usize) as f32 * dy, height]
    }

    /// Texture coordinates of a sample, 0 to 1, for an image with a pixel in the middle of which each sample
    /// lies: `u` east, `v` north.
    pub(super) fn uv(&self, [column, row]: [u32; 2]) -> [f32; 2] {
        let part = |index: u32, count: usize| (index as f32 + 0.5) / count as f32;
        let [columns, rows] = self.size;
        [part(column, columns), 1.0 - part(row, rows)]
    }
}
