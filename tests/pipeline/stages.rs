//! Each command on files, and the run folder.

use crate::common::{Bench, bits, tree};
use dgmpm::parts::io::{cloud_file, mesh_file};
use predicates::prelude::*;

#[test]
fn every_command_explains_itself() {
    let bench = Bench::empty();
    for command in ["check", "mesh", "seed", "preprocess", "solve", "run", "export"] {
        assert!(bench.run("--help").contains(command));
        assert!(bench.run(&format!("{command} --help")).contains("Usage: dgmpm"));
    }
    assert!(bench.run("--help").contains("Exit codes"));
    assert_cmd::Command::new(env!("CARGO_BIN_EXE_dgmpm"))
        .arg("--version")
        .assert()
        .success()
        .stdout(predicate::str::starts_with(concat!("dgmpm ", env!("CARGO_PKG_VERSION"))));
}

#[test]
fn check_says_what_a_run_will_cost_and_what_is_wrong_and_writes_nothing() {
    let bench = Bench::new();
    let before = tree(&bench.path("."));
    let said = bench.run("check case.toml");
    assert!(said.contains("first dt") && said.contains("estimate") && said.contains("the scene is complete"), "{said}");
    // The scene alone is in order; the point is in no cell.
    let message = bench.fail(2, "check case.toml --set output=[{kind=\"probe\",name=\"p\",point=[9.0,9.0]}]");
    assert!(message.contains("the point (9, 9) lies outside"), "{message}");
    assert_eq!(tree(&bench.path(".")), before);
}

#[test]
fn a_rectangle_is_written_inspected_and_carried_to_gmsh_and_back() {
    let bench = Bench::empty();
    let said = bench.run("mesh rectangle --size 3,1 --cells 6,2 --out a.h5");
    assert!(said.contains("written to a.h5"), "{said}");
    let info = bench.run("mesh info a.h5");
    for words in ["cells", "12", "area", "3.000000e0 m^2", "cells of `body`", "edges of `left`", "scaled Jacobian"] {
        assert!(info.contains(words), "{words}: {info}");
    }
    let mesh = mesh_file::read_mesh(&bench.path("a.h5")).unwrap();
    assert_eq!(mesh, dgmpm::parts::mesh::rectangle([3.0, 1.0], [6, 2]).unwrap());

    bench.run("mesh a.h5 --out a.msh");
    bench.run("mesh a.msh --out b.h5");
    let back = mesh_file::read_mesh(&bench.path("b.h5")).unwrap();
    assert_eq!((bits(back.nodes.as_flattened()), &back.cells), (bits(mesh.nodes.as_flattened()), &mesh.cells));
    assert_eq!(bench.run("mesh info a.msh").lines().count(), info.lines().count());
    // Without a name the output stands beside the input.
    bench.run("mesh a.msh --force");
    bench.fail(2, "mesh rectangle --size 3,1 --cells 6,2 --out a.h5");
}

#[test]
fn seed_knows_every_layout_and_a_file_of_points() {
    let bench = Bench::new();
    let mesh = dgmpm::parts::mesh::rectangle([1.0, 0.5], [4, 2]).unwrap();
    let count = |name: &str| cloud_file::read_with(&bench.path(name), &mesh).unwrap().0;
    for layout in ["paper", "midpoints", "gauss", "jitter"] {
        let said = bench
            .run(&format!("seed case.toml --set cloud.layout={layout} --set cloud.per_direction=3 --out {layout}.h5"));
        assert!(said.contains("8 cells with 9 points"), "{said}");
        assert_eq!(count(&format!("{layout}.h5")).len(), 72);
    }
    assert_eq!(count("paper.h5").of(0)[1], [0.25, 0.5]);
    assert_ne!(count("jitter.h5").of(0), count("jitter.h5").of(1));
    bench.run("seed case.toml --set cloud.layout=jitter --set cloud.seed=2 --set cloud.per_direction=3 --out j2.h5");
    assert_ne!(count("jitter.h5"), count("j2.h5"));

    // A cell is .25 x .25: the same four points in each, as rows x, y.
    let at = [0.0625, 0.1875];
    let mut rows = String::from("x,y\n");
    for (i, j) in (0..4).flat_map(|i| (0..2).map(move |j| (i, j))) {
        for (x, y) in at.iter().flat_map(|x| at.map(|y| (x, y))) {
            rows += &format!("{},{}\n", 0.25 * i as f64 + x, 0.25 * j as f64 + y);
        }
    }
    bench.write("points.csv", rows);
    let said = bench.run("seed case.toml --set cloud.layout=file --set cloud.path=points.csv --out file.h5");
    assert!(said.contains("8 cells with 4 points"), "{said}");
    // The points are those of the layout of the paper for k = 2, up to the rounding of the inverse map.
    bench.run("seed case.toml --out paper2.h5");
    let (file, paper) = (count("file.h5"), count("paper2.h5"));
    for cell in 0..8 {
        for x in paper.of(cell) {
            let near = |y: &&[f64; 2]| (x[0] - y[0]).abs() < 1e-14 && (x[1] - y[1]).abs() < 1e-14;
            assert_eq!(file.of(cell).iter().filter(near).count(), 1, "{x:?} in cell {cell}");
        }
    }
    bench.write("outside.csv", "0.1,0.1\n5,5\n");
    let message = bench.fail(2, "seed case.toml --set cloud.layout=file --set cloud.path=outside.csv --out o.h5");
    assert!(message.contains("outside.csv") && message.contains("outside the mesh"), "{message}");
}

#[test]
fn preprocess_reuses_its_file_for_the_same_input_and_builds_again_for_other() {
    let bench = Bench::new();
    let first = bench.run("preprocess case.toml --out op.h5");
    for words in ["first dt", "set by cell", "Lebesgue constant", "steps", "memory", "matrices written to op.h5"] {
        assert!(first.contains(words), "{words}: {first}");
    }
    let bytes = std::fs::read(bench.path("op.h5")).unwrap();
    // The end of the run is not part of the key.
    assert!(bench.run("preprocess case.toml --out op.h5 --set time.end=1e-5").contains("matrices reused from op.h5"));
    assert_eq!(std::fs::read(bench.path("op.h5")).unwrap(), bytes);
    for set in ["scheme.degree=2", "cloud.layout=gauss", "mesh.rectangle.cells=[5, 2]", "scheme.method=ader-dgfem"] {
        let said = bench
            .command("preprocess case.toml --out op.h5")
            .args(["--set", set])
            .output()
            .map(|output| String::from_utf8(output.stdout).unwrap())
            .unwrap();
        assert!(
            said.contains("op.h5 belongs to other mesh, cloud, degree or method; matrices written"),
            "{set}: {said}"
        );
        assert_ne!(std::fs::read(bench.path("op.h5")).unwrap(), bytes, "{set}");
    }
    let note = bench.run("preprocess case.toml --out high.h5 --set scheme.degree=4");
    assert!(note.contains("grows weakly"), "{note}");
}

#[test]
fn damaged_matrices_are_built_again_and_other_files_are_kept() {
    let bench = Bench::new();
    bench.run("preprocess case.toml --out op.h5");
    let whole = std::fs::read(bench.path("op.h5")).unwrap();
    let mut damaged = whole.clone();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 1;
    bench.write("op.h5", &damaged);
    let said = bench.run("preprocess case.toml --out op.h5");
    assert!(said.contains("op.h5 is damaged; matrices written to op.h5"), "{said}");
    assert_eq!(std::fs::read(bench.path("op.h5")).unwrap(), whole);
    bench.run("seed case.toml --out cloud.h5");
    bench.fail(2, "preprocess case.toml --out cloud.h5");
    bench.fail(2, "preprocess case.toml --out case.toml");
    assert!(bench.run("preprocess case.toml --out cloud.h5 --force").contains("matrices written"));
}

#[test]
fn stages_from_files_give_the_bits_of_one_run() {
    let bench = Bench::new();
    bench.run("run case.toml --out whole");
    bench.run("mesh rectangle --size 1,0.5 --cells 4,2 --out mesh.h5");
    bench.run("seed case.toml --mesh mesh.h5 --out cloud.h5");
    bench.run("preprocess case.toml --mesh mesh.h5 --cloud cloud.h5 --out op.h5");
    let said = bench.run("solve case.toml --mesh mesh.h5 --cloud cloud.h5 --operators op.h5 --out parts --threads 1");
    assert!(said.contains("matrices reused from op.h5"), "{said}");
    assert_eq!(bench.last("whole"), bench.last("parts"));
    assert_eq!(bench.read("whole/lines/bottom.csv"), bench.read("parts/lines/bottom.csv"));
    // Matrices of other input are not used, and not written over.
    let kept = std::fs::read(bench.path("op.h5")).unwrap();
    let said = bench.run("solve case.toml --operators op.h5 --set scheme.degree=2 --out other");
    assert!(said.contains("op.h5 belongs to other"), "{said}");
    assert_eq!(std::fs::read(bench.path("op.h5")).unwrap(), kept);
    assert!(bench.fail(2, "solve case.toml --operators none.h5 --out new").contains("none.h5: there is no such file"));
}

#[test]
fn a_run_folder_holds_what_the_design_names() {
    let bench = Bench::new();
    let said = bench.run("run case.toml");
    for file in ["scene.toml", "mesh.h5", "cloud.h5", "operators.h5", "ledger.csv", "summary.json", "lines/bottom.csv"]
    {
        assert!(bench.path("runs/case").join(file).is_file(), "{file}");
    }
    // The table at the end: phases under the paper's names, steps, rate, memory, energy and momentum.
    for words in
        ["small impact", "predictor (15)-(21)", "corrector (13)", "flux (3)", "steps", "DoF-updates/s", "memory"]
    {
        assert!(said.contains(words), "{words}: {said}");
    }
    for words in ["kinetic energy", "strain energy", "momentum 1", "min J", "results in runs/case"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let summary = bench.summary("runs/case");
    let keys = "method degree time_degree cells points dofs steps dt_min dt_max end_time threads cpu_seconds \
        wall_seconds phases dof_updates_per_second peak_memory_mib kinetic_energy strain_energy total_energy_ratio \
        momentum min_j max_curl_f max_drift norms status";
    for key in keys.split_whitespace() {
        assert!(!summary[key].is_null(), "{key}: {summary:#}");
    }
    for name in ["velocity_1", "velocity_2", "deformation_11", "deformation_22", "piola_11", "cauchy_stress_11"] {
        assert!(summary["norms"][name].as_f64().unwrap().is_finite(), "{name}");
    }
    // 8 cells with 4 points and 6 x 4 unknowns each.
    assert_eq!((summary["cells"].as_u64(), summary["points"].as_u64()), (Some(8), Some(32)));
    assert_eq!((summary["dofs"].as_u64(), summary["status"].as_str()), (Some(192), Some("done")));
    assert_eq!(summary["end_time"].as_f64(), Some(1e-4));
    assert!(summary["total_energy_ratio"].as_f64().unwrap() <= 1.0, "the wall does no work and fluxes dissipate");

    let (header, rows) = bench.table("runs/case/lines/bottom.csv");
    let names = "t s x y cauchy_stress_11 cauchy_stress_12 cauchy_stress_22 cauchy_stress_33 velocity_1 velocity_2";
    assert_eq!(header.join(" "), names);
    assert_eq!(rows.iter().map(|row| row[1]).collect::<Vec<_>>(), [0.0, 0.25, 0.5, 0.75, 1.0]);
    let (header, rows) = bench.table("runs/case/ledger.csv");
    assert_eq!(header[..6].join(" "), "step t dt kinetic_energy strain_energy total_energy");
    // 7800 kg/m^3 x .5 m^2 x (200 m/s)^2 / 2, to the rounding of sums over 32 nodes.
    assert!((rows[0][3] / 7.8e7 - 1.0).abs() < 1e-14, "{:?}", rows[0]);
    let last = rows.last().unwrap();
    assert_eq!((last[0] as u64, last[1], last[2]), (summary["steps"].as_u64().unwrap(), 1e-4, 0.0));
    // From the text: serde_json reads some numbers with an error of one unit in the last place.
    let text = bench.read("runs/case/summary.json");
    let energy = text.lines().find_map(|line| line.trim().strip_prefix("\"kinetic_energy\": ")).unwrap();
    assert_eq!(last[3].to_bits(), energy.trim_end_matches(',').parse::<f64>().unwrap().to_bits());
}

#[test]
fn a_run_folder_can_be_moved_and_run_again_with_the_same_bits() {
    let bench = Bench::new();
    bench.run("mesh rectangle --size 1,0.5 --cells 4,2 --out far.h5");
    bench.run("seed case.toml --set cloud.layout=jitter --out cloud.h5");
    let set = "--set mesh.file=far.h5 --set scheme.safety=0.5";
    bench.run(&format!("run case.toml {set} --out a"));
    // The cloud comes from a file although the scene names a layout.
    bench.run(&format!("solve case.toml {set} --set material.0.layout=gauss --cloud cloud.h5 --out b"));
    std::fs::remove_file(bench.path("far.h5")).unwrap();
    std::fs::remove_file(bench.path("cloud.h5")).unwrap();
    std::fs::create_dir(bench.path("moved")).unwrap();
    for run in ["a", "b"] {
        std::fs::rename(bench.path(run), bench.path("moved").join(run)).unwrap();
        bench.run(&format!("run moved/{run}/scene.toml --out again_{run}"));
        assert_eq!(bench.last(&format!("again_{run}")), bench.last(&format!("moved/{run}")), "{run}");
        // In its own place too, where it reads what it writes.
        bench.run(&format!("run moved/{run}/scene.toml --out moved/{run} --force"));
        assert_eq!(bench.last(&format!("again_{run}")), bench.last(&format!("moved/{run}")), "{run}");
    }
    assert_ne!(bench.last("again_a").u, bench.last("again_b").u);
}

#[test]
fn results_of_an_earlier_run_stay_without_force() {
    let bench = Bench::new();
    bench.run("run case.toml");
    let before = tree(&bench.path("runs"));
    let message = bench.fail(2, "run case.toml --set scheme.degree=2");
    assert!(message.contains("runs/case holds results of an earlier run") && message.contains("--force"), "{message}");
    assert_eq!(tree(&bench.path("runs")), before);
    // What is wrong with a scene is found before old results are removed.
    bench.fail(2, "run case.toml --force --set output.1.to=[9.0,0.0]");
    bench.fail(2, "run case.toml --force --set scheme.safety=2");
    assert_eq!(tree(&bench.path("runs")), before);
    bench.run("run case.toml --set scheme.degree=2 --force");
    assert_eq!(bench.summary("runs/case")["degree"].as_u64(), Some(2));
}

#[test]
fn export_writes_each_format_and_one_file_a_snapshot() {
    let bench = Bench::new();
    bench.run("run case.toml");
    assert!(bench.run("export runs/case --format vtu").contains("2 snapshots exported"));
    let names = |ending: &str| {
        let files = tree(&bench.path("runs/case/export"));
        files.iter().filter(|(path, _)| path.extension().is_some_and(|e| e == ending)).count()
    };
    assert_eq!((names("vtu"), names("pvd"), names("xdmf")), (4, 2, 0));
    // Again, with everything, over what is there.
    bench.run("export runs/case");
    assert_eq!((names("vtu"), names("pvd"), names("xdmf")), (4, 2, 3));
    // What moves goes into files of other names, beside the first ones.
    bench.run("export runs/case --format vtu,xdmf,vtkhdf --deformed");
    assert_eq!((names("vtu"), names("pvd"), names("xdmf"), names("vtkhdf")), (8, 4, 4, 2));
    for (beginning, positions) in [("grid_0", "X, in the initial configuration"), ("grid_deformed_0", "x = X + u")] {
        let files = tree(&bench.path("runs/case/export"));
        let is_it = |path: &std::path::Path| path.file_name().unwrap().to_string_lossy().starts_with(beginning);
        let (path, bytes) = files.iter().find(|(path, _)| is_it(path)).unwrap();
        let mesh = format!("mesh {} --out {beginning}.h5", path.display());
        // The deformed body is no initial configuration.
        match beginning == "grid_deformed_0" {
            true => assert!(bench.fail(2, &mesh).contains("x = X + u")),
            false => drop(bench.run(&mesh)),
        }
        let text = String::from_utf8_lossy(bytes);
        assert!(text.contains(&format!("positions: {positions}")), "{beginning}: where points are stands in the file");
    }
    let grid = bench.read("runs/case/export/grid.pvd");
    assert!(grid.contains("timestep=\"0.0001\"") || grid.contains("timestep=\"1e-4\""), "{grid}");
    let series = bench.read("runs/case/export/series.xdmf");
    for field in ["velocity", "displacement", "deformation", "piola", "cauchy_stress", "jacobian", "von_mises"] {
        assert!(series.contains(&format!("Name=\"{field}\"")), "{field}");
    }
}

#[test]
fn a_reader_that_closes_the_pipe_neither_stops_nor_breaks_a_run() {
    let bench = Bench::new();
    let mut child = bench
        .command("run case.toml")
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !errors.contains("panicked"), "{} {errors}", output.status);
    assert_eq!(bench.summary("runs/case")["status"].as_str(), Some("done"));

    let mut child = bench.command("run none.toml").stderr(std::process::Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}
