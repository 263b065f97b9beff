//! A row of the table, how it is run, and how it is judged.

use crate::meshes::Grid;
use crate::problem::{Problem, manufactured};
use crate::solve::{Kind, error};
use dgmpm::parts::accuracy::Errors;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A method of degree N in space and N_T in time on a problem and a family of meshes; what is expected of it.
pub struct Row {
    pub name: String,
    pub grid: Grid,
    pub kind: Kind,
    pub degree: usize,
    pub time_degree: usize,
    pub problem: Problem,
    /// Cells per direction, from the coarsest mesh.
    pub cells: Vec<usize>,
    /// The rate lies between them.
    pub rate: [f64; 2],
    /// Which of the errors counts.
    pub measure: fn(&Errors) -> f64,
    /// Errors known from elsewhere, from the coarsest mesh; within 10 %.
    pub known: &'static [f64],
}

/// The errors of a row, and the rate of its last two meshes.
#[derive(Debug, Clone, Default)]
pub struct Found {
    pub errors: Vec<f64>,
    pub rate: f64,
}

impl Row {
    /// N_T = N, alpha of the scene's default, t = .1, and a rate within .25 of N + 1, from both sides.
    pub fn new(grid: Grid, kind: Kind, degree: usize, cells: &[usize]) -> Self {
        let order = degree as f64 + 1.0;
        Row {
            name: "manufactured".into(),
            grid,
            kind,
            degree,
            time_degree: degree,
            problem: manufactured(0.1, if degree >= 4 { 6.0 } else { 3.0 }),
            cells: cells.to_vec(),
            rate: [order - 0.25, order + 0.25],
            measure: |errors| errors.distance,
            known: &[],
        }
    }

    /// Solves on all meshes and prints the line of the table.
    pub fn run(&self) -> Found {
        let solve = |&n: &usize| error(&self.problem, &self.grid.mesh(n), self.kind, self.degree, self.time_degree);
        let runs: Vec<_> = self.cells.iter().map(solve).collect();
        let errors: Vec<f64> = runs.iter().map(|(errors, _)| (self.measure)(errors)).collect();
        let rate = last_rate(&self.cells, &errors);
        let seconds: f64 = runs.iter().map(|(_, seconds)| seconds).sum();
        println!("{:<76} {:<32} rate {rate:5.2} {seconds:5.2} s", self.title(), short(&errors));
        Found { errors, rate }
    }

    fn title(&self) -> String {
        let (grid, cells) = (format!("{:?}", self.grid), format!("{:?}", self.cells));
        format!("{:<22} {grid:<10} {:<17} S{}T{} {cells:<13}", self.name, self.kind, self.degree, self.time_degree)
    }

    fn faults(&self, found: &Found) -> Vec<String> {
        let mut out = Vec::new();
        // Also where the rate is not a number.
        if !(self.rate[0] <= found.rate && found.rate <= self.rate[1]) {
            out.push(format!("{}: rate {:.2} outside {:?}", self.title(), found.rate, self.rate));
        }
        for (error, known) in found.errors.iter().zip(self.known) {
            if (error / known - 1.0).abs() > 0.1 {
                out.push(format!("{}: {error:.3e} instead of {known:.3e}", self.title()));
            }
        }
        out
    }
}

/// - d log error / d log cells between the last two meshes.
pub fn last_rate(cells: &[usize], errors: &[f64]) -> f64 {
    match (cells, errors) {
        ([.., n, m], [.., e, f]) => (e / f).ln() / (*m as f64 / *n as f64).ln(),
        _ => f64::NAN,
    }
}

pub fn short(values: &[f64]) -> String {
    values.iter().map(|x| format!("{x:.3e}")).collect::<Vec<_>>().join(" ")
}

/// Runs all rows, on as many threads as there are cores; what was found, in the order of the rows.
pub fn run_all(rows: &[Row]) -> Vec<Found> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let (next, found) = (AtomicUsize::new(0), Mutex::new(vec![Found::default(); rows.len()]));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some(row) = rows.get(k) else { break };
                    let result = row.run();
                    found.lock().unwrap()[k] = result;
                }
            });
        }
    });
    found.into_inner().unwrap()
}

/// Runs all rows and fails with all that is wrong.
pub fn hold(rows: &[Row]) {
    let found = run_all(rows);
    let faults: Vec<String> = rows.iter().zip(&found).flat_map(|(row, found)| row.faults(found)).collect();
    assert!(faults.is_empty(), "{faults:#?}");
}
