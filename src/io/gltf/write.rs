//! One mesh, one primitive, one node, one buffer; or one of each but the buffer for each level of detail.

use std::io::{self, Write};

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderStringWriter;
use serde_json::{Map, Value, json};

use super::{BINARY, JSON, MAGIC, VERSION};
use crate::io::{WriteError, unit};
use crate::mesh::{Attributes, Mesh};

const FLOAT: u32 = 5126;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// What a level of detail shows of a vertex buffer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LevelOfDetail<'a> {
    /// Its vertices are those before this one.
    pub(crate) vertices: usize,
    pub(crate) triangles: &'a [[u32; 3]],
    /// In units of the positions.
    pub(crate) error: f32,
}

/// Writes GLB.
pub(in crate::io) fn write_binary(mesh: &Mesh, writer: &mut impl Write) -> Result<(), WriteError> {
    write_chunks(&Layout::new(mesh, &[whole(mesh)])?, writer)
}

/// Writes GLB with a node for each level, from fine to coarse, that share the vertices of `mesh`.
///
/// The first names the others as `MSFT_lod` wants it. Levels without triangles are left out.
pub(in crate::io) fn write_binary_levels(
    mesh: &Mesh,
    levels: &[LevelOfDetail],
    writer: &mut impl Write,
) -> Result<(), WriteError> {
    write_chunks(&Layout::new(mesh, levels)?, writer)
}

fn write_chunks(layout: &Layout, writer: &mut impl Write) -> Result<(), WriteError> {
    let mut json = layout.document(None).to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunks =
        if layout.length == 0 { 8 + json.len() as u64 } else { 16 + json.len() as u64 + layout.length };
    let total = 12 + chunks;
    let length = u32::try_from(total).map_err(|_| WriteError::TooLarge { bytes: total })?;
    writer.write_all(MAGIC)?;
    writer.write_all(&VERSION.to_le_bytes())?;
    writer.write_all(&length.to_le_bytes())?;
    // Both chunks are shorter than the file, whose length fits 32 bits.
    writer.write_all(&(json.len() as u32).to_le_bytes())?;
    writer.write_all(JSON)?;
    writer.write_all(&json)?;
    if layout.length > 0 {
        writer.write_all(&(layout.length as u32).to_le_bytes())?;
        writer.write_all(BINARY)?;
        layout.write_buffer(writer)?;
    }
    Ok(())
}

/// Writes JSON with the buffer embedded, so that the file is whole by itself.
pub(in crate::io) fn write_document(mesh: &Mesh, writer: &mut impl Write) -> Result<(), WriteError> {
    let layout = Layout::new(mesh, &[whole(mesh)])?;
    let uri = "data:application/octet-stream;base64,".to_owned();
    let mut encoder = EncoderStringWriter::from_consumer(uri, &STANDARD);
    layout.write_buffer(&mut encoder)?;
    let uri = encoder.into_inner();
    serde_json::to_writer_pretty(writer, &layout.document(Some(uri))).map_err(io::Error::from)?;
    Ok(())
}

/// The only level of a mesh.
fn whole(mesh: &Mesh) -> LevelOfDetail<'_> {
    LevelOfDetail { vertices: mesh.positions().len(), triangles: mesh.triangles(), error: 0.0 }
}

/// Levels of a mesh, and where their parts stand in the buffer.
///
/// glTF knows no accessor of nothing, so a mesh without triangles becomes a document without one.
struct Layout<'a> {
    mesh: &'a Mesh,
    levels: Vec<LevelOfDetail<'a>>,
    /// Vertices that a level has.
    vertices: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
    primitives: Vec<Value>,
    length: u64,
}

/// An attribute that a mesh has.
struct Stream {
    name: &'static str,
    component: u32,
    kind: &'static str,
    bytes: u64,
}

impl<'a> Layout<'a> {
    fn new(mesh: &'a Mesh, levels: &[LevelOfDetail<'a>]) -> Result<Self, WriteError> {
        let levels: Vec<_> = levels.iter().copied().filter(|level| !level.triangles.is_empty()).collect();
        let mut layout = Layout {
            mesh,
            vertices: levels.iter().map(|level| level.vertices).max().unwrap_or(0),
            views: Vec::new(),
            accessors: Vec::new(),
            primitives: Vec::new(),
            length: 0,
            levels,
        };
        if layout.levels.is_empty() {
            return Ok(layout);
        }
        let streams = streams(mesh.attributes());
        for stream in &streams {
            layout.add_view(layout.vertices as u64 * stream.bytes, ARRAY_BUFFER);
            // glTF wants it said where several accessors share a view.
            if let (Some(view), true) = (layout.views.last_mut(), layout.levels.len() > 1) {
                view["byteStride"] = json!(stream.bytes);
            }
        }
        for level in layout.levels.clone() {
            layout.add_level(level, &streams);
        }
        match u32::try_from(layout.length) {
            Ok(_) => Ok(layout),
            Err(_) => Err(WriteError::TooLarge { bytes: layout.length }),
        }
    }

    fn add_level(&mut self, level: LevelOfDetail, streams: &[Stream]) {
        let mut attributes = Map::new();
        for (view, stream) in streams.iter().enumerate() {
            attributes.insert(stream.name.to_owned(), json!(self.accessors.len()));
            self.add_accessor(view, stream.component, stream.kind, level.vertices as u64);
            if let Some(accessor) = self.accessors.last_mut() {
                if stream.name == "POSITION" {
                    let (min, max) = bounds(&self.mesh.positions()[..level.vertices]);
                    accessor["min"] = json!(min);
                    accessor["max"] = json!(max);
                }
                if stream.component == UNSIGNED_BYTE {
                    accessor["normalized"] = json!(true);
                }
            }
        }
        let indices = level.triangles.len() as u64 * 3;
        let (component, size) =
            if has_short_indices(&level) { (UNSIGNED_SHORT, 2) } else { (UNSIGNED_INT, 4) };
        self.add_view(indices * size, ELEMENT_ARRAY_BUFFER);
        self.primitives.push(json!({ "attributes": attributes, "indices": self.accessors.len() }));
        self.add_accessor(self.views.len() - 1, component, "SCALAR", indices);
    }

    fn add_view(&mut self, bytes: u64, target: u32) {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.length, "byteLength": bytes, "target": target,
        }));
        self.length += bytes.next_multiple_of(4);
    }

    fn add_accessor(&mut self, view: usize, component: u32, kind: &str, count: u64) {
        self.accessors.push(json!({
            "bufferView": view, "componentType": component, "type": kind, "count": count,
        }));
    }

    fn document(&self, uri: Option<String>) -> Value {
        let asset = json!({ "version": "2.0", "generator": "decimesh" });
        if self.length == 0 {
            return json!({ "asset": asset });
        }
        let mut buffer = json!({ "byteLength": self.length });
        if let Some(uri) = uri {
            buffer["uri"] = uri.into();
        }
        let meshes: Vec<Value> =
            self.primitives.iter().map(|primitive| json!({ "primitives": [primitive] })).collect();
        let mut nodes: Vec<Value> = (0..meshes.len()).map(|mesh| json!({ "mesh": mesh })).collect();
        let mut document = json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "meshes": meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [buffer],
        });
        if self.levels.len() > 1 {
            for (node, level) in nodes.iter_mut().zip(&self.levels) {
                node["extras"] = json!({ "error": level.error });
            }
            let coarser: Vec<usize> = (1..self.levels.len()).collect();
            nodes[0]["extensions"] = json!({ "MSFT_lod": { "ids": coarser } });
            document["extensionsUsed"] = json!(["MSFT_lod"]);
        }
        document["nodes"] = nodes.into();
        document
    }

    fn write_buffer(&self, writer: &mut impl Write) -> io::Result<()> {
        if self.length == 0 {
            return Ok(());
        }
        let Attributes { normals, colors, uvs } = self.mesh.attributes();
        let mut vector = |value: &[f32]| value.iter().try_for_each(|x| writer.write_all(&x.to_le_bytes()));
        self.mesh.positions().iter().take(self.vertices).try_for_each(|position| vector(position))?;
        for &normal in normals.iter().flatten().take(self.vertices) {
            // glTF knows no normal without a direction.
            vector(&unit(normal).unwrap_or([0.0, 0.0, 1.0]))?;
        }
        uvs.iter().flatten().take(self.vertices).try_for_each(|&[u, v]| vector(&[u, 1.0 - v]))?;
        colors.iter().flatten().take(self.vertices).try_for_each(|color| writer.write_all(color))?;
        for level in &self.levels {
            let indices = level.triangles.as_flattened();
            if has_short_indices(level) {
                indices.iter().try_for_each(|&index| writer.write_all(&(index as u16).to_le_bytes()))?;
                let end = indices.len() * 2;
                writer.write_all(&[0; 4][..end.next_multiple_of(4) - end])?;
            } else {
                indices.iter().try_for_each(|index| writer.write_all(&index.to_le_bytes()))?;
            }
        }
        Ok(())
    }
}

/// In the order in which they stand in the buffer.
fn streams(Attributes { normals, colors, uvs }: &Attributes) -> Vec<Stream> {
    let stream = |name, component, kind, bytes| Stream { name, component, kind, bytes };
    let mut streams = vec![stream("POSITION", FLOAT, "VEC3", 12)];
    streams.extend(normals.as_ref().map(|_| stream("NORMAL", FLOAT, "VEC3", 12)));
    streams.extend(uvs.as_ref().map(|_| stream("TEXCOORD_0", FLOAT, "VEC2", 8)));
    streams.extend(colors.as_ref().map(|_| stream("COLOR_0", UNSIGNED_BYTE, "VEC4", 4)));
    streams
}

/// The largest index of 16 bits is not allowed: it restarts strips.
fn has_short_indices(level: &LevelOfDetail) -> bool {
    level.vertices <= usize::from(u16::MAX)
}

fn bounds(positions: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    positions.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(min, max), position| {
        (
            std::array::from_fn(|axis| position[axis].min(min[axis])),
            std::array::from_fn(|axis| position[axis].max(max[axis])),
        )
    })
}
