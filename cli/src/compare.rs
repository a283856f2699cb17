//! `decimesh compare`: the measured distance between two surfaces.

use decimesh::deviation::{Bound, BoundOptions, Deviation, Sampling, bound, deviation};
use serde::Serialize;

use crate::arguments::CompareArguments;
use crate::failure::Failure;
use crate::files::read;
use crate::progress::Progress;
use crate::report::{self, BoundReport, percent, significant, table};

pub(crate) fn run(arguments: &CompareArguments) -> Result<(), Failure> {
    let reference = read(&arguments.reference, None)?;
    let other = read(&arguments.other, None)?;
    let default = Sampling::default();
    let sampling = Sampling {
        samples: arguments.samples.unwrap_or(default.samples),
        seed: arguments.seed.unwrap_or(default.seed),
        threads: arguments.threads,
    };
    let progress = Progress::new(arguments.quiet);
    let measured =
        progress.during("measuring", |monitor| deviation(&reference, &other, &sampling, monitor))?;
    let bounds = arguments.bound.then(|| {
        let options = BoundOptions { threads: arguments.threads, ..BoundOptions::default() };
        progress.during("bounding", |monitor| bound(&reference, &other, &options, monitor))
    });
    let report = CompareReport::new(&measured, bounds.transpose()?);
    report::print(&if arguments.json { report::json(&report)? } else { report.text() })
}

/// What `compare --json` prints. Distances are two-sided; those relative to the diagonal of A's
/// bounding box are null where it has none.
#[derive(Debug, Serialize)]
struct CompareReport {
    rms: f64,
    mean: f64,
    max: f64,
    rms_rel: f64,
    mean_rel: f64,
    max_rel: f64,
    normal_rms_degrees: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    bound: Option<BoundReport>,
}

impl CompareReport {
    fn new(measured: &Deviation, bound: Option<Bound>) -> Self {
        let bound = bound.map(BoundReport::from);
        Self {
            rms: measured.rms,
            mean: measured.mean,
            max: measured.max,
            rms_rel: measured.rms_rel(),
            mean_rel: measured.mean_rel(),
            max_rel: measured.max_rel(),
            normal_rms_degrees: measured.normal_rms_degrees,
            bound,
        }
    }

    fn text(&self) -> String {
        let row = |name: &str, value, share| vec![name.to_owned(), significant(value), percent(share)];
        let mut rows = vec![
            row("RMS", self.rms, self.rms_rel),
            row("mean", self.mean, self.mean_rel),
            row("maximum", self.max, self.max_rel),
        ];
        if let Some(bound) = &self.bound {
            rows.push(row("at least", bound.lower, bound.lower_rel));
            rows.push(row("at most", bound.upper, bound.upper_rel));
        }
        rows.push(vec!["normals (RMS)".to_owned(), format!("{}°", significant(self.normal_rms_degrees))]);
        table(&["", "distance", "of the diagonal"], 1, rows)
    }
}
