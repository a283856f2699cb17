//! Meshes to PLY: whole ones, and the header of one that is written piece by piece.

use std::io::{self, Write};

use super::Carried;
use crate::io::text::write_elements;
use crate::io::{Encoding, WriteError};
use crate::mesh::{Attributes, Mesh};

pub(in crate::io) fn write(
    mesh: &Mesh,
    encoding: Encoding,
    writer: &mut impl Write,
) -> Result<(), WriteError> {
    let carried = Carried::of(mesh.attributes());
    write_header(encoding, mesh.positions().len(), carried, mesh.triangles().len(), writer)?;
    match encoding {
        Encoding::Ascii => write_ascii(mesh, writer)?,
        Encoding::Binary => write_binary(mesh, writer, f32::to_le_bytes, u32::to_le_bytes)?,
        Encoding::BinaryBigEndian => write_binary(mesh, writer, f32::to_be_bytes, u32::to_be_bytes)?,
    }
    Ok(())
}

/// Writes the header of a file of so many vertices and triangles. In binary, the vertices follow as three
/// floats, those of the normal, four bytes of colour and two floats, as far as they are carried; then a byte
/// of 3 and three indices of four bytes for each triangle.
pub(crate) fn write_header(
    encoding: Encoding,
    vertices: usize,
    carried: Carried,
    triangles: usize,
    writer: &mut impl Write,
) -> io::Result<()> {
    let name = match encoding {
        Encoding::Ascii => "ascii",
        Encoding::Binary => "binary_little_endian",
        Encoding::BinaryBigEndian => "binary_big_endian",
    };
    write!(writer, "ply\nformat {name} 1.0\nelement vertex {vertices}\n")?;
    writer.write_all(b"property float x\nproperty float y\nproperty float z\n")?;
    if carried.normals {
        writer.write_all(b"property float nx\nproperty float ny\nproperty float nz\n")?;
    }
    if carried.colors {
        for channel in ["red", "green", "blue", "alpha"] {
            writeln!(writer, "property uchar {channel}")?;
        }
    }
    if carried.uvs {
        writer.write_all(b"property float s\nproperty float t\n")?;
    }
    // Most readers expect `int`, which ends at half of what an index can be.
    let index = if vertices > i32::MAX as usize { "uint" } else { "int" };
    write!(writer, "element face {triangles}\nproperty list uchar {index} vertex_indices\nend_header\n")
}

fn write_ascii(mesh: &Mesh, writer: &mut impl Write) -> io::Result<()> {
    write_elements(mesh, writer, |writer, [red, green, blue, alpha]| {
        write!(writer, " {red} {green} {blue} {alpha}")
    })
}

fn write_binary(
    mesh: &Mesh,
    writer: &mut impl Write,
    float: fn(f32) -> [u8; 4],
    index: fn(u32) -> [u8; 4],
) -> io::Result<()> {
    let Attributes { normals, colors, uvs } = mesh.attributes();
    for (vertex, position) in mesh.positions().iter().enumerate() {
        writer.write_all(position.map(float).as_flattened())?;
        if let Some(normals) = normals {
            writer.write_all(normals[vertex].map(float).as_flattened())?;
        }
        if let Some(colors) = colors {
            writer.write_all(&colors[vertex])?;
        }
        if let Some(uvs) = uvs {
            writer.write_all(uvs[vertex].map(float).as_flattened())?;
        }
    }
    for triangle in mesh.triangles() {
        let mut face = [3; 13];
        face[1..].copy_from_slice(triangle.map(index).as_flattened());
        writer.write_all(&face)?;
    }
    Ok(())
}
