//! The stability limit of the time step.

use super::Method;

/// 2D limits of dt c / h with the Rusanov flux and relaxed LCF, N = 0..6: the one-step predictor-corrector. N = 1..4
/// from the von Neumann analysis of the design; N = 5, 6 measured (docs/performance.md, "Limits of the time step").
const ADER: [f64; 7] = [0.5, 0.1667, 0.0838, 0.0504, 0.0325, 0.0225, 0.0165];
/// Runge-Kutta with the tableau of that degree: RK1, RK2, RK4, RK4, RK5, RK6, DOP853.
const RUNGE_KUTTA: [f64; 7] = [0.5, 0.1667, 0.1176, 0.0727, 0.0618, 0.04, 0.04];

/// dt c / h beyond which the method of degree N in space is unstable, at the time degree that belongs to it.
pub fn limit(method: &Method, degree: usize) -> f64 {
    let table = match method {
        Method::Ader { .. } => &ADER,
        Method::RungeKutta(_) => &RUNGE_KUTTA,
    };
    table[degree.min(table.len() - 1)]
}

/// The paper's reading of a cfl number: dt = cfl h / ((2N + 1) c), as a share of the limit.
pub fn safety_of_cfl(cfl: f64, method: &Method, degree: usize) -> f64 {
    cfl / ((2 * degree + 1) as f64 * limit(method, degree))
}

/// Growth per step of ADER of degree 4, 5, 6 at any dt (C = .9, in 1D, whatever the sweeps); none below.
pub fn growth(method: &Method, degree: usize) -> Option<f64> {
    match (method, degree) {
        (Method::Ader { .. }, 4) => Some(4e-6),
        (Method::Ader { .. }, 5) => Some(3e-5),
        (Method::Ader { .. }, 6) => Some(8e-5),
        _ => None,
    }
}
