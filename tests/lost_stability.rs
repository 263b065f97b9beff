//! What a run that loses stability says and leaves: the place, what may help, and a state that it can be restarted from.
//! The program is run as its users have it.

#[path = "pipeline/common.rs"]
#[allow(dead_code)]
mod common;

use common::{Bench, SCENE};
use dgmpm::parts::io::snapshot::Snapshot;

/// Smallest J at the grid nodes of a snapshot.
fn smallest_j(snapshot: &Snapshot) -> f64 {
    let n = (snapshot.degree + 1).pow(2);
    let of_cell =
        |u: &[f64]| (0..n).map(|a| u[a] * u[3 * n + a] - u[n + a] * u[2 * n + a]).fold(f64::INFINITY, f64::min);
    snapshot.u.chunks(6 * n).map(of_cell).fold(f64::INFINITY, f64::min)
}

/// A folder with the small impact of [`SCENE`], without outputs.
fn bench() -> Bench {
    let bench = Bench::empty();
    bench.write("case.toml", &SCENE[..SCENE.find("[[output]]").unwrap()]);
    bench
}

/// Bodies that are crushed, each by another law, method, degree or load; none of them can be saved.
const CRUSHED: [(&str, &str); 4] = [
    // A punch beside a clamped edge: the corner between them is sheared off.
    (
        "punch",
        "--set mesh.rectangle.cells=[8,8] --set scheme.degree=3 --set initial.velocity=[0,0] --set boundary.1.kind=clamped \
         --set boundary.0.kind=velocity --set boundary.0.value=[\"2e3*step(0.2-y)\",0] --set time.end=1e-3",
    ),
    // A bar between plates that meet.
    ("plates", "--set boundary.0.kind=clamped --set boundary.1.kind=velocity --set boundary.1.value=[\"-5e8*t\",0]"),
    (
        "plates, RK S2",
        "--set scheme.method=rk-dgfem --set scheme.degree=2 --set boundary.0.kind=clamped --set \
         boundary.1.kind=velocity --set boundary.1.value=[\"-5e8*t\",0]",
    ),
    // An impact beyond what degree 2 on `paper` points holds.
    ("impact", "--set mesh.rectangle.cells=[16,8] --set scheme.degree=2 --set initial.velocity=[-4500,0]"),
];

#[test]
fn a_crushed_body_leaves_a_state_that_is_sound_and_that_a_run_goes_on_from() {
    for (name, sets) in CRUSHED {
        let bench = bench();
        let message = bench.fail(3, &format!("run case.toml {sets}"));
        let (summary, kept) = (bench.summary("runs/case"), bench.last("runs/case"));
        let loss = &summary["loss"];
        let step = loss["step"].as_u64().unwrap();
        for words in ["in cell ", "X = (", "steps before, is in runs/case/snapshots/", "what may help"] {
            assert!(message.contains(words), "{name}, {words}: {message}");
        }
        assert!(
            message.contains(loss["place"].as_str().unwrap()) && message.contains(&format!("error: step {step}, "))
        );
        // The state kept is some steps older than the loss, and the summary tells of the state before the loss.
        assert_eq!(
            (kept.step as u64, Some(kept.time)),
            (loss["kept_step"].as_u64().unwrap(), loss["kept_time"].as_f64())
        );
        assert_eq!(summary["steps"].as_u64(), Some(step - 1), "{name}");
        let before = step - kept.step as u64;
        assert!(before >= 4.min(step) && before <= 24.max(step / 8), "{name}: {before} of {step} steps before");
        assert!(smallest_j(&kept) > 0.02, "{name}: J = {}", smallest_j(&kept));
        // It goes on for half of the way to the loss, and all of it to the same loss.
        let file = format!("runs/case/snapshots/{:06}.h5", kept.step);
        let half = 0.5 * (kept.time + loss["time"].as_f64().unwrap());
        let again = format!("run case.toml {sets} --out runs/on --set initial={{snapshot=\"{file}\"}}");
        bench.run(&format!("{again} --set time.end={half:e}"));
        assert!(bench.summary("runs/on")["min_j"].as_f64().unwrap() > 0.0, "{name}");
        let second = bench.fail(3, &format!("{again} --force"));
        assert_eq!(second.lines().next(), message.lines().next(), "{name}");
    }
}

/// Expressions that stop being numbers in mid-run: what is set, the place of the expression and how it is named.
const NOT_NUMBERS: [(&str, &str, &str); 7] = [
    (
        "boundary.1.kind=traction --set boundary.1.value=[\"1e6*sqrt(1-t/2e-5)\",0]",
        "boundary.1.value",
        "component 1 of the traction on the boundary `right`, `1e6*sqrt(1-t/2e-5)` is NaN at X = (1.000000, ",
    ),
    (
        "boundary.1.kind=velocity --set boundary.1.value=[0,\"1/step(2e-5-t)-1\"]",
        "boundary.1.value",
        "component 2 of the velocity of the boundary `right`, `1/step(2e-5-t)-1` is inf at X = (1.000000, ",
    ),
    (
        "boundary.0.speed=\"log(2e-5-t)\"",
        "boundary.0.speed",
        "the speed of the wall `left` `log(2e-5-t)` is NaN at X = (0.000000, ",
    ),
    (
        "source=[{kind=\"body-force\",value=[0,\"(2e-5-t)^0.5*step(x-0.5)\"]}]",
        "source",
        "component 2 of the body force, `(2e-5-t)^0.5*step(x-0.5)` is NaN at X = (0.",
    ),
    // A wall and an obstacle that let go: a point that is not held for want of a number would be free.
    (
        "boundary.1={group=\"right\",kind=\"unilateral\",gap=1e-3,speed=\"(2e-5-t)^0.5\"}",
        "boundary.1=",
        "the speed of the wall `right` `(2e-5-t)^0.5` is NaN at X = (1.",
    ),
    (
        "boundary.1={group=\"right\",kind=\"half-plane\",point=[1.001,0],normal=[-1,0],velocity=[\"1/step(2e-5-t)\",\"0\"]}",
        "boundary.1=",
        "component 1 of its velocity `right`, `1/step(2e-5-t)` is inf at X = (1.",
    ),
    // Only where x > .9 of the top.
    (
        "boundary.3.kind=traction --set boundary.3.value=[0,\"if(step(x-0.9)*step(t-2e-5),0/0*x,1e3)\"]",
        "boundary.3.value",
        "component 2 of the traction on the boundary `top`, `if(step(x-0.9)*step(t-2e-5),0/0*x,1e3)` is NaN at X = (0.9",
    ),
];

#[test]
fn an_expression_that_is_not_finite_in_mid_run_is_named_with_its_place_and_time() {
    for method in ["ader-dgmpm", "ader-dgfem", "rk-dgfem"] {
        for (set, key, words) in NOT_NUMBERS {
            let bench = bench();
            let message = bench.fail(2, &format!("run case.toml --set scheme.method={method} --set {set}"));
            // The argument that gave it, as every message about the scene has its place.
            assert!(message.starts_with(&format!("error: --set {key}")), "{method}: {message}");
            assert!(message.contains(words) && message.contains("t = 2."), "{method}: {message}");
            assert!(message.contains("is in runs/case/snapshots/"), "{method}: {message}");
            let summary = bench.summary("runs/case");
            assert_eq!(summary["status"].as_str(), Some("failed"));
            // A number that is not finite is seen in the step that it comes in.
            let [first, step] = [&summary["end_time"], &summary["dt_max"]].map(|v| v.as_f64().unwrap());
            assert!(first <= 2e-5 && first + step >= 2e-5, "{method} {set}: {first} + {step}");
            assert!(bench.last("runs/case").u.iter().all(|u| u.is_finite()));
        }
    }
}

#[test]
fn what_may_help_depends_on_what_is_on() {
    let crush = "--set boundary.0.kind=clamped --set boundary.1.kind=velocity --set boundary.1.value=[\"-5e8*t\",0]";
    let of = |sets: &str| bench().fail(3, &format!("run case.toml {crush} {sets}"));
    let usual = of("");
    let hints = [
        ("--set scheme.safety=1.0", "the step is 1.00 of the limit"),
        ("--set curl.control=off", "[curl] control is \"off\""),
        ("--set scheme.flux=acoustic", "scheme.flux = \"acoustic\""),
        ("--set material.0.law=linear-elastic", "a linear law does not stiffen"),
        ("--set scheme.degree=3 --set cloud.layout=paper", "face Lebesgue constant 124"),
        (
            "--set material.0.law=j2 --set material.0.yield_stress=4e8 --set material.0.hardening=1e9 --set cloud.layout=paper \
             --set cloud.histories=points",
            "a law has memory (face Lebesgue constant",
        ),
        ("--set regrid=[{every_steps=4,rectangle={size=[1.0,0.5],cells=[5,2]}}]", "the grid was new at step"),
    ];
    for (sets, words) in hints {
        let message = of(sets);
        assert!(message.contains(words), "{sets}: {message}");
        assert!(!usual.contains(words), "{words}: {usual}");
    }
    // Driven bodies get energy from outside: only of one that is left alone is it known that it has made some. Compression
    // without control of the curl does, with any flux.
    let sealed = "--set boundary.1.kind=wall --set boundary.3.kind=wall --set curl.control=off --set watch.energy=off \
                  --set scheme.flux=acoustic --set time.end=1e-2";
    let start = "--set initial.deformation=[0.9,0,0,0.9] --set initial.velocity=[\"10*sin(91*x)\",\"10*sin(77*y)\"]";
    let alone = bench().fail(3, &format!("run case.toml --set scheme.degree=2 {sealed} {start}"));
    assert!(alone.contains("the energy had risen to") && !usual.contains("the energy had risen"), "{alone}");
}
