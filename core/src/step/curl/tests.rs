//! The projection of eight cells is that of each by itself, and relaxation is an exponential.
use super::*;
use crate::lane::Kernel;
use crate::mesh::{Mesh, links, rectangle};
use crate::operators::{Needs, Operators, with_nodes};
use crate::step::volume;

struct Project<'a, const M: usize>(&'a Operators, &'a mut [F8]);

impl<const M: usize> Work for Project<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(operators, u) = self;
        let mut nodes = volume::Arrays::new(M, 6, 0);
        let (line, metric) = (&operators.line, operators.geometry.of(0));
        let masses = Masses::<'_, M> { line, metric, masses: &mut nodes.masses };
        let arrays = Arrays { weighted: &mut nodes.weighted, coefficients: &mut nodes.coefficients };
        project::<L, M>(operators.curl_free.as_ref().unwrap(), 0, L::splat(1.0), masses, arrays, u);
    }
}

/// 4 x 2 cells, whose nodes are moved.
fn mesh(place: impl Fn([f64; 2]) -> [f64; 2]) -> Mesh {
    let mut mesh = rectangle([4.0, 2.0], [4, 2]).unwrap();
    mesh.nodes.iter_mut().for_each(|x| *x = place(*x));
    mesh
}

#[test]
fn on_all_cells_it_is_the_projection_of_a_single_one() {
    let sheared = mesh(|x| [x[0] + 0.3 * x[1], 0.7 * x[1]]);
    // Congruent, but not the same after half a turn.
    let trapezoids = mesh(|x| [x[0], x[1] + if x[1] == 1.0 { 0.1 * (1.0 - 2.0 * (x[0] % 2.0)) } else { 0.0 }]);
    let different = mesh(|x| [x[0] + 0.1 * (5.0 * x[1]).sin(), x[1] + 0.1 * (3.0 * x[0]).cos()]);
    for (mesh, by_halves) in [(sheared, true), (trapezoids, false), (different, false)] {
        for degree in 1..=6 {
            let needs = Needs { degree, sampling: None, curl_free: true, held: true };
            let operators = Operators::build(&mesh, &links(&mesh).unwrap(), &[0; 8], &needs).unwrap();
            let (curl_free, n) = (operators.curl_free.as_ref().unwrap(), operators.nodes());
            let halves = |class: &Class| matches!(class, Class::Halves(_));
            assert_eq!(curl_free.pool.shared.iter().any(halves), by_halves);
            let u: Vec<F8> = (0..4 * n).map(|k| F8(std::array::from_fn(|l| ((7 * k + 3 * l) as f64).sin()))).collect();
            for kernel in Kernel::NAMES.iter().map(|(_, kernel)| *kernel) {
                let mut out = u.clone();
                with_nodes!(operators.line.m, M => kernel.run(Project::<'_, M>(&operators, &mut out)));
                for lane in 0..8 {
                    let mut f: Vec<f64> = u.iter().map(|u| u.0[lane]).collect();
                    curl_free.project(&operators.line, &operators.geometry, [0, lane], &mut f);
                    for (f, out) in f.iter().zip(&out) {
                        // Sums of up to 98 numbers of order one.
                        assert!((f - out.0[lane]).abs() < 1e-13, "S{degree} {kernel:?}: {f} {out:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn relaxation_is_one_minus_exp_to_rounding_on_its_whole_range() {
    for i in 0..100_000 {
        let x = 10f64.powf(-12.0 + 15.0 * i as f64 / 1e5);
        let relative = (relaxation(x) / -(-x).exp_m1() - 1.0).abs();
        // Roundings of r, of q and of the sum, which may be a third of its terms.
        assert!(relative < 2e-15, "x = {x}: {relative:e}");
    }
    assert_eq!(relaxation(0.0), 0.0);
}
