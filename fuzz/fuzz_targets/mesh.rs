//! The import of a mesh, from its lists: checks, turned cells, neighbours, cuts, common axes, periodic groups.
#![no_main]

use arbitrary::Arbitrary;
use dgmpm::Mesh;
use dgmpm::parts::mesh::BoundaryEdge;
use libfuzzer_sys::fuzz_target;

#[derive(Debug, Arbitrary)]
struct Lists {
    nodes: Vec<[i8; 2]>,
    /// A coordinate that is any number.
    odd: Option<(u8, f64)>,
    cells: Vec<[u8; 4]>,
    groups: Vec<u8>,
    edges: Vec<(u8, u8, u8)>,
    cut: u8,
}

fuzz_target!(|lists: Lists| {
    let mut nodes: Vec<[f64; 2]> = lists.nodes.iter().map(|x| x.map(|x| f64::from(x) / 4.0)).collect();
    if let Some((at, x)) = lists.odd
        && let Some(node) = nodes.get_mut(usize::from(at))
    {
        node[0] = x;
    }
    let name = |k: usize| format!("group {k}");
    let count = lists.cells.len();
    let group = |c: usize| lists.groups.get(c).map_or(0, |&g| usize::from(g % 3));
    let edge = |&(cell, face, group): &(u8, u8, u8)| BoundaryEdge {
        cell: usize::from(cell),
        face: usize::from(face % 5),
        group: usize::from(group % 4),
    };
    let mesh = Mesh {
        nodes,
        cells: lists.cells.iter().map(|cell| cell.map(usize::from)).collect(),
        cell_group: (0..count).map(group).collect(),
        groups: (0..3).map(name).collect(),
        edges: lists.edges.iter().map(edge).collect(),
        edge_groups: (0..3).map(name).collect(),
        original: (1..=count as u64).collect(),
    };
    let Ok(mesh) = mesh.checked() else { return };
    assert_eq!(mesh.check(), Ok(()));
    let _ = dgmpm::links(&mesh);
    let _ = dgmpm::periodic_links(&mesh, &[[0, 1]]);
    let _ = mesh.clone().split(&[usize::from(lists.cut % 3)]);
    let _ = mesh.with_common_axes();
});
