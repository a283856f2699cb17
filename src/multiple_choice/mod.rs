//! Half-edge collapse by multiple choice: no vertex is made, and none is moved.
//!
//! Follows Jia, Tang and Pan, *Fast Mesh Simplification Algorithm Based on Edge Collapse*, sections 3.2
//! (the visual cost, equations 1 to 3) and 3.3 (each vertex's best edge; of a few vertices drawn at random
//! the cheapest goes; what a collapse has changed is evaluated anew only when it is drawn). Every triangle
//! of the result names vertices of the input, so that all levels of detail share one vertex buffer.
//!
//! What the paper leaves open is said where it is decided: the border ([`Cost`]), the link condition,
//! vertices that have no legal collapse (left out until something around them changes), and when a face
//! folds over (when it turns by a right angle at once, or against the input's normals in the end). Other
//! costs and selections stand beside the paper's, so that they can be compared: `examples/multiple_choice`
//! does, and `docs/multiple-choice.md` has what it measured.
//! The visual cost makes 2.5 to 3.3 times the error of [`simplify`](crate::simplify) with
//! [`Placement::Existing`](crate::Placement::Existing) on the Stanford bunny, and takes longer: a program
//! that only wants the result should use that.

mod corners;
mod cost;
mod fan;
mod selection;
mod state;

pub use cost::Cost;
pub use selection::Selection;

use crate::collapse::HalfEdge;
use crate::mesh::Mesh;
use crate::monitor::{Cancelled, Monitor};
use selection::Order;
use state::{State, flag};

/// Collapses between two looks at the monitor.
const BATCH: usize = 1024;

/// A vertex to lock that the mesh does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("locked vertex {vertex} does not exist: there are {vertices} vertices")]
pub struct NoSuchVertex {
    /// The index that was given.
    pub vertex: u32,
    /// How many vertices the mesh has.
    pub vertices: usize,
}

/// A mesh that loses one vertex after another.
///
/// Topology is kept, no vertex is moved, and no face is flipped: none turns by a right angle at a collapse,
/// nor comes to lie against the mean of the input's normals at its corners. Where the mesh has attributes,
/// vertices that share their place with another stay, so that no seam opens. The same mesh, cost and
/// selection give the same collapses, byte for byte, on every machine.
///
/// ```
/// use decimesh::mesh::shapes;
/// use decimesh::multiple_choice::{Cost, Decimation, Selection};
/// use decimesh::Monitor;
///
/// let stone = shapes::bumpy_sphere(32, 1);
/// let mut decimation = Decimation::new(&stone, Cost::Visual, Selection::default());
/// assert!(decimation.reduce_to(2000, &mut Monitor::silent())?);
/// let fine = decimation.triangles();
/// assert!(decimation.reduce_to(500, &mut Monitor::silent())?);
/// let coarse = decimation.triangles();
/// assert!(fine.len() <= 2000 && coarse.len() <= 500);
/// // Both index the vertices of `stone`.
/// # Ok::<(), decimesh::Cancelled>(())
/// ```
pub struct Decimation {
    state: State,
    order: Order,
    collapses: Vec<HalfEdge>,
}

impl Decimation {
    /// Evaluates every vertex of `mesh`. Linear in the triangles; about 115 bytes a vertex, its points
    /// and faces included.
    pub fn new(mesh: &Mesh, cost: Cost, selection: Selection) -> Self {
        Self::start(State::new(mesh, cost), selection)
    }

    /// Like [`new`](Self::new), with vertices of the input that must stay: none of them goes into another,
    /// but others may go into them. To name one twice is allowed.
    pub fn with_locked(
        mesh: &Mesh,
        cost: Cost,
        selection: Selection,
        locked: &[u32],
    ) -> Result<Self, NoSuchVertex> {
        let mut state = State::new(mesh, cost);
        let vertices = mesh.positions().len();
        for &vertex in locked {
            let flags = state.flags.get_mut(vertex as usize);
            *flags.ok_or(NoSuchVertex { vertex, vertices })? |= flag::LOCKED;
        }
        Ok(Self::start(state, selection))
    }

    fn start(mut state: State, selection: Selection) -> Self {
        state.choose_all();
        let order = Order::new(selection, &mut state);
        Self { state, order, collapses: Vec::new() }
    }

    /// Collapses half-edges until at most `triangles` are left (this many, or one fewer); `false` if no
    /// further collapse is legal before that. To go on from there, to fewer, is allowed, and so it is after
    /// the monitor has cancelled.
    pub fn reduce_to(&mut self, triangles: usize, monitor: &mut Monitor) -> Result<bool, Cancelled> {
        let excess = |alive: usize| alive.saturating_sub(triangles);
        let at_first = excess(self.state.alive).max(1) as f32;
        let mut touched = Vec::new();
        let mut since_report = 0;
        while excess(self.state.alive) > 0
            && let Some(source) = self.order.next(&mut self.state)
        {
            let Some(target) = self.state.collapse(source, &mut touched) else {
                self.state.choose_again(source);
                self.order.put_back(source, &mut self.state);
                continue;
            };
            self.collapses.push(HalfEdge { source, target });
            touched.iter().for_each(|&vertex| self.order.follow(vertex, &mut self.state));
            since_report += 1;
            if since_report == BATCH {
                since_report = 0;
                monitor.report(1.0 - excess(self.state.alive) as f32 / at_first)?;
            }
        }
        monitor.report(1.0)?;
        Ok(excess(self.state.alive) == 0)
    }

    /// The triangles that are left, in the order they had in the input; corners are indices of the input's
    /// vertices. Linear in the triangles of the input.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.state.triangles()
    }

    /// What was collapsed so far, in its order.
    pub fn collapses(&self) -> &[HalfEdge] {
        &self.collapses
    }

    /// How many times a vertex has weighed its neighbours so far.
    pub fn evaluations(&self) -> usize {
        self.state.evaluations
    }
}
