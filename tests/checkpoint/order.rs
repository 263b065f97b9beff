//! The bits of a run do not depend on the order of the blocks of its cells: sums over the body are exact.

use crate::common::{Bench, assert_same};
use dgmpm::parts::io::operators_file;
use dgmpm::parts::operators::{Blocks, Line, Stored};
use dgmpm::parts::problem::{Problem, Setup, Store};
use dgmpm::parts::run::Folder;
use dgmpm::parts::scene::Scene;
use std::path::Path;

/// Stores the operators of a scene with its blocks in the opposite order.
fn store_turned(scene: &Scene, file: &Path) {
    let body = Setup::of(scene).body().unwrap();
    let (places, links) = (body.places(scene), scene.links(&body.mesh).unwrap());
    let needs = scene.needs(&places);
    let blocks = Blocks::new(&body.material, &links);
    let lists = blocks.cells.iter().zip(&blocks.count).map(|(cells, &count)| cells[..count].to_vec());
    let cells: Vec<usize> = lists.rev().flatten().collect();
    let sizes: Vec<usize> = blocks.count.iter().rev().copied().collect();
    let turned = Blocks::stored(&body.material, &links, &cells, &sizes).unwrap();
    assert!(turned.len() > 1 && turned.cells != blocks.cells);
    let key = operators_file::key(&body.mesh, &scene.periodic_groups(&body.mesh), &body.material, &needs);
    let stored = Stored::build(&body.mesh, &turned, &Line::new(needs.degree), &needs).unwrap();
    operators_file::write(file, &key, &turned, &stored, &[]).unwrap();
}

/// Runs a scene as it is, and with its blocks turned: the same files.
fn compare(name: &str, scene: &Path, sets: &[&str]) {
    let out = tempfile::tempdir().unwrap();
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = Scene::load(scene, &sets).unwrap();
    let [usual, turned] = ["usual", "turned"].map(|name| Folder::new(&out.path().join(name)));
    let (file, other) = (out.path().join("operators.h5"), out.path().join("other.h5"));
    store_turned(&scene, &file);
    Problem::new(&scene).unwrap().run_in(&usual).unwrap_or_else(|why| panic!("{name}: {why}"));
    let mut problem = Setup::of(&scene).store(Store { look: &[&file], write: Some(&other) }).build().unwrap();
    assert!(problem.origin.contains("reused") && !other.exists(), "{name}: {}", problem.origin);
    problem.run_in(&turned).unwrap_or_else(|why| panic!("{name}: {why}"));
    assert_same(name, &usual.root, &turned.root);
}

#[test]
fn the_order_of_the_blocks_changes_no_bit() {
    let bench = Bench::new();
    // Three blocks.
    let quiet = "checkpoint={every_minutes=60}";
    let cells = "mesh.rectangle.cells=[6,4]";
    compare("J2, regrid", &bench.path("case.toml"), &[quiet, cells]);
    let elastic = "material=[{law=\"neo-hookean\",young=2e11,poisson=0.3,density=7800}]";
    let jitter = "cloud={layout=\"jitter\",seed=1,amount=0.2}";
    compare("jitter", &bench.path("case.toml"), &[quiet, cells, elastic, jitter, "regrid=[]"]);
    let fem = "scheme.method=rk-dgfem";
    let limiter = "limiter={kind=\"moment\"}";
    let fast = "initial.velocity=[\"-1500\",\"0\"]";
    compare("limiter", &bench.path("case.toml"), &[quiet, cells, elastic, fem, limiter, fast, "regrid=[]"]);
}

#[test]
fn nor_does_it_where_bodies_meet() {
    let bench = Bench::new();
    bench.of_two_bodies();
    compare("contact", &bench.path("parts.toml"), &[]);
}
