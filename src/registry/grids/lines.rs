//! Meshes of cells between lines.

use crate::mesh::{self, Mesh};

/// The mesh of cells between lines, with the groups of `like`, whose four sides bear one group each.
pub(super) fn grid_of_lines(like: &Mesh, lines: [Vec<f64>; 2]) -> std::result::Result<Mesh, String> {
    let [nx, ny] = [lines[0].len() - 1, lines[1].len() - 1];
    let mut mesh = mesh::rectangle([1.0, 1.0], [nx, ny]).map_err(|why| why.to_string())?;
    for (node, x) in mesh.nodes.iter_mut().enumerate() {
        *x = [lines[0][node % (nx + 1)], lines[1][node / (nx + 1)]];
    }
    // Sides left, right, bottom, top of the new mesh by the groups that stand there in the other.
    let ends = [0, 1].map(|axis| [lines[axis][0], lines[axis][lines[axis].len() - 1]]);
    let mut side = [None; 4];
    for edge in &like.edges {
        let x = like.face_nodes(edge.cell, edge.face).map(|node| like.nodes[node]);
        let on = |axis: usize, end: usize| {
            x.iter().all(|x| (x[axis] - ends[axis][end]).abs() <= 1e-12 * ends[axis][1].abs())
        };
        let Some(k) = (0..4).find(|&k| on(k / 2, k % 2)) else { continue };
        if side[k].is_some_and(|other| other != edge.group) {
            return Err("a side of the mesh has edges of two groups".to_owned());
        }
        side[k] = Some(edge.group);
    }
    let mut found = [0; 4];
    for (found, side) in found.iter_mut().zip(side) {
        *found = side.ok_or("a side of the mesh has no group")?;
    }
    mesh.edges.iter_mut().for_each(|edge| edge.group = found[edge.group]);
    mesh.edge_groups = like.edge_groups.clone();
    if like.groups.len() != 1 {
        return Err("the mesh has several groups of cells".to_owned());
    }
    mesh.groups = like.groups.clone();
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_of_lines_keep_the_groups_of_their_sides() {
        let mut like = mesh::rectangle([2.0, 1.0], [4, 2]).unwrap();
        like.edge_groups.rotate_left(1);
        like.edges.iter_mut().for_each(|edge| edge.group = (edge.group + 3) % 4);
        let mesh = grid_of_lines(&like, [vec![0.0, 0.5, 2.0], vec![0.0, 0.25, 0.5, 1.0]]).unwrap();
        assert_eq!((mesh.cells.len(), mesh.corners(5)[2]), (6, [2.0, 1.0]));
        for edge in &mesh.edges {
            let name = mesh.edge_groups[edge.group].as_str();
            let x = mesh.face_nodes(edge.cell, edge.face).map(|node| mesh.nodes[node]);
            let (axis, value) = [("left", 0, 0.0), ("right", 0, 2.0), ("bottom", 1, 0.0), ("top", 1, 1.0)]
                .into_iter()
                .find(|(known, ..)| *known == name)
                .map(|(_, axis, value)| (axis, value))
                .unwrap();
            assert!(x.iter().all(|x| x[axis] == value), "{name}: {x:?}");
        }
    }
}
