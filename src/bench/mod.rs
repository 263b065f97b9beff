//! How fast the step is: the simple wave on a periodic rectangle, timed, counted in flops, and set against what this
//! machine can do.
//!
//! A DoF-update is one scalar unknown in one Runge-Kutta stage, or in one ADER step; rates are per CPU second. A step is
//! `Scheme::step` and the survey of its result, as in a run; building matrices and comparing with the exact solution are
//! not timed. Flops are counted by running the same kernels on [`crate::lane::counted`].

mod campaign;
mod flops;
mod measure;
mod peaks;
mod series;
mod setup;
mod summary;
mod table;
mod traffic;
mod wave;

pub use campaign::Campaign;
pub use flops::{Flops, count};
pub use measure::{Length, Measured, measure};
pub use peaks::{Peaks, peaks};
pub use setup::{Domain, Setup, Subject};
pub use table::{Figures, oneline, report};
pub use traffic::traffic;

#[cfg(test)]
mod tests;
