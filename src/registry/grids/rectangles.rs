//! Rectangles of equal cells.

use super::{Rule, Values, rectangle};
use crate::error::Result;
use crate::mesh::{self, Mesh};

/// The next of the rectangles under a key.
pub(super) fn make(of: &Values, key: &str, rule: &dyn Rule, count: usize) -> Result<Mesh> {
    let all = of.tables(key);
    let (size, cells) = rectangle(&all[count % all.len()]);
    rule.has_room(key, cells[0].saturating_mul(cells[1]))?;
    Ok(mesh::rectangle(size, cells)?)
}
