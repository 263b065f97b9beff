//! HDF5 files that lead out of themselves, or that another program has made.

use super::Bench;
use dgmpm::parts::io::{hdf5, mesh_file, seal};
use hdf5_metno as h5;
use std::path::Path;

/// A mesh file without its array `groups` or `cell_group`, to which `add` gives another one; with a seal.
fn with(path: &Path, without: &str, add: impl FnOnce(&h5::File)) {
    mesh_file::write_mesh(path, &dgmpm::rectangle([2.0, 1.0], [2, 1]).unwrap()).unwrap();
    let file = h5::File::open_rw(path).unwrap();
    file.unlink(without).unwrap();
    add(&file);
    file.close().unwrap();
    seal::put(path).unwrap();
}

#[test]
fn nothing_that_leads_out_of_a_file_is_followed() {
    let bench = Bench::new();
    let other = bench.path("other.h5");
    mesh_file::write_mesh(&other, &dgmpm::rectangle([2.0, 1.0], [2, 1]).unwrap()).unwrap();
    let path = bench.path("leads_out.h5");
    let message = || {
        let message = bench.message(&["mesh", "info", "leads_out.h5"]);
        assert!(message.starts_with("error: leads_out.h5: "), "{message}");
        message
    };
    with(&path, "cell_group", |file| file.link_external("other.h5", "cell_group", "cell_group").unwrap());
    assert!(message().contains("`cell_group` is a link, and links are not followed"), "{}", message());
    with(&path, "cell_group", |file| file.link_soft("/cells", "cell_group").unwrap());
    assert!(message().contains("`cell_group` is a link, and links are not followed"), "{}", message());
    // Raw storage: the bytes of any file as numbers.
    let secret = bench.path("secret");
    std::fs::write(&secret, [0_u8; 16]).unwrap();
    with(&path, "cell_group", |file| {
        let plan = file.new_dataset_builder().with_dcpl(|plan| plan.external(secret.to_str().unwrap(), 0, 16));
        plan.empty::<i64>().shape(2).create("cell_group").unwrap();
    });
    assert!(message().contains("`cell_group` takes its numbers from other files"), "{}", message());
}

#[test]
fn no_link_is_followed_in_the_numbers_of_another_program() {
    let bench = Bench::new();
    let text = std::fs::read_to_string(bench.path("good_mesh.xdmf")).unwrap();
    let item = "<DataItem Format=\"XML\" Dimensions=\"6 2\">0 0 1 0 2 0 0 1 1 1 2 1</DataItem>";
    let stored = "<DataItem Format=\"HDF\" Dimensions=\"6 2\">numbers.h5:/Mesh/mesh/geometry</DataItem>";
    assert!(text.contains(item));
    std::fs::write(bench.path("numbers.xdmf"), text.replace(item, stored)).unwrap();
    let write = |fill: &dyn Fn(&h5::File)| {
        // A new file: a program that another test has just started may hold the lock of the old one, until it has closed what it inherits.
        let _ = std::fs::remove_file(bench.path("numbers.h5"));
        let file = h5::File::create(bench.path("numbers.h5")).unwrap();
        fill(&file);
        file.close().unwrap();
    };
    let points = [0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0];
    let put = |group: &h5::Group, name: &str| {
        group.new_dataset::<f64>().shape([6, 2]).create(name).unwrap().write_raw(&points).unwrap();
    };
    write(&|file| put(&file.create_group("Mesh").unwrap().create_group("mesh").unwrap(), "geometry"));
    let all = ["--trust", "mesh", "info", "numbers.xdmf"];
    assert!(bench.message(&all[1..]).contains("numbers.h5: the file has no seal of dgmpm"));
    assert!(bench.good(&all).contains("cells of `1`"));
    // Who gives the file of the numbers means the mesh.
    assert!(bench.good(&["--trust", "mesh", "info", "numbers.h5"]).contains("cells of `1`"));
    write(&|file| {
        put(file, "geometry");
        file.create_group("Mesh").unwrap().link_soft("/", "mesh").unwrap();
    });
    assert!(bench.message(&all).contains("`mesh` of `/Mesh/mesh/geometry` is a link, and links are not followed"));
    write(&|file| {
        let group = file.create_group("Mesh").unwrap().create_group("mesh").unwrap();
        group.link_external("other.h5", "geometry", "geometry").unwrap();
    });
    assert!(bench.message(&all).contains("`geometry` of `/Mesh/mesh/geometry` is a link, and links are not followed"));
    write(&|file| drop(file.create_group("Mesh").unwrap()));
    assert!(bench.message(&all).contains("numbers.h5: it has no array `/Mesh/mesh/geometry`"));
}

#[test]
fn an_array_that_claims_more_than_the_file_stores_is_refused_before_memory_is_taken() {
    let bench = Bench::new();
    let path = bench.path("claims.h5");
    with(&path, "cell_group", |file| {
        let all = file.new_dataset::<i64>().chunk(1024).shape(1_usize << 31);
        all.create("cell_group").unwrap();
    });
    let message = bench.message(&["mesh", "info", "claims.h5"]);
    assert!(message.contains("`cell_group` claims the shape [2147483648], more than the file can hold"), "{message}");
}

#[test]
fn a_file_without_a_seal_needs_trust_and_then_has_no_text_of_variable_length() {
    let bench = Bench::new();
    let path = bench.path("mesh.h5");
    mesh_file::write_mesh(&path, &dgmpm::rectangle([2.0, 1.0], [2, 1]).unwrap()).unwrap();
    // Another program opens and closes it for writing: the seal is cut off.
    h5::File::open_rw(&path).unwrap().new_dataset::<f64>().create("mine").unwrap().write_scalar(&1.0).unwrap();
    let message = bench.message(&["mesh", "info", "mesh.h5"]);
    assert!(message.contains("has no seal of dgmpm") && message.contains("give --trust"), "{message}");
    assert!(bench.good(&["mesh", "info", "mesh.h5", "--trust"]).contains("cells"));
    let texts = [h5::types::VarLenUnicode::new()];
    let file = h5::File::open_rw(&path).unwrap();
    file.unlink("groups").unwrap();
    file.new_dataset::<h5::types::VarLenUnicode>().shape(1).create("groups").unwrap().write_raw(&texts).unwrap();
    file.close().unwrap();
    let message = bench.message(&["--trust", "mesh", "info", "mesh.h5"]);
    assert!(message.contains("array `groups` holds") && message.contains("not used here"), "{message}");
}

#[test]
fn a_sealed_file_with_texts_of_variable_length_is_read_as_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    let mesh = dgmpm::rectangle([2.0, 1.0], [2, 1]).unwrap();
    // As versions of the program before this one wrote it.
    mesh_file::write_mesh(&path, &mesh).unwrap();
    let file = h5::File::open_rw(&path).unwrap();
    for (name, texts) in [("groups", &mesh.groups), ("edge_groups", &mesh.edge_groups)] {
        let texts: Vec<h5::types::VarLenUnicode> = texts.iter().map(|text| text.parse().unwrap()).collect();
        file.unlink(name).unwrap();
        let all = file.new_dataset::<h5::types::VarLenUnicode>().shape(texts.len()).create(name).unwrap();
        all.write_raw(&texts).unwrap();
    }
    file.close().unwrap();
    seal::put(&path).unwrap();
    assert_eq!(mesh_file::read_mesh(&path).unwrap(), mesh);
}

#[test]
fn texts_of_each_length_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    let mut mesh = dgmpm::rectangle([2.0, 1.0], [2, 1]).unwrap();
    for length in [0, 1, 63, 64, 65, 512, 513, 4096, 4097, 20_000] {
        mesh.groups[0] = "é".repeat(length / 2) + &"a".repeat(length % 2);
        mesh_file::write_mesh(&path, &mesh).unwrap();
        assert_eq!(mesh_file::read_mesh(&path).unwrap(), mesh, "{length}");
    }
    mesh.groups[0] = "a\0b".to_owned();
    assert_eq!(mesh_file::write_mesh(&path, &mesh).unwrap_err().exit_code(), 5);
    assert_eq!(hdf5::peek_attribute(&path, "format").as_deref(), Some("dgmpm mesh"));
}
