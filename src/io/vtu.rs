//! VTU files (VTK XML, unstructured grid) for ParaView, VTK, pyvista and meshio: written here, and the points of them read.
//!
//! Numbers have 64 bits and are written inline as base64, not compressed, with the number of their bytes before them. Indices are
//! signed, since meshio cannot compute with unsigned ones.

mod cells;
mod decode;
mod read;

pub use cells::{CURVES, EDGES, part};
pub use read::{at_nodes, points};

use std::fmt::Write;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::escape::escape;

use super::grid::{Field, Groups, HighOrderGrid, PointCloud};
use super::pending::write_text;
use super::seal;
use crate::error::Result;

/// VTK's numbers of kinds of cells.
pub(super) const VERTEX: u8 = 1;
const QUAD: u8 = 9;
const LAGRANGE_QUADRILATERAL: u8 = 70;

/// What the comment of an export says whose points are not where they were in the initial configuration.
pub const DEFORMED: &str = "x = X + u, at the time";

/// VTK's number of the cells of a grid of this degree.
pub(super) fn kind_of_grid(degree: usize) -> u8 {
    if degree <= 1 { QUAD } else { LAGRANGE_QUADRILATERAL }
}

/// Writes a grid: Lagrange quadrilaterals (VTK type 70) of degree N, bilinear ones (type 9) for N = 0 and 1.
pub fn write_grid(path: &Path, grid: &HighOrderGrid) -> Result<()> {
    grid.check()?;
    let kind = kind_of_grid(grid.degree);
    let mut piece = Piece::begin(grid.points.len(), grid.cells(), grid.groups.as_ref());
    piece.fields("PointData", &grid.point_fields);
    piece.fields("CellData", &grid.cell_fields);
    piece.points(&grid.points);
    piece.cells(grid.cells(), grid.nodes_per_cell(), kind);
    write_text(path, &piece.end(&grid.about))
}

/// Writes points as vertices (VTK type 1).
pub fn write_points(path: &Path, cloud: &PointCloud) -> Result<()> {
    cloud.check()?;
    let count = cloud.points.len();
    let mut piece = Piece::begin(count, count, None);
    piece.fields("PointData", &cloud.fields);
    piece.points(&cloud.points);
    piece.cells(count, 1, VERTEX);
    write_text(path, &piece.end(&cloud.about))
}

/// Writes bilinear quadrilaterals with fields at their nodes, which cells have in common.
///
/// # Errors
/// A file that cannot be written.
pub fn write_nodal(path: &Path, points: &[[f64; 3]], cells: &[[usize; 4]], fields: &[Field]) -> Result<()> {
    super::grid::check_fields(fields, points.len())?;
    let mut piece = Piece::begin(points.len(), cells.len(), None);
    piece.fields("PointData", fields);
    piece.points(points);
    piece.cells_of(cells.as_flattened().iter().map(|&node| node as i64).collect(), 4, QUAD);
    write_text(path, &piece.end(""))
}

/// The text of a file with one piece.
struct Piece(String);

impl Piece {
    fn begin(points: usize, cells: usize, groups: Option<&Groups>) -> Self {
        let head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
                    header_type=\"UInt64\"><UnstructuredGrid>";
        let mut piece = Self(head.to_owned());
        if let Some(groups) = groups {
            piece.groups(groups);
        }
        piece.0 += &format!("<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">");
        piece
    }

    /// Names of groups as meshio has them in `field_data`, number and dimension, the edges of groups ([`EDGES`]), and how cells are
    /// curved ([`CURVES`]).
    fn groups(&mut self, groups: &Groups) {
        self.0.push_str("<FieldData>");
        for (dimension, names) in [(1, &groups.edges), (2, &groups.cells)] {
            for (number, name) in names.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
                self.rows(name, 1, &[number as i64, dimension]);
            }
        }
        let edges: Vec<i64> = groups.tagged.as_flattened().iter().map(|&k| k as i64).collect();
        self.rows(EDGES, 3, &edges);
        if !groups.bulges.is_empty() {
            let values = groups.bulges.as_flattened().as_flattened();
            let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().fold(f64::NAN, pick).to_string());
            let size = [10, groups.bulges.len()];
            self.array("Float64", CURVES, size, [&low, &high], bytes(values, |x| x.to_le_bytes()));
        }
        self.0.push_str("</FieldData>");
    }

    /// Whole numbers of no points and no cells.
    fn rows(&mut self, name: &str, components: usize, values: &[i64]) {
        let of = |pick: fn(i64, i64) -> i64| values.iter().copied().reduce(pick).unwrap_or(0).to_string();
        let size = [components, values.len() / components];
        self.array("Int64", name, size, [&of(i64::min), &of(i64::max)], bytes(values, |k| k.to_le_bytes()));
    }

    fn end(mut self, about: &str) -> String {
        self.0.push_str("</Piece></UnstructuredGrid></VTKFile>\n");
        if !about.is_empty() {
            // Two hyphens would end the comment for some readers.
            self.0 += &format!("<!-- {} -->\n", about.replace("--", "-"));
        }
        seal::text(&self.0, seal::XML)
    }

    fn fields(&mut self, section: &str, fields: &[Field]) {
        if fields.is_empty() {
            return;
        }
        self.0 += &format!("<{section}>");
        for field in fields {
            self.reals(&field.name, field.kind.components(), &field.values);
        }
        self.0 += &format!("</{section}>");
    }

    fn points(&mut self, points: &[[f64; 3]]) {
        self.0.push_str("<Points>");
        self.reals("Points", 3, points.as_flattened());
        self.0.push_str("</Points>");
    }

    /// Cells with `size` own points each; the points of one cell follow those of the cell before.
    fn cells(&mut self, count: usize, size: usize, kind: u8) {
        self.cells_of((0..count * size).map(|k| k as i64).collect(), size, kind);
    }

    /// Cells with `size` points each, by the numbers of these.
    fn cells_of(&mut self, connectivity: Vec<i64>, size: usize, kind: u8) {
        let (count, last) = (connectivity.len() / size, connectivity.iter().max().copied().unwrap_or(0));
        self.0.push_str("<Cells>");
        self.array(
            "Int64",
            "connectivity",
            [1, 0],
            ["0", &last.to_string()],
            bytes(&connectivity, |k| k.to_le_bytes()),
        );
        let offsets: Vec<i64> = (1..=count).map(|cell| (cell * size) as i64).collect();
        let range = [size.to_string(), (count * size).to_string()];
        self.array("Int64", "offsets", [1, 0], [&range[0], &range[1]], bytes(&offsets, |k| k.to_le_bytes()));
        let kinds = vec![kind; count];
        self.array("UInt8", "types", [1, 0], [&kind.to_string(), &kind.to_string()], kinds);
        self.0.push_str("</Cells>");
    }

    fn reals(&mut self, name: &str, components: usize, values: &[f64]) {
        // NaN is in no range.
        let [low, high] = [f64::min, f64::max].map(|pick| values.iter().copied().fold(f64::NAN, pick).to_string());
        self.array("Float64", name, [components, 0], [&low, &high], bytes(values, |x| x.to_le_bytes()));
    }

    /// An array with its components, and its rows where it has not as many as there are points or cells (otherwise 0).
    fn array(&mut self, number: &str, name: &str, [components, rows]: [usize; 2], range: [&str; 2], data: Vec<u8>) {
        let said = |what: &str, count: usize, usual: usize| match count == usual {
            true => String::new(),
            false => format!(" {what}=\"{count}\""),
        };
        let several = said("NumberOfComponents", components, 1) + &said("NumberOfTuples", rows, 0);
        let ([low, high], name) = (range, escape(name));
        // Writing to a String cannot fail.
        let _ = write!(
            self.0,
            "<DataArray type=\"{number}\" Name=\"{name}\"{several} format=\"binary\" RangeMin=\"{low}\" RangeMax=\"{high}\">"
        );
        let length = (data.len() as u64).to_le_bytes();
        STANDARD.encode_string([&length[..], &data].concat(), &mut self.0);
        self.0.push_str("</DataArray>");
    }
}

fn bytes<T: Copy, const N: usize>(values: &[T], of: fn(T) -> [u8; N]) -> Vec<u8> {
    values.iter().flat_map(|value| of(*value)).collect()
}
