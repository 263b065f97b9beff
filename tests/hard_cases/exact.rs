//! Exact waves of uniaxial strain in steel.

/// E (Pa), nu and rho0 (kg/m^3).
const STEEL: [f64; 3] = [2e11, 0.3, 7800.0];

/// A shock that starts from F11 = 1.
#[derive(Clone, Copy)]
pub struct Shock {
    /// F11 behind it.
    pub stretch: f64,
    /// P11 = sigma11 behind it, Pa.
    pub stress: f64,
    /// Its speed in the reference configuration, m/s.
    pub speed: f64,
}

/// The zero of a function between two places where it has other signs.
fn zero(f: impl Fn(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (a + b);
        *(if f(middle) * f(a) > 0.0 { &mut a } else { &mut b }) = middle;
    }
    0.5 * (a + b)
}

/// rho0 v^2 = P (F - 1) and rho0 s^2 = P / (F - 1), for F in a range.
fn shock(stress: impl Fn(f64) -> f64, v: f64, range: [f64; 2]) -> Shock {
    let stretch = zero(|f| stress(f) * (f - 1.0) - STEEL[2] * v * v, range);
    let stress = stress(stretch);
    Shock { stretch, stress, speed: (stress / STEEL[2] / (stretch - 1.0)).sqrt() }
}

/// The shock that goes from the wall into neo-Hookean steel which hits it at v, m/s.
pub fn impact(v: f64) -> Shock {
    let [young, poisson, _] = STEEL;
    let (kappa, mu) = (young / 3.0 / (1.0 - 2.0 * poisson), 0.5 * young / (1.0 + poisson));
    let stress = |f: f64| {
        let a = mu * f.powf(-2.0 / 3.0);
        a * f + kappa * (f - 1.0) - a * (f * f + 2.0) / (3.0 * f)
    };
    shock(stress, v, [0.2, 1.0 - 1e-9])
}

/// P = M (F^3 - F)/2 of St. Venant-Kirchhoff steel: M, Pa.
fn modulus() -> f64 {
    let [young, poisson, _] = STEEL;
    young * (1.0 - poisson) / (1.0 + poisson) / (1.0 - 2.0 * poisson)
}

/// The shock of tension between halves that fly apart, each at v, of St. Venant-Kirchhoff steel.
pub fn tension(v: f64) -> Shock {
    shock(|f| 0.5 * modulus() * (f.powi(3) - f), v, [1.0 + 1e-9, 2.0])
}

/// Halves of St. Venant-Kirchhoff steel that meet, each at v: F11 at x/t = xi (its size, m/s) from where they meet, with
/// v = int_F^1 c dF, c^2 = M (3 F^2 - 1)/(2 rho0), and F11 at xi = 0.
pub fn fan(v: f64) -> impl Fn(f64) -> f64 {
    let (m, rho) = (modulus(), STEEL[2]);
    let c = move |f: f64| (0.5 * m * (3.0 * f * f - 1.0) / rho).sqrt();
    // Simpson's rule, far below the errors of a run.
    let speed = |f: f64| (1.0 - f) / 6.0 * (c(f) + 4.0 * c(0.5 * (1.0 + f)) + c(1.0));
    let least = zero(|f| speed(f) - v, [0.6, 1.0]);
    move |xi: f64| ((2.0 * rho * xi * xi / m + 1.0) / 3.0).sqrt().clamp(least, 1.0)
}
