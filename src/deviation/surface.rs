//! A mesh made ready to answer which of its triangles is nearest to a point.

use std::cell::{Cell, RefCell};

use glam::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

use super::triangle;
use crate::Mesh;

/// Boxes are snapped outwards to this many cells along the longest side of the mesh, plus one cell
/// all around. Whole numbers of this size are exact in `f32`, far from the origin and at any scale;
/// no box is flat, so a tree that weighs boxes by volume also splits plane meshes well; and the
/// depth of the tree is bounded by the grid however unevenly the triangles crowd.
const CELLS: f64 = (1 << 22) as f64;

/// Of triangles at the same distance, at most this many are compared by normal: enough for a corner
/// of any tame mesh, and a short list where thousands of triangles meet or coincide.
const MAX_TIES: usize = 32;

/// Triangles as near as the nearest one up to this relative difference tie with it.
const TIE: f64 = 1e-9;

/// The triangles of a mesh, in double precision, under a bounding-volume hierarchy.
pub(super) struct Surface<'a> {
    positions: Vec<DVec3>,
    triangles: &'a [[u32; 3]],
    tree: Bvh,
    grid: Grid,
    lowest: DVec3,
    highest: DVec3,
}

/// The nearest triangle to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Nearest {
    pub(super) squared: f64,
    pub(super) triangle: u32,
}

/// Whole-number coordinates of the boxes.
struct Grid {
    origin: DVec3,
    /// A power of two, so that multiplying by it does not round.
    cells_per_unit: f64,
}

impl Grid {
    fn new(lowest: DVec3, highest: DVec3) -> Self {
        let side = (highest - lowest).max_element();
        let exponent = if side > 0.0 { (CELLS / side).log2().floor() } else { 0.0 };
        Self { origin: lowest, cells_per_unit: exponent.exp2() }
    }

    fn cell(&self, point: DVec3) -> DVec3 {
        (point - self.origin) * self.cells_per_unit
    }

    fn bounds(&self, [a, b, c]: [DVec3; 3]) -> Aabb {
        let low = self.cell(a.min(b).min(c)).floor() - 1.0;
        let high = self.cell(a.max(b).max(c)).ceil() + 1.0;
        let whole = |at: DVec3| Vector::new(at.x as f32, at.y as f32, at.z as f32);
        Aabb::new(whole(low), whole(high))
    }
}

impl<'a> Surface<'a> {
    /// The surface of `mesh`, which has at least one triangle. O(n log n).
    pub(super) fn new(mesh: &'a Mesh) -> Self {
        let positions: Vec<_> =
            mesh.positions().iter().map(|&position| glam::Vec3::from(position).as_dvec3()).collect();
        let triangles = mesh.triangles();
        let (mut lowest, mut highest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &index in triangles.as_flattened() {
            lowest = lowest.min(positions[index as usize]);
            highest = highest.max(positions[index as usize]);
        }
        let grid = Grid::new(lowest, highest);
        let bounds = triangles
            .iter()
            .map(|corners| grid.bounds(corners.map(|index| positions[index as usize])))
            .enumerate();
        let tree = Bvh::from_iter(BvhBuildStrategy::Binned, bounds);
        Self { positions, triangles, tree, grid, lowest, highest }
    }

    pub(super) fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    pub(super) fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|index| self.position(index))
    }

    /// Diagonal of the bounding box of all triangles.
    pub(super) fn diagonal(&self) -> f64 {
        self.lowest.distance(self.highest)
    }

    /// The largest absolute value of a coordinate.
    pub(super) fn reach(&self) -> f64 {
        self.lowest.abs().max(self.highest.abs()).max_element()
    }

    /// The nearest triangle, unless one within `enough` (squared) comes first: then that one.
    ///
    /// `guess` is any triangle; the nearer it is, the less of the tree is searched.
    pub(super) fn nearest(&self, point: DVec3, guess: u32, enough: f64) -> Nearest {
        let best = Cell::new(self.measure(point, guess));
        let bound = Cell::new(best.get().squared);
        let stop_when_enough = || bound.set(if bound.get() <= enough { 0.0 } else { bound.get() });
        stop_when_enough();
        self.descend(point, &bound, |triangle| {
            let found = self.measure(point, triangle);
            if found.squared < best.get().squared {
                best.set(found);
                bound.set(found.squared);
                stop_when_enough();
            }
        });
        best.get()
    }

    /// The nearest triangle, and the angle in radians between `normal` and its normal.
    ///
    /// A point beside a convex edge is as near to one face as to the other: of all that tie, within
    /// rounding or `noise`, the angle is the smallest. `None` where none of them has a normal.
    pub(super) fn nearest_and_angle(
        &self,
        point: DVec3,
        guess: u32,
        normal: DVec3,
        noise: f64,
        ties: &mut Vec<Nearest>,
    ) -> (Nearest, Option<f64>) {
        let tying = |squared: f64| (squared.sqrt() * (1.0 + TIE) + noise).powi(2);
        let best = Cell::new(self.measure(point, guess));
        let limit = Cell::new(tying(best.get().squared));
        let bound = Cell::new(limit.get());
        ties.clear();
        ties.push(best.get());
        let candidates = RefCell::new(&mut *ties);
        self.descend(point, &bound, |triangle| {
            let found = self.measure(point, triangle);
            if found.squared > limit.get() {
                return;
            }
            let mut candidates = candidates.borrow_mut();
            if found.squared < best.get().squared {
                best.set(found);
                limit.set(tying(found.squared));
                bound.set(limit.get());
                candidates.retain(|candidate| candidate.squared <= limit.get());
            }
            if candidates.len() < MAX_TIES {
                candidates.push(found);
            } else {
                bound.set(best.get().squared);
            }
        });
        let angle = ties
            .iter()
            .filter_map(|tie| triangle::normal(self.corners(tie.triangle)))
            .map(|other| normal.cross(other).length().atan2(normal.dot(other)))
            .reduce(f64::min);
        (best.get(), angle)
    }

    fn measure(&self, point: DVec3, triangle: u32) -> Nearest {
        Nearest { squared: triangle::distance_squared(point, self.corners(triangle)), triangle }
    }

    /// Calls `visit` for the triangles whose box is nearer than `bound` (squared), nearest first as
    /// far as the tree knows. `visit` may lower the bound.
    fn descend(&self, point: DVec3, bound: &Cell<f64>, visit: impl Fn(u32)) {
        let cell = self.grid.cell(point);
        let scale = self.grid.cells_per_unit.powi(2);
        // The crate compares costs in f32, which is too coarse to decide what is nearest: its costs
        // only order the search, and what to leave out is decided here in f64.
        let order = |node: &BvhNode, _| {
            let squared = distance_to_box_squared(cell, node);
            if squared < bound.get() * scale { (squared as f32).min(f32::MAX / 2.0) } else { f32::MAX }
        };
        let leaf = |triangle, _| -> Option<f32> {
            visit(triangle);
            None
        };
        self.tree.find_best(f32::INFINITY, order, leaf);
    }
}

fn distance_to_box_squared(point: DVec3, node: &BvhNode) -> f64 {
    let (low, high) = (node.mins(), node.maxs());
    let outside = |at: f64, low: f32, high: f32| (f64::from(low) - at).max(at - f64::from(high)).max(0.0);
    let x = outside(point.x, low.x, high.x);
    let y = outside(point.y, low.y, high.y);
    let z = outside(point.z, low.z, high.z);
    x * x + y * y + z * z
}
