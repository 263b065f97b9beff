//! `cloud.h5`: the material points, with the fingerprint of the mesh that they were seeded on.
//!
//! Arrays: `first` (cells + 1); `xi` (points, 2), parent coordinates; `positions` (points, 2), X in m, for people who
//! read the file (it is not read back). Attribute `mesh`: the fingerprint. Version 2 may also hold `virtual` (points),
//! 1 where a point stands on a Gauss node because its cell cannot carry the degree; fields at the points, `field_<name>`
//! (points, components); and the certificates of the cells (`cell_..`).

use std::path::Path;

use super::certificates::{self, Columns};
use super::grid::{Field, Kind};
use super::hash;
use super::store::{ArrayRef, Format, Store, write_arrays};
use crate::cloud::Cloud;
use crate::error::{Error, Result};
use crate::mesh::{Mesh, map};
use crate::operators::Certificate;

/// The format of `cloud.h5`.
pub const FORMAT: Format = Format { name: "dgmpm cloud", version: 2, remedy: "write it again by `dgmpm seed`" };

/// The prefix of the names of fields.
const FIELD: &str = "field_";

/// What a file may hold beside the positions of the points. A part that the file does not hold is empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Extras {
    /// Whether each point is virtual.
    pub virtual_points: Vec<bool>,
    /// Fields at the points.
    pub fields: Vec<Field>,
    /// Certificates of the cells.
    pub certificates: Vec<Certificate>,
}

/// Writes the cloud of a mesh.
pub fn write_cloud(path: &Path, cloud: &Cloud, mesh: &Mesh) -> Result<()> {
    write_with(path, cloud, mesh, &Extras::default())
}

/// Writes the cloud of a mesh, with the further parts of [`Extras`].
pub fn write_with(path: &Path, cloud: &Cloud, mesh: &Mesh, more: &Extras) -> Result<()> {
    if let Some(what) = fault(cloud).or_else(|| misfit(cloud, mesh)).or_else(|| too_few(cloud, more)) {
        return Err(Error::output(path, what));
    }
    let positions: Vec<[f64; 2]> = (0..mesh.cells.len())
        .flat_map(|c| cloud.of(c).iter().map(move |&xi| map::position(&mesh.map(c), xi)))
        .collect();
    let mut arrays = vec![
        ("first", vec![cloud.first.len()], ArrayRef::Index(&cloud.first)),
        ("xi", vec![cloud.len(), 2], ArrayRef::F64(cloud.xi.as_flattened())),
        ("positions", vec![cloud.len(), 2], ArrayRef::F64(positions.as_flattened())),
    ];
    let flags: Vec<usize> = more.virtual_points.iter().map(|&is| usize::from(is)).collect();
    if !flags.is_empty() {
        arrays.push(("virtual", vec![flags.len()], ArrayRef::Index(&flags)));
    }
    let names: Vec<String> = more.fields.iter().map(|field| format!("{FIELD}{}", field.name)).collect();
    for (name, field) in names.iter().zip(&more.fields) {
        arrays.push((name, vec![cloud.len(), field.kind.components()], ArrayRef::F64(&field.values)));
    }
    let columns = Columns::of(&more.certificates);
    arrays.extend(columns.arrays());
    write_arrays(path, FORMAT, &[("mesh", hash::of_mesh(mesh))], &arrays)
}

fn read_places(store: &mut Store) -> Result<Cloud> {
    let xi = store.reals("xi", &[2])?;
    let cloud = Cloud { first: store.indices("first", &[])?, xi: xi.as_chunks::<2>().0.to_vec() };
    match fault(&cloud) {
        Some(what) => Err(store.error(what)),
        None => Ok(cloud),
    }
}

/// Reads a cloud that must belong to this mesh, with all further parts of the file.
pub fn read_with(path: &Path, mesh: &Mesh) -> Result<(Cloud, Extras)> {
    let mut store = Store::read(path, FORMAT)?;
    let cloud = read_places(&mut store)?;
    if store.attribute("mesh")? != hash::of_mesh(mesh) {
        return Err(store.error("the points were seeded on another mesh"));
    }
    if let Some(what) = misfit(&cloud, mesh) {
        return Err(store.error(what));
    }
    let mut more = Extras { certificates: certificates::read(&mut store, mesh.cells.len())?, ..Extras::default() };
    if store.names().any(|name| name == "virtual") {
        more.virtual_points = store.indices("virtual", &[])?.into_iter().map(|flag| flag != 0).collect();
    }
    let names: Vec<String> = store.names().filter(|name| name.starts_with(FIELD)).map(str::to_owned).collect();
    for name in names {
        let kinds = [Kind::Scalar, Kind::Vector, Kind::Tensor];
        let components = store.shape(&name)?.get(1).copied();
        let kind = kinds.into_iter().find(|kind| Some(kind.components()) == components);
        let kind = kind.ok_or_else(|| store.error(format!("`{name}` is neither scalar nor vector nor tensor")))?;
        more.fields.push(Field::new(&name[FIELD.len()..], kind, store.reals(&name, &[kind.components()])?));
    }
    match too_few(&cloud, &more) {
        Some(what) => Err(store.error(what)),
        None => Ok((cloud, more)),
    }
}

/// Whether a flag or a value of a field is missing for some point.
fn too_few(cloud: &Cloud, more: &Extras) -> Option<String> {
    let flags = more.virtual_points.len();
    if flags != 0 && flags != cloud.len() {
        return Some(format!("`virtual` has {flags} entries for {} points", cloud.len()));
    }
    let misfit = more.fields.iter().find(|field| field.values.len() != cloud.len() * field.kind.components())?;
    Some(format!("the field `{}` does not have a value for each of the {} points", misfit.name, cloud.len()))
}

/// The first fault in the numbers of a cloud, if there is one.
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
