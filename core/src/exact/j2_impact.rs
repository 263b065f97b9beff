//! Uniaxial impact of a J2 body on a wall: an elastic precursor and a shock in which the body flows.

use super::{Exact, bisect};
use crate::step::Law;

/// A body in X1 > 0 that flies at v1 = -V against a wall at X1 = 0, and cannot widen.
///
/// In uniaxial strain the direction of the flow does not change, so that the law in one step from virgin material is
/// its loading path P11(F11) exactly. P11'' < 0 on both branches and P11' falls at yield: from the state at yield a second,
/// slower shock follows the first. Jump conditions (3) across each: `rho0 S^2 = [P11]/[F11]` and `S [F11] = -[v1]`; behind the
/// last v1 = 0. Where the second shock would overtake the elastic one there is one shock, below yield the elastic one.
/// Valid until a wave from another boundary arrives.
#[derive(Debug, Clone)]
pub struct J2Impact {
    speed: f64,
    /// F11 behind each of the shocks, and its speed in X; the elastic one first.
    shocks: [(f64, f64); 2],
    /// Internal variables behind the second.
    internal: Vec<f64>,
    virgin: Vec<f64>,
}

/// The smallest stretch that is looked at.
const SMALLEST: f64 = 1e-3;

impl J2Impact {
    /// At speed V > 0, m/s; none where the law has no memory, or the impact would press the body to nothing.
    pub fn new(law: &Law, speed: f64) -> Option<Self> {
        if !law.has_memory() {
            return None;
        }
        let virgin = law.virgin();
        let at = |f11: f64| law.response([f11, 0.0, 0.0, 1.0], &virgin);
        let stress = |f11: f64| at(f11).piola[0];
        let shock = |from: f64, to: f64| ((stress(to) - stress(from)) / (to - from) / law.density()).sqrt();
        // v1 gained from one state to the next, S [F11].
        let gain = |from: f64, to: f64| shock(from, to) * (from - to);
        // Bisection leaves a stretch that is elastic or the next number to one.
        let at_yield = bisect([SMALLEST, 1.0], |f11| if at(f11).dissipated > 0.0 { -1.0 } else { 1.0 });
        let missing = |f11: f64| match f11 {
            f11 if f11 >= at_yield => gain(1.0, f11) - speed,
            f11 if shock(at_yield, f11) >= shock(1.0, at_yield) => gain(1.0, f11) - speed,
            f11 => gain(1.0, at_yield) + gain(at_yield, f11) - speed,
        };
        if missing(SMALLEST) < 0.0 {
            return None;
        }
        let last = bisect([SMALLEST, 1.0 - 1e-15], missing);
        let two = last < at_yield && shock(at_yield, last) < shock(1.0, at_yield);
        let shocks = if two {
            [(at_yield, shock(1.0, at_yield)), (last, shock(at_yield, last))]
        } else {
            [(last, shock(1.0, last)); 2]
        };
        Some(Self { speed, shocks, internal: at(last).history, virgin })
    }

    /// F11 behind the elastic and the second shock, and their speeds in X, m/s; twice the same where there is one.
    pub fn shocks(&self) -> [(f64, f64); 2] {
        self.shocks
    }

    /// The number of shocks that have passed X.
    fn passed(&self, x: [f64; 2], t: f64) -> usize {
        self.shocks.iter().filter(|(_, shock)| x[0] < shock * t).count()
    }
}

impl Exact for J2Impact {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        let passed = self.passed(x, t);
        [if passed > 0 { self.shocks[passed - 1].0 } else { 1.0 }, 0.0, 0.0, 1.0]
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        let [(f11, shock), _] = self.shocks;
        let v = match self.passed(x, t) {
            0 => -self.speed,
            1 => shock * (1.0 - f11) - self.speed,
            _ => 0.0,
        };
        [v, 0.0]
    }

    fn internal(&self, x: [f64; 2], t: f64) -> Option<Vec<f64>> {
        Some(if self.passed(x, t) > 1 { &self.internal } else { &self.virgin }.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::J2;

    fn steel(yield_stress: f64) -> Law {
        Law::new(J2::new(2e11, 0.3, 7800.0, yield_stress, 1e10))
    }

    #[test]
    fn the_plateau_is_that_of_an_independent_program() {
        let law = steel(4e8);
        let exact = J2Impact::new(&law, 200.0).unwrap();
        let [_, (f11, second)] = exact.shocks();
        let behind = law.response([f11, 0.0, 0.0, 1.0], &law.virgin());
        // By a program of its own in closed form, s11 = 4/3 mu e; the design's prototype measured 7.4570e9, .025753, 4689.0.
        for (found, expected) in [
            (-behind.piola[0], 7_456_560_800.845),
            (behind.history[4], 0.025_751_598_117_6),
            (second, 4_688.971_541_956),
        ] {
            // Differences of stresses of the size of the moduli: 1e-16 2e11 / 7e9 each.
            assert!((found / expected - 1.0).abs() < 1e-11, "{found} {expected}");
        }
        assert_eq!(exact.internal([0.1, 0.0], 1e-4).unwrap(), behind.history);
    }

    #[test]
    fn momentum_and_energy_are_balanced_across_both_shocks() {
        let law = steel(4e8);
        let exact = J2Impact::new(&law, 200.0).unwrap();
        let t = 1e-4;
        let xs = exact.shocks().map(|(_, s)| s * t);
        assert!(xs[1] < xs[0]);
        let states = [xs[0] + 1e-6, 0.5 * (xs[0] + xs[1]), 0.5 * xs[1]].map(|x| {
            let at = [x, 0.0];
            let response = law.response(exact.deformation(at, t), &exact.internal(at, t).unwrap());
            (exact.deformation(at, t)[0], exact.velocity(at, t)[0], response)
        });
        for (k, (_, s)) in exact.shocks().into_iter().enumerate() {
            let ((f0, v0, before), (f1, v1, after)) = (&states[k], &states[k + 1]);
            assert!((s * (f1 - f0) + (v1 - v0)).abs() < 1e-9, "{k}");
            assert!((law.density() * s * (v1 - v0) + (after.piola[0] - before.piola[0])).abs() < 1e-2, "{k}");
            // Stored and dissipated together: a shock takes more, never less.
            let gained = after.energy + after.dissipated - before.energy - before.dissipated;
            let work = 0.5 * (after.piola[0] + before.piola[0]) * (f1 - f0);
            assert!(gained <= work * (1.0 + 1e-12) && gained > 0.99 * work, "{k}: {gained} {work}");
        }
    }

    #[test]
    fn below_yield_there_is_one_elastic_shock_and_a_huge_impact_has_none() {
        let exact = J2Impact::new(&steel(1e12), 200.0).unwrap();
        let [first, second] = exact.shocks();
        assert!(first == second && exact.internal([0.0; 2], 1.0).unwrap()[4] == 0.0);
        assert!((first.1 * (1.0 - first.0) - 200.0).abs() < 1e-9);
        assert!(J2Impact::new(&steel(4e8), 1e9).is_none());
    }

    #[test]
    fn a_law_without_memory_has_no_such_solution() {
        let law = Law::new(crate::material::NeoHookean::new(2e11, 0.3, 7800.0));
        assert!(J2Impact::new(&law, 200.0).is_none());
    }
}
