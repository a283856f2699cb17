//! Samples and nothing else.

use super::super::ReadError;
use super::super::source::Source;
use super::samples::{SampleType, read_rest};
use super::{Grid, RawLayout};

/// `named` is the type that the file's name tells.
pub(super) fn read(
    source: &mut Source,
    layout: Option<RawLayout>,
    named: Option<SampleType>,
) -> Result<Grid, ReadError> {
    let (layout, sample) = self::layout(layout, named)?;
    read_rest(source, [layout.columns, layout.rows], sample, layout.byte_order)
}

/// How samples lie, and their type, if both are told.
pub(super) fn layout(
    layout: Option<RawLayout>,
    named: Option<SampleType>,
) -> Result<(RawLayout, SampleType), ReadError> {
    let missing = |what: &str| ReadError::Unsupported(format!("raw samples {what}"));
    let layout = layout.ok_or_else(|| missing("whose columns and rows are not told"))?;
    let sample = layout.sample.or(named).ok_or_else(|| missing("whose type is not told"))?;
    Ok((layout, sample))
}
