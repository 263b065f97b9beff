//! The stability limit of the time step.

use super::Method;

/// 2D limits of dt c / h of the one-step predictor-corrector with the Rusanov flux and relaxed LCF, N = 0..6, for any
/// N_T >= 1. N <= 4 from the von Neumann analysis of the design; N = 5, 6 measured by `examples/limits.rs` on 4 x 4
/// cells between walls (.0245, .0185), times .945, the smallest ratio of the two for N <= 4. Both schedules of the sweeps
/// have the same: by that example with `ladder`, at F = 1 and diag(.9, .9), no difference at its resolution of 1.5 %
/// (.1747 .0876 .0517 .0344 .0245 .0185 for N = 1..6 at F = 1).
const ADER: [f64; 7] = [0.5, 0.1667, 0.0838, 0.0504, 0.0325, 0.0231, 0.0174];

/// dt c / h beyond which the method of degree N in space is unstable; 0 where it is unstable for every step, as
/// explicit Euler (N_T = 0) is for N >= 1.
pub fn limit(method: &Method, degree: usize) -> f64 {
    match method {
        Method::Ader { time, .. } if time.len() == 1 && degree > 0 => 0.0,
        Method::Ader { .. } => ADER[degree.min(ADER.len() - 1)],
        Method::RungeKutta(tableau) => tableau.limits[degree.min(tableau.limits.len() - 1)],
    }
}

/// What is left of [`limit`] where the flux holds the jumps of the displacement ([`crate::riemann::hold`]). For ADER of degree 1 they
/// make the step stiffer: noise about F = 1 on periodic squares of 6 x 6 and 8 x 8 cells grows at .86 of the limit and more, and decays at
/// .84. From degree 2 on, and for Runge-Kutta, it decays at .99 of the limit. That is at nu = .3 (`dgmpm stability`: .858); at nu = .45 and
/// more the linearised step grows above .797 of the limit, which the default, .9 of .84, stays below.
pub fn share_when_held(method: &Method, degree: usize) -> f64 {
    match (method, degree) {
        (Method::Ader { .. }, 1) => 0.84,
        _ => 1.0,
    }
}

/// dt c over the height of a cell below which a step of ADER makes no energy of a jump of the velocity at a wall, such as at an impact that begins:
/// 1/(N + 1)^2.
///
/// Its predictor does not see the wall. The corrector then is a step of Euler: v jumps by v_w at the wall, the wall takes dt z v_w^2 an area, and the
/// rates of p and of F, each z v_w l_a(1)/(w_a b), have dt^2 z^2 v_w^2 (N + 1)^2/(rho0 b) in their squares, b being the height. On squares, whose
/// limit counts both directions, the default step is shorter; on rectangles of more than 1 : 2.8 (N = 2), 1 : 2.2 (N = 3) it is longer: the first
/// step of an impact made 2.1 % (S2, 1 : 4), 5.7 % (1 : 8), and 11 % between two walls; a wave that came back made 1 % once more.
pub fn at_walls(degree: usize) -> f64 {
    1.0 / ((degree + 1) * (degree + 1)) as f64
}

/// The largest dt alpha of v' = -alpha v. It grows beyond 2.0, 2.79, 2.79, 3.31 (Runge-Kutta) and 2.51, 2.79, 3.22, 3.55 (ADER) for N = 1..4, found
/// with a body in uniform motion. But the work of the damping is metered at the stages: Heun's is 2.5 % too large at .5 and a third at 1, which the
/// watch over the energy takes for energy that was made. Waves take their part of the step: dt is 1/(1/dt of waves + alpha/this).
pub const DECAY: f64 = 0.5;

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
