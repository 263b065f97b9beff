//! How perturbations of a state grow: the linearised step of a patch or a small body, assembled from the program's own
//! kernels (a step of [`crate::step::Scheme`] on perturbed states), its eigenvalues, its energy and its largest step.
//!
//! `docs/stability.md` has the formulas and how to read the numbers.

mod angles;
mod assemble;
mod cases;
mod creep;
mod energy;
mod measure;
mod norms;
mod operator;
mod problem;
mod spectrum;
mod springs;
mod table;

pub use cases::{Case, Plan, axis, values};
pub use energy::Energy;
pub use measure::{Limit, Measured, Names, Questions, measure};
pub use problem::{Domain, Pattern, Problem, Setup};
pub use table::{Row, chart, csv, lines, rows};
