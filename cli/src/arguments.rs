//! What can be said on the command line, and what it means to the engine.

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::RangedU64ValueParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use decimesh::mesh::Weld;
use decimesh::{AttributeWeights, Options, Placement, Selection, Target, Topology};

use crate::failure::Failure;
use crate::terrain::{DecomposeArguments, ExtractArguments, TerrainArguments, TilesArguments};

const EXIT_CODES: &str = "\
Exit codes:
  0  done (also when a target was missed: the command then says why)
  1  something unexpected
  2  the command line makes no sense
  3  an input cannot be read
  4  an output cannot be written
  5  an option's value, or a mesh, does not suit what was asked for
  6  --verify found the result to be wrong; nothing was written

Files are written whole or not at all. PLY, OBJ, STL, OFF and glTF are known by their extensions,
and so are PNG, TIFF, NumPy and raw samples where heights are read.";

/// Simplify, compare and look at triangle meshes.
#[derive(Debug, Parser)]
#[command(name = "decimesh", version, after_help = EXIT_CODES, arg_required_else_help = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Make a mesh of fewer triangles.
    #[command(after_help = EXIT_CODES)]
    Simplify(SimplifyArguments),
    /// Make a chain of levels of detail, a file each.
    #[command(after_help = EXIT_CODES)]
    Levels(LevelsArguments),
    /// Make a mesh of heights over a grid.
    #[command(after_help = EXIT_CODES)]
    Terrain(TerrainArguments),
    /// Make a pyramid of tiles of heights over a grid, which may be larger than memory.
    #[command(after_help = EXIT_CODES)]
    TerrainTiles(TilesArguments),
    /// Store heights over a grid such that any mesh can be taken from them.
    #[command(after_help = EXIT_CODES)]
    Decompose(DecomposeArguments),
    /// Take a mesh out of what `decompose` stored.
    #[command(after_help = EXIT_CODES)]
    Extract(ExtractArguments),
    /// Measure the distance between two surfaces.
    #[command(after_help = EXIT_CODES)]
    Compare(CompareArguments),
    /// Take a level out of a progressive file.
    #[command(after_help = EXIT_CODES)]
    Play(PlayArguments),
    /// Make a surface of subdivided quads from a mesh, and decimate it if asked to.
    #[command(after_help = EXIT_CODES)]
    Remesh(RemeshArguments),
    /// Say what is in a file.
    #[command(after_help = EXIT_CODES)]
    Info(InfoArguments),
    /// Make a statue of a million triangles, simplify it, and draw what became of it.
    #[command(after_help = EXIT_CODES)]
    Demo(DemoArguments),
}

#[derive(Debug, Args)]
pub(crate) struct SimplifyArguments {
    /// The mesh to simplify.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Where the result goes; its extension says in what format.
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) target: TargetArguments,
    /// With --max-error: no point of either surface is farther from the other, which is proven, in place of
    /// estimated. Fewer triangles too, but takes many times as long.
    // Not "requires": clap does not ask for what conflicts with what is there.
    #[arg(long, conflicts_with_all = ["triangles", "vertices", "ratio"])]
    pub(crate) certify: bool,
    #[command(flatten)]
    pub(crate) engine: EngineArguments,
    /// Take no more memory than about so many bytes (K, M and G are understood), however large the mesh is:
    /// it is cut into blocks on disk, in a directory OUT.work that is gone at the end. The same command after
    /// one that was ended goes on where that was. For PLY files, --triangles or --ratio, and the engine hqms.
    #[arg(long, value_name = "SIZE")]
    pub(crate) memory: Option<MemorySize>,
    /// Check the result against every invariant before it is written.
    #[arg(long)]
    pub(crate) verify: bool,
    /// Write what happened, as JSON, to this file.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print nothing but warnings and errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What to arrive at: exactly one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct TargetArguments {
    /// At most this many triangles.
    #[arg(long, value_name = "N")]
    triangles: Option<usize>,
    /// At most this many vertices.
    #[arg(long, value_name = "N")]
    vertices: Option<usize>,
    /// This fraction of the triangles, 0 to 1.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    ratio: Option<f64>,
    /// As few triangles as an estimated distance of this much allows: in units of the positions, or
    /// with a % sign as a share of the bounding box's diagonal. --certify proves it.
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    max_error: Option<ErrorBound>,
}

impl TargetArguments {
    /// The target for a mesh whose bounding box has this diagonal.
    pub(crate) fn target(&self, diagonal: f64) -> Target {
        match *self {
            Self { triangles: Some(count), .. } => Target::Triangles(count),
            Self { vertices: Some(count), .. } => Target::Vertices(count),
            Self { ratio: Some(ratio), .. } => Target::Ratio(ratio),
            Self { max_error: Some(ErrorBound::Absolute(bound)), .. } => Target::MaxError(bound),
            Self { max_error: Some(ErrorBound::Share(share)), .. } => {
                Target::MaxError((share * diagonal) as f32)
            }
            // The parser lets nobody come without a target.
            Self { max_error: None, .. } => Target::Ratio(1.0),
        }
    }

    /// The maximum error for such a mesh, if that is what was asked for.
    pub(crate) fn max_error(&self, diagonal: f64) -> Option<f64> {
        self.max_error.map(|bound| match bound {
            ErrorBound::Absolute(bound) => f64::from(bound),
            ErrorBound::Share(share) => share * diagonal,
        })
    }
}

/// A number of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MemorySize(pub(crate) usize);

impl FromStr for MemorySize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let digits = text.trim_end_matches(|letter: char| letter.is_ascii_alphabetic());
        let shift = match text[digits.len()..].to_ascii_uppercase().as_str() {
            "" => 0,
            "K" => 10,
            "M" => 20,
            "G" => 30,
            _ => return Err("a size is a number, with K, M or G after it or nothing".to_owned()),
        };
        let count: usize = digits.parse().map_err(|error| format!("{error}"))?;
        count.checked_mul(1 << shift).map(Self).ok_or_else(|| "there is not so much memory".to_owned())
    }
}

/// A distance, or a share of the bounding box's diagonal.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ErrorBound {
    Absolute(f32),
    Share(f64),
}

impl FromStr for ErrorBound {
    type Err = std::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.strip_suffix('%') {
            Some(percent) => Ok(Self::Share(percent.trim_end().parse::<f64>()? / 100.0)),
            None => text.parse().map(Self::Absolute),
        }
    }
}

/// How to simplify, whatever the target.
#[derive(Debug, Args)]
pub(crate) struct EngineArguments {
    /// What simplifies.
    #[arg(long, value_enum, default_value_t = EngineName::Hqms)]
    pub(crate) engine: EngineName,
    /// Which collapses a pass takes: all below a sampled threshold of cost, or the cheapest of a
    /// replacement-selection heap.
    #[arg(long, value_enum, default_value_t = SelectionName::Threshold)]
    selection: SelectionName,
    /// The size of the replacement-selection heap.
    #[arg(
        long,
        value_name = "K",
        default_value_t = 15,
        value_parser = RangedU64ValueParser::<usize>::new().range(1..=1 << 20)
    )]
    records: usize,
    /// Keep the vertices of the border where they are, bit for bit.
    #[arg(long)]
    lock_boundary: bool,
    /// Let the two sides of a seam (vertices at one place with different attributes) part, like
    /// borders. Otherwise they stay closed: hqms keeps them as they are, indices goes along them.
    #[arg(long)]
    open_seams: bool,
    /// hqms: move vertices and turn edges in the end, so that the surface is nearer to the input's: 6 to 10 %
    /// less RMS, in 1.2 to 4 times the time.
    #[arg(long)]
    refine: bool,
    /// indices: go across seams too where the attributes, by their weights, allow it. The surface stays
    /// closed.
    #[arg(long)]
    cross_seams: bool,
    /// indices: what a difference of 1 in a normal's coordinate weighs beside a distance as long as the mesh.
    #[arg(long, value_name = "W", default_value_t = 0.0, allow_hyphen_values = true)]
    normal_weight: f32,
    /// indices: the same for texture coordinates.
    #[arg(long, value_name = "W", default_value_t = 0.0, allow_hyphen_values = true)]
    uv_weight: f32,
    /// indices: the same for the channels of colours, 0 to 1.
    #[arg(long, value_name = "W", default_value_t = 0.0, allow_hyphen_values = true)]
    color_weight: f32,
    /// multiple-choice: of how many vertices drawn at random the cheapest goes.
    #[arg(long, value_name = "D", default_value = "6")]
    pub(crate) candidates: NonZeroU32,
    /// multiple-choice: where the random numbers start.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Keep all holes, handles and components, even if the target is missed.
    #[arg(long, conflicts_with = "allow_topology")]
    keep_topology: bool,
    /// Give up holes, handles and components where the target cannot be reached otherwise (the default).
    #[arg(long)]
    allow_topology: bool,
    /// First merge vertices of the same position, or not farther apart than a tolerance in units of
    /// the positions.
    #[arg(
        long,
        value_name = "TOLERANCE",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "0",
        allow_hyphen_values = true
    )]
    weld: Option<f32>,
    /// Write the text variant of formats that have one.
    #[arg(long)]
    pub(crate) ascii: bool,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
}

/// The engines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum EngineName {
    /// Vertices go where the error is least.
    Hqms,
    /// No vertex is made or moved: the result is indices into the vertices that there are.
    Indices,
    /// The same by the visual cost and random choices of Jia, Tang and Pan: slower and coarser, to compare.
    MultipleChoice,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SelectionName {
    Threshold,
    Replacement,
}

impl EngineArguments {
    /// Fails where an option is for another engine than the one asked for.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let weighted = [self.normal_weight, self.uv_weight, self.color_weight].iter().any(|&w| w != 0.0);
        if self.engine != EngineName::Indices && (weighted || self.cross_seams) {
            let message = "weights of attributes and --cross-seams are for --engine indices";
            return Err(Failure::Options(message.into()));
        }
        if self.engine != EngineName::Hqms && self.refine {
            return Err(Failure::Options("--refine is for --engine hqms, which moves vertices".into()));
        }
        Ok(())
    }

    /// The engine's options for `target`.
    pub(crate) fn options(&self, target: Target) -> Options {
        Options {
            selection: match self.selection {
                SelectionName::Threshold => Selection::SampledThreshold,
                SelectionName::Replacement => Selection::ReplacementSelection { records: self.records },
            },
            topology: if self.keep_topology { Topology::Keep } else { Topology::RelaxIfStuck },
            lock_boundary: self.lock_boundary,
            keep_seams: !self.open_seams,
            placement: match self.engine {
                EngineName::Hqms => Placement::Optimal,
                EngineName::Indices | EngineName::MultipleChoice => Placement::Existing,
            },
            attribute_weights: AttributeWeights {
                normals: self.normal_weight,
                uvs: self.uv_weight,
                colors: self.color_weight,
            },
            cross_seams: self.cross_seams,
            refine: self.refine,
            threads: self.threads,
            ..Options::new(target)
        }
    }

    /// How to weld the input, where that is asked for.
    pub(crate) fn weld(&self) -> Option<Weld> {
        self.weld.map(|tolerance| if tolerance == 0.0 { Weld::Exact } else { Weld::Tolerance(tolerance) })
    }
}

#[derive(Debug, Args)]
pub(crate) struct LevelsArguments {
    /// The mesh to make levels of.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// The directory the levels go into, as NAME_1.ply, NAME_2.ply ...; made if it is missing.
    #[arg(value_name = "OUTDIR")]
    pub(crate) directory: PathBuf,
    /// How many levels.
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=64))]
    pub(crate) count: usize,
    /// Triangles of a level as a fraction of those of the level before it, above 0 and below 1.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) ratio: f64,
    /// Extension of the files, and so their format.
    #[arg(long, value_name = "EXTENSION", default_value = "ply")]
    pub(crate) format: String,
    #[command(flatten)]
    pub(crate) engine: EngineArguments,
    /// Collapse vertices into others, without making or moving any, and also write all levels, the input
    /// as the first, into one file NAME_levels.glb: nodes that share one vertex buffer (MSFT_lod).
    #[arg(long)]
    pub(crate) nested: bool,
    /// With --nested: put a guaranteed bound on the distance of each level from the input into that file
    /// and the report, in place of the estimated error. Takes longer than all else.
    #[arg(long, requires = "nested")]
    pub(crate) certify: bool,
    /// With --nested: also write all levels in between, as a progressive mesh that `play` takes levels from.
    #[arg(long, value_name = "FILE.dpm", requires = "nested")]
    pub(crate) progressive: Option<PathBuf>,
    /// Do not measure the levels' distance from the input.
    #[arg(long)]
    pub(crate) no_measure: bool,
    /// Write what happened, as JSON, to this file.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Print nothing but warnings and errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PlayArguments {
    /// The progressive file.
    #[arg(value_name = "FILE.dpm")]
    pub(crate) input: PathBuf,
    /// Where the level goes; its extension says in what format.
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) level: PlayedLevel,
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

/// Which level to take: exactly one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
pub(crate) struct PlayedLevel {
    /// The finest level with at most this many triangles, or the coarsest.
    #[arg(long, value_name = "N")]
    pub(crate) triangles: Option<usize>,
    /// The finest level with at most this fraction of the finest's triangles, 0 to 1, or the coarsest.
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    pub(crate) ratio: Option<f64>,
    /// The level of this number, as `levels` counts them; 0 is the finest.
    #[arg(long, value_name = "K")]
    pub(crate) level: Option<usize>,
}

#[derive(Debug, Args)]
pub(crate) struct RemeshArguments {
    /// The mesh to remesh: an oriented manifold, once vertices of the same position are merged.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Where the result goes; its extension says in what format.
    #[arg(value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// How often the quads of the base are halved: 4^D squares each.
    #[arg(long, value_name = "D")]
    pub(crate) depth: u32,
    /// How many quads the base shall have, about.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 400,
        value_parser = RangedU64ValueParser::<usize>::new().range(1..)
    )]
    pub(crate) base_quads: usize,
    /// Write a decimated mesh of this fraction of the remesh's vertices, above 0 and at most 1.
    #[arg(long, value_name = "R", allow_hyphen_values = true, conflicts_with = "vertices")]
    pub(crate) ratio: Option<f64>,
    /// Write a decimated mesh of this many vertices, or as few as the base has.
    #[arg(long, value_name = "N")]
    pub(crate) vertices: Option<usize>,
    /// Write the text variant of formats that have one.
    #[arg(long)]
    pub(crate) ascii: bool,
    /// Write what happened, as JSON, to this file.
    #[arg(long, value_name = "FILE.json")]
    pub(crate) report: Option<PathBuf>,
    /// Draw the input, the remesh and what is written side by side, +y up and seen from +z, as a PNG.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,
    /// Threads to use; 0: all that the machine has. The result does not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    /// Print nothing but warnings and errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArguments {
    /// The surface to compare with: its bounding box is the measure of the relative numbers.
    #[arg(value_name = "A")]
    pub(crate) reference: PathBuf,
    /// The surface to compare.
    #[arg(value_name = "B")]
    pub(crate) other: PathBuf,
    /// Samples a side.
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..))]
    pub(crate) samples: Option<usize>,
    /// Seed of the samples: the same seed gives the same numbers.
    #[arg(long, value_name = "SEED")]
    pub(crate) seed: Option<u64>,
    /// Say too what the maximum over all points, not only over samples, is guaranteed to lie between.
    #[arg(long)]
    pub(crate) bound: bool,
    /// Threads to use; 0: all that the machine has. The numbers do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArguments {
    /// The mesh to look at.
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DemoArguments {
    /// The directory for the picture and the levels; made if it is missing.
    #[arg(value_name = "OUTDIR", default_value = "decimesh-demo")]
    pub(crate) directory: PathBuf,
    /// Triangles of the statue, about.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1_000_000,
        value_parser = RangedU64ValueParser::<usize>::new().range(1_000..=100_000_000)
    )]
    pub(crate) triangles: usize,
    /// Width of the picture in pixels.
    #[arg(
        long,
        value_name = "PIXELS",
        default_value_t = 1800,
        value_parser = RangedU64ValueParser::<usize>::new().range(100..=10_000)
    )]
    pub(crate) width: usize,
    /// Print nothing but warnings and errors.
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    fn parse(line: &str) -> Result<SimplifyArguments, clap::Error> {
        let words = ["decimesh", "simplify", "in.ply", "out.ply"].into_iter().chain(line.split_whitespace());
        match Arguments::try_parse_from(words)?.command {
            Command::Simplify(arguments) => Ok(arguments),
            other => panic!("parsed as {other:?}"),
        }
    }

    fn target(line: &str) -> Target {
        parse(line).unwrap().target.target(200.0)
    }

    #[test]
    fn command_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn each_target_reaches_the_engine() {
        assert_eq!(target("--triangles 12"), Target::Triangles(12));
        assert_eq!(target("--vertices 13"), Target::Vertices(13));
        assert_eq!(target("--ratio 0.25"), Target::Ratio(0.25));
        assert_eq!(target("--max-error 0.5"), Target::MaxError(0.5));
        assert_eq!(target("--max-error 0.5%"), Target::MaxError(1.0));
        assert_eq!(target("--max-error -1"), Target::MaxError(-1.0));
        assert_eq!(target("--max-error=-1%"), Target::MaxError(-2.0));
    }

    #[test]
    fn exactly_one_target() {
        for line in ["", "--triangles 1 --vertices 1", "--ratio 0.5 --max-error 1%", "--max-error 1%%"] {
            assert_eq!(parse(line).unwrap_err().exit_code(), 2, "{line}");
        }
    }

    #[test]
    fn sizes_of_memory() {
        let memory = |line: &str| parse(&format!("--ratio 0.5 {line}")).map(|arguments| arguments.memory);
        assert!(matches!(memory(""), Ok(None)));
        for (text, bytes) in [("512M", 512 << 20), ("1g", 1 << 30), ("64k", 65536), ("1234", 1234)] {
            assert_eq!(memory(&format!("--memory {text}")).unwrap(), Some(MemorySize(bytes)));
        }
        for text in ["", "M", "12T", "1.5G", "-1", "12MB", "99999999999G"] {
            assert!(memory(&format!("--memory={text}")).is_err(), "{text}");
        }
    }

    #[test]
    fn engine_options() {
        let options =
            |line: &str| parse(&format!("--ratio 0.5 {line}")).unwrap().engine.options(Target::Ratio(0.5));
        assert_eq!(options(""), Options::new(Target::Ratio(0.5)));
        assert_eq!(options("--allow-topology"), Options::new(Target::Ratio(0.5)));
        assert_eq!(options("--keep-topology").topology, Topology::Keep);
        assert_eq!(
            options("--selection replacement --records 7").selection,
            Selection::ReplacementSelection { records: 7 }
        );
        assert!(options("--lock-boundary").lock_boundary);
        assert!(options("--refine").refine);
        assert_eq!(options("--engine indices").placement, Placement::Existing);
        let weighted =
            options("--engine indices --normal-weight 1 --uv-weight 2 --color-weight 3 --cross-seams");
        assert_eq!(weighted.attribute_weights, AttributeWeights { normals: 1.0, uvs: 2.0, colors: 3.0 });
        assert!(weighted.cross_seams);
        assert_eq!(options("--threads 3").threads, 3);
        assert!(parse("--ratio 0.5 --keep-topology --allow-topology").is_err());
    }

    #[test]
    fn options_of_another_engine_are_refused() {
        let check = |line: &str| parse(&format!("--ratio 0.5 {line}")).unwrap().engine.check();
        for line in ["", "--engine indices --uv-weight 1", "--engine indices --cross-seams"] {
            assert!(check(line).is_ok(), "{line}");
        }
        for line in [
            "--uv-weight 1",
            "--cross-seams",
            "--engine multiple-choice --normal-weight 0.5",
            "--engine indices --refine",
        ] {
            assert!(matches!(check(line), Err(Failure::Options(_))), "{line}");
        }
    }

    #[test]
    fn weld_takes_a_tolerance_only_after_an_equals_sign() {
        let weld =
            |line: &str| parse(&format!("--ratio 0.5 {line}")).map(|arguments| arguments.engine.weld());
        assert!(matches!(weld(""), Ok(None)));
        assert!(matches!(weld("--weld"), Ok(Some(Weld::Exact))));
        assert!(matches!(weld("--weld=0.25"), Ok(Some(Weld::Tolerance(0.25)))));
        assert!(weld("--weld 0.25").is_err());
    }
}
