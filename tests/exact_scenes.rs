//! The scenes with an exact solution: short runs of the program, whose errors stand in `summary.json`.

mod runs;

use dgmpm::parts::scene::Scene;
use runs::run;
use std::path::Path;

#[test]
fn scenes_with_an_exact_solution_report_small_errors() {
    for (scene, sets, largest) in [
        // Twice what these coarse meshes give (8.0e-3, 5.1e-3, 2.1e-4 at worst): the orders are those of tests/convergence.
        ("simple_wave.toml", &["mesh.rectangle.cells=[60, 1]", "scheme.degree=3"][..], 1.6e-2),
        ("manufactured.toml", &["mesh.rectangle.cells=[8, 8]"], 1e-2),
        ("linear_bar.toml", &["mesh.rectangle.cells=[60, 1]", "scheme.degree=3"], 4e-4),
    ] {
        for method in ["ader-dgmpm", "ader-dgfem", "rk-dgfem"] {
            let method = format!("scheme.method={method}");
            let outcome = run(scene, &[&[method.as_str()], sets].concat());
            let errors = &outcome.summary["errors"];
            let standard = errors["standard"].as_f64().unwrap();
            println!("{scene} {method}: {standard:.2e}");
            assert!(standard < largest, "{scene} {method}: {standard:e}");
            for field in ["deformation", "velocity", "piola"] {
                let [l1, l2, linf] = ["l1", "l2", "linf"].map(|norm| errors[field][norm].as_f64().unwrap());
                assert!(l1 > 0.0 && l2 > 0.0 && linf > 0.0, "{scene} {field}: {l1} {l2} {linf}");
            }
        }
    }
}

#[test]
fn an_impact_is_measured_against_its_exact_shock() {
    let sets =
        ["exact.kind=wall-impact", "exact.speed=200.0", "time.end=1e-4", "scheme.degree=1", "output.0.at=[1e-4]"];
    let sets = [&sets[..], &["output.1.at=[1e-4]"]].concat();
    let l1 = run("bar.toml", &sets).summary["errors"]["velocity"]["l1"].as_f64().unwrap();
    // v is wrong by some of 200 m/s in the cells at the front, of .3 m^2 in all; most of the body has none.
    assert!(l1 > 0.0 && l1 < 1.0, "{l1}");
}

/// The message of `meshes/riemann.toml` with overrides, from the scene or from its mesh.
fn refusal(sets: &[&str]) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/riemann.toml");
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let result = Scene::load(&path, &sets).and_then(|scene| scene.build_mesh());
    let error = result.expect_err("a scene that has no exact solution");
    assert_eq!(error.exit_code(), 2, "{error}");
    error.to_string()
}

#[test]
fn materials_that_a_solution_does_not_take_or_has_elsewhere_are_refused() {
    for (sets, words) in [
        // The first material on the right, the interface inside of a material and inside of a cell.
        (&["material.0.group=aluminium", "material.1.group=steel"][..], "not of the material"),
        (&["exact.interface=1.6"], "not of the material"),
        (&["exact.interface=1.51"], "not of the material"),
        (&["exact.left_velocity=1e9"], "press a material to nothing"),
        (&["exact={kind=\"wall-impact\"}"], "2 materials, \"wall-impact\" takes 1"),
    ] {
        let message = refusal(sets);
        assert!(message.contains(words), "{sets:?}: {message}");
    }
}
