//! One suite over every condition, and what each holds alone.
use super::*;
use crate::material::{NeoHookean, PointLaw};
use crate::riemann::star;
use crate::tensor;
use std::sync::Arc;

const N: [f64; 2] = [0.6, 0.8];
const MEDIUM: Medium<f64> = Medium { density: 1.3, shear_admittance: 1.0, share: 1.0, turn: 0.0, is_objective: true };
const AT: FacePoint = FacePoint { x: [0.3, 0.4], normal: N, medium: MEDIUM };
const NOW: Moment = Moment { times: &[TimeNode { time: 0.0, weight: 1.0 }], dt: 0.0 };

fn trace(f: [f64; 4], v: [f64; 2]) -> Trace<f64> {
    let law = NeoHookean::new(1.0, 0.3, 1.3);
    Trace { f, v, t: tensor::times(law.stress(f), N), c: law.speeds(f, N) }
}

fn constant(x: f64) -> Data {
    Arc::new(move |_, _| x)
}

/// A state whose traction is that of a pressure on the current area.
fn pressed(f: [f64; 4], p: f64, v: [f64; 2]) -> Trace<f64> {
    Trace { t: tensor::times(tensor::cofactor(f), N).map(|area| -p * area), ..trace(f, v) }
}

/// Each condition with a state that satisfies it: the flux must then be that of the state itself.
#[test]
fn a_state_that_satisfies_the_condition_is_kept() {
    let rest = [1.0, 0.0, 0.0, 1.0];
    let strained = [1.02, 0.01, 0.01, 0.97];
    let moving = trace(strained, [0.1, -0.2]);
    let along = trace(rest, [-0.08, 0.06]);
    let cases: Vec<(&str, Arc<dyn Boundary>, Trace<f64>)> = vec![
        ("free", Arc::new(Free), trace(rest, [0.1, -0.2])),
        ("wall, sliding", Arc::new(Wall { speed: None }), along),
        ("moving wall", Arc::new(Wall { speed: Some(constant(0.5)) }), trace(rest, [0.3, 0.4])),
        ("traction", Arc::new(Traction { value: moving.t.map(constant) }), moving),
        ("velocity", Arc::new(Velocity { value: moving.v.map(constant) }), moving),
        ("absorbing", Arc::new(Absorbing), trace(rest, [0.0, 0.0])),
        ("pressure", Arc::new(Pressure { value: constant(0.4) }), pressed(strained, 0.4, [0.1, -0.2])),
    ];
    for (name, condition, state) in cases {
        let (flux, own) = (condition.flux(&state, &AT, &NOW, &mut []), star(state.v, state.t, N));
        for k in 0..6 {
            // One rounding of numbers of size 1.
            assert!((flux[k] - own[k]).abs() < 1e-15, "{name} {k}: {} {}", flux[k], own[k]);
        }
    }
}

#[test]
fn an_outgoing_plane_wave_leaves_through_the_absorbing_edge() {
    // Linear wave along N: t = -z_p (v.N) N, F = 1 - (v.N)/c_p N N^T, small so that the law is linear.
    let amplitude = 1e-9;
    let rest = trace([1.0, 0.0, 0.0, 1.0], [0.0; 2]);
    let v = N.map(|n| amplitude * n);
    let z = AT.medium.density * rest.c[0];
    let state = Trace { v, t: N.map(|n| -z * amplitude * n), ..rest };
    let flux = Absorbing.flux(&state, &AT, &NOW, &mut []);
    let own = star(state.v, state.t, N);
    for k in 0..6 {
        // Exact for the linear wave, to the rounding of its amplitude.
        assert!((flux[k] - own[k]).abs() < 1e-14 * amplitude, "{k}");
    }
}

#[test]
fn no_condition_that_holds_an_edge_does_work_on_it_while_it_is_at_rest() {
    let state = trace([0.95, 0.02, -0.03, 1.01], [0.3, -0.1]);
    let zero = [constant(0.0), constant(0.0)];
    let clamped = Velocity { value: zero }.flux(&state, &AT, &NOW, &mut []);
    assert_eq!(clamped[..4], [0.0; 4]);
    let wall = Wall { speed: None }.flux(&state, &AT, &NOW, &mut []);
    // v*.N = 0: the row of F along N has no normal part, and the tangential traction is 0.
    let (t, tangential) = ([-wall[4], -wall[5]], crate::riemann::tangent(N));
    assert!(tensor::dot(t, tangential).abs() < 1e-15);
    assert!((tensor::dot(N, [wall[0] * N[0] + wall[1] * N[1], wall[2] * N[0] + wall[3] * N[1]])).abs() < 1e-15);
}

mod contact;
mod springs;

#[test]
fn data_that_depends_on_time_is_averaged_over_the_time_nodes() {
    let linear: Data = Arc::new(|x, t| x[0] + 10.0 * t);
    let times = [TimeNode { time: 0.0, weight: 0.25 }, TimeNode { time: 2.0, weight: 0.75 }];
    assert_eq!(mean(&linear, [0.5, 0.0], &Moment { times: &times, dt: 1.0 }), 15.5);
}
