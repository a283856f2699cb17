//! Simplifiers beside decimesh: a file for each library.

pub(crate) mod meshoptimizer;

use std::borrow::Cow;

use decimesh::Mesh;
use openmesh_sys::{Decimation, Method};

use meshoptimizer::Function;

/// Someone else's simplifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Peer {
    Meshoptimizer(Function),
    OpenMesh(Method),
}

/// meshoptimizer's two.
pub(crate) const MESHOPTIMIZER: [Peer; 2] =
    [Peer::Meshoptimizer(Function::Simplify), Peer::Meshoptimizer(Function::SimplifyWithUpdate)];

/// OpenMesh's two, by quadrics alone. To be asked only where it is [`openmesh_sys::AVAILABLE`].
pub(crate) const OPENMESH: [Peer; 2] =
    [Peer::OpenMesh(Method::Quadric), Peer::OpenMesh(Method::MultipleChoice)];

/// A mesh as a peer has it, before it simplifies it or after.
pub(crate) enum Held<'a> {
    Meshoptimizer(Function, Buffers<'a>),
    OpenMesh(Method, openmesh_sys::Mesh),
}

/// Positions and the corners of triangles.
#[derive(Debug, Clone)]
pub(crate) struct Buffers<'a> {
    pub(crate) positions: Cow<'a, [[f32; 3]]>,
    pub(crate) indices: Cow<'a, [u32]>,
}

impl Peer {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Meshoptimizer(function) => function.name(),
            Self::OpenMesh(Method::Quadric) => "OpenMesh quadric",
            Self::OpenMesh(Method::MultipleChoice) => "OpenMesh multiple choice",
        }
    }

    /// What the peer works on and overwrites, where decimesh leaves its input alone. To be made outside
    /// the timing, which is in the peer's favour.
    pub(crate) fn hold(self, mesh: &Mesh) -> Held<'_> {
        match self {
            Self::Meshoptimizer(function) => Held::Meshoptimizer(function, function.buffers(mesh)),
            Self::OpenMesh(method) => {
                let built = openmesh_sys::Mesh::build(mesh.positions(), mesh.triangles());
                Held::OpenMesh(method, built.unwrap_or_else(|error| panic!("{error}")))
            }
        }
    }
}

impl<'a> Held<'a> {
    /// Simplifies to `triangles`, or to what the peer gets stuck at.
    pub(crate) fn simplify(self, triangles: usize) -> Self {
        match self {
            Self::Meshoptimizer(function, buffers) => {
                Self::Meshoptimizer(function, function.simplify(buffers, triangles))
            }
            Self::OpenMesh(method, mesh) => {
                let decimated = mesh.decimate(&Decimation::new(method, triangles));
                Self::OpenMesh(method, decimated.unwrap_or_else(|error| panic!("{error}")))
            }
        }
    }
}

impl<'a> From<Held<'a>> for Buffers<'a> {
    fn from(held: Held<'a>) -> Self {
        match held {
            Held::Meshoptimizer(_, buffers) => buffers,
            Held::OpenMesh(_, mesh) => {
                let (positions, triangles) = mesh.buffers();
                Self { positions: positions.into(), indices: triangles.into_flattened().into() }
            }
        }
    }
}
