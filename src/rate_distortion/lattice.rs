//! A field of any size on the samples of a 4-8 hierarchy: filled up beyond its edges and in its voids, by heights
//! that count for nothing.

use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::distortion::{Field, Half, Place, VALID, VOID};
use super::height_field::HeightField;
use super::layout::Layout;

/// The samples of a layout, with a field on them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lattice {
    field: HeightField,
    layout: Layout,
    /// The heights of all samples of the layout, where the field has not one for each.
    filled: Option<Vec<f32>>,
    /// What heights and weights are divided by, powers of two, so that no sum of squares is beyond what an `f32`
    /// holds, whatever the unit.
    units: [f64; 2],
}

impl Lattice {
    pub(crate) fn new(field: HeightField) -> Self {
        let layout = Layout::covering(field.columns(), field.rows());
        let [right, bottom] = layout.extent();
        let fits = (right + 1, bottom + 1) == (field.columns(), field.rows());
        let filled = (!fits || field.voids() > 0).then(|| filled(&field, right + 1, bottom + 1));
        let (low, high) = field.range();
        let most =
            field.importance().unwrap_or(&[1.0]).iter().fold(0.0, |most: f32, &weight| most.max(weight));
        let units = [power_of_two(f64::from(high) - f64::from(low)), power_of_two(f64::from(most))];
        Self { field, layout, filled, units }
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

/// The power of two at or below a number; 1 for 0.
fn power_of_two(number: f64) -> f64 {
    if number > 0.0 { number.log2().floor().exp2() } else { 1.0 }
}

/// The field's own heights with voids filled by what is known beside them; beyond its right and its lower edge it is
/// turned about the edge by half a turn, which goes on as a plane where the field is one.
fn filled(field: &HeightField, width: usize, height: usize) -> Vec<f32> {
    let (columns, rows) = (field.columns(), field.rows());
    let mut known = field.heights().to_vec();
    if field.voids() > 0 {
        let mut last = f32::NAN;
        let mut fill = |height: &mut f32| match height.is_nan() {
            true => *height = last,
            false => last = *height,
        };
        // The first heights may be void; the way back fills them with what came first.
        known.iter_mut().for_each(&mut fill);
        known.iter_mut().rev().for_each(&mut fill);
    }
    let turned = |edge: f32, mirrored: f32| (2.0 * edge - mirrored).clamp(f32::MIN, f32::MAX);
    // A layout reaches beyond its field by no more than a quarter of it (`Layout::covering`).
    let row = |row: usize| {
        let known = &known[row * columns..][..columns];
        let beyond = (columns..width).map(|x| turned(known[columns - 1], known[2 * (columns - 1) - x]));
        known.iter().copied().chain(beyond)
    };
    let mut heights = Vec::with_capacity(width * height);
    (0..rows).for_each(|y| heights.extend(row(y)));
    for y in rows..height {
        heights.extend(
            row(rows - 1).zip(row(2 * (rows - 1) - y)).map(|(edge, mirrored)| turned(edge, mirrored)),
        );
    }
    heights
}

/// A lattice that collects the changes of distortion of its vertices.
pub(crate) struct Collected<'a> {
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
    pub(crate) fn new(lattice: &'a Lattice) -> Self {
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

    /// The change of distortion of each vertex, by number, over [`Lattice::squared_unit`].
    pub(crate) fn into_deltas(self) -> Vec<f32> {
        let [first, second] = self.sides;
        let value = |bits: AtomicU32| f32::from_bits(bits.into_inner());
        first.into_iter().zip(second).map(|(first, second)| value(first) + value(second)).collect()
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
        (from[0] == to[0] && (from[0] == 0 || from[0] as usize == right))
            || (from[1] == to[1] && (from[1] == 0 || from[1] as usize == bottom))
    }

    fn take(&self, triangle: &Half, change: f32) {
        let vertex = self.lattice.layout.index(triangle.midpoint());
        self.sides[triangle.side()][vertex].store(change.to_bits(), Relaxed);
    }
}
