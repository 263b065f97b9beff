//! Rectangles of equal cells.

use super::{Rule, Values, rectangle};
use crate::error::Result;
use crate::mesh::{self, Mesh};

/// Whether each of the rectangles under a key has room in the memory: before the first step, and not hours after it.
pub(super) fn check(of: &Values, key: &str, rule: &dyn Rule) -> Result<()> {
    let room = |one: &Values| {
        let (_, cells) = rectangle(one);
        rule.has_room(key, cells[0].saturating_mul(cells[1]))
    };
    of.tables(key).iter().try_for_each(room)
}

/// The next of the rectangles under a key.
pub(super) fn make(of: &Values, key: &str, rule: &dyn Rule, count: usize) -> Result<Mesh> {
    let all = of.tables(key);
    let (size, cells) = rectangle(&all[count % all.len()]);
    rule.has_room(key, cells[0].saturating_mul(cells[1]))?;
    Ok(mesh::rectangle(size, cells)?)
}
