//! Contenders in turns: one run of each, then one more of each, so that a machine that slows down or
//! speeds up meanwhile does so for all of them.

use std::error::Error;
use std::time::Instant;

use decimesh::mesh::MeshError;
use decimesh::{Mesh, Monitor, Options, Selection, Target, simplify};

use crate::allocation;
use crate::peers::meshoptimizer::Function;
use crate::peers::{Buffers, Held, MESHOPTIMIZER, OPENMESH, Peer};

/// The paper's size of the replacement-selection heap.
const RECORDS: usize = 15;

/// Someone who can simplify.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Contender {
    Decimesh { selection: Selection, threads: usize },
    Peer(Peer),
}

/// The contender to whose time the others' are compared.
pub(crate) const REFERENCE: Contender = Contender::Peer(Peer::Meshoptimizer(Function::SimplifyWithUpdate));

/// A mesh, and how many triangles shall be left of it.
pub(crate) struct Case<'a> {
    pub(crate) mesh: &'a Mesh,
    pub(crate) triangles: usize,
}

/// What a contender did with a case.
pub(crate) struct Measurement {
    pub(crate) contender: Contender,
    /// Of each run, in their order.
    pub(crate) seconds: Vec<f64>,
    /// Allocated at once at the highest, beyond the input.
    pub(crate) peak_bytes: usize,
    /// Triangles that the contender cannot hold, so that it simplified the others only.
    pub(crate) left_out: usize,
    pub(crate) result: Mesh,
}

/// What one run of a contender came to.
struct Run {
    seconds: f64,
    peak_bytes: usize,
    left_out: usize,
    result: Mesh,
}

impl Contender {
    /// Whether this is decimesh as it is unless asked otherwise.
    pub(crate) fn is_default(self) -> bool {
        matches!(self, Self::Decimesh { selection: Selection::SampledThreshold, .. })
    }

    /// decimesh, its default selection with each number of threads; meshoptimizer; OpenMesh if asked for.
    pub(crate) fn all(threads: &[usize], openmesh: bool) -> Vec<Self> {
        let threshold = |&threads| Self::Decimesh { selection: Selection::SampledThreshold, threads };
        let replacement = Selection::ReplacementSelection { records: RECORDS };
        let mut contenders: Vec<Self> = threads.iter().map(threshold).collect();
        contenders.push(Self::Decimesh { selection: replacement, threads: 1 });
        contenders.extend(MESHOPTIMIZER.map(Self::Peer));
        if openmesh {
            contenders.extend(OPENMESH.map(Self::Peer));
        }
        contenders
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::Decimesh { selection, threads } => {
                let threads = match threads {
                    0 => "all threads".to_owned(),
                    1 => "1 thread".to_owned(),
                    _ => format!("{threads} threads"),
                };
                match selection {
                    Selection::SampledThreshold => format!("decimesh, {threads}"),
                    Selection::ReplacementSelection { records } => {
                        format!("decimesh replacement k={records}, {threads}")
                    }
                }
            }
            Self::Peer(peer) => peer.name().to_owned(),
        }
    }

    /// Simplifies. Copies of what the contender overwrites count as bytes, not as seconds.
    fn run(self, case: &Case) -> Result<Run, Box<dyn Error>> {
        allocation::reset_peak();
        match self {
            Self::Decimesh { selection, threads } => {
                let target = Target::Triangles(case.triangles);
                let options = Options { selection, threads, ..Options::new(target) };
                let start = Instant::now();
                let simplified = simplify(case.mesh, &options, &mut Monitor::silent())?;
                let seconds = start.elapsed().as_secs_f64();
                let peak_bytes = allocation::peak_bytes();
                Ok(Run { seconds, peak_bytes, left_out: 0, result: simplified.mesh })
            }
            Self::Peer(peer) => {
                let held = peer.hold(case.mesh);
                let start = Instant::now();
                let held = held.simplify(case.triangles);
                let seconds = start.elapsed().as_secs_f64();
                let peak_bytes = allocation::peak_bytes();
                let left_out = match &held {
                    Held::Meshoptimizer(..) => 0,
                    Held::OpenMesh(_, mesh) => mesh.left_out(),
                };
                Ok(Run { seconds, peak_bytes, left_out, result: compacted(&held.into())? })
            }
        }
    }
}

/// The mesh of what the indices name.
fn compacted(buffers: &Buffers) -> Result<Mesh, MeshError> {
    let mut successors = vec![u32::MAX; buffers.positions.len()];
    let mut positions = Vec::new();
    let mut indices = Vec::with_capacity(buffers.indices.len());
    for &index in &*buffers.indices {
        let successor = &mut successors[index as usize];
        if *successor == u32::MAX {
            *successor = positions.len() as u32;
            positions.push(buffers.positions[index as usize]);
        }
        indices.push(*successor);
    }
    Mesh::from_buffers(&positions, &indices)
}

/// `runs` rounds, at least one, over all cases and contenders: the measurements of each case.
pub(crate) fn play(
    contenders: &[Contender],
    cases: &[Case],
    runs: usize,
) -> Result<Vec<Vec<Measurement>>, Box<dyn Error>> {
    let mut measurements: Vec<Vec<Measurement>> = cases.iter().map(|_| Vec::new()).collect();
    for _ in 0..runs.max(1) {
        for (case, measurements) in cases.iter().zip(&mut measurements) {
            for (place, &contender) in contenders.iter().enumerate() {
                let Run { seconds, peak_bytes, left_out, result } = contender.run(case)?;
                match measurements.get_mut(place) {
                    Some(measurement) => {
                        measurement.seconds.push(seconds);
                        measurement.peak_bytes = measurement.peak_bytes.max(peak_bytes);
                    }
                    None => {
                        let seconds = vec![seconds];
                        measurements.push(Measurement { contender, seconds, peak_bytes, left_out, result });
                    }
                }
            }
        }
    }
    Ok(measurements)
}

impl Measurement {
    pub(crate) fn fastest(&self) -> f64 {
        self.seconds.iter().copied().fold(f64::INFINITY, f64::min)
    }

    pub(crate) fn median(&self) -> f64 {
        median(self.seconds.clone())
    }

    /// The time as a multiple of `reference`'s: the median of the rounds' ratios.
    pub(crate) fn ratio(&self, reference: &Self) -> f64 {
        median(self.seconds.iter().zip(&reference.seconds).map(|(own, other)| own / other).collect())
    }
}

/// The middle of `values`, of which there is at least one, or the mean of the middle two.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
}
