//! What the step holds for all methods: free stream, conservation, equality of methods, decay of noise.
use super::*;
use crate::boundary::{Boundary, FacePoint, Moment, Velocity, Wall};
use crate::cloud::{Cloud, seed};
use crate::lane::Kernel;
use crate::material::NeoHookean;
use crate::mesh::{Mesh, links, map, rectangle};
use crate::operators::{Needs, Operators, Sampling};
use crate::riemann::{Acoustic, Dual, Trace, star};
use crate::tensor;
use std::sync::Arc;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    RkDgfem,
    AderDgfem,
    AderDgmpm,
}

pub(super) const KINDS: [Kind; 3] = [Kind::RkDgfem, Kind::AderDgfem, Kind::AderDgmpm];

/// What lies outside moves and is strained as the inside was at the start.
struct Given {
    f: [f64; 4],
    v: [f64; 2],
}

impl Boundary for Given {
    fn flux(&self, _: &Trace<f64>, at: &FacePoint, _: &Moment, _: &mut [f64]) -> [f64; 6] {
        star(self.v, tensor::times(steel().stress(self.f), at.normal), at.normal)
    }
}

pub(super) fn steel() -> Law {
    Law::new(NeoHookean::new(1.0, 0.3, 1.3))
}

pub(super) fn distorted(cells: usize) -> Mesh {
    let mut mesh = rectangle([1.0, 1.0], [cells, cells]).unwrap();
    for (i, x) in mesh.nodes.iter_mut().enumerate() {
        if x.iter().all(|x| *x > 0.0 && *x < 1.0) {
            let (angle, size) = (i as f64 * 2.4, 0.2 / cells as f64);
            *x = [x[0] + size * angle.cos(), x[1] + size * angle.sin()];
        }
    }
    mesh
}

pub(super) fn scheme(
    mesh: &Mesh,
    kind: Kind,
    degree: usize,
    cloud: &Cloud,
    boundary: fn() -> Arc<dyn Boundary>,
) -> Scheme {
    let sampling = match kind {
        Kind::RkDgfem => None,
        Kind::AderDgfem => Some(Sampling::Nodes),
        Kind::AderDgmpm => Some(Sampling::Cloud(cloud)),
    };
    let needs = Needs { degree, sampling, curl_free: degree > 0, held: true };
    let operators = Operators::build(mesh, &links(mesh).unwrap(), &vec![0; mesh.cells.len()], &needs).unwrap();
    let method = match kind {
        Kind::RkDgfem => Method::RungeKutta(Tableau::of_degree(degree)),
        _ => Method::ader(degree, degree),
    };
    let alpha = if degree >= 4 { 6.0 } else { 3.0 };
    let boundaries = mesh.edge_groups.iter().map(|_| boundary()).collect();
    let scheme = Scheme::new(operators, vec![steel()], method, Flux::new(Dual), boundaries).unwrap();
    match degree {
        0 => scheme,
        _ => scheme.with_curl(Control { relax: Relax::Rotation, rate: alpha * degree as f64 }).unwrap(),
    }
}

pub(super) fn wall() -> Arc<dyn Boundary> {
    Arc::new(Wall { speed: None })
}

/// The state whose unknowns at a node are `u(X, number)`, number counting nodes over all cells.
pub(super) fn state(mesh: &Mesh, scheme: &Scheme, u: impl Fn([f64; 2], usize) -> [f64; 6]) -> State {
    let n = scheme.operators.nodes();
    let mut cells = vec![0.0; mesh.cells.len() * 6 * n];
    for (cell, values) in cells.chunks_mut(6 * n).enumerate() {
        for a in 0..n {
            let x = map::position(&mesh.map(cell), scheme.operators.line.basis.node_2d(a));
            u(x, cell * n + a).into_iter().enumerate().for_each(|(k, u)| values[k * n + a] = u);
        }
    }
    let mut state = State::pack(&scheme.operators.blocks, n, 6, &cells);
    scheme.set_boundary_memory(&mut state, &[]);
    state
}

pub(super) fn unpacked(scheme: &Scheme, state: &State) -> Vec<f64> {
    state.unpack(&scheme.operators.blocks, scheme.operators.nodes())
}

/// Steps `state` in place at `courant` = dt c / h.
pub(super) fn march(scheme: &Scheme, state: &mut State, steps: usize, courant: f64) {
    let mut motion = Motion::new(scheme, std::mem::take(state)).unwrap();
    let h = scheme.operators.geometry.h().flat_map(|h| h.0).fold(f64::INFINITY, f64::min);
    for _ in 0..steps {
        motion.advance(scheme, courant * h / motion.survey.fastest).unwrap();
    }
    *state = motion.state;
}

pub(super) fn midpoints(mesh: &Mesh, degree: usize) -> Cloud {
    seed::seed(seed::Layout::Jitter { seed: 1, amount: 0.2 }, degree + 1, mesh.cells.len())
}

pub(super) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Smooth, compressed by 10 %, not a gradient to the last digit.
pub(super) fn wavy(x: [f64; 2], _: usize) -> [f64; 6] {
    let pi = std::f64::consts::PI;
    let (s, c) = ((pi * x[0]).sin() * (pi * x[1]).cos(), (pi * x[0]).cos() * (pi * x[1]).sin());
    [0.95 + 0.05 * c, 0.03 * s, -0.02 * s, 1.0 + 0.04 * s, 0.1 * s, -0.05 * c]
}

#[test]
fn free_stream_is_kept_on_distorted_cells_by_all_methods_and_degrees() {
    const F: [f64; 4] = [0.9, 0.1, -0.05, 1.1];
    const V: [f64; 2] = [0.3, -0.2];
    let mesh = distorted(5);
    for degree in 0..=6 {
        let cloud = midpoints(&mesh, degree);
        for kind in KINDS {
            let scheme = scheme(&mesh, kind, degree, &cloud, || Arc::new(Given { f: F, v: V }));
            let uniform = |_: [f64; 2], _: usize| [F[0], F[1], F[2], F[3], 1.3 * V[0], 1.3 * V[1]];
            let mut state = state(&mesh, &scheme, uniform);
            let before = unpacked(&scheme, &state);
            march(&scheme, &mut state, 20, 0.02);
            let change = largest_difference(&before, &unpacked(&scheme, &state));
            // Rounding of 20 steps; for a jittered cloud times its condition and Lebesgue constant (1e3 at degree 6).
            let bound = if kind == Kind::AderDgmpm { 1e-12 } else { 1e-13 };
            assert!(change < bound, "{kind:?} S{degree}: {change:e}");
        }
    }
}

#[test]
fn a_rotated_body_at_rest_stays_at_rest() {
    let mesh = distorted(4);
    let (sine, cosine) = 1.0_f64.sin_cos();
    for kind in KINDS {
        let scheme = scheme(&mesh, kind, 2, &midpoints(&mesh, 2), || Arc::new(crate::boundary::Free));
        let mut state = state(&mesh, &scheme, |_, _| [cosine, -sine, sine, cosine, 0.0, 0.0]);
        let before = unpacked(&scheme, &state);
        march(&scheme, &mut state, 50, 0.05);
        // Objective law, fluxes and free edges: rounding of 50 steps, for the jittered cloud times its condition.
        let change = largest_difference(&before, &unpacked(&scheme, &state));
        assert!(change < if kind == Kind::AderDgmpm { 1e-12 } else { 1e-13 }, "{kind:?}: {change:e}");
    }
}

#[test]
fn walls_on_all_sides_keep_mean_deformation_and_free_edges_keep_momentum() {
    let mesh = distorted(4);
    for kind in KINDS {
        let cloud = midpoints(&mesh, 2);
        let closed = scheme(&mesh, kind, 2, &cloud, || {
            let zero: crate::boundary::Data = Arc::new(|_, _| 0.0);
            Arc::new(Velocity { value: [zero.clone(), zero] })
        });
        let free = scheme(&mesh, kind, 2, &cloud, || Arc::new(crate::boundary::Free));
        let mut held = state(&mesh, &closed, wavy);
        let mut loose = held.clone();
        let (first, start) = (closed.totals(&held), free.totals(&loose));
        march(&closed, &mut held, 100, 0.05);
        march(&free, &mut loose, 100, 0.05);
        let (last, end) = (closed.totals(&held), free.totals(&loose));
        for k in 0..4 {
            // int F dX changes by int v N over the boundary alone, which is 0, and by what the control turns, in second order.
            let change = (last.deformation[k] - first.deformation[k]).abs();
            assert!(change < 1e-5, "{kind:?}: {change:e}");
        }
        for k in 0..2 {
            assert!((end.momentum[k] - start.momentum[k]).abs() < 1e-13, "{kind:?}");
        }
        assert!(last.energy() < first.energy(), "{kind:?}: dissipation only");
    }
}

#[test]
fn with_points_on_the_gauss_nodes_dgmpm_is_dgfem_after_1000_steps() {
    let mesh = distorted(4);
    for degree in 1..=3 {
        let gauss = seed::seed(seed::Layout::Gauss, degree + 1, mesh.cells.len());
        let results = [Kind::AderDgfem, Kind::AderDgmpm].map(|kind| {
            let scheme = scheme(&mesh, kind, degree, &gauss, wall);
            let mut state = state(&mesh, &scheme, wavy);
            march(&scheme, &mut state, 1000, 0.045);
            unpacked(&scheme, &state)
        });
        // The fit at the nodes is the identity to 1e-15, and 1000 stable steps add such errors at random.
        let difference = largest_difference(&results[0], &results[1]);
        assert!(difference < 1e-12, "S{degree}: {difference:e}");
    }
}

/// Two laws in a chessboard: every face is an interface.
pub(super) fn chessboard(mesh: &Mesh, kind: Kind) -> (Scheme, Vec<f64>) {
    let cloud = midpoints(mesh, 2);
    let base = scheme(mesh, kind, 2, &cloud, || Arc::new(crate::boundary::Free));
    let side = (mesh.cells.len() as f64).sqrt() as usize;
    let material: Vec<usize> = (0..mesh.cells.len()).map(|cell| (cell % side + cell / side) % 2).collect();
    let sampling = (kind == Kind::AderDgmpm).then_some(Sampling::Cloud(&cloud));
    let sampling = if kind == Kind::AderDgfem { Some(Sampling::Nodes) } else { sampling };
    let needs = Needs { degree: 2, sampling, curl_free: true, held: true };
    let operators = Operators::build(mesh, &links(mesh).unwrap(), &material, &needs).unwrap();
    let heavy = Law::new(NeoHookean::new(3.0, 0.2, 9.0));
    let densities = material.iter().map(|&m| if m == 0 { 1.3 } else { 9.0 }).collect();
    (Scheme { operators, ..base }.with_laws(vec![steel(), heavy]), densities)
}

#[test]
fn uniform_motion_of_two_materials_makes_no_stress() {
    let mesh = distorted(4);
    for kind in KINDS {
        let (scheme, densities) = chessboard(&mesh, kind);
        let moving = |_: [f64; 2], a: usize| [1.0, 0.0, 0.0, 1.0, 0.3 * densities[a / 9], -0.2 * densities[a / 9]];
        let mut state = state(&mesh, &scheme, moving);
        let before = unpacked(&scheme, &state);
        march(&scheme, &mut state, 50, 0.05);
        // Rounding of 50 steps on numbers of size 9.
        let change = largest_difference(&before, &unpacked(&scheme, &state));
        assert!(change < 1e-12, "{kind:?}: {change:e}");
    }
}

#[test]
fn interfaces_conserve_momentum_and_dissipate() {
    let mesh = distorted(4);
    for kind in KINDS {
        let (scheme, densities) = chessboard(&mesh, kind);
        let mut state = state(&mesh, &scheme, |x, a| {
            let u = wavy(x, a);
            [u[0], u[1], u[2], u[3], u[4] * densities[a / 9], u[5] * densities[a / 9]]
        });
        let first = scheme.totals(&state);
        march(&scheme, &mut state, 200, 0.05);
        let last = scheme.totals(&state);
        for k in 0..2 {
            // Both sides form v* and t* in their own order of operations: rounding of 200 steps.
            assert!((last.momentum[k] - first.momentum[k]).abs() < 1e-13, "{kind:?}");
        }
        assert!(last.energy() < first.energy(), "{kind:?}");
    }
}

#[test]
fn one_two_and_three_threads_give_the_same_bits() {
    // 200 blocks: large enough for three tiles, of all methods.
    let mesh = distorted(40);
    for kind in KINDS {
        let scheme = scheme(&mesh, kind, 2, &midpoints(&mesh, 2), wall);
        let results = [1, 2, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut state = state(&mesh, &scheme, wavy);
                // Else nothing is tested.
                assert_eq!(Work::new(&scheme, &state).tiles.count(), threads, "{kind:?}");
                march(&scheme, &mut state, 30, 0.05);
                state
            })
        });
        assert!(results[0] == results[1] && results[0] == results[2], "{kind:?}");
    }
}

#[test]
fn the_survey_that_a_step_makes_is_that_of_its_result() {
    let mesh = distorted(5);
    for degree in [1, 3] {
        for kind in KINDS {
            let scheme = scheme(&mesh, kind, degree, &midpoints(&mesh, degree), wall);
            let state = state(&mesh, &scheme, wavy);
            let mut work = Work::new(&scheme, &state);
            let (mut before, mut found, mut expected) = <(Survey, Survey, Survey)>::default();
            scheme.survey(&state, &work, &mut before).unwrap();
            scheme.step(&state, 1e-3, &before, &mut work);
            scheme.surveyed(&mut work, &mut found).unwrap();
            scheme.survey(&work.next, &work, &mut expected).unwrap();
            // The same work on the same numbers: the same bits.
            // (The step has seen the faces of the state before, too: its smallest J may be less.)
            assert!(found.min_j <= expected.min_j, "{kind:?} S{degree}");
            found.min_j = expected.min_j;
            assert_eq!(found, expected, "{kind:?} S{degree}");
            assert_ne!(found, before);
            // A step to a state that is lost says so.
            scheme.step(&state, 10.0, &before, &mut work);
            let lost = scheme.surveyed(&mut work, &mut found).unwrap_err();
            let again = scheme.survey(&work.next, &work, &mut expected).unwrap_err();
            // (Its faces, or those of the state before, may have been lost first.)
            assert!(lost == again || matches!(lost.site, Site::Face(..)), "{kind:?} S{degree}: {lost:?} {again:?}");
        }
    }
}

#[test]
fn all_kernels_of_this_processor_agree_after_100_steps() {
    let mesh = distorted(4);
    let kernels = || Kernel::NAMES.iter().map(|(_, kernel)| *kernel).filter(|kernel| kernel.is_available());
    for kind in KINDS {
        let results = kernels().map(|kernel| {
            let scheme = Scheme { kernel, ..scheme(&mesh, kind, 2, &midpoints(&mesh, 2), wall) };
            let mut state = state(&mesh, &scheme, wavy);
            march(&scheme, &mut state, 100, 0.05);
            unpacked(&scheme, &state)
        });
        let results: Vec<_> = results.collect();
        for other in &results[1..] {
            // Fused multiplications differ by a rounding each; 100 stable steps.
            assert!(largest_difference(&results[0], other) < 1e-12, "{kind:?}");
        }
    }
}

/// A number in -1/2..1/2 from another (the finaliser of splitmix64).
pub(super) fn noise(n: usize) -> f64 {
    let mut z = (n as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 - 0.5
}

#[test]
fn noise_on_compressed_states_decays_with_the_default_control_and_flux_for_all_methods() {
    for degree in 1..=3 {
        for kind in KINDS {
            noise_decays(kind, degree, None);
        }
    }
}

/// From a cell of noise, 600 steps at .9 of the limit on 6 x 6 cells, at two compressed states.
pub(super) fn noise_decays(kind: Kind, degree: usize, method: Option<Method>) {
    let mesh = rectangle([1.0, 1.0], [6, 6]).unwrap();
    for (f11, f22) in [(0.965, 1.0), (0.9, 0.9)] {
        let mut scheme = scheme(&mesh, kind, degree, &midpoints(&mesh, degree), wall);
        if let Some(method) = &method {
            scheme.method = method.clone();
        }
        let mean = [f11, 0.0, 0.0, f22, 0.0, 0.0];
        let noisy = |_: [f64; 2], a: usize| std::array::from_fn(|k| mean[k] + 1e-8 * noise(6 * a + k));
        let mut state = state(&mesh, &scheme, noisy);
        let n = scheme.operators.nodes();
        let size = |state: &State| {
            let values = unpacked(&scheme, state);
            values.iter().enumerate().map(|(i, u)| (u - mean[(i / n) % 6]).abs()).fold(0.0, f64::max)
        };
        march(&scheme, &mut state, 1, 0.9 * cfl::limit(&scheme.method, degree));
        let first = size(&state);
        march(&scheme, &mut state, 600, 0.9 * cfl::limit(&scheme.method, degree));
        // The design's criterion: not above the first step. (Without control it grows by e^10 and more.)
        assert!(size(&state) <= first, "{kind:?} S{degree} ({f11}, {f22}): {:e} {first:e}", size(&state));
    }
}

#[test]
fn without_control_the_acoustic_flux_lets_noise_grow_in_compression() {
    // The instability that the control cures is there: a test that cannot fail on it would test nothing.
    let mesh = rectangle([1.0, 1.0], [6, 6]).unwrap();
    let base = scheme(&mesh, Kind::AderDgfem, 2, &Cloud::default(), wall);
    let scheme = Scheme { flux: Flux::new(Acoustic), curl: None, ..base };
    let mut state = state(&mesh, &scheme, |_, a| {
        std::array::from_fn(|k| [0.9, 0.0, 0.0, 0.9, 0.0, 0.0][k] + 1e-9 * noise(6 * a + k))
    });
    let spread = |state: &State| scheme.totals(state).max_curl;
    let first = spread(&state);
    march(&scheme, &mut state, 150, 0.07);
    // Rate 3.2 c/h in the design: e^(3.2 * .07 * 150) = 4e14 if it stayed linear; a factor of 1e3 leaves no doubt.
    assert!(spread(&state) > 1e3 * first, "{} {first}", spread(&state));
}

#[test]
fn a_state_that_lost_stability_is_named_by_cell_and_kind() {
    let mesh = rectangle([1.0, 1.0], [3, 3]).unwrap();
    let scheme = scheme(&mesh, Kind::AderDgmpm, 1, &midpoints(&mesh, 1), wall);
    let sick = |bad: [f64; 6]| {
        let state = state(&mesh, &scheme, |_, a| if a / 4 == 5 { bad } else { [1.0, 0.0, 0.0, 1.0, 0.0, 0.0] });
        scheme.survey(&state, &Work::new(&scheme, &state), &mut Survey::default()).unwrap_err()
    };
    let inverted = sick([-0.5, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!((inverted.cell, matches!(inverted.kind, LossKind::Inverted(_))), (5, true));
    let nan = sick([1.0, 0.0, 0.0, 1.0, f64::NAN, 0.0]);
    assert_eq!((nan.cell, nan.kind), (5, LossKind::NotFinite));
}
