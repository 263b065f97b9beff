//! The methods, `[scheme] method = ..`.

use super::{ANY, Entry, Table};
use crate::basis::TimeBasis;
use crate::chart::{Marker, Stroke};
use crate::step::{Method as Integration, Sweeps as Picard, Tableau};

names! {
    /// The method of the step.
    Method {
        /// ADER-DG on material points (the paper's method).
        AderDgmpm = "ader-dgmpm",
        /// ADER-DG with the Gauss nodes as points.
        AderDgfem = "ader-dgfem",
        /// Runge-Kutta DG on the Gauss nodes.
        RkDgfem = "rk-dgfem",
    }
}

names! {
    /// The schedule of the predictor's Picard sweeps.
    Sweeps {
        /// max(N, N_T) + 1 sweeps on all time nodes.
        Paper = "paper",
        /// N sweeps, the j-th from j time nodes to j + 1, where N_T = N: fewer evaluations of the law (not in the paper).
        Ladder = "ladder",
    }
}

/// What there is to know of a method.
pub struct Build {
    /// The method.
    pub method: Method,
    /// Where its predictor samples; none: it has no predictor.
    pub samples: Option<Samples>,
    /// Time integration of degree N_T for degree N in space, with a schedule of sweeps where it has any.
    pub integration: fn(usize, usize, Sweeps) -> Integration,
    /// The marks of its lines in plots.
    pub marker: Marker,
    /// What joins them.
    pub stroke: Stroke,
}

/// Where a predictor samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Samples {
    /// At the material points.
    Points,
    /// At the Gauss nodes.
    Nodes,
}

/// Every method.
pub static METHODS: Table<Build> = Table::new(&[
    Entry {
        name: "ader-dgmpm",
        about: "ADER-DG on material points: the method of the paper",
        parameters: &[],
        check: ANY,
        build: Build {
            method: Method::AderDgmpm,
            samples: Some(Samples::Points),
            integration: ader,
            marker: Marker::Square,
            stroke: Stroke::Full,
        },
    },
    Entry {
        name: "ader-dgfem",
        about: "ADER-DG with the Gauss nodes as points",
        parameters: &[],
        check: ANY,
        build: Build {
            method: Method::AderDgfem,
            samples: Some(Samples::Nodes),
            integration: ader,
            marker: Marker::Triangle,
            stroke: Stroke::Dashed,
        },
    },
    Entry {
        name: "rk-dgfem",
        about: "Runge-Kutta DG on the Gauss nodes",
        parameters: &[],
        check: ANY,
        build: Build {
            method: Method::RkDgfem,
            samples: None,
            integration: |_, n_t, _| Integration::RungeKutta(Tableau::of_degree(n_t)),
            marker: Marker::Circle,
            stroke: Stroke::Dotted,
        },
    },
]);

fn ader(n: usize, n_t: usize, sweeps: Sweeps) -> Integration {
    let time = TimeBasis::new(n_t);
    let sweeps = match sweeps {
        Sweeps::Ladder => Picard::ladder(&time),
        Sweeps::Paper => Picard::paper(&time, n.max(n_t) + 1),
    };
    Integration::Ader { time, sweeps }
}

impl Method {
    /// What there is to know of it.
    pub fn build(self) -> &'static Build {
        // Every method has its entry: a test holds that.
        METHODS.iter().map(|entry| &entry.build).find(|build| build.method == self).unwrap_or(&METHODS.first().build)
    }

    /// Whether it samples at the material points.
    pub fn has_points(self) -> bool {
        self.build().samples == Some(Samples::Points)
    }
}
