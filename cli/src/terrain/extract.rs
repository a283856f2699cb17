//! `decimesh extract`: a mesh of any detail from a hierarchy in a file.

use std::time::Instant;

use decimesh::rate_distortion::Decomposition;

use super::arguments::ExtractArguments;
use super::report::TerrainReport;
use super::{Terrain, tell, write_mesh};
use crate::allocation::peak_bytes;
use crate::failure::Failure;
use crate::files::{check_directory, check_output};

pub(crate) fn run(arguments: &ExtractArguments) -> Result<(), Failure> {
    let ExtractArguments { input, output, detail, common } = arguments;
    check_output(output)?;
    common.report.as_deref().map_or(Ok(()), check_directory)?;

    let begin = Instant::now();
    let (result, peak_bytes) = peak_bytes(|| -> Result<_, Failure> {
        let decomposition = Decomposition::read(input).map_err(Failure::Read)?;
        let terrain = Terrain::of(&decomposition, decomposition.at(detail.detail())?);
        Ok((decomposition, terrain))
    });
    let seconds = begin.elapsed().as_secs_f64();
    let (decomposition, terrain) = result?;

    let seconds_write = write_mesh(&terrain.mesh, output, common)?;
    let report = TerrainReport { seconds, seconds_write, peak_bytes, ..terrain.report(&decomposition) };
    tell(&report, common)
}
