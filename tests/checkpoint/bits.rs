//! A run that was stopped and resumed has the bits of a run that was not.

use crate::bodies::Parts;
use crate::common::{Bench, assert_same};
use dgmpm::parts::io::checkpoint;
use dgmpm::parts::problem::{Files, Newest, Problem, write_input};
use dgmpm::parts::run::Folder;
use dgmpm::{Error, Observer, Schedule, View};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks a run to stop at a step.
struct StopAt(Schedule, usize, Arc<AtomicBool>);

impl Observer for StopAt {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.0
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        self.2.fetch_or(view.state.step >= self.1, Ordering::Relaxed);
        Ok(())
    }
}

/// Steps a problem in its folder until it stops behind `step`, or to its end.
fn go(mut problem: Problem, folder: &Folder, step: usize) -> Result<(), Error> {
    let flag = Arc::new(AtomicBool::new(false));
    let schedule = Schedule::new(dgmpm::parts::observe::When::EverySteps(1), false);
    let stop = Box::new(StopAt(schedule, step, flag.clone()));
    problem.record(folder, vec![stop], [&flag, &AtomicBool::new(false)], |_, _| {}).1
}

/// A scene run in one go, and stopped at each of these steps and resumed: the same files.
fn compare(name: &str, scene: &Path, sets: &[&str], stops: &[usize]) {
    let out = tempfile::tempdir().unwrap();
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let problem = || Problem::load(scene, &sets).unwrap();
    let [whole, parts] = ["whole", "parts"].map(|name| Folder::new(&out.path().join(name)));
    let report = problem().run_in(&whole).unwrap_or_else(|why| panic!("{name}: {why}"));
    let first = problem();
    parts.clear_results().unwrap();
    write_input(&first, &Files::default(), &parts, first.body.certificates.clone()).unwrap();
    let stopped = go(first, &parts, stops[0]).unwrap_err();
    assert!(matches!(stopped, Error::Interrupted(_)), "{name}: {stopped}");
    for stop in stops[1..].iter().copied().chain([usize::MAX]) {
        let problem = Newest::read(&parts).unwrap().problem(&parts, &[], None).unwrap();
        assert!(problem.state.step < report.steps, "{name}: the run has {} steps", report.steps);
        let ended = go(problem, &parts, stop);
        assert!(stop == usize::MAX || ended.is_err(), "{name}: {} steps, stopped at {stop}", report.steps);
        assert!(stop != usize::MAX || ended.is_ok(), "{name}: {ended:?}");
    }
    assert_same(name, &whole.root, &parts.root);
}

#[test]
fn impact_regrid_plasticity_gap_and_all_outputs() {
    let scene = Bench::new();
    // Before, between and behind the changes of the grid; also at the step of the first change, and right after it.
    compare("all", &scene.path("case.toml"), &[], &[5, 16, 17, 30]);
    let elastic = "material=[{law=\"neo-hookean\",young=2e11,poisson=0.3,density=7800}]";
    compare("elastic", &scene.path("case.toml"), &[elastic, "regrid=[]", "checkpoint={every_minutes=1}"], &[4, 9]);
    compare("runge-kutta", &scene.path("case.toml"), &["scheme.method=rk-dgfem"], &[7, 30]);
    let front = "regrid=[{every_steps=4,when={front=0.2},shift=[0.01,0.01]},{at=[6e-5],rectangle={size=[1,0.5],cells=[5,3]},points=\"layout\"}]";
    compare("rules", &scene.path("case.toml"), &[front], &[6, 9, 20]);
}

#[test]
fn springs_in_faces() {
    let scene = Bench::new();
    let elastic = "material=[{law=\"neo-hookean\",young=2e11,poisson=0.3,density=7800}]";
    let sets = [elastic, "scheme.springs=true"];
    // Before, between and behind the changes of the grid.
    compare("springs", &scene.path("case.toml"), &sets, &[5, 16, 30]);
    compare("Runge-Kutta", &scene.path("case.toml"), &[&sets[..], &["scheme.method=rk-dgfem"]].concat(), &[7, 30]);
    let run = |threads: usize| {
        let sets: String = sets.iter().map(|set| format!(" --set {set}")).collect();
        scene.run(&format!("run case.toml --out on{threads} --threads {threads}{sets}"));
        scene.path(&format!("on{threads}"))
    };
    let [one, two, four] = [1, 2, 4].map(run);
    assert_same("2 threads", &one, &two);
    assert_same("4 threads", &one, &four);
}

#[test]
fn a_limiter_with_its_rescue() {
    let scene = Bench::new();
    let sets = [
        "material=[{law=\"neo-hookean\",young=2e11,poisson=0.3,density=7800}]",
        "initial.velocity=[\"-1500\",\"0\"]",
        "boundary.0={group=\"left\",kind=\"wall\"}",
        "limiter={kind=\"moment\"}",
        "regrid=[]",
        "mesh.rectangle.cells=[12,3]",
    ];
    for method in ["scheme.method=ader-dgmpm", "scheme.method=rk-dgfem"] {
        let sets: Vec<&str> = sets.iter().copied().chain([method]).collect();
        compare(method, &scene.path("case.toml"), &sets, &[5, 40]);
    }
}

#[test]
fn contact_with_friction_and_a_cohesive_edge() {
    let bench = Bench::new();
    let mut parts = Parts::default();
    let sides = |sides: [&str; 4]| sides.map(str::to_owned);
    parts.rectangle([0.0; 2], [1.0, 0.5], [4, 2], "body", &sides(["out", "a", "out", "out"]));
    parts.rectangle([1.005, 0.1], [0.5, 0.5], [3, 3], "body", &sides(["b", "out", "out", "out"]));
    let conditions = [("out", "kind=\"free\""), ("a", "kind=\"contact\",partner=\"b\",friction=0.3")];
    bench.of_parts(&parts, &conditions, "\"100*step(1.001 - x)\", \"-30*step(x - 1.001)\"");
    compare("contact", &bench.path("parts.toml"), &[], &[20, 60]);
    let mut parts = Parts::default();
    parts.rectangle([0.0; 2], [1.0, 0.4], [8, 4], "body", &sides(["out"; 4]));
    parts.group((0..8).map(|cell| (8 + cell, 3)), "joint");
    let conditions = [("out", "kind=\"free\""), ("joint", "kind=\"cohesive\",strength=2e8,energy=2e4")];
    bench.of_parts(&parts, &conditions, "0, \"40*step(y - 0.2) - 20\"");
    compare("cohesive", &bench.path("parts.toml"), &[], &[15, 40]);
}

#[test]
fn another_number_of_threads_and_a_later_end() {
    let bench = Bench::new();
    bench.run("run case.toml --out whole --threads 1");
    bench.run("run case.toml --out parts --threads 1 --set time.end=7.2e-5");
    let message = bench.fail(2, "resume parts");
    assert!(message.contains("the run is at its end") && message.contains("--set time.end="), "{message}");
    let newest = checkpoint::list(&bench.path("parts/checkpoints")).unwrap();
    assert_eq!(newest.len(), 2, "the last two are kept");
    // The last one is that of the end, whose steps were shortened to meet it; the one before is on the way of the longer run.
    std::fs::remove_file(&newest[1].1).unwrap();
    let said = bench.run("resume parts --threads 3 --set time.end=1.2e-4");
    assert!(said.contains(&format!("resumed at step {}", newest[0].0)), "{said}");
    let text = |run: &str| std::fs::read_to_string(bench.path(run).join("scene.toml")).unwrap();
    std::fs::write(bench.path("parts/scene.toml"), text("whole")).unwrap();
    assert_same("extended", &bench.path("whole"), &bench.path("parts"));
    bench.run("resume parts --set time.end=1.3e-4");
    let ledger = std::fs::read_to_string(bench.path("parts/ledger.csv")).unwrap();
    let last: Vec<f64> = ledger.lines().last().unwrap().split(',').map(|x| x.parse().unwrap()).collect();
    assert_eq!(last[1], 1.3e-4);
    let steps: Vec<&str> = ledger.lines().skip(1).map(|row| row.split(',').next().unwrap()).collect();
    assert!(steps.windows(2).all(|pair| pair[0] != pair[1]), "no row twice: {steps:?}");
}

#[test]
fn any_number_of_threads_has_the_bits_of_one_where_one_half_of_the_body_costs_more() {
    let bench = Bench::new();
    bench.of_mixed_body();
    for method in ["ader-dgmpm", "rk-dgfem"] {
        let run = |threads: usize| {
            let name = format!("{method}_{threads}");
            bench.run(&format!("run mixed.toml --out {name} --threads {threads} --set scheme.method={method}"));
            bench.path(&name)
        };
        let one = run(1);
        for threads in 2..=4 {
            let several = run(threads);
            assert_same(&format!("{method}, {threads} threads"), &one, &several);
            let text = std::fs::read_to_string(several.join("summary.json")).unwrap();
            let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
            let imbalance = &summary["threads_imbalance"];
            // Enough blocks for a tile for each thread: of half as many, Runge-Kutta makes one tile.
            assert_eq!(imbalance["seconds"].as_array().map(Vec::len), Some(threads), "{method}, {threads} threads");
            // A tile has 50 blocks or more in the mean, and the mean and one block more at most: the heaviest is less than 4 times the mean.
            let predicted = imbalance["predicted"].as_f64().unwrap();
            assert!((1.0..1.09).contains(&predicted), "{method}, {threads} threads: {predicted}");
        }
    }
}
