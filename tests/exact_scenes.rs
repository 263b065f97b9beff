//! The scenes with an exact solution: short runs of the program, whose errors stand in `summary.json`.

mod runs;

use runs::run;

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
