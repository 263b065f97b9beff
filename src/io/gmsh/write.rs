//! Writes MSH 4.1 as text, which Gmsh and meshio read too.

use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;

use super::{LINE, LINE_3, QUAD, QUAD_9};
use crate::error::Result;
use crate::io::middles::Middles;
use crate::io::pending::write_text;
use crate::mesh::Mesh;

/// Writes a mesh as MSH 4.1 text: the whole file, or nothing.
pub fn write(mesh: &Mesh, path: &Path) -> Result<()> {
    write_text(path, &to_text(mesh))
}

/// The MSH 4.1 text of a mesh: one curve per boundary group, one surface per cell group, both numbered from 1.
///
/// Cells keep their original numbers if those are distinct and above 0, else they are numbered from 1; reading the text
/// gives the same mesh if all nodes and groups are used and edges are ordered by group, cell and face.
pub fn to_text(mesh: &Mesh) -> String {
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    // Writing to a String cannot fail.
    let _ = names(mesh, &mut text)
        .and_then(|()| entities(mesh, &mut text))
        .and_then(|()| nodes(mesh, &mut text))
        .and_then(|()| elements(mesh, &mut text));
    text
}

fn names(mesh: &Mesh, text: &mut String) -> std::fmt::Result {
    writeln!(text, "$PhysicalNames\n{}", mesh.edge_groups.len() + mesh.groups.len())?;
    for (dimension, names) in [(1, &mesh.edge_groups), (2, &mesh.groups)] {
        for (group, name) in names.iter().enumerate() {
            writeln!(text, "{dimension} {} \"{}\"", group + 1, name.replace(['\n', '\r'], " "))?;
        }
    }
    writeln!(text, "$EndPhysicalNames")
}

fn entities(mesh: &Mesh, text: &mut String) -> std::fmt::Result {
    let start = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let [x0, y0, x1, y1] =
        mesh.nodes.iter().fold(start, |b, x| [b[0].min(x[0]), b[1].min(x[1]), b[2].max(x[0]), b[3].max(x[1])]);
    writeln!(text, "$Entities\n0 {} {} 0", mesh.edge_groups.len(), mesh.groups.len())?;
    for group in (1..=mesh.edge_groups.len()).chain(1..=mesh.groups.len()) {
        writeln!(text, "{group} {x0:?} {y0:?} 0 {x1:?} {y1:?} 0 1 {group} 0")?;
    }
    writeln!(text, "$EndEntities")
}

fn nodes(mesh: &Mesh, text: &mut String) -> std::fmt::Result {
    let more = Middles::of(mesh);
    let count = mesh.nodes.len() + more.places.len();
    writeln!(text, "$Nodes\n1 {count} 1 {count}\n2 1 0 {count}")?;
    for node in 1..=count {
        writeln!(text, "{node}")?;
    }
    for [x, y] in mesh.nodes.iter().chain(&more.places) {
        // `{:?}` is the shortest text that reads back to the same bits.
        writeln!(text, "{x:?} {y:?} 0")?;
    }
    writeln!(text, "$EndNodes")
}

fn elements(mesh: &Mesh, text: &mut String) -> std::fmt::Result {
    let distinct: HashSet<u64> = mesh.original.iter().copied().filter(|n| *n > 0).collect();
    let keep = distinct.len() == mesh.cells.len();
    let number = |cell: usize| if keep { mesh.original[cell] } else { cell as u64 + 1 };
    let largest = (0..mesh.cells.len()).map(number).max().unwrap_or(0);
    let smallest = (0..mesh.cells.len()).map(number).min().unwrap_or(0);

    let middles = Middles::of(mesh);
    let [edge_kind, cell_kind] = if middles.places.is_empty() { [LINE, QUAD] } else { [LINE_3, QUAD_9] };
    let edges = |group: usize| mesh.edges.iter().filter(move |e| e.group == group);
    let cells = |group: usize| (0..mesh.cells.len()).filter(move |&c| mesh.cell_group[c] == group);
    let curves: Vec<usize> = (0..mesh.edge_groups.len()).filter(|&g| edges(g).next().is_some()).collect();
    let surfaces: Vec<usize> = (0..mesh.groups.len()).filter(|&g| cells(g).next().is_some()).collect();
    let (blocks, count) = (curves.len() + surfaces.len(), mesh.edges.len() + mesh.cells.len());
    writeln!(text, "$Elements\n{blocks} {count} {smallest} {}", largest.saturating_add(mesh.edges.len() as u64))?;
    let mut line = largest;
    for group in curves {
        writeln!(text, "1 {} {edge_kind} {}", group + 1, edges(group).count())?;
        for edge in edges(group) {
            line = line.saturating_add(1);
            let [a, b] = mesh.face_nodes(edge.cell, edge.face).map(|node| node + 1);
            writeln!(text, "{line} {a} {b}{}", middles.text(edge.cell, &[edge.face]))?;
        }
    }
    for group in surfaces {
        writeln!(text, "2 {} {cell_kind} {}", group + 1, cells(group).count())?;
        for cell in cells(group) {
            let [a, b, c, d] = mesh.cells[cell].map(|node| node + 1);
            writeln!(text, "{} {a} {b} {c} {d}{}", number(cell), middles.text(cell, &[2, 1, 3, 0, 4]))?;
        }
    }
    writeln!(text, "$EndElements")
}
