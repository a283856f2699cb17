//! Accessors: lists of small vectors in a buffer, in one of six number types, dense or sparse.

use gltf_json::Index;
use gltf_json::accessor::{Accessor, ComponentType, GenericComponentType, IndexComponentType, Type};
use gltf_json::buffer::View;
use gltf_json::validation::Checked;

use super::Document;
use crate::io::ReadError;

/// Elements in a buffer, checked to be within it.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |at| &bytes[at * stride..at * stride + size])
    }
}

impl Document {
    /// How many elements an accessor promises.
    pub(super) fn count(&self, accessor: Index<Accessor>) -> Result<usize, ReadError> {
        let (object, accessor) = self.accessor(accessor)?;
        usize::try_from(accessor.count.0).map_err(|_| ReadError::in_object(object, "too many elements"))
    }

    /// Whether the elements of an accessor have as many components as `kind`.
    pub(super) fn is(&self, accessor: Index<Accessor>, kind: Type) -> Result<bool, ReadError> {
        Ok(matches!(self.accessor(accessor)?.1.type_, Checked::Valid(found) if found == kind))
    }

    /// The elements of an accessor, which must be of type `kind`, as floats.
    pub(super) fn vectors<const N: usize>(
        &self,
        index: Index<Accessor>,
        kind: Type,
    ) -> Result<Vec<[f32; N]>, ReadError> {
        let normalized = self.accessor(index)?.1.normalized;
        self.elements(index, kind, |component, bytes| {
            let size = component.size();
            std::array::from_fn(|at| float(component, normalized, &bytes[at * size..(at + 1) * size]))
        })
    }

    /// The elements of an accessor of indices.
    pub(super) fn indices(&self, index: Index<Accessor>) -> Result<Vec<u32>, ReadError> {
        let (object, accessor) = self.accessor(index)?;
        match accessor.component_type {
            Checked::Valid(GenericComponentType(
                ComponentType::U8 | ComponentType::U16 | ComponentType::U32,
            )) => {}
            _ => return Err(ReadError::in_object(object, "indices must be unsigned integers")),
        }
        self.elements(index, Type::Scalar, |_, bytes| unsigned(bytes))
    }

    fn accessor(&self, index: Index<Accessor>) -> Result<(String, &Accessor), ReadError> {
        let object = format!("accessors[{}]", index.value());
        match self.root.accessors.get(index.value()) {
            Some(accessor) => Ok((object, accessor)),
            None => Err(ReadError::in_object(object, "the document names it, but does not have it")),
        }
    }

    fn elements<T: Clone>(
        &self,
        index: Index<Accessor>,
        kind: Type,
        convert: impl Fn(ComponentType, &[u8]) -> T,
    ) -> Result<Vec<T>, ReadError> {
        let (object, accessor) = self.accessor(index)?;
        let (Checked::Valid(component), Checked::Valid(found)) = (accessor.component_type, accessor.type_)
        else {
            return Err(ReadError::in_object(object, "its type or componentType is none of glTF's"));
        };
        if found != kind {
            return Err(ReadError::in_object(object, format!("it is a {found:?}, where a {kind:?} must be")));
        }
        let component = component.0;
        let size = component.size() * kind.multiplicity();
        let offset = accessor.byte_offset.unwrap_or_default().0;
        let count = accessor.count.0;
        let mut values: Vec<T> = match accessor.buffer_view {
            Some(view) => self
                .slice(view, offset, count, size, &object)?
                .iter()
                .map(|bytes| convert(component, bytes))
                .collect(),
            // All zero but for the sparse ones. A document may promise any number of them.
            None if count <= self.bytes() as u64 => {
                vec![convert(component, &vec![0; size]); count as usize]
            }
            None => {
                let problem =
                    format!("{count} elements without a bufferView, in a file too small for as many");
                return Err(ReadError::in_object(object, problem));
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(IndexComponentType(index_kind)) = sparse.indices.component_type else {
                return Err(ReadError::in_object(object, "the sparse indices have no type of glTF's"));
            };
            let (count, offset) = (sparse.count.0, sparse.indices.byte_offset.0);
            let places = self.slice(sparse.indices.buffer_view, offset, count, index_kind.size(), &object)?;
            let offset = sparse.values.byte_offset.0;
            let changed = self.slice(sparse.values.buffer_view, offset, count, size, &object)?;
            for (place, bytes) in places.iter().zip(changed.iter()) {
                let place = unsigned(place);
                let Some(value) = values.get_mut(place as usize) else {
                    let problem = format!("a sparse value for element {place} of {}", accessor.count.0);
                    return Err(ReadError::in_object(object, problem));
                };
                *value = convert(component, bytes);
            }
        }
        Ok(values)
    }

    /// `count` elements of `size` bytes from `offset` on in a buffer view.
    fn slice(
        &self,
        view: Index<View>,
        offset: u64,
        count: u64,
        size: usize,
        object: &str,
    ) -> Result<Elements<'_>, ReadError> {
        let name = format!("bufferViews[{}]", view.value());
        let missing = || ReadError::in_object(object, format!("it names {name}, which does not hold it"));
        let view = self.root.buffer_views.get(view.value()).ok_or_else(missing)?;
        let buffer = self.places.get(view.buffer.value()).ok_or_else(|| {
            ReadError::in_object(
                &name,
                format!("it names buffers[{}], which does not exist", view.buffer.value()),
            )
        })?;
        let start = view.byte_offset.unwrap_or_default().0;
        let bytes = range(&self.buffers[*buffer], start, view.byte_length.0)
            .ok_or_else(|| ReadError::in_object(&name, "it goes beyond the end of its buffer"))?;
        let stride = view.byte_stride.map_or(size, |stride| stride.0);
        if stride < size {
            let problem = format!("a byteStride of {stride} for elements of {size} bytes");
            return Err(ReadError::in_object(name, problem));
        }
        let length = match count.checked_sub(1) {
            Some(steps) => steps.checked_mul(stride as u64).and_then(|steps| steps.checked_add(size as u64)),
            None => Some(0),
        };
        let bytes = length.and_then(|length| range(bytes, offset, length)).ok_or_else(|| {
            let problem = format!(
                "{count} elements of {size} bytes, {stride} apart, from byte {offset} on go beyond the \
                 {} bytes of {name}",
                bytes.len()
            );
            ReadError::in_object(object, problem)
        })?;
        // Within a slice, so it fits.
        Ok(Elements { bytes, stride, size, count: count as usize })
    }
}

fn range(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(start).ok()?;
    let length = usize::try_from(length).ok()?;
    bytes.get(start..start.checked_add(length)?)
}

/// The number that one to four bytes, least first, make.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

fn float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let bits = unsigned(bytes);
    let (value, largest) = match component {
        ComponentType::F32 => return f32::from_bits(bits),
        ComponentType::I8 => (f32::from(bits as u8 as i8), f32::from(i8::MAX)),
        ComponentType::U8 => (f32::from(bits as u8), f32::from(u8::MAX)),
        ComponentType::I16 => (f32::from(bits as u16 as i16), f32::from(i16::MAX)),
        ComponentType::U16 => (f32::from(bits as u16), f32::from(u16::MAX)),
        ComponentType::U32 => (bits as f32, u32::MAX as f32),
    };
    if normalized { (value / largest).max(-1.0) } else { value }
}
