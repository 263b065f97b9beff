//! What the balance holds: its entries close; in the limit of small steps jumps explain what is lost; it changes no bit of the
//! run.
use super::*;
use crate::boundary::{
    Absorbing, Boundary, Data, Foundation, Free, Obstacle, Pressure, Shape, Traction, Unilateral, Velocity, Wall,
};
use crate::material::LinearElastic;
use crate::mesh::Mesh;
use crate::riemann::{Acoustic, AcousticCurl, Rusanov};
use crate::source::{BodyForce, Varies};
use crate::state::State;
use crate::step::Flux;
use crate::step::Law;
use crate::step::tests::{KINDS, Kind, chessboard, distorted, midpoints, noise, scheme, state, steel, wall, wavy};
use crate::step::{Method, Motion, Tableau};
use std::sync::Arc;

/// A condition of the boundary, made anew for each group.
type Condition = fn() -> Arc<dyn Boundary>;

fn data(f: fn([f64; 2], f64) -> f64) -> Data {
    Arc::new(f)
}

/// Every condition, with its name; each does work or dissipates in its own way.
const CONDITIONS: [(&str, Condition); 11] = [
    ("wall", wall),
    ("moving wall", || Arc::new(Wall { speed: Some(data(|x, t| 0.1 * x[1] + t)) })),
    ("free", || Arc::new(Free)),
    ("traction", || Arc::new(Traction { value: [data(|x, t| 0.1 + x[0] * t), data(|_, _| -0.2)] })),
    ("velocity", || Arc::new(Velocity { value: [data(|x, _| 0.1 * x[1]), data(|_, t| 0.3 - t)] })),
    ("absorbing", || Arc::new(Absorbing)),
    ("wall that lets go", || Arc::new(Unilateral { gap: [0.0], speed: Some(data(|_, _| 0.02)), friction: 0.0 })),
    ("wall with friction", || Arc::new(Unilateral { gap: [0.0], speed: None, friction: 0.2 })),
    ("disc in the way", || {
        let shape = Shape::Disc { centre: [0.5, -8.9], radius: 9.0 };
        Arc::new(Obstacle { shape, velocity: Some([data(|_, _| 0.1), data(|_, t| t)]), friction: 0.1 })
    }),
    ("pressure", || Arc::new(Pressure { value: data(|x, t| 0.1 + x[0] * t) })),
    ("foundation", || Arc::new(Foundation { stiffness: [0.5, 0.2], damping: [0.1, 0.3] })),
];

/// [`wavy`] with jumps between cells and curl within them.
fn rough(x: [f64; 2], a: usize) -> [f64; 6] {
    let u = wavy(x, a);
    std::array::from_fn(|k| u[k] + 0.02 * noise(6 * a + k))
}

/// Steps `state` at `courant` = dt c / h and meters it; all that the balance sums, and the energy at the end.
fn metered(scheme: &Scheme, state: &mut State, steps: usize, courant: f64) -> (Balance, f64) {
    let mut balance = Balance::starting_at(scheme.totals(state).energy());
    let mut motion = Motion::unsurveyed(scheme, std::mem::take(state)).with_balance(scheme);
    motion.survey(scheme).unwrap();
    let h = scheme.operators.geometry.h().flat_map(|h| h.0).fold(f64::INFINITY, f64::min);
    for _ in 0..steps {
        motion.advance(scheme, courant * h / motion.survey.fastest).unwrap();
        motion.work.settle(scheme, &mut balance);
    }
    *state = motion.state;
    (balance, scheme.totals(state).energy())
}

/// RK4 whatever the degree.
fn rk4(mesh: &Mesh, degree: usize, boundary: Condition) -> Scheme {
    let base = scheme(mesh, Kind::RkDgfem, degree, &midpoints(mesh, degree), boundary);
    Scheme { method: Method::RungeKutta(Tableau::of_degree(3)), ..base }
}

/// What the jumps take must be what the steps lose, but for rounding, mostly that of W: the neo-Hookean energy is a difference
/// of numbers of size 3/2 mu = .58, with an error of some 1e-16 at each node, which is some 3e-14 of E = 4e-3 here. RK4's own
/// error is below: (lambda dt)^5 with lambda dt of some 1e-3. Measured: up to 1.5e-14 of E; what is lost is 6e-5 of E and more.
fn assert_explained(what: &str, balance: &Balance, energy: f64) {
    let lost = balance.flux_dissipation + balance.boundary_dissipation;
    let (unexplained, explained) = ((lost - balance.jumps) / energy, balance.dissipation() / energy);
    assert!(unexplained.abs() < 1e-13, "{what}: {unexplained:e} of {explained:e}, {balance:?}");
    assert!(explained > 1e-5, "{what}: nothing to explain, {explained:e}");
    // The entries close to the rounding of sums in another order.
    assert!((balance.remainder(energy) / energy).abs() < 1e-13, "{what}: {balance:?}");
}

#[test]
fn small_steps_lose_what_jumps_take_for_any_flux_and_condition() {
    let mesh = distorted(3);
    for (name, boundary) in CONDITIONS {
        for flux in [Flux::new(Rusanov), Flux::new(Acoustic), Flux::new(AcousticCurl)] {
            for law in [steel(), Law::new(LinearElastic::new(1.0, 0.3, 1.3))] {
                let what = format!("{name}, {flux:?}, {law:?}");
                let scheme = Scheme { flux: flux.clone(), ..rk4(&mesh, 2, boundary) }.with_laws(vec![law]);
                let mut state = state(&mesh, &scheme, rough);
                let (balance, energy) = metered(&scheme, &mut state, 5, 1e-4);
                assert_explained(&what, &balance, energy);
            }
        }
    }
}

#[test]
fn small_steps_lose_what_jumps_take_for_any_degree_two_materials_and_a_source() {
    let mesh = distorted(4);
    for degree in 0..=4 {
        let scheme = rk4(&mesh, degree, wall);
        let mut state = state(&mesh, &scheme, rough);
        let (balance, energy) = metered(&scheme, &mut state, 5, 1e-4);
        assert_explained(&format!("S{degree}"), &balance, energy);
        assert_eq!(balance.work(), 0.0, "a wall at rest does no work");
    }
    let (base, densities) = chessboard(&mesh, Kind::RkDgfem);
    let force = BodyForce {
        value: [data(|x, _| 1.0 - x[1]), data(|_, t| -3.0 + t)],
        varies: Varies::PLACE_AND_TIME,
        material: Some(1),
    };
    let scheme = Scheme { sources: vec![Arc::new(force)], ..base };
    let mut state = state(&mesh, &scheme, |x, a| {
        let u = rough(x, a);
        [u[0], u[1], u[2], u[3], u[4] * densities[a / 9], u[5] * densities[a / 9]]
    });
    // The work of the source is a trapezoid rule in time: what is unexplained falls by 8 with half of the step (6.5e-12 at 1e-4).
    let (balance, energy) = metered(&scheme, &mut state, 10, 1e-5);
    assert_explained("two materials", &balance, energy);
    assert!(balance.source_work.abs() > 1e-6 * energy, "{balance:?}");
}

#[test]
fn the_work_of_a_wall_that_moves_is_its_force_times_its_speed() {
    let mesh = distorted(3);
    let moving: Condition = || Arc::new(Wall { speed: Some(data(|_, _| 0.5)) });
    let scheme = rk4(&mesh, 1, moving);
    let mut state = state(&mesh, &scheme, |_, _| [1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let step = 1e-4;
    let (balance, _) = metered(&scheme, &mut state, 1, step);
    // A body at rest, pulled outwards on all sides: t*.v* = z_p v_w^2 over a boundary of length 4, for a step.
    let c = steel().speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0];
    let h = scheme.operators.geometry.h().flat_map(|h| h.0).fold(f64::INFINITY, f64::min);
    let expected = 4.0 * 1.3 * c * 0.25 * (step * h / c);
    // First order in the step, over which the trace of the body follows the wall.
    assert!((balance.boundary_work / expected - 1.0).abs() < 10.0 * step, "{} {expected}", balance.boundary_work);
}

#[test]
fn a_smooth_state_without_jumps_loses_nothing_at_faces() {
    let mesh = distorted(4);
    let scheme = rk4(&mesh, 2, wall);
    let mut state = state(&mesh, &scheme, |_, _| [0.9, 0.0, 0.0, 0.95, 0.0, 0.0]);
    let (balance, energy) = metered(&scheme, &mut state, 20, 0.1);
    // Rounding: squares of jumps of 1e-15, no curl, and energies that are the same but for the last digits, as above.
    assert!(balance.jumps.abs() < 1e-24 * energy, "{balance:?}");
    assert!((balance.flux_dissipation + balance.boundary_dissipation).abs() < 1e-13 * energy, "{balance:?}");
    assert!(balance.curl_dissipation.abs() < 1e-14 * energy, "{balance:?}");
}

#[test]
fn the_balance_changes_no_bit_of_the_state_and_has_the_same_bits_on_any_number_of_threads() {
    // 200 blocks: large enough for three tiles, of all methods.
    let mesh = distorted(40);
    for kind in KINDS {
        let force =
            || BodyForce { value: [data(|x, _| x[1]), data(|_, t| t)], varies: Varies::PLACE_AND_TIME, material: None };
        let base = scheme(&mesh, kind, 2, &midpoints(&mesh, 2), CONDITIONS[3].1);
        let scheme = Scheme { sources: vec![Arc::new(force())], ..base };
        let mut plain = state(&mesh, &scheme, rough);
        let start = plain.clone();
        crate::step::tests::march(&scheme, &mut plain, 30, 0.05);
        let mut first = None;
        for threads in [1, 2, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut state = start.clone();
            assert_eq!(pool.install(|| Work::new(&scheme, &state).tiles.count()), threads, "{kind:?}");
            let (balance, energy) = pool.install(|| metered(&scheme, &mut state, 30, 0.05));
            assert!(state == plain, "{kind:?}, {threads} threads");
            assert_eq!(*first.get_or_insert((balance, energy)), (balance, energy), "{kind:?}, {threads} threads");
        }
    }
}

#[test]
fn without_the_balance_there_is_no_memory_for_it() {
    let mesh = distorted(3);
    let scheme = scheme(&mesh, Kind::AderDgmpm, 2, &midpoints(&mesh, 2), wall);
    let state = state(&mesh, &scheme, wavy);
    // On one thread there is one tile.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (off, on) = pool.install(|| (Work::new(&scheme, &state), Work::new(&scheme, &state).with_balance(&scheme)));
    assert!(!off.has_balance() && on.has_balance());
    // 2 blocks: per point of 4 x 3 two numbers of the trace, and 4 sums.
    assert_eq!(on.bytes() - off.bytes(), 2 * (4 * 3 * 2 + 4) * size_of::<F8>());
    let mut untouched = Balance::default();
    off.settle(&scheme, &mut untouched);
    assert_eq!(untouched, Balance::default());
}
