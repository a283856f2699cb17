//! What can be said about terrain on the command line.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::{Args, ValueEnum};
use decimesh::io::heights::{ByteOrder, HeightOptions, Pixels, RawLayout, SampleType};
use decimesh::rate_distortion::{Detail, HeightField};

use crate::failure::Failure;

#[derive(Debug, Args)]
pub(crate) struct TerrainArguments {
    /// The heights: PNG, TIFF, NumPy or raw samples, by their extension.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Where the mesh goes; its extension says in what format.
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) detail: DetailArguments,
    #[command(flatten)]
    pub(crate) heights: HeightArguments,
    /// Leave the hierarchy: triangles of any shape, which for as many vertices are closer to the heights. For
    /// --vertices and --ratio; takes longer.
    #[arg(long)]
    pub(crate) tin: bool,
    /// With --tin: fit the heights of the vertices by least squares. They are then between those of samples.
    #[arg(long, requires = "tin")]
    pub(crate) least_squares: bool,
    /// Draw what signal-to-noise ratio comes of how many vertices, by this and by simpler methods, as a PNG.
    #[arg(long, value_name = "CURVE.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    #[command(flatten)]
    pub(crate) common: CommonArguments,
}

#[derive(Debug, Args)]
pub(crate) struct DecomposeArguments {
    /// The heights: PNG, TIFF, NumPy or raw samples, by their extension.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Where the hierarchy goes; `extract` takes meshes from it.
    #[arg(value_name = "OUT.drd")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) heights: HeightArguments,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    /// Write what happened, as JSON, to this file.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print nothing but warnings and errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExtractArguments {
    /// The hierarchy.
    #[arg(value_name = "IN.drd")]
    pub(crate) input: PathBuf,
    /// Where the mesh goes; its extension says in what format.
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) detail: DetailArguments,
    #[command(flatten)]
    pub(crate) common: CommonArguments,
}

#[derive(Debug, Args)]
pub(crate) struct TilesArguments {
    /// The heights. NumPy files and raw samples may be larger than memory.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Where the tiles go: tiles.json, and a directory a level.
    #[arg(value_name = "OUTDIR")]
    pub(crate) directory: PathBuf,
    #[command(flatten)]
    pub(crate) detail: CountArguments,
    /// The side of a tile of the finest level, in samples: a power of two.
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub(crate) tile: usize,
    /// How many levels to make; without it, as many as lead to one tile.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) levels: Option<usize>,
    /// The format of the tiles, by its extension.
    #[arg(long, value_name = "EXTENSION", default_value = "glb", value_parser = super::tiles::format)]
    pub(crate) format: String,
    #[command(flatten)]
    pub(crate) heights: HeightArguments,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    #[command(flatten)]
    pub(crate) common: CommonArguments,
}

/// How much the finest level has: exactly one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct CountArguments {
    /// About this many vertices, and no more but for the corners of tiles, for the edges of the field, and for
    /// voids.
    #[arg(long, value_name = "N")]
    vertices: Option<usize>,
    /// This fraction of the samples that are not void, above 0 and at most 1.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    ratio: Option<f64>,
}

impl CountArguments {
    /// How many vertices that is of so many samples.
    pub(crate) fn vertices(&self, samples: usize) -> Result<usize, Failure> {
        let ratio = self.ratio.unwrap_or(1.0);
        if !(ratio > 0.0 && ratio <= 1.0) {
            return Err(Failure::Options(format!(
                "ratio {ratio} is not allowed: it must be above 0 and at most 1"
            )));
        }
        Ok(self.vertices.unwrap_or((ratio * samples as f64).round() as usize))
    }
}

#[derive(Debug, Args)]
pub(crate) struct CommonArguments {
    /// Write the text variant of formats that have one.
    #[arg(long)]
    pub(crate) ascii: bool,
    /// Write what happened, as JSON, to this file.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print nothing but warnings and errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// How much is wanted: exactly one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct DetailArguments {
    /// At most this many vertices.
    #[arg(long, value_name = "N")]
    vertices: Option<usize>,
    /// This fraction of the samples that are not void, above 0 and at most 1.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    ratio: Option<f64>,
    /// As few vertices as the order has with this root mean square of the vertical error, in the unit of the
    /// heights.
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    rms: Option<f64>,
    /// As few vertices as there can be with no sample farther from the surface, vertically.
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    max_error: Option<f64>,
}

impl DetailArguments {
    pub(crate) fn detail(&self) -> Detail {
        match *self {
            Self { vertices: Some(count), .. } => Detail::Vertices(count),
            Self { ratio: Some(ratio), .. } => Detail::Ratio(ratio),
            Self { rms: Some(rms), .. } => Detail::Rms(rms),
            Self { max_error: Some(bound), .. } => Detail::MaxError(bound),
            // The parser lets nobody come without one.
            Self { max_error: None, .. } => Detail::Ratio(1.0),
        }
    }
}

/// What the file of heights does not say itself.
#[derive(Debug, Args)]
pub(crate) struct HeightArguments {
    /// How far columns, and after a comma rows, are apart, in the unit of the heights. Without it 1, or what a
    /// GeoTIFF on a projected map says.
    #[arg(long, value_name = "X[,Y]", allow_hyphen_values = true)]
    spacing: Option<Spacing>,
    /// The sample that means "nothing is known here", as it stands in the file; nan: all that are no number.
    #[arg(long, value_name = "V", allow_hyphen_values = true)]
    no_data: Option<f32>,
    /// What samples are multiplied by to make heights.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_hyphen_values = true)]
    scale: f32,
    /// What is added to them then.
    #[arg(long, value_name = "H", default_value_t = 0.0, allow_hyphen_values = true)]
    offset: f32,
    /// The pixels of a PNG are Mapbox's Terrain-RGB: metres by colour.
    #[arg(long)]
    terrain_rgb: bool,
    /// Raw samples: how many columns and rows there are.
    #[arg(long, value_name = "COLUMNSxROWS")]
    size: Option<Size>,
    /// Raw samples: their type, where the extension does not name it (.f32, .i16, .u16).
    #[arg(long, value_name = "TYPE", requires = "size")]
    sample: Option<SampleName>,
    /// Raw samples: the highest byte of each comes first.
    #[arg(long, requires = "size")]
    big_endian: bool,
}

impl HeightArguments {
    /// The field in the file at `path`.
    pub(crate) fn read(&self, path: &Path) -> Result<HeightField, Failure> {
        Ok(HeightField::read(path, &self.options())?)
    }

    pub(crate) fn options(&self) -> HeightOptions {
        HeightOptions {
            format: None,
            pixels: if self.terrain_rgb { Pixels::TerrainRgb } else { Pixels::Grey },
            no_data: self.no_data,
            spacing: self.spacing.map(|Spacing(spacing)| spacing),
            scale: self.scale,
            offset: self.offset,
            raw: self.size.map(|Size([columns, rows])| RawLayout {
                columns,
                rows,
                sample: self.sample.map(SampleName::sample),
                byte_order: if self.big_endian { ByteOrder::Big } else { ByteOrder::Little },
            }),
        }
    }
}

/// One number for both, or two.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spacing([f32; 2]);

impl FromStr for Spacing {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (x, y) = text.split_once(',').unwrap_or((text, text));
        Ok(Self([x.trim().parse()?, y.trim().parse()?]))
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Size([usize; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.split_once(['x', 'X']).and_then(|(columns, rows)| {
            Some(Self([columns.trim().parse().ok()?, rows.trim().parse().ok()?]))
        });
        parts.ok_or_else(|| "two whole numbers with an x between them are expected, as 1201x601".to_owned())
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SampleName {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    F32,
    F64,
}

impl SampleName {
    fn sample(self) -> SampleType {
        match self {
            Self::U8 => SampleType::U8,
            Self::I8 => SampleType::I8,
            Self::U16 => SampleType::U16,
            Self::I16 => SampleType::I16,
            Self::U32 => SampleType::U32,
            Self::I32 => SampleType::I32,
            Self::F32 => SampleType::F32,
            Self::F64 => SampleType::F64,
        }
    }
}
