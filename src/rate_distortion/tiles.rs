//! Terrain of any size, a tile at a time: with identical borders, so that no crack shows.
//!
//! The paper's conclusion proposes patches whose boundaries are aligned; how is left open. Here each tile is solved
//! alone, and then each sample on a border takes the largest of the slopes that the tiles beside it found, which may
//! raise others in these tiles, and so on until nothing changes. Slopes of a border are then the same on both
//! sides, and so is what is left of it at any slope; one number a sample is all that crosses it. Decided for the
//! border alone, from its heights, it would cost two to three decibels; so it costs some thousandths.

use std::sync::Mutex;

use hashbrown::HashMap;

use super::Error;
use super::distortion::Place;
use super::extract::{extract, mesh_over};
use super::flow::{Flow, NEVER, of_rank, rank};
use super::height_field::{Grid, HeightField};
use super::lattice::{Lattice, units};
use super::layout::{Layout, Site};
use super::vertical::measure;
use crate::mesh::Mesh;
use crate::monitor::Monitor;
use crate::workers::Workers;

/// Where the heights of a large field come from, in part.
pub trait Source: Sync {
    /// How many columns and rows there are.
    fn size(&self) -> [usize; 2];

    /// The distance between columns and between rows.
    fn spacing(&self) -> [f32; 2];

    /// The least and the greatest height, or what they are at least and at most.
    fn range(&self) -> Result<(f32, f32), Error>;

    /// The heights of `size` columns and rows from `start` on, row by row; not a number where void.
    fn window(&self, start: [usize; 2], size: [usize; 2]) -> Result<Vec<f32>, Error>;
}

impl Source for HeightField {
    fn size(&self) -> [usize; 2] {
        [self.columns(), self.rows()]
    }

    fn spacing(&self) -> [f32; 2] {
        HeightField::spacing(self)
    }

    fn range(&self) -> Result<(f32, f32), Error> {
        Ok(HeightField::range(self))
    }

    fn window(&self, [column, row]: [usize; 2], [columns, rows]: [usize; 2]) -> Result<Vec<f32>, Error> {
        let rows = self.heights().chunks(self.columns()).skip(row).take(rows);
        Ok(rows.flat_map(|row| &row[column..][..columns]).copied().collect())
    }
}

/// Where the slopes of tiles are kept between one walk over them and the next.
pub trait Store: Sync {
    /// Keeps the slopes of a tile, as many as all tiles have, in the place of what was kept of it.
    fn put(&self, tile: usize, slopes: &[f32]) -> std::io::Result<()>;

    /// The slopes of a tile, as they were kept last; none if they never were.
    fn get(&self, tile: usize) -> std::io::Result<Vec<f32>>;
}

/// A store in memory: 4 bytes a sample.
#[derive(Debug, Default)]
pub struct InMemory(Mutex<Vec<Vec<f32>>>);

impl Store for InMemory {
    fn put(&self, tile: usize, slopes: &[f32]) -> std::io::Result<()> {
        let mut tiles = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if tiles.len() <= tile {
            tiles.resize(tile + 1, Vec::new());
        }
        tiles[tile] = slopes.to_vec();
        Ok(())
    }

    fn get(&self, tile: usize) -> std::io::Result<Vec<f32>> {
        let tiles = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        Ok(tiles.get(tile).cloned().unwrap_or_default())
    }
}

/// How a field is cut and solved.
#[derive(Debug, Clone, PartialEq)]
pub struct TileOptions {
    /// The side of a tile in samples: a power of two, 2 to 32768. A tile has one row and one column more, which it
    /// shares with its neighbours.
    pub side: usize,
    /// Sweeps of the flow.
    pub sweeps: u32,
    /// How many tiles to work on at a time; 0: as many as the machine has threads. The result is the same.
    pub threads: usize,
}

impl Default for TileOptions {
    fn default() -> Self {
        Self { side: 256, sweeps: 12, threads: 0 }
    }
}

/// A large field, decomposed tile by tile.
///
/// Memory: that of one tile a thread (about 24 bytes a sample), 4 bytes a sample on borders, and what the store
/// takes.
pub struct Tiles<'a> {
    source: &'a dyn Source,
    store: &'a dyn Store,
    /// Of each tile, those at the lower and the right edge filled up.
    layout: Layout,
    tiles: [usize; 2],
    units: [f64; 2],
    workers: Workers,
    /// How many vertices of all tiles have a slope of each class and below, those on borders once.
    below: Vec<u64>,
    samples: usize,
    rounds: usize,
}

/// How many leading bits of slopes are told apart when one is chosen for a number of vertices: steps of a
/// four-thousandth of it.
const CLASS_BITS: u32 = 21;

/// The largest slopes that were found on the borders between tiles.
struct Borders {
    /// Of the borders between columns of tiles, each by row.
    vertical: Vec<f32>,
    /// Of those between rows of tiles, each by column.
    horizontal: Vec<f32>,
    size: [usize; 2],
    side: usize,
}

impl Borders {
    fn new(tiles: [usize; 2], side: usize) -> Self {
        let size = tiles.map(|tiles| tiles * side + 1);
        let lines = |axis: usize| vec![f32::NEG_INFINITY; (tiles[axis] - 1) * size[1 - axis]];
        Self { vertical: lines(0), horizontal: lines(1), size, side }
    }

    /// Where the sample at a place of the field is found in the lists of vertical and of horizontal borders.
    fn indices(&self, place: [usize; 2]) -> [Option<usize>; 2] {
        std::array::from_fn(|axis| {
            let (at, along) = (place[axis], place[1 - axis]);
            let is_between = at % self.side == 0 && at > 0 && at + 1 < self.size[axis];
            is_between.then(|| (at / self.side - 1) * self.size[1 - axis] + along)
        })
    }

    fn at(&self, place: [usize; 2]) -> [Option<f32>; 2] {
        let [vertical, horizontal] = self.indices(place);
        [vertical.map(|index| self.vertical[index]), horizontal.map(|index| self.horizontal[index])]
    }

    /// Whether one of the slopes is above what was known.
    fn raise(&mut self, slopes: Vec<([usize; 2], f32)>) -> bool {
        let mut raised = false;
        for (place, slope) in slopes {
            let [vertical, horizontal] = self.indices(place);
            let known = vertical.map(|index| &mut self.vertical[index]);
            for known in known.into_iter().chain(horizontal.map(|index| &mut self.horizontal[index])) {
                raised |= *known < slope;
                *known = known.max(slope);
            }
        }
        raised
    }
}

/// The mesh of a block of tiles.
#[derive(Debug, Clone, PartialEq)]
pub struct TileMesh {
    /// East, north, up, in the place that it has in the whole field; with texture coordinates for an image of all
    /// of that.
    pub mesh: Mesh,
    /// The sum of the squared vertical errors of the block's samples; those on its borders with other blocks count
    /// half.
    pub squared_error: f64,
    /// The largest vertical error of a sample of it.
    pub max_error: f64,
}

impl<'a> Tiles<'a> {
    /// Cuts and solves a field. Time linear in its samples.
    pub fn new(
        source: &'a dyn Source,
        store: &'a dyn Store,
        options: &TileOptions,
        monitor: &mut Monitor,
    ) -> Result<Self, Error> {
        let side = options.side;
        if !side.is_power_of_two() || !(2..=1 << 15).contains(&side) {
            let expected = "it must be a power of two from 2 to 32768";
            return Err(Error::Target { what: "side of tiles", value: side as f64, expected });
        }
        let [columns, rows] = source.size();
        if columns < 2 || rows < 2 {
            return Err(Error::TooSmall { columns, rows });
        }
        let tiles = [columns, rows].map(|count| (count - 1).div_ceil(side));
        let mut made = Self {
            source,
            store,
            layout: Layout::new([1, 1], side.trailing_zeros()),
            tiles,
            units: units(source.range()?, None),
            workers: Workers::new(options.threads)?,
            below: Vec::new(),
            samples: 0,
            rounds: 0,
        };
        monitor.report(0.0)?;
        let mut borders = Borders::new(tiles, side);
        made.samples = made.solve(options.sweeps, &mut borders, monitor)?;
        if made.samples == 0 {
            return Err(Error::AllVoid { columns, rows });
        }
        while made.agree(&mut borders, monitor)? {}
        made.below = made.count(monitor)?;
        monitor.report(1.0)?;
        Ok(made)
    }

    /// Solves the tiles apart, and puts together what is found on borders. How many samples are not void.
    fn solve(&self, sweeps: u32, borders: &mut Borders, monitor: &mut Monitor) -> Result<usize, Error> {
        let alone = |_: &Borders, tile: usize| {
            let Some(lattice) = self.lattice(tile)? else { return Ok((0, Vec::new())) };
            let deltas = lattice.deltas(&Workers::Caller, &mut Monitor::silent(), 0.0..1.0)?;
            // As `flow::solve`, but for the proof, which nobody asks for.
            let mut flow = Flow::new(&self.layout, &deltas, &Workers::Caller);
            (0..sweeps.div_ceil(2).max(1)).for_each(|_| flow.sweep_twice(&self.layout, &Workers::Caller));
            let slopes = flow.raised(&self.layout, &Workers::Caller);
            self.store.put(tile, &slopes).map_err(|error| self.lost(tile, &error))?;
            let owned = |row: usize, column: usize| self.owns(tile, [column, row]);
            let columns = lattice.field().columns();
            let heights = lattice.field().heights().iter().enumerate();
            let known =
                heights.filter(|&(at, height)| !height.is_nan() && owned(at / columns, at % columns)).count();
            Ok((known, self.border(tile, &slopes)))
        };
        let mut samples = 0;
        self.each(borders, monitor, 0.0..0.7, alone, |borders, (known, border)| {
            samples += known;
            borders.raise(border);
        })?;
        Ok(samples)
    }

    /// Raises the slopes of each tile to those of its borders, and what follows from that, up to other borders.
    /// Whether any of these was raised.
    fn agree(&mut self, borders: &mut Borders, monitor: &mut Monitor) -> Result<bool, Error> {
        self.rounds += 1;
        let raise = |borders: &Borders, tile: usize| {
            let mut slopes = self.store.get(tile).map_err(|error| self.lost(tile, &error))?;
            if slopes.is_empty() {
                return Ok(Vec::new());
            }
            let mut changed = false;
            for (vertex, place) in self.border_places(tile) {
                let slope = borders.at(place).into_iter().flatten().fold(slopes[vertex], f32::max);
                changed |= std::mem::replace(&mut slopes[vertex], slope) != slope;
            }
            if changed {
                slopes =
                    Flow::new(&self.layout, &slopes, &Workers::Caller).raised(&self.layout, &Workers::Caller);
                self.store.put(tile, &slopes).map_err(|error| self.lost(tile, &error))?;
            }
            Ok(self.border(tile, &slopes))
        };
        let share = if self.rounds == 1 { 0.7..0.8 } else { 0.8..0.9 };
        let mut raised = false;
        self.each(borders, monitor, share, raise, |borders, border| raised |= borders.raise(border))?;
        Ok(raised)
    }

    /// How many vertices there are with a slope of each class and below.
    fn count(&self, monitor: &mut Monitor) -> Result<Vec<u64>, Error> {
        let slopes = |_: &Vec<u64>, tile: usize| {
            let slopes = self.store.get(tile).map_err(|error| self.lost(tile, &error))?;
            let owned = (0..slopes.len()).filter(|&vertex| {
                let Site { x, y, .. } = self.layout.site(vertex);
                self.owns(tile, [x, y]) && self.is_inside(tile, [x, y])
            });
            Ok(owned.map(|vertex| slopes[vertex]).collect::<Vec<_>>())
        };
        let mut below = vec![0; 1 << CLASS_BITS];
        self.each(&mut below, monitor, 0.9..1.0, slopes, |below, slopes| {
            slopes.into_iter().for_each(|slope| below[class(slope)] += 1);
        })?;
        let mut sum = 0;
        for count in &mut below {
            sum += *count;
            *count = sum;
        }
        Ok(below)
    }

    /// How many tiles there are across and down.
    pub fn size(&self) -> [usize; 2] {
        self.tiles
    }

    /// How many samples are not void.
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// How often tiles had to look at their borders until all agreed.
    pub fn rounds(&self) -> usize {
        self.rounds
    }

    /// A slope at which no more than so many vertices are left, or as few as there can be; the corners of tiles and
    /// the vertices made where the field is cut off at its edges not counted, and voids with what they need.
    pub fn slope_for(&self, vertices: usize) -> f32 {
        let all = self.below.last().copied().unwrap_or(0);
        let gone = all.saturating_sub(vertices as u64);
        let class = self.below.partition_point(|&below| below < gone);
        match gone {
            0 => f32::NEG_INFINITY,
            // All of the class go; what must stay does in any case.
            _ => of_rank((class as u32) << (32 - CLASS_BITS) | ((1 << (32 - CLASS_BITS)) - 1)),
        }
    }

    /// The mesh of `count` tiles across and down from `start` on of what is left at a slope, without a seam inside,
    /// and with none to another block of the same slope; `None` where all is void.
    pub fn mesh(&self, start: [usize; 2], count: [usize; 2], slope: f32) -> Result<Option<TileMesh>, Error> {
        let mut block = Block::default();
        for row in start[1]..(start[1] + count[1]).min(self.tiles[1]) {
            for column in start[0]..(start[0] + count[0]).min(self.tiles[0]) {
                self.add(row * self.tiles[0] + column, slope, &mut block)?;
            }
        }
        if block.triangles.is_empty() {
            return Ok(None);
        }
        let grid = Grid { size: self.source.size(), spacing: self.source.spacing() };
        let mesh = mesh_over(grid, &block.places, &block.heights, block.triangles);
        Ok(Some(TileMesh { mesh, squared_error: block.squared_error, max_error: block.max_error }))
    }

    fn add(&self, tile: usize, slope: f32, block: &mut Block) -> Result<(), Error> {
        let Some(lattice) = self.lattice(tile)? else { return Ok(()) };
        let slopes = self.store.get(tile).map_err(|error| self.lost(tile, &error))?;
        let is_left = |vertex: usize| slopes[vertex] > slope || slopes[vertex] >= NEVER;
        let deltas = lattice.deltas(&Workers::Caller, &mut Monitor::silent(), 0.0..1.0)?;
        let gone = deltas.iter().enumerate().filter(|&(vertex, _)| !is_left(vertex));
        let squared = gone.map(|(_, &delta)| f64::from(delta)).sum::<f64>() * lattice.squared_unit();
        block.squared_error += squared.max(0.0);
        let extract = extract(&lattice, is_left);
        let error = measure(lattice.field(), &extract.places, &extract.heights, &extract.triangles);
        block.max_error = block.max_error.max(error.maximum);
        let [left, top] = self.start(tile);
        let names = extract.places.iter().zip(&extract.heights).map(|(&[x, y], &height)| {
            let place = [left as u32 + x, top as u32 + y];
            *block.names.entry(place).or_insert_with(|| {
                block.places.push(place);
                block.heights.push(height);
                block.places.len() as u32 - 1
            })
        });
        let names: Vec<u32> = names.collect();
        block
            .triangles
            .extend(extract.triangles.iter().map(|corners| corners.map(|corner| names[corner as usize])));
        Ok(())
    }

    fn lost(&self, tile: usize, error: &std::io::Error) -> Error {
        let [column, row] = self.start(tile);
        Error::Tile { column, row, reason: format!("its slopes are lost: {error}") }
    }

    /// The first column and row of a tile.
    fn start(&self, tile: usize) -> [usize; 2] {
        [tile % self.tiles[0], tile / self.tiles[0]].map(|index| index * self.layout.side())
    }

    /// A tile of the field; `None` if all of it is void.
    fn lattice(&self, tile: usize) -> Result<Option<Lattice>, Error> {
        let start = self.start(tile);
        let size = self.source.size();
        let extent: [usize; 2] =
            std::array::from_fn(|axis| (size[axis] - start[axis]).min(self.layout.side() + 1));
        let heights = self.source.window(start, extent)?;
        if heights.iter().all(|height| height.is_nan()) {
            return Ok(None);
        }
        let field = HeightField::new(extent[0], extent[1], heights, Some(f32::NAN))?;
        let field = field.with_spacing(self.source.spacing())?;
        let last: [bool; 2] = std::array::from_fn(|axis| start[axis] + self.layout.side() >= size[axis] - 1);
        let rims = [start[0] == 0, last[0], start[1] == 0, last[1]];
        Ok(Some(Lattice::tile(field, self.layout.depth(), rims, self.units)))
    }

    /// Whether a sample of a tile is not one of the next tile's as well, which counts it.
    fn owns(&self, tile: usize, place: [usize; 2]) -> bool {
        let index = [tile % self.tiles[0], tile / self.tiles[0]];
        (0..2).all(|axis| place[axis] < self.layout.side() || index[axis] + 1 == self.tiles[axis])
    }

    fn is_inside(&self, tile: usize, place: [usize; 2]) -> bool {
        let (start, size) = (self.start(tile), self.source.size());
        (0..2).all(|axis| start[axis] + place[axis] < size[axis])
    }

    /// The vertices on the rim of a tile, and where in the field they lie.
    fn border_places(&self, tile: usize) -> impl Iterator<Item = (usize, [usize; 2])> {
        let side = self.layout.side();
        let [left, top] = self.start(tile);
        let rim = (1..side).flat_map(move |at| [[at, 0], [at, side], [0, at], [side, at]]);
        rim.map(move |[x, y]| {
            let site = Site { x, y, level: self.layout.level_at(x, y) };
            (self.layout.index(site), [left + x, top + y])
        })
    }

    fn border(&self, tile: usize, slopes: &[f32]) -> Vec<([usize; 2], f32)> {
        self.border_places(tile).map(|(vertex, place)| (place, slopes[vertex])).collect()
    }

    /// Does something with each tile, some at a time, and takes what it gives in the order of the tiles.
    fn each<S: Sync, T: Send>(
        &self,
        state: &mut S,
        monitor: &mut Monitor,
        share: std::ops::Range<f32>,
        work: impl Fn(&S, usize) -> Result<T, Error> + Sync + Send,
        mut take: impl FnMut(&mut S, T),
    ) -> Result<(), Error> {
        let tiles: Vec<usize> = (0..self.tiles[0] * self.tiles[1]).collect();
        let mut done = 0;
        for chunk in tiles.chunks(4 * self.workers.count()) {
            let known = &*state;
            for result in self.workers.map(chunk.to_vec(), |tile| work(known, tile)) {
                take(state, result?);
            }
            done += chunk.len();
            monitor.report(share.start + (share.end - share.start) * done as f32 / tiles.len() as f32)?;
        }
        Ok(())
    }
}

/// The mesh of a block, as far as it has been put together.
#[derive(Default)]
struct Block {
    names: HashMap<Place, u32>,
    places: Vec<Place>,
    heights: Vec<f32>,
    triangles: Vec<[u32; 3]>,
    squared_error: f64,
    max_error: f64,
}

fn class(slope: f32) -> usize {
    (rank(slope) >> (32 - CLASS_BITS)) as usize
}
