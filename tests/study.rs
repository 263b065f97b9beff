//! `dgmpm study`: its files, its predictions of errors, its reference, its refusals. Times are not tested: machines are noisy.

mod scenes;

use assert_cmd::Command;
use scenes::Body;
use std::path::{Path, PathBuf};

const MESHES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/meshes");

/// Runs a study of a scene into `out`; its standard output, or its error with the exit code.
fn study(scene: &Path, out: &Path, options: &str) -> Result<String, (i32, String)> {
    let mut command = Command::cargo_bin("dgmpm").unwrap();
    command.arg("study").arg(scene).arg("--out").arg(out).args(["--repeat", "1"]).args(options.split_whitespace());
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match output.status.code() {
        Some(0) => Ok(text(&output.stdout)),
        code => Err((code.unwrap_or(-1), text(&output.stderr))),
    }
}

fn scene(name: &str) -> PathBuf {
    Path::new(MESHES).join(name)
}

/// A column of `study.csv`, as text.
fn column(out: &Path, name: &str) -> Vec<String> {
    let text = std::fs::read_to_string(out.join("study.csv")).unwrap();
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let k = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(k).unwrap().to_owned()).collect()
}

fn numbers(out: &Path, name: &str) -> Vec<f64> {
    column(out, name).iter().map(|text| text.parse().unwrap()).collect()
}

#[test]
fn a_study_writes_its_table_its_plots_and_the_answer_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let options = "--methods rk-dgfem,ader-dgmpm --degrees 1,2 --refine 0.25,0.5 --layouts midpoints,gauss";
    let said = study(&scene("manufactured.toml"), folder.path(), options).unwrap();
    assert!(said.contains("for an error of") && said.contains("the exact solution"), "{said}");
    // RK at two degrees, ADER-DGMPM at two degrees and two layouts, on two meshes.
    let (methods, error) = (column(folder.path(), "method"), numbers(folder.path(), "error"));
    assert_eq!(methods.len(), 12);
    for series in 0..6 {
        assert!(error[series + 6] < error[series], "{error:?}");
    }
    for (steps, dofs) in numbers(folder.path(), "steps").into_iter().zip(numbers(folder.path(), "dofs")) {
        assert!(steps > 0.0 && dofs > 0.0);
    }
    assert!(numbers(folder.path(), "cpu_seconds").iter().all(|s| *s > 0.0));
    assert!(column(folder.path(), "status").iter().all(|status| status == "\"done\""));
    let text = std::fs::read_to_string(folder.path().join("study.csv")).unwrap();
    assert!(text.lines().any(|line| line.starts_with("# machine: dgmpm")), "{text}");
    for name in ["error_over_seconds", "error_over_dofs"] {
        let svg = std::fs::read_to_string(folder.path().join(format!("{name}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("rk-dgfem S2") && svg.contains("ader-dgmpm S1 gauss"));
        let png = std::fs::read(folder.path().join(format!("{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    }
    let all: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("study.json")).unwrap()).unwrap();
    assert!(!all["answers"].as_array().unwrap().is_empty() && !all["front"].as_array().unwrap().is_empty());
    let table = std::fs::read_to_string(folder.path().join("table.md")).unwrap();
    assert!(table.contains("| rk-dgfem S2 |") && table.contains("**"), "{table}");
}

#[test]
fn values_of_keys_are_compared_each_with_each_in_runs_that_differ_by_them_alone() {
    let folder = tempfile::tempdir().unwrap();
    let compare = "--compare curl.control=rotation|off --compare scheme.flux=dual|rusanov";
    let options = format!("--methods rk-dgfem --degrees 1 --refine 0.25,0.5 {compare}");
    let said = study(&scene("manufactured.toml"), folder.path(), &options).unwrap();
    let settings = [
        "rotation scheme.flux=dual",
        "rotation scheme.flux=rusanov",
        "off scheme.flux=dual",
        "off scheme.flux=rusanov",
    ];
    let settings = settings.map(|setting| format!("curl.control={setting}"));
    assert_eq!(column(folder.path(), "compared"), [&settings[..], &settings[..]].concat());
    // Rusanov's flux is not the dual one: the setting reaches the run.
    let error = numbers(folder.path(), "error");
    assert!(error[0] != error[1] && error[2] != error[3], "{error:?}");
    let all: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("study.json")).unwrap()).unwrap();
    let compared = all["compared"].as_array().unwrap();
    assert_eq!(compared.len(), 3);
    for (k, one) in (1..).zip(compared) {
        assert_eq!((one["pairs"].as_u64(), one["set"].as_str()), (Some(2), Some(&settings[k][..])));
        // The geometric mean over both meshes; the table has all digits.
        let expected = (error[k] * error[k + 4] / (error[0] * error[4])).sqrt();
        assert!((one["error"].as_f64().unwrap() / expected - 1.0).abs() < 1e-12, "{one}");
        assert!(said.contains(&format!("{} takes", settings[k])), "{said}");
    }
}

#[test]
fn a_setting_chosen_for_an_error_has_it_within_a_factor_of_two_of_the_prediction() {
    let folder = tempfile::tempdir().unwrap();
    study(&scene("manufactured.toml"), folder.path(), "--degrees 2,3 --refine 0.125,0.25,0.5 --error 1e-3").unwrap();
    let all: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("study.json")).unwrap()).unwrap();
    let tries = all["tries"].as_array().unwrap();
    let last = tries.last().unwrap();
    assert!(last["met"].as_bool().unwrap() && last["found"]["error"].as_f64().unwrap() <= 1e-3, "{last}");
    for one in tries {
        let ratio = one["found"]["error"].as_f64().unwrap() / one["predicted"]["error"].as_f64().unwrap();
        // The issue's figure.
        assert!((0.5..2.0).contains(&ratio), "{one}");
    }
}

#[test]
fn without_an_exact_solution_a_finer_run_stands_in_and_knows_its_own_error() {
    let folder = tempfile::tempdir().unwrap();
    // The smooth box: no exact solution.
    let scene = Body::smooth_box(8).write(folder.path(), "box");
    let json = |options: &str, out: &str| -> serde_json::Value {
        let out = folder.path().join(out);
        study(&scene, &out, options).unwrap();
        serde_json::from_str(&std::fs::read_to_string(out.join("study.json")).unwrap()).unwrap()
    };
    let base = "--methods rk-dgfem --degrees 2 --refine 0.5,1";
    // The reference S2 on 8 x 8 is the finest run of the study itself: against S5 its error is known.
    let coarse = json(&format!("{base} --reference 2,1"), "coarse");
    let fine = json(&format!("{base} --reference 5,1"), "fine");
    let estimated = coarse["reference_error"].as_f64().unwrap();
    let error = numbers(&folder.path().join("fine"), "error")[1];
    // Richardson on 2 x 2, 4 x 4 and 8 x 8 cells, of which the coarsest is before the asymptotic range.
    assert!((0.4..2.5).contains(&(estimated / error)), "{estimated:e} {error:e}");
    // Three degrees more on the same mesh: below a thousandth.
    assert!(fine["reference_error"].as_f64().unwrap() < 1e-3 * error);
    // Against itself a run has a distance of 0, which is no error: it is below that of the reference.
    let coarse_out = folder.path().join("coarse");
    assert!(numbers(&coarse_out, "velocity_l2")[1] < 1e-10 * numbers(&coarse_out, "velocity_l2")[0]);
    assert_eq!((&column(&coarse_out, "error")[1][..], column(&coarse_out, "error_below")[0].as_str()), ("", ""));
    let below = column(&coarse_out, "error_below")[1].parse::<f64>().unwrap();
    assert!((below / estimated - 1.0).abs() < 1e-9, "{below:e} {estimated:e}");
    let row = |all: &serde_json::Value| all["front"].as_array().unwrap().last().unwrap().clone();
    assert!(row(&coarse)["error"].is_null() && row(&coarse)["error_below"].as_f64() == Some(below), "{coarse}");
    assert!(row(&fine)["error"].as_f64() == Some(error) && row(&fine)["error_below"].is_null(), "{fine}");
}

#[test]
fn a_mesh_file_is_refined_by_cutting_its_cells() {
    let folder = tempfile::tempdir().unwrap();
    let options = "--methods ader-dgmpm --degrees 1 --refine 1,2 --set output=[] --set time.end=2e-5 --reference 2,2";
    study(&scene("plate_hole.toml"), folder.path(), options).unwrap();
    let cells = numbers(folder.path(), "cells");
    assert_eq!(cells[1], 4.0 * cells[0]);
    let error = numbers(folder.path(), "error");
    assert!(error[1] < error[0], "{error:?}");
}

#[test]
fn at_a_shock_the_l1_error_falls_faster_than_the_standard_one_and_the_front_stays_as_narrow_in_cells() {
    let folder = tempfile::tempdir().unwrap();
    let line = "from=[0.0,0.05],to=[3.0,0.05]";
    let quantities = format!(
        r#"quantity=[{{name="width",kind="front-width",{line}}},{{name="over",kind="overshoot",{line}}},{{name="v",kind="value",at=[0.5,0.05],field="velocity",component="1"}}]"#
    );
    let fixed = "--methods ader-dgmpm --degrees 1 --refine 1,2 --measure l1 --set limiter.kind=moment";
    let mesh = "mesh.rectangle={size=[3.0,0.1],cells=[30,1]}";
    let options = format!("{fixed} --set {quantities} --set {mesh} --set output=[]");
    let said = study(&scene("wall_impact.toml"), folder.path(), &options).unwrap();
    assert!(said.contains("relative error (L1)") && said.contains("is an error itself"), "{said}");
    let rate = |name: &str| {
        let error = numbers(folder.path(), name);
        (error[0] / error[1]).log2()
    };
    // 1/2 and 1 are the rates at a jump; on meshes this coarse within a quarter.
    assert!(
        (rate("error") - 0.5).abs() < 0.25 && (rate("error_l1") - 1.0).abs() < 0.25,
        "{} {}",
        rate("error"),
        rate("error_l1")
    );
    let width = numbers(folder.path(), "quantity_width");
    assert!(
        width.iter().all(|cells| (1.0..4.0).contains(cells)) && (width[1] / width[0] - 1.0).abs() < 0.3,
        "{width:?}"
    );
    // What is an error itself has its value for its error; the limiter leaves little of the 20 % without it.
    let over = numbers(folder.path(), "quantity_over");
    assert!(
        over == numbers(folder.path(), "quantity_over_error") && over.iter().all(|share| *share < 0.05),
        "{over:?}"
    );
    // Behind the shock the body is at rest: an error by the size of what is exact, 0, is absolute, m/s of 200 m/s.
    let v = numbers(folder.path(), "quantity_v_error");
    assert!(v.iter().all(|v| *v < 2.0), "{v:?}");
}

/// The smooth box on 4, 8 and 16 cells, with quantities.
fn smooth_box_with_quantities(folder: &Path) -> PathBuf {
    let kinetic = "name = \"kinetic\"\nkind = \"energy\"\npart = \"kinetic\"";
    let force = "name = \"force\"\nkind = \"force\"\ngroup = \"right\"\nover = \"run\"\nstatistic = \"mean\"";
    Body::smooth_box(8).table("[quantity]", kinetic).table("[quantity]", force).write(folder, "box")
}

fn json(out: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(out.join("study.json")).unwrap()).unwrap()
}

#[test]
fn where_nothing_exact_is_known_three_meshes_tell_the_error_of_a_quantity() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (smooth_box_with_quantities(folder.path()), folder.path().join("out"));
    let options = "--methods rk-dgfem --degrees 2 --refine 0.5,1,2 --measure kinetic";
    let said = study(&scene, &out, options).unwrap();
    // No reference run is made for it.
    assert!(said.contains("Richardson's extrapolation") && said.contains("extrapolated "), "{said}");
    assert!(column(&out, "error").iter().all(String::is_empty));
    let (value, error) = (numbers(&out, "quantity_kinetic"), numbers(&out, "quantity_kinetic_error"));
    // A run of degree 5 on 8 x 8 cells stands for the limit: its error is far below.
    let fine = folder.path().join("fine");
    study(&scene, &fine, "--methods rk-dgfem --degrees 5 --refine 1 --measure kinetic").unwrap();
    let limit = numbers(&fine, "quantity_kinetic")[0];
    for (value, error) in value.iter().zip(&error) {
        let true_error = (value / limit - 1.0).abs();
        // The order of three meshes is that of none of them to more than a few tenths.
        assert!((0.5..2.0).contains(&(error / true_error)), "{error:e} {true_error:e}");
    }
    let all = json(&out);
    let series = &all["quantities"][0]["series"][0];
    // N + 1 and more for an integral of a smooth solution.
    assert!(all["measure"] == "kinetic" && series["order"].as_f64().unwrap() > 2.5, "{series}");
    let table = std::fs::read_to_string(out.join("quantities.md")).unwrap();
    assert!(table.contains("| kinetic, J/m |") && table.contains("| force, N/m |"), "{table}");
    let svg = std::fs::read_to_string(out.join("error_over_seconds.svg")).unwrap();
    assert!(svg.contains("relative error of kinetic"));
}

#[test]
fn a_setting_is_chosen_for_the_error_of_a_quantity() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, out) = (smooth_box_with_quantities(folder.path()), folder.path().join("out"));
    let options = "--methods rk-dgfem,ader-dgfem --degrees 2 --refine 0.25,0.5,1 --measure kinetic --error 1e-4";
    study(&scene, &out, options).unwrap();
    let all = json(&out);
    let last = all["tries"].as_array().unwrap().last().unwrap();
    assert!(last["met"].as_bool().unwrap() && last["found"]["error"].as_f64().unwrap() <= 1e-4, "{last}");
    // Two meshes tell nothing: one message, no plot that would show nothing.
    let few = folder.path().join("few");
    let two = "--methods rk-dgfem --degrees 2 --refine 0.5,1 --measure kinetic";
    let (code, message) = study(&scene, &few, &format!("{two} --error 1e-4")).unwrap_err();
    assert!(code == 2 && message.contains("needs three meshes") && message.contains("--refine"), "{message}");
    let said = study(&scene, &few, &format!("{two} --force")).unwrap();
    assert!(said.contains("no plot") && !few.join("error_over_seconds.svg").exists(), "{said}");
    let (code, message) = study(&scene, &few, "--measure kinetik --force").unwrap_err();
    assert!(code == 2 && message.contains("did you mean `kinetic`?") && message.contains("l1"), "{message}");
}

#[test]
fn bad_options_are_refused_and_results_kept() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene("manufactured.toml");
    for (options, word) in [
        ("--methods rk-dgfm", "rk-dgfem"),
        ("--layouts midpoint --methods ader-dgmpm", "midpoints"),
        ("--refine 0", "above 0"),
        ("--compare curl.control", "KEY=VALUE|VALUE"),
        ("--compare scheme.degree=1|2", "--degrees"),
        ("--compare scheme=1|2", "--methods"),
        ("--compare time.end=1e-4|2e-4", "two scenes"),
        ("--compare curl.control=off|lcf --compare curl.control=rotation", "twice"),
        ("--compare curl.control=lfc|off", "lcf"),
        ("--reference 9,1", "DEGREE,REFINEMENT"),
        ("--error -1", "above 0"),
        ("--error 1e-15", "rounding"),
        ("--degrees 8", "6"),
    ] {
        let (code, message) = study(&scene, folder.path(), options).unwrap_err();
        assert!(code == 2 && message.contains(word), "{options}: {code} {message}");
    }
    assert!(!folder.path().join("study.csv").exists());
    // What would take more cells than any memory holds is found after the calibration, whose table stays.
    let far = "--error 1e-13 --degrees 1 --methods rk-dgfem --refine 0.125,0.25";
    let (code, message) = study(&scene, folder.path(), far).unwrap_err();
    assert!(code == 2 && message.contains("no setting"), "{message}");
    assert_eq!(column(folder.path(), "method").len(), 2);
    std::fs::write(folder.path().join("study.csv"), "mine").unwrap();
    let (code, message) = study(&scene, folder.path(), "--degrees 1").unwrap_err();
    assert!(code == 2 && message.contains("--force"), "{message}");
    assert_eq!(std::fs::read_to_string(folder.path().join("study.csv")).unwrap(), "mine");
}

#[test]
fn a_compared_key_without_effect_is_named_with_its_method_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let fixed = "--degrees 1 --refine 0.125 --set output=[]";
    let options = format!("--methods rk-dgfem,ader-dgmpm --compare cloud.per_direction=2|3 {fixed}");
    let said = study(&scene("manufactured.toml"), folder.path(), &options).unwrap();
    let notes: Vec<&str> = said.lines().filter(|line| line.starts_with("note: ")).collect();
    assert_eq!(notes.len(), 1, "{said}");
    assert!(notes[0].contains("cloud.per_direction has no effect on rk-dgfem S1: rk-dgfem computes on the"), "{said}");
    assert_eq!(json(folder.path())["notes"], serde_json::json!(notes));
}

#[test]
fn an_expression_that_is_no_number_is_bad_input_and_no_loss_of_stability() {
    let folder = tempfile::tempdir().unwrap();
    let force = r#"source=[{kind="body-force",value=["log(1e-9-t)","0"]}]"#;
    let fixed = format!("--methods rk-dgfem --degrees 1 --refine 0.125 --set {force} --set output=[]");
    let said = study(&scene("simple_wave.toml"), folder.path(), &fixed).unwrap();
    let status = &column(folder.path(), "status")[0];
    assert!(status.starts_with("\"bad input: ") && said.contains("`log(1e-9-t)` is NaN at X = ("), "{said}");
    assert!(said.contains("cheapest by error: no run has a known error") && !said.contains("unstable"), "{said}");
    // In the run that others are compared with it ends the study, at its key.
    let own = Body::smooth_box(4).write(folder.path(), "box");
    let (code, message) = study(&own, &folder.path().join("own"), &fixed).unwrap_err();
    assert!(code == 2 && message.contains("in the reference run: ") && message.contains("is NaN at X"), "{message}");
}

#[test]
fn the_cheapest_of_one_run_is_that_run() {
    let folder = tempfile::tempdir().unwrap();
    let said =
        study(&scene("manufactured.toml"), folder.path(), "--methods rk-dgfem --degrees 1 --refine 0.125").unwrap();
    let after = said.split("cheapest by error:\n").nth(1).unwrap();
    assert!(after.starts_with("  for an error of ") && after.contains(" use rk-dgfem S1 on 4 cells: "), "{said}");
}
