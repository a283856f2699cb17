//! Files that end too early, are damaged, or lie.

use decimesh::io::heights::{
    ByteOrder, HeightFormat, HeightOptions, Pixels, RawLayout, SampleType, read_from_slice,
};
use proptest::collection::vec;
use proptest::prelude::*;

use crate::encode::{
    Chunks, DOUBLE, LONG, SHORT, Tiff, bytes, npy, npy_header, png, png_grey16, tiff_compressed,
};

fn options() -> HeightOptions {
    let raw = RawLayout { columns: 5, rows: 4, sample: Some(SampleType::I16), byte_order: ByteOrder::Big };
    HeightOptions { raw: Some(raw), ..HeightOptions::default() }
}

/// A whole file of each kind, and how it is to be read.
fn specimens() -> Vec<(HeightFormat, HeightOptions, Vec<u8>)> {
    use tiff::encoder::{Compression, DeflateLevel};
    let values: Vec<_> = (0..20).map(|value| f64::from(value * value % 23)).collect();
    let samples: Vec<_> = values.iter().map(|&value| value as u16).collect();
    let signed: Vec<_> = values.iter().map(|&value| value as i16).collect();
    let body = bytes(&values, SampleType::I16, ByteOrder::Big);
    let terrain = HeightOptions { pixels: Pixels::TerrainRgb, ..options() };
    let rgb = png(5, 4, png::ColorType::Rgb, png::BitDepth::Eight, &[3; 60]);
    let mut all = vec![
        (HeightFormat::Png, options(), png_grey16(5, 4, &samples)),
        (HeightFormat::Png, terrain, rgb),
        (HeightFormat::Npy, options(), npy(1, &npy_header(">i2", 4, 5), &body)),
        (HeightFormat::Raw, options(), body),
    ];
    for (order, chunks) in [
        (ByteOrder::Little, Chunks::Strips { rows: 3 }),
        (ByteOrder::Big, Chunks::Tiles { columns: 4, rows: 2 }),
    ] {
        let mut tiff = Tiff::new([5, 4], &values, SampleType::F32, order, chunks);
        tiff.set_text(42113, "-9999");
        tiff.set(33550, DOUBLE, &[30.0, 30.0, 0.0]);
        tiff.set(34735, SHORT, &[1.0, 1.0, 0.0, 1.0, 1024.0, 0.0, 1.0, 1.0]);
        all.push((HeightFormat::Tiff, options(), tiff.build()));
    }
    for compression in [Compression::Packbits, Compression::Lzw, Compression::Deflate(DeflateLevel::Fast)] {
        all.push((HeightFormat::Tiff, options(), tiff_compressed(5, 4, &signed, compression)));
    }
    all
}

#[test]
fn every_truncation_is_an_error() {
    for (format, options, bytes) in specimens() {
        read_from_slice(&bytes, format, &options).unwrap_or_else(|error| panic!("{format:?}: {error}"));
        for length in 0..bytes.len() {
            match read_from_slice(&bytes[..length], format, &options) {
                Err(error) => assert!(!error.to_string().is_empty()),
                // What comes last in a TIFF may be where the next image would be said to be.
                Ok(_) => {
                    assert!(format == HeightFormat::Tiff && length + 4 >= bytes.len(), "{format:?} {length}")
                }
            }
        }
    }
}

#[test]
fn bytes_that_follow_raw_samples_are_an_error() {
    for (format, options, mut bytes) in specimens() {
        if matches!(format, HeightFormat::Raw | HeightFormat::Npy) {
            bytes.push(0);
            let error = read_from_slice(&bytes, format, &options).expect_err("too long");
            assert!(error.to_string().contains("bytes follow the last of 5 columns times 4 rows"), "{error}");
        }
    }
}

#[test]
fn no_value_of_a_tag_makes_a_tiff_panic() {
    let values = [0.0; 20];
    for chunks in [Chunks::Strips { rows: 1 }, Chunks::Tiles { columns: 3, rows: 2 }] {
        let good = Tiff::new([5, 4], &values, SampleType::I16, ByteOrder::Little, chunks);
        for tag in
            [256, 257, 258, 259, 262, 273, 277, 278, 279, 284, 317, 322, 323, 324, 325, 338, 339, 42113]
        {
            for kind in 0..20 {
                for value in [0.0, 1.0, 2.0, 3.0, 8.0, 32.0, 65535.0, 2147483648.0, 4294967295.0] {
                    for count in [0, 1, 2, 4, 5, 65535, u32::MAX] {
                        let mut file = good.clone();
                        let bytes = bytes(&[value], SampleType::U32, file.order);
                        file.tags.retain(|&(there, ..)| there != tag);
                        file.tags.push((tag, kind, count, bytes));
                        let _ = read_from_slice(&file.build(), HeightFormat::Tiff, &options());
                    }
                }
            }
        }
    }
}

#[test]
fn a_tiff_that_is_larger_than_its_strips_is_refused() {
    let good = Tiff::new([5, 4], &[1.0; 20], SampleType::F32, ByteOrder::Little, Chunks::Strips { rows: 4 });
    let mut file = good.clone();
    file.set(257, LONG, &[60_000.0]);
    file.set(256, LONG, &[60_000.0]);
    file.set(278, LONG, &[60_000.0]);
    let error = read_from_slice(&file.build(), HeightFormat::Tiff, &options()).expect_err("a lie");
    assert_eq!(
        error.to_string(),
        "strip 0: 14400000000 bytes of samples cannot come from 80 bytes of the file"
    );
    let mut file = good.clone();
    file.set(279, LONG, &[4e9]);
    file.set(257, LONG, &[60_000.0]);
    file.set(278, LONG, &[60_000.0]);
    read_from_slice(&file.build(), HeightFormat::Tiff, &options()).expect_err("a lie");
    let mut file = good;
    file.tags.push((34735, SHORT, u32::MAX, vec![0; 4]));
    let error = read_from_slice(&file.build(), HeightFormat::Tiff, &options()).expect_err("a lie");
    assert!(error.to_string().contains("tag 34735 has 4294967295 values of 2 bytes, more than"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn no_damage_makes_a_reader_panic(
        damage in vec((any::<prop::sample::Index>(), any::<u8>(), 0u8..4), 1..6),
    ) {
        for (format, options, mut bytes) in specimens() {
            for (place, value, kind) in &damage {
                let place = place.index(bytes.len());
                match kind {
                    0 => bytes[place] = *value,
                    1 => bytes[place] ^= 1 << (value % 8),
                    2 => bytes.insert(place, *value),
                    _ => bytes[place] = 0xff,
                }
            }
            let _ = read_from_slice(&bytes, format, &options);
        }
    }

    #[test]
    fn no_bytes_make_a_reader_panic(bytes in vec(any::<u8>(), 0..400)) {
        for format in [HeightFormat::Png, HeightFormat::Tiff, HeightFormat::Npy, HeightFormat::Raw] {
            let _ = read_from_slice(&bytes, format, &options());
        }
    }
}
