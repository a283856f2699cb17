//! meshoptimizer on the same terms as decimesh: its defaults, no limit of error, the same target.

use std::borrow::Cow;

use decimesh::Mesh;
use meshopt::{SimplifyOptions, VertexDataAdapter};

use super::Buffers;

/// Relative to the extent of the mesh; beyond what any collapse costs, so that the target decides.
const NO_ERROR_LIMIT: f32 = 1e3;

/// A simplifier of meshoptimizer's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    /// `meshopt_simplify`: collapses into vertices of the input.
    Simplify,
    /// `meshopt_simplifyWithUpdate`: moves the vertices too.
    SimplifyWithUpdate,
}

impl Function {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Simplify => "meshopt simplify",
            Self::SimplifyWithUpdate => "meshopt simplifyWithUpdate",
        }
    }

    /// Copies of what it overwrites.
    pub(super) fn buffers(self, mesh: &Mesh) -> Buffers<'_> {
        let positions = Cow::Borrowed(mesh.positions());
        let indices = Cow::Borrowed(mesh.triangles().as_flattened());
        match self {
            Self::Simplify => Buffers { positions, indices },
            Self::SimplifyWithUpdate => Buffers {
                positions: Cow::Owned(positions.into_owned()),
                indices: Cow::Owned(indices.into_owned()),
            },
        }
    }

    /// Positions that no index names any more stay where they are.
    pub(super) fn simplify(self, mut buffers: Buffers<'_>, triangles: usize) -> Buffers<'_> {
        let target = 3 * triangles;
        let options = SimplifyOptions::None;
        match self {
            Self::Simplify => {
                let bytes = meshopt::typed_to_bytes(&buffers.positions);
                let vertices = VertexDataAdapter::new(bytes, size_of::<[f32; 3]>(), 0)
                    .expect("positions are whole vertices");
                let indices =
                    meshopt::simplify(&buffers.indices, &vertices, target, NO_ERROR_LIMIT, options, None);
                Buffers { indices: Cow::Owned(indices), ..buffers }
            }
            Self::SimplifyWithUpdate => {
                let indices = buffers.indices.to_mut();
                let count = meshopt::simplify_with_update(
                    indices,
                    buffers.positions.to_mut(),
                    &mut [],
                    &[],
                    0,
                    None,
                    target,
                    NO_ERROR_LIMIT,
                    options,
                    None,
                );
                indices.truncate(count);
                buffers
            }
        }
    }
}
