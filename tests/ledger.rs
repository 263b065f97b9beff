//! The balance of energy as a user finds it: `ledger.csv` and `summary.json` of whole runs.

mod runs;
mod scenes;

use runs::{Outcome, run};
use scenes::{Body, STEEL};
use std::path::PathBuf;

const METHODS: [&str; 3] = ["ader-dgmpm", "ader-dgfem", "rk-dgfem"];

/// The scene of a body, with a ledger that has a row for each step.
fn scene(name: &str, body: Body) -> PathBuf {
    body.table("[output]", "kind = \"ledger\"").write(&scenes::folder("ledger"), name)
}

fn of(scene: &std::path::Path, method: &str, degree: usize, sets: &[&str]) -> Outcome {
    let (method, degree) = (format!("scheme.method={method}"), format!("scheme.degree={degree}"));
    run(scene.to_str().unwrap(), &[&[method.as_str(), &degree], sets].concat())
}

fn part(outcome: &Outcome, key: &str) -> f64 {
    outcome.summary["balance"][key].as_f64().unwrap()
}

fn energy(outcome: &Outcome) -> f64 {
    outcome.number("kinetic_energy") + outcome.number("strain_energy")
}

/// What the steps lose beyond what the jumps take: the error of time integration.
fn beyond_jumps(outcome: &Outcome) -> f64 {
    part(outcome, "flux_dissipation") + part(outcome, "boundary_dissipation") - part(outcome, "jumps")
}

/// That of the smooth box over the energy on 8 x 8 and 16 x 16 cells, h and dt together, and measured orders.
/// ADER: of the order N + 1 of the scheme and above, since its predictor sees no jumps; RK2, RK4, RK4: the error of the
/// tableau, which meets the jumps' order 2N + 1 first (at S1 two parts of 1e-5 nearly cancel). What the faces hold of the displacement is not counted as energy, and is a part of it. Bounds: a quarter of an order below what was measured.
#[test]
fn what_jumps_do_not_explain_falls_under_refinement_with_the_order_of_the_scheme() {
    let scene = scene("box", Body::smooth_box(8));
    let orders = [[2.21, 2.89, 4.09], [2.21, 2.9, 4.11], [0.6, 5.56, 5.62]];
    for (method, orders) in METHODS.into_iter().zip(orders) {
        for (degree, measured) in (1..=3).zip(orders) {
            let unexplained = |cells: usize| {
                let set = format!("mesh.rectangle.cells=[{cells},{cells}]");
                let outcome = of(&scene, method, degree, &[&set, "output.0.every_steps=1000"]);
                // Walls at rest do no work, and there is no source.
                assert_eq!((part(&outcome, "boundary_work"), part(&outcome, "source_work")), (0.0, 0.0));
                // The entries close to the rounding of energies.
                assert!(part(&outcome, "remainder").abs() < 1e-13 * energy(&outcome), "{method} S{degree}");
                (beyond_jumps(&outcome) / energy(&outcome)).abs()
            };
            let (coarse, fine) = (unexplained(8), unexplained(16));
            let order = (coarse / fine).log2();
            println!("{method} S{degree}: {coarse:.3e} {fine:.3e} order {order:.2}");
            assert!(order > measured - 0.25, "{method} S{degree}: {coarse:e} {fine:e} order {order:.2}");
        }
    }
}

/// Half of a bar bends against a plane of symmetry, RK2 at S2: what springs store counts as energy, and what they forget is lost, at free
/// sides, in the plane and between cells. Measured: what jumps do not explain is 4e-5 of the loss, where 1.2 % of
/// it is stored at the end, and 1.3 % were not explained without that.
#[test]
fn with_springs_jumps_explain_what_the_steps_lose() {
    let bar = Body::rectangle([6.0, 1.0], [6, 1]).sides("free").side("left", "symmetry", "");
    let bar = bar.material("neo-hookean", [17e6, 0.3, 1100.0], "").velocity(["0", "0.1*cos(pi*(x+6)/6)"]).end(2.0);
    let outcome = of(&scene("bar", bar), "rk-dgfem", 2, &["scheme.springs=true", "output.0.every_steps=1000"]);
    let [lost, stored] =
        [part(&outcome, "flux_dissipation") + part(&outcome, "boundary_dissipation"), outcome.number("face_energy")];
    println!("lost {lost:.4e}, stored {stored:.4e}, beyond jumps {:.4e}", beyond_jumps(&outcome) / lost);
    assert!(stored > 0.01 * lost, "{stored:e} of {lost:e}");
    assert!(beyond_jumps(&outcome).abs() < 1e-3 * lost, "{:e} of {lost:e}", beyond_jumps(&outcome));
}

/// The paper's impact on 15 x 15 cells until the wave has come back. RK's steps only lose; of ADER's some give, about
/// one each time the front enters a cell, which its predictor does not see coming. The control of the curl moves next to nothing.
/// Measured, of E(0) for ADER-DGMPM: faces .0187, boundary .0081, control 8e-6; given, of what was lost: faces .026,
/// boundary .026.
#[test]
fn in_the_impact_steps_dissipate_and_the_control_of_the_curl_moves_next_to_nothing() {
    for method in METHODS {
        let sets = [
            "mesh.rectangle={size=[3.0,3.0],cells=[15,15]}",
            &format!("scheme.method={method}"),
            "time.end=1e-3",
            "output=[{kind=\"ledger\"}]",
        ];
        let outcome = run("square_impact.toml", &sets);
        let ledger = outcome.ledger();
        let total = ledger.column("total_energy");
        let mut all = 0.0;
        // Twice the measured shares.
        let of_step = if method == "rk-dgfem" { 0.0 } else { 0.052 };
        for (cause, may_give) in [("flux", of_step), ("boundary", of_step), ("curl", f64::INFINITY)] {
            let lost = ledger.column(&format!("{cause}_dissipation"));
            let end = *lost.last().unwrap();
            println!("{method} {cause}: {:.4e} of E(0)", end / total[0]);
            let little = cause == "curl" && end.abs() < 1e-4 * total[0];
            assert!(lost.len() > 300 && (little || end > 1e-4 * total[0]), "{method} {cause}: {end:e}");
            let given: f64 = lost.windows(2).map(|pair| (pair[0] - pair[1]).max(0.0)).sum();
            println!("{method} {cause}: gave {:.4e}", given / end);
            assert!(cause == "curl" || given <= may_give * end, "{method} {cause}: {given:e} of {end:e}");
            all += end;
        }
        let remainder = *ledger.column("remainder").last().unwrap();
        println!(
            "{method} remainder: {:.4e} of E(0), jumps {:.4e}",
            remainder / total[0],
            part(&outcome, "jumps") / total[0]
        );
        // The entries explain all, to the rounding of numbers of size E in another order.
        assert!(remainder.abs() < 1e-13 * total[0], "{method}: {remainder:e}");
        // The columns add up: E = E(0) - lost + remainder, to the rounding of numbers of size E.
        let closed = total[0] - all + remainder;
        assert!((closed / total.last().unwrap() - 1.0).abs() < 1e-14, "{method}");
    }
}

/// A pulse of traction t(t) at the right end of a strip, linear law: until it reaches the left end v = t/(rho0 c_p) at
/// the right end exactly, so that the work is width times int t^2/(rho0 c_p) dt = .3 A^2 T 3/8 / (rho0 c_p).
#[test]
fn the_work_of_a_pulse_of_traction_is_that_of_the_plane_wave_and_goes_into_the_body() {
    let strip = Body::rectangle([1.0, 0.3], [20, 6]).material("linear-elastic", STEEL, "");
    let pushed = strip.side("right", "traction", r#"value = ["1e8*sin(pi*t/1e-4)^2", "0"]"#);
    let plane = pushed.side("bottom", "symmetry", "").side("top", "symmetry", "");
    let scene = scene("pulse", plane.method("rk-dgfem").degree(2).end(1e-4));
    let exact = 0.3 * 1e16 * 1e-4 * 0.375 / (7800.0 * 5875.097);
    // Twice what was measured: work -4.5e-5 (ADER), 2.7e-7 (RK); what jumps do not explain 1.03e-4, -9e-8.
    let ader = [9e-5, 2e-4];
    for (method, [of_work, of_time]) in METHODS.into_iter().zip([ader, ader, [6e-7, 6e-7]]) {
        let outcome = of(&scene, method, 2, &[]);
        let (work, time) = (part(&outcome, "boundary_work"), beyond_jumps(&outcome));
        let given = energy(&outcome);
        println!("{method}: {:e}, {:e}, {:e}", work / exact - 1.0, given / exact - 1.0, time / exact);
        assert!((work / exact - 1.0).abs() < of_work, "{method}: {work:e} {exact:e}");
        assert!(time.abs() < of_time * exact, "{method}: {time:e}");
        // From rest: the ratio is of what was given.
        assert!((outcome.number("total_energy_ratio") / (given / work) - 1.0).abs() < 1e-13, "{method}");
        // The body has it all, but for what 20 cells a metre lose of the pulse: measured 1.7e-4 and 2.3e-5.
        assert!((given / exact - 1.0).abs() < 3.5e-4, "{method}: {given:e} {exact:e}");
    }
}

/// A free body that shakes while it falls: source work = rho0 b . displacement of the centre, which no inner force
/// moves: V t + b t^2/2.
#[test]
fn the_work_of_gravity_is_weight_times_displacement_of_the_centre() {
    let shaken = Body::square(8).velocity(["30*sin(pi*x)*cos(pi*y)", "-100 - 15*cos(pi*x)"]);
    let falling = shaken.table(
        "[source]",
        r#"kind = "gravity"
value = ["0", "-1e5"]"#,
    );
    let scene = scene("gravity", falling.method("rk-dgfem").degree(2).end(3e-4));
    let t = 3e-4;
    let exact = 7800.0 * 1e5 * (100.0 * t + 1e5 * t * t / 2.0);
    for method in METHODS {
        let outcome = of(&scene, method, 2, &[]);
        let work = part(&outcome, "source_work") / exact - 1.0;
        // Rounding of sums over 576 nodes and 100 steps and more; measured up to 7e-15.
        assert!(work.abs() < 1e-13, "{method}: {work:e}");
        // Time integration: measured 4.3e-5.
        assert!(beyond_jumps(&outcome).abs() < 9e-5 * exact, "{method}");
        assert!(part(&outcome, "remainder").abs() < 1e-13 * exact, "{method}");
        // A free edge has t* = 0.
        assert_eq!(part(&outcome, "boundary_work"), 0.0);
    }
}

/// A free square spins by 400 m/s at its edges, about one turn. Linear momentum is kept to rounding by all methods.
/// Angular momentum is not in (F, p): its change is measured as 3.8e-5, 5.1e-6 (ADER-DGMPM, 4 x 4 and 8 x 8 cells),
/// 2.3e-5, 4.5e-6 (ADER-DGFEM) and 1.2e-5, 5.2e-7 (RK4; with rusanov 1.3e-8, 9.3e-10). The bounds are twice that.
#[test]
fn a_free_spinning_square_keeps_its_momenta() {
    let spinning = Body::square(4).velocity(["-800*(y-0.5)", "800*(x-0.5)"]);
    let scene = scene("spin", spinning.method("rk-dgfem").degree(2).end(7.854e-3));
    for (method, bounds) in METHODS.into_iter().zip([[8e-5, 1e-5], [8e-5, 1e-5], [2.5e-5, 1.1e-6]]) {
        let changes = [4, 8].map(|cells| {
            let set = format!("mesh.rectangle.cells=[{cells},{cells}]");
            let outcome = of(&scene, method, 2, &[&set, "output.0.every_steps=100"]);
            let of = |key: &str, k: usize| outcome.summary[key][k].as_f64().unwrap();
            // rho0 800 /s times the polar moment of the square, 1/6 m^4.
            assert!((of("angular_momentum", 0) / (7800.0 * 800.0 / 6.0) - 1.0).abs() < 1e-14);
            for k in 0..2 {
                // Rounding of 2000 steps and more on numbers of rho0 v = 3e6; measured 6e-10.
                assert!(of("momentum", k).abs() < 1e-8, "{method}: {:?}", outcome.summary["momentum"]);
            }
            assert!(outcome.number("total_energy_ratio") < 1.0, "{method}");
            (of("angular_momentum", 1) / of("angular_momentum", 0) - 1.0).abs()
        });
        println!("{method}: {changes:?}");
        assert!(changes[0] < bounds[0] && changes[1] < bounds[1], "{method}: {changes:?}");
        // Measured 3.7 (ADER-DGMPM).
        assert!(changes[0] > 3.0 * changes[1], "{method}: {changes:?}");
    }
}

/// What costs is asked for: without the table, or with `balance = false`, nothing of the balance is there.
#[test]
fn the_balance_is_there_only_where_a_ledger_asks_for_it_and_changes_no_energy() {
    let scene = scene("asked", Body::smooth_box(4));
    let columns = |outcome: &Outcome| {
        let text = std::fs::read_to_string(outcome.path().join("ledger.csv")).unwrap();
        text.lines().next().unwrap().split(',').map(str::to_owned).collect::<Vec<_>>()
    };
    let always = "step t dt kinetic_energy strain_energy total_energy momentum_1 momentum_2 min_j max_curl_f c_max \
                  max_drift";
    let more =
        "boundary_work source_work flux_dissipation boundary_dissipation curl_dissipation remainder angular_momentum";
    for method in METHODS {
        let on = of(&scene, method, 2, &[]);
        assert_eq!(columns(&on).join(" "), format!("{always} {more}"));
        for off in ["output.0.balance=false", "output=[]"] {
            let off = of(&scene, method, 2, &[off]);
            assert_eq!(columns(&off).join(" "), always);
            assert!(off.summary["balance"].is_null());
            for key in ["kinetic_energy", "strain_energy", "min_j", "max_curl_f", "max_drift"] {
                assert_eq!(on.number(key).to_bits(), off.number(key).to_bits(), "{method} {key}");
            }
        }
        // The last row and the summary say the same.
        let (ledger, last) = (on.ledger(), |column: Vec<f64>| *column.last().unwrap());
        for key in more.split(' ').filter(|key| *key != "angular_momentum") {
            assert_eq!(last(ledger.column(key)), part(&on, key), "{method} {key}");
        }
        assert_eq!(last(ledger.column("angular_momentum")), on.summary["angular_momentum"][1].as_f64().unwrap());
    }
}

#[test]
fn balance_is_a_key_of_the_ledger_alone() {
    let scene = scene("key", Body::smooth_box(4));
    let load = |set: &str| dgmpm::parts::scene::Scene::load(&scene, &[set.to_owned()]);
    assert!(load("output.0.balance=true").unwrap().wants_displacement());
    assert!(!load("output.0.balance=false").unwrap().wants_displacement());
    for wrong in ["output.0.balance=1", "output.0={kind=\"fields\", at=[0.0], balance=true}"] {
        let message = load(wrong).unwrap_err().to_string();
        assert!(message.contains("balance"), "{wrong}: {message}");
    }
}
