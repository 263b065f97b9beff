//! Rectangles of equal cells.

use super::{Values, rectangle};
use crate::error::Result;
use crate::mesh::{self, Mesh};

pub(super) fn make(all: &[Values], count: usize) -> Result<Mesh> {
    let (size, cells) = rectangle(&all[count % all.len()]);
    Ok(mesh::rectangle(size, cells)?)
}
