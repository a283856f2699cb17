//! Numbers as files have them, and what they become.

use super::super::ReadError;
use super::super::source::Source;
use super::Grid;

/// The type of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SampleType {
    /// 8 bits, from 0 on.
    U8,
    /// 8 bits, signed.
    I8,
    /// 16 bits, from 0 on.
    U16,
    /// 16 bits, signed.
    I16,
    /// 32 bits, from 0 on.
    U32,
    /// 32 bits, signed.
    I32,
    /// A float of 32 bits.
    F32,
    /// A float of 64 bits.
    F64,
}

impl SampleType {
    /// How many bytes a sample takes.
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The type that an extension in lower case names.
    pub(super) fn from_extension(extension: &str) -> Option<Self> {
        match extension {
            "f32" => Some(Self::F32),
            "i16" => Some(Self::I16),
            "u16" => Some(Self::U16),
            _ => None,
        }
    }
}

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ByteOrder {
    /// The lowest first.
    #[default]
    Little,
    /// The highest first.
    Big,
}

impl ByteOrder {
    /// That of this machine.
    pub(super) const NATIVE: Self = if cfg!(target_endian = "big") { Self::Big } else { Self::Little };
}

/// Appends the samples in `bytes`, a whole number of them, to `list`.
pub(super) fn append(list: &mut Vec<f32>, bytes: &[u8], sample: SampleType, order: ByteOrder) {
    match sample {
        SampleType::U8 => numbers(list, bytes, order, |b| u8::from_le_bytes(b).into()),
        SampleType::I8 => numbers(list, bytes, order, |b| i8::from_le_bytes(b).into()),
        SampleType::U16 => numbers(list, bytes, order, |b| u16::from_le_bytes(b).into()),
        SampleType::I16 => numbers(list, bytes, order, |b| i16::from_le_bytes(b).into()),
        SampleType::U32 => numbers(list, bytes, order, |b| u32::from_le_bytes(b) as f32),
        SampleType::I32 => numbers(list, bytes, order, |b| i32::from_le_bytes(b) as f32),
        SampleType::F32 => numbers(list, bytes, order, f32::from_le_bytes),
        SampleType::F64 => numbers(list, bytes, order, |b| f64::from_le_bytes(b) as f32),
    }
}

/// `convert` is given the bytes of a number from the lowest to the highest.
fn numbers<const N: usize>(
    list: &mut Vec<f32>,
    bytes: &[u8],
    order: ByteOrder,
    convert: impl Fn([u8; N]) -> f32,
) {
    let (numbers, _) = bytes.as_chunks::<N>();
    match order {
        ByteOrder::Little => list.extend(numbers.iter().map(|&number| convert(number))),
        ByteOrder::Big => list.extend(numbers.iter().map(|&(mut number)| {
            number.reverse();
            convert(number)
        })),
    }
}

/// The rest of a file that must be `columns` times `rows` samples, no fewer and no more.
pub(super) fn read_rest(
    source: &mut Source,
    [columns, rows]: [usize; 2],
    sample: SampleType,
    order: ByteOrder,
) -> Result<Grid, ReadError> {
    /// Bytes at a time; any sample's size divides it.
    const STEP: usize = 1 << 16;
    let size = sample.bytes() as u64;
    let Some(mut left) =
        columns.checked_mul(rows).and_then(|count| u64::try_from(count).ok()?.checked_mul(size))
    else {
        return Err(
            source.error_here(format!("{columns} columns times {rows} rows are more than can be counted"))
        );
    };
    source.expect(left / size, size, "samples")?;
    let mut samples = source.list(left / size, size)?;
    while left > 0 {
        let step = left.min(STEP as u64);
        append(&mut samples, source.take(step as usize)?, sample, order);
        left -= step;
    }
    if !source.peek(1)?.is_empty() {
        return Err(source.error_here(format!(
            "bytes follow the last of {columns} columns times {rows} rows of {size} bytes each"
        )));
    }
    Ok(Grid::new(columns, rows, samples))
}
