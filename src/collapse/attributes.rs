//! What a half-edge collapse does to the attributes: the error of normals, colours and texture coordinates.
//!
//! After Hoppe, *New quadric metric for simplifying meshes with appearance attributes* (1999), memoryless as
//! all here: over each face an attribute is linear, and where a vertex goes to a neighbour, what the faces
//! around it foretell for that place is compared with what the neighbour has. The sum over the faces of the
//! squared differences, weighted by their areas, is a quadratic function of the place and of the value there.

use super::ring::Ring;
use super::wedges::{Moves, RingWedges, WedgeNames};
use crate::mesh::Mesh;
use glam::{Vec3, Vec3A, Vec4};

/// What a difference of 1 in an attribute weighs, beside a distance as long as the longest side of the
/// bounding box. Finite, not negative; 0: the attribute has no say.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AttributeWeights {
    /// For each of the three coordinates of normals.
    pub normals: f32,
    /// For both texture coordinates.
    pub uvs: f32,
    /// For each of the four channels of colours, from 0 to 1.
    pub colors: f32,
}

/// The weighted attributes of the input's vertices, in rows of blocks of four, filled up with zeros.
#[derive(Debug, Clone, Default)]
pub(crate) struct AttributeRows {
    blocks: Vec<Vec4>,
    width: usize,
}

impl AttributeRows {
    /// The attributes of `mesh` that have a weight, in units of its positions times `scale`; `None` if
    /// there are none.
    pub(crate) fn new(mesh: &Mesh, weights: AttributeWeights, scale: f32) -> Option<Self> {
        let attributes = mesh.attributes();
        let vertices = mesh.positions().len();
        let AttributeWeights { normals, uvs, colors } = weights;
        let weighted = |weight: f32| (weight > 0.0).then_some(weight);
        let normals = attributes.normals.as_ref().zip(weighted(normals));
        let uvs = attributes.uvs.as_ref().zip(weighted(uvs));
        let colors = attributes.colors.as_ref().zip(weighted(colors / 255.0));
        let values = 3 * usize::from(normals.is_some())
            + 2 * usize::from(uvs.is_some())
            + 4 * usize::from(colors.is_some());
        if values == 0 {
            return None;
        }
        let unit = mesh.bounds().map_or(0.0, |(low, high)| {
            scale * (Vec3::from(high) - Vec3::from(low)).max_element().min(f32::MAX)
        });
        let width = values.div_ceil(4);
        let mut blocks = Vec::with_capacity(width * vertices);
        for vertex in 0..vertices {
            let mut row = [0.0; 4 * WIDTH];
            let mut places = row.iter_mut();
            let mut fill = |values: &[f32], weight: f32| {
                values.iter().zip(&mut places).for_each(|(value, place)| *place = value * (weight * unit));
            };
            if let Some((normals, weight)) = normals {
                fill(&normals[vertex], weight);
            }
            if let Some((uvs, weight)) = uvs {
                fill(&uvs[vertex], weight);
            }
            if let Some((colors, weight)) = colors {
                fill(&colors[vertex].map(f32::from), weight);
            }
            blocks.extend((0..width).map(|block| Vec4::from_slice(&row[4 * block..])));
        }
        Some(Self { blocks, width })
    }

    #[inline(always)]
    fn row(&self, vertex: u32) -> &[Vec4] {
        &self.blocks[vertex as usize * self.width..][..self.width]
    }

    /// All rows, whose width is known to be this.
    #[inline(always)]
    fn of_width<const W: usize>(&self) -> &[[Vec4; W]] {
        self.blocks.as_chunks().0
    }

    /// The squared distance between the attributes of two wedges.
    pub(crate) fn distance_squared(&self, names: &WedgeNames, a: u32, b: u32) -> f32 {
        let (a, b) = (self.row(names.vertex(a)), self.row(names.vertex(b)));
        a.iter().zip(b).map(|(&a, &b)| (a - b).length_squared()).sum()
    }
}

/// The most blocks of values a vertex has.
const WIDTH: usize = 3;

/// The attributes over the faces of one wedge of a vertex.
#[derive(Debug, Clone, Copy)]
struct Sector {
    wedge: u32,
    /// The sum over faces and values of the gradients' outer products, weighted by the areas.
    slopes: [Vec3A; 3],
    /// For each block of values the sums of the gradients' x, y and z, weighted by the areas.
    gradients: [[Vec4; 3]; WIDTH],
    area: f32,
}

/// The attributes around a vertex.
#[derive(Debug, Clone, Default)]
pub(crate) struct AttributeQuadric {
    sectors: Vec<Sector>,
}

impl AttributeQuadric {
    /// Gathers them from the faces of a ring.
    pub(crate) fn gather(
        &mut self,
        rows: &AttributeRows,
        names: &WedgeNames,
        wedges: &RingWedges,
        ring: &Ring,
    ) {
        match rows.width {
            1 => self.gather_rows::<1>(rows, names, wedges, ring),
            2 => self.gather_rows::<2>(rows, names, wedges, ring),
            _ => self.gather_rows::<WIDTH>(rows, names, wedges, ring),
        }
    }

    fn gather_rows<const W: usize>(
        &mut self,
        rows: &AttributeRows,
        names: &WedgeNames,
        wedges: &RingWedges,
        ring: &Ring,
    ) {
        self.sectors.clear();
        let rows = rows.of_width::<W>();
        let row = |wedge: u32| &rows[names.vertex(wedge) as usize];
        for (index, spoke) in ring.spokes().enumerate() {
            let wedge = wedges.own[index];
            let known = self.sectors.iter().position(|sector| sector.wedge == wedge);
            let sector = known.unwrap_or_else(|| {
                let (slopes, gradients) = ([Vec3A::ZERO; 3], [[Vec4::ZERO; 3]; WIDTH]);
                self.sectors.push(Sector { wedge, slopes, gradients, area: 0.0 });
                self.sectors.len() - 1
            });
            let sector = &mut self.sectors[sector];
            let squared = spoke.cross.length_squared();
            if squared <= f32::MIN_POSITIVE {
                continue;
            }
            // The gradient of what is 1 at the next corner and 0 at the others, and at the previous one.
            let inverse = 1.0 / squared;
            let to_next = spoke.to_previous.cross(spoke.cross) * inverse;
            let to_previous = spoke.cross.cross(spoke.to_next) * inverse;
            let area = 0.5 * squared.sqrt();
            let (weighted_next, weighted_previous) = (area * to_next, area * to_previous);
            let (own, next, previous) = (row(wedge), row(wedges.next[index]), row(wedges.previous[index]));
            let (mut both_next, mut mixed, mut both_previous) = (Vec4::ZERO, Vec4::ZERO, Vec4::ZERO);
            for (((&own, &next), &previous), sum) in
                own.iter().zip(next).zip(previous).zip(&mut sector.gradients)
            {
                let (rise_next, rise_previous) = (next - own, previous - own);
                both_next += rise_next * rise_next;
                mixed += rise_next * rise_previous;
                both_previous += rise_previous * rise_previous;
                sum[0] += rise_next * weighted_next.x + rise_previous * weighted_previous.x;
                sum[1] += rise_next * weighted_next.y + rise_previous * weighted_previous.y;
                sum[2] += rise_next * weighted_next.z + rise_previous * weighted_previous.z;
            }
            let [both_next, mixed, both_previous] = [both_next, mixed, both_previous].map(Vec4::element_sum);
            let along_next = both_next * weighted_next + mixed * weighted_previous;
            let along_previous = mixed * weighted_next + both_previous * weighted_previous;
            sector.slopes[0] += to_next.x * along_next + to_previous.x * along_previous;
            sector.slopes[1] += to_next.y * along_next + to_previous.y * along_previous;
            sector.slopes[2] += to_next.z * along_next + to_previous.z * along_previous;
            sector.area += area;
        }
    }

    /// What it costs that the wedges go by `moves` to `edge` away; and the square of the mean difference.
    pub(crate) fn cost(
        &self,
        rows: &AttributeRows,
        names: &WedgeNames,
        moves: &Moves,
        edge: Vec3A,
    ) -> (f32, f32) {
        match rows.width {
            1 => self.cost_of_rows::<1>(rows, names, moves, edge),
            2 => self.cost_of_rows::<2>(rows, names, moves, edge),
            _ => self.cost_of_rows::<WIDTH>(rows, names, moves, edge),
        }
    }

    fn cost_of_rows<const W: usize>(
        &self,
        rows: &AttributeRows,
        names: &WedgeNames,
        moves: &Moves,
        edge: Vec3A,
    ) -> (f32, f32) {
        let rows = rows.of_width::<W>();
        let (mut cost, mut area) = (0.0, 0.0);
        for sector in &self.sectors {
            let own = &rows[names.vertex(sector.wedge) as usize];
            let there = &rows[names.vertex(moves.target(sector.wedge)) as usize];
            let [x, y, z] = sector.slopes;
            let mut differences = Vec4::ZERO;
            for ((&own, &there), gradient) in own.iter().zip(there).zip(&sector.gradients) {
                let rise = there - own;
                let foretold = gradient[0] * edge.x + gradient[1] * edge.y + gradient[2] * edge.z;
                differences += rise * (rise * sector.area - 2.0 * foretold);
            }
            let of_sector = edge.dot(x * edge.x + y * edge.y + z * edge.z) + differences.element_sum();
            cost += of_sector.max(0.0);
            area += sector.area;
        }
        (cost, cost / (area + f32::MIN_POSITIVE))
    }
}
