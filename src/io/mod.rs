//! The files of the pipeline, and the files that other programs read.
//!
//! Between the steps of the pipeline everything travels in HDF5 ([`store`]): the mesh ([`mesh_file`]), the cloud
//! ([`cloud_file`]), the matrices ([`operators_file`]) and the state at a time ([`snapshot`]). Meshes come from Gmsh
//! ([`gmsh`]), and from VTU and XDMF files of other programs ([`unstructured`]); [`import`] tells what a file is. For other programs
//! there is an output model ([`grid`]) that knows nothing of a solver, and one writer per
//! format: [`vtu`], [`pvd`], [`vtkhdf`], [`xdmf`], [`csv`]. Loads over time come from CSV too ([`LoadTable`]).
//!
//! A file appears under its name only when it is whole ([`pending`]); what is read is checked before it is used. The folder of a run has
//! a list of the files that the program has made there ([`own`]).

mod certificates;
pub mod checkpoint;
pub mod cloud_file;
pub mod csv;
pub mod fingerprint;
pub mod gmsh;
pub mod grid;
pub mod hash;
pub mod hdf5;
mod import;
mod load_table;
pub mod mesh_file;
mod middles;
pub mod nodal;
pub mod operators_file;
pub mod own;
pub mod pending;
pub mod points;
pub mod provenance;
pub mod pvd;
pub mod snapshot;
pub mod store;
pub mod unstructured;
pub mod vtkhdf;
pub mod vtu;
pub mod xdmf;
mod xml;

pub(crate) use crate::file as regular;
pub use crate::file::seal;
pub use load_table::LoadTable;

pub use import::{FORMATS, has_own_names, parse, read_mesh, read_tagged};

use crate::error::Result;
use crate::mesh::Mesh;
use std::path::Path;

/// Writes a mesh: `.msh` for Gmsh, `.xdmf` for DOLFINx and ParaView with `.h5` beside it, else HDF5.
///
/// # Errors
/// A file that cannot be written.
pub fn write_mesh(path: &Path, mesh: &Mesh) -> Result<()> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("msh") => gmsh::write(mesh, path),
        Some("xdmf") => xdmf::write_all(path, mesh),
        _ => mesh_file::write_mesh(path, mesh),
    }
}
