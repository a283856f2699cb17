//! Progress and cancel, in one.

use std::ops::ControlFlow;
#[cfg(feature = "deviation")]
use std::ops::Range;

/// Watches a long computation: is told how far it has come, and may end it.
///
/// The callback runs on the thread that called into decimesh, never on a worker, so it may touch
/// whatever that thread may touch. It receives a fraction in `0..=1` that never falls, and ends
/// the computation by answering [`ControlFlow::Break`]; the caller then gets an error and nothing
/// of the caller's has changed.
#[derive(Default)]
pub struct Monitor<'a> {
    callback: Option<Box<dyn FnMut(f32) -> ControlFlow<()> + 'a>>,
    reported: f32,
}

/// The [`Monitor`] asked for the computation to end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl<'a> Monitor<'a> {
    /// A monitor that hears nothing and never cancels.
    pub fn silent() -> Self {
        Self::default()
    }

    /// A monitor that calls `callback` with each new fraction.
    pub fn new(callback: impl FnMut(f32) -> ControlFlow<()> + 'a) -> Self {
        Self { callback: Some(Box::new(callback)), reported: 0.0 }
    }

    /// Reports that `fraction` of the work is done. Values below an earlier one are raised to it.
    pub fn report(&mut self, fraction: f32) -> Result<(), Cancelled> {
        self.reported = self.reported.max(fraction.clamp(0.0, 1.0));
        match &mut self.callback {
            Some(callback) => match callback(self.reported) {
                ControlFlow::Continue(()) => Ok(()),
                ControlFlow::Break(()) => Err(Cancelled),
            },
            None => Ok(()),
        }
    }

    /// A monitor for a part of the work, whose fractions lie in this `share` of the whole.
    #[cfg(feature = "deviation")]
    pub(crate) fn part(&mut self, share: Range<f32>) -> Monitor<'_> {
        Monitor::new(move |done| match self.report(share.start + (share.end - share.start) * done) {
            Ok(()) => ControlFlow::Continue(()),
            Err(Cancelled) => ControlFlow::Break(()),
        })
    }
}
