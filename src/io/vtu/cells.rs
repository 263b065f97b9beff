//! The grid of a VTU file: points, cells, data at the cells, names of groups.
//!
//! Names are arrays of `FieldData` that are called as the group and have two numbers: the number of the group, and 1 for edges or 2
//! for cells, as meshio has them. Exports of this program have the edges of groups there too, see [`EDGES`].

use super::read::{Array, Document, Section};
use crate::error::Result;
use crate::file::memory;
use crate::io::unstructured::{Data, Of, Part, of_vtk};
use std::rc::Rc;

/// The array of `FieldData` that only exports of this program have: edges of groups as cell, local face, number of the group.
pub const EDGES: &str = "dgmpm_edges";
/// The name of the array of how the edges of cells are curved, 10 numbers a cell: [`crate::mesh::Mesh::bulges`].
pub const CURVES: &str = "dgmpm_curves";

/// What is read of a file.
const SECTIONS: &[Section] = &[Section::Place, Section::Cells, Section::CellData, Section::FieldData];

/// Bytes that a point, a cell and a node of a cell take until they are a mesh.
const POINT: u64 = 100;
/// As `MESH` of `problem::room` for a cell.
const CELL: u64 = 500;
/// Bytes, a number of 8 bytes, a number of a point.
const NODE: u64 = 24;

/// Names of groups beyond which a file is refused.
const NAMES: usize = 10_000;

/// Reads the grid of a file; `fault` makes an error of what is wrong with the values of data that are read later.
///
/// # Errors
/// What is wrong, in words.
pub fn part<'a>(bytes: &'a [u8], fault: &'a dyn Fn(String) -> crate::Error) -> std::result::Result<Part<'a>, String> {
    let document = Rc::new(Document::read(bytes, SECTIONS)?);
    let total = |k: usize| document.pieces.iter().fold(0_u64, |sum, piece| sum.saturating_add(piece[k] as u64));
    // Compressed arrays may be a thousand times as large as the file.
    memory::check(total(0).saturating_mul(POINT).saturating_add(total(1).saturating_mul(CELL)))?;
    let mut part = Part { points: Some(document.points()?), ..Part::default() };
    for array in document.arrays.iter().filter(|array| array.section == Section::FieldData) {
        field(&document, array, &mut part)?;
    }
    let mut base = 0;
    for (piece, &[points, cells]) in document.pieces.iter().enumerate() {
        add_cells(&document, (piece, cells), base, &mut part)?;
        base += points as u64;
    }
    let mut known: Vec<&str> = Vec::new();
    for array in document.arrays.iter().filter(|array| array.section == Section::CellData && array.components == 1) {
        // The same name stands in each piece; those of the first piece are all.
        if array.piece == 0 && !known.contains(&array.name.as_str()) {
            known.push(&array.name);
            part.data.push(data(&document, array, fault));
        }
    }
    Ok(part)
}

/// Numbers at the cells of all pieces.
fn data<'a>(document: &Rc<Document<'a>>, array: &Array, fault: &'a dyn Fn(String) -> crate::Error) -> Data<'a> {
    let (document, name) = (Rc::clone(document), array.name.clone());
    let wanted = name.clone();
    let values = move || -> Result<Vec<f64>> {
        let all = document.arrays.iter().filter(|array| array.section == Section::CellData && array.name == wanted);
        let mut values = Vec::new();
        for array in all {
            values.extend(document.values(array).map_err(fault)?);
        }
        Ok(values)
    };
    Data { name, whole: array.number.is_whole(), values: Box::new(values) }
}

/// What an array of `FieldData` says: the name of a group, or the edges of groups.
fn field(document: &Document, array: &Array, part: &mut Part) -> std::result::Result<(), String> {
    if array.name == EDGES && array.components == 3 {
        let values: Option<Vec<usize>> =
            document.values(array)?.into_iter().map(|x| whole(x).map(|x| x as usize)).collect();
        let values = values.ok_or_else(|| format!("array `{EDGES}` has what is no whole number from 0"))?;
        part.own_edges = Some(values.as_chunks::<3>().0.to_vec());
    } else if array.name == CURVES && array.components == 10 {
        let values = document.values(array)?;
        part.own_bulges = values.as_chunks::<2>().0.as_chunks::<5>().0.to_vec();
    } else if array.number.is_whole() && array.tuples.and_then(|rows| rows.checked_mul(array.components)) == Some(2) {
        let [number, dimension] = document.values(array)?[..] else { return Ok(()) };
        let of = match dimension {
            1.0 => Of::Edges,
            2.0 => Of::Cells,
            _ => return Ok(()),
        };
        part.names.insert((of, number as i64), array.name.clone());
        if part.names.len() > NAMES {
            return Err(format!("it has more than {NAMES} names of groups"));
        }
    }
    Ok(())
}

/// Adds the cells of a piece, the first point of which is `base` of all.
fn add_cells(
    document: &Document,
    (piece, count): (usize, usize),
    base: u64,
    part: &mut Part,
) -> std::result::Result<(), String> {
    if count == 0 {
        return Ok(());
    }
    let find = |name: &str| {
        let mut own = document.arrays.iter().filter(|array| array.section == Section::Cells && array.piece == piece);
        own.find(|array| array.name == name).ok_or_else(|| format!("its cells have no array `{name}`"))
    };
    let (offsets, types) = (document.counted(find("offsets")?, count)?, document.counted(find("types")?, count)?);
    let ends: Option<Vec<usize>> = offsets.iter().map(|&x| whole(x).and_then(|x| usize::try_from(x).ok())).collect();
    let ends = ends.filter(|ends| ends.is_sorted()).ok_or("array `offsets` does not count up")?;
    let count = ends.last().copied().unwrap_or(0);
    memory::check((count as u64).saturating_mul(NODE))?;
    let connectivity = document.counted(find("connectivity")?, count)?;
    let nodes: Option<Vec<u64>> = connectivity.iter().map(|&x| whole(x)?.checked_add(base)).collect();
    let nodes = nodes.ok_or("array `connectivity` has what is no number of a point")?;
    let straight = part.own_edges.is_some();
    let mut start = 0;
    for (cell, (end, kind)) in ends.into_iter().zip(types).enumerate() {
        let shape = whole(kind)
            .and_then(of_vtk)
            .ok_or_else(|| format!("cell {cell} (from 0) is of the VTK type {kind}, which is not known"))?;
        part.cells.push(shape, &nodes[start..end], straight);
        start = end;
    }
    Ok(())
}

/// A whole number from 0.
fn whole(x: f64) -> Option<u64> {
    (x >= 0.0 && x.fract() == 0.0 && x < 9e15).then_some(x as u64)
}
