//! Effects at the boundary and in the body, against what is known of them: walls that let go, obstacles, friction, load tables,
//! pressure, foundation, damping. Short runs by the library.

#[path = "../runs/mod.rs"]
mod runs;
#[path = "../scenes/mod.rs"]
mod scenes;

mod contact;
mod friction;
mod loads;
mod volume;

use dgmpm::Folder;
use dgmpm::parts::problem::Problem;
use runs::Table;
use scenes::Body;

/// A finished run, and its ledger.
struct Run {
    problem: Problem,
    ledger: Table,
}

impl Run {
    /// Runs a scene of this text, with a row of the ledger for every step.
    fn of(body: Body) -> Self {
        Self::with_row_every(1, body)
    }

    /// The same with fewer rows, each of which costs about a step.
    fn with_row_every(steps: usize, body: Body) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut problem = body.ledger(steps).problem(&[]);
        let folder = Folder::new(folder.path());
        problem.run_in(&folder).unwrap();
        Self { problem, ledger: Table::read(&folder.ledger()) }
    }

    fn times(&self) -> Vec<f64> {
        self.ledger.column("t")
    }

    /// Momentum along an axis over time, kg/s.
    fn momentum(&self, axis: usize) -> Vec<f64> {
        self.ledger.column(["momentum_1", "momentum_2"][axis])
    }

    /// Force on the body along an axis, from row to row: the change of momentum over time, N/m.
    fn force(&self, axis: usize) -> Vec<f64> {
        let (p, t) = (self.momentum(axis), self.times());
        p.windows(2).zip(t.windows(2)).map(|(p, t)| (p[1] - p[0]) / (t[1] - t[0])).collect()
    }

    /// When the force along an axis first and last is beyond half of a size, s.
    fn contact(&self, axis: usize, size: f64) -> [f64; 2] {
        let (force, t) = (self.force(axis), self.times());
        let pushed: Vec<usize> = (0..force.len()).filter(|&k| force[k] / size > 0.5).collect();
        [t[pushed[0]], t[pushed[pushed.len() - 1] + 1]]
    }

    /// Kinetic and strain energy less the work of the outside, over time, J/m.
    fn accounted(&self) -> Vec<f64> {
        let all = ["total_energy", "boundary_work", "source_work"].map(|name| self.ledger.column(name));
        (0..all[0].len()).map(|k| all[0][k] - all[1][k] - all[2][k]).collect()
    }
}

/// The largest of some numbers.
fn largest(all: &[f64]) -> f64 {
    all.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The slope of the straight line through values over times, by least squares.
fn slope(t: &[f64], x: &[f64]) -> f64 {
    let n = t.len() as f64;
    let (mt, mx) = (t.iter().sum::<f64>() / n, x.iter().sum::<f64>() / n);
    let both: f64 = t.iter().zip(x).map(|(t, x)| (t - mt) * (x - mx)).sum();
    both / t.iter().map(|t| (t - mt).powi(2)).sum::<f64>()
}
