//! Which triangles meet at a vertex: the one adjacency that every query and every engine starts from.

use super::Mesh;

/// A corner of a triangle, in 32 bits: the face, and which of its three places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(transparent)]
pub struct Corner(u32);

impl Corner {
    fn new(face: usize, place: usize) -> Self {
        Self((face as u32) << 2 | place as u32)
    }

    /// The triangle, an index into [`Mesh::triangles`].
    pub fn face(self) -> usize {
        (self.0 >> 2) as usize
    }

    /// The place in the triangle: 0, 1 or 2.
    pub fn place(self) -> usize {
        (self.0 & 3) as usize
    }

    /// The corner after it, counter-clockwise in the same triangle.
    pub fn next(self) -> Self {
        if self.place() == 2 { Self(self.0 - 2) } else { Self(self.0 + 1) }
    }

    /// The corner before it in the same triangle.
    pub fn previous(self) -> Self {
        if self.place() == 0 { Self(self.0 + 2) } else { Self(self.0 - 1) }
    }

    /// `face << 2 | place`.
    pub fn packed(self) -> u32 {
        self.0
    }
}

/// For each vertex the corners that lie at it, in the order of the faces.
///
/// One flat list with an offset a vertex (compressed rows): 12 bytes a triangle and 4 a vertex.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rings {
    offsets: Vec<u32>,
    corners: Vec<Corner>,
}

impl Rings {
    /// The rings of `mesh`, in linear time.
    ///
    /// Every corner of every triangle is in exactly one ring. A triangle that names a vertex twice is
    /// twice in its ring.
    pub fn new(mesh: &Mesh) -> Self {
        let triangles = mesh.triangles();
        let mut offsets = vec![0u32; mesh.positions().len() + 1];
        for &vertex in triangles.as_flattened() {
            offsets[vertex as usize] += 1;
        }
        let mut end = 0;
        for offset in &mut offsets {
            end += *offset;
            *offset = end;
        }
        // Filled from the back, each row's end moves down to its start, which saves a second list of
        // cursors.
        let mut corners = vec![Corner::default(); triangles.len() * 3];
        for (face, triangle) in triangles.iter().enumerate().rev() {
            for (place, &vertex) in triangle.iter().enumerate().rev() {
                let cursor = &mut offsets[vertex as usize];
                *cursor -= 1;
                corners[*cursor as usize] = Corner::new(face, place);
            }
        }
        Self { offsets, corners }
    }

    /// How many rings there are: the vertices of the mesh.
    pub fn vertices(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The corners at `vertex`, in the order of the faces.
    ///
    /// # Panics
    ///
    /// If `vertex` is not less than [`Rings::vertices`].
    pub fn corners(&self, vertex: usize) -> &[Corner] {
        &self.corners[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// The faces at `vertex` in ascending order, one a corner.
    ///
    /// # Panics
    ///
    /// If `vertex` is not less than [`Rings::vertices`].
    pub fn faces_around(&self, vertex: usize) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.corners(vertex).iter().map(|corner| corner.face())
    }
}
