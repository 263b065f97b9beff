//! Which data of a file name the groups, and the number of each cell.

use super::assemble::Source;
use super::{Data, Of, Part, Tags};
use crate::error::Result;
use crate::names;
use std::collections::{BTreeSet, HashMap};

/// Names that the numbers of groups usually have, the surest first: those of meshio, of DOLFINx, of its tutorials, of Medit, of this
/// program.
const USUAL: [&str; 9] = [
    "gmsh:physical",
    "cell_tags",
    "facet_tags",
    "mesh_tags",
    "Cell tags",
    "Facet tags",
    "name_to_read",
    "medit:ref",
    "group",
];

/// In this data 0 is no group: the line lies on no physical curve.
const PHYSICAL: &str = "gmsh:physical";

/// Different numbers beyond which data do not name groups: they rather number cells.
const MOST: usize = 1000;

/// The word for no data.
pub const NONE: &str = "none";

/// Data that may name groups.
#[derive(Clone, Copy)]
struct Candidate<'a, 'b> {
    part: &'a Part<'b>,
    data: &'a Data<'b>,
}

impl Candidate<'_, '_> {
    fn is_named(&self, name: &str) -> bool {
        self.data.name == name || self.part.name == name
    }

    /// Whether it may be taken without being named: data that programs add by themselves name nothing.
    fn is_likely(&self) -> bool {
        let name = &self.data.name;
        self.data.whole && !name.starts_with("vtk") && !name.starts_with("gmsh:")
    }
}

/// The data of some parts.
fn candidates<'a, 'b>(parts: impl Iterator<Item = &'a Part<'b>>) -> Vec<Candidate<'a, 'b>> {
    parts.flat_map(|part| part.data.iter().map(move |data| Candidate { part, data })).collect()
}

/// The data that name the groups: those that are asked for, those with a usual name, or the only likely ones.
fn chosen<'a, 'b>(
    all: &[Candidate<'a, 'b>],
    of: Of,
    tags: &Tags,
    source: &Source,
) -> Result<Option<Candidate<'a, 'b>>> {
    if let Some(wanted) = &tags.data {
        if let Some(found) = all.iter().find(|one| one.is_named(wanted)) {
            return Ok(Some(*found));
        }
        if wanted == NONE {
            return Ok(None);
        }
    }
    let usual = USUAL.iter().find_map(|name| all.iter().find(|one| one.is_named(name)));
    if let Some(usual) = usual {
        return Ok(Some(*usual));
    }
    let likely: Vec<&Candidate> = all.iter().filter(|one| one.is_likely()).collect();
    match likely[..] {
        [] => Ok(None),
        [one] => Ok(Some(*one)),
        _ => {
            let listed: Vec<&str> = likely.iter().map(|one| one.data.name.as_str()).collect();
            let (listed, first) = (listed.join(", "), listed[0]);
            let what = match of {
                Of::Cells => format!("several of its data could name the groups of cells: {listed}"),
                Of::Edges => format!("several of its data could name the groups of edges: {listed}"),
            };
            Err(source.error(
                what,
                format!(
                    "say which, such as groups = \"{first}\" in [mesh] of the scene or --groups {first}, or \"{NONE}\""
                ),
            ))
        }
    }
}

/// An error if the data that are asked for are nowhere.
pub fn check_wanted<'a, 'b: 'a>(parts: impl Iterator<Item = &'a Part<'b>>, tags: &Tags, source: &Source) -> Result<()> {
    let Some(wanted) = tags.data.as_deref().filter(|wanted| *wanted != NONE) else { return Ok(()) };
    let all = candidates(parts);
    if all.iter().any(|one| one.is_named(wanted)) {
        return Ok(());
    }
    let known: Vec<&str> = all.iter().map(|one| one.data.name.as_str()).collect();
    let remedy = match known[..] {
        [] => "it has no data at its cells: leave out `groups`".to_owned(),
        _ => format!("{}its data at cells are {}", names::did_you_mean(wanted, &known), known.join(", ")),
    };
    Err(source.error(format!("no data at its cells are named \"{wanted}\""), remedy))
}

/// The numbers of the groups of the quadrilaterals of `mesh`, in their order; none where no data name groups. Other parts have them
/// for some of its cells.
pub fn of_cells(mesh: &Part, others: &[&Part], tags: &Tags, source: &Source) -> Result<Option<Vec<Option<i64>>>> {
    let beside = others.iter().copied().filter(|part| !part.cells.quads.is_empty());
    let all = candidates(std::iter::once(mesh).chain(beside));
    let Some(found) = chosen(&all, Of::Cells, tags, source)? else { return Ok(None) };
    let numbers = numbers(&found, source)?;
    let quads = found.part.cells.quads.iter();
    if std::ptr::eq(found.part, mesh) {
        let own: Vec<Option<i64>> = quads.map(|(cell, _)| numbers[*cell]).collect();
        limited(own.iter().flatten().copied(), &found, source)?;
        return Ok(Some(own));
    }
    let place = places(found.part, mesh, source)?;
    let mut known = HashMap::with_capacity(found.part.cells.quads.len());
    for (cell, nodes) in quads {
        let mut key = [0; 4];
        for (key, node) in key.iter_mut().zip(nodes) {
            *key = place(*node)?;
        }
        key.sort_unstable();
        known.insert(key, numbers[*cell]);
    }
    let of = |nodes: &[u64; 4]| {
        let mut key = *nodes;
        key.sort_unstable();
        known.get(&key).copied().flatten()
    };
    let all: Vec<Option<i64>> = mesh.cells.quads.iter().map(|(_, nodes)| of(nodes)).collect();
    limited(all.iter().flatten().copied(), &found, source)?;
    Ok(Some(all))
}

/// A line of a group: the number of its cell, its nodes in the mesh, the number of the group.
pub type Line = (u64, [u64; 2], i64);

/// The lines that are in groups, of the parts that have lines.
pub fn of_lines(mesh: &Part, others: &[&Part], tags: &Tags, source: &Source) -> Result<Vec<Line>> {
    let all = candidates(others.iter().copied().filter(|part| !part.cells.lines.is_empty()));
    let Some(found) = chosen(&all, Of::Edges, tags, source)? else { return Ok(vec![]) };
    let numbers = numbers(&found, source)?;
    let place = places(found.part, mesh, source)?;
    let none = (found.data.name == PHYSICAL).then_some(0);
    let mut lines = Vec::with_capacity(found.part.cells.lines.len());
    for &(cell, [a, b]) in &found.part.cells.lines {
        let Some(number) = numbers[cell].filter(|number| Some(*number) != none) else { continue };
        lines.push((cell as u64, [place(a)?, place(b)?], number));
    }
    limited(lines.iter().map(|line| line.2), &found, source)?;
    Ok(lines)
}

/// The whole numbers of data, one for each cell of the part; none where it is not a number.
fn numbers(found: &Candidate, source: &Source) -> Result<Vec<Option<i64>>> {
    let values = (found.data.values)()?;
    let (name, count) = (&found.data.name, found.part.cells.count);
    if values.len() != count {
        let what = format!("`{name}` has {} numbers, and {count} cells need one each", values.len());
        return Err(source.error(what, "give one number for each cell"));
    }
    let whole = |x: f64| match x {
        x if x.is_nan() => Ok(None),
        // Beyond it the numbers that are whole are not all there.
        x if x.fract() == 0.0 && x.abs() < 9e15 => Ok(Some(x as i64)),
        _ => Err(source
            .error(format!("`{name}` has the value {x}: groups have whole numbers"), "name other data by `groups`")),
    };
    values.into_iter().map(whole).collect()
}

/// An error if there are so many different numbers that they are no groups.
fn limited(numbers: impl Iterator<Item = i64>, found: &Candidate, source: &Source) -> Result<()> {
    let mut different = BTreeSet::new();
    for number in numbers {
        different.insert(number);
        if different.len() > MOST {
            let what = format!("`{}` has more than {MOST} different numbers: it does not name groups", found.data.name);
            return Err(source.error(what, "name other data by `groups` in [mesh] of the scene or by --groups"));
        }
    }
    Ok(())
}

/// The number in the mesh of a node of another part.
type Place<'a> = Box<dyn Fn(u64) -> Result<u64> + 'a>;

/// Nodes of a part by its points: where it has points of its own, those of the mesh in the same places.
fn places<'a>(part: &'a Part, mesh: &'a Part, source: &'a Source) -> Result<Place<'a>> {
    let (Some(own), Some(points)) = (&part.points, &mesh.points) else { return Ok(Box::new(Ok)) };
    if std::ptr::eq(part, mesh) {
        return Ok(Box::new(Ok));
    }
    // Zeros of both signs are one place.
    let key = |x: &[f64; 3]| [x[0] + 0.0, x[1] + 0.0].map(f64::to_bits);
    let known: HashMap<[u64; 2], u64> = points.iter().enumerate().map(|(node, x)| (key(x), node as u64)).collect();
    Ok(Box::new(move |node| {
        let at = usize::try_from(node).ok().and_then(|node| own.get(node));
        let fail = |what: String| source.error(what, "write both from one mesh");
        let at = at.ok_or_else(|| fail(format!("a cell of `{}` names node {node}, which is not there", part.name)))?;
        let found = known.get(&key(at)).copied();
        found.ok_or_else(|| fail(format!("the point ({}, {}) of `{}` is no node of the mesh", at[0], at[1], part.name)))
    }))
}
