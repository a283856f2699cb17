//! What is said about terrain.

use decimesh::rate_distortion::{HeightField, VerticalError};
use serde::Serialize;

use crate::report::{grouped, significant};

/// What `terrain --report` and `extract --report` write. Numbers that are infinite or not known are null.
#[derive(Debug, Serialize)]
pub(crate) struct TerrainReport {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Samples that are not void.
    pub(crate) samples: usize,
    pub(crate) vertices_out: usize,
    pub(crate) triangles_out: usize,
    #[serde(flatten)]
    pub(crate) error: MeasuredError,
    /// How far the squared error can be above that of the best conforming mesh of as many vertices; null for
    /// --tin, whose meshes are others.
    pub(crate) certified_gap_db: Option<f64>,
    /// Of decomposing, or of reading a hierarchy, of taking the mesh from it, and of measuring the error.
    pub(crate) seconds: f64,
    /// Of reading the heights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) seconds_read: Option<f64>,
    pub(crate) seconds_write: f64,
    /// The highest point of what `seconds` counts above what was allocated when it began.
    pub(crate) peak_bytes: usize,
}

/// Vertical distances from the samples to the mesh, all of them measured.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct MeasuredError {
    pub(crate) rms: f64,
    pub(crate) max: f64,
    /// Of the range of heights and the RMS.
    pub(crate) psnr_db: f64,
}

/// What `decompose --report` writes.
#[derive(Debug, Serialize)]
pub(crate) struct DecomposeReport {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Samples that are not void.
    pub(crate) samples: usize,
    pub(crate) bytes: u64,
    pub(crate) bytes_per_sample: f64,
    pub(crate) seconds: f64,
    pub(crate) seconds_read: f64,
    pub(crate) seconds_write: f64,
    pub(crate) peak_bytes: usize,
}

impl MeasuredError {
    pub(crate) fn new(field: &HeightField, error: VerticalError) -> Self {
        let rms = error.rms();
        Self { rms, max: error.maximum, psnr_db: psnr(field, rms) }
    }
}

/// The peak signal-to-noise ratio in decibels: of the range of heights and the RMS.
pub(crate) fn psnr(field: &HeightField, rms: f64) -> f64 {
    let (low, high) = field.range();
    20.0 * ((f64::from(high) - f64::from(low)) / rms).log10()
}

pub(crate) fn summary(report: &TerrainReport) -> String {
    let TerrainReport { samples, vertices_out, triangles_out, error, seconds, .. } = *report;
    let gap = report.certified_gap_db.map_or_else(String::new, |gap| {
        format!(", at most {} dB above the best conforming mesh", significant(gap))
    });
    format!(
        "{} samples -> {} vertices, {} triangles in {seconds:.3} s, RMS error {}, maximum {} ({:.1} dB){gap}\n",
        grouped(samples),
        grouped(vertices_out),
        grouped(triangles_out),
        significant(error.rms),
        significant(error.max),
        error.psnr_db,
    )
}
