//! The folder of a run: what is in it stays the user's, and one run at a time writes there.

use crate::common::{Bench, results};
use std::fs;

#[test]
fn force_removes_what_dgmpm_has_made_and_nothing_else() {
    let bench = Bench::new();
    bench.run("run case.toml --out r");
    bench.run("export r --format vtu");
    let own = ["export/mine.vtu", "lines/notes.csv", "snapshots/notes.txt", "mesh_.h5", "thesis.tex", "tracks/own.csv"];
    own.iter().for_each(|file| fs::write(bench.path("r").join(file), "mine").unwrap());
    let said = bench.run("run case.toml --out r --force --set output=[] --set quantity=[]");
    assert!(said.contains("note: 4 files that dgmpm has not made, such as r/export/mine.vtu: kept"), "{said}");
    own.iter().for_each(|file| assert_eq!(fs::read_to_string(bench.path("r").join(file)).unwrap(), "mine", "{file}"));
    for gone in ["export/grid.pvd", "lines/bottom.csv", "snapshots/000000.h5"] {
        assert!(!bench.path("r").join(gone).exists(), "{gone}");
    }
}

#[test]
fn files_of_others_are_in_the_way_of_a_run_with_and_without_force() {
    let bench = Bench::new();
    for (file, text) in [("scene.toml", "mine"), ("mesh.h5", "mine"), ("cloud.h5", "mine"), ("ledger.csv", "t\n")] {
        fs::create_dir(bench.path("w")).unwrap();
        fs::write(bench.path("w").join(file), text).unwrap();
        for force in ["", "--force"] {
            let message = bench.fail(2, &format!("run case.toml --out w {force}"));
            assert!(message.contains(&format!("w/{file} is in the way")), "{message}");
        }
        assert_eq!(fs::read_dir(bench.path("w")).unwrap().count(), 1, "nothing else is there");
        assert_eq!(fs::read_to_string(bench.path("w").join(file)).unwrap(), text);
        fs::remove_dir_all(bench.path("w")).unwrap();
    }
    // The user's own folder, with its scene under the name that a run has for it.
    fs::rename(bench.path("case.toml"), bench.path("scene.toml")).unwrap();
    let message = bench.fail(2, "run scene.toml --out . --set scheme.degree=1");
    assert!(message.contains("scene.toml is in the way"), "{message}");
    assert_eq!(fs::read_to_string(bench.path("scene.toml")).unwrap(), crate::common::SCENE);
}

#[test]
fn a_run_does_not_remove_what_it_starts_from() {
    let bench = Bench::new();
    bench.run("run case.toml --out r --set regrid.0.every=9e-5");
    let before = results(&bench.path("r"));
    let mesh = fs::read_dir(bench.path("r")).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
    let mesh = mesh.into_iter().find(|name| name.starts_with("mesh_")).unwrap();
    for sets in [
        "--set initial={snapshot=\"snapshots/000000.h5\"} --set regrid=[]".to_owned(),
        format!("--set regrid=[{{at=[5e-5],mesh=\"{mesh}\"}}]"),
        format!("--set mesh={{file=\"{mesh}\"}}"),
    ] {
        let message = bench.fail(2, &format!("run r/scene.toml --out r --force {sets}"));
        assert!(message.contains("lies in r, where this run removes it or writes another file"), "{message}");
        assert_eq!(results(&bench.path("r")), before, "{sets}");
    }
    let message = bench.fail(2, "regrid r --mesh r/mesh.h5 --out ./r --force");
    assert!(message.contains("--out is the folder of the run itself"), "{message}");
    bench.run("run case.toml --out other --set regrid=[]");
    fs::remove_file(bench.path("other/scene.toml")).unwrap();
    let others = results(&bench.path("other"));
    let message = bench.fail(2, "regrid r --mesh r/mesh.h5 --out other");
    assert!(message.contains("other holds results of an earlier run"), "{message}");
    assert_eq!(results(&bench.path("other")), others);
}

#[test]
fn snapshots_of_another_body_are_refused_with_what_differs() {
    let bench = Bench::new();
    bench.run("run case.toml --out r --set regrid=[] --set output=[{kind=\"fields\",at=[2e-5]}] --set quantity=[]");
    let file = fs::read_dir(bench.path("r/snapshots")).unwrap().next().unwrap().unwrap().path();
    let from = format!(
        "run case.toml --out s --force --set regrid=[] --set output=[] --set quantity=[] --set initial={{snapshot={file:?}}}"
    );
    for (set, words) in [
        ("mesh.rectangle.cells=[2,4]", "another mesh"),
        ("mesh.rectangle.size=[2.0,1.0]", "another mesh"),
        ("material.0.density=2700", "other densities: 7800 instead of 2700 kg/m^3"),
        ("material.0.yield_stress=5e8", "other laws, or other parameters of them"),
        ("material.0.young=1e11", "other laws, or other parameters of them"),
    ] {
        let message = bench.fail(2, &format!("{from} --set {set}"));
        assert!(message.contains(words), "{set}: {message}");
    }
    bench.run(&format!("{from} --set scheme.safety=0.5"));
}

#[test]
fn a_run_whose_time_cannot_advance_says_why() {
    let bench = Bench::new();
    let plain = "run case.toml --force --out r --set output=[] --set quantity=[] --set regrid=[]";
    let message = bench.fail(2, &format!("{plain} --set time={{start=1e12,end=1.000000000001e12}}"));
    assert!(message.contains("the run would not get to its end") && message.contains("16 digits"), "{message}");
    let message = bench.fail(2, &format!("{plain} --set scheme.safety=1e-320"));
    assert!(message.contains("would not get to its end") && message.contains("safety"), "{message}");
}
