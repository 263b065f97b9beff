//! What is refused or said though the program could go on: conditions that would not act, parts that do not see each other,
//! numbers in other units, threads that nobody has, output that nobody gets.

use crate::common::{Bench, SCENE, bits};
use dgmpm::parts::io::{gmsh, mesh_file};
use dgmpm::parts::mesh::{BoundaryEdge, Mesh, rectangle};

/// The mesh of [`SCENE`], 4 x 2 cells, with the two edges at x = .5 in a group `inside`.
fn with_inner_edges() -> Mesh {
    let mut mesh = rectangle([1.0, 0.5], [4, 2]).unwrap();
    mesh.edge_groups.push("inside".to_owned());
    mesh.edges.extend([1, 5].map(|cell| BoundaryEdge { cell, face: 1, group: 4 }));
    mesh
}

/// [`SCENE`] on a mesh file, with more text behind it.
fn on(mesh: &Mesh, more: &str) -> Bench {
    let bench = Bench::empty();
    gmsh::write(mesh, &bench.path("mesh.msh")).unwrap();
    let scene = SCENE.replace("rectangle = { size = [1.0, 0.5], cells = [4, 2] }", "file = \"mesh.msh\"");
    bench.write("case.toml", format!("{scene}{more}"));
    bench
}

#[test]
fn a_condition_on_edges_inside_of_the_body_cuts_it_and_none_is_needed_there() {
    let whole = with_inner_edges();
    let mut partly = whole.clone();
    // One edge of the top, too.
    let top = partly.edges.iter_mut().find(|edge| edge.group == 3).unwrap();
    top.group = 4;
    let conditions = [
        "kind = \"free\"",
        "kind = \"clamped\"",
        "kind = \"traction\"\nvalue = [\"1e9\", \"0\"]",
        "kind = \"wall\"",
        "kind = \"periodic\"\npartner = \"left\"",
    ];
    for (mesh, boundary) in [(&whole, 0), (&partly, 1)] {
        for condition in conditions {
            let bench = on(mesh, &format!("[[boundary]]\ngroup = \"inside\"\n{condition}\n"));
            if !condition.contains("periodic") {
                let said = bench.run("run case.toml");
                let counts =
                    "note: the condition of `inside` cuts the body along 2 edge(s), of which both sides are boundary";
                assert!(said.contains(counts), "{condition}: {said}");
                assert_eq!(said.contains("and 1 edge(s) at one side of the body only"), boundary == 1, "{said}");
                // Both sides have the nodes of the cut: three more, of which one is shared with the top where that is cut, too.
                let mesh = mesh_file::read_mesh(&bench.path("runs/case/mesh.h5")).unwrap();
                assert_eq!(mesh.nodes.len(), 15 + 3);
                continue;
            }
            // The partner has no condition of its own then.
            let message = bench.fail(2, "run case.toml --set boundary.0.group=inside --set boundary.0.kind=periodic --set boundary.0.partner=right --set boundary.1.group=left --set boundary.4={group=\"right\",kind=\"periodic\",partner=\"inside\"}");
            let counts = format!("\"inside\" has 2 edge(s) inside of the body and {boundary} boundary edge(s)");
            assert!(message.contains(&counts) && message.contains("needs no [[boundary]]"), "{condition}: {message}");
            assert!(!bench.path("runs").exists());
        }
    }
    // Without a condition the group changes no bit.
    let (bench, plain) = (on(&whole, ""), Bench::new());
    assert!(!bench.run("run case.toml").contains("note: the group"));
    plain.run("run case.toml");
    assert_eq!(bits(&bench.last("runs/case").u), bits(&plain.last("runs/case").u));
    assert!(bench.run("mesh info mesh.msh").contains("edges of `inside`         2, all inside of the body"));
    // Partly inside: it is said, with counts, and the rest of the group is free.
    let bench = on(&partly, "");
    for command in
        ["mesh info mesh.msh", "mesh mesh.msh --out again.h5 --force", "preprocess case.toml", "run case.toml"]
    {
        let said = bench.run(command);
        assert!(said.contains("note: the group `inside` lies partly inside of the body: 2 edge(s) inside"), "{said}");
        assert!(said.contains("and 1 boundary edge(s)"), "{said}");
    }
    assert_eq!(bits(&bench.last("runs/case").u), bits(&plain.last("runs/case").u));
    assert!(bench.run("mesh info mesh.msh").contains("3, 2 of them inside of the body"));
    // A new grid in mid-run is cut, too.
    let bench = on(&rectangle([1.0, 0.5], [4, 2]).unwrap(), "[[regrid]]\nat = [5e-5]\nmesh = \"new.msh\"\n");
    let mut turned = rectangle([1.0, 0.5], [4, 2]).unwrap();
    turned.edges.push(BoundaryEdge { cell: 1, face: 1, group: 1 });
    gmsh::write(&turned, &bench.path("new.msh")).unwrap();
    bench.run("run case.toml");
    let mesh = mesh_file::read_mesh(&bench.path("runs/case").join(&bench.last("runs/case").grid.mesh)).unwrap();
    // One node more: the cut ends inside.
    assert_eq!(mesh.nodes.len(), 15 + 1);
}

#[test]
fn parts_that_share_no_edge_are_said_with_their_cells() {
    // Two bars side by side, in contact at x = .5: nodes of their own on both sides of it.
    let mut mesh = with_inner_edges();
    for (cell, corner, copy) in [(2, 0, 15), (2, 3, 16), (6, 0, 16), (6, 3, 17)] {
        if copy == mesh.nodes.len() {
            mesh.nodes.push(mesh.nodes[mesh.cells[cell][corner]]);
        }
        mesh.cells[cell][corner] = copy;
    }
    mesh.edges.extend([2, 6].map(|cell| BoundaryEdge { cell, face: 0, group: 4 }));
    let bench = on(&mesh, "[[boundary]]\ngroup = \"inside\"\nkind = \"free\"\n");
    let words = "note: the mesh has 2 parts that share no edge and do not see each other";
    let ends = "there is no contact between them unless a [[boundary]] says so";
    for command in
        ["mesh info mesh.msh", "mesh mesh.msh --out again.h5 --force", "preprocess case.toml", "run case.toml"]
    {
        let said = bench.run(command);
        assert!(said.contains(ends));
        assert!(said.contains(words) && said.contains("4 cell(s) with cell 1, 4 cell(s) with cell 3"), "{said}");
    }
    // One body says nothing; nor do parts that a periodic boundary joins.
    assert!(!Bench::new().run("run case.toml").contains("note: "));
    let joined = "--set boundary.0.kind=periodic --set boundary.0.partner=right --set boundary.1.group=inside";
    let bench = on(&mesh, "");
    assert!(!bench.run(&format!("run case.toml {joined}")).contains("parts"));
}

#[test]
fn numbers_that_look_like_other_units_are_named_with_the_unit_that_is_meant() {
    let bench = Bench::new();
    let said = |sets: &str| bench.run(&format!("run case.toml --force --set output=[] {sets}"));
    let expect = |sets: &str, words: &[&str]| {
        let said = said(sets);
        assert!(words.iter().all(|word| said.contains(word)), "{sets}: {said}");
    };
    // A stable step is 5.36e-6 s.
    expect("--set time.end=5e-6", &["note: the run is one step: it ends 5.000e-6 s", "times are in s"]);
    expect("--set time.start=1 --set time.end=1.000005", &["the run is one step"]);
    // c_p is 5875 m/s; with E in GPa and density in g/cm^3 it is 5.875.
    expect(
        "--set initial.velocity=[\"8e3*x\",0] --set initial.deformation=[1,0,0,1] --set time.end=1e-6",
        &[
            "the initial velocity is 7.577",
            "in cell 4, above the wave speed there, 5.8751e3 m/s",
            "in m/s",
            "in Pa",
            "kg/m^3",
        ],
    );
    expect(
        "--set material.0.young=200 --set material.0.density=7.8 --set time.end=1e-4",
        &["the initial velocity is 2.0000e2 m/s in cell 1, above the wave speed there, 5.8751e0 m/s"],
    );
    expect(
        "--set boundary.0.speed=\"6e7*t\"",
        &["the speed of the boundary `left` is 6.0000e3 m/s, above the wave speed"],
    );
    expect(
        "--set boundary.1.kind=velocity --set boundary.1.value=[\"5e9*t\",\"0\"] --set time.end=2e-6",
        &["the speed of the boundary `right` is 1.0000e4 m/s"],
    );
    expect(
        "--set mesh.rectangle.size=[1500,500] --set time.end=1e-1",
        &["note: the body is 1.5e3 m x 5e2 m large: lengths are in m"],
    );
    let info = bench.run("mesh rectangle --size 1500,1 --cells 4,2 --out long.h5");
    assert!(info.contains("note: the body is 1.5e3 m x 1e0 m large"), "{info}");
    assert!(bench.run("mesh info long.h5").contains("note: the body"));
    expect(
        "--set output=[{kind=\"ledger\",every=1e-7}]",
        &["note: `every` of output \"ledger\" is 1e-7 s, shorter than a step of 5.36"],
    );
    // At the limits of what is usual nothing is said.
    assert!(!said("").contains("note: "));
    assert!(!said("--set mesh.rectangle.size=[1000,500] --set time.end=1e-1").contains("note: "));
    assert!(
        !said("--set boundary.0.kind=free --set initial.velocity=[5.8e3,0] --set time.end=2e-5")
            .contains("initial velocity")
    );
}

#[test]
fn more_threads_than_four_a_core_are_refused_by_every_command_that_takes_them() {
    let bench = Bench::new();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let (most, more) = (4 * cores, 4 * cores + 1);
    for command in ["run case.toml", "solve case.toml", "study case.toml", "bench --oneline --steps 1 --cells 2,2"] {
        let message = bench.fail(2, &format!("{command} --threads {more}"));
        assert!(message.contains(&format!("--threads is {more}, and this machine has {cores} core(s)")), "{message}");
        assert!(message.contains(&format!("from 1 to {most}")), "{message}");
        assert!(bench.fail(2, &format!("{command} --threads 0")).contains("--threads is 0"));
    }
    assert!(!bench.path("runs").exists());
    bench.run(&format!("run case.toml --threads {most}"));
}

/// What every command says ends in a device that is always full, or in a pipe that nobody reads.
#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_is_exit_code_5_and_a_closed_pipe_is_no_fault() {
    use std::process::Stdio;
    let bench = Bench::new();
    bench.run("run case.toml --out there");
    bench.run("mesh rectangle --size 1,0.5 --cells 6,2 --out mesh.h5");
    let commands = [
        "mesh info mesh.h5",
        "mesh rectangle --size 1,1 --cells 2,2 --out a.h5 --force",
        "mesh mesh.h5 --out b.h5 --force",
        "seed case.toml --force",
        "preprocess case.toml",
        "solve case.toml --force",
        "run case.toml --force",
        "export there",
        "regrid there --mesh mesh.h5 --out on --force",
        "bench --oneline --steps 1 --cells 2,2 --degree 1",
        "--help",
        "run --help",
        "--version",
    ];
    for arguments in commands {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let output = bench.command(arguments).stdout(full).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(5), "dgmpm {arguments}: {said}");
        assert_eq!(said.matches("error: cannot write standard output: ").count(), 1, "dgmpm {arguments}: {said}");
        assert!(!said.contains("panicked"), "dgmpm {arguments}: {said}");
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = bench.command(arguments).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("error"), "dgmpm {arguments}: {said}");
    }
    // The run itself has done its work, and bad input is still what it was.
    assert_eq!(bench.summary("runs/case")["status"].as_str(), Some("done"));
    for (arguments, code) in [("mesh info none.h5", 2), ("runn", 2), ("", 2)] {
        let full = || std::fs::File::options().write(true).open("/dev/full").unwrap();
        let status = bench.command(arguments).stdout(full()).stderr(full()).status().unwrap();
        assert_eq!(status.code(), Some(code), "dgmpm {arguments}");
    }
}

/// A file takes the place of what has its name: of a device or a socket it must not.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_not_replaced_by_one() {
    let bench = Bench::new();
    let _socket = std::os::unix::net::UnixListener::bind(bench.path("socket")).unwrap();
    for arguments in
        ["mesh rectangle --size 1,1 --cells 2,2 --out socket --force", "seed case.toml --out socket --force"]
    {
        let message = bench.fail(5, arguments);
        assert!(message.contains("cannot write socket: it is no file but a device"), "{message}");
    }
    assert!(!std::fs::metadata(bench.path("socket")).unwrap().is_file());
}

#[test]
fn a_shift_by_steps_goes_there_and_back_and_one_too_far_is_found_before_the_first_step() {
    let bench = Bench::new();
    let rule = "[[regrid]]\nevery_steps = 2\nshift = [0.05, 0.02]\n";
    bench.write("case.toml", format!("{SCENE}{rule}"));
    bench.run("run case.toml --set output.0.every_steps=1");
    let summary = bench.summary("runs/case");
    let rows = bench.table("runs/case/regrid.csv").1;
    // At each second step after the start, but not at the end.
    let steps = summary["steps"].as_u64().unwrap();
    assert!(rows.len() as u64 == (steps - 1) / 2 && rows.len() >= 4, "{} regrids in {steps} steps", rows.len());
    // The first inner node goes by the shift and comes back: to the grid of the start, which has its file already.
    let node = |file: &str| mesh_file::read_mesh(&bench.path(&format!("runs/case/{file}"))).unwrap().nodes[6];
    let there = node(&format!("mesh_{:06}.h5", rows[0][0]));
    // A rounding of the sums.
    assert!((there[0] - 0.3).hypot(there[1] - 0.27) < 1e-15, "{there:?}");
    let grids: Vec<String> = bench.snapshots("runs/case").into_iter().map(|snapshot| snapshot.grid.mesh).collect();
    let mut names = grids.clone();
    names.sort();
    names.dedup();
    assert_eq!(
        (names.len(), &grids[grids.len() - 1][..]),
        (2, if rows.len().is_multiple_of(2) { "mesh.h5" } else { &names[1] })
    );
    // Steps do not shrink from grid to grid: a cell is .2 m wide in place of .25 m, and sheared by .02 m.
    let dt = |key: &str| summary[key].as_f64().unwrap();
    assert!(dt("dt_min") > 0.5 * dt("dt_max"), "{summary}");
    for shift in ["[0.3,0.0]", "[0.0,-0.25]"] {
        let bench = Bench::new();
        bench.write("case.toml", format!("{SCENE}{rule}"));
        let message = bench.fail(2, &format!("run case.toml --set regrid.0.shift={shift}"));
        assert!(message.contains("each second time the nodes go back"), "{message}");
        assert!(!bench.path("runs/case/snapshots").exists());
    }
    for rule in ["refine", "coarsen"] {
        bench.write("case.toml", format!("{SCENE}[[regrid]]\nevery_steps = 1000\n{rule} = 2\n"));
        let said = bench.run("run case.toml --force");
        let warning = format!("`{rule}` changes the cells that are there, again each time that it is due");
        assert!(said.contains("warning: case.toml:") && said.contains(&warning), "{said}");
    }
}

#[test]
fn a_path_says_that_the_points_come_from_a_file() {
    let bench = Bench::new();
    let rows: String = (0..8)
        .flat_map(|cell| [[0.05, 0.05], [0.2, 0.05], [0.05, 0.2], [0.2, 0.2]].map(|x| (cell, x)))
        .map(|(cell, x)| format!("{},{}\n", x[0] + 0.25 * f64::from(cell % 4), x[1] + 0.25 * f64::from(cell / 4)))
        .collect();
    for (name, mark) in [("points.csv", ""), ("marked.csv", "\u{feff}")] {
        bench.write(name, format!("{mark}{rows}"));
        bench.write("case.toml", format!("{SCENE}[cloud]\npath = \"{name}\"\n"));
        bench.run("run case.toml --force");
        // The first row is a point, with and without a mark before it.
        assert_eq!(bench.summary("runs/case")["points"].as_u64(), Some(32), "{name}");
    }
    bench.write("typo.csv", rows.replacen("0.05,", "0.05;", 1));
    let message = bench.fail(2, "run case.toml --force --set cloud.path=typo.csv");
    assert!(message.contains("typo.csv:1:1: `;` is not known as a separator"), "{message}");
    let message = bench.fail(2, "run case.toml --force --set cloud.layout=gauss");
    assert!(message.contains("[cloud] has a `path` and another `layout`"), "{message}");
    assert!(message.contains("layout = \"file\""), "{message}");
}

#[test]
fn a_start_from_a_snapshot_of_a_run_with_other_springs_is_said() {
    let bench = Bench::new();
    for (name, springs) in [("plain", false), ("springs", true)] {
        bench.run(&format!("run case.toml --out {name} --set scheme.springs={springs} --set checkpoint.every_steps=5"));
        let states = bench.snapshots(name);
        // Four faces of two points, and two numbers each.
        let creep = if springs { 8 * 4 * 2 * 2 } else { 0 };
        assert!(states.iter().all(|state| state.creep.len() == creep), "{name}");
        // A file without springs has no such array at all.
        let bytes = std::fs::read(bench.path(&format!("{name}/snapshots/{:06}.h5", states[0].step))).unwrap();
        assert_eq!(bytes.windows(5).any(|word| word == b"creep"), springs, "{name}");
    }
    let step = bench.snapshots("plain")[0].step;
    let said = |command: &str, from: &str, springs: bool| {
        let initial = format!("initial={{snapshot=\"{from}/snapshots/{step:06}.h5\"}}");
        let out = if command == "run" { "--out on --force" } else { "" };
        bench.run(&format!("{command} case.toml {out} --set {initial} --set scheme.springs={springs}"))
    };
    for command in ["check", "run"] {
        let told = said(command, "plain", true);
        assert!(told.contains("note: the snapshot has no creep of faces"), "{told}");
        let told = said(command, "springs", false);
        assert!(told.contains("note: the snapshot has the creep of faces of a run with springs"), "{told}");
        for springs in [false, true] {
            let told = said(command, if springs { "springs" } else { "plain" }, springs);
            assert!(!told.contains("the snapshot has"), "{told}");
        }
    }
    // What the last of them has from the snapshot goes on as in the run that did not stop.
    assert_eq!(bits(&bench.last("on").creep), bits(&bench.last("springs").creep));
    for (name, springs) in [("plain", "true"), ("springs", "false")] {
        let message = bench.fail(2, &format!("resume {name} --set scheme.springs={springs} --set time.end=2e-4"));
        assert!(message.contains("the checkpoint is of another scene: `scheme.springs` was"), "{message}");
    }
}

#[test]
fn cells_for_which_the_whole_body_waits_are_named() {
    let mut mesh = rectangle([1.0, 0.5], [4, 2]).unwrap();
    assert!(!on(&mesh, "").run("check case.toml").contains("allow a step of"));
    // The first column is 1/50 as wide as the cells that are left as they were (and its h_e = 2 hx hy/(hx + hy) 1/25.5): 2 of 8 cells.
    for node in mesh.nodes.iter_mut().filter(|node| node[0] == 0.25) {
        node[0] = 0.005;
    }
    let said = on(&mesh, "").run("check case.toml");
    assert!(said.contains("2 cell(s), such as cell 1, ") && said.contains("takes 25 times the steps"), "{said}");
}
