//! What each vertex is worth: by how much the squared error grows when it goes.
//!
//! Balmelli, Vetterli and Liebling, section 2.1 and appendix A, measure the distortion of a *merging domain*, a
//! vertex with all of its descendants, by projecting each sample onto the triangles that stay. Distortion is
//! additive, though: a vertex `v` that goes (its descendants gone before) turns the four triangles around it
//! into two, whatever stands elsewhere, so it has a change of its own,
//!
//! ```text
//! delta(v) = error(its two merged triangles) - error(their four halves)
//! ```
//!
//! and that of a merging domain is the sum over those of its vertices that are still there. All are found in one
//! pass, depth first, in place of a projection for each domain. With the residuals `r` of the samples of a
//! triangle against its plane, their weights `w` and their barycentric coordinates `b`, a triangle is described by
//!
//! ```text
//! m_i = sum w r b_i        G_ij = sum w b_i b_j
//! ```
//!
//! without its own corners, where residuals are 0. When the midpoint goes, which stands `h` above the edge that it
//! splits, residuals grow by `h b_v`: the error grows by `2 h m_v + h^2 G_vv` in each half.

use std::ops::{Add, Mul, Sub};

use super::layout::Site;
use crate::monitor::{Cancelled, Monitor};
use crate::workers::Workers;

/// What stands at a sample: a height, or a point in space.
pub(crate) trait Value:
    Copy + Default + Send + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    /// The product whose square is the squared error.
    fn dot(self, other: Self) -> f64;
}

impl Value for f64 {
    fn dot(self, other: Self) -> f64 {
        self * other
    }
}

/// The place of a sample.
pub(crate) type Place = [u32; 2];

/// A triangle of the hierarchy: its right-angled corner and the ends of the edge that its midpoint splits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Half {
    pub(crate) apex: Place,
    pub(crate) from: Place,
    pub(crate) to: Place,
    /// The level of the midpoint; one below the last for the smallest triangles, which have none.
    pub(crate) level: u32,
}

impl Half {
    /// Where its midpoint lies.
    pub(crate) fn middle(&self) -> Place {
        [(self.from[0] + self.to[0]) / 2, (self.from[1] + self.to[1]) / 2]
    }

    pub(crate) fn midpoint(&self) -> Site {
        let [x, y] = self.middle().map(|coordinate| coordinate as usize);
        Site { x, y, level: self.level }
    }

    /// On which side of its midpoint it lies: 0 above it or to its left, 1 below it or to its right.
    pub(crate) fn side(&self) -> usize {
        let Site { x, y, .. } = self.midpoint();
        let [apex_x, apex_y] = self.apex.map(|coordinate| coordinate as usize);
        usize::from(apex_y > y || (apex_y == y && apex_x > x))
    }

    /// Its two halves, in the winding that it has.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let Self { apex, from, to, level } = *self;
        let (middle, level) = (self.middle(), level + 1);
        [Self { apex: middle, from: apex, to: from, level }, Self { apex: middle, from: to, to: apex, level }]
    }
}

/// A field of samples with a 4-8 hierarchy over it.
pub(crate) trait Field: Sync {
    type Value: Value;
    /// What is known of a sample: [`VALID`], [`VOID`], or 0 where there is none (beyond the data).
    fn known(&self, place: Place) -> u8;
    fn value(&self, place: Place) -> Self::Value;
    /// How much the squared error of a sample counts.
    fn weight(&self, place: Place) -> f64;
    /// Whether the edge between two places has a triangle on one side only.
    fn is_rim(&self, from: Place, to: Place) -> bool;
    /// Takes what one of the triangles that a vertex splits adds to its change of distortion; infinite where the
    /// vertex must not go.
    fn take(&self, triangle: &Half, change: f32);
}

/// Something is known at a sample.
pub(crate) const VALID: u8 = 1;
/// Nothing is known at a sample.
pub(crate) const VOID: u8 = 2;

/// Sums over the samples of a triangle but its corners, in the order apex, from, to.
#[derive(Debug, Clone, Copy, Default)]
struct Moments<V> {
    residual: [V; 3],
    /// The products of the corners with themselves.
    square: [f64; 3],
    /// Of apex and from, from and to, to and apex.
    mixed: [f64; 3],
    /// Of all of its samples, those at its corners as well.
    known: u8,
}

/// Triangles with fewer levels below them than this are not worth a trip to another thread.
const LEVELS_A_TASK: u32 = 14;
/// How many tasks are given out between two reports.
const TASKS_A_REPORT: usize = 64;

/// Finds the change of distortion of every vertex of a hierarchy of `levels` levels over `roots`, the triangles of
/// the base mesh. Time linear in the samples, memory in the number of threads and of roots.
///
/// The field takes each change from each of the one or two triangles that a vertex splits, once, in no order.
pub(crate) fn distortions<F: Field>(
    field: &F,
    roots: Vec<Half>,
    levels: u32,
    workers: &Workers,
    monitor: &mut Monitor,
    share: std::ops::Range<f32>,
) -> Result<(), Cancelled> {
    if levels == 0 {
        return Ok(());
    }
    // A task is a triangle of this level; what is above is put together from what the tasks leave.
    let cut = levels.saturating_sub(LEVELS_A_TASK).max(1);
    let mut tasks = roots.clone();
    for _ in 1..cut {
        tasks = tasks.iter().flat_map(Half::halves).collect();
    }
    let total = tasks.len();
    let values =
        |triangle: &Half| [triangle.apex, triangle.from, triangle.to].map(|place| field.value(place));
    let mut moments = Vec::with_capacity(total);
    for chunk in tasks.chunks(TASKS_A_REPORT) {
        let work = |triangle: Half| descend(field, &triangle, values(&triangle), levels, &mut |_| None);
        moments.extend(workers.map(chunk.to_vec(), work));
        let done = moments.len() as f32 / total as f32;
        monitor.report(share.start + done * (share.end - share.start))?;
    }
    let mut moments = moments.into_iter();
    let mut found = |triangle: &Half| (triangle.level == cut).then(|| moments.next()).flatten();
    for root in roots {
        descend(field, &root, values(&root), levels, &mut found);
    }
    Ok(())
}

/// The moments of a triangle with these values at its corners, and the changes of the vertices in it; those of
/// triangles that `found` knows are taken as they are.
fn descend<F: Field>(
    field: &F,
    triangle: &Half,
    values: [F::Value; 3],
    levels: u32,
    found: &mut impl FnMut(&Half) -> Option<Moments<F::Value>>,
) -> Moments<F::Value> {
    if let Some(moments) = found(triangle) {
        return moments;
    }
    let [apex, from, to] = values;
    let middle = field.value(triangle.middle());
    let height = middle - (from + to) * 0.5;
    let weight = own_weight(field, triangle);
    if triangle.level == levels {
        return smallest(field, triangle, height, weight);
    }
    let halves = triangle.halves();
    let values = [[middle, apex, from], [middle, to, apex]];
    // Half of all triangles are the smallest: for them, a call would cost more than what there is to do.
    let [first, second] = match triangle.level + 1 == levels {
        true => std::array::from_fn(|half| {
            let [_, from, to] = values[half];
            let below = field.value(halves[half].middle()) - (from + to) * 0.5;
            smallest(field, &halves[half], below, own_weight(field, &halves[half]))
        }),
        false => [0, 1].map(|half| descend(field, &halves[half], values[half], levels, found)),
    };
    let known = first.known | second.known;
    let own = first.square[0] + second.square[0];
    let grows =
        height.dot(first.residual[0] + second.residual[0]) * 2.0 + height.dot(height) * (own + weight);
    field.take(triangle, change(grows, known));

    // Residuals against the plane of the whole; the corners of the halves are midpoint, apex, from and midpoint,
    // to, apex.
    let [a_middle, a_apex, a_from] = shifted(&first, height);
    let [b_middle, b_to, b_apex] = shifted(&second, height);
    // The midpoint's coordinate goes to both ends of the edge by halves.
    let shared = (a_middle + b_middle) * 0.5 + height * (0.5 * weight);
    let ends = 0.25 * (own + weight);
    let (from_middle, to_middle) = (first.mixed[2], second.mixed[0]);
    let apex_middle = 0.5 * (first.mixed[0] + second.mixed[2]);
    Moments {
        residual: [a_apex + b_apex, a_from + shared, b_to + shared],
        square: [
            first.square[1] + second.square[2],
            first.square[2] + from_middle + ends,
            second.square[1] + to_middle + ends,
        ],
        mixed: [
            first.mixed[1] + apex_middle,
            0.5 * (from_middle + to_middle) + ends,
            second.mixed[1] + apex_middle,
        ],
        known,
    }
}

/// A triangle whose halves have no samples but at corners; its midpoint stands `height` above the edge it splits.
#[inline(always)]
fn smallest<F: Field>(field: &F, triangle: &Half, height: F::Value, weight: f64) -> Moments<F::Value> {
    let corners = [triangle.apex, triangle.from, triangle.to, triangle.middle()];
    let known = corners.into_iter().fold(0, |known, place| known | field.known(place));
    field.take(triangle, change(height.dot(height) * weight, known));
    let half = height * (0.5 * weight);
    let quarter = 0.25 * weight;
    Moments {
        residual: [F::Value::default(), half, half],
        square: [0.0, quarter, quarter],
        mixed: [0.0, quarter, 0.0],
        known,
    }
}

/// How much the midpoint counts on this side: a sample on an edge belongs to the triangles on both by halves.
#[inline(always)]
fn own_weight<F: Field>(field: &F, triangle: &Half) -> f64 {
    let part = if field.is_rim(triangle.from, triangle.to) { 1.0 } else { 0.5 };
    field.weight(triangle.middle()) * part
}

/// The residual moments of a half once its apex has sunk by `height`.
fn shifted<V: Value>(half: &Moments<V>, height: V) -> [V; 3] {
    let [apex, from, to] = half.residual;
    [apex + height * half.square[0], from + height * half.mixed[0], to + height * half.mixed[2]]
}

/// Where a triangle lies on the rim of what is known, its midpoint must not go: what covers voids is parted from
/// what does not down to the smallest triangles.
fn change(grows: f64, known: u8) -> f32 {
    match known == VALID | VOID {
        true => f32::INFINITY,
        false => grows as f32,
    }
}
