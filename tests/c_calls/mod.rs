//! Structs of the C ABI for tests in Rust.

use std::ffi::CStr;
use std::mem::MaybeUninit;

use decimesh::capi::*;
use decimesh::mesh::Mesh;

/// The defaults.
pub(crate) fn options() -> decimesh_simplify_options {
    let mut options = MaybeUninit::uninit();
    // SAFETY: there is room for the options, and the call sets them all.
    unsafe {
        decimesh_simplify_options_init(options.as_mut_ptr(), size_of::<decimesh_simplify_options>());
        options.assume_init()
    }
}

/// Those of `mesh`, which must outlive what is done with them.
pub(crate) fn buffers(mesh: &Mesh) -> decimesh_buffers {
    let mut buffers = MaybeUninit::uninit();
    // SAFETY: there is room for the buffers, and the call sets them all.
    let mut buffers: decimesh_buffers = unsafe {
        decimesh_buffers_init(buffers.as_mut_ptr(), size_of::<decimesh_buffers>());
        buffers.assume_init()
    };
    buffers.positions = mesh.positions().as_ptr().cast();
    buffers.vertex_count = mesh.positions().len();
    buffers.indices = mesh.triangles().as_ptr().cast();
    buffers.index_count = mesh.triangles().as_flattened().len();
    let attributes = mesh.attributes();
    if let Some(normals) = &attributes.normals {
        buffers.normals = normals.as_ptr().cast();
    }
    if let Some(uvs) = &attributes.uvs {
        buffers.uvs = uvs.as_ptr().cast();
    }
    if let Some(colors) = &attributes.colors {
        buffers.colors = colors.as_ptr().cast();
    }
    buffers
}

pub(crate) fn succeeded(status: decimesh_status) {
    // SAFETY: the text is this thread's own, and nothing fails meanwhile.
    let message = unsafe { CStr::from_ptr(decimesh_last_error_message()) };
    assert_eq!(status, DECIMESH_OK, "{message:?}");
}

/// One to be filled.
#[allow(dead_code, reason = "not every test looks at one")]
pub(crate) fn report() -> decimesh_simplify_report {
    let mut report = MaybeUninit::uninit();
    // SAFETY: there is room for the report, and the call sets it all.
    unsafe {
        decimesh_simplify_report_init(report.as_mut_ptr(), size_of::<decimesh_simplify_report>());
        report.assume_init()
    }
}
