//! Bad input: exit code 2, one message with its place, and what would be right.

use crate::common::{Bench, SCENE};

#[test]
fn bad_scenes_are_named_by_file_line_and_column() {
    let bench = Bench::empty();
    // What is replaced by what, and where and how the message begins.
    let table = [
        ("degree = 1", "degre = 1", "26:1: unknown key `degre`", "did you mean `degree`"),
        ("group = \"top\"", "group = \"topp\"", "22:9: the mesh has no group \"topp\"", "did you mean `top`"),
        ("density = 7800.0", "density = -7800.0", "9:11: `density` is -7800", "greater than 0"),
        ("degree = 1", "degree = 3\ncfl = 0.4", "27:7: the step is", "scheme.cfl up to"),
        ("degree = 1", "degree = 1\nsafety = 1.5", "27:10: the step is 1.50", "safety up to 1"),
        ("to = [1.0, 0.0]", "to = [1.5, 0.0]", "36:6: sample 4 of 5 of the line, at (1.125, 0)", "inside of the body"),
        ("from = [0.0, 0.0]", "from = [0.0, -0.1]", "35:8: sample 1 of 5", "inside of the body"),
        (
            "\"-200\", \"0\"",
            "\"-200/x^20*0\", \"log(-1)\"",
            "11:28: the initial velocity v2 = `log(-1)` is NaN at X",
            "finite",
        ),
        ("velocity = [\"-200\", \"0\"]", "deformation = [\"x-0.5\", 0, 0, 1]", "11:15: the initial deformation", "> 0"),
        ("[mesh]", "[mesh", "2:6: this is not TOML", ""),
        // Files that are not there, at the key that names them.
        (
            "rectangle = { size = [1.0, 0.5], cells = [4, 2] }",
            "file = \"none.msh\"",
            "3:8: there is no file none.msh",
            "relative to the scene file",
        ),
        ("[[material]]", "[cloud]\npath = \"none.csv\"\n[[material]]", "5:8: there is no file none.csv", "relative"),
        ("velocity = [\"-200\", \"0\"]", "snapshot = \"none.h5\"", "11:12: there is no file none.h5", "relative"),
        (
            "[time]",
            "[[regrid]]\nat = [0.0]\nmesh = \"none.msh\"\n[time]",
            "29:8: there is no file none.msh",
            "relative",
        ),
        // More cells than any memory holds.
        ("cells = [4, 2]", "cells = [100000, 100000]", "3:42: 10000000000 cells of degree 1 need about", "fewer cells"),
    ];
    for (old, new, begins, remedy) in table {
        assert!(SCENE.contains(old), "{old}");
        bench.write("case.toml", SCENE.replacen(old, new, 1));
        let message = bench.fail(2, "run case.toml");
        assert!(message.starts_with(&format!("error: case.toml:{begins}")), "{new}: {message}");
        assert!(message.contains(remedy), "{new}: {message}");
        assert!(!bench.path("runs/case/summary.json").exists());
        // What is wrong is found before matrices are built and written.
        assert!(!bench.path("runs/case/operators.h5").exists(), "{new}");
    }
}

#[test]
fn a_state_that_is_sick_only_between_its_nodes_is_bad_input_too() {
    let bench = Bench::new();
    // J is .1 at the nodes of degree 2 (.113, .5, .887 of a cell of .25 m), below 0 at the points (.056) and faces outside of
    // them.
    let deformation = "initial.deformation=[\"1 - 0.9*(4*x - floor(4*x) - 0.5)^2/0.15\", 0, 0, 1]";
    let message = String::from_utf8(
        bench
            .command("run case.toml --set scheme.degree=2 --set cloud.layout=midpoints --set cloud.per_direction=9")
            .args(["--set", deformation])
            .output()
            .unwrap()
            .stderr,
    )
    .unwrap();
    assert!(message.contains("the initial state is lost: J = ") && message.contains("at material point"), "{message}");
}

#[test]
fn faults_that_show_in_mid_run_are_named_by_their_key() {
    let bench = Bench::new();
    // Infinite at t = 0, and at no time at which the predictor asks for it.
    let message = bench.fail(2, "run case.toml --set boundary.0.speed=1/t");
    assert!(message.starts_with("error: --set boundary.0.speed=1/t: step 1, t = "), "{message}");
    assert!(message.contains("the speed of the wall `left` `1/t` is inf at X = "), "{message}");
    // Area and centre of the body as far as they are compared before the first step, and another form.
    let grid = "[[regrid]]\nat = [5e-5]\nrectangle = { size = [1.04, 0.48], cells = [4, 2] }\n[time]";
    bench.write("case.toml", SCENE.replace("[time]", grid));
    let message = bench.fail(2, "run case.toml --force");
    assert!(message.starts_with("error: case.toml:29:13: regrid at step "), "{message}");
    assert!(message.contains("not a grid of the same body") && message.contains("cover 2.000e-2 m^2"), "{message}");
    let message = bench.fail(2, "run case.toml --force --set regrid.0.rectangle.size=[1.1,0.5]");
    // Found before the first step, as what follows.
    assert!(message.contains("the rectangle is not the body: its area is 5.5"), "{message}");
    let message = bench.fail(2, "run case.toml --force --set regrid.0.rectangle.cells=[100000,100000]");
    assert!(message.starts_with("error: case.toml:29:13: 10000000000 cells of degree 1 need"), "{message}");
}

#[test]
fn sets_that_are_wrong_are_named() {
    let bench = Bench::new();
    for (set, words) in [
        ("scheme.degre=2", "--set scheme.degre=2: unknown key"),
        ("scheme.degree", "there is no `=`"),
        ("boundary.7.kind=free", "has no place"),
        ("scheme.method=fem", "unknown `method` \"fem\""),
    ] {
        let message = bench.fail(2, &format!("run case.toml --set {set}"));
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn wrong_arguments_are_bad_input() {
    let bench = Bench::new();
    let usage = ["", "runn case.toml", "run", "run case.toml --threads two", "run case.toml --degree 2", "export"];
    for arguments in usage {
        assert_eq!(bench.command(arguments).output().unwrap().status.code(), Some(2), "dgmpm {arguments}");
    }
    for arguments in [
        "run none.toml",
        "run case.toml --threads 0",
        "mesh rectangle --size 3 --cells 2,2",
        "mesh rectangle --size -1,3 --cells 2,2",
        "mesh rectangle --size 1,3 --cells 0,2",
        "mesh info none.msh",
        "mesh none.h5",
        "solve case.toml --mesh none.h5",
        "solve case.toml --cloud none.h5",
        "export none",
        "run .",
    ] {
        bench.fail(2, arguments);
    }
    assert!(bench.fail(2, "export none").contains("none is not the folder of a run"));
    assert!(!bench.path("runs").exists());
}

/// Flips a bit in the middle of a file.
fn damage(bench: &Bench, name: &str) {
    let mut bytes = std::fs::read(bench.path(name)).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 16;
    bench.write(name, bytes);
}

#[test]
fn damaged_files_are_refused_by_name() {
    let bench = Bench::new();
    bench.run("mesh rectangle --size 1,0.5 --cells 4,2 --out mesh.h5");
    bench.run("seed case.toml --out cloud.h5");
    for name in ["mesh.h5", "cloud.h5"] {
        let option = if name == "mesh.h5" { "--mesh" } else { "--cloud" };
        let whole = std::fs::read(bench.path(name)).unwrap();
        damage(&bench, name);
        let message = bench.fail(2, &format!("solve case.toml {option} {name}"));
        assert!(message.starts_with(&format!("error: {name}: the file is damaged")), "{message}");
        // Cut, empty, text, a folder.
        for bytes in [&whole[..whole.len() / 3], b"", b"x,y\n1,2\n"] {
            bench.write(name, bytes);
            assert!(bench.fail(2, &format!("solve case.toml {option} {name}")).contains(name));
        }
        std::fs::remove_file(bench.path(name)).unwrap();
        std::fs::create_dir(bench.path(name)).unwrap();
        assert!(bench.fail(2, &format!("solve case.toml {option} {name}")).contains(name));
    }
    assert!(!bench.path("runs").exists());
}

#[test]
fn a_cloud_of_another_mesh_is_refused() {
    let bench = Bench::new();
    bench.run("seed case.toml --out cloud.h5");
    let message = bench.fail(2, "solve case.toml --cloud cloud.h5 --set mesh.rectangle.cells=[4,3]");
    assert!(message.contains("cloud.h5: the points were seeded on another mesh"), "{message}");
    let message = bench.fail(2, "preprocess case.toml --strict --set cloud.per_direction=1");
    assert!(message.contains("cell"), "{message}");
}

#[test]
fn export_refuses_what_is_no_whole_run() {
    let bench = Bench::new();
    bench.run("run case.toml --set output.0.kind=ledger --set output.0.at=[1e-4]");
    let message = bench.fail(2, "export runs/case");
    assert!(message.contains("holds no snapshot") && message.contains("kind = \"fields\""), "{message}");
    bench.run("run case.toml --force");
    let snapshot = "runs/case/snapshots/".to_owned();
    let name = std::fs::read_dir(bench.path(&snapshot)).unwrap().next().unwrap().unwrap().file_name();
    damage(&bench, &format!("{snapshot}{}", name.to_string_lossy()));
    let message = bench.fail(2, "export runs/case");
    assert!(message.contains(&*name.to_string_lossy()) && message.contains("damaged"), "{message}");
    bench.run("run case.toml --force");
    damage(&bench, "runs/case/mesh.h5");
    assert!(bench.fail(2, "export runs/case").contains("mesh.h5: the file is damaged"));
}

#[test]
fn a_file_in_the_place_of_a_folder_of_results_is_bad_input() {
    let bench = Bench::new();
    bench.run("run case.toml");
    bench.write("mine", "of the user");
    for command in [
        "run case.toml --out mine",
        "run case.toml --out mine/below/run",
        "run case.toml --out mine --force",
        "solve case.toml --out mine",
        "study case.toml --out mine",
        "plot runs/case --out mine",
        "bench --all mine",
        "mesh rectangle --size 1,1 --cells 2,2 --out mine/a.h5",
    ] {
        let message = bench.fail(2, command);
        assert!(message.contains("mine is no folder, and results go into a folder"), "{command}: {message}");
        assert!(message.contains("another folder by --out"), "{command}: {message}");
    }
    assert_eq!(bench.read("mine"), "of the user");
}

#[test]
fn a_series_for_paraview_is_no_mesh_and_info_tells_its_times() {
    let bench = Bench::new();
    bench.run("run case.toml");
    bench.run("export runs/case --format vtu,vtkhdf");
    for (file, what, own) in [
        ("grid.vtkhdf", "this is a VTKHDF file", "save it as .vtu"),
        ("grid.pvd", "a list of the .vtu files of a series", "one of the .vtu files that it names"),
    ] {
        let message = bench.fail(2, &format!("mesh runs/case/export/{file} --out a.h5"));
        assert!(message.contains(what) && message.contains(own), "{message}");
        assert!([".msh", ".vtu", ".xdmf", "mesh.h5"].iter().all(|known| message.contains(known)), "{message}");
    }
    let times = bench.snapshots("runs/case").iter().map(|state| state.time).collect::<Vec<_>>();
    let told: serde_json::Value = serde_json::from_str(&bench.run("info runs/case/export/grid.vtkhdf --json")).unwrap();
    assert_eq!(told["times"].as_u64(), Some(times.len() as u64), "{told}");
    let ends = [times[0], times[times.len() - 1]];
    assert_eq!(told["t_from_to_s"], serde_json::json!(ends));
}

#[test]
fn the_commands_that_a_first_scene_prints_can_be_pasted_where_paths_have_blanks() {
    let bench = Bench::empty();
    std::fs::create_dir(bench.path("my plates")).unwrap();
    bench.run("mesh rectangle --size 1,1 --cells 2,2 --out plate.h5");
    std::fs::rename(bench.path("plate.h5"), bench.path("my plates/the plate.h5")).unwrap();
    let output = bench.command("new").arg("my plates/the plate.h5").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let commands: Vec<&str> = said.lines().filter_map(|line| line.strip_prefix("  dgmpm ")).collect();
    assert_eq!(commands, ["run 'my plates/the plate.toml'", "plot 'runs/the plate'"], "{said}");
}

#[test]
fn springs_that_faces_cannot_have_are_refused_before_matrices_are_made_and_a_folder_is_there() {
    let bench = Bench::new();
    let j2 = SCENE.replace("law = \"neo-hookean\"", "law = \"j2\"\nyield_stress = 4e8\nhardening = 1e10");
    bench.write("j2.toml", j2);
    for (sets, what, remedy) in [
        ("case.toml --set scheme.springs=1", "`springs` is 1", "true or false"),
        ("case.toml --set scheme.springs=true --set scheme.flux=rusanov", "here it is `rusanov`", "flux = \"dual\""),
        (
            "case.toml --set scheme.springs=true --set limiter.kind=moment",
            "here it is `rusanov`, which the limiter `moment` brings",
            "flux = \"dual\"",
        ),
        ("case.toml --set scheme.springs=true --set scheme.degree=0", "at degree 0 the jump", "degree 1 or more"),
        ("j2.toml --set scheme.springs=true", "a law with internal variables has no springs", "another law"),
    ] {
        for command in ["check", "preprocess", "run"] {
            let output = bench.command(&format!("{command} {sets}")).output().unwrap();
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(2), "{command} {sets}: {message}");
            assert_eq!(message.matches("error: ").count(), 1, "{command} {sets}: {message}");
            assert!(message.contains(what) && message.contains(remedy), "{command} {sets}: {message}");
            assert!(message.contains("scheme.springs") && output.stdout.is_empty(), "{command} {sets}: {message}");
        }
    }
    // The two scenes, and nothing that was written.
    assert_eq!(std::fs::read_dir(bench.path(".")).unwrap().count(), 2);
    bench.run("check case.toml --set scheme.springs=true");
    bench.run("check case.toml --set scheme.springs=true --set limiter.kind=moment --set scheme.flux=dual");
}
