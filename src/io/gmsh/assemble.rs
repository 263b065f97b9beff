//! From the contents of a file to a mesh.

use std::collections::{BTreeMap, HashMap};

use super::error::Error;
use super::kinds::Kind;
use super::{Element, Middles, Raw};
use crate::mesh::map::{self, Bulge};
use crate::mesh::{BoundaryEdge, Mesh};

/// Largest |z| that counts as 0, relative to the extent in x and y: it allows for rounding in a rotated or computed plane.
const FLAT: f64 = 1e-10;

/// The mesh of the quadrilaterals of a file, checked and oriented.
pub fn mesh(mut raw: Raw) -> Result<Mesh, Error> {
    usable(&raw)?;
    tagged(&raw)?;
    raw.quads.sort_by_key(|quad| quad.number);
    distinct(&raw)?;
    let (nodes, cells) = nodes(&mut raw)?;
    let bulges = bulges(&raw, &nodes, &cells)?;
    let (groups, cell_group) = cell_groups(&raw)?;
    let (edge_groups, edges) = edges(&raw, &nodes, &cells)?;
    let mesh = Mesh {
        nodes: nodes.iter().map(|(_, x)| [x[0], x[1]]).collect(),
        cells,
        cell_group,
        groups,
        edges,
        edge_groups,
        original: raw.quads.iter().map(|quad| quad.number).collect(),
        bulges,
    };
    let mut mesh = mesh.checked()?;
    // Only after the check, because the check may turn cells.
    mesh.edges.sort_unstable_by_key(|edge| (edge.group, edge.cell, edge.face));
    mesh.edges.dedup();
    Ok(mesh)
}

/// An error if there are elements that are no quadrilaterals of order 1 or 2, lines or points: first solids, then higher
/// orders, then triangles.
fn usable(raw: &Raw) -> Result<(), Error> {
    let refused = raw.refused.iter().filter_map(|(&kind, &(count, first))| Some((Kind::of(kind)?, count, first)));
    match refused.max_by_key(|(kind, _, _)| (kind.dimension == 3, kind.order, kind.dimension)) {
        Some((kind, count, first)) => Err(Error::Element { kind, count, first }),
        None => Ok(()),
    }
}

/// Refuses a file of MSH 2.2 that names groups of lines or surfaces and has no element in any of them.
fn tagged(raw: &Raw) -> Result<(), Error> {
    let names: Vec<String> = raw
        .names
        .iter()
        .filter(|((dimension, _), _)| [1, 2].contains(dimension))
        .map(|(_, name)| format!("`{name}`"))
        .collect();
    let none = raw.quads.iter().all(|quad| quad.group == 0) && raw.lines.iter().all(|line| line.group == 0);
    let count = raw.quads.len() + raw.lines.len();
    if raw.entities || names.is_empty() || count == 0 || !none {
        return Ok(());
    }
    Err(Error::NoTags { count, names })
}

/// Refuses numbers and quadrilaterals that are given twice. MSH 2.2 repeats an element for each of its physical groups.
fn distinct(raw: &Raw) -> Result<(), Error> {
    let mut seen: HashMap<[u64; 4], &Element<4>> = HashMap::with_capacity(raw.quads.len());
    for quad in &raw.quads {
        let mut key = quad.nodes;
        key.sort_unstable();
        let Some(other) = seen.insert(key, quad) else { continue };
        if other.group == quad.group {
            return Err(Error::RepeatedElement(other.number, quad.number));
        }
        let names = [other.group, quad.group].map(|tag| format!("`{}`", raw.name(2, tag))).to_vec();
        return Err(Error::ManyGroups { what: format!("quadrilateral {}", quad.number), names });
    }
    match raw.quads.windows(2).find(|pair| pair[0].number == pair[1].number) {
        Some(pair) => Err(Error::RepeatedElement(pair[0].number, pair[1].number)),
        None => Ok(()),
    }
}

/// The nodes of the quadrilaterals in the order of their numbers, and the cells by indices into them.
#[expect(clippy::type_complexity, reason = "two lists, used once")]
fn nodes(raw: &mut Raw) -> Result<(Vec<(u64, [f64; 3])>, Vec<[usize; 4]>), Error> {
    raw.nodes.sort_by_key(|node| node.0);
    if let Some(pair) = raw.nodes.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        return Err(Error::RepeatedNode(pair[0].0));
    }
    let mut used = vec![false; raw.nodes.len()];
    let mut cells = Vec::with_capacity(raw.quads.len());
    for quad in &raw.quads {
        let mut cell = [0; 4];
        for (index, node) in cell.iter_mut().zip(quad.nodes) {
            let unknown = |_| Error::UnknownNode { element: quad.number, node };
            *index = raw.nodes.binary_search_by_key(&node, |n| n.0).map_err(unknown)?;
            used[*index] = true;
        }
        cells.push(cell);
    }
    let mut new = vec![0; raw.nodes.len()];
    let mut nodes = Vec::with_capacity(raw.nodes.len());
    for (index, _) in used.iter().enumerate().filter(|(_, used)| **used) {
        new[index] = nodes.len();
        nodes.push(raw.nodes[index]);
    }
    cells.iter_mut().flatten().for_each(|node| *node = new[*node]);
    in_plane(&nodes)?;
    Ok((nodes, cells))
}

/// How the edges of the quadrilaterals are curved, by the nodes in their middles; empty where all are straight.
fn bulges(raw: &Raw, nodes: &[(u64, [f64; 3])], cells: &[[usize; 4]]) -> Result<Vec<Bulge>, Error> {
    if raw.middles.is_empty() {
        return Ok(if raw.bulges.len() == cells.len() { raw.bulges.clone() } else { vec![] });
    }
    let of_quad: HashMap<u64, &Middles> = raw.middles.iter().map(|middles| (middles.number, middles)).collect();
    let mut seen: Vec<(u64, [f64; 3])> = nodes.to_vec();
    let mut find = |element: u64, node: u64| {
        let unknown = |_| Error::UnknownNode { element, node };
        let at = raw.nodes.binary_search_by_key(&node, |n| n.0).map_err(unknown)?;
        seen.push(raw.nodes[at]);
        Ok::<[f64; 2], Error>([raw.nodes[at].1[0], raw.nodes[at].1[1]])
    };
    let mut out = vec![Bulge::default(); cells.len()];
    for ((quad, cell), bulge) in raw.quads.iter().zip(cells).zip(&mut out) {
        let Some(middles) = of_quad.get(&quad.number) else { continue };
        let mut faces = [[0.0; 2]; 4];
        for (face, node) in SIDES.into_iter().zip(middles.edges) {
            faces[face] = find(quad.number, node)?;
        }
        let own = middles.own.map(|node| find(quad.number, node)).transpose()?;
        let corners = cell.map(|node| [nodes[node].1[0], nodes[node].1[1]]);
        *bulge = map::bulge_of(&corners, faces, own).unwrap_or_default();
    }
    in_plane(&seen)?;
    let straight = out.iter().all(|bulge| *bulge == Bulge::default());
    Ok(if straight { vec![] } else { out })
}

/// Local faces in the order of the edges of an element, from corner k to corner k + 1.
pub(super) const SIDES: [usize; 4] = [2, 1, 3, 0];

fn in_plane(nodes: &[(u64, [f64; 3])]) -> Result<(), Error> {
    let extent = [0, 1].map(|i| {
        let range = nodes.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), (_, x)| (a.min(x[i]), b.max(x[i])));
        range.1 - range.0
    });
    let limit = FLAT * extent[0].max(extent[1]);
    match nodes.iter().find(|(_, x)| x[2].is_nan() || x[2].abs() > limit) {
        Some(&(node, at)) => Err(Error::NotPlane { node, at }),
        None => Ok(()),
    }
}

/// Names of the groups of quadrilaterals, and the group of each.
fn cell_groups(raw: &Raw) -> Result<(Vec<String>, Vec<usize>), Error> {
    let without = || raw.quads.iter().filter(|quad| quad.group == 0);
    if !raw.surfaces {
        return Ok((vec!["body".to_owned()], vec![0; raw.quads.len()]));
    }
    if let Some(quad) = without().next() {
        return Err(Error::NoGroup { count: without().count(), first: quad.number });
    }
    let (names, index) = groups(raw, 2, raw.quads.iter().map(|quad| quad.group));
    Ok((names, raw.quads.iter().map(|quad| index[&quad.group]).collect()))
}

/// Names of the physical groups that are used, in the order of their tags, and the index of each tag; tags of one name are one group.
fn groups(raw: &Raw, dimension: i32, used: impl Iterator<Item = i32>) -> (Vec<String>, BTreeMap<i32, usize>) {
    let mut index: BTreeMap<i32, usize> = used.map(|tag| (tag, 0)).collect();
    let mut names: Vec<String> = Vec::new();
    for (&tag, at) in &mut index {
        let name = raw.name(dimension, tag);
        *at = names.iter().position(|n| *n == name).unwrap_or(names.len());
        if *at == names.len() {
            names.push(name);
        }
    }
    (names, index)
}

/// Names of the boundary groups, and for each line of a physical curve its face. For an inner edge it is the face of
/// the cell with the lower index.
fn edges(
    raw: &Raw,
    nodes: &[(u64, [f64; 3])],
    cells: &[[usize; 4]],
) -> Result<(Vec<String>, Vec<BoundaryEdge>), Error> {
    let tagged = || raw.lines.iter().filter(|line| line.group != 0);
    let (names, index) = groups(raw, 1, tagged().map(|line| line.group));
    let key = |nodes: [u64; 2]| [nodes[0].min(nodes[1]), nodes[0].max(nodes[1])];
    let mut faces: HashMap<[u64; 2], Option<(usize, usize)>> = tagged().map(|line| (key(line.nodes), None)).collect();
    for (cell, corners) in cells.iter().enumerate() {
        for (face, ends) in crate::mesh::FACE_CORNERS.iter().enumerate() {
            if let Some(found) = faces.get_mut(&key(ends.map(|corner| nodes[corners[corner]].0))) {
                found.get_or_insert((cell, face));
            }
        }
    }
    let face = |line: &Element<2>| faces.get(&key(line.nodes)).copied().flatten();
    if let Some(line) = tagged().find(|line| face(line).is_none()) {
        let count = tagged().filter(|other| other.group == line.group && face(other).is_none()).count();
        return Err(Error::Stray { name: raw.name(1, line.group), count, first: line.number });
    }
    let edges = tagged()
        .filter_map(|line| face(line).map(|(cell, face)| BoundaryEdge { cell, face, group: index[&line.group] }))
        .collect();
    Ok((names, edges))
}
