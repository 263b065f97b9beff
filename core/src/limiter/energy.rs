//! A limiter never gives energy to a cell.
//!
//! It cuts the slopes of F along one axis at a time. Where the slope of F11 falls and that of F22 stays, the slope of J may grow, whose
//! energy is lambda/mu times larger: a nearly incompressible body made 10 % of its energy so within some hundred steps.

use super::modes::{Places, of_lane};
use crate::lane::F8;
use crate::state::UNKNOWNS;
use crate::step::Law;
use crate::tensor::DEFORMATION;

/// F and p of a cell at its nodes.
#[derive(Debug, Clone)]
pub(super) struct Nodal {
    /// `[node][component]`.
    pub of: Places,
}

impl Nodal {
    /// Those of a lane.
    pub fn of(u: &[F8], n: usize, lane: usize) -> Self {
        Self { of: of_lane(u, n, lane) }
    }

    /// Into a lane.
    pub fn store(&self, u: &mut [F8], n: usize, lane: usize) {
        for (k, values) in u.chunks_exact_mut(n).take(UNKNOWNS).enumerate() {
            self.of.iter().zip(values).for_each(|(own, value)| value.0[lane] = own[k]);
        }
    }

    /// sum_a m_a W(F_a) and sum_a m_a |p_a|^2 / (2 rho0), J/m.
    fn energy(&self, law: &Law, masses: &[f64]) -> [f64; 2] {
        let mut out = [0.0; 2];
        for ([f11, f12, f21, f22, p1, p2], mass) in self.of.into_iter().zip(masses) {
            out[0] += mass * law.energy([f11, f12, f21, f22]);
            out[1] += mass * 0.5 * (p1 * p1 + p2 * p2) / law.density();
        }
        out
    }

    /// The root of sum_a m_a |u_a - mean u|^2 over some components.
    fn deviation(&self, masses: &[f64], means: &[f64; UNKNOWNS], components: std::ops::Range<usize>) -> f64 {
        let of = |k: usize| -> f64 {
            masses.iter().zip(&self.of).map(|(mass, values)| mass * (values[k] - means[k]).powi(2)).sum()
        };
        components.map(of).sum::<f64>().sqrt()
    }

    fn means(&self, masses: &[f64]) -> [f64; UNKNOWNS] {
        let area: f64 = masses.iter().sum();
        std::array::from_fn(|k| masses.iter().zip(&self.of).map(|(mass, values)| mass * values[k]).sum::<f64>() / area)
    }
}

/// A rise by less than this share of the energy of the cell is rounding.
const ROUNDING: f64 = 1e-12;

/// Where `new` has more energy than `old` (F of a law with internal variables is the same in both): deviations from the mean of the cell
/// are those of `old`, all shortened alike to the length of those of `new`. For a W that is convex in the cell this takes energy; F stays
/// as it was where it does not.
pub(super) fn hold(law: &Law, masses: &[f64], old: &Nodal, new: &mut Nodal) {
    let elastic = !law.has_memory();
    let energy = |nodal: &Nodal| if elastic { nodal.energy(law, masses) } else { [0.0, nodal.energy(law, masses)[1]] };
    let (before, after) = (energy(old), energy(new));
    // A number that is not finite is for the rescue.
    let rises = |after: f64, before: f64| after > before + ROUNDING * before.abs();
    if !rises(after[0] + after[1], before[0] + before[1]) {
        return;
    }
    let means = old.means(masses);
    for components in [0..DEFORMATION, DEFORMATION..UNKNOWNS] {
        let lengths = [old, &*new].map(|nodal| nodal.deviation(masses, &means, components.clone()));
        let share = if lengths[0] > 0.0 { (lengths[1] / lengths[0]).min(1.0) } else { 1.0 };
        for k in components {
            for a in 0..masses.len() {
                new.of[a][k] = means[k] + share * (old.of[a][k] - means[k]);
            }
        }
    }
    if rises(energy(new)[0], before[0]) {
        new.of.iter_mut().zip(&old.of).for_each(|(new, old)| new[..DEFORMATION].copy_from_slice(&old[..DEFORMATION]));
    }
}
