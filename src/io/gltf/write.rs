//! One mesh, one primitive, one node, one buffer.

use std::io::{self, Write};

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderStringWriter;
use serde_json::{Value, json};

use super::{BINARY, JSON, MAGIC, VERSION};
use crate::io::{WriteError, unit};
use crate::mesh::{Attributes, Mesh};

const FLOAT: u32 = 5126;
const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Writes GLB.
pub(in crate::io) fn write_binary(mesh: &Mesh, writer: &mut impl Write) -> Result<(), WriteError> {
    let layout = Layout::new(mesh)?;
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
    let layout = Layout::new(mesh)?;
    let uri = "data:application/octet-stream;base64,".to_owned();
    let mut encoder = EncoderStringWriter::from_consumer(uri, &STANDARD);
    layout.write_buffer(&mut encoder)?;
    let uri = encoder.into_inner();
    serde_json::to_writer_pretty(writer, &layout.document(Some(uri))).map_err(io::Error::from)?;
    Ok(())
}

/// A mesh, and where its parts stand in the buffer.
///
/// glTF knows no accessor of nothing, so a mesh without triangles becomes a document without one.
struct Layout<'a> {
    mesh: &'a Mesh,
    views: Vec<Value>,
    accessors: Vec<Value>,
    attributes: serde_json::Map<String, Value>,
    length: u64,
}

impl<'a> Layout<'a> {
    fn new(mesh: &'a Mesh) -> Result<Self, WriteError> {
        let mut layout = Layout {
            mesh,
            views: Vec::new(),
            accessors: Vec::new(),
            attributes: serde_json::Map::new(),
            length: 0,
        };
        if mesh.triangles().is_empty() {
            return Ok(layout);
        }
        let vertices = mesh.positions().len() as u64;
        let Attributes { normals, colors, uvs } = mesh.attributes();
        layout.add_attribute("POSITION", FLOAT, "VEC3", vertices * 12);
        let (min, max) = bounds(mesh.positions());
        layout.accessors[0]["min"] = json!(min);
        layout.accessors[0]["max"] = json!(max);
        if normals.is_some() {
            layout.add_attribute("NORMAL", FLOAT, "VEC3", vertices * 12);
        }
        if uvs.is_some() {
            layout.add_attribute("TEXCOORD_0", FLOAT, "VEC2", vertices * 8);
        }
        if colors.is_some() {
            layout.add_attribute("COLOR_0", UNSIGNED_BYTE, "VEC4", vertices * 4);
            if let Some(accessor) = layout.accessors.last_mut() {
                accessor["normalized"] = json!(true);
            }
        }
        let indices = mesh.triangles().len() as u64 * 3;
        let (component, size) = if layout.short_indices() { (UNSIGNED_SHORT, 2) } else { (UNSIGNED_INT, 4) };
        layout.add_view(indices * size, ELEMENT_ARRAY_BUFFER);
        layout.add_accessor(component, "SCALAR", indices);
        match u32::try_from(layout.length) {
            Ok(_) => Ok(layout),
            Err(_) => Err(WriteError::TooLarge { bytes: layout.length }),
        }
    }

    /// The largest index of 16 bits is not allowed: it restarts strips.
    fn short_indices(&self) -> bool {
        self.mesh.positions().len() <= usize::from(u16::MAX)
    }

    fn add_attribute(&mut self, name: &str, component: u32, kind: &str, bytes: u64) {
        self.attributes.insert(name.to_owned(), json!(self.accessors.len()));
        self.add_view(bytes, ARRAY_BUFFER);
        self.add_accessor(component, kind, self.mesh.positions().len() as u64);
    }

    fn add_view(&mut self, bytes: u64, target: u32) {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.length, "byteLength": bytes, "target": target,
        }));
        self.length += bytes.next_multiple_of(4);
    }

    fn add_accessor(&mut self, component: u32, kind: &str, count: u64) {
        let view = self.views.len() - 1;
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
        json!({
            "asset": asset,
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [{
                "attributes": self.attributes,
                "indices": self.accessors.len() - 1,
            }] }],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [buffer],
        })
    }

    fn write_buffer(&self, writer: &mut impl Write) -> io::Result<()> {
        if self.length == 0 {
            return Ok(());
        }
        let Attributes { normals, colors, uvs } = self.mesh.attributes();
        let mut vector = |value: &[f32]| value.iter().try_for_each(|x| writer.write_all(&x.to_le_bytes()));
        self.mesh.positions().iter().try_for_each(|position| vector(position))?;
        for &normal in normals.iter().flatten() {
            // glTF knows no normal without a direction.
            vector(&unit(normal).unwrap_or([0.0, 0.0, 1.0]))?;
        }
        uvs.iter().flatten().try_for_each(|&[u, v]| vector(&[u, 1.0 - v]))?;
        colors.iter().flatten().try_for_each(|color| writer.write_all(color))?;
        let indices = self.mesh.triangles().as_flattened();
        if self.short_indices() {
            indices.iter().try_for_each(|&index| writer.write_all(&(index as u16).to_le_bytes()))?;
            let end = indices.len() * 2;
            writer.write_all(&[0; 4][..end.next_multiple_of(4) - end])
        } else {
            indices.iter().try_for_each(|index| writer.write_all(&index.to_le_bytes()))
        }
    }
}

fn bounds(positions: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    positions.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(min, max), position| {
        (
            std::array::from_fn(|axis| position[axis].min(min[axis])),
            std::array::from_fn(|axis| position[axis].max(max[axis])),
        )
    })
}
