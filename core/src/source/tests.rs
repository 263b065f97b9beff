use super::*;
use std::sync::Arc;

#[test]
fn damping_acts_against_the_velocity_in_its_law_and_by_its_share() {
    let all = Damping { rate: 3.0, share: None, material: Some(1) };
    assert_eq!(all.acceleration([0.0; 2], 0.0, [2.0, -1.0], 1), [-6.0, 3.0]);
    assert_eq!(all.acceleration([0.0; 2], 0.0, [2.0, -1.0], 0), [0.0, 0.0]);
    let layer = Damping { rate: 4.0, share: Some(Arc::new(|x, _| x[0])), material: None };
    let at = |x: f64| layer.acceleration([x, 0.0], 0.0, [1.0, 0.0], 0)[0];
    // The share is cut to 0..1.
    assert_eq!([-1.0, 0.0, 0.25, 1.0, 2.0].map(at), [0.0, 0.0, -1.0, -4.0, -4.0]);
    assert_eq!((all.varies(), layer.varies()), (Varies::VELOCITY, Varies { place: true, time: true, velocity: true }));
}

const PULSE: PressurePulse = PressurePulse {
    amplitude: 2.0,
    centre: [0.5, -0.25],
    radius: 0.4,
    start: 1.0,
    duration: 0.5,
    density: 1.3,
    material: None,
};

#[test]
fn a_pressure_pulse_is_the_gradient_of_its_pressure_and_is_0_outside() {
    let pressure = |x: [f64; 2], t: f64| {
        let q = ((x[0] - 0.5).powi(2) + (x[1] + 0.25).powi(2)) / 0.16;
        2.0 * (1.0 - q).powi(3) * (std::f64::consts::PI * (t - 1.0) / 0.5).sin().powi(2)
    };
    let (x, t, h) = ([0.6, -0.1], 1.2, 1e-5);
    let b = PULSE.acceleration(x, t, [0.0; 2], 0);
    for i in 0..2 {
        let beside =
            |by: f64| pressure([x[0] + if i == 0 { by } else { 0.0 }, x[1] + if i == 1 { by } else { 0.0 }], t);
        let expected = -(beside(h) - beside(-h)) / (2.0 * h) / 1.3;
        // Central differences: h^2 times the third derivative, some 1e-10 of 1e2, and rounding over h.
        assert!((b[i] - expected).abs() < 1e-7, "{b:?} {expected}");
    }
    for (x, t) in [([0.95, -0.25], 1.2), ([0.6, -0.1], 0.99), ([0.6, -0.1], 1.51)] {
        assert_eq!(PULSE.acceleration(x, t, [0.0; 2], 0), [0.0; 2]);
    }
    // The middle pushes nowhere.
    assert_eq!(PULSE.acceleration([0.5, -0.25], 1.2, [0.0; 2], 0), [0.0; 2]);
}

#[test]
fn the_forces_of_a_pulse_within_the_body_sum_to_nothing() {
    let n = 200;
    let mut sum = [0.0; 2];
    for k in 0..n * n {
        let x = [(k % n) as f64, (k / n) as f64].map(|k| (k + 0.5) / n as f64);
        let b = PULSE.acceleration([x[0], x[1] - 0.75], 1.25, [0.0; 2], 0);
        (0..2).for_each(|i| sum[i] += b[i] / (n * n) as f64);
    }
    // Midpoints on a symmetric lattice: pairs cancel to rounding.
    assert!(sum.iter().all(|sum| sum.abs() < 1e-12), "{sum:?}");
}
