//! glTF 2.0, as JSON and as GLB.
//!
//! Only the types of the JSON come from a crate. What they say is checked here before it is
//! followed: nothing in the document is trusted to name an object that exists, to stay within its
//! buffer, or to describe a tree.

mod accessor;
mod scene;
mod write;

use std::borrow::Cow;
use std::collections::HashMap;
use std::fs::File;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf_json::Root;

use super::source::Source;
use super::{Place, ReadError};
use crate::mesh::Mesh;

pub(crate) use write::LevelOfDetail;
pub(super) use write::{write_binary, write_binary_levels, write_document};

const MAGIC: &[u8; 4] = b"glTF";
const VERSION: u32 = 2;
const JSON: &[u8; 4] = b"JSON";
const BINARY: &[u8; 4] = b"BIN\0";

/// A document and the bytes it talks about.
struct Document {
    root: Root,
    buffers: Vec<Vec<u8>>,
    /// Which of `buffers` each buffer of the document is: those of one file share it.
    places: Vec<usize>,
}

/// Reads either kind, whatever the extension says: the first bytes tell them apart.
pub(super) fn read(source: &mut Source, directory: Option<&Path>) -> Result<Mesh, ReadError> {
    let is_binary = source.peek(4)? == MAGIC;
    let (json, binary) = if is_binary { read_chunks(source)? } else { (source.take_rest()?, None) };
    let root: Root = gltf_json::deserialize::from_slice(&json).map_err(|error| ReadError::Malformed {
        place: Place::Line(error.line() as u64),
        problem: format!("the JSON is no glTF document: {error}"),
    })?;
    if !root.asset.version.starts_with("2.") {
        return Err(ReadError::Unsupported(format!("glTF version '{}'", root.asset.version)));
    }
    check_extensions(&root)?;
    scene::read(&Document::load(root, binary, directory)?)
}

fn read_chunks(source: &mut Source) -> Result<(Vec<u8>, Option<Vec<u8>>), ReadError> {
    source.take(MAGIC.len())?;
    let version = read_u32(source)?;
    if version != VERSION {
        return Err(ReadError::Unsupported(format!("version {version} of GLB")));
    }
    let length = read_u32(source)?;
    let Some(mut left) = u64::from(length).checked_sub(12) else {
        return Err(source.error_here(format!("a length of {length} bytes, less than the header takes")));
    };
    source.expect(left, 1, "bytes of GLB chunks")?;
    let mut json = None;
    let mut binary = None;
    while left > 0 {
        let size = u64::from(read_u32(source)?);
        let kind = read_u32(source)?.to_le_bytes();
        left = left.checked_sub(8 + size).ok_or_else(|| {
            source.error_here(format!("a chunk of {size} bytes goes beyond the length in the header"))
        })?;
        match (&kind, &json) {
            (JSON, None) => json = Some(source.take_all(size)?),
            (_, None) => return Err(source.error_here("the first chunk of a GLB file is not its JSON")),
            (BINARY, _) if binary.is_none() => binary = Some(source.take_all(size)?),
            _ => source.skip(size)?,
        }
    }
    match json {
        Some(json) => Ok((json, binary)),
        None => Err(source.error_here("a GLB file without a chunk")),
    }
}

fn read_u32(source: &mut Source) -> Result<u32, ReadError> {
    let mut bytes = [0; 4];
    bytes.copy_from_slice(source.take(4)?);
    Ok(u32::from_le_bytes(bytes))
}

/// Refuses documents that need an extension which may change the shape.
fn check_extensions(root: &Root) -> Result<(), ReadError> {
    const HARMLESS: [&str; 5] =
        ["KHR_materials_", "KHR_texture_", "EXT_texture_", "MSFT_texture_", "KHR_lights_punctual"];
    // Quantised attributes are but other component types.
    let known = |name: &&String| {
        *name == "KHR_mesh_quantization" || HARMLESS.iter().any(|prefix| name.starts_with(prefix))
    };
    match root.extensions_required.iter().find(|name| !known(name)) {
        Some(name) => Err(ReadError::Unsupported(format!("a glTF file that requires the extension {name}"))),
        None => Ok(()),
    }
}

impl Document {
    fn load(root: Root, mut binary: Option<Vec<u8>>, directory: Option<&Path>) -> Result<Self, ReadError> {
        let mut buffers: Vec<Vec<u8>> = Vec::new();
        let mut places = Vec::new();
        let mut by_uri = HashMap::new();
        for (index, buffer) in root.buffers.iter().enumerate() {
            let object = format!("buffers[{index}]");
            let place = match &buffer.uri {
                Some(uri) => match by_uri.get(uri.as_str()) {
                    Some(&place) => place,
                    None => {
                        buffers.push(load_uri(uri, directory, &object)?);
                        by_uri.insert(uri.as_str(), buffers.len() - 1);
                        buffers.len() - 1
                    }
                },
                None => {
                    let binary = binary.take().filter(|_| index == 0).ok_or_else(|| {
                        ReadError::in_object(
                            &object,
                            "it has neither a URI nor the binary chunk of a GLB file",
                        )
                    })?;
                    buffers.push(binary);
                    buffers.len() - 1
                }
            };
            let (promised, actual) = (buffer.byte_length.0, buffers[place].len());
            if promised > actual as u64 {
                let problem = format!("byteLength is {promised}, but there are {actual} bytes");
                return Err(ReadError::in_object(object, problem));
            }
            places.push(place);
        }
        Ok(Self { root, buffers, places })
    }

    /// How many bytes there are to make a mesh of.
    fn bytes(&self) -> usize {
        self.buffers.iter().map(Vec::len).sum()
    }
}

fn load_uri(uri: &str, directory: Option<&Path>, object: &str) -> Result<Vec<u8>, ReadError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, data) = data
            .split_once(";base64,")
            .ok_or_else(|| ReadError::in_object(object, "its data URI is not base64"))?;
        return STANDARD
            .decode(data)
            .map_err(|error| ReadError::in_object(object, format!("its data URI is no base64: {error}")));
    }
    let name: Cow<str> = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .map_err(|_| ReadError::in_object(object, "its URI is not UTF-8"))?;
    let path = Path::new(name.as_ref());
    if uri.contains(':') || path.has_root() {
        return Err(ReadError::Unsupported(format!(
            "a buffer that is not in a file beside the document ('{uri}')"
        )));
    }
    let Some(directory) = directory else {
        return Err(ReadError::Unsupported(format!("the buffer '{uri}' of a document that is not a file")));
    };
    let path = directory.join(path);
    let load = || {
        let mut file = File::open(&path)?;
        let metadata = file.metadata()?;
        if !metadata.is_file() {
            return Err(ReadError::in_object(object, "it is no ordinary file"));
        }
        Source::new(&mut file, Some(metadata.len())).take_rest()
    };
    load().map_err(|error| match error {
        ReadError::Io(error) => ReadError::in_object(object, format!("{}: {error}", path.display())),
        other => other,
    })
}
