//! How much memory each contender takes at its highest: an allocator that counts, for both languages.

use std::alloc::{Layout, System, alloc, dealloc, handle_alloc_error};
use std::ffi::c_void;
use std::process::abort;

use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// Holds the size in front of each block of C++'s; keeps the alignment of `malloc`.
const HEADER: usize = 16;

/// Begins to count: the bytes that are allocated from now on, less those that are freed.
pub(crate) fn reset_peak() {
    ALLOCATOR.reset_peak_memory();
}

/// The highest count since [`reset_peak`], of all threads.
pub(crate) fn peak_bytes() -> usize {
    ALLOCATOR.get_peak_memory()
}

/// Makes meshoptimizer allocate where Rust does. Some dozens of large blocks a call: its time stays.
pub(crate) fn count_meshoptimizer() {
    // SAFETY: nothing of meshoptimizer's is running or holds memory yet, and the two functions keep to
    // the contract of `malloc` and `free`.
    unsafe { meshopt::ffi::meshopt_setAllocator(Some(allocate), Some(deallocate)) };
}

/// C++'s `operator new(std::size_t)`, as the Itanium ABI spells it on 64 bits: in a program that has its
/// own, OpenMesh's library and templates use it, and the forms for arrays go through it. It is how
/// OpenMesh's memory is counted, for which it has no hook. Forms with an alignment are left alone: they
/// come in pairs of their own.
#[cfg(all(unix, target_pointer_width = "64"))]
#[unsafe(export_name = "_Znwm")]
unsafe extern "C" fn operator_new(size: usize) -> *mut c_void {
    // SAFETY: `allocate` may be asked for any size.
    unsafe { allocate(size) }
}

/// C++'s `operator delete(void*)`, which the forms for arrays and with a size go through.
#[cfg(all(unix, target_pointer_width = "64"))]
#[unsafe(export_name = "_ZdlPv")]
unsafe extern "C" fn operator_delete(block: *mut c_void) {
    // SAFETY: what C++ deletes, it got from `operator_new`, which is `allocate`.
    unsafe { deallocate(block) }
}

unsafe extern "C" fn allocate(size: usize) -> *mut c_void {
    // Unwinding through C++ is not an option.
    let Some(bytes) = size.checked_add(HEADER) else { abort() };
    let Ok(layout) = Layout::from_size_align(bytes, HEADER) else { abort() };
    // SAFETY: the layout has the header at least, so its size is not zero; the block is large enough
    // and aligned for the `usize` written to its begin, and what is handed out lies within it.
    unsafe {
        let start = alloc(layout);
        if start.is_null() {
            handle_alloc_error(layout);
        }
        start.cast::<usize>().write(bytes);
        start.add(HEADER).cast()
    }
}

unsafe extern "C" fn deallocate(block: *mut c_void) {
    if block.is_null() {
        return;
    }
    // SAFETY: the caller gives back what `allocate` returned, once: the header lies in front of it and
    // holds the size, and size and alignment were valid as a layout then.
    unsafe {
        let start = block.cast::<u8>().sub(HEADER);
        let bytes = start.cast::<usize>().read();
        dealloc(start, Layout::from_size_align_unchecked(bytes, HEADER));
    }
}
