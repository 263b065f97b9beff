//! What each effect adds to the standard scene: runs with it and without it, in turn.

use crate::error::{Error, Result};
use crate::problem::Problem;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// An effect on the standard scene.
pub(super) struct Case {
    /// The table of the scene that names it.
    pub table: &'static str,
    /// Its name there.
    pub name: &'static str,
    /// What is set in the scene for it.
    with: &'static [&'static str],
    /// And for the run that it is compared with.
    without: &'static [&'static str],
}

/// The left side under a condition, against a free one.
const fn side(name: &'static str, with: &'static [&'static str]) -> Case {
    Case { table: "[[boundary]]", name, with, without: &["boundary.0.kind=free"] }
}

const fn case(table: &'static str, name: &'static str, with: &'static [&'static str]) -> Case {
    Case { table, name, with, without: &[] }
}

const fn track(name: &'static str, with: &'static [&'static str]) -> Case {
    case("[[output]]", name, with)
}

/// All cases.
pub(super) const CASES: &[Case] = &[
    side("wall", &["boundary.0.kind=wall"]),
    side("symmetry", &["boundary.0.kind=symmetry"]),
    side("clamped", &["boundary.0.kind=clamped"]),
    side("velocity", &["boundary.0.kind=velocity", "boundary.0.value=[\"0\",\"x*t\"]"]),
    side("traction", &["boundary.0.kind=traction", "boundary.0.value=[\"1e8\",\"1e9*t\"]"]),
    side("absorbing", &["boundary.0.kind=absorbing"]),
    case("[[source]]", "gravity", &["source=[{kind=\"gravity\",value=[0,-9.81]}]"]),
    case("[[source]]", "body-force", &["source=[{kind=\"body-force\",value=[\"x*t\",\"-9.81\"]}]"]),
    Case { table: "[curl]", name: "rotation", with: &["curl.control=rotation"], without: &["curl.control=off"] },
    Case { table: "[curl]", name: "lcf", with: &["curl.control=lcf"], without: &["curl.control=off"] },
    case("[limiter]", "moment", &["limiter.kind=moment"]),
    case("[limiter]", "vertex", &["limiter.kind=vertex"]),
    case("[scheme]", "angular_momentum", &["scheme.angular_momentum=true"]),
    case("[scheme]", "springs", &["scheme.springs=true"]),
    track("fields", &["output=[{kind=\"fields\",every_steps=1},{kind=\"ledger\",balance=false,every_steps=1000000}]"]),
    track(
        "line",
        &[
            "output=[{kind=\"line\",name=\"a\",from=[0,0],to=[3,0],samples=300,every_steps=1},{kind=\"ledger\",balance=false,every_steps=1000000}]",
        ],
    ),
    track("ledger", &["output=[{kind=\"ledger\"}]"]),
    track(
        "probe",
        &["output=[{kind=\"probe\",name=\"a\",point=[1,1]},{kind=\"ledger\",balance=false,every_steps=1000000}]"],
    ),
    track("force", &["output=[{kind=\"force\",name=\"a\"},{kind=\"ledger\",balance=false,every_steps=1000000}]"]),
    track(
        "extreme",
        &[
            "output=[{kind=\"extreme\",name=\"a\",field=\"von_mises\"},{kind=\"ledger\",balance=false,every_steps=1000000}]",
        ],
    ),
    track(
        "length",
        &[
            "output=[{kind=\"length\",name=\"a\",from=[0,0],to=[3,0]},{kind=\"ledger\",balance=false,every_steps=1000000}]",
        ],
    ),
    track("energy", &["output=[{kind=\"energy\",name=\"a\"},{kind=\"ledger\",balance=false,every_steps=1000000}]"]),
];

/// What all runs have: the first third of a millisecond, and a ledger with its first and last row.
const ALL: [&str; 2] = ["time.end=3e-4", "output=[{kind=\"ledger\",balance=false,every_steps=1000000}]"];

/// So many runs each way; the least time counts.
const REPEATS: usize = 5;

/// What an effect costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// The table of the scene that names it.
    pub table: &'static str,
    /// Its name there.
    pub name: String,
    /// CPU time that it adds to a step, %.
    pub percent: f64,
    /// The same in microseconds.
    pub microseconds: f64,
}

/// Seconds of a step of a scene with overrides, on this thread.
fn seconds(scene: &Path, sets: &[&str], folder: &Folder) -> Result<f64> {
    let all: Vec<String> = ALL.iter().chain(sets).map(|set| (*set).to_owned()).collect();
    let mut problem = Problem::new(&Scene::load(scene, &all)?)?;
    folder.clear_results()?;
    let (report, result) = problem.record(folder, vec![], [&AtomicBool::new(false); 2], |_, _| {});
    result?;
    Ok(report.cpu / report.steps.max(1) as f64)
}

/// Measures all effects on a scene, the standard one, on one thread; files of the runs go to `folder`.
///
/// # Errors
/// A scene that cannot be run, such as one without a first condition.
pub fn measure(scene: &Path, folder: &Path, say: &(dyn Fn(String) + Sync)) -> Result<Vec<Cost>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|why| Error::output("a thread".as_ref(), why))?;
    let folder = &Folder::new(folder);
    pool.install(|| {
        let mut out = Vec::new();
        for case in CASES {
            let (mut with, mut without) = (f64::INFINITY, f64::INFINITY);
            for _ in 0..REPEATS {
                without = without.min(seconds(scene, case.without, folder)?);
                with = with.min(seconds(scene, case.with, folder)?);
            }
            let (table, name) = (case.table, case.name.to_owned());
            let cost =
                Cost { table, name, percent: 100.0 * (with / without - 1.0), microseconds: 1e6 * (with - without) };
            say(format!("{table} {}: {:+.1} %, {:+.1} us a step", case.name, cost.percent, cost.microseconds));
            out.push(cost);
        }
        Ok(out)
    })
}

/// Measured costs as they are stored; `head` says where they were measured.
pub fn text(costs: &[Cost], head: &[String]) -> String {
    let mut text: String = head.iter().map(|line| format!("# {line}\n")).collect();
    text += "table,name,percent,microseconds_a_step\n";
    for Cost { table, name, percent, microseconds } in costs {
        text += &format!("{table},{name},{percent:.1},{microseconds:.1}\n");
    }
    text
}

/// Where the stored costs were measured, and they.
pub fn stored() -> (Vec<String>, Vec<Cost>) {
    read(include_str!("measured.csv"))
}

fn read(text: &str) -> (Vec<String>, Vec<Cost>) {
    let head = text.lines().filter_map(|line| line.strip_prefix("# ")).map(str::to_owned).collect();
    let cost = |line: &str| {
        let mut cells = line.split(',');
        let (table, name) = (cells.next()?, cells.next()?);
        let table = CASES.iter().find(|case| case.table == table && case.name == name)?.table;
        let [percent, microseconds] = [cells.next()?, cells.next()?].map(|cell| cell.parse().ok());
        Some(Cost { table, name: name.to_owned(), percent: percent?, microseconds: microseconds? })
    };
    (head, text.lines().filter_map(cost).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_are_read_as_they_are_written() {
        let of = |table, name: &str, percent| Cost { table, name: name.to_owned(), percent, microseconds: 2.5 };
        let costs = vec![of("[[source]]", "gravity", -0.5), of("[[output]]", "probe", 12.0)];
        let head = vec!["commit abc".to_owned(), "a machine, with 2 processors".to_owned()];
        assert_eq!(read(&text(&costs, &head)), (head, costs));
    }
}
