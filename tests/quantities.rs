//! Quantities of interest: their values against what is known of a motion, what they cost a run, and what is refused.

mod runs;
mod scenes;

use assert_cmd::Command;
use dgmpm::Folder;
use runs::Table;
use scenes::Body;
use serde_json::Value;
use std::path::Path;

/// Runs a scene in a folder, by the library; its summary.
fn summary(body: &Body, folder: &Path) -> Value {
    let folder = Folder::new(folder);
    body.problem(&[]).run_in(&folder).unwrap();
    serde_json::from_str(&std::fs::read_to_string(folder.summary()).unwrap()).unwrap()
}

/// The quantities of a run.
fn quantities(body: &Body) -> Value {
    let folder = tempfile::tempdir().unwrap();
    summary(body, folder.path())["quantities"].clone()
}

fn quantity(body: Body, name: &str, lines: &str) -> Body {
    body.table("[quantity]", &format!("name = \"{name}\"\n{lines}"))
}

/// A square of steel that flies at 50 m/s against a wall.
fn impact() -> Body {
    Body::square(6).side("left", "wall", "").velocity(["-50", "0"]).method("rk-dgfem").degree(2).end(1e-4)
}

#[test]
fn a_body_that_flies_keeps_its_lengths_and_moves_by_v_t() {
    // 40 m/s along x and 30 m/s along y for 1e-3 s.
    let body = Body::rectangle([1.0, 0.5], [4, 3]).velocity(["40", "30"]).method("rk-dgfem").degree(1).end(1e-3);
    let body = quantity(body, "length", "kind = \"extent\"");
    let body = quantity(body, "height", "kind = \"extent\"\naxis = \"y\"\nover = \"run\"");
    let body = quantity(body, "diagonal", "kind = \"length\"\nfrom = [0, 0]\nto = [1, 0.5]");
    let u = "kind = \"value\"\nat = [0.3, 0.2]\nfield = \"displacement\"";
    let body = quantity(body, "way", u);
    let body = quantity(body, "half_way", &format!("{u}\ntime = 3.3e-4"));
    let body = quantity(body, "mean_way", &format!("{u}\ncomponent = \"1\"\nover = \"run\"\nstatistic = \"mean\""));
    let body = quantity(body, "speed", "kind = \"peak\"\nfield = \"velocity\"");
    let body = quantity(body, "dissipated", "kind = \"energy\"\npart = \"dissipated\"");
    let found = quantities(&body);
    for (name, expected) in [
        ("length", 1.0),
        ("height", 0.5),
        ("diagonal", 1.25_f64.sqrt()),
        ("way", 0.05),
        ("half_way", 0.0165),
        ("mean_way", 0.02),
        ("speed", 50.0),
        ("dissipated", 0.0),
    ] {
        let value = found[name].as_f64().unwrap();
        // A uniform motion is exact but for the rounding of stresses that vanish, which some steps add up.
        assert!((value - expected).abs() < 1e-8 * expected.max(1e-3), "{name}: {value}");
    }
}

#[test]
fn the_mean_force_of_the_wall_changes_the_momentum_of_the_body() {
    let force = "kind = \"force\"\ngroup = \"left\"\nover = \"run\"\nstatistic = \"mean\"";
    let body = quantity(impact(), "force", force);
    let body = quantity(body, "above", "kind = \"force\"\ngroup = \"top\"\naxis = \"y\"\nover = \"run\"");
    let folder = tempfile::tempdir().unwrap();
    let found = summary(&body, folder.path());
    let change = found["momentum"][0].as_f64().unwrap() + 50.0 * 7800.0;
    let force = found["quantities"]["force"].as_f64().unwrap();
    // The trapezoidal rule over steps against the rule of Runge-Kutta; the jump at the first step counts most.
    assert!((force * 1e-4 / change - 1.0).abs() < 0.02, "{force:e} N/m, {change:e} kg/s");
    // A free side has no traction, to the last bit.
    assert_eq!(found["quantities"]["above"].as_f64().unwrap(), 0.0);
}

/// The force of a state's own traces was 0 at contact, and of the wrong size and sign on bodies of J2.
#[test]
fn a_force_is_that_of_the_output_at_contact_and_on_plastic_bodies() {
    let pair =
        Body::square(4).side("left", "wall", "").velocity(["-300", "0"]).method("ader-dgmpm").degree(2).end(1e-4);
    let plastic = pair.clone().material("j2", [2e11, 0.3, 7800.0], "yield_stress = 4e8\nhardening = 1e10");
    for (name, body) in [("elastic", pair), ("plastic", plastic)] {
        let of = |name: &str, lines: &str| format!("name = \"{name}\"\nkind = \"force\"\ngroup = \"left\"\n{lines}");
        let ways = [
            ("end", ""),
            ("at", "time = 4e-5"),
            ("most", "over = \"run\""),
            ("size", "over = \"run\"\nstatistic = \"abs\""),
        ];
        let body = ways.iter().fold(body, |body, (name, lines)| body.table("[quantity]", &of(name, lines)));
        let body = body.table("[output]", "kind = \"force\"\nname = \"walls\"\ngroups = [\"left\"]");
        let folder = tempfile::tempdir().unwrap();
        let found = summary(&body, folder.path())["quantities"].clone();
        let table = Table::read(&folder.path().join("tracks/walls.csv"));
        let (t, force) = (table.column("t [s]"), table.column("left_force_1 [N/m]"));
        let step = (1..t.len()).find(|&k| t[k] >= 4e-5).unwrap();
        let most = force[1..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let size = force[1..].iter().fold(0.0_f64, |size, force| size.max(force.abs()));
        for (key, expected) in [("end", force[t.len() - 1]), ("at", force[step]), ("most", most), ("size", size)] {
            // The same differences of the same sums.
            assert_eq!(found[key].as_f64().unwrap(), expected, "{name} {key}");
        }
        assert!(most > 1e8, "{name}: {most:e}");
    }
}

#[test]
fn energies_are_those_of_the_summary_and_a_run_without_a_number_says_null() {
    let body = quantity(impact(), "kinetic", "kind = \"energy\"\npart = \"kinetic\"");
    let body = quantity(body, "strain", "kind = \"energy\"\npart = \"strain\"");
    let line = "from = [0, 0.5]\nto = [1, 0.5]";
    // Shear does not jump along the middle of the body.
    let flat = "values = [1, 2]\nfield = \"velocity\"\ncomponent = \"2\"";
    let body = quantity(body, "none", &format!("kind = \"front-width\"\n{line}\n{flat}"));
    let folder = tempfile::tempdir().unwrap();
    let found = summary(&body, folder.path());
    for name in ["kinetic", "strain"] {
        assert_eq!(found["quantities"][name], found[&format!("{name}_energy")], "{name}");
    }
    assert!(found["quantities"]["none"].is_null() && found["quantities"].as_object().unwrap().contains_key("none"));
}

#[test]
fn quantities_change_no_bit_of_a_run_and_a_scene_without_any_has_no_observer_for_them() {
    let end = |body: &Body| {
        let folder = tempfile::tempdir().unwrap();
        let mut problem = body.problem(&[]);
        problem.run_in(&Folder::new(folder.path())).unwrap();
        problem.state.u
    };
    let bare = impact();
    let body = quantity(impact(), "a", "kind = \"peak\"\nfield = \"jacobian\"\nextreme = \"smallest\"\nover = \"run\"");
    let body = quantity(body, "b", "kind = \"force\"\ngroup = \"left\"\ntime = 5e-5");
    assert!(end(&bare) == end(&body));
    assert!(bare.problem(&[]).gauge().unwrap().is_none() && body.problem(&[]).gauge().unwrap().is_some());
}

#[test]
fn places_are_found_again_on_another_grid() {
    let line = "from = [0, 0.25]\nto = [1, 0.25]";
    // A shock in uniaxial strain: a plateau without waves from free sides behind it.
    let limited = impact().side("bottom", "symmetry", "").side("top", "symmetry", "");
    let limited = limited.table("limiter", "kind = \"moment\"");
    let body = quantity(limited, "v", "kind = \"value\"\nat = [0.9, 0.5]\nfield = \"velocity\"\ncomponent = \"1\"");
    let body = quantity(body, "width", &format!("kind = \"front-width\"\n{line}\nunit = \"m\""));
    let body = quantity(body, "j", "kind = \"peak\"\nfield = \"jacobian\"\nextreme = \"smallest\"");
    let once = quantities(&body);
    let again = quantities(&body.table("[regrid]", "at = [5e-5]\nrefine = 2"));
    // The front has not come there: both see the body fly, but for the ripples that the limiter leaves, at most 2 %.
    for found in [&once, &again] {
        assert!((found["v"].as_f64().unwrap() + 50.0).abs() < 1.0, "{found}");
    }
    // The front stays about as wide as the coarse cells have made it; the peak keeps its size.
    let [a, b] = [&once, &again].map(|found| found["width"].as_f64().unwrap());
    assert!((b / a - 1.0).abs() < 0.5, "{a} {b}");
    let [a, b] = [&once, &again].map(|found| 1.0 - found["j"].as_f64().unwrap());
    assert!(a > 0.0 && (b / a - 1.0).abs() < 0.5, "{a} {b}");
}

#[test]
fn what_the_start_lacks_for_a_quantity_is_found_before_results_change() {
    let folder = tempfile::tempdir().unwrap();
    // Left and right are one face.
    let sides =
        r#"{group="left",kind="periodic",partner="right"},{group="bottom",kind="free"},{group="top",kind="free"}"#;
    let scene = Body::square(4).method("rk-dgfem").degree(1).end(1e-5).write(folder.path(), "rest");
    let out = folder.path().join("out");
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("summary.json"), "old").unwrap();
    // The list of the files of the run: others are never replaced.
    std::fs::write(out.join(".dgmpm"), "summary.json\n").unwrap();
    for (table, words) in [
        (r#"{name="a",kind="force",group="left"}"#, "it is periodic"),
        (r#"{name="a",kind="overshoot"}"#, "give `range`"),
    ] {
        let mut command = Command::cargo_bin("dgmpm").unwrap();
        command.arg("run").arg(&scene).args(["--force", "--set", &format!("boundary=[{sides}]")]);
        command.args(["--set", &format!("quantity=[{table}]"), "--out"]).arg(&out);
        let output = command.output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && message.contains(words), "{table}: {message}");
        assert_eq!(std::fs::read_to_string(out.join("summary.json")).unwrap(), "old", "{table}");
    }
}

#[test]
fn a_run_that_is_lost_has_no_statistic_over_it_and_a_uniform_field_has_no_front() {
    let folder = tempfile::tempdir().unwrap();
    // 3.4 times as fast as waves, without limiter: cells at the wall turn inside out.
    let body =
        Body::square(4).side("left", "wall", "").velocity(["-20000", "0"]).method("rk-dgfem").degree(2).end(1e-3);
    let body = quantity(body, "force", "kind = \"force\"\ngroup = \"left\"\nover = \"run\"");
    let line = "kind = \"front-width\"\nfrom = [0, 0.5]\nto = [1, 0.5]";
    let body = quantity(body, "width", &format!("{line}\ntime = 0"));
    let path = Folder::new(folder.path());
    assert!(body.problem(&[]).run_in(&path).is_err());
    let found: Value = serde_json::from_str(&std::fs::read_to_string(path.summary()).unwrap()).unwrap();
    assert!(found["quantities"]["force"].is_null() && found["quantities"]["width"].is_null(), "{found}");
}

#[test]
fn what_is_wrong_with_a_quantity_is_one_message_and_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let scene = impact().write(folder.path(), "impact");
    let out = folder.path().join("out");
    for (tables, words) in [
        (r#"{name="a",kind="peek",field="velocity"}"#, "did you mean `peak`?"),
        (r#"{name="a",kind="force",group="lft"}"#, "did you mean `left`?"),
        (r#"{name="a",kind="value",at=[2,0.5],field="jacobian"}"#, "lies outside of the mesh"),
        (r#"{name="a",kind="overshoot",from=[0,0],to=[2,0]}"#, "lies outside of the mesh"),
        (r#"{name="a",kind="overshoot",from=[0,0]}"#, "no `to`"),
        (r#"{name="a",kind="extent"},{name="a",kind="energy"}"#, "two [[quantity]] have the name \"a\""),
        (r#"{name="a",kind="extent",time=1.0}"#, "after the end of the run"),
        (r#"{name="a",kind="extent",time=1e-5,over="run"}"#, "both `over` and `time`"),
        (r#"{name="a",kind="extent",statistic="max"}"#, "over = \"run\""),
        (r#"{name="l1",kind="extent"}"#, "another name"),
        (r#"{name="a b",kind="extent"}"#, "letters, digits"),
        (r#"{kind="extent"}"#, "needs the key `name`"),
        (r#"{name="a",kind="peak",field="piola"}"#, "needs a `component`"),
        (r#"{name="a",kind="peak",field="piola",component="1"}"#, "no component \"1\""),
        (r#"{name="a",kind="peak",field="plastic_strain"}"#, "law = \"j2\""),
        (r#"{name="a",kind="length",from=[0,0],to=[0,0]}"#, "the same point"),
        (r#"{name="a",kind="extent",axes="y"}"#, "did you mean `axis`?"),
    ] {
        let mut command = Command::cargo_bin("dgmpm").unwrap();
        command.arg("run").arg(&scene).args(["--set", &format!("quantity=[{tables}]"), "--out"]).arg(&out);
        let output = command.output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{tables}: {message}");
        assert!(message.contains(words) && message.matches("error").count() == 1, "{tables}: {message}");
        assert!(!out.exists(), "{tables}");
    }
}
