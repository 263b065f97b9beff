//! Outputs that follow numbers through time, against what is known of a motion: forces and momentum, a point of an exact solution,
//! extremes, energies and lengths; what they cost a run, and what is refused.

mod runs;
mod scenes;

use assert_cmd::Command;
use dgmpm::Folder;
use dgmpm::parts::problem::Problem;
use dgmpm::parts::scene::Scene;
use runs::Table;
use scenes::Body;
use std::path::{Path, PathBuf};

const METHODS: [&str; 3] = ["ader-dgmpm", "ader-dgfem", "rk-dgfem"];

/// The paper's impact on 6 x 6 cells: a wall at the left, symmetry at the bottom, free elsewhere, 200 m/s.
fn impact() -> Body {
    let body = Body::rectangle([3.0, 3.0], [6, 6]).side("left", "wall", "").side("bottom", "symmetry", "");
    body.velocity(["-200", "0"]).end(8e-4)
}

fn output(body: Body, kind: &str, name: &str, lines: &str) -> Body {
    body.table("[output]", &format!("kind = \"{kind}\"\nname = \"{name}\"\n{lines}"))
}

fn run(body: &Body, folder: &Path) -> Problem {
    let mut problem = body.problem(&[]);
    problem.run_in(&Folder::new(folder)).unwrap();
    problem
}

fn track(folder: &Path, name: &str) -> Table {
    Table::read(&folder.join("tracks").join(format!("{name}.csv")))
}

fn last(table: &Table, column: &str) -> f64 {
    *table.column(column).last().unwrap()
}

/// The momentum of a problem along x and y, kg/s.
fn momentum(problem: &Problem) -> [f64; 2] {
    problem.scheme.totals(&problem.state).momentum
}

/// int rho0 |v| dX of the impact at its start, kg/s.
const MOMENTUM: f64 = 9.0 * 200.0 * scenes::STEEL[2];

/// Compares the impulse of all groups with a change of momentum.
fn assert_impulse(table: &Table, change: [f64; 2], what: &str) {
    for (axis, change) in change.into_iter().enumerate() {
        let of = |side: &&str| last(table, &format!("{side}_impulse_{} [N s/m]", axis + 1));
        let impulse: f64 = scenes::SIDES.iter().map(of).sum();
        // The roundings of some hundred steps; 1e-10 is what the figure has to be good for.
        assert!((impulse - change).abs() < 1e-10 * MOMENTUM, "{what}, {axis}: {impulse:e} {change:e}");
    }
}

#[test]
fn the_impulse_of_all_groups_is_the_change_of_momentum_to_rounding() {
    for method in METHODS {
        for degree in [1, 2] {
            let folder = tempfile::tempdir().unwrap();
            let body = output(impact().method(method).degree(degree), "force", "walls", "");
            let before = momentum(&body.problem(&[]));
            let after = momentum(&run(&body, folder.path()));
            let table = track(folder.path(), "walls");
            let change = [after[0] - before[0], after[1] - before[1]];
            // The wall stops it and throws it back.
            assert!(change[0] > MOMENTUM, "{method} S{degree}: {change:?}");
            assert_impulse(&table, change, &format!("{method} S{degree}"));
        }
    }
}

#[test]
fn forces_of_the_steps_add_up_to_the_impulse_and_a_wall_at_rest_does_no_work() {
    let folder = tempfile::tempdir().unwrap();
    let body = output(impact().method("ader-dgmpm").degree(2), "force", "walls", "groups = [\"left\", \"top\"]");
    run(&body, folder.path());
    let table = track(folder.path(), "walls");
    let (t, force) = (table.column("t [s]"), table.column("left_force_1 [N/m]"));
    let impulse = table.column("left_impulse_1 [N s/m]");
    let sum: f64 = (1..t.len()).map(|k| force[k] * (t[k] - t[k - 1])).sum();
    // A division and a product by the same time in each of some hundred rows.
    assert!((sum / impulse.last().unwrap() - 1.0).abs() < 1e-11, "{sum:e}");
    assert_eq!((t[0], force[0], impulse[0]), (0.0, 0.0, 0.0));
    // The velocity of a wall at rest is 0 to the bit, and so is the traction of a free side.
    assert_eq!(last(&table, "left_work [J/m]"), 0.0);
    assert_eq!(last(&table, "top_impulse_2 [N s/m]"), 0.0);
    assert!(!table.has("right_force_1 [N/m]"));
}

#[test]
fn the_work_of_all_groups_is_that_of_the_boundary_in_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let body = Body::square(4).side("left", "velocity", "value = [\"20*sin(1e4*t)\", \"5\"]");
    let body = body.side("right", "traction", "value = [\"1e8*t/1e-4\", \"1e7\"]").method("ader-dgmpm").degree(2);
    let mut problem = output(body.end(1e-4), "force", "f", "").problem(&[]);
    let report = problem.run_in(&Folder::new(folder.path())).unwrap();
    let table = track(folder.path(), "f");
    let work: f64 = scenes::SIDES.iter().map(|side| last(&table, &format!("{side}_work [J/m]"))).sum();
    // The same products in another order.
    assert!((work / report.watch.work[0] - 1.0).abs() < 1e-12, "{work:e} {:?}", report.watch.work);
}

#[test]
fn an_impulse_goes_on_over_a_change_of_grid() {
    for method in METHODS {
        let folder = tempfile::tempdir().unwrap();
        let body = output(impact().method(method).degree(2), "force", "walls", "");
        let body = body.table("[regrid]", "at = [2e-4, 5e-4]\nrefine = 2").end(6e-4);
        let before = momentum(&body.problem(&[]));
        let after = momentum(&run(&body, folder.path()));
        let change = [after[0] - before[0], after[1] - before[1]];
        assert_impulse(&track(folder.path(), "walls"), change, method);
    }
}

#[test]
fn an_impulse_goes_on_over_a_restart() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    let body = output(impact().method("ader-dgmpm").degree(2), "force", "walls", "");
    let body = body.table("[output]", "kind = \"fields\"\nat = [4e-4]\nexact_times = true");
    let before = momentum(&body.problem(&[]));
    run(&body.clone().end(4e-4), &first);
    let snapshot = std::fs::read_dir(first.join("snapshots")).unwrap().last().unwrap().unwrap().path();
    let again = body.initial(&format!("snapshot = {snapshot:?}")).time("start = 4e-4\nend = 8e-4");
    let after = momentum(&run(&again, &second));
    let table = track(&second, "walls");
    assert_impulse(&table, [after[0] - before[0], after[1] - before[1]], "restart");
    // Its first row is the last of the run before.
    let column = "left_impulse_1 [N s/m]";
    assert_eq!(table.column(column)[0], last(&track(&first, "walls"), column));
}

#[test]
fn the_mean_of_the_quantity_force_is_the_balance_of_momentum() {
    let folder = tempfile::tempdir().unwrap();
    let force = "kind = \"force\"\nname = \"f\"\ngroup = \"left\"\nover = \"run\"\nstatistic = \"mean\"";
    let body = impact().method("ader-dgmpm").degree(2).table("[quantity]", force);
    let before = momentum(&body.problem(&[]));
    let after = momentum(&run(&body, folder.path()));
    let text = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mean = summary["quantities"]["f"].as_f64().unwrap();
    // Symmetry and free sides give nothing along x.
    assert!((mean * 8e-4 / (after[0] - before[0]) - 1.0).abs() < 1e-10, "{mean:e}");
}

/// The largest difference of a probe's deformation from the exact linear bar, on so many cells.
fn probe_error(cells: usize) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/linear_bar.toml");
    let sets = [
        format!("mesh.rectangle.cells=[{cells},1]"),
        "time.end=2.5e-4".to_owned(),
        "output=[{kind=\"probe\",name=\"p\",point=[1.37,0.02],fields=[\"deformation\",\"velocity\"]}]".to_owned(),
    ];
    let mut problem = Problem::new(&Scene::load(&path, &sets).unwrap()).unwrap();
    problem.run_in(&Folder::new(folder.path())).unwrap();
    let (table, exact) = (track(folder.path(), "p"), problem.scene.build_exact().unwrap());
    let (t, f11) = (table.column("t [s]"), table.column("deformation_11"));
    // The point moves by int v dt: its place is bounded by that of the displacement's sum.
    let (x, v) = (table.column("x [m]"), table.column("velocity_1 [m/s]"));
    let moved: f64 = (1..t.len()).map(|k| 0.5 * (t[k] - t[k - 1]) * (v[k] + v[k - 1])).sum();
    assert!((x[t.len() - 1] - 1.37 - moved).abs() < 1e-6, "{} {moved}", x[t.len() - 1]);
    let error = |(t, f): (&f64, &f64)| (exact.deformation([1.37, 0.02], *t)[0] - f).abs();
    t.iter().zip(&f11).map(error).fold(0.0, f64::max)
}

#[test]
fn a_probe_sees_the_exact_linear_bar_to_the_order_of_the_scheme() {
    let [coarse, fine] = [30, 60].map(probe_error);
    // Degree 2: order 3 in the mean of waves, at a point of a cell at least 2; measured rates are printed where it fails.
    assert!((coarse / fine).log2() > 2.0, "{coarse:e} {fine:e}");
    // A pulse of 1e-3.
    assert!(fine < 2e-5, "{fine:e}");
}

#[test]
fn a_probe_is_a_line_of_one_sample_and_is_found_again_on_another_grid() {
    let folder = tempfile::tempdir().unwrap();
    let body =
        impact().method("ader-dgmpm").degree(2).material("j2", scenes::STEEL, "yield_stress = 4e8\nhardening = 1e9");
    let body = output(body, "probe", "p", "point = [0.7, 1.1]\nfields = [\"von_mises\", \"plastic_strain\"]");
    let body = Body::text(&body);
    let line = "[[output]]\nkind = \"line\"\nname = \"l\"\nfrom = [0.7, 1.1]\nto = [0.8, 1.1]\nsamples = 2\nevery_steps = 1\n\
        fields = [\"von_mises\", \"plastic_strain\", \"displacement\"]\n[[regrid]]\nat = [2e-4]\nrefine = 2\n";
    let scene = Scene::parse(&format!("{body}{line}"), Path::new("test.toml"), &["time.end=3e-4".to_owned()]).unwrap();
    let mut problem = Problem::new(&scene).unwrap();
    problem.run_in(&Folder::new(folder.path())).unwrap();
    let (probe, line) = (track(folder.path(), "p"), Table::read(&folder.path().join("lines/l.csv")));
    for (column, of_line) in [("von_mises [Pa]", "von_mises"), ("plastic_strain", "plastic_strain")] {
        let line: Vec<f64> = line.column(of_line).into_iter().step_by(2).collect();
        let probe = probe.column(column);
        // A line has no row at the end but that of its step; here both have one each step.
        assert_eq!(probe[..line.len()], line[..], "{column}");
    }
    let u: Vec<f64> = line.column("displacement_1").into_iter().step_by(2).collect();
    let x = probe.column("x [m]");
    // X comes from the cell's corners: a rounding.
    u.iter().zip(&x).for_each(|(u, x)| assert!((0.7 + u - x).abs() < 1e-14, "{u} {x}"));
}

#[test]
fn a_spot_has_the_numbers_of_the_solution_to_the_bit() {
    use dgmpm::parts::observe::{Solution, Spot};
    for method in METHODS {
        let body = impact().method(method).degree(2).end(1e-4);
        let body = body.material("j2", scenes::STEEL, "yield_stress = 4e8\nhardening = 1e9");
        let mut problem = body.problem(&[]);
        problem.run().unwrap();
        let Problem { scheme, state, body, .. } = &problem;
        let solution = Solution::of_state(scheme, state, &body.material);
        for (cell, xi) in [(0, [0.0, 0.3]), (7, [0.41, 1.0]), (35, [0.9, 0.13])] {
            assert_eq!(Spot::new(scheme, cell, xi).of(scheme, state), solution.at(cell, xi), "{method} {cell}");
        }
    }
}

#[test]
fn extremes_bracket_every_sample_and_are_where_they_say() {
    let folder = tempfile::tempdir().unwrap();
    let velocity = "field = \"velocity\"\ncomponent = \"1\"";
    let body = output(impact().method("rk-dgfem").degree(2), "extreme", "v", velocity);
    let body = output(body, "extreme", "wall", &format!("{velocity}\ngroup = \"left\""));
    let body = output(body, "extreme", "cells", &format!("{velocity}\ngroup = \"body\""));
    let problem = run(&body.end(3e-4), folder.path());
    let [v, wall, cells] = ["v", "wall", "cells"].map(|name| track(folder.path(), name));
    let (low, high) = (v.column("smallest [m/s]"), v.column("largest [m/s]"));
    // What a snapshot of the end has: numbers at the nodes, which are among the places. Interpolation there rounds.
    let state = dgmpm::parts::observe::take(&problem.scheme, &problem.state);
    let n = problem.scheme.operators.nodes();
    let nodes: Vec<f64> =
        state.u.chunks(6 * n).flat_map(|cell| cell[4 * n..5 * n].iter().map(|p| p / scenes::STEEL[2])).collect();
    let [a, b] = runs::range(&nodes);
    assert!(low.last().unwrap() - 1e-10 <= a && b <= high.last().unwrap() + 1e-10, "{a} {b} {low:?} {high:?}");
    // On faces and corners the polynomial goes further than at the nodes, at most by some of the 200 m/s near a front.
    assert!(low.last().unwrap() > &(a - 40.0) && high.last().unwrap() < &(b + 40.0), "{a} {b} {low:?} {high:?}");
    // The places: on the left side the wall, and inside of the body.
    assert!(wall.column("largest_at_x [m]").iter().all(|x| x.abs() < 1e-15));
    assert!(wall.column("smallest [m/s]").iter().zip(&low).all(|(a, b)| a >= b));
    assert_eq!(cells.column("largest [m/s]"), high);
    let at = [last(&v, "largest_at_x [m]"), last(&v, "largest_at_y [m]")];
    let locator = dgmpm::Locator::new(&problem.body.mesh);
    assert!(locator.find(at).is_some());
}

/// Two bodies of different laws side by side, the left one plastic.
fn two_laws(folder: &Path) -> Body {
    let mut mesh = dgmpm::rectangle([2.0, 1.0], [8, 4]).unwrap();
    mesh.groups = vec!["soft".to_owned(), "hard".to_owned()];
    mesh.cell_group = (0..mesh.cells.len()).map(|cell| usize::from(mesh.corners(cell)[0][0] > 0.99)).collect();
    let path = folder.join("two.h5");
    dgmpm::parts::io::mesh_file::write_mesh(&path, &mesh).unwrap();
    let body = Body::of_file(&path).sides("free").side("left", "wall", "").velocity(["-60", "0"]).end(2e-4);
    let body = body.material("j2", scenes::STEEL, "group = \"soft\"\nyield_stress = 2e8\nhardening = 1e9");
    body.material("neo-hookean", scenes::STEEL, "group = \"hard\"").method("ader-dgmpm").degree(1)
}

#[test]
fn energies_by_material_sum_to_those_of_the_ledger() {
    let folder = tempfile::tempdir().unwrap();
    let body = output(two_laws(folder.path()), "energy", "e", "every_steps = 5").ledger(5);
    let out = folder.path().join("out");
    run(&body, &out);
    let (energy, ledger) = (track(&out, "e"), Table::read(&out.join("ledger.csv")));
    for (part, total) in
        [("kinetic", "kinetic_energy"), ("strain", "strain_energy"), ("dissipated", "material_dissipation")]
    {
        let [soft, hard] = ["soft", "hard"].map(|name| energy.column(&format!("{name}_{part} [J/m]")));
        let total = ledger.column(total);
        assert_eq!(soft.len(), total.len());
        for (row, total) in total.iter().enumerate() {
            // A sum of two parts in another order.
            assert!((soft[row] + hard[row] - total).abs() <= 1e-12 * total.abs(), "{part} {row}");
        }
        if part == "dissipated" {
            assert!(soft.last().unwrap() > &0.0 && hard.iter().all(|d| *d == 0.0));
        }
    }
}

#[test]
fn lengths_are_the_distance_of_two_probes_and_extents_of_groups() {
    let folder = tempfile::tempdir().unwrap();
    let body = impact().method("ader-dgfem").degree(2).end(3e-4);
    let body = output(body, "length", "l", "from = [0.2, 0.3]\nto = [2.5, 1.1]");
    let body = output(body, "probe", "a", "point = [0.2, 0.3]");
    let body = output(body, "probe", "b", "point = [2.5, 1.1]");
    let body = output(body, "length", "side", "group = \"left\"\naxis = \"y\"");
    let body = output(body, "length", "height", "group = \"body\"\naxis = \"y\"");
    let body = output(body, "length", "all", "axis = \"y\"");
    run(&body, folder.path());
    let [l, a, b] = ["l", "a", "b"].map(|name| track(folder.path(), name));
    let x = |table: &Table| (table.column("x [m]"), table.column("y [m]"));
    let ((ax, ay), (bx, by)) = (x(&a), x(&b));
    for (row, length) in l.column("length [m]").into_iter().enumerate() {
        // The same numbers to the bit.
        assert_eq!(length, (bx[row] - ax[row]).hypot(by[row] - ay[row]));
    }
    let of = |name: &str| track(folder.path(), name).column("length [m]");
    let (side, height, all) = (of("side"), of("height"), of("all"));
    assert!(height == all && side[0] == 3.0 && side.iter().zip(&all).all(|(side, all)| side <= all));
}

#[test]
fn what_is_followed_changes_no_bit_of_a_run_and_nothing_is_there_unless_asked() {
    let folder = tempfile::tempdir().unwrap();
    let (bare, full) = (folder.path().join("bare"), folder.path().join("full"));
    let body = impact().method("ader-dgmpm").degree(2).end(2e-4);
    let before = run(&body, &bare).state;
    let all = output(body.clone(), "force", "f", "");
    let all = output(all, "energy", "e", "");
    let all = output(all, "extreme", "x", "field = \"jacobian\"");
    let after = run(&all, &full).state;
    assert!(before.u == after.u && before.received.is_empty() && !after.received.is_empty());
    assert!(!bare.join("tracks").exists() && full.join("tracks").exists());
    // With the displacement, which a probe needs, the six unknowns stay as they are.
    let probe = run(&output(body, "probe", "p", "point = [1, 1]"), &folder.path().join("probe"));
    let n = probe.scheme.operators.nodes();
    let [own, other] = [&before, &probe.state].map(|state| {
        let all = state.unpack(&probe.scheme.operators.blocks, n);
        all.chunks(state.components * n).flat_map(|cell| cell[..6 * n].to_vec()).collect::<Vec<_>>()
    });
    assert!(own == other);
}

#[test]
fn what_is_wrong_with_an_output_through_time_is_one_message_and_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let scene: PathBuf = impact().method("rk-dgfem").degree(1).end(1e-5).write(folder.path(), "impact");
    let out = folder.path().join("out");
    for (table, words) in [
        (r#"{kind="probe",name="p",point=[4,1]}"#, "lies outside of the mesh"),
        (r#"{kind="probe",name="p",point=[1,1],fields=["velocty"]}"#, "did you mean `velocity`?"),
        (r#"{kind="probe",name="p",point=[1,1],fields=["plastic_strain"]}"#, "law = \"j2\""),
        (r#"{kind="probe",point=[1,1]}"#, "needs the key `name`"),
        (r#"{kind="prob",name="p",point=[1,1]}"#, "did you mean `probe`?"),
        (r#"{kind="force",name="f",groups=["lft"]}"#, "did you mean `left`?"),
        (r#"{kind="force",name="f",groups="lft"}"#, "did you mean `left`?"),
        (r#"{kind="force",name="f",group="left"}"#, "did you mean `groups`?"),
        (r#"{kind="extreme",name="x",field="piola"}"#, "needs a `component`"),
        (r#"{kind="extreme",name="x",field="velocity",component="3"}"#, "unknown `component`"),
        (r#"{kind="extreme",name="x",field="plastic_strain"}"#, "law = \"j2\""),
        (r#"{kind="extreme",name="x",field="jacobian",group="bodi"}"#, "did you mean `body`?"),
        (r#"{kind="length",name="l",from=[0,0]}"#, "no `to`"),
        (r#"{kind="length",name="l",from=[0,0],to=[0,0]}"#, "the same point"),
        (r#"{kind="length",name="l",from=[0,0],to=[9,0]}"#, "lies outside of the mesh"),
        (r#"{kind="length",name="l",from=[0,0],to=[1,0],group="left"}"#, "here it is both"),
        (r#"{kind="energy",name="a b"}"#, "letters, digits"),
    ] {
        let mut command = Command::cargo_bin("dgmpm").unwrap();
        command.arg("run").arg(&scene).args(["--set", &format!("output=[{table}]"), "--out"]).arg(&out);
        let output = command.output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{table}: {message}");
        assert!(message.contains(words) && message.matches("error").count() == 1, "{table}: {message}");
        assert!(!out.exists(), "{table}");
    }
}

/// Name and place of the effects of a run, and whether each has taken time.
fn effects_of(body: &Body) -> Vec<(String, String, bool)> {
    let folder = tempfile::tempdir().unwrap();
    run(body, folder.path());
    let text = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let text = |effect: &serde_json::Value, key: &str| effect[key].as_str().unwrap().to_owned();
    let of = |effect: &serde_json::Value| {
        assert!(
            effect["share"].as_f64().unwrap() >= 0.0 && effect["bytes"].is_u64() && effect["by_points"].is_boolean()
        );
        (text(effect, "effect"), text(effect, "where"), effect["seconds"].as_f64().unwrap() > 0.0)
    };
    summary["effects"].as_array().unwrap().iter().map(of).collect()
}

#[test]
fn a_run_reports_the_effects_that_it_had_and_no_others() {
    // 8 blocks: the clock is read for each of them, so that nothing that is done can take no time.
    let plain = Body::square(8).velocity(["10*sin(pi*x)", "0"]).method("ader-dgmpm").degree(2).end(2e-5);
    let names = |body: &Body| effects_of(body).into_iter().map(|(name, ..)| name).collect::<Vec<_>>();
    assert_eq!(names(&plain), ["curl control rotation", "output ledger"]);
    assert_eq!(names(&plain.clone().table("curl", "control = \"off\"")), ["output ledger"]);
    let full = plain.side("left", "wall", "").side("top", "absorbing", "").ledger(1);
    let full = full.scheme("springs", "true").scheme("flux", "\"dual\"");
    let full = full.table("[source]", "kind = \"gravity\"\nvalue = [0, -9.81]").table("limiter", "kind = \"moment\"");
    let full = full.table("[quantity]", "name = \"l\"\nkind = \"extent\"").table("[regrid]", "at = [1e-5]\nrefine = 2");
    let all = effects_of(&output(full, "force", "walls", ""));
    let named: Vec<&str> = all.iter().map(|(name, ..)| &name[..]).collect();
    let expected = [
        "condition wall",
        "condition absorbing",
        "source gravity",
        "curl control rotation",
        "limiter moment",
        "rescue",
        "balance of energy",
        "springs",
        "regrid",
        "output ledger",
        "output force",
        "quantities",
    ];
    assert_eq!(named, expected);
    assert!(all.iter().all(|(_, _, took_time)| *took_time), "{all:?}");
    // 16 cells on a side of 1 m after the change, 3 points each.
    assert_eq!((&all[0].1[..], &all[2].1[..], &all[8].1[..]), ("left, 48 points", "256 cells", "1 time"));
    // The row of the springs: they act in the flux, too, which has one clock.
    assert_eq!(all[7].1, "256 cells; and a part of the flux");
}

#[test]
fn a_force_on_a_periodic_group_is_refused_where_no_condition_acts() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Body::square(4).method("rk-dgfem").degree(1).end(1e-5).write(folder.path(), "square");
    let sides =
        r#"{group="left",kind="periodic",partner="right"},{group="bottom",kind="free"},{group="top",kind="free"}"#;
    for group in ["left", "right"] {
        let mut command = Command::cargo_bin("dgmpm").unwrap();
        let force = format!("output=[{{kind=\"force\",name=\"f\",groups=[\"top\",\"{group}\"]}}]");
        command.arg("run").arg(&scene).args(["--set", &format!("boundary=[{sides}]"), "--set", &force, "--out"]);
        let output = command.arg(folder.path().join("out")).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains("is periodic"), "{group}: {message}");
    }
}
