//! How perturbations of a state grow: the linearised step, assembled from the program's own kernels.

mod angles;
mod assemble;
mod cases;
mod energy;
mod measure;
mod norms;
mod operator;
mod problem;
mod spectrum;
mod table;

pub use cases::{Case, Plan};
pub use energy::Energy;
pub use measure::{Measured, Names, Questions, measure};
pub use problem::{Domain, Pattern, Problem, Setup};
pub use table::{Row, lines};
