//! Every method, degree, flux, boundary condition and source runs, by `--set` on one scene.

use crate::common::Bench;

#[test]
fn every_method_runs_at_every_degree() {
    let bench = Bench::new();
    for method in ["ader-dgmpm", "ader-dgfem", "rk-dgfem"] {
        for degree in 0..=6 {
            // A few steps of any degree: h / c is 4.3e-5 s, and the limits go from .5 to .0165 of it.
            let end = 1e-5 / (1 + degree * degree) as f64;
            bench.run(&format!(
                "run case.toml --set scheme.method={method} --set scheme.degree={degree} --set time.end={end:e} --force"
            ));
            let summary = bench.summary("runs/case");
            assert_eq!((summary["method"].as_str(), summary["degree"].as_u64()), (Some(method), Some(degree)));
            assert_eq!(summary["time_degree"].as_u64(), Some(degree));
            let ratio = summary["total_energy_ratio"].as_f64().unwrap();
            // Fluxes dissipate and the wall at rest does no work; the rest is growth of 1e-4 a step (N = 6) at most.
            assert!(ratio > 0.5 && ratio < 1.001, "{method} {degree}: {ratio}");
        }
    }
}

#[test]
fn degrees_in_time_and_space_may_differ() {
    let bench = Bench::new();
    for (method, degree, time_degree) in
        [("ader-dgmpm", 2, 1), ("ader-dgmpm", 1, 3), ("ader-dgfem", 3, 2), ("rk-dgfem", 2, 1)]
    {
        bench.run(&format!(
            "run case.toml --set scheme.method={method} --set scheme.degree={degree} --set time.end=1e-5 \
             --set scheme.time_degree={time_degree} --set scheme.safety=0.4 --force"
        ));
        let summary = bench.summary("runs/case");
        assert_eq!(summary["time_degree"].as_u64(), Some(time_degree));
        assert_eq!(summary["degree"].as_u64(), Some(degree));
    }
}

#[test]
fn fluxes_layouts_and_the_curl_control_each_change_the_bits() {
    let bench = Bench::new();
    let variants = [
        "scheme.flux=rusanov",
        "scheme.flux=acoustic",
        "scheme.flux=acoustic-curl",
        "curl.control=off",
        "curl.alpha=6",
        "cloud.layout=gauss",
        "cloud.layout=jitter",
        "cloud.per_direction=3",
        "scheme.cfl=0.4",
    ];
    let mut ends: Vec<Vec<f64>> = Vec::new();
    for set in variants {
        bench.run(&format!("run case.toml --set {set} --force"));
        let end = bench.last("runs/case").u;
        assert!(!ends.contains(&end), "{set} changes nothing");
        ends.push(end);
    }
}

#[test]
fn every_boundary_condition_runs_with_expressions_where_it_has_values() {
    let bench = Bench::new();
    let kinds = [
        "kind=\"wall\"",
        "kind=\"wall\", speed=\"10*sin(1e5*t)*y\"",
        "kind=\"symmetry\"",
        "kind=\"free\"",
        "kind=\"clamped\"",
        "kind=\"velocity\", value=[\"-200 + 1e6*t\", \"5*y\"]",
        "kind=\"traction\", value=[\"1e8*step(t - 2e-5)*(x + y)\", 0]",
        "kind=\"absorbing\"",
    ];
    let mut ends: Vec<Vec<f64>> = Vec::new();
    for kind in kinds {
        let output = bench
            .command("run case.toml --force")
            .args(["--set", &format!("boundary.1={{group=\"right\", {kind}}}")])
            .output()
            .unwrap();
        assert!(output.status.success(), "{kind}: {}", String::from_utf8_lossy(&output.stderr));
        let end = bench.last("runs/case").u;
        // A symmetry line is a wall at rest; all others differ.
        let known = ends.iter().position(|other| *other == end);
        assert_eq!(known, (kind == "kind=\"symmetry\"").then_some(0), "{kind}");
        ends.push(end);
    }
}

#[test]
fn a_body_force_accelerates_a_free_body_by_its_mean() {
    let bench = Bench::new();
    let text = crate::common::SCENE
        .replace("\"-200\", \"0\"", "0, 0")
        .replace("kind = \"wall\"", "kind = \"free\"")
        .replace("kind = \"symmetry\"", "kind = \"free\"");
    bench
        .write("fall.toml", format!("{text}[[source]]\nkind = \"body-force\"\nvalue = [\"2e6*x\", \"-1e6*t/1e-4\"]\n"));
    bench.run("run fall.toml");
    let summary = bench.summary("runs/fall");
    let momentum = |k: usize| summary["momentum"][k].as_f64().unwrap();
    // rho0 b over the body times t: 7800 x .5 x 1e6 (the mean of 2e6 x) x 1e-4, and half of it for b2 ~ t; Gauss
    // quadrature of degree 1 in space and time is exact here, the rest is rounding of about 15 steps.
    assert!((momentum(0) / 3.9e5 - 1.0).abs() < 1e-12, "{}", momentum(0));
    assert!((momentum(1) / -1.95e5 - 1.0).abs() < 1e-12, "{}", momentum(1));
}

#[test]
fn two_materials_share_a_mesh_and_each_has_its_points() {
    let bench = Bench::empty();
    let mut mesh = dgmpm::parts::mesh::rectangle([1.0, 0.5], [4, 2]).unwrap();
    mesh.groups = vec!["steel".to_owned(), "lead".to_owned()];
    (0..8).for_each(|cell| mesh.cell_group[cell] = usize::from(cell % 4 > 1));
    dgmpm::parts::io::gmsh::write(&mesh, &bench.path("two.msh")).unwrap();
    let (head, tail) = crate::common::SCENE.split_once("[initial]").unwrap();
    let head = head
        .replace("rectangle = { size = [1.0, 0.5], cells = [4, 2] }", "file = \"two.msh\"")
        .replace("group = \"body\"", "group = \"steel\"");
    let lead = "[[material]]\ngroup = \"lead\"\nlaw = \"neo-hookean\"\nyoung = 1.6e10\npoisson = 0.44\ndensity = 11340\n\
        per_direction = 3\n";
    bench.write("two.toml", format!("{head}{lead}[initial]{tail}"));
    let said = bench.run("seed two.toml");
    assert!(said.contains("4 cells with 4 points") && said.contains("4 cells with 9 points"), "{said}");
    bench.run("run two.toml");
    let summary = bench.summary("runs/two");
    assert!(summary["total_energy_ratio"].as_f64().unwrap() <= 1.0, "{summary:#}");
    let force = "--set source.0.kind=gravity --set source.0.value=[0.0,-9.81]";
    bench.run(&format!("run two.toml --force --set source.0.group=lead {force}"));
    let message = bench.fail(2, &format!("run two.toml --force --set source.0.group=led {force}"));
    assert!(message.contains("did you mean `lead`"), "{message}");
}
