//! Structs that cross the boundary, older and newer ones too: the first field says how large one is.

use super::status::{DECIMESH_ERROR_STRUCT_SIZE, DECIMESH_ERROR_UNKNOWN_OPTION, Failure};
use std::ptr;

/// Larger than any struct will be: more is a field that was never set.
const MOST: usize = 1 << 16;
/// Fields up to here were in every struct there ever was.
const LEAST: usize = 16;
/// Every struct is as large as a multiple of its alignment.
const ALIGNMENT: usize = 8;

/// A struct of the header.
///
/// # Safety
/// The type is `repr(C)`, has no padding and an alignment of eight, its first field is the `u32` that
/// holds its size, and every other field may have any bits at all.
pub(super) unsafe trait Versioned: Copy {
    const NAME: &'static str;

    /// What the init function makes of it; the size is set.
    fn initial() -> Self;
}

/// The caller's struct; fields that an older caller does not have are as the init function sets them.
///
/// # Safety
/// `pointer` is not NULL, and what it points to is as long as its first field says.
pub(super) unsafe fn read<T: Versioned>(pointer: *const T) -> Result<T, Failure> {
    // SAFETY: as the caller of this function promises; only so much is read.
    unsafe {
        let size = size(pointer)?;
        let own = size_of::<T>();
        if let Some(place) = (own..size).find(|&place| *pointer.cast::<u8>().add(place) != 0) {
            let message = format!(
                "byte {place} of {}, which has {own} bytes here, is set: it is an option of a newer decimesh",
                T::NAME
            );
            return Err(Failure::new(DECIMESH_ERROR_UNKNOWN_OPTION, message));
        }
        let mut value = T::initial();
        ptr::copy_nonoverlapping(pointer.cast::<u8>(), (&raw mut value).cast::<u8>(), size.min(own));
        Ok(value)
    }
}

/// The size that a caller's struct says it has, if it can be one.
///
/// # Safety
/// `pointer` is not NULL and points to four bytes at least.
pub(super) unsafe fn size<T: Versioned>(pointer: *const T) -> Result<usize, Failure> {
    // SAFETY: as the caller of this function promises.
    let size = unsafe { pointer.cast::<u32>().read_unaligned() } as usize;
    let name = T::NAME;
    let problem = match size {
        0 => format!("struct_size of {name} is 0: call {name}_init first"),
        _ if size < LEAST => format!("struct_size of {name} is {size}, less than the {LEAST} it always had"),
        _ if size > MOST => format!("struct_size of {name} is {size}, more than the {MOST} it may have"),
        _ if !size.is_multiple_of(ALIGNMENT) => {
            format!("struct_size of {name} is {size}, no multiple of {ALIGNMENT}")
        }
        _ => return Ok(size),
    };
    Err(Failure::new(DECIMESH_ERROR_STRUCT_SIZE, problem))
}

/// Fills the caller's struct, as far as it goes, and leaves its size as it is.
///
/// # Safety
/// `pointer` is not NULL, and what it points to is `size` bytes long; `size` came from [`size`].
pub(super) unsafe fn write<T: Versioned>(pointer: *mut T, size: usize, value: &T) {
    const SIZE_FIELD: usize = size_of::<u32>();
    let length = size.min(size_of::<T>()) - SIZE_FIELD;
    // SAFETY: as the caller of this function promises; the two do not overlap, as `value` is ours.
    unsafe {
        let from = ptr::from_ref(value).cast::<u8>().add(SIZE_FIELD);
        ptr::copy_nonoverlapping(from, pointer.cast::<u8>().add(SIZE_FIELD), length);
    }
}

/// The body of an init function: NULL is left alone. An older caller's struct is filled as far as it
/// goes, and what a newer one has beyond ours becomes 0: not set.
///
/// # Safety
/// `pointer` is NULL or points to room for `size` bytes.
pub(super) unsafe fn initialize<T: Versioned>(pointer: *mut T, size: usize) {
    if pointer.is_null() || size < size_of::<u32>() {
        return;
    }
    // SAFETY: as the caller of this function promises.
    unsafe {
        ptr::write_bytes(pointer.cast::<u8>(), 0, size);
        write(pointer, size, &T::initial());
        // A size that no struct has stays for the calls to refuse.
        pointer.cast::<u32>().write_unaligned(u32::try_from(size).unwrap_or(u32::MAX));
    }
}
