//! Every exact solution against the equations themselves, and against the numbers of the design.
use super::*;
use crate::material::{LinearElastic, NeoHookean};

fn steel() -> Law {
    Law::new(NeoHookean::new(2e11, 0.3, 7800.0))
}

fn soft() -> Law {
    Law::new(NeoHookean::new(1.0, 0.3, 1.0))
}

/// A solution with its law, and points, times and steps of differences where it is smooth.
struct Case {
    name: &'static str,
    exact: Box<dyn Exact>,
    law: Law,
    points: Vec<[f64; 2]>,
    times: Vec<f64>,
    step: [f64; 2],
}

fn cases() -> Vec<Case> {
    let line: Vec<[f64; 2]> = (1..30).map(|i| [0.1 * i as f64, 0.3]).collect();
    let square: Vec<[f64; 2]> = (0..20).map(|i| [0.37 * i as f64 % 1.0, 0.61 * i as f64 % 1.0]).collect();
    let ring = |i: usize| [0.8 + 0.02 * i as f64, 0.7 * i as f64];
    let annulus = (0..20).map(ring).map(|[r, a]| [1.5 + r * a.cos(), 1.5 + r * a.sin()]).collect();
    let linear = Law::new(LinearElastic::new(2e11, 0.3, 7800.0));
    let fans = [[0.9, -600.0], [0.95, 600.0]];
    vec![
        Case {
            // In the fans, X1 from .882 to .919 and from 2.081 to 2.102, and on all sides of them.
            name: "fans",
            exact: Box::new(Riemann::new(&[steel()], fans, 1.5).unwrap()),
            law: steel(),
            points: [0.87, 0.89, 0.91, 1.2, 1.6, 2.07, 2.085].map(|x| [x, 0.0]).to_vec(),
            times: vec![1e-4],
            step: [1e-5, 1e-9],
        },
        Case {
            name: "simple wave",
            exact: Box::new(SimpleWave::new(steel(), 0.1, 0.75, 0.12)),
            law: steel(),
            points: line.clone(),
            times: vec![1e-4, 2.5e-4],
            step: [1e-5, 1e-9],
        },
        Case {
            name: "linear bar",
            exact: Box::new(LinearBar::new(&linear, 3.0, 1e-3, 1.5, 0.2)),
            law: linear,
            points: line,
            times: vec![1e-4, 4e-4, 7e-4, 2.2e-3],
            step: [1e-4, 1e-8],
        },
        Case {
            name: "manufactured",
            exact: Box::new(Manufactured::new(soft(), 0.05, 1.0)),
            law: soft(),
            points: square,
            times: vec![0.0, 0.1, 0.25],
            step: [1e-4, 1e-4],
        },
        Case {
            name: "vortex",
            exact: Box::new(Vortex::new(soft(), [1.5, 1.5], 1.0, 1.0, 1.0)),
            law: soft(),
            points: annulus,
            times: vec![0.1, 0.3, 0.8],
            step: [1e-5, 1e-5],
        },
    ]
}

/// Central difference of K numbers.
fn slope<const K: usize>(function: impl Fn(f64) -> [f64; K], h: f64) -> [f64; K] {
    let (plus, minus) = (function(h), function(-h));
    std::array::from_fn(|k| (plus[k] - minus[k]) / (2.0 * h))
}

#[test]
fn every_solution_satisfies_compatibility_and_momentum_balance() {
    for Case { name, exact, law, points, times, step: [hx, ht] } in cases() {
        let c = law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0];
        for &t in &times {
            let along = |a: usize, h: f64, x: [f64; 2]| [0, 1].map(|k| x[k] + if k == a { h } else { 0.0 });
            let gradient = |x: [f64; 2]| [0, 1].map(|a| slope(|h| exact.velocity(along(a, h, x), t), hx));
            // The largest slope of v is the scale of every term, since v is of the size c times the strain.
            let size = points.iter().flat_map(|&x| gradient(x)).flatten().fold(0.0_f64, |s, v| s.max(v.abs()));
            for &x in &points {
                let [dv1, dv2] = gradient(x);
                let df = slope(|h| exact.deformation(x, t + h), ht);
                let expected = [dv1[0], dv2[0], dv1[1], dv2[1]];
                // Differences: h^2 times third derivatives, rounding of 1e-16 F / h.
                let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * size;
                assert!((0..4).all(|k| close(df[k], expected[k])), "{name} {x:?} {t}: {df:?} {expected:?}");
                let dv = slope(|h| exact.velocity(x, t + h), ht);
                let stress = |a: usize| slope(|h| law.stress(exact.deformation(along(a, h, x), t)), hx);
                let (s1, s2) = (stress(0), stress(1));
                let b = exact.body_force(x, t).unwrap_or_default();
                for i in 0..2 {
                    let force = (s1[2 * i] + s2[2 * i + 1]) / law.density() + b[i];
                    assert!(close(dv[i] / c, force / c), "{name} {x:?} {t}: {} {force}", dv[i]);
                }
            }
        }
    }
}

#[test]
fn shocks_of_the_wall_impact_are_those_of_the_design() {
    for (speed, stretch, p11, shock) in [
        (200.0, 0.966221152117, -9.23654948e9, 5920.865),
        (800.0, 0.868320670, -3.79102780e10, 6075.365),
        (2000.0, 0.691192233, -1.01033728e11, 6476.521),
    ] {
        let impact = WallImpact::new(&steel(), speed);
        // The digits that the design gives.
        assert!((impact.stretch() - stretch).abs() < 1e-9, "{}", impact.stretch());
        assert!((impact.shock() / shock - 1.0).abs() < 1e-6);
        let behind = impact.deformation([0.1, 0.0], 1e-3);
        assert!((steel().stress(behind)[0] / p11 - 1.0).abs() < 1e-8);
        assert_eq!((impact.velocity([0.1, 0.0], 1e-3), impact.velocity([9.0, 0.0], 1e-3)), ([0.0; 2], [-speed, 0.0]));
    }
}

#[test]
fn the_simple_wave_breaks_when_the_design_says() {
    let until = SimpleWave::new(steel(), 0.1, 0.75, 0.12).until();
    // The design gives 6 digits; the search samples 4000 characteristics about a smooth minimum.
    assert!((until / 4.36852e-4 - 1.0).abs() < 3e-6, "{until:e}");
}

#[test]
fn the_linear_bar_keeps_wall_and_free_end() {
    let law = Law::new(LinearElastic::new(2e11, 0.3, 7800.0));
    let bar = LinearBar::new(&law, 3.0, 1e-3, 1.5, 0.2);
    for k in 0..50 {
        let t = 5e-5 * k as f64;
        // Rounding of sums of v up to 3 m/s; the tail of the pulse at the ends is exp(-56).
        assert!(bar.velocity([0.0, 0.0], t)[0].abs() < 1e-14);
        assert!((bar.deformation([3.0, 0.0], t)[0] - 1.0).abs() < 1e-15);
    }
}
