//! Shape functions: grid (Lagrange), cloud (moving least squares), time.

pub mod lagrange;
pub mod mls;
pub mod time;

pub use lagrange::Lagrange;
pub use mls::MovingLeastSquares;
pub use time::TimeBasis;
