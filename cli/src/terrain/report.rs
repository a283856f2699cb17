//! What is said about terrain.

use decimesh::rate_distortion::{Approximation, Decomposition, Detail, HeightField};
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
    /// Root mean square and maximum of the vertical distances of all samples from the mesh, as measured.
    pub(crate) rms: f64,
    pub(crate) max: f64,
    /// Of the range of heights and the RMS.
    pub(crate) psnr_db: f64,
    /// How far the squared error can be above that of the best conforming mesh of as many vertices; null for
    /// --tin, whose meshes are others.
    pub(crate) certified_gap_db: f64,
    /// Of decomposing, or of reading a hierarchy, and of taking the mesh from it.
    pub(crate) seconds: f64,
    /// Of reading the heights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) seconds_read: Option<f64>,
    pub(crate) seconds_write: f64,
    /// The highest point of what `seconds` counts above what was allocated when it began.
    pub(crate) peak_bytes: usize,
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

impl TerrainReport {
    /// What can be said without a clock.
    pub(crate) fn of(decomposition: &Decomposition, taken: &Approximation) -> Self {
        let field = decomposition.field();
        let error = decomposition.measure(taken);
        let rms = error.rms();
        Self {
            columns: field.columns(),
            rows: field.rows(),
            samples: decomposition.samples(),
            vertices_out: taken.mesh.positions().len(),
            triangles_out: taken.mesh.triangles().len(),
            rms,
            max: error.maximum,
            psnr_db: psnr(field, rms),
            certified_gap_db: taken.certified_gap,
            seconds: 0.0,
            seconds_read: None,
            seconds_write: 0.0,
            peak_bytes: 0,
        }
    }

    /// Tells the user, on the error stream, where there are more vertices than asked for.
    pub(crate) fn warn_if_more(&self, detail: Detail) {
        let wanted = match detail {
            Detail::Vertices(vertices) => vertices,
            Detail::Ratio(ratio) => (ratio * self.samples as f64).round() as usize,
            _ => return,
        };
        if self.vertices_out > wanted {
            eprintln!(
                "decimesh: warning: the mesh has {} vertices, more than asked for: with fewer, triangles would lie \
                 over voids, or the corners would not be there",
                grouped(self.vertices_out)
            );
        }
    }
}

/// The peak signal-to-noise ratio in decibels: of the range of heights and the RMS.
pub(crate) fn psnr(field: &HeightField, rms: f64) -> f64 {
    let (low, high) = field.range();
    20.0 * ((f64::from(high) - f64::from(low)) / rms).log10()
}

pub(crate) fn summary(report: &TerrainReport) -> String {
    let TerrainReport { samples, vertices_out, triangles_out, rms, max, psnr_db, seconds, .. } = *report;
    let gap = match report.certified_gap_db {
        gap if gap.is_finite() => format!(", at most {} dB above the best conforming mesh", significant(gap)),
        _ => String::new(),
    };
    format!(
        "{} samples -> {} vertices, {} triangles in {seconds:.3} s, RMS error {}, maximum {} ({psnr_db:.1} dB){gap}\n",
        grouped(samples),
        grouped(vertices_out),
        grouped(triangles_out),
        significant(rms),
        significant(max),
    )
}
