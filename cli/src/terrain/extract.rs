//! `decimesh extract`: a mesh of any detail from a hierarchy in a file.

use std::time::Instant;

use decimesh::rate_distortion::Decomposition;

use super::arguments::ExtractArguments;
use super::report::TerrainReport;
use super::{tell, write_mesh};
use crate::allocation::peak_bytes;
use crate::failure::Failure;
use crate::files::{check_directory, check_output};

pub(crate) fn run(arguments: &ExtractArguments) -> Result<(), Failure> {
    let ExtractArguments { input, output, detail, common } = arguments;
    check_output(output)?;
    common.report.as_deref().map_or(Ok(()), check_directory)?;

    let detail = detail.detail();
    let begin = Instant::now();
    let (result, peak_bytes) = peak_bytes(|| -> Result<_, Failure> {
        let decomposition = Decomposition::read(input).map_err(Failure::Read)?;
        let taken = decomposition.at(detail)?;
        Ok((decomposition, taken))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let (decomposition, taken) = result?;

    let seconds_write = write_mesh(&taken.mesh, output, common)?;
    let report =
        TerrainReport { seconds, seconds_write, peak_bytes, ..TerrainReport::of(&decomposition, &taken) };
    tell(&report, detail, common)
}
