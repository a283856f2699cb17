//! What stands for `handle.rs` where OpenMesh is not installed: a mesh that cannot be.

use crate::{Decimation, Error};

#[derive(Debug)]
pub(crate) enum Handle {}

pub(crate) fn version() -> Option<(u32, u32)> {
    None
}

impl Handle {
    pub(crate) fn build(_: &[[f32; 3]], _: &[[u32; 3]]) -> Result<Self, Error> {
        Err(Error::Unavailable)
    }

    pub(crate) fn decimate(self, _: &Decimation) -> Result<Self, Error> {
        match self {}
    }

    pub(crate) fn vertices(&self) -> usize {
        match *self {}
    }

    pub(crate) fn triangles(&self) -> usize {
        match *self {}
    }

    pub(crate) fn left_out(&self) -> usize {
        match *self {}
    }

    pub(crate) fn buffers(&self) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        match *self {}
    }
}
