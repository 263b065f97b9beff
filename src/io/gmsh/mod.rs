//! Gmsh's MSH files, versions 2.2 and 4.1, ascii and binary: quadrilaterals of order 1 and 2 in the plane z = 0, groups
//! by physical surfaces and curves. The format is that of the Gmsh reference manual, chapter "Gmsh file formats".
//!
//! An element that the program cannot use is an error, with its number and the Gmsh option that helps. Nodes that no
//! quadrilateral uses are dropped; lines in no physical curve and points are ignored.

mod assemble;
mod error;
mod kinds;
pub mod program;
mod sections;
mod source;
mod v22;
mod v41;
mod write;

use std::path::Path;

use crate::error::Result;
use crate::io::regular;
use crate::mesh::Mesh;
use crate::mesh::map::Bulge;

pub(in crate::io) use assemble::mesh as assemble;
pub use error::{At, Error};
pub use kinds::{Kind, LINE, LINE_3, OTHER_QUAD, POINT, QUAD, QUAD_9};
pub use write::{to_text, write};

/// Reads a mesh from an MSH file.
///
/// Cells come in the order of their element numbers, nodes in that of their node numbers, groups in that of their
/// physical tags, edges by group, cell and face; so the same mesh is the same [`Mesh`] from each version of the format.
pub fn read(path: &Path) -> Result<Mesh> {
    let bytes = regular::bytes(path, u64::MAX).map_err(|why| {
        let place = crate::Place::file(path);
        crate::Error::at(place, format!("the mesh cannot be read: {why}"), "give the path of an .msh file of Gmsh")
    })?;
    parse(&bytes).map_err(|error| error.in_file(path))
}

/// Reads a mesh from the bytes of an MSH file. No sequence of bytes makes it panic, or allocate out of proportion to them.
pub fn parse(bytes: &[u8]) -> std::result::Result<Mesh, Error> {
    assemble::mesh(sections::read(bytes)?)
}

/// The contents of a file, before they are made into a mesh. Groups are physical tags; 0 means no group.
#[derive(Debug, Default)]
pub(in crate::io) struct Raw {
    /// Names of physical groups by dimension and tag, in the order of tags.
    pub names: std::collections::BTreeMap<(i32, i32), String>,
    /// Whether groups are those of entities (MSH 4.1), and not tags of the elements (MSH 2.2).
    pub entities: bool,
    /// Whether any physical surface is defined.
    pub surfaces: bool,
    /// Number and coordinates of each node.
    pub nodes: Vec<(u64, [f64; 3])>,
    pub lines: Vec<Element<2>>,
    pub quads: Vec<Element<4>>,
    /// Of quadrilaterals of order 2.
    pub middles: Vec<Middles>,
    /// How the edges of all quadrilaterals are curved, where the file says that itself; else empty.
    pub bulges: Vec<Bulge>,
    /// Elements that cannot be used: for each type how many, and the number of the first.
    pub refused: std::collections::BTreeMap<i32, (usize, u64)>,
}

impl Raw {
    /// The name of a physical group; its tag where it has none.
    pub fn name(&self, dimension: i32, tag: i32) -> String {
        self.names.get(&(dimension, tag)).cloned().unwrap_or_else(|| tag.to_string())
    }
}

/// The nodes of a quadrilateral of order 2 beside its corners.
#[derive(Debug, Clone, Copy)]
pub(in crate::io) struct Middles {
    /// The number of the quadrilateral.
    pub number: u64,
    /// The middles of its edges from corner k to corner k + 1.
    pub edges: [u64; 4],
    /// Its own; none of 8 nodes.
    pub own: Option<u64>,
}

/// Reads an element of a kind, number and group; `node` reads the number of a node.
fn element<E>(
    raw: &mut Raw,
    kind: Kind,
    (number, group): (u64, i32),
    mut node: impl FnMut() -> std::result::Result<u64, E>,
) -> std::result::Result<(), E> {
    match kind.number {
        _ if kind.is_line() => {
            raw.lines.push(Element { number, group, nodes: [node()?, node()?] });
            (2..kind.nodes).try_for_each(|_| node().map(drop))?;
        }
        _ if kind.is_quad() => {
            raw.quads.push(Element { number, group, nodes: [node()?, node()?, node()?, node()?] });
            if kind.order == 2 {
                let edges = [node()?, node()?, node()?, node()?];
                let own = if kind.number == QUAD_9 { Some(node()?) } else { None };
                raw.middles.push(Middles { number, edges, own });
            }
        }
        _ => {
            (0..kind.nodes).try_for_each(|_| node().map(drop))?;
            if !kind.usable() {
                raw.refused.entry(kind.number).or_insert((0, number)).0 += 1;
            }
        }
    }
    Ok(())
}

/// An element: its number, its physical tag (0 for none), the numbers of its nodes.
#[derive(Debug, Clone, Copy)]
pub(in crate::io) struct Element<const N: usize> {
    pub number: u64,
    pub group: i32,
    pub nodes: [u64; N],
}
