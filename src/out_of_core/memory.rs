//! How much memory what takes, and what can be done in so much.

use super::OutOfCoreError;

/// Files are read and written through so many bytes each.
pub(super) const BUFFER: usize = 1 << 16;
/// Buffers of files, of which few are open at a time; tables of a few blocks; what threads have of their own.
const FIXED: usize = 1 << 20;
/// What the finish of a run takes for each triangle it works on, and on how many it does at most.
const FINISH: usize = 70;
const FINISH_TRIANGLES: usize = 24_000;
/// Blocks of fewer triangles are mostly border.
const LEAST_BLOCK: usize = 16384;

/// The memory that is allowed, and what is to be done in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Memory {
    bytes: usize,
    /// Of the attributes of a vertex.
    attributes: usize,
}

impl Memory {
    pub(super) fn new(bytes: usize, attributes: usize) -> Self {
        Self { bytes, attributes }
    }

    /// What it takes to simplify a mesh that is in memory to `left` triangles: the mesh, what is known about its
    /// vertices beside, and the surface, with its rings or, once these are gone, with the result.
    fn run(&self, triangles: usize, vertices: usize, left: usize) -> usize {
        let left_vertices = (left as f64 * vertices as f64 / triangles.max(1) as f64) as usize + 1;
        let mesh = 12 * triangles + (12 + self.attributes) * vertices;
        // Names in the whole mesh, ranks, and a few locks.
        let beside = 9 * vertices;
        // Points 16, flags 1, sources 4, places in a better order 4.
        let surface = 12 * triangles + (25 + self.attributes) * vertices;
        let rings = 12 * triangles + 4 * vertices;
        let result = 12 * left + (20 + self.attributes) * left_vertices + 4 * vertices;
        mesh + beside + surface + rings.max(result) + FINISH * triangles.min(FINISH_TRIANGLES)
    }

    /// Whether a whole mesh can be simplified in one run.
    pub(super) fn fits(&self, triangles: usize, vertices: usize, left: usize) -> bool {
        FIXED + self.run(triangles, vertices, left) <= self.bytes
    }

    /// How many triangles a mesh may have to be simplified to `left` in one run, where it has so many vertices
    /// a triangle.
    pub(super) fn most_at_once(&self, vertices_per_triangle: f64, left: usize) -> usize {
        let fits = |triangles: usize| {
            self.fits(triangles, (triangles as f64 * vertices_per_triangle) as usize, left.min(triangles))
        };
        // A bit at a time from above.
        let bits = (0..40).rev();
        bits.fold(0, |most, bit| if fits(most | 1 << bit) { most | 1 << bit } else { most })
    }

    /// What is left for a block beside what is known about each of `vertices` vertices of the whole: which are
    /// in the block, which are in several, a bit and a half each.
    fn block_bytes(&self, vertices: usize) -> Option<usize> {
        self.bytes.checked_sub(FIXED + 3 * vertices.div_ceil(8))
    }

    /// Fails unless a block with so many vertices of its own can be simplified, however little.
    pub(super) fn check_block(
        &self,
        vertices: usize,
        triangles: usize,
        own: usize,
    ) -> Result<(), OutOfCoreError> {
        let needed = FIXED + 3 * vertices.div_ceil(8) + self.run(triangles, own, triangles);
        let given = self.bytes;
        if needed <= given {
            Ok(())
        } else {
            Err(OutOfCoreError::TooLittleMemory { given, needed, vertices })
        }
    }

    /// How many triangles a block of a mesh may have.
    pub(super) fn block_triangles(&self, vertices: usize, triangles: usize) -> Result<usize, OutOfCoreError> {
        // Blocks have borders, and more of them are needed the smaller they are: hence the tenth.
        let per_triangle = 1.1 * vertices as f64 / triangles.max(1) as f64;
        let own = |triangles: usize| (triangles as f64 * per_triangle) as usize;
        let limited = Self { bytes: self.block_bytes(vertices).unwrap_or(0) + FIXED, ..*self };
        let most = limited.most_at_once(per_triangle, usize::MAX);
        if most < LEAST_BLOCK.min(triangles) {
            let least = LEAST_BLOCK.min(triangles);
            self.check_block(vertices, least, own(least))?;
        }
        Ok(most)
    }

    /// What may hold parts of files while blocks are cut, when no mesh is in memory.
    pub(super) fn for_cutting(&self) -> usize {
        self.bytes.saturating_sub(FIXED) / 2
    }
}
