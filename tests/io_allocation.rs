//! What a file promises costs nothing: memory is taken only for what the file really holds.

#![cfg(feature = "io")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use decimesh::io::heights::{self, HeightFormat, HeightOptions, RawLayout, SampleType};
use decimesh::io::{Format, read_from_slice};
use decimesh::lod::{Extent, Progressive};
use decimesh::rate_distortion::Decomposition;

struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call goes to the system's allocator as it comes; counting touches no memory of it.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(LIVE.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `alloc`, which is the same here.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the pointer came from `System.alloc` with this layout.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Ends only once every file is refused, with little memory used at any time.
#[test]
fn lying_headers_get_no_memory() {
    let ply = |format: &str, vertices: u64, faces: u64, length: &str, body: &[u8]| {
        let header = format!(
            "ply\nformat {format} 1.0\nelement empty 18446744073709551615\nelement vertex {vertices}\n\
             property float x\nproperty float y\nproperty float z\nelement face {faces}\n\
             property list {length} int vertex_indices\nend_header\n"
        );
        (Format::Ply, [header.as_bytes(), body].concat())
    };
    let gltf = |accessor: &str, rest: &str| {
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}}, "accessors": [{{"componentType": 5126, "type": "VEC3", {accessor}}}],
                "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}], {rest}}}"#
        );
        (Format::Gltf, text.into_bytes())
    };
    let buffer = r#""buffers": [{"byteLength": 4, "uri": "data:;base64,AAAAAA=="}],
        "bufferViews": [{"buffer": 0, "byteLength": 18446744073709551615}]"#;
    let stl = [&[0u8; 80][..], &u32::MAX.to_le_bytes(), &[0; 99]].concat();
    let glb = [
        &b"glTF"[..],
        &2u32.to_le_bytes(),
        &u32::MAX.to_le_bytes(),
        &(u32::MAX - 99).to_le_bytes(),
        b"JSON{}",
    ];
    let huge = [&[0; 12][..], &(1u32 << 31).to_le_bytes(), &[0; 40]].concat();
    let files = [
        ply("binary_little_endian", 4_000_000_000, 1, "uchar", &[0; 100]),
        ply("binary_big_endian", 1, 4_000_000_000, "uchar", &[0; 100]),
        ply("binary_little_endian", 1, 1, "uint", &huge),
        ply("ascii", 4_000_000_000, 1, "uchar", b"0 0 0\n"),
        ply("ascii", 1, 4_000_000_000, "uchar", b"0 0 0\n3 0 0 0\n"),
        ply("ascii", 1, 1, "uint", b"0 0 0\n4000000000 0 0 0\n"),
        (Format::Off, b"OFF 4000000000 1 0\n0 0 0\n".to_vec()),
        (Format::Off, b"OFF 1 4000000000 0\n0 0 0\n3 0 0 0\n".to_vec()),
        (Format::Off, b"OFF 1 1 0\n0 0 0\n4000000000 0 0 0\n".to_vec()),
        (Format::Obj, b"v 0 0 0\nf 1 1 4000000000\n".to_vec()),
        (Format::Stl, stl),
        (Format::Glb, glb.concat()),
        gltf(r#""count": 18446744073709551615, "bufferView": 0"#, buffer),
        gltf(r#""count": 4000000000, "bufferView": 0"#, buffer),
        gltf(
            r#""count": 4000000000, "sparse": {"count": 4000000000,
            "indices": {"bufferView": 0, "componentType": 5125}, "values": {"bufferView": 0}}"#,
            buffer,
        ),
        gltf(r#""count": 1"#, r#""buffers": [{"byteLength": 4000000000, "uri": "data:;base64,AAAA"}]"#),
    ];
    for (format, bytes) in files {
        let (used, error) = measured(|| read_from_slice(&bytes, format).map(drop));
        assert!(used < 64 << 10, "{used} bytes for {} bytes of {format:?}: {error}", bytes.len());
    }

    // Version, attributes, vertices and triangles of the finest and of the coarsest level, steps, marks.
    let (many, most) = (4_000_000_000, 1 << 29);
    for numbers in [
        [1, 7, many, most, 3, 1, many - 3, 0],
        [1, 7, many, most, many, 1, 0, 0],
        [1, 0, many, most, 3, most, many - 3, 0],
        [1, 0, many, most, 3, 1, many - 3, many],
    ] {
        let bytes =
            [&b"\x89DPM\r\n\x1a\n"[..], numbers.map(u32::to_le_bytes).as_flattened(), &[0; 99]].concat();
        for extent in [Extent::Whole, Extent::Triangles(1 << 20)] {
            let (used, error) = measured(|| Progressive::read_from_slice(&bytes, extent).map(drop));
            assert!(used < 64 << 10, "{used} bytes for {numbers:?}: {error}");
        }
    }

    // Version, flags, columns, rows, quads across and down, depth.
    for numbers in
        [[1, 0, 60_000, 60_000, 1, 1, 16], [1, 1, u32::MAX, u32::MAX, 1, 1, 31], [1, 0, 2, u32::MAX, 1, 1, 0]]
    {
        let bytes =
            [&b"\x89DRD\r\n\x1a\n"[..], numbers.map(u32::to_le_bytes).as_flattened(), &[0; 99]].concat();
        let (used, error) = measured(|| Decomposition::read_from_slice(&bytes).map(drop));
        assert!(used < 64 << 10, "{used} bytes for {numbers:?}: {error}");
    }

    // A TIFF of these tags beside those that say what samples are: each a LONG.
    let tiff = |tags: &[(u16, u32, u32)]| {
        let mut all = vec![(258, 1, 32), (262, 1, 1), (277, 1, 1), (339, 1, 3)];
        all.extend(tags);
        all.sort_unstable();
        let mut file = [&b"II\x2a\0\x08\0\0\0"[..], &(all.len() as u16).to_le_bytes()].concat();
        for (tag, count, value) in all {
            file.extend(tag.to_le_bytes());
            file.extend(4_u16.to_le_bytes());
            file.extend(count.to_le_bytes());
            file.extend(value.to_le_bytes());
        }
        file.extend([0; 40]);
        (HeightFormat::Tiff, file)
    };
    let strip =
        |height, offset, bytes| [(256, 1, 60_000), (257, 1, height), (273, 1, offset), (279, 1, bytes)];
    let tile = [
        (256, 1, 60_000),
        (257, 1, 60_000),
        (322, 1, 60_000),
        (323, 1, 60_000),
        (324, 1, 8),
        (325, 1, u32::MAX),
    ];
    let compressed = |method| [(259, 1, method)].into_iter().chain(strip(60_000, 8, 40)).collect::<Vec<_>>();
    let npy = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
        let length = (header.len() as u16).to_le_bytes();
        (HeightFormat::Npy, [b"\x93NUMPY\x01\0", &length[..], header.as_bytes(), &[0; 99]].concat())
    };
    let png = |columns: u32, rows: u32, kind: [u8; 5]| {
        let header = [&b"IHDR"[..], &columns.to_be_bytes(), &rows.to_be_bytes(), &kind].concat();
        let chunk = |body: &[u8]| {
            [&(body.len() as u32 - 4).to_be_bytes(), body, &crc32fast::hash(body).to_be_bytes()].concat()
        };
        let file = [&b"\x89PNG\r\n\x1a\n"[..], &chunk(&header), &chunk(b"IDATxxxx"), &chunk(b"IEND")];
        (HeightFormat::Png, file.concat())
    };
    let raw = RawLayout {
        columns: 1 << 31,
        rows: 1 << 31,
        sample: Some(SampleType::F64),
        byte_order: heights::ByteOrder::Little,
    };
    let options = HeightOptions { raw: Some(raw), ..HeightOptions::default() };
    for (format, bytes) in [
        tiff(&strip(60_000, 8, 40)),
        tiff(&strip(60_000, 8, u32::MAX)),
        tiff(&tile),
        tiff(&compressed(5)),
        tiff(&compressed(8)),
        tiff(&compressed(32773)),
        tiff(&[(256, 1, 60_000), (257, 1, 60_000), (273, 60_000, 8), (279, 60_000, 8)]),
        tiff(&[(256, 1, 60_000), (257, 1, 60_000), (273, u32::MAX, 8), (279, u32::MAX, 8)]),
        npy("(4000000000, 4000000000)"),
        npy("(100000, 100000)"),
        png(4_000_000, 4_000_000, [16, 0, 0, 0, 0]),
        png(1 << 30, 1, [16, 0, 0, 0, 0]),
        png(4_000_000, 4_000_000, [8, 2, 0, 0, 1]),
        (HeightFormat::Raw, vec![0; 99]),
    ] {
        let (used, error) = measured(|| heights::read_from_slice(&bytes, format, &options).map(drop));
        assert!(used < 256 << 10, "{used} bytes for {} bytes of {format:?}: {error}", bytes.len());
    }
}

/// The most memory that `read` has at any time, and why it fails.
fn measured<E>(read: impl FnOnce() -> Result<(), E>) -> (usize, E) {
    let before = LIVE.load(Relaxed);
    PEAK.store(before, Relaxed);
    let error = read().expect_err("more is promised than is there");
    (PEAK.load(Relaxed) - before, error)
}
