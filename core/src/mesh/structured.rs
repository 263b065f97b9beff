//! Structured meshes: a rectangle of equal cells.

use super::{BoundaryEdge, Error, Mesh};

/// The rectangle `[0, size[0]] x [0, size[1]]` of `cells[0] x cells[1]` equal cells.
///
/// Cell `(ix, iy)` has the index `ix + cells[0] iy`, its corner 0 is the lower left one, so xi1 runs along x and
/// xi2 along y. Group `body`; edge groups `left`, `right`, `bottom`, `top`, in this order.
pub fn rectangle(size: [f64; 2], cells: [usize; 2]) -> Result<Mesh, Error> {
    let [nx, ny] = cells;
    let extent = size.iter().all(|s| s.is_finite() && *s > 0.0);
    // 2^32 cells need more memory than any machine has, and the product must not overflow.
    let count = nx.checked_mul(ny).filter(|n| (1..1 << 32).contains(n));
    let (true, Some(count)) = (extent, count) else {
        return Err(Error::Rectangle { size, cells });
    };
    let node = |ix: usize, iy: usize| ix + (nx + 1) * iy;
    // First the fraction: it is exactly 1 at the last node, so that this node lies exactly at the size.
    let at = |i: usize, axis: usize| size[axis] * (i as f64 / cells[axis] as f64);
    let edge = |cell: usize, face: usize| BoundaryEdge { cell, face, group: face };
    let edges = (0..ny)
        .map(|iy| edge(nx * iy, 0))
        .chain((0..ny).map(|iy| edge(nx * iy + nx - 1, 1)))
        .chain((0..nx).map(|ix| edge(ix, 2)))
        .chain((0..nx).map(|ix| edge(nx * (ny - 1) + ix, 3)))
        .collect();
    Ok(Mesh {
        nodes: (0..=ny).flat_map(|iy| (0..=nx).map(move |ix| [at(ix, 0), at(iy, 1)])).collect(),
        cells: (0..ny)
            .flat_map(|iy| {
                (0..nx).map(move |ix| [node(ix, iy), node(ix + 1, iy), node(ix + 1, iy + 1), node(ix, iy + 1)])
            })
            .collect(),
        cell_group: vec![0; count],
        groups: vec!["body".to_owned()],
        edges,
        edge_groups: ["left", "right", "bottom", "top"].map(str::to_owned).to_vec(),
        bulges: vec![],
        original: (1..=count as u64).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_run_row_by_row_with_x_fastest() {
        let mesh = rectangle([3.0, 1.0], [3, 2]).unwrap();
        assert_eq!(mesh.corners(4), [[1.0, 0.5], [2.0, 0.5], [2.0, 1.0], [1.0, 1.0]]);
        assert_eq!((mesh.cells.len(), mesh.nodes.len(), mesh.edges.len()), (6, 12, 10));
    }

    #[test]
    fn the_last_node_lies_exactly_at_the_size() {
        let mesh = rectangle([0.3, 0.7], [7, 3]).unwrap();
        assert_eq!(mesh.nodes.last(), Some(&[0.3, 0.7]));
    }

    #[test]
    fn edge_groups_are_where_their_names_say() {
        let mesh = rectangle([3.0, 2.0], [3, 2]).unwrap();
        for edge in &mesh.edges {
            let ends = mesh.face_nodes(edge.cell, edge.face).map(|n| mesh.nodes[n]);
            let (axis, value) = [(0, 0.0), (0, 3.0), (1, 0.0), (1, 2.0)][edge.group];
            assert!(ends.iter().all(|x| x[axis] == value), "{edge:?} at {ends:?}");
        }
        assert_eq!(mesh.edge_groups, ["left", "right", "bottom", "top"]);
    }

    #[test]
    fn senseless_sizes_are_refused() {
        let refused = |size, cells| assert!(rectangle(size, cells).is_err(), "{size:?} {cells:?}");
        refused([0.0, 1.0], [1, 1]);
        refused([1.0, -1.0], [1, 1]);
        refused([f64::NAN, 1.0], [1, 1]);
        refused([1.0, f64::INFINITY], [1, 1]);
        refused([1.0, 1.0], [0, 1]);
        refused([1.0, 1.0], [usize::MAX, 2]);
    }
}
