//! What files say comes back.

use decimesh::io::FileError;
use decimesh::io::heights::{
    ByteOrder, HeightFormat, HeightOptions, Heights, Pixels, RawLayout, SampleType, read, read_from_slice,
};
use decimesh::rate_distortion::{self, HeightField, HeightFileError};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::encode::{
    ASCII, Chunks, DOUBLE, SHORT, Tiff, bytes, npy, npy_header, png, png_grey16, tiff_compressed,
};

const SAMPLES: [(SampleType, &str); 8] = [
    (SampleType::U8, "u1"),
    (SampleType::I8, "i1"),
    (SampleType::U16, "u2"),
    (SampleType::I16, "i2"),
    (SampleType::U32, "u4"),
    (SampleType::I32, "i4"),
    (SampleType::F32, "f4"),
    (SampleType::F64, "f8"),
];
const ORDERS: [(ByteOrder, char); 2] = [(ByteOrder::Little, '<'), (ByteOrder::Big, '>')];

fn options() -> HeightOptions {
    HeightOptions::default()
}

fn read_well(bytes: &[u8], format: HeightFormat, options: &HeightOptions) -> Heights {
    read_from_slice(bytes, format, options).unwrap_or_else(|error| panic!("{format:?}: {error}"))
}

fn assert_holds(found: &Heights, size: [usize; 2], values: &[f64]) {
    assert_eq!([found.columns, found.rows], size);
    let expected: Vec<_> = values.iter().map(|&value| value as f32).collect();
    assert_eq!(found.heights, expected);
}

/// A size, and whole numbers that every type can hold.
fn grid() -> impl Strategy<Value = ([usize; 2], Vec<f64>)> {
    (1usize..20, 1usize..20).prop_flat_map(|(columns, rows)| {
        (Just([columns, rows]), vec((0u8..128).prop_map(f64::from), columns * rows))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_type_order_and_cut_brings_the_samples_back(
        (size, values) in grid(),
        cut in 1usize..24,
        other_cut in 1usize..24,
    ) {
        let [columns, rows] = size;
        for (sample, name) in SAMPLES {
            for (order, mark) in ORDERS {
                let body = bytes(&values, sample, order);
                for version in 1..=3 {
                    let file = npy(version, &npy_header(&format!("{mark}{name}"), rows, columns), &body);
                    assert_holds(&read_well(&file, HeightFormat::Npy, &options()), size, &values);
                }
                let raw = Some(RawLayout { columns, rows, sample: Some(sample), byte_order: order });
                let raw = HeightOptions { raw, ..options() };
                assert_holds(&read_well(&body, HeightFormat::Raw, &raw), size, &values);
                for chunks in [
                    Chunks::Strips { rows: cut },
                    Chunks::Tiles { columns: cut, rows: other_cut },
                ] {
                    let file = Tiff::new(size, &values, sample, order, chunks).build();
                    assert_holds(&read_well(&file, HeightFormat::Tiff, &options()), size, &values);
                }
            }
        }
    }

    #[test]
    fn compressed_files_bring_the_samples_back((size, values) in grid(), minus in any::<bool>()) {
        use tiff::encoder::{Compression, DeflateLevel};
        let values: Vec<_> = values.iter().map(|value| if minus { -value * 255.0 } else { *value }).collect();
        let [columns, rows] = size.map(|count| count as u32);
        let samples: Vec<_> = values.iter().map(|&value| value as i16).collect();
        for compression in [
            Compression::Uncompressed,
            Compression::Packbits,
            Compression::Lzw,
            Compression::Deflate(DeflateLevel::Best),
        ] {
            let file = tiff_compressed(columns, rows, &samples, compression);
            assert_holds(&read_well(&file, HeightFormat::Tiff, &options()), size, &values);
        }
        if !minus {
            let samples: Vec<_> = values.iter().map(|&value| value as u16 * 511).collect();
            let file = png_grey16(columns, rows, &samples);
            let values: Vec<_> = samples.iter().copied().map(f64::from).collect();
            assert_holds(&read_well(&file, HeightFormat::Png, &options()), size, &values);
        }
    }
}

/// Some tiles that stick out of the image end in a way that the decoder, reading row by row, takes for too short.
#[test]
fn tiles_that_stick_out_are_read_to_their_end() {
    let size = [37, 16];
    let mut random = 1_u32;
    for _ in 0..200 {
        let values: Vec<_> = (0..size[0] * size[1])
            .map(|_| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(random >> 28)
            })
            .collect();
        for (order, _) in ORDERS {
            let chunks = Chunks::Tiles { columns: 16, rows: 16 };
            let file = Tiff::new(size, &values, SampleType::U16, order, chunks).with_lzw().build();
            assert_holds(&read_well(&file, HeightFormat::Tiff, &options()), size, &values);
        }
    }
}

#[test]
fn long_files_are_read_piece_by_piece_and_whole() {
    let (columns, rows) = (300, 400);
    let values: Vec<_> = (0..columns * rows).map(|sample| f64::from(sample as u32) * 0.25).collect();
    let body = bytes(&values, SampleType::F64, ByteOrder::Big);
    let file = npy(1, &npy_header(">f8", rows, columns), &body);
    assert_holds(&read_well(&file, HeightFormat::Npy, &options()), [columns, rows], &values);
}

#[test]
fn pixels_mean_what_they_are_said_to_mean() {
    use png::{BitDepth, ColorType};
    let grey = png(2, 2, ColorType::Grayscale, BitDepth::Eight, &[0, 1, 128, 255]);
    assert_holds(&read_well(&grey, HeightFormat::Png, &options()), [2, 2], &[0.0, 1.0, 128.0, 255.0]);

    // Sea level is 100,000 tenths of a metre above the lowest: 1, 134, 160.
    let terrain = HeightOptions { pixels: Pixels::TerrainRgb, ..options() };
    let colors = [[0, 0, 0], [1, 134, 160], [1, 134, 161], [255, 255, 255]];
    let expected = [-10_000.0, 0.0, 0.1, 1_667_721.5];
    let rgb = png(2, 2, ColorType::Rgb, BitDepth::Eight, colors.as_flattened());
    assert_holds(&read_well(&rgb, HeightFormat::Png, &terrain), [2, 2], &expected);
    let rgba: Vec<_> = colors.iter().flat_map(|&[r, g, b]| [r, g, b, 1]).collect();
    let rgba = png(2, 2, ColorType::Rgba, BitDepth::Eight, &rgba);
    assert_holds(&read_well(&rgba, HeightFormat::Png, &terrain), [2, 2], &expected);

    let error = read_from_slice(&rgb, HeightFormat::Png, &options()).expect_err("colours are not grey");
    assert!(error.to_string().contains("may be Terrain-RGB"), "{error}");
    let error = read_from_slice(&grey, HeightFormat::Png, &terrain).expect_err("grey is no colour");
    assert!(error.to_string().contains("Grayscale with 8 bits"), "{error}");
}

#[test]
fn transparent_terrain_is_void() {
    let pixels = [[1, 134, 160, 255], [9, 9, 9, 0], [1, 134, 160, 255], [1, 134, 160, 255]];
    let file = png(2, 2, png::ColorType::Rgba, png::BitDepth::Eight, pixels.as_flattened());
    let terrain = HeightOptions { pixels: Pixels::TerrainRgb, ..options() };
    let field = HeightField::try_from(read_well(&file, HeightFormat::Png, &terrain)).expect("a field");
    assert_eq!(field.voids(), 1);
    assert!(field.is_void(1, 0));
}

/// Adam7 by the specification: which pixels come in which pass.
#[test]
fn interlaced_images_are_put_together() {
    use std::io::Write;
    let (columns, rows) = (13, 11);
    let value = |x: usize, y: usize| (y * columns + x) as u16 * 300;
    let mut raw = Vec::new();
    for (left, top, across, down) in
        [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
    {
        for y in (top..rows).step_by(down) {
            raw.push(0);
            raw.extend((left..columns).step_by(across).flat_map(|x| value(x, y).to_be_bytes()));
        }
    }
    let chunk = |kind: &[u8], data: &[u8]| {
        let body = [kind, data].concat();
        let check = crc32fast::hash(&body);
        [&(data.len() as u32).to_be_bytes(), &body[..], &check.to_be_bytes()].concat()
    };
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    zlib.write_all(&raw).expect("memory");
    let header = [&[0, 0, 0, 13, 0, 0, 0, 11][..], &[16, 0, 0, 0, 1]].concat();
    let file = [
        &b"\x89PNG\r\n\x1a\n"[..],
        &chunk(b"IHDR", &header),
        &chunk(b"IDAT", &zlib.finish().expect("memory")),
        &chunk(b"IEND", &[]),
    ]
    .concat();
    let expected: Vec<_> =
        (0..rows).flat_map(|y| (0..columns).map(move |x| f64::from(value(x, y)))).collect();
    assert_holds(&read_well(&file, HeightFormat::Png, &options()), [columns, rows], &expected);
}

#[test]
fn voids_are_told_before_heights_are_scaled() {
    let values = [-32768.0, 100.0, 200.0, 3.0];
    let file = npy(1, &npy_header("<i2", 2, 2), &bytes(&values, SampleType::I16, ByteOrder::Little));
    let options = HeightOptions { no_data: Some(-32768.0), scale: 0.5, offset: -50.0, ..options() };
    let found = read_well(&file, HeightFormat::Npy, &options);
    assert!(found.heights[0].is_nan());
    // That a height comes out as what meant "void" does not make it void.
    assert_eq!(found.heights[1..], [0.0, 50.0, -48.5]);
    let field = HeightField::try_from(found).expect("a field");
    assert_eq!((field.voids(), field.range()), (1, (-48.5, 50.0)));
}

fn tiff(values: &[f64], sample: SampleType) -> Tiff {
    Tiff::new([2, 2], values, sample, ByteOrder::Little, Chunks::Strips { rows: 2 })
}

#[test]
fn gdals_no_data_value_is_heeded() {
    let lowest = f64::from(f32::MIN);
    for (text, void, sample) in [
        ("-9999", -9999.0, SampleType::I16),
        (" -9999.0 ", -9999.0, SampleType::F32),
        ("-3.4028234663852886e+38", lowest, SampleType::F32),
        ("-3.4028235e+38", lowest, SampleType::F32),
        ("nan", f64::NAN, SampleType::F32),
        ("-1.7976931348623157e+308", f64::MIN, SampleType::F64),
    ] {
        let mut file = tiff(&[1.0, void, 2.0, 3.0], sample);
        file.set_text(42113, text);
        let found = read_well(&file.build(), HeightFormat::Tiff, &options());
        assert!(found.heights[1].is_nan(), "{text}: {found:?}");
        assert_eq!([0, 2, 3].map(|sample| found.heights[sample]), [1.0, 2.0, 3.0]);
    }
    let mut file = tiff(&[1.0, -9999.0, 2.0, 3.0], SampleType::F32);
    file.set_text(42113, "-9999");
    let more = HeightOptions { no_data: Some(2.0), ..options() };
    let found = read_well(&file.build(), HeightFormat::Tiff, &more);
    assert!(found.heights[1].is_nan() && found.heights[2].is_nan());
    file.set_text(42113, "none");
    let error = read_from_slice(&file.build(), HeightFormat::Tiff, &options()).expect_err("no number");
    assert_eq!(error.to_string(), "no-data value: 'none' is not a number");
}

#[test]
fn pixel_scale_is_a_distance_on_projected_maps_alone() {
    let mut file = tiff(&[0.0; 4], SampleType::F32);
    file.set(33550, DOUBLE, &[30.0, 25.0, 0.0]);
    let spacing =
        |file: &Tiff, options: &HeightOptions| read_well(&file.build(), HeightFormat::Tiff, options).spacing;
    let keys = |model: f64| [1.0, 1.0, 0.0, 2.0, 1024.0, 0.0, 1.0, model, 1025.0, 0.0, 1.0, 1.0];
    assert_eq!(spacing(&file, &options()), None);
    file.set(34735, SHORT, &keys(2.0));
    assert_eq!(spacing(&file, &options()), None);
    file.set(34735, SHORT, &keys(1.0));
    assert_eq!(spacing(&file, &options()), Some([30.0, 25.0]));
    let other = HeightOptions { spacing: Some([1.0, 2.0]), ..options() };
    assert_eq!(spacing(&file, &other), Some([1.0, 2.0]));
    let found = read_well(&file.build(), HeightFormat::Tiff, &options());
    assert_eq!(HeightField::try_from(found).expect("a field").spacing(), [30.0, 25.0]);
    // A scale that is no distance is not taken for one.
    file.set(33550, DOUBLE, &[30.0, 0.0, 0.0]);
    let found = read_well(&file.build(), HeightFormat::Tiff, &options());
    assert!(matches!(HeightField::try_from(found), Err(rate_distortion::Error::Spacing { .. })));
}

#[test]
fn what_is_not_read_is_said() {
    let refuse = |tiff: &Tiff, part: &str| {
        let error = read_from_slice(&tiff.build(), HeightFormat::Tiff, &options()).expect_err(part);
        assert!(error.to_string().contains(part), "{error} does not say {part}");
    };
    let good = tiff(&[0.0; 4], SampleType::F32);
    for (tag, kind, value, part) in [
        (277, SHORT, 3.0, "a TIFF of 3 bands, not one, cannot be read"),
        (262, SHORT, 0.0, "not levels from black up"),
        (262, SHORT, 2.0, "not levels from black up"),
        (258, SHORT, 4.0, "cannot be read"),
        (258, SHORT, 64.0, "cannot come from 16 bytes"),
        (258, SHORT, 12.0, "cannot be read"),
        (259, SHORT, 7.0, "cannot"),
        (259, SHORT, 50000.0, "cannot"),
        (339, SHORT, 6.0, "cannot be read"),
        (257, ASCII, 2.0, "directory: "),
    ] {
        let mut file = good.clone();
        file.set(tag, kind, &[value]);
        refuse(&file, part);
    }
    for (header, part) in [
        (npy_header("<c8", 2, 2), "an array of the type '<c8' cannot be read"),
        (npy_header("<f2", 2, 2), "an array of the type '<f2' cannot be read"),
        (npy_header("f4", 2, 2), "'f4' is no type of NumPy's"),
        (npy_header("", 2, 2), "'' is no type of NumPy's"),
        (npy_header("é", 2, 2), "'é' is no type of NumPy's"),
        (npy_header("<f4", 2, 2).replace("False", "True"), "stored column by column"),
        (npy_header("<f4", 2, 2).replace("(2, 2)", "(4,)"), "an array of 1 dimensions, not two,"),
        (npy_header("<f4", 2, 2).replace("(2, 2)", "()"), "an array of 0 dimensions"),
        (npy_header("<f4", 2, 2).replace("(2, 2)", "(2, -2)"), "a whole number should be"),
        (npy_header("<f4", 2, 2).replace("'<f4'", "[('x', '<f4')]"), "an array of records"),
        (npy_header("<f4", 2, 2).replace("descr", "kind"), "an unknown entry 'kind'"),
        ("{'descr': '<f4', 'shape': (2, 2)}".into(), "no entry 'fortran_order'"),
        ("{'descr': '<f4'".into(), "a comma should be"),
        (String::new(), "where '{' should be"),
    ] {
        let file = npy(1, &header, &[0; 16]);
        let error = read_from_slice(&file, HeightFormat::Npy, &options()).expect_err(part);
        assert!(error.to_string().contains(part), "{error} does not say {part}");
    }
}

#[test]
fn files_are_read_by_their_extension() {
    let directory = tempfile::tempdir().expect("a directory");
    let values = [1.0, 2.0, 3.0, 4.0, 5.0, 60.0];
    let size = [3, 2];
    let raw = Some(RawLayout { columns: 3, rows: 2, sample: None, byte_order: ByteOrder::Little });
    let raw_options = HeightOptions { raw, ..options() };
    let body = |sample| bytes(&values, sample, ByteOrder::Little);
    let tiff = Tiff::new(size, &values, SampleType::I16, ByteOrder::Big, Chunks::Strips { rows: 1 }).build();
    for (extension, content) in [
        ("png", png_grey16(3, 2, &values.map(|value| value as u16))),
        ("tif", tiff.clone()),
        ("TIFF", tiff),
        ("npy", npy(2, &npy_header("<f4", 2, 3), &body(SampleType::F32))),
        ("f32", body(SampleType::F32)),
        ("i16", body(SampleType::I16)),
        ("U16", body(SampleType::U16)),
    ] {
        let path = directory.path().join(format!("heights.{extension}"));
        std::fs::write(&path, &content).expect("a file");
        assert_holds(&read(&path, &raw_options).expect(extension), size, &values);
        assert_eq!(HeightField::read(&path, &raw_options).expect(extension).columns(), 3);
        let nameless = directory.path().join("heights");
        std::fs::write(&nameless, &content).expect("a file");
        if HeightFormat::from_path(&path).expect("a format") != HeightFormat::Raw {
            let format = Some(HeightFormat::from_path(&path).expect("a format"));
            let found = read(&nameless, &HeightOptions { format, ..options() });
            assert_holds(&found.expect(extension), size, &values);
        }
    }
    let path = directory.path().join("heights.bin");
    std::fs::write(&path, body(SampleType::U8)).expect("a file");
    let say = |options: &HeightOptions| read(&path, options).expect_err("too little is told").to_string();
    assert!(say(&options()).ends_with("raw samples whose columns and rows are not told cannot be read"));
    assert!(say(&raw_options).ends_with("raw samples whose type is not told cannot be read"));
    let error = read("heights.jpg".as_ref(), &options()).expect_err("no format of heights");
    assert!(matches!(error, FileError::UnknownHeightFormat { .. }));
}

#[test]
fn what_makes_no_surface_is_read_but_makes_no_field() {
    for size in [[1, 1], [2, 1], [1, 2]] {
        let [columns, rows] = size;
        let values = vec![7.0; columns * rows];
        let samples = vec![7; columns * rows];
        let body = bytes(&values, SampleType::F32, ByteOrder::Little);
        for (format, file) in [
            (HeightFormat::Png, png_grey16(columns as u32, rows as u32, &samples)),
            (
                HeightFormat::Tiff,
                Tiff::new(size, &values, SampleType::F32, ByteOrder::Little, Chunks::Strips { rows: 1 })
                    .build(),
            ),
            (HeightFormat::Npy, npy(1, &npy_header("<f4", rows, columns), &body)),
        ] {
            let found = read_well(&file, format, &options());
            assert_holds(&found, size, &values);
            let error = HeightField::try_from(found).expect_err("no surface");
            assert_eq!(error, rate_distortion::Error::TooSmall { columns, rows });
        }
    }
    for shape in [[0, 0], [0, 5], [5, 0]] {
        let found =
            read_well(&npy(1, &npy_header("<f4", shape[0], shape[1]), &[]), HeightFormat::Npy, &options());
        assert!(matches!(HeightField::try_from(found), Err(rate_distortion::Error::TooSmall { .. })));
    }
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("void.npy");
    std::fs::write(&path, npy(1, &npy_header("|u1", 2, 2), &[9; 4])).expect("a file");
    let error = HeightField::read(&path, &HeightOptions { no_data: Some(9.0), ..options() });
    let error = error.expect_err("all void");
    assert!(matches!(error, HeightFileError::Field { source: rate_distortion::Error::AllVoid { .. }, .. }));
    assert!(error.to_string().ends_with("void.npy: all of 2 columns times 2 rows are void"), "{error}");
}

#[test]
fn values_that_are_no_heights_are_named_by_place() {
    for (value, problem) in [
        (f64::NAN, "NaN is no height, and not what stands for void"),
        (f64::INFINITY, "inf is no height, and not what stands for void"),
        (f64::NEG_INFINITY, "-inf is no height, and not what stands for void"),
    ] {
        let values = [0.0, 1.0, 2.0, 3.0, value, 5.0];
        let body = bytes(&values, SampleType::F32, ByteOrder::Little);
        let file = npy(1, &npy_header("<f4", 2, 3), &body);
        let error = read_from_slice(&file, HeightFormat::Npy, &options()).expect_err("no height");
        assert_eq!(error.to_string(), format!("column 1, row 1: {problem}"));
        let void = HeightOptions { no_data: Some(value as f32), ..options() };
        assert!(read_well(&file, HeightFormat::Npy, &void).heights[4].is_nan());
    }
    let file = npy(1, &npy_header("|u1", 1, 2), &[0, 200]);
    for scale in [f32::NAN, f32::INFINITY] {
        let error = read_from_slice(&file, HeightFormat::Npy, &HeightOptions { scale, ..options() });
        assert!(error.expect_err("no height").to_string().contains("is no height"));
    }
    let huge = HeightOptions { scale: f32::MAX, ..options() };
    let error = read_from_slice(&file, HeightFormat::Npy, &huge).expect_err("too high");
    assert!(error.to_string().starts_with("column 1, row 0: 200 times"), "{error}");
}
