//! `operators.h5`: the stored matrices, keyed by what they were built from.

use std::path::Path;

use super::hash::{self, Digest};
use super::hdf5;
use super::seal::{self, Seal};
use super::store::{ArrayRef, Format, Store, write_arrays};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::operators::stored::Flat;
use crate::operators::{Blocks, Needs, Sampling, Stored};

/// The format of the stored matrices.
pub const FORMAT: Format =
    Format { name: "dgmpm operators", version: 1, remedy: "write it again by `dgmpm preprocess`" };

/// The key: a hash of mesh, pairs of periodic groups, cloud (or nodes), degree, the law of each cell, and which
/// matrices are asked for.
pub fn key(mesh: &Mesh, periodic: &[[usize; 2]], material: &[usize], needs: &Needs) -> String {
    let mut digest = Digest::new();
    digest.text(FORMAT.name).count(FORMAT.version as usize).text(&hash::of_mesh(mesh)).count(needs.degree);
    digest.counts(periodic.as_flattened().iter().map(|&group| group as u64));
    digest.counts(material.iter().map(|&m| m as u64));
    match needs.sampling {
        None => digest.text("none"),
        Some(Sampling::Nodes) => digest.text("nodes"),
        Some(Sampling::Cloud(cloud)) => digest.text(&hash::of_cloud(cloud)),
    };
    digest.count(usize::from(needs.curl_free)).finish()
}

/// Writes the matrices under their key.
pub fn write(path: &Path, key: &str, stored: &Stored) -> Result<()> {
    let parts =
        [("points", stored.points.as_ref().map(Flat::of)), ("curl_free", stored.curl_free.as_ref().map(Flat::of))];
    let mut arrays = Vec::new();
    for (name, flat) in &parts {
        let Some(flat) = flat else { continue };
        arrays.push((format!("{name}_share"), flat.share.len(), ArrayRef::I64(&flat.share)));
        arrays.push((format!("{name}_shared_sizes"), flat.shared_sizes.len(), ArrayRef::Index(&flat.shared_sizes)));
        arrays.push((format!("{name}_own_sizes"), flat.own_sizes.len(), ArrayRef::Index(&flat.own_sizes)));
        arrays.push((format!("{name}_shared"), flat.shared.len(), ArrayRef::F64(&flat.shared)));
        arrays.push((format!("{name}_own"), flat.own.len(), ArrayRef::F64(&flat.own)));
    }
    let arrays: Vec<_> = arrays.iter().map(|(name, len, array)| (name.as_str(), vec![*len], *array)).collect();
    write_arrays(path, FORMAT, &[("key", key.to_owned())], &arrays)
}

/// Whether new matrices may take the place of a file: it holds matrices, or is a damaged store of whatever kind.
pub fn may_replace(path: &Path) -> bool {
    let ours = || hdf5::peek_attribute(path, "format").is_some_and(|name| name == FORMAT.name);
    matches!(seal::check(path), Ok(Seal::Broken)) || ours()
}

/// Reads the matrices if they have this key; none where the file is missing or was built from other input.
///
/// # Errors
/// A file that is damaged.
pub fn read(path: &Path, key: &str, blocks: &Blocks, needs: &Needs) -> Result<Option<Stored>> {
    if !path.exists() {
        return Ok(None);
    }
    let mut store = Store::read(path, FORMAT)?;
    if store.attribute("key")? != key {
        return Ok(None);
    }
    let nodes = (needs.degree + 1).pow(2);
    let misfit = |store: &Store, name: &str| store.error(format!("the arrays of `{name}` do not fit together"));
    let mut out = Stored { points: None, curl_free: None };
    if needs.sampling.is_some() {
        let pool = flat(&mut store, "points")?.pool(blocks.len(), nodes);
        out.points = Some(pool.ok_or_else(|| misfit(&store, "points"))?);
    }
    if needs.curl_free {
        let pool = flat(&mut store, "curl_free")?.pool(blocks.len(), nodes);
        out.curl_free = Some(pool.ok_or_else(|| misfit(&store, "curl_free"))?);
    }
    Ok(Some(out))
}

fn flat(store: &mut Store, name: &str) -> Result<Flat> {
    let share = store.take(&format!("{name}_share"))?.1;
    let hdf5::Values::I64(share) = share else {
        return Err(store.error(format!("`{name}_share` is not an array of integers")));
    };
    Ok(Flat {
        share,
        shared_sizes: store.indices(&format!("{name}_shared_sizes"), &[])?,
        own_sizes: store.indices(&format!("{name}_own_sizes"), &[])?,
        shared: store.reals(&format!("{name}_shared"), &[])?,
        own: store.reals(&format!("{name}_own"), &[])?,
    })
}
