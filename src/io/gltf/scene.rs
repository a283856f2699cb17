//! From a scene to one mesh: all its triangles, where its nodes put them.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DQuat, DVec3, Vec3};
use gltf_json::Index;
use gltf_json::accessor::{Accessor, Type};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::scene::Node;
use gltf_json::validation::Checked;

use super::Document;
use crate::io::text::WHITE;
use crate::io::{Fan, ReadError, Strip, finish};
use crate::mesh::{Attributes, Mesh};

/// A scene may show one mesh any number of times, so a small file can describe a mesh of any size.
/// Up to this many vertices and corners it may always, ...
const ALWAYS_ALLOWED: usize = 1 << 22;
/// ... and up to this many for each byte of its buffers.
const ALLOWED_PER_BYTE: usize = 64;

/// A mesh of the document, where a node puts it.
struct Instance {
    mesh: usize,
    /// `None` where it changes nothing, not even by rounding.
    transform: Option<DMat4>,
}

pub(super) fn read(document: &Document) -> Result<Mesh, ReadError> {
    let limit = document.bytes().saturating_mul(ALLOWED_PER_BYTE).max(ALWAYS_ALLOWED);
    let mut collector = Collector::new(document, limit);
    for instance in instances(document)? {
        collector.add(&instance)?;
    }
    collector.finish()
}

fn instances(document: &Document) -> Result<Vec<Instance>, ReadError> {
    let root = &document.root;
    let default = root.scene.map_or(0, |scene| scene.value());
    let Some(scene) = root.scenes.get(default) else {
        if root.scene.is_some() {
            return Err(ReadError::in_object(
                format!("scenes[{default}]"),
                "the default scene does not exist",
            ));
        }
        return Ok((0..root.meshes.len()).map(|mesh| Instance { mesh, transform: None }).collect());
    };
    let mut instances = Vec::new();
    let mut visited = vec![false; root.nodes.len()];
    let mut stack: Vec<_> = scene.nodes.iter().rev().map(|node| (node.value(), DMat4::IDENTITY)).collect();
    while let Some((index, parent)) = stack.pop() {
        let object = || format!("nodes[{index}]");
        let Some(node) = root.nodes.get(index) else {
            return Err(ReadError::in_object(object(), "the document names it, but does not have it"));
        };
        if std::mem::replace(&mut visited[index], true) {
            return Err(ReadError::in_object(object(), "it has more than one parent: nodes must form trees"));
        }
        let transform = parent * local(node);
        if !transform.is_finite() {
            return Err(ReadError::in_object(object(), "its transform is not finite"));
        }
        if let Some(mesh) = node.mesh {
            let moved = node.skin.is_none() && transform != DMat4::IDENTITY;
            instances.push(Instance { mesh: mesh.value(), transform: moved.then_some(transform) });
        }
        stack.extend(node.children.iter().flatten().rev().map(|child| (child.value(), transform)));
    }
    Ok(instances)
}

fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vector =
        |value: Option<[f32; 3]>, default| value.map_or(default, |value| Vec3::from(value).as_dvec3());
    let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
    let rotation = DQuat::from_xyzw(x, y, z, w);
    let length = rotation.length();
    let rotation = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(
        vector(node.scale, DVec3::ONE),
        rotation,
        vector(node.translation, DVec3::ZERO),
    )
}

/// All that has been read so far.
struct Collector<'a> {
    document: &'a Document,
    limit: usize,
    spent: usize,
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Shorter than `positions` where the last primitives have none.
    normals: Vec<[f32; 3]>,
    normals_complete: bool,
    colors: Vec<[u8; 4]>,
    uvs: Vec<[f32; 2]>,
}

/// The accessors of a primitive: position, normal, colour, texture coordinate.
type Accessors = [Option<Index<Accessor>>; 4];

/// Where the vertices of a primitive are, and how many, by its accessors: primitives of a mesh that
/// name the same share them.
type Shared = HashMap<[Option<usize>; 4], (usize, usize)>;

impl<'a> Collector<'a> {
    fn new(document: &'a Document, limit: usize) -> Self {
        Self {
            document,
            limit,
            spent: 0,
            positions: Vec::new(),
            triangles: Vec::new(),
            normals: Vec::new(),
            normals_complete: true,
            colors: Vec::new(),
            uvs: Vec::new(),
        }
    }

    fn add(&mut self, instance: &Instance) -> Result<(), ReadError> {
        let object = format!("meshes[{}]", instance.mesh);
        let Some(mesh) = self.document.root.meshes.get(instance.mesh) else {
            return Err(ReadError::in_object(object, "a node names it, but it does not exist"));
        };
        let mut shared = Shared::new();
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            self.spend(1)?;
            self.add_primitive(primitive, instance.transform, &mut shared)
                .map_err(|error| error.within(format_args!("{object}.primitives[{index}]")))?;
        }
        Ok(())
    }

    fn add_primitive(
        &mut self,
        primitive: &Primitive,
        transform: Option<DMat4>,
        shared: &mut Shared,
    ) -> Result<(), ReadError> {
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            _ => return Ok(()),
        };
        let semantics = [Semantic::Positions, Semantic::Normals, Semantic::Colors(0), Semantic::TexCoords(0)];
        let accessors: Accessors =
            semantics.map(|semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied());
        // A primitive without positions shows nothing.
        let Some(position) = accessors[0] else { return Ok(()) };
        let key = accessors.map(|accessor| accessor.map(|accessor| accessor.value()));
        let (first, count) = match shared.get(&key) {
            Some(&known) => known,
            None => {
                let first = self.positions.len();
                let count = self.document.count(position)?;
                self.spend(count)?;
                self.add_vertices(position, accessors, count, transform)?;
                shared.insert(key, (first, count));
                (first, count)
            }
        };
        let corners = primitive.indices.map_or(Ok(count), |indices| self.document.count(indices))?;
        self.spend(corners)?;
        let indices = primitive.indices.map(|indices| self.document.indices(indices)).transpose()?;
        if let Some(at) = indices.iter().flatten().position(|&index| index as usize >= count) {
            let index = indices.as_ref().map_or(0, |indices| indices[at]);
            let problem = format!("index {index} at place {at}, but there are {count} vertices");
            return Err(ReadError::in_object("indices", problem));
        }
        if mode == Mode::Triangles && corners % 3 != 0 {
            let problem = format!("{corners} indices do not make whole triangles");
            return Err(ReadError::in_object("indices", problem));
        }
        // What does not fit 32 bits is refused when the mesh is built: no mesh has as many.
        let corner = |at: usize| (first + indices.as_ref().map_or(at, |indices| indices[at] as usize)) as u32;
        let start = self.triangles.len();
        match mode {
            Mode::TriangleStrip => {
                let mut strip = Strip::default();
                self.triangles.extend((0..corners).filter_map(|at| strip.push(corner(at))));
            }
            Mode::TriangleFan => {
                let mut fan = Fan::default();
                self.triangles.extend((0..corners).filter_map(|at| fan.push(corner(at))));
            }
            _ => {
                self.triangles.extend((0..corners / 3).map(|at| [3 * at, 3 * at + 1, 3 * at + 2].map(corner)))
            }
        }
        // A mirrored mesh keeps its outside outside.
        if transform.is_some_and(|transform| transform.determinant() < 0.0) {
            self.triangles[start..].iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        Ok(())
    }

    /// Counts vertices, corners and primitives, and refuses more of them than the file can mean.
    fn spend(&mut self, more: usize) -> Result<(), ReadError> {
        self.spent = self.spent.saturating_add(more);
        if self.spent > self.limit {
            return Err(ReadError::Unsupported(format!(
                "a scene of more than {} vertices and corners out of {} bytes",
                self.limit,
                self.document.bytes()
            )));
        }
        Ok(())
    }

    fn add_vertices(
        &mut self,
        position: Index<Accessor>,
        [_, normal, color, uv]: Accessors,
        count: usize,
        transform: Option<DMat4>,
    ) -> Result<(), ReadError> {
        let document = self.document;
        let first = self.positions.len();
        for accessor in [normal, color, uv].into_iter().flatten() {
            let found = document.count(accessor)?;
            if found != count {
                let object = format!("accessors[{}]", accessor.value());
                return Err(ReadError::in_object(object, format!("{found} elements for {count} vertices")));
            }
        }
        let mut positions = document.vectors::<3>(position, Type::Vec3)?;
        if let Some(transform) = transform {
            for position in &mut positions {
                *position = transform.transform_point3(Vec3::from(*position).as_dvec3()).as_vec3().into();
            }
        }
        self.positions.append(&mut positions);
        self.normals_complete &= normal.is_some() || count == 0;
        if let Some(normal) = normal {
            let mut normals = document.vectors::<3>(normal, Type::Vec3)?;
            if let Some(transform) = transform {
                // The cofactors turn normals the right way even where there is no inverse.
                let turn = cofactors(DMat3::from_mat4(transform));
                for normal in &mut normals {
                    let turned = turn * Vec3::from(*normal).as_dvec3();
                    *normal = turned.normalize_or_zero().as_vec3().into();
                }
            }
            self.normals.resize(first, [0.0; 3]);
            self.normals.append(&mut normals);
        }
        if let Some(color) = color {
            self.colors.resize(first, WHITE);
            let byte = |value: f32| (value * 255.0).round() as u8;
            if document.is(color, Type::Vec3)? {
                let colors = document.vectors::<3>(color, Type::Vec3)?;
                self.colors.extend(colors.iter().map(|&[r, g, b]| [byte(r), byte(g), byte(b), 255]));
            } else {
                let colors = document.vectors::<4>(color, Type::Vec4)?;
                self.colors.extend(colors.iter().map(|color| color.map(byte)));
            }
        }
        if let Some(uv) = uv {
            self.uvs.resize(first, [0.0; 2]);
            let uvs = document.vectors::<2>(uv, Type::Vec2)?;
            self.uvs.extend(uvs.iter().map(|&[u, v]| [u, 1.0 - v]));
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Mesh, ReadError> {
        let vertices = self.positions.len();
        if !self.colors.is_empty() {
            self.colors.resize(vertices, WHITE);
        }
        if !self.uvs.is_empty() {
            self.uvs.resize(vertices, [0.0; 2]);
        }
        let attributes = Attributes {
            normals: (self.normals_complete && vertices > 0).then_some(self.normals),
            colors: (!self.colors.is_empty()).then_some(self.colors),
            uvs: (!self.uvs.is_empty()).then_some(self.uvs),
        };
        finish(self.positions, self.triangles, attributes)
    }
}

/// The inverse transpose but for its scale, which may be negative: what a mirror does to the
/// outside, it does to normals.
fn cofactors(matrix: DMat3) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let sign = if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}
