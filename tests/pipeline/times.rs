//! When outputs look, and that neither they nor the number of threads change a bit.

use crate::common::{Bench, bits};

/// Times of the snapshots of a run.
fn times(bench: &Bench) -> Vec<f64> {
    bench.snapshots("runs/case").iter().map(|snapshot| snapshot.time).collect()
}

#[test]
fn a_snapshot_is_the_step_that_ends_nearest_to_its_time() {
    let bench = Bench::new();
    let dt = |name: &str| bench.summary("runs/case")[name].as_f64().unwrap();
    bench.run("run case.toml --set output.0.at=[0.0,1.3e-5,4.1e-5,7.7e-5]");
    let found = times(&bench);
    assert_eq!((found.len(), found[0]), (4, 0.0));
    for (asked, found) in [1.3e-5, 4.1e-5, 7.7e-5].iter().zip(&found[1..]) {
        assert!((asked - found).abs() <= 0.5 * dt("dt_max"), "{asked} {found}");
    }
    // Every step, to know them all: none is nearer.
    bench.run("run case.toml --force --set output.0.every_steps=1");
    let all = times(&bench);
    assert_eq!(all.len() as u64, bench.summary("runs/case")["steps"].as_u64().unwrap() + 1);
    for (asked, found) in [1.3e-5, 4.1e-5, 7.7e-5].iter().zip(&found[1..]) {
        let nearest = all.iter().map(|t| (t - asked).abs()).fold(f64::INFINITY, f64::min);
        assert_eq!((found - asked).abs().to_bits(), nearest.to_bits());
    }
}

#[test]
fn a_line_samples_the_polynomial_and_on_an_edge_the_cell_of_the_lower_number() {
    let bench = Bench::new();
    let line = "output.1={kind=\"line\", name=\"cut\", from=[0,0], to=[1,0.5], samples=9, at=[0.0], \
                fields=[\"velocity\", \"deformation\", \"piola\", \"jacobian\"]}";
    let velocity = "initial.velocity=[\"30 + 20*x - 10*y\", \"step(x - 0.5)\"]";
    let deformation = "initial.deformation=[\"1 + 0.01*x\", 0, 0, 1]";
    let sets = ["--set", line, "--set", velocity, "--set", deformation];
    let output = bench.command("run case.toml").args(sets).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (header, rows) = bench.table("runs/case/lines/cut.csv");
    let names = "t s x y velocity_1 velocity_2 deformation_11 deformation_12 deformation_21 deformation_22 piola_11 \
        piola_12 piola_21 piola_22 piola_33 jacobian";
    assert_eq!(header.join(" "), names.split_whitespace().collect::<Vec<_>>().join(" "));
    assert_eq!(rows.len(), 9);
    let (young, poisson) = (2e11, 0.3);
    let (kappa, mu) = (young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)));
    for (i, row) in rows.iter().enumerate() {
        let (x, y) = (i as f64 / 8.0, i as f64 / 16.0);
        assert_eq!((row[0], row[2], row[3]), (0.0, x, y));
        assert!((row[1] - 1.25f64.sqrt() * x).abs() < 1e-15);
        // Degree 1 has linear functions: roundings of four terms of size 50 and 1.
        assert!((row[4] - (30.0 + 20.0 * x - 10.0 * y)).abs() < 1e-13, "{row:?}");
        let f = 1.0 + 0.01 * x;
        assert!((row[6] - f).abs() < 1e-14 && (row[15] - f).abs() < 1e-14, "{row:?}");
        // Uniaxial: P11 = kappa (J - 1) + mu J^(-2/3) (F11 - I/(3 F11)), I = F11^2 + 2; P33 with F33 = 1.
        let a = mu * f.powf(-2.0 / 3.0);
        let trace = (f * f + 2.0) / 3.0;
        let expected = [kappa * (f - 1.0) + a * (f - trace / f), kappa * (f - 1.0) * f + a * (1.0 - trace)];
        // kappa and mu of 1e11 times the rounding of F.
        assert!((row[10] - expected[0]).abs() < 1e-3 && (row[14] - expected[1]).abs() < 1e-3, "{row:?} {expected:?}");
    }
    // x = .5, y = .25 is a corner of four cells; the lowest lies left of it, where the step is 0.
    assert!(rows[4][5] == 0.0 && (rows[5][5] - 1.0).abs() < 1e-15, "{:?}", (rows[4][5], rows[5][5]));
}

#[test]
fn exact_times_are_met_to_the_last_bit() {
    let bench = Bench::new();
    bench.run("run case.toml --set output.0.exact_times=true --set output.0.at=[1.3e-5,1.4e-5,7.7e-5]");
    assert_eq!(times(&bench), [1.3e-5, 1.4e-5, 7.7e-5]);
    bench.run("run case.toml --force --set output.0.exact_times=true --set output.0.every=2.5e-5");
    assert_eq!(times(&bench), [0.0, 2.5e-5, 2.0 * 2.5e-5, 3.0 * 2.5e-5, 1e-4]);
    // An interval below the step: steps are cut to it.
    bench.run("run case.toml --force --set output.0.exact_times=true --set output.0.every=5e-6");
    assert_eq!(times(&bench).len(), 21);
}

#[test]
fn intervals_of_time_and_steps_are_counted_from_the_start() {
    let bench = Bench::new();
    bench.run("run case.toml --set output.0.every=2.5e-5");
    let found = times(&bench);
    let dt = bench.summary("runs/case")["dt_max"].as_f64().unwrap();
    assert_eq!(found.len(), 5);
    assert!(found.iter().enumerate().all(|(i, t)| (t - 2.5e-5 * i as f64).abs() <= 0.5 * dt), "{found:?}");
    bench.run("run case.toml --force --set output.0.every_steps=4 --set output.1.every_steps=5");
    assert!(bench.snapshots("runs/case").iter().enumerate().all(|(i, snapshot)| snapshot.step == 4 * i));
    let steps = bench.summary("runs/case")["steps"].as_u64().unwrap() as usize;
    let (_, rows) = bench.table("runs/case/lines/bottom.csv");
    assert_eq!(rows.len(), 5 * (steps / 5 + 1));
}

#[test]
fn a_run_shortened_by_set_warns_of_later_outputs_and_keeps_its_last_state() {
    let bench = Bench::new();
    let said = bench.run("run case.toml --set time.end=6e-5");
    let warning =
        "warning: case.toml:31:6: `at` of output \"fields\": 1 of 2 times lie after the end of the run, 6e-5 s";
    assert!(said.contains(warning), "{said}");
    let found = times(&bench);
    assert_eq!((found.len(), found[1]), (2, 6e-5));
    assert!(bench.run("run case.toml --set time.end=1e-5 --force").contains("2 of 2 times"));
    assert_eq!(times(&bench), [1e-5]);
    bench.run("export runs/case");
    // Its folder runs again.
    bench.run("run runs/case/scene.toml --out again");
}

#[test]
fn the_last_steps_are_even_and_the_run_ends_at_its_end() {
    let bench = Bench::new();
    bench.run("run case.toml --set output.2.kind=ledger");
    let (_, rows) = bench.table("runs/case/ledger.csv");
    let dt: Vec<f64> = rows[..rows.len() - 1].iter().map(|row| row[2]).collect();
    let [.., a, b] = dt[..] else { panic!("steps") };
    assert_eq!(rows.last().unwrap()[1], 1e-4);
    // Two roundings of the time, 1e-4 s, over dt of some 1e-6 s.
    assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    assert_eq!(rows.len() as u64, bench.summary("runs/case")["steps"].as_u64().unwrap() + 1);
}

#[test]
fn observing_changes_no_bit() {
    let bench = Bench::new();
    bench.run("run case.toml --set output.0.at=[1e-4] --set output.0.fields=[\"velocity\"] --out one");
    let many = "--set output.0.every_steps=1 --set output.1.every_steps=1 --set output.2.kind=ledger";
    bench.run(&format!("run case.toml {many} --out many"));
    let (one, many) = (bench.last("one"), bench.last("many"));
    assert_eq!((one.step, one.time.to_bits()), (many.step, many.time.to_bits()));
    assert_eq!(bits(&one.u), bits(&many.u));
    // The displacement is integrated where the flux looks at it or an output asks for it.
    assert_eq!(bits(&one.displacement), bits(&many.displacement));
    bench.run("run case.toml --set scheme.flux=rusanov --set output.0.fields=[\"velocity\"] --out plain");
    assert!(bench.last("plain").displacement.is_empty() && !one.displacement.is_empty());
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let bench = Bench::new();
    for method in ["ader-dgmpm", "rk-dgfem"] {
        // 54 cells: 7 blocks of 8, the last padded.
        let set =
            format!("--force --set scheme.method={method} --set mesh.rectangle.cells=[9,6] --set scheme.degree=2");
        for threads in [1, 2, 3] {
            bench.run(&format!("run case.toml {set} --threads {threads} --out t{threads}"));
            assert_eq!(bench.summary(&format!("t{threads}"))["threads"].as_u64(), Some(threads));
        }
        for threads in ["t2", "t3"] {
            for (one, other) in bench.snapshots("t1").iter().zip(bench.snapshots(threads)) {
                assert_eq!(one.time.to_bits(), other.time.to_bits());
                assert_eq!(bits(&one.u), bits(&other.u));
                assert_eq!(bits(&one.displacement), bits(&other.displacement));
            }
            assert_eq!(bench.read("t1/ledger.csv"), bench.read(&format!("{threads}/ledger.csv")), "totals too");
        }
    }
}
