//! VTU files (VTK XML, unstructured grid) for ParaView, VTK, pyvista and meshio.
//!
//! Numbers have 64 bits and are written inline as base64, not compressed. The compressing writer of `vtkio` 0.7.0-rc2
//! adds an empty block to an array whose bytes are a multiple of the block; VTK then reads this block as a full one.

mod decode;
mod read;

pub use read::points;

use std::path::Path;

use vtkio::model::{Attribute, Attributes, ByteOrder, CellType, Cells, UnstructuredGridPiece, Version, VertexNumbers};
use vtkio::model::{DataSet, Vtk};
use vtkio::xml::Compressor;

use super::grid::{Field, HighOrderGrid, PointCloud};
use super::pending::write_text;
use super::seal;
use crate::error::{Error, Result};

/// Writes a grid: Lagrange quadrilaterals (VTK type 70) of degree N, bilinear ones (type 9) for N = 0 and 1.
pub fn write_grid(path: &Path, grid: &HighOrderGrid) -> Result<()> {
    grid.check()?;
    let kind = if grid.degree <= 1 { CellType::Quad } else { CellType::LagrangeQuadrilateral };
    let cells = cells(grid.cells(), grid.nodes_per_cell(), kind);
    let data = Attributes { point: attributes(&grid.point_fields), cell: attributes(&grid.cell_fields) };
    write(path, UnstructuredGridPiece { points: coordinates(&grid.points), cells, data })
}

/// Writes points as vertices (VTK type 1).
pub fn write_points(path: &Path, cloud: &PointCloud) -> Result<()> {
    cloud.check()?;
    let cells = cells(cloud.points.len(), 1, CellType::Vertex);
    let data = Attributes { point: attributes(&cloud.fields), cell: Vec::new() };
    write(path, UnstructuredGridPiece { points: coordinates(&cloud.points), cells, data })
}

fn coordinates(points: &[[f64; 3]]) -> vtkio::IOBuffer {
    vtkio::IOBuffer::F64(points.as_flattened().to_vec())
}

/// Cells with `size` own points each; the points of one cell follow those of the cell before.
fn cells(count: usize, size: usize, kind: CellType) -> Cells {
    let connectivity = (0..(count * size) as u64).collect();
    let offsets = (1..=count as u64).map(|c| c * size as u64).collect();
    Cells { cell_verts: VertexNumbers::XML { connectivity, offsets }, types: vec![kind; count] }
}

fn attributes(fields: &[Field]) -> Vec<Attribute> {
    let attribute = |f: &Field| {
        Attribute::generic(f.name.as_str(), f.kind.components() as u32)
            .with_data(vtkio::IOBuffer::F64(f.values.clone()))
    };
    fields.iter().map(attribute).collect()
}

fn write(path: &Path, piece: UnstructuredGridPiece) -> Result<()> {
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: String::new(),
        byte_order: ByteOrder::LittleEndian,
        data: DataSet::inline(piece),
        file_path: None,
    };
    let xml = file.try_into_xml_format(Compressor::None, 0).map_err(|e| Error::output(path, e))?;
    // vtkio marks indices as unsigned, and meshio cannot compute with unsigned indices; below 2^63 the bytes are the same.
    // Only an attribute can hold a quote, so this changes nothing else.
    let text = xml.to_string().replace(" type=\"UInt64\"", " type=\"Int64\"");
    write_text(path, &seal::text(&format!("<?xml version=\"1.0\"?>\n{text}\n"), seal::XML))
}
