//! One suite, run over every flux.
use super::*;
use crate::material::{NeoHookean, PointLaw};
use proptest::prelude::*;

/// A flux without its type.
trait Choice: std::fmt::Debug + Sync {
    fn of(&self, minus: &Trace<f64>, plus: &Trace<f64>, n: [f64; 2]) -> [f64; 6];
    fn lift(&self, minus: &Trace<f64>, plus: &Trace<f64>, n: [f64; 2], scale: f64) -> [f64; 6];
}

impl<R: Riemann> Choice for R {
    fn of(&self, minus: &Trace<f64>, plus: &Trace<f64>, n: [f64; 2]) -> [f64; 6] {
        self.flux(minus, plus, n, &medium())
    }

    fn lift(&self, minus: &Trace<f64>, plus: &Trace<f64>, n: [f64; 2], scale: f64) -> [f64; 6] {
        self.lifted(minus, plus, n, &medium(), scale)
    }
}

const FLUXES: [&dyn Choice; 4] = [&Rusanov, &Acoustic, &AcousticCurl, &Dual];

fn law() -> NeoHookean {
    NeoHookean::new(1.0, 0.3, 1.3)
}

fn medium() -> Medium<f64> {
    Medium::new(law().density(), law().shear_modulus(), 2)
}

fn trace(f: [f64; 4], v: [f64; 2], n: [f64; 2]) -> Trace<f64> {
    Trace { f, v, t: tensor::times(law().stress(f), n), c: law().speeds(f, n) }
}

fn flux(choice: &dyn Choice, minus: &Trace<f64>, plus: &Trace<f64>, n: [f64; 2]) -> [f64; 6] {
    choice.of(minus, plus, n)
}

fn gradient() -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(-0.2..0.2f64).prop_map(|g| [1.0 + g[0], g[1], g[2], 1.0 + g[3]])
}

fn velocity() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(-0.5..0.5f64)
}

fn rotate(r: [f64; 2], a: [f64; 2]) -> [f64; 2] {
    [r[0] * a[0] - r[1] * a[1], r[1] * a[0] + r[0] * a[1]]
}

proptest! {
    #[test]
    fn is_consistent(f in gradient(), v in velocity(), angle in 0.0..6.3f64) {
        let n = [angle.cos(), angle.sin()];
        let state = trace(f, v, n);
        let exact = star(v, state.t, n);
        let two = interface(&state, &state, n, [1.3, 1.3]);
        for result in FLUXES.map(|choice| flux(choice, &state, &state, n)).into_iter().chain([two]) {
            for k in 0..6 {
                // flux(u, u) = F.N up to one rounding of numbers of size 1.
                prop_assert!((result[k] - exact[k]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn is_antisymmetric_to_the_bit(f in gradient(), g in gradient(), v in velocity(), w in velocity(), angle in 0.0..6.3f64) {
        let n = [angle.cos(), angle.sin()];
        let back = n.map(|x| -x);
        for choice in FLUXES {
            let turned = |t: Trace<f64>| Trace { t: t.t.map(|x| -x), ..t };
            let (minus, plus) = (trace(f, v, n), trace(g, w, n));
            let forth = flux(choice, &minus, &plus, n);
            let back = flux(choice, &turned(plus), &turned(minus), back);
            for k in 0..6 {
                // What one cell loses the other gains: no rounding may differ.
                prop_assert_eq!(forth[k], -back[k]);
            }
        }
    }

    #[test]
    fn lifted_is_the_flux_in_strong_form(f in gradient(), g in gradient(), v in velocity(), w in velocity(),
                                         angle in 0.0..6.3f64, scale in 0.1..2.0f64) {
        let n = [angle.cos(), angle.sin()];
        let (minus, plus) = (trace(f, v, n), trace(g, w, n));
        let turned = |t: &Trace<f64>| Trace { t: t.t.map(|x| -x), ..*t };
        for choice in FLUXES {
            let lifted = |minus: &Trace<f64>, plus: &Trace<f64>, n: [f64; 2]| {
                choice.lift(minus, plus, n, scale)
            };
            let (found, flux) = (lifted(&minus, &plus, n), flux(choice, &minus, &plus, n));
            for k in 0..6 {
                let own = if k < 4 { v[k / 2] * n[k % 2] } else { 0.0 };
                // Some ten operations on numbers of size 1.
                prop_assert!((found[k] - scale * (flux[k] + own)).abs() < 1e-14, "{choice:?} {k}");
            }
            let back = lifted(&turned(&plus), &turned(&minus), n.map(|x| -x));
            // What one cell loses of the momentum the other gains, to the bit; a jump of F or v is lifted on both sides.
            prop_assert_eq!([found[4], found[5]], [-back[4], -back[5]]);
        }
        let still = Rusanov.lifted(&minus, &minus, n, &medium(), scale);
        prop_assert_eq!(&still[..4], &[0.0; 4]);
    }

    #[test]
    fn turns_with_the_observer(f in gradient(), g in gradient(), v in velocity(), w in velocity(),
                               angle in 0.0..6.3f64, turn in 0.0..6.3f64) {
        let n = [angle.cos(), angle.sin()];
        let r = [turn.cos(), turn.sin()];
        let columns = |a: [f64; 4]| {
            let (x, y) = (rotate(r, [a[0], a[2]]), rotate(r, [a[1], a[3]]));
            [x[0], y[0], x[1], y[1]]
        };
        for choice in FLUXES {
            let still = flux(choice, &trace(f, v, n), &trace(g, w, n), n);
            let turned = flux(choice, &trace(columns(f), rotate(r, v), n), &trace(columns(g), rotate(r, w), n), n);
            let rows = columns([still[0], still[1], still[2], still[3]]);
            let p = rotate(r, [still[4], still[5]]);
            let expected = [rows[0], rows[1], rows[2], rows[3], p[0], p[1]];
            for k in 0..6 {
                // A chain of some 50 operations on numbers of size 1.
                prop_assert!((turned[k] - expected[k]).abs() < 1e-13, "{choice:?} {k}");
            }
        }
    }

    #[test]
    fn uniform_motion_crosses_an_interface_of_two_densities_without_stress(v in velocity(), angle in 0.0..6.3f64) {
        let n = [angle.cos(), angle.sin()];
        let state = trace([1.0, 0.0, 0.0, 1.0], v, n);
        let other = Trace { c: [5.0, 2.0], ..state };
        prop_assert_eq!(interface(&state, &other, n, [1.3, 7.0]), star(v, [0.0; 2], n));
    }
}
