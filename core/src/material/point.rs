//! A law at one point, whichever it is: for boundaries, probes, exact solutions and tests. Blocks of cells do not come this way.

use super::{Material, Numbers, Past, Variable, virgin};
use crate::lane::Dual;

/// What a law says at one point.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// P, [P11, P12, P21, P22] in Pa.
    pub piola: [f64; 4],
    /// P33, Pa.
    pub piola33: f64,
    /// Stored energy, J/m^3.
    pub energy: f64,
    /// Dissipated energy, J/m^3.
    pub dissipated: f64,
    /// The history at F.
    pub history: Vec<f64>,
}

/// A law without its type. Every [`Material`] is one.
pub trait PointLaw: std::fmt::Debug + Send + Sync {
    /// rho0, in kg/m^3.
    fn density(&self) -> f64;

    /// mu, in Pa, see [`Material::shear_modulus`].
    fn shear_modulus(&self) -> f64;

    /// The variables of its history.
    fn variables(&self) -> &'static [Variable];

    /// Whether P(R F) = R P(F) for every rotation R, see [`Material::OBJECTIVE`].
    fn is_objective(&self) -> bool;

    /// What the law says at F, `dt` (s) after its history was `history`.
    fn response_after(&self, f: [f64; 4], history: &[f64], dt: f64) -> Response;

    /// P and its derivative along a direction, from F and that direction: through the code of the law itself, in virgin material.
    fn stress_and_slope(&self, f: [Dual; 4]) -> [Dual; 4];

    /// The acoustic tensor, see [`Material::acoustic`].
    fn acoustic(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 3];

    /// Its eigenvalues, see [`Material::moduli`].
    fn moduli(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 2];

    /// Speeds, see [`Material::speeds`].
    fn speeds(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 2];

    /// c_p, see [`Material::pressure_speed`].
    fn pressure_speed(&self, f: [f64; 4], n: [f64; 2]) -> f64;

    /// (c_p, c_s) along the smallest principal stretch, see [`Material::largest_squares`]; NaN where hyperbolicity is lost.
    fn largest_speeds(&self, f: [f64; 4], history: &[f64]) -> [f64; 2];

    /// The history of a point for another place, see [`Material::move_history`].
    fn move_history(&self, from: [f64; 4], to: [f64; 4], history: &mut [f64]);

    /// How many numbers its history has.
    fn history_len(&self) -> usize {
        self.variables().iter().map(|variable| variable.numbers.len()).sum()
    }

    /// Whether it has a history.
    fn has_memory(&self) -> bool {
        !self.variables().is_empty()
    }

    /// The history of virgin material.
    fn virgin(&self) -> Vec<f64> {
        self.variables().iter().flat_map(|variable| variable.numbers.iter().map(|(_, value)| *value)).collect()
    }

    /// Where the numbers of a variable stand in its history.
    fn place_of(&self, variable: &str) -> Option<std::ops::Range<usize>> {
        let mut first = 0;
        for known in self.variables() {
            if known.name == variable {
                return Some(first..first + known.numbers.len());
            }
            first += known.numbers.len();
        }
        None
    }

    /// What the law says at F, at once.
    fn response(&self, f: [f64; 4], history: &[f64]) -> Response {
        self.response_after(f, history, 0.0)
    }

    /// Stress of virgin material, see [`Material::stress`].
    fn stress(&self, f: [f64; 4]) -> [f64; 4] {
        self.response(f, &self.virgin()).piola
    }

    /// Out-of-plane stress of virgin material, see [`Material::stress33`].
    fn stress33(&self, f: [f64; 4]) -> f64 {
        self.response(f, &self.virgin()).piola33
    }

    /// Stored energy of virgin material, see [`Material::energy`].
    fn energy(&self, f: [f64; 4]) -> f64 {
        self.response(f, &self.virgin()).energy
    }
}

/// A history from its numbers; what is missing is virgin.
fn history_of<M: Material>(numbers: &[f64]) -> M::History<f64> {
    let mut out = virgin::<f64, M>();
    out.slice_mut().iter_mut().zip(numbers).for_each(|(out, number)| *out = *number);
    out
}

impl<M: Material> PointLaw for M {
    fn density(&self) -> f64 {
        Material::density(self)
    }

    fn shear_modulus(&self) -> f64 {
        Material::shear_modulus(self)
    }

    fn variables(&self) -> &'static [Variable] {
        M::HISTORY
    }

    fn is_objective(&self) -> bool {
        M::OBJECTIVE
    }

    fn response_after(&self, f: [f64; 4], history: &[f64], dt: f64) -> Response {
        let known = Past { history: history_of::<M>(history), dt };
        let mut past = known;
        let piola = Material::stress(self, f, &mut past);
        let (piola33, energy) = (Material::stress33(self, f, &known), Material::energy(self, f, &known));
        let history = past.history.slice().to_vec();
        Response { piola, piola33, energy, dissipated: self.dissipated(f, &known), history }
    }

    fn stress_and_slope(&self, f: [Dual; 4]) -> [Dual; 4] {
        Material::stress(self, f, &mut Past::now(virgin::<Dual, M>()))
    }

    fn acoustic(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 3] {
        Material::acoustic(self, f, n)
    }

    fn moduli(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 2] {
        Material::moduli(self, f, n)
    }

    fn speeds(&self, f: [f64; 4], n: [f64; 2]) -> [f64; 2] {
        Material::speeds(self, f, n)
    }

    fn pressure_speed(&self, f: [f64; 4], n: [f64; 2]) -> f64 {
        Material::pressure_speed(self, f, n)
    }

    fn largest_speeds(&self, f: [f64; 4], history: &[f64]) -> [f64; 2] {
        self.largest_squares(f, &history_of::<M>(history)).map(f64::sqrt)
    }

    fn move_history(&self, from: [f64; 4], to: [f64; 4], history: &mut [f64]) {
        let mut moved = history_of::<M>(history);
        Material::move_history(self, from, to, &mut moved);
        history.iter_mut().zip(moved.slice()).for_each(|(out, number)| *out = *number);
    }
}
