//! Clouds of all kinds, cells that cannot carry the degree, and the start from a cloud, as scenes ask for them.

use crate::common::{Bench, SCENE, bits};
use dgmpm::parts::io::cloud_file::{self, Extras};
use dgmpm::parts::io::points;
use dgmpm::parts::mesh::{Mesh, rectangle};
use dgmpm::parts::operators::Class;

fn mesh() -> Mesh {
    rectangle([1.0, 0.5], [4, 2]).unwrap()
}

/// What a run folder says of its points.
fn cloud(bench: &Bench, run: &str) -> (dgmpm::parts::cloud::Cloud, Extras) {
    cloud_file::read_with(&bench.path(run).join("cloud.h5"), &mesh()).unwrap()
}

#[test]
fn every_layout_runs_by_its_keys_and_each_key_changes_the_points() {
    let bench = Bench::new();
    let mut seen = Vec::new();
    for set in [
        "layout=\"random\"",
        "layout=\"random\", seed=2",
        "layout=\"random\", per_direction=5",
        "layout=\"cluster\"",
        "layout=\"cluster\", clusters=2",
        "layout=\"cluster\", radius=0.4",
        "layout=\"poisson-disk\"",
        "layout=\"poisson-disk\", spacing=0.05",
        "layout=\"poisson-disk\", seed=3",
        "layout=\"rotated\"",
        "layout=\"rotated\", angle=10",
        "layout=\"rotated\", spacing=0.04",
    ] {
        let output =
            bench.command("run case.toml --force").args(["--set", &format!("cloud={{{set}}}")]).output().unwrap();
        assert!(output.status.success(), "{set}: {}", String::from_utf8_lossy(&output.stderr));
        let xi = cloud(&bench, "runs/case").0.xi;
        assert!(!seen.contains(&xi), "{set} changes nothing");
        seen.push(xi);
    }
}

#[test]
fn keys_of_other_layouts_and_values_out_of_range_are_refused() {
    let bench = Bench::new();
    for (set, words) in [
        ("cloud={layout=\"random\", angle=3}", "unknown key `angle`"),
        ("cloud={layout=\"rotated\", spacing=-1}", "greater than 0"),
        ("cloud={layout=\"cluster\", clusters=0}", "from 1 to 100"),
        ("cloud={face_lebesgue=0.5}", "at least 1"),
        ("cloud={layout=\"hexagons\"}", "poisson-disk"),
        ("initial.from=\"cloud\"", "come from no file"),
    ] {
        let scene = SCENE.replace("velocity = [\"-200\", \"0\"]", "");
        bench.write("case.toml", &scene);
        let output = bench.command("run case.toml").args(["--set", set]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && said.contains(words), "{set}: {said}");
    }
}

/// Rows x, y of a 3 x 3 lattice in each cell but for cell 2, which is empty, and cell 5, which has one point.
fn holes() -> String {
    let mut rows = String::new();
    for cell in (0..8).filter(|cell| *cell != 2) {
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).filter(|at| cell != 5 || *at == (0, 0)) {
            let at = |c: usize, i: usize| 0.25 * (c as f64 + (i as f64 + 0.5) / 3.0);
            rows += &format!("{},{}\n", at(cell % 4, i), at(cell / 4, j));
        }
    }
    rows
}

#[test]
fn deficient_cells_are_said_stored_and_exported_and_strict_refuses_them_before_anything_is_written() {
    let bench = Bench::new();
    bench.write("points.csv", holes());
    let file = "--set cloud.layout=file --set cloud.path=points.csv";
    let said = bench.run(&format!("run case.toml {file}"));
    assert!(said.contains("2 of 8 cells cannot carry degree 1 and have virtual points on their Gauss nodes"), "{said}");
    assert!(
        said.contains("2 with too few points; worst: cell 3 (0 points, rank 0), cell 6 (1 point, rank 1)"),
        "{said}"
    );
    assert!(said.contains("classes of cells") && said.contains("6 lattice, 2 deficient"), "{said}");
    let (cloud, more) = cloud(&bench, "runs/case");
    assert_eq!((cloud.of(2).len(), cloud.of(5).len(), cloud.len()), (4, 4, 6 * 9 + 8));
    let flags: Vec<bool> = (0..8).flat_map(|c| cloud.of(c).iter().map(move |_| c == 2 || c == 5)).collect();
    assert_eq!(more.virtual_points, flags);
    let classes: Vec<Class> = more.certificates.iter().map(|c| c.class).collect();
    assert!(classes.iter().enumerate().all(|(c, class)| (*class == Class::Deficient) == (c == 2 || c == 5)));
    // dt = .9 limit h / c: .9 x .84 x .1667 x .25 / 5875.097 at F = 1 (the flux `dual` leaves .84 of the limit at degree 1).
    assert!(more.certificates.iter().all(|c| (c.dt / (0.9 * 0.84 * 0.1667 * 0.25 / 5875.097) - 1.0).abs() < 1e-6));
    bench.run("export runs/case --format vtu");
    let exported: Vec<_> =
        std::fs::read_dir(bench.path("runs/case/export")).unwrap().map(|f| f.unwrap().path()).collect();
    let last =
        exported.iter().filter(|f| f.file_name().unwrap().to_string_lossy().starts_with("points_0")).max().unwrap();
    let (_, fields) = points::read_with_fields(last).unwrap();
    let flag = fields.iter().find(|field| field.name == "virtual").unwrap();
    assert!(flag.values.iter().zip(&flags).all(|(a, b)| (*a == 1.0) == *b));
    // The cloud of the run is one that carries the degree, and still says what is virtual.
    let again = bench.run("solve case.toml --mesh runs/case/mesh.h5 --cloud runs/case/cloud.h5 --out runs/again");
    assert!(!again.contains("cannot carry") && again.contains("6 lattice, 2 deficient"), "{again}");
    assert_eq!(bits(&bench.last("runs/again").u), bits(&bench.last("runs/case").u));

    let message = bench.fail(2, &format!("preprocess case.toml {file} --strict"));
    assert!(message.contains("2 of 8 cells are beyond the limits (rank 4"), "{message}");
    assert!(message.contains("cell 3 (0 points, rank 0), cell 6 (1 point, rank 1)"), "{message}");
    assert!(message.contains("per_direction") && !bench.path("operators.h5").exists(), "{message}");
    bench.run(&format!("preprocess case.toml {file}"));
}

#[test]
fn a_named_lattice_is_replaced_only_by_a_limit_that_the_scene_gives_and_strict_names_it() {
    let bench = Bench::new();
    let paper = "--set scheme.degree=3 --set cloud.layout=paper --set time.end=2e-6";
    let said = bench.run(&format!("run case.toml {paper}"));
    assert!(!said.contains("virtual") && said.contains("8 lattice"), "{said}");
    let message = bench.fail(2, &format!("preprocess case.toml {paper} --strict"));
    assert!(message.contains("8 of 8 cells") && message.contains("face Lebesgue constant 124"), "{message}");
    bench.run(&format!("preprocess case.toml {paper} --strict --set cloud.face_lebesgue=200"));
    let said = bench.run(&format!("run case.toml {paper} --set cloud.face_lebesgue=60 --force"));
    assert!(
        said.contains("8 of 8 cells cannot carry degree 3") && said.contains("8 beyond a Lebesgue constant of 60"),
        "{said}"
    );
    // Methods without points have nothing to refuse.
    bench.run("preprocess case.toml --strict --set scheme.method=rk-dgfem --out rk.h5");
}

#[test]
fn a_run_goes_on_from_the_points_of_an_export_on_another_grid() {
    let bench = Bench::new();
    bench.run("run case.toml --set cloud.per_direction=4 --set scheme.degree=2");
    bench.run("export runs/case --format vtu");
    let mut files: Vec<_> = std::fs::read_dir(bench.path("runs/case/export"))
        .unwrap()
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.starts_with("points_0"))
        .collect();
    files.sort();
    let middle = bench.snapshots("runs/case")[0].time;
    let scene = SCENE
        .replace("velocity = [\"-200\", \"0\"]", "from = \"cloud\"")
        .replace("cells = [4, 2]", "cells = [5, 3]")
        .replace("end = 1e-4", &format!("start = {middle:e}\nend = 1e-4"))
        .replace("at = [5e-5, 1e-4]", "every_steps = 1000")
        .replace("degree = 1", "degree = 2");
    bench.write("on.toml", format!("{scene}[cloud]\nlayout = \"file\"\npath = \"runs/case/export/{}\"\n", files[0]));
    let said = bench.run("run on.toml");
    let first = &bench.snapshots("runs/on")[0];
    assert_eq!(first.time.to_bits(), middle.to_bits());
    // Kinetic and strain energy at the end are those of the run that went through, but for the grid: 3 % on 8 cells.
    let energy = |run: &str| {
        let summary = bench.summary(run);
        summary["kinetic_energy"].as_f64().unwrap() + summary["strain_energy"].as_f64().unwrap()
    };
    let ratio = energy("runs/on") / energy("runs/case");
    assert!((ratio - 1.0).abs() < 0.03, "{ratio}\n{said}");
    // The run folder starts again from its own cloud: the same state to rounding, nothing else needed.
    std::fs::remove_dir_all(bench.path("runs/case")).unwrap();
    bench.run("run runs/on/scene.toml --out runs/same");
    let again = &bench.snapshots("runs/same")[0];
    let scale = [1.0, 1.0, 1.0, 1.0, 7800.0 * 200.0, 7800.0 * 200.0];
    for (e, (a, b)) in first.u.iter().zip(&again.u).enumerate() {
        // Rounding times the Lebesgue constants of the fit.
        assert!((a - b).abs() < 1e-12 * scale[e / 9 % 6], "{e}: {a} {b}");
    }
}

#[test]
fn a_start_from_a_cloud_says_what_its_file_lacks() {
    let bench = Bench::new();
    bench.write("points.csv", holes());
    let scene = SCENE.replace("velocity = [\"-200\", \"0\"]", "from = \"cloud\"");
    bench.write("case.toml", format!("{scene}[cloud]\nlayout = \"file\"\npath = \"points.csv\"\n"));
    let message = bench.fail(2, "run case.toml");
    assert!(message.starts_with("error: case.toml:11:8: the cloud file has no field `deformation`"), "{message}");
    assert!(message.contains("velocity and deformation"), "{message}");
    let message = bench.fail(2, "run case.toml --set time.start=2e-4");
    assert!(message.contains("the run starts at"), "{message}");
    let message = bench.fail(2, "run case.toml --set time.start=6e-5");
    assert!(message.contains("before the start of the run"), "{message}");
    let message = bench.fail(2, "solve case.toml --cloud points.csv");
    assert!(message.contains("--set cloud.path=points.csv"), "{message}");
    // Inverted material at a point.
    let rows: String = holes().lines().map(|line| format!("{line},-1,0,0,1,0,0\n")).collect();
    let names = "x,y,deformation_11,deformation_12,deformation_21,deformation_22,velocity_1,velocity_2";
    bench.write("points.csv", format!("{names}\n{rows}"));
    let message = bench.fail(2, "run case.toml");
    assert!(message.contains("has J = -1"), "{message}");
    // A uniform state from rows: also in the cells without points.
    bench.write("points.csv", format!("{names}\n{}", rows.replace(",-1,0,0,1,0,0", ",1,0,0,1,-200,0")));
    bench.run("run case.toml --set output.0.every_steps=1000");
    let first = &bench.snapshots("runs/case")[0];
    for (e, value) in first.u.iter().enumerate() {
        let exact = [1.0, 0.0, 0.0, 1.0, -200.0 * 7800.0, 0.0][e / 4 % 6];
        assert!((value - exact).abs() < 1e-13 * exact.abs().max(1.0), "{e}: {value}");
    }
}

#[test]
fn internal_variables_of_points_go_along_bit_for_bit_and_a_file_without_them_is_refused() {
    let bench = Bench::new();
    let plastic = SCENE.replace("\"neo-hookean\"", "\"j2\"\nyield_stress = 4e8\nhardening = 1e10");
    bench.write("case.toml", &plastic);
    bench.run("run case.toml");
    bench.run("export runs/case --format vtu");
    let last = bench.last("runs/case");
    let from = plastic
        .replace("velocity = [\"-200\", \"0\"]", "from = \"cloud\"")
        .replace("end = 1e-4", "start = 1e-4\nend = 1.0001e-4")
        .replace("at = [5e-5, 1e-4]", "every_steps = 1");
    let file = format!("runs/case/export/points_{:06}.vtu", last.step);
    let scene = format!("{from}[cloud]\nlayout = \"file\"\npath = \"{file}\"\n");
    bench.write("on.toml", &scene);
    bench.run("run on.toml");
    // The same points in the same cells: five variables at each, and some of it has yielded.
    let first = &bench.snapshots("runs/on")[0];
    assert_eq!(bits(&first.internal), bits(&last.internal));
    assert!(last.internal.len() == 5 * 4 * 8 && last.internal.iter().any(|x| *x > 0.0 && *x < 0.5));
    // On another grid, and at nodes: each value is that of some point.
    for set in ["mesh.rectangle.cells=[5,3]", "scheme.method=rk-dgfem"] {
        bench.run(&format!("run on.toml --force --set {set}"));
        let first = &bench.snapshots("runs/on")[0];
        let known: Vec<u64> = bits(&last.internal);
        assert!(!first.internal.is_empty() && bits(&first.internal).iter().all(|x| known.contains(x)), "{set}");
    }
    // The run folder holds them, too.
    bench.run("run on.toml --force");
    bench.run("run runs/on/scene.toml --out runs/same");
    assert_eq!(bits(&bench.snapshots("runs/same")[0].internal), bits(&last.internal));
    bench.write("elastic.toml", SCENE);
    bench.run("run elastic.toml");
    bench.run("export runs/elastic --format vtu");
    let elastic = std::fs::read_dir(bench.path("runs/elastic/export")).unwrap().map(|f| f.unwrap().file_name());
    let points = elastic.map(|f| f.into_string().unwrap()).filter(|f| f.starts_with("points_0")).max().unwrap();
    bench.write("on.toml", scene.replace(&file, &format!("runs/elastic/export/{points}")));
    let message = bench.fail(2, "run on.toml --force");
    assert!(message.contains("no internal variable `"), "{message}");
}
