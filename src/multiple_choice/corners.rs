//! The faces around each vertex, in a form that follows collapses.
//!
//! Compressed rows, and room behind them: where two rings join and fit in neither's place, they move to
//! the end. A vertex takes 40 bytes at the start, and a few more as rows move.

/// A vertex with more faces goes nowhere, and none goes into it: fans are put in order, and compared, in
/// time quadratic in their size.
pub(super) const MAX_DEGREE: usize = 64;

/// What one vertex has in the pool.
#[derive(Debug, Clone, Copy)]
struct Row {
    start: u32,
    count: u32,
    /// Of these so many are of dead faces.
    dead: u32,
    room: u32,
}

/// For each vertex its corners, as `face << 2 | corner`.
pub(super) struct Corners {
    rows: Vec<Row>,
    pool: Vec<u32>,
}

/// A face is dead when its first two corners are equal.
pub(super) fn is_alive(face: &[u32; 3]) -> bool {
    face[0] != face[1]
}

/// The corners after and before `corner` in its face.
pub(super) fn neighbours(faces: &[[u32; 3]], corner: u32) -> (u32, u32) {
    let face = &faces[(corner >> 2) as usize];
    let corner = (corner & 3) as usize;
    (face[(corner + 1) % 3], face[(corner + 2) % 3])
}

impl Corners {
    /// The rows of `vertices` vertices, each in face order. Linear.
    pub(super) fn new(vertices: usize, faces: &[[u32; 3]]) -> Self {
        let mut rows = vec![Row { start: 0, count: 0, dead: 0, room: 0 }; vertices];
        faces.as_flattened().iter().for_each(|&vertex| rows[vertex as usize].room += 1);
        let mut start = 0;
        for row in &mut rows {
            row.start = start;
            start += row.room;
        }
        let mut pool = vec![0; 3 * faces.len()];
        for (face, index) in faces.iter().zip(0u32..) {
            for (&vertex, corner) in face.iter().zip(0..) {
                let row = &mut rows[vertex as usize];
                pool[(row.start + row.count) as usize] = index << 2 | corner;
                row.count += 1;
            }
        }
        Self { rows, pool }
    }

    /// The corners of `vertex`; `None` if they are more than [`MAX_DEGREE`].
    pub(super) fn of(&self, vertex: u32) -> Option<&[u32]> {
        let row = self.rows[vertex as usize];
        ((row.count - row.dead) as usize <= MAX_DEGREE)
            .then(|| &self.pool[row.start as usize..(row.start + row.count) as usize])
    }

    /// Notes that one face of `vertex` has died. A long row is swept only when half of it is dead, or when
    /// it is no longer a long one: a hub would else take time quadratic in its size.
    pub(super) fn lose_face(&mut self, vertex: u32, faces: &[[u32; 3]]) {
        let row = &mut self.rows[vertex as usize];
        row.dead += 1;
        let alive = row.count - row.dead;
        if alive as usize <= MAX_DEGREE || alive < row.dead {
            self.drop_dead(vertex, faces);
        }
    }

    fn drop_dead(&mut self, vertex: u32, faces: &[[u32; 3]]) {
        let row = &mut self.rows[vertex as usize];
        let corners = &mut self.pool[row.start as usize..(row.start + row.count) as usize];
        let mut kept = 0;
        for index in 0..corners.len() {
            if is_alive(&faces[(corners[index] >> 2) as usize]) {
                corners[kept] = corners[index];
                kept += 1;
            }
        }
        row.count = kept as u32;
        row.dead = 0;
    }

    /// Gives what lives of the row of `source` to `target`.
    pub(super) fn merge(&mut self, source: u32, target: u32, faces: &[[u32; 3]]) {
        self.drop_dead(source, faces);
        self.drop_dead(target, faces);
        let (from, into) = (self.rows[source as usize], self.rows[target as usize]);
        let count = from.count + into.count;
        let span = |row: Row| row.start as usize..(row.start + row.count) as usize;
        let row = if count <= into.room {
            self.pool.copy_within(span(from), (into.start + into.count) as usize);
            into
        } else if count <= from.room {
            // The target's come first, as in the other cases: sums are rounded in the order of a row.
            self.pool.copy_within(span(from), (from.start + into.count) as usize);
            self.pool.copy_within(span(into), from.start as usize);
            from
        } else {
            let start = self.pool.len() as u32;
            self.pool.extend_from_within(span(into));
            self.pool.extend_from_within(span(from));
            Row { start, count, dead: 0, room: count }
        };
        self.rows[target as usize] = Row { count, ..row };
        self.rows[source as usize] = Row { count: 0, room: 0, ..from };
    }
}
