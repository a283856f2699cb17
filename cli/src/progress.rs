//! A progress bar for work that takes long, and silence for work that does not.

use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use decimesh::Monitor;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Shorter work ends before anybody could read the bar.
const PATIENCE: Duration = Duration::from_millis(300);
const STEPS: u64 = 1000;

/// Shows on the error stream how far a computation has come, where that is a terminal.
pub(crate) struct Progress {
    visible: bool,
}

impl Progress {
    /// A progress display; `quiet` keeps it dark.
    pub(crate) fn new(quiet: bool) -> Self {
        Self { visible: !quiet && std::io::stderr().is_terminal() }
    }

    /// Runs `work` with a monitor that draws a bar titled `label` and takes it away at the end.
    pub(crate) fn during<T>(&self, label: &str, work: impl FnOnce(&mut Monitor) -> T) -> T {
        if !self.visible {
            return work(&mut Monitor::silent());
        }
        let begin = Instant::now();
        let bar = ProgressBar::with_draw_target(Some(STEPS), ProgressDrawTarget::hidden())
            .with_message(label.to_owned())
            .with_style(style());
        let result = work(&mut Monitor::new(|fraction| {
            if bar.is_hidden() && begin.elapsed() > PATIENCE {
                bar.set_draw_target(ProgressDrawTarget::stderr());
            }
            bar.set_position((fraction * STEPS as f32) as u64);
            ControlFlow::Continue(())
        }));
        bar.finish_and_clear();
        result
    }
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("{msg:>12} [{bar:40}] {percent:>3} % {elapsed}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .progress_chars("=> ")
}
