//! Rectangles of equal cells.

use super::{Rule, Values, rectangle, same};
use crate::error::Result;
use crate::mesh::{self, Mesh};

/// Whether each of the rectangles under a key has room in the memory and is of the body: before the first step, and not hours after it.
pub(super) fn check(of: &Values, key: &str, rule: &dyn Rule, first: &Mesh) -> Result<()> {
    let check = |one: &Values| {
        let (size, cells) = rectangle(one);
        rule.has_room(key, cells[0].saturating_mul(cells[1]))?;
        match same::difference(&mesh::rectangle(size, [1, 1])?, first) {
            None => Ok(()),
            Some(what) => {
                Err(rule.wrong(key, format!("the rectangle is not the body: {what}"), "give the size of the body"))
            }
        }
    };
    of.tables(key).iter().try_for_each(check)
}

/// The next of the rectangles under a key.
pub(super) fn make(of: &Values, key: &str, rule: &dyn Rule, count: usize) -> Result<Mesh> {
    let all = of.tables(key);
    let (size, cells) = rectangle(&all[count % all.len()]);
    rule.has_room(key, cells[0].saturating_mul(cells[1]))?;
    Ok(mesh::rectangle(size, cells)?)
}
