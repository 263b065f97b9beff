//! Hard cases: shocks, corners, distorted cells, large rotation, plastic bars, long runs, by the program as its users have it.
//!
//! `cargo test` runs the quick set. With DGMPM_HARD=all every case is run and docs/hard_cases.md is written (`make hard-cases`). A
//! criterion that a case does not meet is named with it as open (`Case::open`): it stands in the page with its figure, and nothing
//! holds it. A criterion that is met is held, in both sets.

mod cases;
mod checks;
mod exact;
mod page;
mod run;
#[path = "../runs/mod.rs"]
mod runs;

use cases::Case;
use run::Finished;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What came out of a check.
#[derive(Clone)]
pub struct Verdict {
    /// The criterion in words.
    pub criterion: String,
    /// What was found.
    pub figure: String,
    /// Whether the criterion is met.
    pub met: bool,
}

/// A case after its run.
pub struct Outcome {
    /// The case.
    pub case: Case,
    /// The verdict of each check, and whether the case says that it is open.
    pub verdicts: Vec<(Verdict, bool)>,
    /// Wall seconds of the run.
    pub seconds: f64,
}

/// Cases that are run side by side, each by one thread.
const SIDE_BY_SIDE: usize = 2;

fn outcome(case: Case) -> Outcome {
    let finished = Finished::of(case.scene, &case.sets);
    let verdicts = case.checks.iter().map(|check| ((check.of)(&finished), case.open.contains(&check.kind))).collect();
    Outcome { verdicts, seconds: finished.seconds, case }
}

/// Runs the cases, a few at once; the outcomes stand in the order of the cases.
fn outcomes(cases: Vec<Case>) -> Vec<Outcome> {
    // Those that take minutes begin first, so that no thread waits for them at the end.
    let mut order: Vec<_> = (0..cases.len()).collect();
    order.sort_by_key(|&k| !cases[k].long);
    let cases: Vec<_> = cases.into_iter().map(|case| Mutex::new(Some(case))).collect();
    let done: Vec<_> = cases.iter().map(|_| Mutex::new(None)).collect();
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..SIDE_BY_SIDE {
            scope.spawn(|| {
                while let Some(&k) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let case = cases[k].lock().unwrap().take().unwrap();
                    *done[k].lock().unwrap() = Some(outcome(case));
                }
            });
        }
    });
    done.into_iter().filter_map(|place| place.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}

#[test]
fn each_case_meets_the_criteria_that_it_does_not_name_as_open() {
    let all = std::env::var("DGMPM_HARD").is_ok_and(|set| set == "all");
    let outcomes = outcomes(cases::all().into_iter().filter(|case| all || case.quick).collect());
    let mut missed = Vec::new();
    for Outcome { case, verdicts, seconds } in &outcomes {
        println!("{}: {seconds:.1} s", case.name);
        for (verdict, open) in verdicts {
            let met = if verdict.met { "met" } else { "NOT MET" };
            println!("    {met}: {}: {}", verdict.criterion, verdict.figure);
            if !verdict.met && !open {
                missed.push(format!("{}: {}: {}", case.name, verdict.criterion, verdict.figure));
            }
        }
    }
    if all {
        page::write(&outcomes);
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}
