//! Semi-regular surfaces: any base complex of quads, each subdivided into a 4-8 mesh, and their decimation to any
//! rate by distortion in space.

mod complex;
mod decomposition;
mod error;
mod forest;
mod insertion;
mod stars;

pub use complex::BaseComplex;
pub use decomposition::{SurfaceApproximation, SurfaceDecomposition};
pub use error::SemiRegularError;
pub(crate) use forest::{Forest, Spot};

use crate::mesh::Mesh;

/// A surface with subdivision connectivity: 2^depth times 2^depth squares in each quad of a
/// [`BaseComplex`], each square two triangles, so that vertices have four or eight neighbours; only
/// the corners of the complex may have another number.
///
/// A place is given by a quad and coordinates in it, 0 to 2^depth, along its first side and up its last one.
/// Vertices are numbered by levels: first the corners of the complex, then, for each halving, the centres
/// of all squares and the midpoints of all their sides; the order on a level is what
/// [`SemiRegularMesh::vertex`] says.
#[derive(Debug, Clone, PartialEq)]
pub struct SemiRegularMesh {
    forest: Forest,
    positions: Vec<[f32; 3]>,
}

impl SemiRegularMesh {
    /// The surface over `complex`, subdivided `depth` times (at least once), with a finite position for each
    /// vertex, by number. Takes the buffers as they are.
    pub fn new(complex: BaseComplex, depth: u32, positions: Vec<[f32; 3]>) -> Result<Self, SemiRegularError> {
        Self::over(Forest::new(complex, depth)?, positions)
    }

    /// The same, with the position of each vertex from a function of its quad and place. The function is
    /// asked once for each vertex; for one that several quads have in common, in any of them.
    pub fn of_places(
        complex: BaseComplex,
        depth: u32,
        mut position: impl FnMut(usize, [u32; 2]) -> [f32; 3],
    ) -> Result<Self, SemiRegularError> {
        let forest = Forest::new(complex, depth)?;
        let mut positions = vec![[0.0; 3]; forest.vertices()];
        let side = forest.side();
        for (quad, corners) in forest.complex().quads().iter().enumerate() {
            for (&corner, place) in corners.iter().zip([[0, 0], [side, 0], [side, side], [0, side]]) {
                positions[corner as usize] = position(quad, place);
            }
        }
        for (vertex, at) in positions.iter_mut().enumerate().skip(forest.complex().corners()) {
            let Spot { quad, place } = forest.spot(vertex);
            *at = position(quad as usize, place);
        }
        Self::over(forest, positions)
    }

    pub(crate) fn over(forest: Forest, positions: Vec<[f32; 3]>) -> Result<Self, SemiRegularError> {
        let vertices = forest.vertices();
        if positions.len() != vertices {
            return Err(SemiRegularError::PositionCount { count: positions.len(), vertices });
        }
        match positions.iter().position(|position| !position.iter().all(|x| x.is_finite())) {
            Some(vertex) => Err(SemiRegularError::NotFinite { vertex }),
            None => Ok(Self { forest, positions }),
        }
    }

    /// The quads that are subdivided.
    pub fn complex(&self) -> &BaseComplex {
        self.forest.complex()
    }

    /// How often each quad is halved.
    pub fn depth(&self) -> u32 {
        self.forest.depth()
    }

    /// One position a vertex.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The vertex at a place in a quad.
    ///
    /// # Panics
    ///
    /// If there is no such quad, or a coordinate is larger than 2^depth.
    pub fn vertex(&self, quad: usize, place: [u32; 2]) -> usize {
        assert!(quad < self.complex().quads().len(), "there is no quad {quad}");
        assert!(place.iter().all(|&at| at <= self.forest.side()), "{place:?} is not in the quad");
        self.forest.vertex(Spot { quad: quad as u32, place })
    }

    /// All of it as a mesh, the vertices as they are: linear.
    pub fn to_mesh(&self) -> Mesh {
        let mut triangles = Vec::with_capacity((2 * self.complex().quads().len()) << (2 * self.depth()));
        self.forest.visit_triangles(|_| true, |corners| triangles.push(corners.map(|vertex| vertex as u32)));
        mesh(self.positions.clone(), triangles)
    }
}

/// A mesh from parts of a surface that has been checked.
fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(positions, triangles)
        .expect("positions are finite, and a forest is no larger than a mesh may be")
}
