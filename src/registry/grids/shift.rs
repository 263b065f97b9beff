//! Inner nodes moved.

use super::{Present, Rule, Values};
use crate::error::Result;
use crate::mesh::{self, Mesh, map};

// There and back: nodes that went the same way each time would leave their cells.
pub(super) fn make(of: &Values, rule: &dyn Rule, count: usize, present: &Present) -> Result<Mesh> {
    let sign = if count.is_multiple_of(2) { 1.0 } else { -1.0 };
    moved(of, rule, sign, present.view.mesh)
}

pub(super) fn check(of: &Values, rule: &dyn Rule, first: &Mesh) -> Result<()> {
    if rule.is_alone() { moved(of, rule, 1.0, first).map(drop) } else { Ok(()) }
}

/// The nodes moved one way; a shift that turns a cell inside out is refused.
fn moved(of: &Values, rule: &dyn Rule, sign: f64, mesh: &Mesh) -> Result<Mesh> {
    let remedy = "shift by a part of the smallest cell; each second time the nodes go back";
    let by = of.vector("shift").map(|by| sign * by);
    shifted(mesh, by).map_err(|turned| rule.wrong("shift", turned.to_string(), remedy))
}

/// Nodes that lie inside of one group of cells, moved.
fn shifted(mesh: &Mesh, by: [f64; 2]) -> std::result::Result<Mesh, mesh::Error> {
    let mut fixed = vec![false; mesh.nodes.len()];
    let links = mesh::links(mesh)?;
    for (cell, links) in links.iter().enumerate() {
        for (face, link) in links.iter().enumerate() {
            let inner = matches!(link, mesh::Link::Cell { cell: other, .. } if mesh.cell_group[*other] == mesh.cell_group[cell]);
            if !inner {
                mesh.face_nodes(cell, face).into_iter().for_each(|node| fixed[node] = true);
            }
        }
    }
    let mut out = mesh.clone();
    for (x, _) in out.nodes.iter_mut().zip(fixed).filter(|(_, fixed)| !fixed) {
        *x = [x[0] + by[0], x[1] + by[1]];
    }
    // A node that leaves its cells may leave them all counter-clockwise: turned cells are refused, too.
    let turned = (0..out.cells.len()).find(|&cell| map::h_e(&out.map(cell)) <= 0.0);
    match turned {
        Some(cell) => Err(mesh::Error::Turned { cell: out.number(cell), at: out.corners(cell)[0] }),
        None => out.checked(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_nodes_inside_of_a_group_are_shifted() {
        let mesh = mesh::rectangle([1.0, 1.0], [4, 4]).unwrap();
        let moved = shifted(&mesh, [0.05, -0.02]).unwrap();
        let changed = (0..25).filter(|&k| mesh.nodes[k] != moved.nodes[k]).count();
        assert_eq!((changed, moved.nodes[6]), (9, [0.3, 0.23]));
        assert!(shifted(&mesh, [0.3, 0.0]).is_err());
    }
}
