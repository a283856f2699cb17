//! Where a mesh lies and how large it is.

use super::Mesh;

impl Mesh {
    /// The least and the greatest coordinates over all vertices that a triangle uses; `None` without
    /// a triangle. Linear.
    ///
    /// Vertices that no triangle uses are not part of the surface: one stray point far away must not
    /// change what a tolerance in fractions of the diagonal means.
    pub fn bounds(&self) -> Option<([f32; 3], [f32; 3])> {
        let mut used = self.triangles().as_flattened().iter().map(|&v| self.positions()[v as usize]);
        let first = used.next()?;
        Some(used.fold((first, first), |(low, high), position| {
            (
                std::array::from_fn(|axis| low[axis].min(position[axis])),
                std::array::from_fn(|axis| high[axis].max(position[axis])),
            )
        }))
    }

    /// The length of the diagonal of [`Mesh::bounds`]; 0 without a triangle. Linear.
    ///
    /// It is finite for every mesh, even one whose extent is beyond what an `f32` holds.
    pub fn diagonal(&self) -> f64 {
        let Some((low, high)) = self.bounds() else { return 0.0 };
        (0..3).map(|axis| (f64::from(high[axis]) - f64::from(low[axis])).powi(2)).sum::<f64>().sqrt()
    }
}
