//! What can be wrong with what comes in.

use crate::monitor::Cancelled;
use crate::workers::ThreadsError;

/// Why heights make no field, or a field no decomposition. Columns and rows count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Fewer than two columns or rows: no surface.
    #[error("{columns} columns and {rows} rows make no surface: two of each are the least")]
    TooSmall {
        /// How many columns.
        columns: usize,
        /// How many rows.
        rows: usize,
    },
    /// More samples than can be named.
    #[error("{columns} columns times {rows} rows are more samples than decimesh can hold ({limit})")]
    TooLarge {
        /// How many columns.
        columns: usize,
        /// How many rows.
        rows: usize,
        /// How many samples there may be.
        limit: usize,
    },
    /// A list has not one entry a sample.
    #[error("{count} {what} for {columns} columns times {rows} rows")]
    SampleCount {
        /// `"heights"`, `"weights"` or `"costs"`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many columns.
        columns: usize,
        /// How many rows.
        rows: usize,
    },
    /// A height or a weight that cannot be.
    #[error("{what} {value} in column {column}, row {row} is not allowed")]
    NotFinite {
        /// `"height"`, `"weight"` or `"cost"`.
        what: &'static str,
        /// What it is.
        value: f32,
        /// In which column.
        column: usize,
        /// In which row.
        row: usize,
    },
    /// Nothing is known anywhere.
    #[error("all of {columns} columns times {rows} rows are void")]
    AllVoid {
        /// How many columns.
        columns: usize,
        /// How many rows.
        rows: usize,
    },
    /// Columns or rows that are not apart.
    #[error("columns {} and rows {} apart: both must be positive and finite", .spacing[0], .spacing[1])]
    Spacing {
        /// The distances.
        spacing: [f32; 2],
    },
    /// A wish that cannot be understood.
    #[error("{what} {value} is not allowed: {expected}")]
    Target {
        /// What was asked for.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it has to be.
        expected: &'static str,
    },
    /// A part of a large field could not be had, or what is known of it not be kept.
    #[error("columns from {column} on, rows from {row} on: {reason}")]
    Tile {
        /// The first column.
        column: usize,
        /// The first row.
        row: usize,
        /// Why.
        reason: String,
    },
    /// The monitor asked for the end.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// No threads.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
}
