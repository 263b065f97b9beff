//! XDMF with HDF5 beside it, for ParaView, VTK, meshio and DOLFINx.
//!
//! Most readers of XDMF know only bilinear quadrilaterals. So each cell of degree N is split into N x N of them on its own
//! (N + 1)^2 equispaced nodes: [`Series`] writes those with their fields in time. [`write_mesh`] writes the mesh alone, with
//! shared nodes. The numbers of `name.xdmf` are in `name.h5`, as DOLFINx expects.

mod mesh;
mod names;
mod nodal;
mod read;
mod series;

pub use mesh::{write_all, write_boundary, write_mesh};
pub use nodal::is_own_series;
pub use read::{File, REMEDY, beside};
pub use series::Series;

use std::path::{Path, PathBuf};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use super::pending::write_text;
use super::store::is_store;
use crate::built;
use crate::error::{Error, Result};

/// XML is written into memory.
type Xml = Writer<Vec<u8>>;
/// The result of writing XML.
type Written = std::io::Result<()>;

/// Path of the HDF5 file beside an XDMF file. A store of the pipeline (such as `mesh.h5` of a run) is never replaced.
pub(crate) fn companion(path: &Path) -> Result<PathBuf> {
    let h5 = path.with_extension("h5");
    if h5 == path || path.file_name().is_none_or(|n| n.to_string_lossy().contains(':')) {
        return Err(Error::output(path, "an XDMF file needs a name that ends in .xdmf and has no colon"));
    }
    if is_store(&h5) {
        return Err(Error::output(&h5, "a file of the pipeline has this name; choose another name or folder"));
    }
    Ok(h5)
}

/// A document; `fill` writes the contents of its domain.
fn write_document(path: &Path, fill: impl FnOnce(&mut Xml) -> Written) -> Result<()> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let root = [("Version", "3.0"), ("xmlns:xi", "http://www.w3.org/2001/XInclude")];
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None))).and_then(|()| {
        let root = xml.create_element("Xdmf").with_attributes(root);
        root.write_inner_content(|xml| xml.create_element("Domain").write_inner_content(fill).map(drop)).map(drop)
    });
    written.map_err(|e| Error::output(path, e))?;
    let text = String::from_utf8(xml.into_inner()).map_err(|e| Error::output(path, e))?;
    write_text(path, &(text + "\n" + &built::comment()))
}

/// An array in the HDF5 file: its place, shape and type.
struct Item<'a> {
    file: &'a str,
    name: &'a str,
    shape: &'a [usize],
    /// `Float` or `Int`, and the bytes of a number.
    number: (&'a str, &'a str),
}

fn item(xml: &mut Xml, item: &Item) -> Written {
    let shape: Vec<String> = item.shape.iter().map(usize::to_string).collect();
    let shape = shape.join(" ");
    let (kind, bytes) = item.number;
    let attributes = [("Format", "HDF"), ("NumberType", kind), ("Precision", bytes), ("Dimensions", shape.as_str())];
    let place = format!("{}:/{}", item.file, item.name);
    xml.create_element("DataItem").with_attributes(attributes).write_text_content(BytesText::new(&place)).map(drop)
}

/// The uniform grid `name`: cells of `nodes` nodes each as `topology` (c, nodes), X as `geometry` (n, 2); then what
/// `more` adds.
fn uniform_grid(
    xml: &mut Xml,
    (file, name): (&str, &str),
    (cells, nodes, points): (usize, usize, usize),
    more: impl FnOnce(&mut Xml) -> Written,
) -> Written {
    let part = |part: &str| format!("{name}/{part}");
    let (topology_name, geometry_name) = (part("topology"), part("geometry"));
    let integers = Item { file, name: &topology_name, shape: &[cells, nodes], number: ("Int", "8") };
    let reals = Item { file, name: &geometry_name, shape: &[points, 2], number: ("Float", "8") };
    xml.create_element("Grid").with_attributes([("Name", name), ("GridType", "Uniform")]).write_inner_content(
        |xml| {
            topology(xml, nodes, cells, &integers)?;
            let geometry = xml.create_element("Geometry").with_attribute(("GeometryType", "XY"));
            geometry.write_inner_content(|xml| item(xml, &reals))?;
            more(xml)
        },
    )?;
    Ok(())
}

/// The cells of a grid, of `nodes` nodes each.
fn topology(xml: &mut Xml, nodes: usize, cells: usize, values: &Item) -> Written {
    let kind = match nodes {
        2 => "Polyline",
        3 => "Edge_3",
        9 => "Quadrilateral_9",
        _ => "Quadrilateral",
    };
    let (count, size) = (cells.to_string(), nodes.to_string());
    let attributes = [("TopologyType", kind), ("NumberOfElements", count.as_str()), ("NodesPerElement", size.as_str())];
    xml.create_element("Topology").with_attributes(attributes).write_inner_content(|xml| item(xml, values)).map(drop)
}

/// An attribute (a field) of a grid.
fn attribute(xml: &mut Xml, name: &str, kind: &str, center: &str, values: &Item) -> Written {
    let attributes = [("Name", name), ("AttributeType", kind), ("Center", center)];
    xml.create_element("Attribute").with_attributes(attributes).write_inner_content(|xml| item(xml, values)).map(drop)
}

/// The name of a file without its folder, as text.
fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
