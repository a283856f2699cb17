//! The caller's vertex and index buffers.

use super::entry::null;
use super::status::{
    DECIMESH_ERROR_EMPTY, DECIMESH_ERROR_ENUM, DECIMESH_ERROR_INDEX_COUNT, DECIMESH_ERROR_OUT_OF_MEMORY,
    DECIMESH_ERROR_OVERFLOW, DECIMESH_ERROR_STRIDE, DECIMESH_ERROR_TOO_LARGE, Failure,
};
use super::structs::{self, Versioned};
use crate::mesh::{Attributes, Mesh};
use std::ffi::c_void;
use std::ptr;

/// The type of an index.
pub type decimesh_index_type = i32;
/// 16-bit unsigned integers.
pub const DECIMESH_INDEX_U16: decimesh_index_type = 1;
/// 32-bit unsigned integers.
pub const DECIMESH_INDEX_U32: decimesh_index_type = 2;

/// A mesh in buffers of the caller's, which a call only reads.
///
/// Strides are the bytes from one vertex to the next, so that interleaved buffers serve as they are;
/// 0 means that elements follow each other without a gap. No alignment is asked for.
/// Attributes are NULL where there are none.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_buffers {
    /// sizeof(decimesh_buffers), as decimesh_buffers_init sets it.
    pub struct_size: u32,
    /// DECIMESH_INDEX_U16 or DECIMESH_INDEX_U32.
    pub index_type: decimesh_index_type,
    /// x, y and z of each vertex: finite.
    pub positions: *const f32,
    /// 0, or at least 12.
    pub positions_stride: usize,
    /// Vertices: at least 1, fewer than 2^32.
    pub vertex_count: usize,
    /// Three indices a triangle, counter-clockwise from outside: each below vertex_count.
    pub indices: *const c_void,
    /// Indices: at least 3, a multiple of 3, fewer than 3 * 2^30.
    pub index_count: usize,
    /// Unit normals, x, y and z: finite; or NULL.
    pub normals: *const f32,
    /// 0, or at least 12.
    pub normals_stride: usize,
    /// Texture coordinates, u and v: finite; or NULL.
    pub uvs: *const f32,
    /// 0, or at least 8.
    pub uvs_stride: usize,
    /// Colours: red, green, blue and alpha, 0 to 255; or NULL.
    pub colors: *const u8,
    /// 0, or at least 4.
    pub colors_stride: usize,
}

/// A mesh in buffers of the caller's, which a call may overwrite. Otherwise as decimesh_buffers.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct decimesh_mutable_buffers {
    /// sizeof(decimesh_mutable_buffers), as decimesh_mutable_buffers_init sets it.
    pub struct_size: u32,
    /// DECIMESH_INDEX_U16 or DECIMESH_INDEX_U32.
    pub index_type: decimesh_index_type,
    /// x, y and z of each vertex: finite.
    pub positions: *mut f32,
    /// 0, or at least 12.
    pub positions_stride: usize,
    /// Vertices: at least 1, fewer than 2^32.
    pub vertex_count: usize,
    /// Three indices a triangle, counter-clockwise from outside: each below vertex_count.
    pub indices: *mut c_void,
    /// Indices: at least 3, a multiple of 3, fewer than 3 * 2^30.
    pub index_count: usize,
    /// Unit normals, x, y and z: finite; or NULL.
    pub normals: *mut f32,
    /// 0, or at least 12.
    pub normals_stride: usize,
    /// Texture coordinates, u and v: finite; or NULL.
    pub uvs: *mut f32,
    /// 0, or at least 8.
    pub uvs_stride: usize,
    /// Colours: red, green, blue and alpha, 0 to 255; or NULL.
    pub colors: *mut u8,
    /// 0, or at least 4.
    pub colors_stride: usize,
}

// SAFETY: repr(C); two 32-bit integers, then pointers and sizes of 8 bytes; all may have any bits.
unsafe impl Versioned for decimesh_buffers {
    const NAME: &'static str = "decimesh_buffers";

    fn initial() -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            index_type: DECIMESH_INDEX_U32,
            positions: ptr::null(),
            positions_stride: 0,
            vertex_count: 0,
            indices: ptr::null(),
            index_count: 0,
            normals: ptr::null(),
            normals_stride: 0,
            uvs: ptr::null(),
            uvs_stride: 0,
            colors: ptr::null(),
            colors_stride: 0,
        }
    }
}

// SAFETY: as for `decimesh_buffers`.
unsafe impl Versioned for decimesh_mutable_buffers {
    const NAME: &'static str = "decimesh_mutable_buffers";

    fn initial() -> Self {
        Self {
            struct_size: size_of::<Self>() as u32,
            index_type: DECIMESH_INDEX_U32,
            positions: ptr::null_mut(),
            positions_stride: 0,
            vertex_count: 0,
            indices: ptr::null_mut(),
            index_count: 0,
            normals: ptr::null_mut(),
            normals_stride: 0,
            uvs: ptr::null_mut(),
            uvs_stride: 0,
            colors: ptr::null_mut(),
            colors_stride: 0,
        }
    }
}

impl decimesh_mutable_buffers {
    /// The same buffers, to be read.
    pub(super) fn shared(&self) -> decimesh_buffers {
        decimesh_buffers {
            struct_size: size_of::<decimesh_buffers>() as u32,
            index_type: self.index_type,
            positions: self.positions,
            positions_stride: self.positions_stride,
            vertex_count: self.vertex_count,
            indices: self.indices,
            index_count: self.index_count,
            normals: self.normals,
            normals_stride: self.normals_stride,
            uvs: self.uvs,
            uvs_stride: self.uvs_stride,
            colors: self.colors,
            colors_stride: self.colors_stride,
        }
    }

    /// Gives the vertices `places` what those of `mesh` have, in its order. Attributes without a buffer
    /// go nowhere.
    ///
    /// # Safety
    /// [`read_mesh`] has read these buffers, and nobody else looks at them.
    pub(super) unsafe fn write_vertices(&self, mesh: &Mesh, places: &[u32]) {
        let Attributes { normals, colors, uvs } = mesh.attributes();
        // SAFETY: where there was an element to read there is room for one.
        unsafe {
            scatter(self.positions, self.positions_stride, mesh.positions(), places);
            scatter(self.normals, self.normals_stride, normals.as_deref().unwrap_or_default(), places);
            scatter(self.uvs, self.uvs_stride, uvs.as_deref().unwrap_or_default(), places);
            scatter(self.colors, self.colors_stride, colors.as_deref().unwrap_or_default(), places);
        }
    }
}

/// Makes *buffers empty: struct_size is set, indices are 32 bits wide, all else is 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_buffers), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_buffers_init(buffers: *mut decimesh_buffers, struct_size: usize) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(buffers, struct_size) }
}

/// Makes *buffers empty: struct_size is set, indices are 32 bits wide, all else is 0. NULL is left alone.
///
/// struct_size is sizeof(decimesh_mutable_buffers), as the caller was compiled: no more is written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn decimesh_mutable_buffers_init(
    buffers: *mut decimesh_mutable_buffers,
    struct_size: usize,
) {
    // SAFETY: the caller\'s pointer is NULL or points to a struct of that size.
    unsafe { structs::initialize(buffers, struct_size) }
}

/// A copy of the mesh in `buffers`.
///
/// # Safety
/// Each buffer that is not NULL is as long as its count and stride say.
pub(super) unsafe fn read_mesh(buffers: &decimesh_buffers) -> Result<Mesh, Failure> {
    let &decimesh_buffers { vertex_count, index_count, index_type, .. } = buffers;
    if buffers.positions.is_null() {
        return Err(null("positions"));
    }
    if buffers.indices.is_null() {
        return Err(null("indices"));
    }
    for (name, count) in [("vertex_count", vertex_count), ("index_count", index_count)] {
        if count == 0 {
            return Err(Failure::new(DECIMESH_ERROR_EMPTY, format!("{name} is 0")));
        }
    }
    if !index_count.is_multiple_of(3) {
        let message = format!("index_count is {index_count}, no multiple of three");
        return Err(Failure::new(DECIMESH_ERROR_INDEX_COUNT, message));
    }
    check_index_type(index_type)?;
    limit("vertex_count", vertex_count, u32::MAX as usize)?;
    limit("index_count", index_count, 3 * Mesh::MAX_TRIANGLES)?;
    // SAFETY: as the caller of this function promises.
    unsafe {
        let positions = gather("positions", buffers.positions, buffers.positions_stride, vertex_count)?;
        let normals = optional("normals", buffers.normals, buffers.normals_stride, vertex_count)?;
        let uvs = optional("uvs", buffers.uvs, buffers.uvs_stride, vertex_count)?;
        let colors = optional("colors", buffers.colors, buffers.colors_stride, vertex_count)?;
        let triangles = if index_type == DECIMESH_INDEX_U16 {
            let narrow = gather("indices", buffers.indices.cast::<u16>(), 0, index_count / 3)?;
            narrow.into_iter().map(|triangle: [u16; 3]| triangle.map(u32::from)).collect()
        } else {
            gather("indices", buffers.indices.cast::<u32>(), 0, index_count / 3)?
        };
        Ok(Mesh::with_attributes(positions, triangles, Attributes { normals, colors, uvs })?)
    }
}

fn limit(name: &str, count: usize, most: usize) -> Result<(), Failure> {
    if count > most {
        let message = format!("{name} is {count}, more than the {most} that a mesh can hold");
        return Err(Failure::new(DECIMESH_ERROR_OVERFLOW, message));
    }
    Ok(())
}

unsafe fn optional<T: Copy, const N: usize>(
    name: &str,
    first: *const T,
    stride: usize,
    count: usize,
) -> Result<Option<Vec<[T; N]>>, Failure> {
    // SAFETY: as the caller of this function promises.
    if first.is_null() { Ok(None) } else { unsafe { gather(name, first, stride, count) }.map(Some) }
}

/// Copies `count` elements that lie `stride` bytes apart.
///
/// # Safety
/// `first` points to so many, aligned or not.
pub(super) unsafe fn gather<T: Copy, const N: usize>(
    name: &str,
    first: *const T,
    stride: usize,
    count: usize,
) -> Result<Vec<[T; N]>, Failure> {
    let stride = checked_stride::<T, N>(name, stride, count)?;
    let mut elements: Vec<[T; N]> = Vec::new();
    if elements.try_reserve_exact(count).is_err() {
        let message = format!("no memory for a copy of {count} elements of {name}");
        return Err(Failure::new(DECIMESH_ERROR_OUT_OF_MEMORY, message));
    }
    let bytes = first.cast::<u8>();
    // SAFETY: each element lies within what the caller of this function vouches for, and the product
    // cannot overflow, as `checked_stride` has seen.
    elements.extend((0..count).map(|i| unsafe { bytes.add(i * stride).cast::<[T; N]>().read_unaligned() }));
    Ok(elements)
}

/// Bytes from one element to the next.
fn checked_stride<T, const N: usize>(name: &str, stride: usize, count: usize) -> Result<usize, Failure> {
    let least = size_of::<[T; N]>();
    let stride = if stride == 0 { least } else { stride };
    if stride < least {
        let message = format!("the stride of {name} is {stride}, less than the {least} bytes of an element");
        return Err(Failure::new(DECIMESH_ERROR_STRIDE, message));
    }
    match count.checked_mul(stride) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(stride),
        _ => {
            let message = format!("{count} {name}, {stride} bytes apart, exceed the address space");
            Err(Failure::new(DECIMESH_ERROR_OVERFLOW, message))
        }
    }
}

/// Writes `elements` to the `places` of a buffer, if there is one.
///
/// # Safety
/// `first` is NULL, or the buffer is the caller's to write to at all `places`.
unsafe fn scatter<T: Copy, const N: usize>(
    first: *mut T,
    stride: usize,
    elements: &[[T; N]],
    places: &[u32],
) {
    if first.is_null() {
        return;
    }
    let stride = if stride == 0 { size_of::<[T; N]>() } else { stride };
    for (element, &place) in elements.iter().zip(places) {
        // SAFETY: as the caller of this function promises.
        unsafe {
            first.cast::<u8>().add(place as usize * stride).cast::<[T; N]>().write_unaligned(*element);
        }
    }
}

/// Writes `elements` one after the other, if there is somewhere to write to.
///
/// # Safety
/// `first` is NULL, or there is room for them.
pub(super) unsafe fn write_elements<T: Copy>(first: *mut T, elements: &[T]) {
    if !first.is_null() {
        // SAFETY: as the caller of this function promises; the memory is not ours. Bytes need no alignment.
        unsafe {
            ptr::copy_nonoverlapping(elements.as_ptr().cast::<u8>(), first.cast(), size_of_val(elements));
        }
    }
}

/// The caller's memory for the indices of a level.
pub(super) struct IndexRoom {
    pub(super) index_type: decimesh_index_type,
    pub(super) destination: *mut c_void,
    /// How many indices it has room for.
    pub(super) room: usize,
}

impl IndexRoom {
    /// Copies a level of so many `vertices`.
    ///
    /// # Safety
    /// There is as much room as it says.
    pub(super) unsafe fn copy(&self, triangles: &[[u32; 3]], vertices: usize) -> Result<(), Failure> {
        let &Self { index_type, destination, room } = self;
        let indices = triangles.as_flattened();
        check_index_type(index_type)?;
        let too_large = |message: String| Err(Failure::new(DECIMESH_ERROR_TOO_LARGE, message));
        if indices.len() > room {
            return too_large(format!(
                "the level has {} indices, more than the room of {room}",
                indices.len()
            ));
        }
        if index_type == DECIMESH_INDEX_U16 && vertices > 1 << 16 {
            return too_large(format!("the level has {vertices} vertices, more than 16 bits can name"));
        }
        // SAFETY: as the caller of this function promises, and they have just been seen to fit.
        unsafe { write_indices(destination, index_type, indices.iter().copied()) };
        Ok(())
    }
}

fn check_index_type(index_type: decimesh_index_type) -> Result<(), Failure> {
    if matches!(index_type, DECIMESH_INDEX_U16 | DECIMESH_INDEX_U32) {
        return Ok(());
    }
    let message = format!(
        "index_type is {index_type}, neither DECIMESH_INDEX_U16 ({DECIMESH_INDEX_U16}) nor DECIMESH_INDEX_U32 \
         ({DECIMESH_INDEX_U32})"
    );
    Err(Failure::new(DECIMESH_ERROR_ENUM, message))
}

/// Writes indices of `index_type`, which [`check_index_type`] has found to be one.
///
/// # Safety
/// There is room for them, and indices of 16 bits hold them.
pub(super) unsafe fn write_indices(
    destination: *mut c_void,
    index_type: decimesh_index_type,
    indices: impl Iterator<Item = u32>,
) {
    for (place, index) in indices.enumerate() {
        // SAFETY: as the caller of this function promises.
        unsafe {
            if index_type == DECIMESH_INDEX_U16 {
                destination.cast::<u16>().add(place).write_unaligned(index as u16);
            } else {
                destination.cast::<u32>().add(place).write_unaligned(index);
            }
        }
    }
}
