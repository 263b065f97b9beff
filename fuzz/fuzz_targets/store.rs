//! The program's own HDF5 files with any contents: arrays of all names, shapes and values, written and read as each kind.
#![no_main]

use arbitrary::Arbitrary;
use dgmpm::parts::io::store::{ArrayRef, Store, write_arrays};
use dgmpm::parts::io::{cloud_file, mesh_file, snapshot};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

#[derive(Debug, Arbitrary)]
enum Numbers {
    Real(Vec<f64>),
    Whole(Vec<i64>),
    Small(Vec<u8>),
    Text(Vec<String>),
}

#[derive(Debug, Arbitrary)]
struct File {
    kind: u8,
    /// The number of a name, columns, values.
    arrays: Vec<(u8, u8, Numbers)>,
    attributes: Vec<(u8, String)>,
}

const NAMES: [&str; 24] = [
    "nodes", "cells", "cell_group", "groups", "edges", "edge_groups", "original", "first", "xi", "positions", "virtual",
    "field_velocity", "cell_class", "cell_points", "time", "step", "degree", "u", "displacement", "internal", "boundary",
    "received", "corrected", "rescued",
];
const ATTRIBUTES: [&str; 4] = ["mesh", "cloud", "key", "more"];

fn write(path: &Path, file: &File) -> Option<()> {
    let format = [mesh_file::FORMAT, cloud_file::FORMAT, snapshot::FORMAT][usize::from(file.kind % 3)];
    let mut arrays = Vec::new();
    let mut wide: Vec<(usize, Vec<usize>)> = Vec::new();
    for (k, (name, columns, numbers)) in file.arrays.iter().enumerate() {
        let name = NAMES[usize::from(*name) % NAMES.len()];
        if arrays.iter().any(|(known, _, _)| *known == name) {
            continue;
        }
        let shape = |length: usize| match usize::from(columns % 7) {
            0 => vec![length],
            columns if length % columns == 0 => vec![length / columns, columns],
            _ => vec![length],
        };
        match numbers {
            Numbers::Real(values) => arrays.push((name, shape(values.len()), ArrayRef::F64(values))),
            Numbers::Whole(values) => arrays.push((name, shape(values.len()), ArrayRef::I64(values))),
            Numbers::Text(values) => arrays.push((name, vec![values.len()], ArrayRef::Text(values))),
            Numbers::Small(values) => {
                wide.push((k, values.iter().map(|&value| usize::from(value % 9)).collect()));
            }
        }
    }
    for (k, values) in &wide {
        let (name, columns, _) = &file.arrays[*k];
        let name = NAMES[usize::from(*name) % NAMES.len()];
        let columns = usize::from(columns % 7).max(1);
        if arrays.iter().all(|(known, _, _)| *known != name) && values.len() % columns == 0 {
            let shape = if columns == 1 { vec![values.len()] } else { vec![values.len() / columns, columns] };
            arrays.push((name, shape, ArrayRef::Index(values)));
        }
    }
    let attributes: Vec<(&str, String)> = file
        .attributes
        .iter()
        .map(|(name, text)| (ATTRIBUTES[usize::from(*name) % ATTRIBUTES.len()], text.clone()))
        .collect();
    write_arrays(path, format, &attributes, &arrays).ok()
}

fuzz_target!(|file: File| {
    let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a folder");
    let path = folder.path().join("file.h5");
    if write(&path, &file).is_none() {
        return;
    }
    let mesh = dgmpm::rectangle([1.0, 1.0], [2, 2]).expect("a mesh");
    if let Ok(mesh) = mesh_file::read_mesh(&path) {
        assert_eq!(mesh.check(), Ok(()));
    }
    let _ = cloud_file::read_with(&path, &mesh);
    let _ = snapshot::Snapshot::read(&path);
    let _ = Store::read(&path, mesh_file::FORMAT);
});
