//! `cloud.h5`: the material points, with the fingerprint of the mesh that they were seeded on.
//!
//! Arrays: `first` (cells + 1); `xi` (points, 2), parent coordinates; `positions` (points, 2), X in m, for people who
//! read the file (it is not read back). Attribute `mesh`: the fingerprint.

use std::path::Path;

use super::grid::bilinear;
use super::hash;
use super::store::{ArrayRef, Format, Store, write_arrays};
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::mesh::Mesh;

/// The format of `cloud.h5`.
pub const FORMAT: Format = Format { name: "dgmpm cloud", version: 1, remedy: "write it again by `dgmpm seed`" };

/// Writes the cloud of a mesh.
pub fn write_cloud(path: &Path, cloud: &Cloud, mesh: &Mesh) -> Result<()> {
    if let Some(what) = fault(cloud).or_else(|| misfit(cloud, mesh)) {
        return Err(Error::output(path, what));
    }
    let positions: Vec<[f64; 2]> = (0..mesh.cells.len())
        .flat_map(|c| cloud.of(c).iter().map(move |&xi| bilinear(mesh.cells[c].map(|n| mesh.nodes[n]), xi)))
        .collect();
    let arrays = [
        ("first", vec![cloud.first.len()], ArrayRef::Index(&cloud.first)),
        ("xi", vec![cloud.len(), 2], ArrayRef::F64(cloud.xi.as_flattened())),
        ("positions", vec![cloud.len(), 2], ArrayRef::F64(positions.as_flattened())),
    ];
    write_arrays(path, FORMAT, &[("mesh", hash::of_mesh(mesh))], &arrays)
}

/// Reads a cloud and the fingerprint of its mesh.
pub fn read_cloud(path: &Path) -> Result<(Cloud, String)> {
    let mut store = Store::read(path, FORMAT)?;
    let xi = store.reals("xi", &[2])?;
    let cloud = Cloud { first: store.indices("first", &[])?, xi: xi.as_chunks::<2>().0.to_vec() };
    match fault(&cloud) {
        Some(what) => Err(store.error(what)),
        None => Ok((cloud, store.attribute("mesh")?.to_owned())),
    }
}

/// Reads a cloud that must belong to this mesh.
pub fn read_cloud_of(path: &Path, mesh: &Mesh) -> Result<Cloud> {
    let (cloud, seeded_on) = read_cloud(path)?;
    let fail = |what: &str| Err(Error::at(crate::error::Place::file(path), what, FORMAT.remedy));
    if seeded_on != hash::of_mesh(mesh) {
        return fail("the points were seeded on another mesh");
    }
    match misfit(&cloud, mesh) {
        Some(what) => fail(&what),
        None => Ok(cloud),
    }
}

/// What is wrong with the numbers of a cloud, if anything.
fn fault(cloud: &Cloud) -> Option<String> {
    let first = &cloud.first;
    if first.first() != Some(&0) || first.last() != Some(&cloud.len()) || !first.is_sorted() {
        return Some(format!("`first` must rise from 0 to the number of points, {}", cloud.len()));
    }
    let outside = cloud.xi.iter().position(|xi| !xi.iter().all(|v| (0.0..=1.0).contains(v)))?;
    Some(format!("point {outside} has the parent coordinates {:?}, outside of [0, 1]", cloud.xi[outside]))
}

fn misfit(cloud: &Cloud, mesh: &Mesh) -> Option<String> {
    let (runs, cells) = (cloud.first.len() - 1, mesh.cells.len());
    (runs != cells).then(|| format!("the cloud is for {runs} cells, the mesh has {cells}"))
}
