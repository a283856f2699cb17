//! How much memory a computation takes: an allocator that counts.

use std::alloc::System;

use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// The highest number of bytes that were allocated at once while `work` ran, above what was
/// allocated when it began. Counts all threads: only one measurement makes sense at a time.
pub(crate) fn peak_bytes<T>(work: impl FnOnce() -> T) -> (T, usize) {
    ALLOCATOR.reset_peak_memory();
    let result = work();
    (result, ALLOCATOR.get_peak_memory())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peak_is_of_what_lived_at_once() {
        const MEGABYTE: usize = 1 << 20;
        let held = vec![1_u8; 8 * MEGABYTE];
        let (kept, peak) = peak_bytes(|| {
            for _ in 0..4 {
                std::hint::black_box(vec![1_u8; 16 * MEGABYTE]);
            }
            std::hint::black_box(vec![1_u8; MEGABYTE])
        });
        // Other tests of this process may allocate meanwhile, but not megabytes.
        assert!((16 * MEGABYTE..20 * MEGABYTE).contains(&peak), "{peak}");
        assert_eq!(held.len() + kept.len(), 9 * MEGABYTE);
    }
}
