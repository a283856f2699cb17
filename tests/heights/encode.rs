//! Files of heights, written by the crates that write such files, or byte by byte.

use std::io::Cursor;

use decimesh::io::heights::{ByteOrder, SampleType};

/// A PNG of grey or colour.
pub(crate) fn png(
    columns: u32,
    rows: u32,
    color: png::ColorType,
    depth: png::BitDepth,
    bytes: &[u8],
) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, columns, rows);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(bytes).expect("an image");
    writer.finish().expect("an end");
    file
}

pub(crate) fn png_grey16(columns: u32, rows: u32, samples: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_be_bytes()).collect();
    png(columns, rows, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
}

/// The bytes of `values` in a type and an order.
pub(crate) fn bytes(values: &[f64], sample: SampleType, order: ByteOrder) -> Vec<u8> {
    let number = |&value: &f64| {
        let mut bytes = match sample {
            SampleType::U8 => (value as u8).to_le_bytes().to_vec(),
            SampleType::I8 => (value as i8).to_le_bytes().to_vec(),
            SampleType::U16 => (value as u16).to_le_bytes().to_vec(),
            SampleType::I16 => (value as i16).to_le_bytes().to_vec(),
            SampleType::U32 => (value as u32).to_le_bytes().to_vec(),
            SampleType::I32 => (value as i32).to_le_bytes().to_vec(),
            SampleType::F32 => (value as f32).to_le_bytes().to_vec(),
            SampleType::F64 => value.to_le_bytes().to_vec(),
            other => panic!("a new type: {other:?}"),
        };
        if order == ByteOrder::Big {
            bytes.reverse();
        }
        bytes
    };
    values.iter().flat_map(number).collect()
}

/// A NumPy file with this header and these samples.
pub(crate) fn npy(version: u8, header: &str, samples: &[u8]) -> Vec<u8> {
    let header = header.as_bytes();
    let length = if version == 1 {
        (header.len() as u16).to_le_bytes().to_vec()
    } else {
        (header.len() as u32).to_le_bytes().to_vec()
    };
    [b"\x93NUMPY", &[version, 0][..], &length, header, samples].concat()
}

pub(crate) fn npy_header(kind: &str, rows: usize, columns: usize) -> String {
    format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}   \n")
}

/// A TIFF from its tags: those of the TIFF crate's encoder know no tiles, and do not lie.
#[derive(Clone)]
pub(crate) struct Tiff {
    pub(crate) order: ByteOrder,
    /// Tag, type, number of values, and their bytes (in the order of the file).
    pub(crate) tags: Vec<(u16, u16, u32, Vec<u8>)>,
    /// What is stored chunk by chunk.
    pub(crate) chunks: Vec<Vec<u8>>,
}

pub(crate) const SHORT: u16 = 3;
pub(crate) const LONG: u16 = 4;
pub(crate) const DOUBLE: u16 = 12;
pub(crate) const ASCII: u16 = 2;

/// How a TIFF of the tests is cut into chunks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Chunks {
    Strips { rows: usize },
    Tiles { columns: usize, rows: usize },
}

impl Tiff {
    pub(crate) fn new(
        [columns, rows]: [usize; 2],
        values: &[f64],
        sample: SampleType,
        order: ByteOrder,
        chunks: Chunks,
    ) -> Self {
        let mut tiff = Self { order, tags: Vec::new(), chunks: Vec::new() };
        let format = match sample {
            SampleType::F32 | SampleType::F64 => 3,
            SampleType::I8 | SampleType::I16 | SampleType::I32 => 2,
            _ => 1,
        };
        tiff.set(256, LONG, &[columns as f64]);
        tiff.set(257, LONG, &[rows as f64]);
        tiff.set(258, SHORT, &[8.0 * sample.bytes() as f64]);
        tiff.set(259, SHORT, &[1.0]);
        tiff.set(262, SHORT, &[1.0]);
        tiff.set(277, SHORT, &[1.0]);
        tiff.set(339, SHORT, &[f64::from(format)]);
        let (size, is_tiled) = match chunks {
            Chunks::Strips { rows } => ([columns, rows], false),
            Chunks::Tiles { columns, rows } => ([columns, rows], true),
        };
        for top in (0..rows).step_by(size[1]) {
            for left in (0..columns).step_by(size[0]) {
                let bottom = if is_tiled { top + size[1] } else { rows.min(top + size[1]) };
                let places = (top..bottom).flat_map(|y| (left..left + size[0]).map(move |x| (x, y)));
                // What fills up tiles at the rim must not be seen.
                let at = |(x, y)| if x < columns && y < rows { values[y * columns + x] } else { 77.0 };
                tiff.chunks.push(bytes(&places.map(at).collect::<Vec<_>>(), sample, order));
            }
        }
        if is_tiled {
            tiff.set(322, LONG, &[size[0] as f64]);
            tiff.set(323, LONG, &[size[1] as f64]);
        } else {
            tiff.set(278, LONG, &[size[1] as f64]);
        }
        tiff
    }

    /// The same with every chunk compressed by LZW.
    pub(crate) fn with_lzw(mut self) -> Self {
        self.set(259, SHORT, &[5.0]);
        for chunk in &mut self.chunks {
            let mut encoder = weezl::encode::Encoder::with_tiff_size_switch(weezl::BitOrder::Msb, 8);
            *chunk = encoder.encode(chunk).expect("any bytes can be encoded");
        }
        self
    }

    /// Sets a tag to values of a type.
    pub(crate) fn set(&mut self, tag: u16, kind: u16, values: &[f64]) {
        let sample = match kind {
            SHORT => SampleType::U16,
            LONG => SampleType::U32,
            DOUBLE => SampleType::F64,
            _ => SampleType::U8,
        };
        let bytes = bytes(values, sample, self.order);
        self.tags.retain(|&(there, ..)| there != tag);
        self.tags.push((tag, kind, values.len() as u32, bytes));
    }

    pub(crate) fn set_text(&mut self, tag: u16, text: &str) {
        let values: Vec<_> = text.bytes().chain([0]).map(f64::from).collect();
        self.set(tag, ASCII, &values);
    }

    /// The file: header, chunks, values, directory.
    pub(crate) fn build(&self) -> Vec<u8> {
        let mut tiff = self.clone();
        let is_tiled = tiff.tags.iter().any(|&(tag, ..)| tag == 322);
        let (offsets, counts) = if is_tiled { (324, 325) } else { (273, 279) };
        let mut starts = Vec::new();
        let mut body = vec![0; 8];
        for chunk in &tiff.chunks {
            starts.push(body.len() as f64);
            body.extend(chunk);
        }
        let has = |tag| self.tags.iter().any(|&(there, ..)| there == tag);
        let lengths: Vec<_> = tiff.chunks.iter().map(|chunk| chunk.len() as f64).collect();
        if !has(offsets) {
            tiff.set(offsets, LONG, &starts);
        }
        if !has(counts) {
            tiff.set(counts, LONG, &lengths);
        }
        tiff.tags.sort_by_key(|&(tag, ..)| tag);
        let order = tiff.order;
        let number = |value: f64, sample| bytes(&[value], sample, order);
        let mut directory = number(tiff.tags.len() as f64, SampleType::U16);
        for (tag, kind, count, value) in &tiff.tags {
            directory.extend(number(f64::from(*tag), SampleType::U16));
            directory.extend(number(f64::from(*kind), SampleType::U16));
            directory.extend(number(f64::from(*count), SampleType::U32));
            if value.len() <= 4 {
                let mut field = value.clone();
                field.resize(4, 0);
                directory.extend(field);
            } else {
                directory.extend(number(body.len() as f64, SampleType::U32));
                body.extend(value);
            }
        }
        directory.extend([0; 4]);
        let mark: &[u8] = if order == ByteOrder::Big { b"MM" } else { b"II" };
        let header =
            [mark, &number(42.0, SampleType::U16), &number(body.len() as f64, SampleType::U32)].concat();
        body[..8].copy_from_slice(&header);
        body.extend(directory);
        body
    }
}

/// A TIFF by the TIFF crate, compressed and with a predictor.
pub(crate) fn tiff_compressed(
    columns: u32,
    rows: u32,
    samples: &[i16],
    compression: tiff::encoder::Compression,
) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut file)
        .expect("a header")
        .with_compression(compression)
        .with_predictor(tiff::tags::Predictor::Horizontal);
    encoder.write_image::<tiff::encoder::colortype::GrayI16>(columns, rows, samples).expect("an image");
    file.into_inner()
}
