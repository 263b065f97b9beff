//! Another grid in mid-run, and of a stopped run: messages, files, and that runs go on.

use crate::common::{Bench, SCENE};
use dgmpm::parts::io::mesh_file;
use dgmpm::parts::mesh::{BoundaryEdge, Mesh, rectangle};

/// [`SCENE`] with a [[regrid]].
fn bench(rule: &str) -> Bench {
    let bench = Bench::new();
    bench.write("case.toml", format!("{SCENE}\n[[regrid]]\n{rule}\n"));
    bench
}

fn put(bench: &Bench, name: &str, mesh: &Mesh) {
    mesh_file::write_mesh(&bench.path(name), mesh).unwrap();
}

/// 6 x 3 cells whose inner nodes are moved: nothing of it is a grid of lines.
fn distorted() -> Mesh {
    let mut mesh = rectangle([1.0, 0.5], [6, 3]).unwrap();
    let inner = |x: &[f64; 2]| x[0] > 0.0 && x[0] < 1.0 && x[1] > 0.0 && x[1] < 0.5;
    mesh.nodes.iter_mut().filter(|x| inner(x)).for_each(|x| *x = [x[0] + 0.02, x[1] - 0.03 * x[0]]);
    mesh
}

#[test]
fn what_a_regrid_lacks_or_has_twice_is_said_with_its_place() {
    let rows = [
        ("mesh = \"a.msh\"", "needs the key `at`", "every_steps"),
        ("at = [5e-5]", "needs the key `mesh`", "rectangle"),
        ("at = [5e-5]\nrefine = 2\ncoarsen = 2", "has refine and coarsen", "keep one"),
        ("at = [5e-5]\nevery_steps = 3\nrefine = 2", "has both `at` and `every_steps`", "keep one"),
        ("at = [5e-5]\nrefine = 1", "`refine` is 1", "from 2 to 64"),
        ("at = [5e-5]\nrefine = 2\npoints = \"kep\"", "unknown `points` \"kep\"", "did you mean `keep`"),
        ("when = {}\nrefine = 2", "needs the key `certificate`", "front"),
        ("when = { distortion = 1.5 }\nrefine = 2", "`distortion` is 1.5", "between 0 and 1"),
        (
            "at = [5e-5]\nstrips = [{ axis = \"z\", around = 0.5, behind = 0, ahead = 0 }]",
            "unknown `axis` \"z\"",
            "\"x\"",
        ),
        ("at = [5e-5]\nstrips = [{ axis = \"x\", behind = 0, ahead = 0 }]", "needs the key `around`", "\"front\""),
    ];
    for (rule, what, remedy) in rows {
        let message = bench(rule).fail(2, "run case.toml");
        assert!(
            message.contains(what) && message.contains(remedy) && message.contains("case.toml:"),
            "{rule}: {message}"
        );
    }
}

#[test]
fn a_mesh_that_lacks_a_group_is_refused_before_the_first_step_with_those_that_it_has() {
    let bench = bench("at = [5e-5]\nmesh = [\"good.h5\", \"bad.h5\"]");
    put(&bench, "good.h5", &distorted());
    let mut bad = distorted();
    bad.edge_groups[3] = "roof".to_owned();
    put(&bench, "bad.h5", &bad);
    let message = bench.fail(2, "run case.toml");
    for words in ["bad.h5", "no group \"top\"", "left, right, bottom, roof"] {
        assert!(message.contains(words), "{words}: {message}");
    }
    assert!(!bench.path("runs/case/snapshots").exists());
    let message = self::bench("at = [5e-5]\nmesh = \"none.msh\"").fail(2, "run case.toml");
    assert!(message.contains("none.msh"), "{message}");
}

#[test]
fn another_body_in_mid_run_ends_the_run_with_both_areas_and_the_last_good_state() {
    // With the area and the centre of the body as far as they are compared before the first step.
    let bench = bench("at = [5e-5]\nrectangle = { size = [1.04, 0.48], cells = [5, 2] }");
    let message = bench.fail(2, "run case.toml");
    for words in ["regrid at step ", "lie outside of the old grid", "1.920e-2 m^2"] {
        assert!(message.contains(words), "{words}: {message}");
    }
}

#[test]
fn a_mesh_of_another_size_is_refused_before_the_first_step() {
    let bench = bench("at = [5e-5]\nmesh = \"large.h5\"");
    put(&bench, "large.h5", &dgmpm::parts::mesh::rectangle([1.2, 0.5], [5, 2]).unwrap());
    let message = bench.fail(2, "run case.toml");
    assert!(message.contains("large.h5 is of another body: its area is 6e-1 m^2"), "{message}");
    assert!(!bench.path("runs/case/snapshots").exists());
}

#[test]
fn gmsh_that_is_not_on_the_path_is_named_before_the_first_step() {
    let bench = bench("at = [5e-5]\ngeo = \"a.geo\"");
    bench.write("a.geo", "");
    let output = bench.command("run case.toml").env("PATH", bench.path("")).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains("there is no `gmsh` on the path") && message.contains("pip install gmsh"), "{message}");
}

/// Where Gmsh is on the path (it is for developers): a size field of t.
#[test]
fn gmsh_makes_a_mesh_with_a_size_field() {
    if std::process::Command::new("gmsh").arg("--version").output().is_err() {
        eprintln!("no gmsh on the path: nothing is looked at");
        return;
    }
    let bench = bench("at = [5e-5]\ngeo = \"a.geo\"\nsize = \"0.05 + 0.1*x\"");
    bench.write(
        "a.geo",
        "Point(1) = {0,0,0}; Point(2) = {1,0,0}; Point(3) = {1,0.5,0}; Point(4) = {0,0.5,0};\n\
         Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};\n\
         Curve Loop(1) = {1,2,3,4}; Plane Surface(1) = {1}; Recombine Surface {1};\n\
         Mesh.Algorithm = 8; Mesh.RecombinationAlgorithm = 3;\n\
         Physical Curve(\"left\", 1) = {4}; Physical Curve(\"right\", 2) = {2};\n\
         Physical Curve(\"bottom\", 3) = {1}; Physical Curve(\"top\", 4) = {3}; Physical Surface(\"body\", 5) = {1};\n",
    );
    let said = bench.run("run case.toml");
    assert!(said.contains("by clipping"), "{said}");
    let (header, rows) = bench.table("runs/case/regrid.csv");
    let cells = rows[0][header.iter().position(|name| name == "cells").unwrap()];
    // Sizes .05 at the left to .15 at the right: int dX / size^2 = .5 / .1 (1/.05 - 1/.15) = 67.
    assert!((40.0..110.0).contains(&cells), "{cells}");
}

#[test]
fn each_time_is_exported_on_its_own_grid_and_the_folder_can_be_moved_and_run_again() {
    let bench = bench("at = [5e-5]\nmesh = \"other.h5\"");
    put(&bench, "other.h5", &distorted());
    bench.run("run case.toml --out run");
    let states = bench.snapshots("run");
    let grids: Vec<&str> = states.iter().map(|state| state.grid.mesh.as_str()).collect();
    assert_eq!((grids[0], states[0].cells(), states[1].cells()), ("mesh.h5", 8, 18));
    assert_eq!(grids[1], format!("mesh_{:06}.h5", states[0].step));
    bench.run("export run");
    let cells = |state: &dgmpm::parts::io::snapshot::Snapshot| {
        let text = bench.read(&format!("run/export/grid_{:06}.vtu", state.step));
        let at = text.find("NumberOfCells=\"").unwrap() + 15;
        text[at..].split('"').next().unwrap().parse::<usize>().unwrap()
    };
    assert_eq!(states.iter().map(cells).collect::<Vec<_>>(), [8, 18]);
    let series = bench.read("run/export/series.xdmf");
    assert!(series.contains("series.h5:/mesh1/topology") && series.contains("NumberOfElements=\"18\""), "{series}");
    let moved = Bench::empty();
    std::fs::rename(bench.path("run"), moved.path("there")).unwrap();
    moved.run("run there/scene.toml --out again");
    assert_eq!(moved.last("again").u, states[1].u);
}

#[test]
fn the_ledger_says_what_regrids_lost_where_the_scene_has_some_and_a_balance() {
    let ledger = "[[output]]\nkind = \"ledger\"\nevery_steps = 1\n";
    let bench = bench(&format!("at = [5e-5]\nrectangle = {{ size = [1.0, 0.5], cells = [6, 3] }}\n{ledger}"));
    bench.run("run case.toml");
    let text = bench.read("runs/case/ledger.csv");
    let column = |name: &str| -> Vec<f64> {
        let at = text.lines().next().unwrap().split(',').position(|column| column == name).unwrap();
        text.lines().skip(1).map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
    };
    let (lost, energy) = (column("regrid_dissipation"), column("total_energy"));
    // Nothing before, and then what one regrid took: some of the energy of a shock that the new cells do not resolve as the
    // old ones do, below a hundredth of all.
    let last = lost[lost.len() - 1];
    assert!(lost[0] == 0.0 && last != 0.0 && last.abs() < 1e-2 * energy[0], "{lost:?}");
    assert_eq!(lost.iter().filter(|x| **x != 0.0 && **x != last).count(), 0);
}

#[test]
fn refining_coarsening_shifting_and_strips_give_the_meshes_that_they_say() {
    let rows = [
        ("refine = 2", 32.0),
        ("coarsen = 2", 2.0),
        ("shift = [0.01, 0.0]", 8.0),
        ("strips = [{ axis = \"x\", around = \"0.3 + 0*t\", behind = 0.1, ahead = 0.1, factor = 3 }]", 16.0),
        ("rectangles = [{ size = [1, 0.5], cells = [7, 3] }]", 21.0),
    ];
    for (grid, wanted) in rows {
        let bench = bench(&format!("at = [5e-5]\n{grid}"));
        bench.run("run case.toml");
        let (header, rows) = bench.table("runs/case/regrid.csv");
        assert_eq!(rows[0][header.iter().position(|name| name == "cells").unwrap()], wanted, "{grid}");
    }
    let message = bench("at = [5e-5]\ncoarsen = 3").fail(2, "run case.toml");
    assert!(message.contains("4 cells cannot be joined by 3") && message.contains("case.toml:"), "{message}");
}

#[test]
fn criteria_fire_when_they_are_met_and_not_before() {
    let fired = |when: &str| {
        let bench = bench(&format!(
            "every_steps = 2\nwhen = {{ {when} }}\nrectangle = {{ size = [1, 0.5], cells = [5, 3] }}\npoints = \"layout\""
        ));
        bench.run("run case.toml --set time.end=4e-5 --set output=[]");
        bench.table("runs/case/regrid.csv").1.first().map(|row| row[0])
    };
    // Paper's layout, degree 1: 2.25 on a square, 4 at a corner in 2D at most.
    assert_eq!((fired("certificate = 1.5"), fired("certificate = 50")), (Some(0.0), None));
    // A jump of 200 m/s within a cell or two; at the start nothing moves against anything.
    assert!(fired("front = 0.3").is_some_and(|step| step >= 2.0));
    assert_eq!(fired("distortion = 0.1"), None);
    assert!(fired("distortion = 0.999999").is_some_and(|step| step >= 2.0));
}

#[test]
fn a_stopped_run_goes_on_with_another_mesh() {
    let bench = Bench::new();
    bench.run("run case.toml --out first --set time.end=6e-5");
    put(&bench, "other.h5", &distorted());
    let step = bench.snapshots("first")[0].step;
    let said = bench.run(&format!("regrid first --mesh other.h5 --step {step} --out second"));
    assert!(said.contains("kinetic energy") && said.contains("dgmpm run second/scene.toml --out second"), "{said}");
    bench.run("export second");
    let moved = bench.last("second");
    assert_eq!((moved.step, moved.cells()), (step, 18));
    bench.run("run second/scene.toml --out second --force --set time.end=1e-4");
    let (before, after) = (bench.last("first"), bench.last("second"));
    assert!(after.step > before.step && (after.time - 1e-4).abs() < 1e-15 && after.cells() == 18);
    let message = bench.fail(2, "regrid first --mesh other.h5 --out second");
    assert!(message.contains("--force"), "{message}");
    let message = bench.fail(2, "regrid first --mesh other.h5 --step 999");
    assert!(message.contains("no such snapshot") && message.contains(&step.to_string()), "{message}");
    let message = bench.fail(2, "regrid first --mesh other.h5 --points many");
    assert!(message.contains("keep, enrich, layout"), "{message}");
    let message = bench.fail(2, "run second/scene.toml --out third --set time.end=1e-6");
    assert!(message.contains("the snapshot is at") && message.contains("later time.end"), "{message}");
}

#[test]
fn the_same_mesh_of_a_stopped_run_gives_the_bits_of_a_run_that_went_on() {
    let bench = Bench::new();
    bench.run("run case.toml --out whole");
    let states = bench.snapshots("whole");
    bench.run(&format!("regrid whole --mesh whole/mesh.h5 --step {} --out half", states[0].step));
    assert_eq!(bench.last("half").u, states[0].u);
    bench.run("run half/scene.toml --out on");
    // The last two steps are even in both, whatever came before.
    assert_eq!(bench.last("on").u, states[1].u);
}

/// Elastic-plastic impact, points that ignore the grid; the new grid leaves some cells, divides others.
#[test]
fn internal_variables_are_bit_for_bit_what_they_were_at_the_points_that_are_kept() {
    let bench = Bench::new();
    let plastic = SCENE.replace("law = \"neo-hookean\"", "law = \"j2\"\nyield_stress = 4e8\nhardening = 1e10");
    bench.write(
        "case.toml",
        format!("{plastic}[cloud]\nlayout = \"jitter\"\nper_direction = 5\nhistories = \"points\"\n"),
    );
    bench.run("run case.toml --out first");
    let mut new = rectangle([1.0, 0.5], [5, 2]).unwrap();
    new.nodes.iter_mut().enumerate().for_each(|(node, x)| x[0] = [0.0, 0.25, 0.4, 0.5, 0.75, 1.0][node % 6]);
    put(&bench, "new.h5", &new);
    bench.run("regrid first --mesh new.h5 --out second");
    let histories = |run: &str| {
        let (mesh, state) = (mesh_file::read_mesh(&bench.path(run).join("mesh.h5")).unwrap(), bench.last(run));
        let cloud = dgmpm::parts::io::cloud_file::read_with(&bench.path(run).join("cloud.h5"), &mesh).unwrap().0;
        let count = state.internal.len() / cloud.len();
        assert_eq!((count, state.internal.len() % cloud.len()), (5, 0));
        let of = |cell: usize| {
            let map = mesh.map(cell);
            cloud.of(cell).iter().map(move |&xi| dgmpm::parts::mesh::map::position(&map, xi))
        };
        let places: Vec<[f64; 2]> = (0..mesh.cells.len()).flat_map(of).collect();
        places.into_iter().zip(state.internal.chunks(5).map(<[f64]>::to_vec).collect::<Vec<_>>()).collect::<Vec<_>>()
    };
    let (before, after) = (histories("first"), histories("second"));
    assert!(before.iter().any(|(_, internal)| internal[4] > 1e-3), "nothing yields");
    let mut kept = 0;
    for (place, internal) in &after {
        // Positions are located to 2^-41 of a cell; points are some centimetres apart.
        let same = |(other, _): &&([f64; 2], Vec<f64>)| (place[0] - other[0]).hypot(place[1] - other[1]) < 1e-11;
        let Some((_, old)) = before.iter().find(same) else { continue };
        assert_eq!(internal, old, "at {place:?}");
        kept += 1;
    }
    assert!(kept > 150 && kept <= before.len(), "{kept} of {}", before.len());
    bench.run("run second/scene.toml --out third --set time.end=1.2e-4");
    let plastic = |run: &str| bench.last(run).internal.chunks(5).map(|h| h[4]).fold(0.0, f64::max);
    assert!(plastic("third") >= plastic("second"));
}

/// Nodes hold the histories of RK-DGFEM and ADER-DGFEM: copies keep theirs, new ones have the nearest.
#[test]
fn plastic_runs_of_all_methods_go_from_grid_to_grid() {
    for method in ["ader-dgmpm", "ader-dgfem", "rk-dgfem"] {
        let bench = Bench::new();
        let plastic = SCENE.replace("law = \"neo-hookean\"", "law = \"j2\"\nyield_stress = 4e8\nhardening = 1e10");
        let plastic = plastic.replace("ader-dgmpm", method);
        let strip = "strips = [{ axis = \"x\", around = \"front\", behind = 0.0, ahead = 0.2, factor = 2 }]";
        bench.write("case.toml", format!("{plastic}[[regrid]]\nevery = 2e-5\npoints = \"layout\"\n{strip}\n"));
        bench.run("run case.toml --out run");
        assert!(!bench.table("run/regrid.csv").1.is_empty(), "{method}");
        let (state, variables) = (bench.last("run"), 5);
        let strain = state.internal.chunks(variables).map(|history| history[4]);
        let mut yielded: Vec<f64> = strain.filter(|p| *p > 1e-3).collect();
        yielded.sort_by(f64::total_cmp);
        // The exact plateau of the uniaxial impact has .0258; these cells are 25 cm wide, and the free side is near.
        let middle = yielded[yielded.len() / 2];
        assert!((0.018..0.035).contains(&middle), "{method}: {middle}");
        bench.run("export run");
    }
}

/// Cells 0, 1, 4 and 5 of the 4 x 2 stay, the right half is divided along x.
fn half_divided() -> Mesh {
    let mut new = rectangle([1.0, 0.5], [6, 2]).unwrap();
    new.nodes.iter_mut().enumerate().for_each(|(node, x)| x[0] = [0.0, 0.25, 0.5, 0.625, 0.75, 0.875, 1.0][node % 7]);
    new
}

#[test]
fn the_creep_of_faces_goes_over_between_cells_that_are_copies_and_begins_at_0_elsewhere() {
    let bench = Bench::new();
    bench.run("run case.toml --out whole --set scheme.springs=true");
    let states = bench.snapshots("whole");
    let step = states[0].step;
    bench.run(&format!("regrid whole --mesh whole/mesh.h5 --step {step} --out half"));
    assert_eq!((&bench.last("half").u, &bench.last("half").creep), (&states[0].u, &states[0].creep));
    bench.run("run half/scene.toml --out on");
    assert_eq!((&bench.last("on").u, &bench.last("on").creep), (&states[1].u, &states[1].creep));
    put(&bench, "divided.h5", &half_divided());
    bench.run(&format!("regrid whole --mesh divided.h5 --step {step} --out divided"));
    let (old, new) = (&states[0].creep, bench.last("divided").creep);
    // Four numbers a face of two points: left, right, bottom, top.
    let of = |creep: &[f64], cell: usize, face: usize| creep[16 * cell + 4 * face..][..4].to_vec();
    for (cell, twin) in [(0, 0), (1, 1), (6, 4), (7, 5)] {
        for face in 0..4 {
            let stays = face != 1 || cell % 6 == 0;
            let wanted = if stays { of(old, twin, face) } else { vec![0.0; 4] };
            assert_eq!(of(&new, cell, face), wanted, "cell {cell}, face {face}");
        }
    }
    assert!((0..12).filter(|cell| cell % 6 > 1).all(|cell| (0..4).all(|face| of(&new, cell, face) == [0.0; 4])));
    assert!(of(old, 0, 1).iter().all(|a| *a != 0.0) && of(old, 1, 1) != [0.0; 4], "{old:?}");
    // The same cells, cut along an edge: both its sides are new.
    let mut cut = rectangle([1.0, 0.5], [4, 2]).unwrap();
    cut.edges.push(BoundaryEdge { cell: 1, face: 1, group: 1 });
    put(&bench, "cut.h5", &cut);
    bench.run(&format!("regrid whole --mesh cut.h5 --step {step} --out cut"));
    let new = bench.last("cut").creep;
    for (cell, face) in (0..8).flat_map(|cell| (0..4).map(move |face| (cell, face))) {
        let is_cut = [(1, 1), (2, 0)].contains(&(cell, face));
        let wanted = if is_cut { vec![0.0; 4] } else { of(old, cell, face) };
        assert_eq!(of(&new, cell, face), wanted, "cell {cell}, face {face}");
    }
    put(&bench, "other.h5", &distorted());
    bench.run(&format!("regrid whole --mesh other.h5 --step {step} --out other"));
    assert!(bench.last("other").creep.iter().all(|a| *a == 0.0));
}

#[test]
fn a_regrid_books_the_energy_of_the_springs_that_it_leaves() {
    let ledger = "[[output]]\nkind = \"ledger\"\nevery_steps = 1\n";
    let bench = Bench::new();
    put(&bench, "divided.h5", &half_divided());
    put(&bench, "other.h5", &distorted());
    for (mesh, keeps) in [("divided.h5", true), ("other.h5", false)] {
        let rule = format!("[[regrid]]\nat = [5e-5]\nmesh = \"{mesh}\"\n");
        bench.write("case.toml", format!("{SCENE}{rule}{ledger}"));
        bench.run("run case.toml --force --set scheme.springs=true");
        let (header, rows) = bench.table("runs/case/ledger.csv");
        let column = |name: &str| header.iter().position(|known| known == name).unwrap();
        let [total, faces, lost, left] = ["total_energy", "face_energy", "regrid_dissipation", "remainder"].map(column);
        let at = rows.iter().position(|row| row[lost] != 0.0).unwrap();
        let stored = |row: usize| rows[row][faces];
        // Of the halves that the wave has reached by then the left one stays.
        assert!(stored(at - 1) > 0.0 && if keeps { stored(at) > 0.0 } else { stored(at) < 0.1 * stored(at - 1) });
        // The remainder is rounding, of the energy at the start.
        assert!(rows.iter().all(|row| row[left].abs() < 1e-11 * rows[0][total]), "{mesh}");
    }
}
