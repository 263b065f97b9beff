//! From the grids of a file to a mesh.

use super::tags::{self, Line};
use super::{Of, Part, Tags};
use crate::error::{Error, Place, Result};
use crate::file::memory;
use crate::io::gmsh::{self, Element, Kind, Middles, Raw};
use crate::mesh::{BoundaryEdge, Error as MeshError, FACE_CORNERS, Mesh, faces::neighbours, links};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Cells that are in no group.
const BODY: &str = "body";
/// Boundary edges that are in no group.
const BOUNDARY: &str = "boundary";
/// The data of an export of this program that have the numbers of cells in the file that its mesh came from.
const NUMBERS: &str = "cell";

const NO_MESH: &str = "it has no mesh: no grid of it has points and quadrilaterals";
/// A share of the largest coordinate by which nodes may lie beside the plane: rounding of other programs.
const FLAT: f64 = 1e-10;

/// Bytes of a cell and what is looked up by it, as `MESH` of `problem::room`.
const CELL: u64 = 500;

/// The file that a mesh comes from, for messages.
pub struct Source<'a> {
    /// Its path.
    pub path: &'a Path,
}

impl Source<'_> {
    /// An error of this file.
    pub fn error(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::at(Place::file(self.path), what, remedy)
    }
}

/// The mesh of the first grid with quadrilaterals: its cells and nodes in the order of the file, and its groups in that of their
/// numbers. `beside` are the grids of the file of the lines, if there is one.
///
/// # Errors
/// No grid with quadrilaterals; whatever a mesh of Gmsh is refused for; data that do not name groups.
pub fn assemble(mut parts: Vec<Part>, beside: Vec<Part>, tags: &Tags, source: &Source) -> Result<Mesh> {
    let is_mesh = |part: &Part| part.points.is_some() && !part.cells.quads.is_empty();
    let has_surfaces = |part: &Part| part.points.is_some() && !part.cells.refused.is_empty();
    let at = parts
        .iter()
        .position(is_mesh)
        .or_else(|| parts.iter().position(has_surfaces))
        .ok_or_else(|| source.error(NO_MESH, "write the mesh with its cells into it"))?;
    let mut mesh = parts.remove(at);
    let bytes = (mesh.cells.count as u64).saturating_mul(CELL);
    memory::check(bytes).map_err(|why| source.error(why, "give fewer cells"))?;
    merge(&mut mesh, source)?;
    let others: Vec<&Part> = parts.iter().chain(&beside).collect();
    tags::check_wanted(std::iter::once(&mesh).chain(others.iter().copied()), tags, source)?;
    let cells = tags::of_cells(&mesh, &others, tags, source)?;
    let lines = match (&mesh.own_edges, &beside[..]) {
        (Some(edges), _) => own_lines(&mesh, edges, source)?,
        (None, []) => tags::of_lines(&mesh, &std::iter::once(&mesh).chain(others).collect::<Vec<_>>(), tags, source)?,
        (None, all) => tags::of_lines(&mesh, &all.iter().collect::<Vec<_>>(), tags, source)?,
    };
    let mut groups = Groups::new(std::iter::once(&mesh).chain(&parts).chain(&beside));
    let used = [
        (Of::Cells, numbers(cells.iter().flatten().copied().flatten())),
        (Of::Edges, numbers(lines.iter().map(|line| line.2))),
    ];
    groups.rename(tags, &used, source)?;
    let raw = groups.raw(&mesh, cells.as_deref(), &lines, &used);
    let made = gmsh::assemble(raw).map_err(|why| in_words(why, source))?;
    let mut made = rest(made).with_common_axes();
    renumber(&mut made, &mesh)?;
    Ok(made)
}

/// The cells of the first grid with quadrilaterals and all of its nodes, in the order of the file and without groups: for data at nodes.
///
/// # Errors
/// No grid with quadrilaterals; cells of another kind, and whatever makes a cell unusable.
pub fn nodal(mut parts: Vec<Part>, source: &Source) -> Result<Mesh> {
    let has_cells = |part: &Part| !(part.cells.quads.is_empty() && part.cells.refused.is_empty());
    let at = parts.iter().position(|part| part.points.is_some() && has_cells(part));
    let part = parts.swap_remove(at.ok_or_else(|| source.error(NO_MESH, "give a file with cells and data at nodes"))?);
    let points = part.points.unwrap_or_default();
    if part.own_edges.is_some() && points.len() != 4 * part.cells.quads.len() {
        return Err(source.error("its cells are quadrilaterals of a higher degree than 1", super::OWN));
    }
    let bytes = (part.cells.count as u64).saturating_mul(CELL);
    memory::check(bytes).map_err(|why| source.error(why, "give fewer cells"))?;
    if !part.cells.middles.is_empty() {
        let remedy = "give the fields on cells of 4 nodes";
        return Err(
            source.error("its cells are quadrilaterals of order 2, and fields are taken from cells of order 1", remedy)
        );
    }
    if let Some((kind, &(count, first))) = part.cells.refused.iter().find_map(|(k, of)| Some((Kind::of(*k)?, of))) {
        return Err(in_words(gmsh::Error::Element { kind, count, first }, source));
    }
    let size = points.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    // NaN is an error too.
    if let Some(k) = points.iter().position(|x| x[2].is_nan() || x[2].abs() > FLAT * size) {
        let what = format!("node {k} (from 0) has z = {}, and the body lies in the plane z = 0", points[k][2]);
        return Err(source.error(what, "give a grid in the plane"));
    }
    let mut mesh = Mesh { groups: vec![BODY.to_owned()], ..Mesh::default() };
    for &(cell, nodes) in &part.cells.quads {
        let unknown = |node: &&u64| **node >= points.len() as u64;
        if let Some(node) = nodes.iter().find(unknown) {
            return Err(unknown_node(cell as u64, *node, source));
        }
        mesh.cells.push(nodes.map(|node| node as usize));
        mesh.original.push(cell as u64);
    }
    mesh.nodes = points.into_iter().map(|[x, y, _]| [x, y]).collect();
    mesh.cell_group = vec![0; mesh.cells.len()];
    mesh.checked().map_err(|why| in_words(gmsh::Error::Mesh(why), source))
}

/// Different numbers in ascending order, each with its place from 1.
fn numbers(all: impl Iterator<Item = i64>) -> BTreeMap<i64, i32> {
    let mut different: BTreeMap<i64, i32> = all.map(|number| (number, 0)).collect();
    different.values_mut().zip(1..).for_each(|(place, next)| *place = next);
    different
}

/// In an export of this program each cell has points of its own: points in one place become one node.
fn merge(mesh: &mut Part, source: &Source) -> Result<()> {
    let (Some(_), Some(points)) = (&mesh.own_edges, &mut mesh.points) else { return Ok(()) };
    let (mut known, mut merged) = (HashMap::new(), Vec::new());
    for (cell, nodes) in &mut mesh.cells.quads {
        for node in nodes {
            let at = usize::try_from(*node).ok().and_then(|node| points.get(node));
            let x = *at.ok_or_else(|| unknown_node(*cell as u64, *node, source))?;
            *node = *known.entry(x.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                merged.push(x);
                merged.len() as u64 - 1
            });
        }
    }
    *points = merged;
    Ok(())
}

fn unknown_node(cell: u64, node: u64, source: &Source) -> Error {
    source.error(format!("cell {cell} (from 0) names node {node}, which the file does not have"), DAMAGED)
}

const DAMAGED: &str = "the file is damaged: write it again";

/// The edges of groups of an export of this program as lines.
fn own_lines(mesh: &Part, edges: &[[usize; 3]], source: &Source) -> Result<Vec<Line>> {
    let line = |&[cell, face, group]: &[usize; 3]| {
        let (quad, ends) = (mesh.cells.quads.get(cell)?, FACE_CORNERS.get(face)?);
        Some((cell as u64, ends.map(|corner| quad.1[corner]), i64::try_from(group).ok()?))
    };
    let all: Option<Vec<Line>> = edges.iter().map(line).collect();
    all.ok_or_else(|| source.error("an edge of a group is of a cell that is not there", DAMAGED))
}

/// The names of groups by their numbers.
struct Groups(super::Names);

impl Groups {
    fn new<'a, 'b: 'a>(parts: impl Iterator<Item = &'a Part<'b>>) -> Self {
        let mut names = super::Names::new();
        for (key, name) in parts.flat_map(|part| &part.names) {
            names.entry(*key).or_insert_with(|| name.clone());
        }
        Self(names)
    }

    /// Takes the names that are asked for.
    fn rename(&mut self, tags: &Tags, used: &[(Of, BTreeMap<i64, i32>); 2], source: &Source) -> Result<()> {
        for (of, number, name) in &tags.names {
            let known = used.iter().find(|(kind, _)| kind == of).map(|(_, known)| known);
            if !known.is_some_and(|known| known.contains_key(number)) {
                let what = if *of == Of::Cells { "cells" } else { "edges" };
                let all: Vec<String> = known.into_iter().flat_map(|known| known.keys()).map(i64::to_string).collect();
                let remedy = match all[..] {
                    [] => format!("its {what} have no numbers of groups"),
                    _ => format!("the groups of its {what} have the numbers {}", all.join(", ")),
                };
                return Err(source
                    .error(format!("no {what} have the number {number}, which is to be called \"{name}\""), remedy));
            }
            self.0.insert((*of, *number), name.clone());
        }
        Ok(())
    }

    fn name(&self, of: Of, number: i64) -> String {
        self.0.get(&(of, number)).cloned().unwrap_or_else(|| number.to_string())
    }

    /// The contents as those of a file of Gmsh, in which groups are numbered from 1.
    fn raw(
        &self,
        mesh: &Part,
        cells: Option<&[Option<i64>]>,
        lines: &[Line],
        used: &[(Of, BTreeMap<i64, i32>); 2],
    ) -> Raw {
        let mut raw = Raw { entities: true, surfaces: cells.is_some(), ..Raw::default() };
        for (of, known) in used {
            raw.names.extend(known.iter().map(|(&number, &place)| ((*of as i32, place), self.name(*of, number))));
        }
        let [of_cells, of_edges] = [&used[0].1, &used[1].1];
        // Cells that other data leave out.
        let rest = of_cells.len() as i32 + 1;
        raw.names.insert((Of::Cells as i32, rest), BODY.to_owned());
        let group = |place: usize| match cells.map(|all| all[place]) {
            None => 0,
            Some(number) => number.and_then(|number| of_cells.get(&number).copied()).unwrap_or(rest),
        };
        let points = mesh.points.iter().flatten().enumerate();
        raw.nodes = points.map(|(node, x)| (node as u64, *x)).collect();
        let quads = mesh.cells.quads.iter().enumerate();
        raw.quads = quads.map(|(k, &(cell, nodes))| Element { number: cell as u64, group: group(k), nodes }).collect();
        let middles = mesh.cells.middles.iter();
        raw.middles = middles.map(|&(cell, edges, own)| Middles { number: cell as u64, edges, own }).collect();
        raw.bulges.clone_from(&mesh.own_bulges);
        let line = |&(number, nodes, group): &Line| Element { number, group: of_edges[&group], nodes };
        raw.lines = lines.iter().map(line).collect();
        raw.refused.clone_from(&mesh.cells.refused);
        raw
    }
}

/// What is wrong with the contents, in words that do not speak of Gmsh.
fn in_words(why: gmsh::Error, source: &Source) -> Error {
    let (mut what, mut remedy) = (why.to_string(), why.remedy());
    match why {
        gmsh::Error::UnknownNode { element, node } => return unknown_node(element, node, source),
        gmsh::Error::Element { kind: Kind { .. }, count, first } => {
            what = what.replace(&format!("{count} element(s)"), &format!("{count} cell(s)"));
            what = what.replace(&format!("element {first}"), &format!("cell {first} (from 0)"));
        }
        gmsh::Error::ManyGroups { what: ref quad, ref names } => {
            what = format!("{quad} is given twice, in the groups {}", names.join(" and "));
            "give each cell once".clone_into(&mut remedy);
        }
        gmsh::Error::RepeatedElement(..) => "give each cell once".clone_into(&mut remedy),
        gmsh::Error::Stray { name, count, first } => {
            what = format!(
                "{count} line(s) of the group `{name}` are no edge of a quadrilateral, the first is cell {first} (from 0)"
            );
            "take the lines out of the group, or out of the file".clone_into(&mut remedy);
        }
        _ => {}
    }
    source.error(what, remedy)
}

/// Puts the boundary edges that are in no group into the group `boundary`. Where two bodies lie on each other without one, where a
/// node hangs, or where there is such a group, all stays as it is: what is checked later tells.
fn rest(mut mesh: Mesh) -> Mesh {
    if mesh.edge_groups.iter().any(|name| name == BOUNDARY) || !matches!(links(&mesh), Err(MeshError::Untagged { .. }))
    {
        return mesh;
    }
    let group = mesh.edge_groups.len();
    let tagged: std::collections::HashSet<(usize, usize)> =
        mesh.edges.iter().map(|edge| (edge.cell, edge.face)).collect();
    for (cell, beyond) in neighbours(&mesh).into_iter().enumerate() {
        let bare = (0..beyond.len()).filter(|&face| beyond[face].is_none() && !tagged.contains(&(cell, face)));
        mesh.edges.extend(bare.map(|face| BoundaryEdge { cell, face, group }));
    }
    mesh.edge_groups.push(BOUNDARY.to_owned());
    mesh
}

/// Gives the cells of an export the numbers that they had in the file that its mesh came from.
fn renumber(made: &mut Mesh, mesh: &Part) -> Result<()> {
    let data = mesh.data.iter().find(|data| mesh.own_edges.is_some() && data.name == NUMBERS);
    let Some(values) = data.map(|data| (data.values)()).transpose()? else { return Ok(()) };
    let number = |cell: &u64| {
        let x = usize::try_from(*cell).ok().and_then(|cell| values.get(cell)).copied()?;
        (x >= 0.0 && x.fract() == 0.0 && x < 9e15).then_some(x as u64)
    };
    let all: Option<Vec<u64>> = made.original.iter().map(number).collect();
    made.original = all.unwrap_or_else(|| made.original.clone());
    Ok(())
}
