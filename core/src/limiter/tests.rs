//! What a limiter keeps, what it leaves alone, and what it cuts.
use super::neighbour::{Axes, around, behind};
use super::waves::Waves;
use super::*;
use crate::boundary::{Boundary, Free, Wall};
use crate::lane::{F8, Kernel};
use crate::material::NeoHookean;
use crate::mesh::{Mesh, links, map, rectangle};
use crate::operators::Needs;
use crate::riemann::Rusanov;
use crate::state::State;
use crate::step::{Flux, Law, Method, Motion, Tableau};
use proptest::prelude::*;
use std::sync::Arc;

fn steel() -> Law {
    Law::new(NeoHookean::new(1.0, 0.3, 1.3))
}

/// A mesh whose cells begin at any of their corners, with inner nodes moved by `amount` of a cell.
fn mesh(cells: usize, amount: f64) -> Mesh {
    let mut mesh = rectangle([1.0, 1.0], [cells, cells]).unwrap();
    for (i, x) in mesh.nodes.iter_mut().enumerate() {
        if x.iter().all(|x| *x > 0.0 && *x < 1.0) {
            let (angle, size) = (i as f64 * 2.4, amount / cells as f64);
            *x = [x[0] + size * angle.cos(), x[1] + size * angle.sin()];
        }
    }
    let tagged: Vec<_> = mesh.edges.iter().map(|edge| mesh.face_nodes(edge.cell, edge.face)).collect();
    for (i, cell) in mesh.cells.iter_mut().enumerate() {
        cell.rotate_left(i * 7 % 4);
    }
    // Turned cells have other local faces.
    let face = |cell: usize, nodes: &[usize; 2]| {
        (0..4).find(|face| mesh.face_nodes(cell, *face).iter().all(|node| nodes.contains(node))).unwrap()
    };
    let faces: Vec<usize> = mesh.edges.iter().zip(&tagged).map(|(edge, nodes)| face(edge.cell, nodes)).collect();
    mesh.edges.iter_mut().zip(faces).for_each(|(edge, face)| edge.face = face);
    mesh
}

fn scheme(mesh: &Mesh, degree: usize, corrections: Vec<Arc<dyn Correction>>) -> Scheme {
    let needs = Needs { degree, sampling: None, curl_free: false, held: true };
    let operators = Operators::build(mesh, &links(mesh).unwrap(), &vec![0; mesh.cells.len()], &needs).unwrap();
    let walls = mesh.edge_groups.iter().map(|_| Arc::new(Wall { speed: None }) as Arc<dyn Boundary>).collect();
    let method = Method::RungeKutta(Tableau::of_degree(degree));
    Scheme::new(operators, vec![steel()], method, Flux::new(Rusanov), walls).unwrap().with_corrections(corrections)
}

fn state(mesh: &Mesh, scheme: &Scheme, u: impl Fn([f64; 2]) -> [f64; UNKNOWNS]) -> State {
    let n = scheme.operators.nodes();
    let mut cells = vec![0.0; mesh.cells.len() * UNKNOWNS * n];
    for (cell, values) in cells.chunks_mut(UNKNOWNS * n).enumerate() {
        for a in 0..n {
            let x = map::position(&mesh.map(cell), scheme.operators.line.basis.node_2d(a));
            u(x).into_iter().enumerate().for_each(|(k, u)| values[k * n + a] = u);
        }
    }
    State::pack(&scheme.operators.blocks, n, UNKNOWNS, &cells)
}

/// A state after marked cells have been limited, and the marks.
fn limited<K: CellLimiter>(scheme: &Scheme, state: &State, limiter: &Limiter<K>) -> (State, Vec<u8>) {
    let n = scheme.operators.nodes();
    let mut notes = Notes {
        marked: vec![0; scheme.operators.blocks.len()],
        numbers: vec![F8::ZERO; limiter.numbers(scheme) * scheme.operators.blocks.len()],
    };
    let nothing = Notes::default();
    let made = Made { scheme, before: state, state, notes: &nothing, dt: 0.1, stage: None };
    limiter.look(&made, &mut notes);
    let (made, mut out) = (Made { notes: &notes, ..made }, state.clone());
    for (number, u) in out.u.chunks_exact_mut(UNKNOWNS * n).enumerate() {
        let mut block = Corrected { number, u, internal: &mut [], changed: u8::MAX };
        if limiter.applies(&made, number) {
            limiter.correct(&made, &mut block);
        }
    }
    (out, notes.marked)
}

const EVERYWHERE: Sensor = Sensor { threshold: 0.0 };

/// Integrals of all components over the body.
fn integrals(scheme: &Scheme, state: &State) -> [f64; UNKNOWNS] {
    let n = scheme.operators.nodes();
    let mut out = [0.0; UNKNOWNS];
    for (block, u) in state.u.chunks_exact(UNKNOWNS * n).enumerate() {
        for lane in 0..scheme.operators.blocks.count[block] {
            let weights = scheme.operators.node_weights(block, lane);
            for (k, values) in u.chunks_exact(n).enumerate() {
                out[k] += values.iter().zip(&weights).map(|(u, w)| u.0[lane] * w).sum::<f64>();
            }
        }
    }
    out
}

/// A shock between two states along a line that no axis follows.
fn shock(x: [f64; 2]) -> [f64; UNKNOWNS] {
    if x[0] + 0.3 * x[1] < 0.55 { [0.95, 0.02, -0.01, 1.0, 0.0, 0.0] } else { [1.0, 0.0, 0.0, 1.0, -0.06, 0.01] }
}

#[test]
fn the_mean_of_every_cell_is_kept_on_distorted_cells() {
    let mesh = mesh(6, 0.2);
    for degree in 1..=4 {
        let scheme = scheme(&mesh, degree, vec![]);
        let start = state(&mesh, &scheme, shock);
        let before = integrals(&scheme, &start);
        let moment = limited(&scheme, &start, &Limiter::new(degree, EVERYWHERE, MomentLimiter::default()));
        let vertex = limited(&scheme, &start, &Limiter::new(degree, EVERYWHERE, VertexLimiter));
        for (after, _) in [moment, vertex] {
            assert!(after != start);
            let after = integrals(&scheme, &after);
            // Rounding of sums of 36 cells.
            assert!(before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-14), "S{degree}: {before:?} {after:?}");
        }
    }
}

#[test]
fn a_linear_state_stays_to_the_last_bit_whatever_corner_a_cell_begins_at() {
    // On parallelograms modes of the parent cells are those of the body. All walls are mirrors, at which a slope is a kink: cells
    // there are left out.
    let mesh = mesh(6, 0.0);
    let linear = |x: [f64; 2]| {
        [1.0 + 0.1 * x[0], 0.2 * x[1], -0.1 * x[0], 1.0 + 0.05 * x[1], 0.3 * x[0] - 0.2 * x[1], 0.1 * x[1]]
    };
    let inner = |x: &[f64; 2]| x.iter().all(|x| *x > 1.0 / 6.0 && *x < 5.0 / 6.0);
    for degree in 1..=4 {
        let scheme = scheme(&mesh, degree, vec![]);
        let start = state(&mesh, &scheme, linear);
        let moment = limited(&scheme, &start, &Limiter::new(degree, EVERYWHERE, MomentLimiter::default()));
        let vertex = limited(&scheme, &start, &Limiter::new(degree, EVERYWHERE, VertexLimiter));
        for (after, _) in [moment, vertex] {
            let n = scheme.operators.nodes();
            for (cell, &(block, lane)) in scheme.operators.blocks.slot.iter().enumerate() {
                let middle = map::position(&mesh.map(cell), [0.5, 0.5]);
                if inner(&middle) {
                    let of = |state: &State| -> Vec<f64> {
                        state.u[UNKNOWNS * n * block..][..UNKNOWNS * n].iter().map(|u| u.0[lane]).collect()
                    };
                    // Modes above the first are rounding, and may be cut.
                    let difference = of(&start).iter().zip(of(&after)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(difference < 1e-13, "S{degree}, cell {cell}: {difference:e}");
                }
            }
        }
    }
}

#[test]
fn behind_a_shock_no_cell_leaves_the_range_of_the_states() {
    let mesh = mesh(8, 0.0);
    let straight =
        |x: [f64; 2]| if x[0] < 0.527 { [0.9, 0.0, 0.0, 1.0, 0.0, 0.0] } else { [1.0, 0.0, 0.0, 1.0, -0.1, 0.0] };
    for degree in 1..=4 {
        let scheme = scheme(&mesh, degree, vec![]);
        // The front lies in a cell, whose polynomial swings beyond both states.
        let start = state(&mesh, &scheme, straight);
        let range = |state: &State| {
            let n = scheme.operators.nodes();
            let mut out = [f64::INFINITY, f64::NEG_INFINITY];
            for block in 0..scheme.operators.blocks.len() {
                for lane in 0..scheme.operators.blocks.count[block] {
                    for face in 0..4 {
                        for point in 0..degree + 1 {
                            let (first, step) = if face < 2 { (point, degree + 1) } else { (point * (degree + 1), 1) };
                            let ends = &scheme.operators.line.ends[face % 2];
                            let at = |i: usize| state.u[UNKNOWNS * n * block + first + step * i].0[lane];
                            let f11: f64 = ends.iter().enumerate().map(|(i, l)| l * at(i)).sum();
                            out = [out[0].min(f11), out[1].max(f11)];
                        }
                    }
                }
            }
            out
        };
        let limiter = Limiter::new(degree, EVERYWHERE, MomentLimiter { beta: 1.0 });
        let (after, _) = limited(&scheme, &start, &limiter);
        let ([low, high], [from, to]) = (range(&start), range(&after));
        assert!(low < 0.9 - 1e-3 || high > 1.0 + 1e-3, "S{degree}: the start swings, {low} {high}");
        // beta = 1: the slope that the neighbours have, half a cell from the mean, stays between the means.
        assert!(from > 0.9 - 1e-12 && to < 1.0 + 1e-12, "S{degree}: {from} {to}");
    }
}

#[test]
fn the_sensor_marks_the_cells_at_a_shock_and_no_cell_of_a_smooth_state() {
    let mesh = mesh(12, 0.1);
    let wave = |x: [f64; 2]| {
        let (s, c) = ((3.0 * x[0]).sin() * (3.0 * x[1]).cos(), (3.0 * x[0]).cos() * (3.0 * x[1]).sin());
        // No velocity at the walls, which are mirrors.
        let still = (std::f64::consts::PI * x[0]).sin() * (std::f64::consts::PI * x[1]).sin();
        [0.97 + 0.03 * c, 0.02 * s, -0.01 * s, 1.0 + 0.03 * s, 0.03 * still, -0.02 * still]
    };
    for degree in 1..=4 {
        let limiter = Limiter::new(degree, Sensor::default(), MomentLimiter::default());
        let scheme = scheme(&mesh, degree, vec![]);
        let (smooth, marked) = (state(&mesh, &scheme, wave), state(&mesh, &scheme, shock));
        assert_eq!(limited(&scheme, &smooth, &limiter).0, smooth, "S{degree}");
        let (after, marks) = limited(&scheme, &marked, &limiter);
        let cells: u32 = marks.iter().map(|lanes| lanes.count_ones()).sum();
        // A front across 12 rows, in one or two cells of each row with a neighbour on each side; and mirrors, where v is not 0.
        assert!(after != marked && (12..=100).contains(&cells), "S{degree}: {cells}");
    }
}

#[test]
fn a_limiter_that_finds_nothing_leaves_the_bits_of_a_run_as_they_are() {
    let mesh = mesh(5, 0.2);
    let rest = |_: [f64; 2]| [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    let smooth = |x: [f64; 2]| {
        let mut u = rest(x);
        let s = (std::f64::consts::PI * x[0]).sin() * (std::f64::consts::PI * x[1]).sin();
        (u[4], u[5]) = (0.01 * s, -0.02 * s);
        u
    };
    for degree in 2..=3 {
        let limiter: Arc<dyn Correction> = Arc::new(Limiter::new(degree, Sensor::default(), MomentLimiter::default()));
        let runs = [vec![], vec![limiter]].map(|corrections| {
            let scheme = scheme(&mesh, degree, corrections).with_kernel(Kernel::widest());
            let mut motion = Motion::new(&scheme, state(&mesh, &scheme, smooth)).unwrap();
            (0..10).for_each(|_| motion.advance(&scheme, 2e-3).unwrap());
            (motion.state, motion.work.counts().marked)
        });
        assert!(runs[0].0 == runs[1].0 && runs[1].1 == 0, "S{degree}");
    }
}

#[test]
fn the_image_behind_a_wall_is_the_state_of_the_mirrored_body() {
    // Two cells beside each other, mirrored at x = 1/2: the right one is the image of the left one.
    let halves = |cells: usize| rectangle([if cells == 2 { 1.0 } else { 0.5 }, 1.0], [cells, 1]).unwrap();
    let u = |x: [f64; 2]| {
        let s = (4.0 * x[0] * x[0] + x[1]).sin();
        [1.0 + 0.1 * s, 0.03 * s * x[0], -0.02 * s, 1.0 - 0.05 * s * x[1], 0.1 * s, -0.07 * s * x[0]]
    };
    let both = |x: [f64; 2]| if x[0] < 0.5 { u(x) } else { cell::reflected(u([1.0 - x[0], x[1]]), [1.0, 0.0]) };
    let degree = 3;
    let limiter = || Limiter::new(degree, EVERYWHERE, MomentLimiter::default());
    let of_left = |cells: usize| {
        let mesh = halves(cells);
        let scheme = scheme(&mesh, degree, vec![]);
        let (after, _) = limited(&scheme, &state(&mesh, &scheme, both), &limiter());
        after.u.iter().map(|u| u.0[0]).collect::<Vec<_>>()
    };
    let difference = of_left(1).iter().zip(of_left(2)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // Rounding of modes of size 1.
    assert!(difference < 1e-14, "{difference:e}");
}

#[test]
fn all_cells_around_a_corner_are_found_with_their_axes() {
    let mesh = mesh(4, 0.1);
    let scheme = scheme(&mesh, 1, vec![]);
    let blocks = &scheme.operators.blocks;
    for (cell, &slot) in blocks.slot.iter().enumerate() {
        for ends in [[0, 0], [0, 1], [1, 0], [1, 1]] {
            let corner = mesh.cells[cell][[0, 3, 1, 2][2 * ends[0] + ends[1]]];
            let mut found = vec![cell];
            around(blocks, slot, ends, &mut |block, lane, axes| {
                let other = blocks.cells[block][lane];
                found.push(other);
                // The corner in the axes of the other cell.
                let mut there = [0; 2];
                for axis in 0..2 {
                    // Seen from the first cell the other lies on the far side of the corner along at least one axis.
                    there[axes.of(axis)] = axis;
                }
                assert_ne!(there[0], there[1]);
            });
            found.sort_unstable();
            found.dedup();
            let all: Vec<usize> = (0..mesh.cells.len()).filter(|other| mesh.cells[*other].contains(&corner)).collect();
            assert_eq!(found, all, "cell {cell}, corner {ends:?}");
        }
    }
}

#[test]
fn modes_of_a_neighbour_are_those_of_one_polynomial_in_the_axes_of_the_cell() {
    // u = a + b x + c y + d x y on squares: the bilinear function of the next cell, seen with the axes of this one and moved by
    // one cell, is the same function.
    let mesh = mesh(3, 0.0);
    let degree = 2;
    let scheme = scheme(&mesh, degree, vec![]);
    let u = |x: [f64; 2]| [1.0 + 0.1 * x[0] - 0.3 * x[1] + 0.2 * x[0] * x[1], 0.0, 0.0, 1.0, 0.0, 0.0];
    let start = state(&mesh, &scheme, u);
    let nothing = Notes::default();
    let made = Made { scheme: &scheme, before: &start, state: &start, notes: &nothing, dt: 0.1, stage: None };
    let legendre = Legendre::new(degree);
    for &(block, lane) in &scheme.operators.blocks.slot {
        let own = Cell { made: &made, legendre: &legendre, block, lane };
        let modes = own.modes();
        for face in 0..4 {
            let Some(there) = behind(&scheme.operators.blocks, block, lane, face) else { continue };
            let other = Cell { block: there.block, lane: there.lane, ..own };
            let seen = other.modes().seen(there.axes, [1.0; 2]);
            let (axis, sign) = (face / 2, if face % 2 == 0 { -1.0 } else { 1.0 });
            let [first, mixed] = [modes.number(axis, 1, 0), modes.number(axis, 1, 1)];
            // A slope c_1 makes a difference of 2 sqrt(3) c_1 between means.
            let step = 2.0 * 3f64.sqrt() * sign;
            let across = modes.number(axis, 0, 1);
            let close = |a: f64, b: f64| (a - b).abs() < 1e-14;
            assert!(close(seen.of[0][0], modes.of[0][0] + step * modes.of[first][0]));
            assert!(close(seen.of[across][0], modes.of[across][0] + step * modes.of[mixed][0]));
            assert!(close(seen.of[first][0], modes.of[first][0]) && close(seen.of[mixed][0], modes.of[mixed][0]));
        }
    }
}

#[test]
fn a_limiter_does_the_same_in_every_frame() {
    let mesh = mesh(6, 0.15);
    let (sin, cos) = 0.7f64.sin_cos();
    let turn = |u: [f64; UNKNOWNS]| {
        let of = |a: f64, b: f64| [cos * a - sin * b, sin * a + cos * b];
        let (one, two, p) = (of(u[0], u[2]), of(u[1], u[3]), of(u[4], u[5]));
        [one[0], two[0], one[1], two[1], p[0], p[1]]
    };
    for degree in 1..=3 {
        // What lies behind a wall does not turn with the body.
        let mut scheme = scheme(&mesh, degree, vec![]);
        scheme.boundaries.iter_mut().for_each(|boundary| *boundary = Arc::new(Free));
        let limiter = Limiter::new(degree, EVERYWHERE, MomentLimiter::default());
        let of = |u: &dyn Fn([f64; 2]) -> [f64; UNKNOWNS]| limited(&scheme, &state(&mesh, &scheme, u), &limiter).0;
        let (plain, turned) = (of(&shock), of(&|x| turn(shock(x))));
        let n = scheme.operators.nodes();
        let blocks = plain.u.chunks_exact(UNKNOWNS * n).zip(turned.u.chunks_exact(UNKNOWNS * n));
        for ((plain, turned), &count) in blocks.zip(&scheme.operators.blocks.count) {
            for node in 0..n {
                for lane in 0..count {
                    let at = |u: &[F8]| std::array::from_fn(|k| u[k * n + node].0[lane]);
                    let (expected, found): (_, [f64; UNKNOWNS]) = (turn(at(plain)), at(turned));
                    let gap = expected.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    // Rounding of modes of size 1, with impedances about 1.
                    assert!(gap < 1e-12, "S{degree}: {gap:e}");
                }
            }
        }
    }
}

proptest! {
    #[test]
    fn characteristic_variables_come_back(f in prop::array::uniform4(-0.2f64..0.2), u in prop::array::uniform6(-1.0f64..1.0), angle in 0.0f64..6.3) {
        let f = [1.0 + f[0], f[1], f[2], 1.0 + f[3]];
        let waves = Waves::new(&steel(), f, [angle.cos(), angle.sin()]);
        let back = waves.back(waves.of(u));
        // Rounding with impedances between .5 and 2.
        prop_assert!(u.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-13));
    }

    #[test]
    fn axes_seen_through_a_cell_and_back_are_the_own_ones(swapped: bool, first: [bool; 2]) {
        let axes = Axes { swapped, reversed: first };
        let back = Axes { swapped, reversed: [0, 1].map(|axis| first[axes.of(axis)]) };
        prop_assert_eq!(axes.then(back), Axes::default());
    }
}
