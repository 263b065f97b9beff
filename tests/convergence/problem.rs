//! Problems whose solution is known: what is solved, up to when, and how.

use dgmpm::parts::exact::{Dual, Exact, Manufactured};
use dgmpm::parts::material::{Material, NeoHookean, Past};
use dgmpm::parts::step::Law;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A problem: its law, solution and what stands at its sides.
#[derive(Clone)]
pub struct Problem {
    pub law: Law,
    pub exact: Arc<dyn Exact>,
    /// Pairs of groups that are periodic.
    pub periodic: Vec<[usize; 2]>,
    pub end: f64,
    /// Share of the stability limit.
    pub safety: f64,
    /// alpha of LCF as a scene gives it, times N in the scheme; none: LCF off.
    pub alpha: Option<f64>,
}

/// The law of all periodic problems: E = 1, nu = .3, rho0 = 1.
fn unit_law() -> NeoHookean {
    NeoHookean::new(1.0, 0.3, 1.0)
}

/// Strain of 5 % about F = 1, period 1.
pub fn manufactured(end: f64, alpha: f64) -> Problem {
    let law = Law::from(unit_law());
    let exact = Arc::new(Manufactured::new(law.clone(), 0.05, 1.0));
    Problem { law, exact, periodic: vec![[0, 1], [2, 3]], end, safety: 0.85, alpha: Some(alpha) }
}

/// Waves of strain `amplitude` about the uniform state F = `stretch` times the unit tensor, period 1.
pub fn prestrained(stretch: f64, amplitude: f64, end: f64, alpha: Option<f64>) -> Problem {
    let law = Law::from(unit_law());
    let exact = Arc::new(Prestrained { law: unit_law(), stretch, amplitude });
    Problem { law, exact, periodic: vec![[0, 1], [2, 3]], end, safety: 0.85, alpha }
}

/// x = stretch X + u, u1 = a/k sin(k X1) cos(k X2 + .4) cos(w t + .3), u2 = a/k cos(k X1 + .7) sin(k X2) cos(w t + .3),
/// k = w = 2 pi (c_p is near 1), with its body force b = d2u/dt2 - Div P / rho0.
struct Prestrained {
    law: NeoHookean,
    stretch: f64,
    amplitude: f64,
}

impl Prestrained {
    fn gradient(&self, x: [Dual; 2], t: f64) -> [Dual; 4] {
        let number = |value| Dual::new(value, 0.0);
        let scale = number(self.amplitude * (TAU * t + 0.3).cos());
        let angle = |x: Dual, shift: f64| (x * number(TAU) + number(shift)).sin_cos();
        let ((sin_a, cos_a), (sin_b, cos_b)) = (angle(x[0], 0.0), angle(x[1], 0.4));
        let ((sin_c, cos_c), (sin_d, cos_d)) = (angle(x[0], 0.7), angle(x[1], 0.0));
        let base = number(self.stretch);
        [base + scale * cos_a * cos_b, -(scale * sin_a * sin_b), -(scale * sin_c * sin_d), base + scale * cos_c * cos_d]
    }
}

/// (sin k X1 cos(k X2 + .4), cos(k X1 + .7) sin k X2).
fn shape(x: [f64; 2]) -> [f64; 2] {
    let [a, b] = x.map(|x| TAU * x);
    [a.sin() * (b + 0.4).cos(), (a + 0.7).cos() * b.sin()]
}

impl Exact for Prestrained {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        self.gradient(x.map(|x| Dual::new(x, 0.0)), t).map(|f| f.value)
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        shape(x).map(|u| -self.amplitude * (TAU * t + 0.3).sin() * u)
    }

    fn body_force(&self, x: [f64; 2], t: f64) -> Option<[f64; 2]> {
        // Derivatives along X1, then X2, through the code of the law.
        let along = |a: usize| [0, 1].map(|k| Dual::new(x[k], if k == a { 1.0 } else { 0.0 }));
        let [first, second] = [0, 1].map(|a| self.law.stress(self.gradient(along(a), t), &mut Past::now([])));
        let inertia = -self.amplitude * TAU * (TAU * t + 0.3).cos();
        let u = shape(x);
        let density = self.law.density();
        Some([0, 1].map(|i| inertia * u[i] - (first[2 * i].slope + second[2 * i + 1].slope) / density))
    }
}
