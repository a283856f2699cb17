//! Threads: the same results for any number of them.
//!
//! Work is cut into pieces by the data, never by the number of threads, and results are combined
//! in the order of the pieces. One thread means the caller's own: nothing is started.

use rayon::prelude::*;

/// The threads that a computation may use.
pub(crate) enum Workers {
    /// The caller's thread.
    Caller,
    /// Rayon's global pool.
    Global,
    /// A pool of a size asked for.
    Pool(rayon::ThreadPool),
}

impl Workers {
    /// `threads` workers; 0: as many as the machine has. Falls back to the caller's thread where
    /// the system gives no more.
    pub(crate) fn new(threads: usize) -> Self {
        match threads {
            0 if rayon::current_num_threads() > 1 => Self::Global,
            0 | 1 => Self::Caller,
            _ => match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => Self::Pool(pool),
                Err(_) => Self::Caller,
            },
        }
    }

    /// Applies `work` to each of `items`; the results are in the order of the items.
    pub(crate) fn map<T: Send, R: Send>(&self, items: Vec<T>, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
        // A single item would only travel to another thread and back.
        match self {
            Self::Pool(pool) if items.len() > 1 => pool.install(|| items.into_par_iter().map(work).collect()),
            Self::Global if items.len() > 1 => items.into_par_iter().map(work).collect(),
            _ => items.into_iter().map(work).collect(),
        }
    }

    /// How many threads there are.
    pub(crate) fn count(&self) -> usize {
        match self {
            Self::Caller => 1,
            Self::Global => rayon::current_num_threads(),
            Self::Pool(pool) => pool.current_num_threads(),
        }
    }
}
