//! Threads: the same results for any number of them.
//!
//! Work is cut into pieces by the data, never by the number of threads, and results are combined
//! in the order of the pieces. One thread means the caller's own: nothing is started.

use rayon::prelude::*;

/// More threads than this would find nothing to do.
const MOST: usize = 256;

/// The threads asked for could not be started.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("cannot start {threads} threads: {reason}")]
pub struct ThreadsError {
    /// How many were asked for.
    pub threads: usize,
    /// What the system said.
    pub reason: String,
}

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
    /// `threads` workers; 0: as many as the machine has.
    pub(crate) fn new(threads: usize) -> Result<Self, ThreadsError> {
        match threads {
            0 if rayon::current_num_threads() > 1 => Ok(Self::Global),
            0 | 1 => Ok(Self::Caller),
            _ => match rayon::ThreadPoolBuilder::new().num_threads(threads.min(MOST)).build() {
                Ok(pool) => Ok(Self::Pool(pool)),
                Err(reason) => Err(ThreadsError { threads, reason: reason.to_string() }),
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

    /// The list of what `make` gives for 0, 1, 2, ... up to `count`.
    pub(crate) fn list<T: Send>(&self, count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        /// Fewer are not worth a trip to another thread.
        const LEAST: usize = 1 << 14;
        let places = 0..count;
        let in_parallel = |make| places.clone().into_par_iter().with_min_len(LEAST).map(make).collect();
        match self {
            Self::Caller => places.map(make).collect(),
            Self::Global => in_parallel(make),
            Self::Pool(pool) => pool.install(|| in_parallel(make)),
        }
    }

    /// Applies `work` to `first` and to `second`, side by side where there are threads.
    #[cfg(feature = "deviation")]
    pub(crate) fn both<T: Send, R: Send>(
        &self,
        [first, second]: [T; 2],
        work: impl Fn(T) -> R + Sync + Send,
    ) -> [R; 2] {
        let (first, second) = match self {
            Self::Caller => (work(first), work(second)),
            Self::Global => rayon::join(|| work(first), || work(second)),
            Self::Pool(pool) => pool.join(|| work(first), || work(second)),
        };
        [first, second]
    }

    /// Sorts `items`; equal ones must be the same, so that it does not matter which comes first.
    pub(crate) fn sort<T: Ord + Send>(&self, items: &mut [T]) {
        match self {
            Self::Caller => items.sort_unstable(),
            Self::Global => items.par_sort_unstable(),
            Self::Pool(pool) => pool.install(|| items.par_sort_unstable()),
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
