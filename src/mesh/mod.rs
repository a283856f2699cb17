//! The ground floor: a triangle mesh, validated once and immutable after.
//!
//! A [`Mesh`] can only hold valid things: finite positions, indices in range, attributes of the
//! right length. It need not be *clean*: duplicate and degenerate triangles, vertices no triangle
//! uses, non-manifold edges and vertices, faces that disagree in orientation and any number of
//! components are all the normal case of real data.

mod extent;
pub(crate) mod partition;
pub(crate) mod places;
mod rings;
pub mod shapes;
mod statistics;
pub mod topology;
mod verify;
pub(crate) mod weld;

pub use rings::{Corner, Rings};
pub use statistics::{Flaws, Statistics};
pub use topology::{Components, Topology};
pub use verify::{Violation, verify};
pub use weld::{Weld, WeldError, Welded};

/// Per-vertex attributes that a simplification carries along.
///
/// Each is either absent or has one entry a vertex.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Attributes {
    /// Unit normals.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Colours, red, green, blue and alpha, 0 to 255.
    pub colors: Option<Vec<[u8; 4]>>,
    /// Texture coordinates, first set; v points up (OBJ, PLY convention).
    pub uvs: Option<Vec<[f32; 2]>>,
}

impl Attributes {
    /// Those of `vertices`, in that order.
    pub(crate) fn select(&self, vertices: &[u32]) -> Self {
        Self {
            normals: self.normals.as_deref().map(|normals| select(normals, vertices)),
            colors: self.colors.as_deref().map(|colors| select(colors, vertices)),
            uvs: self.uvs.as_deref().map(|uvs| select(uvs, vertices)),
        }
    }
}

/// The values at `indices`, in that order.
pub(crate) fn select<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
    indices.iter().map(|&index| values[index as usize]).collect()
}

/// Why buffers do not make a mesh. Positions in the lists count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A flat index list has a length that is no multiple of three.
    #[error("{count} indices do not make whole triangles: the count is no multiple of three")]
    IncompleteTriangle {
        /// Length of the index list.
        count: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} has index {index}, but there are {vertices} vertices")]
    IndexOutOfRange {
        /// Which triangle.
        triangle: usize,
        /// The index it holds.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A coordinate or attribute is infinite or not a number.
    #[error("{what} of vertex {vertex} is not finite")]
    NotFinite {
        /// `"position"`, `"normal"` or `"uv"`.
        what: &'static str,
        /// Which vertex.
        vertex: usize,
    },
    /// An attribute has another length than the positions.
    #[error("{count} {what} for {vertices} vertices")]
    AttributeCount {
        /// `"normals"`, `"colors"` or `"uvs"`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there must be.
        vertices: usize,
    },
    /// More than [`Mesh::MAX_TRIANGLES`] triangles or `u32::MAX` vertices.
    #[error("{count} {what} are more than decimesh can hold ({limit})")]
    TooLarge {
        /// `"vertices"` or `"triangles"`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
}

/// A triangle mesh. See the [module](self) for what it may and may not contain.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    attributes: Attributes,
}

impl Mesh {
    /// Rings name a corner in 32 bits, two of them for the place in the triangle.
    pub const MAX_TRIANGLES: usize = (1 << 30) - 1;

    /// A mesh of `positions` and `triangles`, without attributes.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        Self::with_attributes(positions, triangles, Attributes::default())
    }

    /// A mesh with attributes. Takes the buffers as they are: nothing is copied, welded or dropped.
    pub fn with_attributes(
        positions: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
        attributes: Attributes,
    ) -> Result<Self, MeshError> {
        let vertices = positions.len();
        let limit = u32::MAX as usize;
        if vertices > limit {
            return Err(MeshError::TooLarge { what: "vertices", count: vertices, limit });
        }
        if triangles.len() > Self::MAX_TRIANGLES {
            let limit = Self::MAX_TRIANGLES;
            return Err(MeshError::TooLarge { what: "triangles", count: triangles.len(), limit });
        }
        finite("position", &positions)?;
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= vertices) {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertices });
            }
        }
        let Attributes { normals, colors, uvs } = &attributes;
        check_count("normals", normals, vertices)?;
        check_count("colors", colors, vertices)?;
        check_count("uvs", uvs, vertices)?;
        finite("normal", normals.as_deref().unwrap_or_default())?;
        finite("uv", uvs.as_deref().unwrap_or_default())?;
        Ok(Self { positions, triangles, attributes })
    }

    /// A mesh copied from flat buffers: `x y z` a vertex, three indices a triangle.
    pub fn from_buffers(positions: &[[f32; 3]], indices: &[u32]) -> Result<Self, MeshError> {
        let (triangles, rest) = indices.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(MeshError::IncompleteTriangle { count: indices.len() });
        }
        Self::new(positions.to_vec(), triangles.to_vec())
    }

    /// One position a vertex.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// Three vertex indices a triangle, counter-clockwise from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The per-vertex attributes.
    pub fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    /// A mesh of the first `vertices` vertices and of `triangles`, which name no others.
    pub(crate) fn prefix(&self, vertices: usize, triangles: Vec<[u32; 3]>) -> Self {
        let kept: Vec<u32> = (0..vertices as u32).collect();
        Self {
            positions: self.positions[..vertices].to_vec(),
            triangles,
            attributes: self.attributes.select(&kept),
        }
    }

    /// The mesh of other triangles on the same vertices, without those that none of them uses; and for each
    /// of its vertices the one of this mesh that it is, ascending. Linear.
    pub fn of_triangles(&self, triangles: &[[u32; 3]]) -> Result<(Self, Vec<u32>), MeshError> {
        let vertices = self.positions.len();
        let mut places = vec![u32::MAX; vertices];
        for (triangle, corners) in triangles.iter().enumerate() {
            for &index in corners {
                let place = places.get_mut(index as usize);
                *place.ok_or(MeshError::IndexOutOfRange { triangle, index, vertices })? = 0;
            }
        }
        let mut used = Vec::new();
        for (place, vertex) in places.iter_mut().zip(0..).filter(|(place, _)| **place == 0) {
            *place = used.len() as u32;
            used.push(vertex);
        }
        let triangles = triangles.iter().map(|triangle| triangle.map(|vertex| places[vertex as usize]));
        let attributes = self.attributes.select(&used);
        let mesh = Self::with_attributes(select(&self.positions, &used), triangles.collect(), attributes)?;
        Ok((mesh, used))
    }

    /// The buffers, without a copy.
    pub fn into_parts(self) -> (Vec<[f32; 3]>, Vec<[u32; 3]>, Attributes) {
        (self.positions, self.triangles, self.attributes)
    }
}

fn finite<const N: usize>(what: &'static str, values: &[[f32; N]]) -> Result<(), MeshError> {
    match values.iter().position(|value| !value.iter().all(|x| x.is_finite())) {
        Some(vertex) => Err(MeshError::NotFinite { what, vertex }),
        None => Ok(()),
    }
}

fn check_count<T>(what: &'static str, values: &Option<Vec<T>>, vertices: usize) -> Result<(), MeshError> {
    match values {
        Some(values) if values.len() != vertices => {
            Err(MeshError::AttributeCount { what, count: values.len(), vertices })
        }
        _ => Ok(()),
    }
}
