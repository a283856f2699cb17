//! Points of the input, spread as its area is.

use super::fit::Shape;
use crate::collapse::surface::NONE;
use crate::mesh::Mesh;
use crate::workers::Workers;
use glam::{Vec3, Vec3A};

/// How many samples there should be for each face of the surface: with 4 the error falls by 8 %, with 8 by
/// 10 %.
const SAMPLES: usize = 5;

/// Where a triangle or less is there for so many faces, each has three samples.
const SCARCE: usize = 3;

/// Triangles in a block of parallel work.
const BLOCK: usize = 1 << 14;

/// A point of the input, in the units of the surface.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sample {
    point: Vec3,
    /// The normal there, as long as the area that the point stands for.
    normal: Vec3,
    pub(super) weight: f32,
    /// The face of the surface that it is nearest to, as far as is known.
    pub(super) face: u32,
}

impl Sample {
    #[inline(always)]
    pub(super) fn point(&self) -> Vec3A {
        self.point.into()
    }

    /// The normal of the input there, of length 1.
    #[inline(always)]
    pub(super) fn normal(&self) -> Vec3A {
        Vec3A::from(self.normal).normalize_or_zero()
    }
}

/// Samples of `input`, each at the nearest face of the `shape` that was found near the vertex that a corner
/// of its triangle went into. A triangle has one in its middle; or three, which integrate a square over it
/// exactly, where there are few; where there are very many, one of several has.
pub(super) fn samples(shape: Shape, input: &Mesh, workers: &Workers) -> Vec<Sample> {
    let Some(origins) = shape.surface.origins() else { return Vec::new() };
    let (triangles, faces) = (input.triangles(), shape.surface.faces.len());
    let stride = (triangles.len() / (SAMPLES * faces).max(1)).max(1);
    let thrice = triangles.len() < SCARCE * faces;
    let scale = shape.surface.scale();
    let length = BLOCK.next_multiple_of(stride);
    let of_block = |block: &[[u32; 3]]| {
        let mut samples = Vec::with_capacity(block.len().div_ceil(stride) * if thrice { 3 } else { 1 });
        let mut last = None;
        for triangle in block.iter().step_by(stride) {
            let [a, b, c] = triangle.map(|corner| Vec3::from(input.positions()[corner as usize]) * scale);
            let vector_area = stride as f32 / 2.0 * (b - a).cross(c - a);
            let area = vector_area.length();
            if area.is_nan() || area <= 0.0 {
                continue;
            }
            let mut add = |point: Vec3, share: f32, corner: u32| {
                let vertex = origins[corner as usize];
                let found = if vertex == NONE { None } else { shape.find(point.into(), vertex, last) };
                if let Some(nearest) = found {
                    let face = nearest.face;
                    samples.push(Sample { point, normal: vector_area, weight: share * area, face });
                    last = found;
                }
            };
            let middle = a + ((b - a) + (c - a)) / 3.0;
            if thrice {
                for (place, &corner) in [a, b, c].into_iter().zip(triangle) {
                    add(middle + (place - middle) / 2.0, 1.0 / 3.0, corner);
                }
            } else {
                add(middle, 1.0, triangle[0]);
            }
        }
        samples
    };
    workers.map(triangles.chunks(length).collect(), of_block).concat()
}

/// Puts samples in the order of their faces, of which there are so many; those of one face stay in their
/// order. Where those of each face begin, and the last ones end.
pub(super) fn sort(samples: &mut Vec<Sample>, faces: usize) -> Vec<u32> {
    let mut starts = vec![0u32; faces + 1];
    samples.iter().for_each(|sample| starts[sample.face as usize] += 1);
    let mut end = 0;
    for start in &mut starts {
        end += *start;
        *start = end;
    }
    // From the back, each end moves down to the beginning.
    let mut sorted = vec![Sample::default(); samples.len()];
    for sample in samples.iter().rev() {
        let start = &mut starts[sample.face as usize];
        *start -= 1;
        sorted[*start as usize] = *sample;
    }
    *samples = sorted;
    starts
}
