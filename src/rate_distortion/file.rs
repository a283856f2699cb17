//! The hierarchy file, as `docs/hierarchy-format.md` describes it.
//!
//! What takes long to find is stored: the slopes, and the proof of how good they are. What each vertex adds to the
//! error follows from the heights, in one pass, and is found anew, so that no file can lie about the error of what
//! is taken from it.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use super::decomposition::Decomposition;
use super::flow::{Certificate, Class, Flow, NEVER};
use super::height_field::HeightField;
use super::lattice::Lattice;
use super::layout::Layout;
use crate::io::source::Source;
use crate::io::{FileError, ReadError, WriteError, replace};
use crate::monitor::Monitor;
use crate::workers::Workers;

const MAGIC: &[u8; 8] = b"\x89DRD\r\n\x1a\n";
const VERSION: u32 = 1;
/// The only flag: that there are weights.
const IMPORTANCE: u32 = 1;

impl Decomposition {
    /// Writes the file at `path`, whole or not at all, as [`io::write`](crate::io::write) does. The usual
    /// extension is `.drd`.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        replace(path, |file| self.write_to(file))
    }

    /// Writes what is in such a file to `writer` and flushes it: 8 bytes a sample or a little more, 12 with
    /// importance. `writer` need not be buffered.
    pub fn write_to(&self, writer: impl Write) -> Result<(), WriteError> {
        let mut writer = BufWriter::with_capacity(1 << 18, writer);
        let (lattice, slopes, certificate) = self.parts();
        let (field, layout) = (lattice.field(), lattice.layout());
        let [across, down] = layout.base();
        writer.write_all(MAGIC)?;
        for number in [
            VERSION,
            if field.importance().is_some() { IMPORTANCE } else { 0 },
            field.columns() as u32,
            field.rows() as u32,
            across as u32,
            down as u32,
            layout.levels() / 2,
        ] {
            writer.write_all(&number.to_le_bytes())?;
        }
        let lists = [&field.spacing(), field.heights(), field.importance().unwrap_or(&[]), slopes];
        for number in lists.into_iter().flatten() {
            writer.write_all(&number.to_le_bytes())?;
        }
        let classes = certificate.classes();
        writer.write_all(&(classes.len() as u32).to_le_bytes())?;
        for Class { number, count, sum } in classes {
            writer.write_all(&number.to_le_bytes())?;
            writer.write_all(&count.to_le_bytes())?;
            writer.write_all(&sum.to_le_bytes())?;
        }
        Ok(writer.flush()?)
    }

    /// The decomposition in the file at `path`. Takes as much memory as making one does, and most of its time goes
    /// into what is found anew: the changes of distortion, and the order.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let open_and_read = || {
            let mut file = File::open(path)?;
            let metadata = file.metadata()?;
            let length = metadata.is_file().then_some(metadata.len());
            read(&mut Source::new(&mut file, length))
        };
        open_and_read().map_err(|source| FileError::Read { path: path.to_owned(), source })
    }

    /// The decomposition in the bytes of such a file.
    pub fn read_from_slice(mut bytes: &[u8]) -> Result<Self, ReadError> {
        let length = bytes.len() as u64;
        read(&mut Source::new(&mut bytes, Some(length)))
    }
}

fn read(source: &mut Source) -> Result<Decomposition, ReadError> {
    let lattice = lattice(source)?;
    let layout = lattice.layout();
    let slopes = floats(source, layout.vertices() as u64, "slopes")?;
    if let Some(vertex) = slopes.iter().position(|slope| !slope.is_finite()) {
        return Err(source.error_here(format!("the slope of vertex {vertex} is {}", slopes[vertex])));
    }
    let classes = classes(source, slopes.len() as u64)?;
    if !source.peek(1)?.is_empty() {
        return Err(source.error_here("bytes follow the last class"));
    }

    let unexpected = |error: &dyn std::error::Error| ReadError::Io(std::io::Error::other(error.to_string()));
    let workers = Workers::new(0).map_err(|error| unexpected(&error))?;
    let raised = Flow::new(layout, &slopes, &workers).raised(layout, &workers);
    if let Some(vertex) = raised.iter().zip(&slopes).position(|(raised, slope)| raised != slope) {
        return Err(source.error_here(format!("vertex {vertex} goes before another that hangs on it")));
    }
    let deltas =
        lattice.deltas(&workers, &mut Monitor::silent(), 0.0..1.0).map_err(|error| unexpected(&error))?;
    if let Some(vertex) = (0..slopes.len()).find(|&vertex| deltas[vertex] >= NEVER && slopes[vertex] < NEVER)
    {
        let problem = format!("vertex {vertex} goes, which would leave triangles over voids");
        return Err(source.error_here(problem));
    }
    Ok(Decomposition::of_slopes(lattice, deltas, slopes, Certificate::of_classes(&classes), &workers))
}

/// The field, on a grid of the shape that the file tells.
fn lattice(source: &mut Source) -> Result<Lattice, ReadError> {
    if source.peek(MAGIC.len())? != MAGIC {
        return Err(source.error_here("this is no hierarchy file"));
    }
    source.take(MAGIC.len())?;
    let version = number(source)?;
    if version != VERSION {
        return Err(ReadError::Unsupported(format!("version {version} of the hierarchy format")));
    }
    let flags = number(source)?;
    if flags & !IMPORTANCE != 0 {
        return Err(ReadError::Unsupported(format!("a hierarchy with the flags {flags:#x}")));
    }
    let [columns, rows, across, down, depth] = [(); 5].map(|()| number(source));
    let (columns, rows) = (columns? as usize, rows? as usize);
    let shape = ([across? as usize, down? as usize], depth?);
    if columns < 2 || rows < 2 {
        return Err(source.error_here(format!("{columns} columns and {rows} rows make no surface")));
    }
    let samples = columns as u64 * rows as u64;
    let spacing = floats(source, 2, "distances")?;
    let heights = floats(source, samples, "heights")?;
    let importance = (flags & IMPORTANCE != 0).then(|| floats(source, samples, "weights")).transpose()?;
    let field = HeightField::new(columns, rows, heights, Some(f32::NAN))
        .and_then(|field| field.with_spacing([spacing[0], spacing[1]]))
        .and_then(|field| match importance {
            Some(importance) => field.with_importance(importance),
            None => Ok(field),
        })
        .map_err(|error| source.error_here(error.to_string()))?;
    let layout = Layout::covering(columns, rows);
    if (layout.base(), layout.levels() / 2) != shape {
        let ([across, down], depth) = shape;
        return Err(ReadError::Unsupported(format!(
            "a hierarchy of {across} times {down} quads of depth {depth} for {columns} columns and {rows} rows"
        )));
    }
    source.expect(layout.vertices() as u64, 4, "slopes")?;
    Ok(Lattice::new(field))
}

/// The classes that the slopes of so many vertices are in.
fn classes(source: &mut Source, vertices: u64) -> Result<Vec<Class>, ReadError> {
    const BYTES: u64 = 20;
    let count = number(source)?;
    source.expect(count.into(), BYTES, "classes")?;
    let mut classes: Vec<Class> = source.list(count.into(), BYTES)?;
    for _ in 0..count {
        let class = Class {
            number: number(source)?,
            count: u64::from_le_bytes(bytes(source)?),
            sum: f64::from_le_bytes(bytes(source)?),
        };
        let grows = match classes.last() {
            Some(last) => class.number > last.number && class.count > last.count,
            None => class.count > 0,
        };
        if !grows || class.number >= Certificate::CLASSES || !class.sum.is_finite() {
            return Err(source.error_here(format!("class {} cannot come here", class.number)));
        }
        classes.push(class);
    }
    let counted = classes.last().map_or(0, |class| class.count);
    match counted == vertices {
        true => Ok(classes),
        false => Err(source.error_here(format!("{counted} of {vertices} slopes are in classes"))),
    }
}

fn number(source: &mut Source) -> Result<u32, ReadError> {
    bytes(source).map(u32::from_le_bytes)
}

fn floats(source: &mut Source, count: u64, what: &str) -> Result<Vec<f32>, ReadError> {
    source.expect(count, 4, what)?;
    let mut list = source.list(count, 4)?;
    for _ in 0..count {
        list.push(f32::from_le_bytes(bytes(source)?));
    }
    Ok(list)
}

fn bytes<const N: usize>(source: &mut Source) -> Result<[u8; N], ReadError> {
    let mut bytes = [0; N];
    bytes.copy_from_slice(source.take(N)?);
    Ok(bytes)
}
