//! A field of any size on the samples of a 4-8 hierarchy: filled up beyond its edges and in its voids, by heights
//! that count for nothing.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::distortion::{Field, Half, Place, VALID, VOID, distortions};
use super::height_field::HeightField;
use super::layout::Layout;
use crate::monitor::{Cancelled, Monitor};
use crate::workers::Workers;

/// The samples of a layout, with a field on them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lattice {
    field: HeightField,
    layout: Layout,
    /// The heights of all samples of the layout, where the field has not one for each.
    filled: Option<Vec<f32>>,
    /// Whether nothing comes beyond the left, right, upper and lower edge.
    rims: [bool; 4],
    /// What heights and weights are divided by, powers of two, so that no sum of squares is beyond what an `f32`
    /// holds, whatever the unit.
    units: [f64; 2],
}

impl Lattice {
    pub(crate) fn new(field: HeightField) -> Self {
        let layout = Layout::covering(field.columns(), field.rows());
        let units = units(field.range(), field.importance());
        Self::of_layout(field, layout, [true; 4], units)
    }

    /// A part of a larger field, on one quad of 2^`depth` samples: samples on those of its edges that are not the
    /// rim count half here and half beyond.
    pub(crate) fn tile(field: HeightField, depth: u32, rims: [bool; 4], units: [f64; 2]) -> Self {
        Self::of_layout(field, Layout::new([1, 1], depth), rims, units)
    }

    fn of_layout(field: HeightField, layout: Layout, rims: [bool; 4], units: [f64; 2]) -> Self {
        let [right, bottom] = layout.extent();
        let fits = (right + 1, bottom + 1) == (field.columns(), field.rows());
        let filled = (!fits || field.voids() > 0).then(|| filled(&field, right + 1, bottom + 1));
        Self { field, layout, filled, rims, units }
    }

    pub(crate) fn field(&self) -> &HeightField {
        &self.field
    }

    pub(crate) fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Whether the samples of the layout are those of the field, and none is void.
    pub(crate) fn fits(&self) -> bool {
        self.filled.is_none()
    }

    /// The heights of all samples of the layout, row by row.
    pub(crate) fn heights(&self) -> &[f32] {
        self.filled.as_deref().unwrap_or(self.field.heights())
    }

    pub(crate) fn height(&self, [x, y]: Place) -> f32 {
        self.heights()[y as usize * (self.layout.extent()[0] + 1) + x as usize]
    }

    /// Whether a sample of the layout is one of the field.
    pub(crate) fn is_inside(&self, [x, y]: Place) -> bool {
        (x as usize) < self.field.columns() && (y as usize) < self.field.rows()
    }

    /// What a height is divided by where squared errors are summed up.
    pub(crate) fn unit(&self) -> f64 {
        self.units[0]
    }

    /// What a sum of squared errors, of heights and weights that were divided, has to be multiplied by.
    pub(crate) fn squared_unit(&self) -> f64 {
        self.units[0] * self.units[0] * self.units[1]
    }

    /// How much the squared error at a sample counts, of 1: nothing where nothing is known.
    pub(crate) fn weight(&self, place: Place) -> f64 {
        if !self.is_inside(place) {
            return 0.0;
        }
        let sample = place[1] as usize * self.field.columns() + place[0] as usize;
        match self.field.importance() {
            _ if self.field.heights()[sample].is_nan() => 0.0,
            Some(importance) => f64::from(importance[sample]) / self.units[1],
            None => 1.0,
        }
    }

    /// [`VALID`], [`VOID`], or 0 beyond the field.
    pub(crate) fn known(&self, place: Place) -> u8 {
        if !self.is_inside(place) {
            0
        } else if self.field.voids() > 0 && self.field.is_void(place[0] as usize, place[1] as usize) {
            VOID
        } else {
            VALID
        }
    }

    /// The change of distortion of each vertex, by number, over [`Lattice::squared_unit`]; infinite for those that
    /// must not go. `share` is the part of the monitor's way that this is.
    pub(crate) fn deltas(
        &self,
        workers: &Workers,
        monitor: &mut Monitor,
        share: std::ops::Range<f32>,
    ) -> Result<Vec<f32>, Cancelled> {
        let collected = Collected::new(self);
        distortions(&collected, self.roots(), self.layout.levels(), workers, monitor, share)?;
        let [first, second] = &collected.sides;
        let value = |bits: &AtomicU32| f32::from_bits(bits.load(Relaxed));
        Ok(workers.list(first.len(), |vertex| value(&first[vertex]) + value(&second[vertex])))
    }

    /// The two triangles of each base quad.
    pub(crate) fn roots(&self) -> Vec<Half> {
        let [across, down] = self.layout.base();
        let side = self.layout.side() as u32;
        let quads = (0..down as u32).flat_map(|row| (0..across as u32).map(move |column| [column, row]));
        quads
            .flat_map(|[column, row]| {
                let corner = |x: u32, y: u32| [(column + x) * side, (row + y) * side];
                // The diagonals take turns, as Layout has it.
                let [a, b, c, d] = match (column + row) % 2 {
                    0 => [corner(0, 1), corner(1, 1), corner(1, 0), corner(0, 0)],
                    _ => [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)],
                };
                [Half { apex: a, from: b, to: d, level: 1 }, Half { apex: c, from: d, to: b, level: 1 }]
            })
            .collect()
    }
}

/// What heights of a range and weights are divided by: the powers of two at or below the range and the largest.
pub(crate) fn units((low, high): (f32, f32), importance: Option<&[f32]>) -> [f64; 2] {
    let power_of_two = |number: f64| if number > 0.0 { number.log2().floor().exp2() } else { 1.0 };
    let most = importance.unwrap_or(&[1.0]).iter().fold(0.0, |most: f32, &weight| most.max(weight));
    [power_of_two(f64::from(high) - f64::from(low)), power_of_two(f64::from(most))]
}

/// The field's own heights, 0 in place of voids; beyond its right and its lower edge it is turned about the edge by
/// half a turn, which goes on as a plane where the field is one.
///
/// What stands at a place depends on its own row and column alone, so that tiles agree on their common edges.
fn filled(field: &HeightField, width: usize, height: usize) -> Vec<f32> {
    let (columns, rows) = (field.columns(), field.rows());
    let mut heights = vec![0.0; width * height];
    for y in 0..rows {
        let known = &field.heights()[y * columns..][..columns];
        let turned = Turned::new(columns, |x| known[x]);
        let row = &mut heights[y * width..][..width];
        row.iter_mut().enumerate().for_each(|(x, height)| *height = turned.at(x));
    }
    for x in 0..width {
        // Columns beyond the right edge are turned about the lower one as they are there.
        let column: Vec<f32> = (0..rows).map(|y| heights[y * width + x]).collect();
        let turned = Turned::new(rows, |y| column[y]);
        (rows..height).for_each(|y| heights[y * width + x] = turned.at(y));
    }
    heights.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = 0.0);
    heights
}

/// A line of heights that goes on beyond its end, turned about it, and about where it began, and so on.
struct Turned<F> {
    last: usize,
    height: F,
}

impl<F: Fn(usize) -> f32> Turned<F> {
    fn new(count: usize, height: F) -> Self {
        Self { last: count - 1, height }
    }

    /// Not a number where void; beyond the end, what is void on the way counts as being as high as the end.
    fn at(&self, index: usize) -> f32 {
        if index <= self.last {
            return (self.height)(index);
        }
        let (turns, rest) = (index / (2 * self.last), index % (2 * self.last));
        let end = f64::from((self.height)(self.last));
        let known = |index: usize| match f64::from((self.height)(index)) {
            void if void.is_nan() => end,
            height => height,
        };
        let within = if rest <= self.last { known(rest) } else { 2.0 * end - known(2 * self.last - rest) };
        let height = within + turns as f64 * 2.0 * (end - known(0));
        (height as f32).clamp(f32::MIN, f32::MAX)
    }
}

/// A lattice that collects the changes of distortion of its vertices.
struct Collected<'a> {
    lattice: &'a Lattice,
    width: usize,
    heights: &'a [f32],
    per_unit: f64,
    /// Whether each sample counts as one, as nearly always.
    is_plain: bool,
    /// What the triangles on either side of the edge that a vertex splits add. Each writes to its own, so that
    /// threads need not wait for each other, and the sum of two numbers does not depend on their order.
    sides: [Vec<AtomicU32>; 2],
}

impl<'a> Collected<'a> {
    fn new(lattice: &'a Lattice) -> Self {
        let zeros = || (0..lattice.layout.vertices()).map(|_| AtomicU32::new(0)).collect();
        Self {
            lattice,
            width: lattice.layout.extent()[0] + 1,
            heights: lattice.heights(),
            per_unit: lattice.unit().recip(),
            is_plain: lattice.fits() && lattice.field.importance().is_none(),
            sides: [zeros(), zeros()],
        }
    }
}

impl Field for Collected<'_> {
    type Value = f64;

    fn known(&self, place: Place) -> u8 {
        if self.is_plain { VALID } else { self.lattice.known(place) }
    }

    fn value(&self, [x, y]: Place) -> f64 {
        f64::from(self.heights[y as usize * self.width + x as usize]) * self.per_unit
    }

    fn weight(&self, place: Place) -> f64 {
        if self.is_plain { 1.0 } else { self.lattice.weight(place) }
    }

    fn is_rim(&self, from: Place, to: Place) -> bool {
        let [right, bottom] = self.lattice.layout.extent();
        let [left_rim, right_rim, upper_rim, lower_rim] = self.lattice.rims;
        let on = |axis: usize, last: usize, low: bool, high: bool| {
            from[axis] == to[axis] && ((low && from[axis] == 0) || (high && from[axis] as usize == last))
        };
        on(0, right, left_rim, right_rim) || on(1, bottom, upper_rim, lower_rim)
    }

    fn take(&self, triangle: &Half, change: f32) {
        let vertex = self.lattice.layout.index(triangle.midpoint());
        self.sides[triangle.side()][vertex].store(change.to_bits(), Relaxed);
    }
}
