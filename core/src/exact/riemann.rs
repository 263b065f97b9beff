//! The Riemann problem of two states and two materials: exact, by the p-system of uniaxial strain.

use super::{Exact, bisect, speed_integral, uniaxial_speed};
use crate::quadrature::gauss_legendre;
use crate::step::Law;

/// Two uniform states (F11, v1) of two materials that meet at X1 = X0, from t = 0 on as one body that cannot widen.
///
/// A wave goes into each material, with the star state between them: v1 and P11 are continuous across X0, F11 is not.
/// A wave whose speed rises across it is a shock, with the jump conditions (3) S \[F11\] = -\[v1\], S rho0 \[v1\] = -\[P11\];
/// else it is a fan, on whose rays X1 - X0 = -+c(F11) t the invariant v1 -+ int c dF11 is that of the state ahead.
/// (In the neo-Hookean solid P11'' < 0 everywhere: compression shocks, release fans out.) Valid until a wave meets a
/// boundary. E. F. Toro, "Riemann Solvers and Numerical Methods for Fluid Dynamics" (2009), chapter 2, for the method;
/// the two materials enter through the curve of each side only.
#[derive(Debug, Clone)]
pub struct Riemann {
    interface: f64,
    /// The number of the law on the right.
    right: usize,
    sides: [Side; 2],
    /// v1 (m/s) and P11 (Pa) between the waves.
    star: [f64; 2],
}

/// A material with its wave, which goes away from the interface.
#[derive(Debug, Clone)]
struct Side {
    law: Law,
    /// F11 and v1 ahead of the wave.
    ahead: [f64; 2],
    /// dv1/dF11 over c: 1 for the wave to the left, -1 for that to the right.
    sign: f64,
    /// Gauss rule on [0, 1] for int c dF.
    rule: (Vec<f64>, Vec<f64>),
    /// F11 behind the wave.
    behind: f64,
    /// Speeds in X of its two ends, m/s; equal in a shock.
    head: f64,
    tail: f64,
}

/// The smallest stretch that is looked at.
const SMALLEST: f64 = 1e-6;
/// Changes of F11 that count as sound: speed and jump at the mean are exact to the square of it.
const WEAK: f64 = 1e-7;
/// Points of the rule for int c dF: exact to rounding for stretches within a factor 3 of each other.
const POINTS: usize = 16;
/// Doublings of the range that is searched for the star traction.
const DOUBLINGS: usize = 60;

impl Side {
    fn new(law: &Law, ahead: [f64; 2], sign: f64) -> Self {
        let c = uniaxial_speed(law, ahead[0]);
        Self { law: law.clone(), ahead, sign, rule: gauss_legendre(POINTS), behind: ahead[0], head: c, tail: c }
    }

    /// P11.
    fn stress(&self, f11: f64) -> f64 {
        self.law.stress([f11, 0.0, 0.0, 1.0])[0]
    }

    /// F11 under P11 = p, at least [`SMALLEST`].
    fn stretch(&self, p: f64) -> f64 {
        if self.stress(SMALLEST) >= p {
            return SMALLEST;
        }
        let mut largest = 2.0;
        while self.stress(largest) < p {
            largest *= 2.0;
        }
        bisect([SMALLEST, largest], |f11| self.stress(f11) - p)
    }

    /// Speed in X of a shock from the state ahead to F11, m/s; nothing where the wave is a fan.
    fn shock(&self, f11: f64) -> Option<f64> {
        let from = self.ahead[0];
        if (f11 - from).abs() < WEAK * from {
            return Some(uniaxial_speed(&self.law, 0.5 * (f11 + from)));
        }
        let steepens = uniaxial_speed(&self.law, f11) > uniaxial_speed(&self.law, from);
        let slope = (self.stress(f11) - self.stress(from)) / (f11 - from);
        steepens.then(|| (slope / self.law.density()).sqrt())
    }

    /// v1 where the wave has changed F11 to this.
    fn velocity(&self, f11: f64) -> f64 {
        let [from, v] = self.ahead;
        let change = self.shock(f11).map(|speed| speed * (f11 - from));
        v + self.sign * change.unwrap_or_else(|| speed_integral(&self.law, &self.rule, [from, f11]))
    }

    fn set_behind(&mut self, f11: f64) {
        let shock = self.shock(f11);
        self.behind = f11;
        self.head = shock.unwrap_or_else(|| uniaxial_speed(&self.law, self.ahead[0]));
        self.tail = shock.unwrap_or_else(|| uniaxial_speed(&self.law, f11));
    }

    /// F11 at this distance over time from the interface, m/s.
    fn at(&self, rate: f64) -> f64 {
        if rate >= self.head {
            self.ahead[0]
        } else if rate <= self.tail {
            self.behind
        } else {
            bisect([self.behind, self.ahead[0]], |f11| uniaxial_speed(&self.law, f11) - rate)
        }
    }
}

impl Riemann {
    /// Of the states (F11, v1 in m/s) left and right of X1 = `interface` (m), in the first and the last of `laws`.
    ///
    /// None where the impact presses a material below 1e-6 of its length: there is no star state then.
    pub fn new(laws: &[Law], states: [[f64; 2]; 2], interface: f64) -> Option<Self> {
        let right = laws.len().checked_sub(1)?;
        let laws = [laws.first()?, laws.last()?];
        let mut sides = [Side::new(laws[0], states[0], 1.0), Side::new(laws[1], states[1], -1.0)];
        // v1 of the left side rises with the star traction, that of the right side falls.
        let gap = |p: f64| sides[0].velocity(sides[0].stretch(p)) - sides[1].velocity(sides[1].stretch(p));
        let modulus = |side: &Side| side.law.density() * uniaxial_speed(&side.law, 1.0).powi(2);
        let mut range = modulus(&sides[0]) + modulus(&sides[1]);
        let mut doublings = 0;
        while !(gap(-range) < 0.0 && gap(range) > 0.0) {
            range *= 2.0;
            doublings += 1;
            if doublings > DOUBLINGS {
                return None;
            }
        }
        let p = bisect([-range, range], gap);
        for side in &mut sides {
            side.set_behind(side.stretch(p));
        }
        if sides.iter().any(|side| side.behind <= SMALLEST) {
            return None;
        }
        let v = 0.5 * (sides[0].velocity(sides[0].behind) + sides[1].velocity(sides[1].behind));
        Some(Self { interface, right, sides, star: [v, p] })
    }

    /// F11 and its side; at t = 0 the state that was there.
    fn at(&self, x: f64, t: f64) -> (f64, &Side) {
        let distance = x - self.interface;
        let side = &self.sides[usize::from(distance >= 0.0)];
        let f11 = if t > 0.0 { side.at(distance.abs() / t) } else { side.ahead[0] };
        (f11, side)
    }
}

impl Exact for Riemann {
    fn deformation(&self, x: [f64; 2], t: f64) -> [f64; 4] {
        [self.at(x[0], t).0, 0.0, 0.0, 1.0]
    }

    fn velocity(&self, x: [f64; 2], t: f64) -> [f64; 2] {
        let (f11, side) = self.at(x[0], t);
        // Behind the wave both sides have the same v1 to the last digit; ahead of it the change is zero.
        [if f11 == side.behind && f11 != side.ahead[0] { self.star[0] } else { side.velocity(f11) }, 0.0]
    }

    fn material(&self, x: [f64; 2]) -> usize {
        if x[0] < self.interface { 0 } else { self.right }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::WallImpact;
    use crate::material::{LinearElastic, NeoHookean};

    fn steel() -> Law {
        Law::new(NeoHookean::new(2e11, 0.3, 7800.0))
    }

    fn aluminium() -> Law {
        Law::new(NeoHookean::new(7e10, 0.33, 2700.0))
    }

    fn linear() -> Law {
        Law::new(LinearElastic::new(7e10, 0.33, 2700.0))
    }

    /// Laws, states, and which of the two waves are shocks.
    type Case = ([Law; 2], [[f64; 2]; 2], [bool; 2]);

    fn cases() -> Vec<Case> {
        vec![
            ([steel(), aluminium()], [[1.0, 400.0], [1.0, 0.0]], [true, true]),
            ([steel(), aluminium()], [[0.966, 200.0], [1.0, 0.0]], [false, true]),
            ([aluminium(), steel()], [[0.95, 100.0], [1.02, -50.0]], [false, true]),
            ([aluminium(), steel()], [[0.95, -300.0], [0.97, 250.0]], [false, false]),
            ([steel(), steel()], [[0.8, 0.0], [1.0, 0.0]], [false, true]),
            ([linear(), steel()], [[1.0, 10.0], [1.0, 0.0]], [false, true]),
        ]
    }

    /// Speeds in X of head and tail of the wave of each side, away from the interface, m/s; equal in a shock.
    fn waves(problem: &Riemann) -> [[f64; 2]; 2] {
        problem.sides.each_ref().map(|side| [side.head, side.tail])
    }

    fn p11(law: &Law, f: [f64; 4]) -> f64 {
        law.stress(f)[0]
    }

    #[test]
    fn shocks_keep_the_jump_conditions_and_fans_end_where_their_rays_do() {
        for (laws, states, shocks) in cases() {
            let problem = Riemann::new(&laws, states, 1.5).unwrap();
            let t = 1e-4;
            for side in 0..2 {
                let ([head, tail], sign) = (waves(&problem)[side], [-1.0, 1.0][side]);
                let at = |rate: f64| {
                    let x = [1.5 + sign * rate * t, 0.0];
                    let f = problem.deformation(x, t);
                    (f[0], problem.velocity(x, t)[0], p11(&laws[side], f))
                };
                let ((f, v, p), (g, w, q)) = (at(1.001 * head), at(0.999 * tail));
                assert_eq!([f, v], states[side], "{states:?}");
                // A wave in a linear material jumps too, at the speed of sound.
                if head == tail {
                    // (3) with S = +-head: rounding of F of order one times speeds of 6e3 m/s.
                    let (speed, density) = (sign * head, laws[side].density());
                    assert!((speed * (g - f) + (w - v)).abs() < 1e-9, "{states:?}");
                    assert!((speed * density * (w - v) + (q - p)).abs() < 1e-9 * density * head * head);
                    // Lax: faster than sound ahead, slower than sound behind.
                    let [before, after] = [f, g].map(|f11| uniaxial_speed(&laws[side], f11));
                    assert_eq!(before < head && head < after, shocks[side], "{states:?}");
                } else {
                    assert!(!shocks[side], "{states:?}");
                    assert!((head, tail) == (uniaxial_speed(&laws[side], f), uniaxial_speed(&laws[side], g)));
                    // Continuous at both ends of the fan.
                    let ((f1, v1, _), (g1, w1, _)) = (at(head * (1.0 - 1e-12)), at(tail * (1.0 + 1e-12)));
                    assert!((f1 - f).abs() < 1e-9 && (g1 - g).abs() < 1e-9, "{states:?}");
                    assert!((v1 - v).abs() < 1e-5 && (w1 - w).abs() < 1e-5, "{v1} {v} {w1} {w}");
                }
            }
        }
    }

    #[test]
    fn velocity_and_traction_are_continuous_across_the_interface_and_the_strain_is_not() {
        for (laws, states, _) in cases() {
            let problem = Riemann::new(&laws, states, 1.5).unwrap();
            let [l, r] = [1.5 - 1e-9, 1.5 + 1e-9].map(|x| [x, 0.0]);
            let ([f, g], t) = ([l, r].map(|x| problem.deformation(x, 1e-4)), 1e-4);
            assert_eq!((problem.material(l), problem.material(r)), (0, 1));
            assert_eq!(problem.velocity(l, t), problem.velocity(r, t));
            // Rounding of the bisection for F11, times the modulus of 2.7e11 Pa.
            assert!((p11(&laws[0], f) - p11(&laws[1], g)).abs() < 1e-3, "{states:?}");
            assert!((p11(&laws[0], f) - problem.star[1]).abs() < 1e-3);
            let same = format!("{:?}", laws[0]) == format!("{:?}", laws[1]);
            assert_eq!(same, (f[0] - g[0]).abs() < 1e-12, "{f:?} {g:?}");
        }
    }

    #[test]
    fn symmetric_data_are_the_impact_on_a_wall() {
        for speed in [1e-3, 200.0, 2000.0] {
            let problem = Riemann::new(&[steel()], [[1.0, speed], [1.0, -speed]], 0.0).unwrap();
            let wall = WallImpact::new(&steel(), speed);
            // Rounding of F11: that of 1e-3 m/s is 1.7e-7.
            assert!(problem.star[0].abs() < 1e-11 * speed.max(1.0), "{}", problem.star[0]);
            for (stretch, [head, tail]) in problem.sides.iter().map(|side| side.behind).zip(waves(&problem)) {
                assert!((stretch - wall.stretch()).abs() < 1e-13, "{speed}");
                assert!((head / wall.shock() - 1.0).abs() < 1e-7 && head == tail, "{speed}: {head} {}", wall.shock());
            }
        }
    }

    #[test]
    fn linear_materials_share_momentum_by_their_impedances() {
        let (a, b) = (linear(), Law::new(LinearElastic::new(2e11, 0.3, 7800.0)));
        let problem = Riemann::new(&[a.clone(), b.clone()], [[1.0, 10.0], [1.0, -4.0]], 0.0).unwrap();
        let [za, zb] = [&a, &b].map(|law| law.density() * uniaxial_speed(law, 1.0));
        assert!((problem.star[0] - (10.0 * za - 4.0 * zb) / (za + zb)).abs() < 1e-10);
        assert!((problem.star[1] / (-14.0 * za * zb / (za + zb)) - 1.0).abs() < 1e-11);
    }

    #[test]
    fn an_impact_that_leaves_nothing_has_no_solution() {
        assert!(Riemann::new(&[steel()], [[1.0, 1e9], [1.0, -1e9]], 0.0).is_none());
        assert!(Riemann::new(&[steel()], [[1.0, f64::MAX], [1.0, f64::MIN]], 0.0).is_none());
    }
}
