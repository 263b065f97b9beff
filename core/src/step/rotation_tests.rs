//! What the control of the curl by rotation holds.
use super::tests::{KINDS, Kind, distorted, march, midpoints, scheme, state, unpacked, wall, wavy};
use super::*;
use crate::material::LinearElastic;
use crate::mesh::Mesh;
use crate::tensor;

/// F on a cell with a rotation and a strain that are no gradients, about a compressed mean.
fn rough(_: [f64; 2], a: usize) -> [f64; 6] {
    let s = |k: usize| ((7 * a + 3 * k) as f64).sin();
    [0.9 + 0.02 * s(0), 0.03 * s(1), -0.02 * s(2), 0.85 + 0.02 * s(3), 0.0, 0.0]
}

/// F of all cells, `[cell][component][node]`, after the control alone: the difference of steps with and without it.
fn relaxed(mesh: &Mesh, kind: Kind, degree: usize, law: Option<Law>) -> [Vec<f64>; 2] {
    [true, false].map(|on| {
        let base = scheme(mesh, kind, degree, &midpoints(mesh, degree), wall);
        let base = Scheme { curl: base.curl.filter(|_| on), ..base };
        let scheme = match &law {
            Some(law) => base.with_laws(vec![law.clone()]),
            None => base,
        };
        let mut state = state(mesh, &scheme, rough);
        march(&scheme, &mut state, 1, 1e-3);
        unpacked(&scheme, &state)
    })
}

#[test]
fn the_control_moves_the_mean_of_f_in_second_order_alone_and_does_something() {
    let mesh = distorted(3);
    for degree in 1..=4 {
        let n = (degree + 1) * (degree + 1);
        for kind in KINDS {
            let [with, without] = relaxed(&mesh, kind, degree, None);
            let base = scheme(&mesh, kind, degree, &midpoints(&mesh, degree), wall);
            let mut largest = 0.0f64;
            for (cell, (with, without)) in with.chunks(6 * n).zip(without.chunks(6 * n)).enumerate() {
                let (block, lane) = base.operators.blocks.slot[cell];
                let masses: Vec<f64> = base.operators.geometry.masses(&base.operators.line, block, lane).collect();
                for k in 0..6 {
                    let change = |a: usize| with[k * n + a] - without[k * n + a];
                    let mean: f64 = (0..n).map(|a| masses[a] * change(a)).sum();
                    // theta (some 1e-3) times R and the variation of F in the cell, 2e-2 each.
                    assert!(mean.abs() < 4e-7, "{kind:?} S{degree}: {mean:e}");
                    (0..n).for_each(|a| largest = largest.max(change(a).abs()));
                }
            }
            // theta is 3 N 1e-3 times the prestress (some .3 of mu), R some 1e-2.
            assert!(largest > 1e-7, "{kind:?} S{degree}: {largest:e}");
        }
    }
}

#[test]
fn a_law_linear_in_f_is_left_alone_to_the_bit_and_a_body_in_tension_is_only_turned() {
    let mesh = distorted(3);
    let linear = Law::new(LinearElastic::new(1.0, 0.3, 1.3));
    for kind in KINDS {
        let [with, without] = relaxed(&mesh, kind, 2, Some(linear.clone()));
        assert!(with == without, "{kind:?}");
        let [with, without] = [true, false].map(|on| {
            let base = scheme(&mesh, kind, 2, &midpoints(&mesh, 2), wall);
            let scheme = Scheme { curl: base.curl.filter(|_| on), ..base };
            let mut state = state(&mesh, &scheme, |x, a| {
                let u = wavy(x, a);
                [u[0] + 0.15, u[1], u[2], u[3] + 0.1, 0.1 * u[4], 0.1 * u[5]]
            });
            march(&scheme, &mut state, 1, 0.05);
            unpacked(&scheme, &state)
        });
        let n = 9;
        let mut turned = 0.0_f64;
        for (with, without) in with.chunks(6 * n).zip(without.chunks(6 * n)) {
            for a in 0..n {
                let f = |u: &[f64]| [0, 1, 2, 3].map(|k| u[k * n + a]);
                let (one, two) = (f(with), f(without));
                let [c, d] = [one, two].map(tensor::right_cauchy_green);
                // Rounding of squares of numbers of size 1.
                assert!((0..3).all(|k| (c[k] - d[k]).abs() < 1e-14), "{kind:?}: {c:?} {d:?}");
                turned = (0..4).fold(turned, |most, k| most.max((one[k] - two[k]).abs()));
            }
        }
        assert!(turned > 1e-9, "{kind:?}: {turned:e}");
    }
}

#[test]
fn the_jump_of_rotation_does_no_work_for_a_law_linear_in_f() {
    use crate::riemann::{Dual, Medium, Trace};
    let law = Law::new(LinearElastic::new(1.0, 0.4, 1.3));
    let n = [0.6, 0.8];
    for k in 0..50 {
        let s = |i: usize| 0.1 * ((13 * k + 5 * i) as f64).sin();
        let side = |at: usize| {
            let f = [1.0 + s(at), s(at + 1), s(at + 2), 1.0 + s(at + 3)];
            Trace { f, v: [0.0; 2], t: [0.0; 2], c: law.speeds(f, n) }
        };
        let (minus, plus) = (side(0), side(9));
        let add = Dual::incompatible(&minus, &plus, n, 1.0, &Medium::new(law.density(), law.shear_modulus(), 2));
        // The power against a symmetric stress, about F = 1: of second order in F - 1 (here .01), where the jump is of first.
        let work = tensor::contract(add, [1.0, 0.3, 0.3, -0.7]);
        assert!(work.abs() < 0.5 * 0.1 * 0.1, "{work:e}");
    }
}
