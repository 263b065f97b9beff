//! Walls that let go, obstacles and friction.

use super::*;
use crate::riemann::tangent;
use crate::tensor::{dot, times};
use proptest::prelude::*;

/// v* and t* of a flux.
fn star_of(flux: [f64; 6], n: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    (times([flux[0], flux[1], flux[2], flux[3]], n).map(|v| -v), [-flux[4], -flux[5]])
}

/// (v* - v).(t* - t) of a state without additions to the rows of F, which is what the boundary loses; and t*.v*, its work.
fn loss_and_work(inside: &Trace<f64>, flux: [f64; 6], n: [f64; 2]) -> (f64, f64) {
    let (v, t) = star_of(flux, n);
    let jumps = (0..2).map(|i| (v[i] - inside.v[i]) * (t[i] - inside.t[i])).sum();
    (jumps, dot(v, t))
}

fn step(dt: f64) -> Moment<'static> {
    Moment { dt, ..NOW }
}

fn wall(friction: f64) -> Unilateral {
    Unilateral { gap: [0.0], speed: None, friction }
}

fn at(normal: [f64; 2], share: f64) -> FacePoint {
    FacePoint { normal, medium: Medium { share, ..MEDIUM }, ..AT }
}

/// A half-plane whose edge goes through the face point, with the body on the side of -N.
fn plane(friction: f64) -> Obstacle {
    let shape = Shape::HalfPlane { point: AT.x, normal: N.map(|n| -n) };
    Obstacle { shape, velocity: None, friction }
}

#[test]
fn a_pressed_wall_without_friction_is_the_bilateral_wall_and_a_half_plane_has_its_traction() {
    let state = trace([0.95, 0.02, -0.03, 1.01], [0.3, 0.1]);
    let bilateral = Wall { speed: None }.flux(&state, &AT, &NOW, &mut []);
    assert_eq!(wall(0.0).flux(&state, &AT, &NOW, &mut [0.0]), bilateral);
    let (v, t) = star_of(plane(0.0).flux(&state, &AT, &NOW, &mut [0.0; 2]), N);
    // Roundings of numbers of size 1.
    assert!((0..2).all(|k| (t[k] + bilateral[4 + k]).abs() < 1e-15) && dot(v, N).abs() < 1e-15, "{v:?} {t:?}");
}

#[test]
fn a_wall_that_would_have_to_pull_and_a_wall_behind_a_gap_are_free() {
    let (leaving, coming) = (trace([1.0, 0.0, 0.0, 1.0], [-0.3, -0.1]), trace([1.0, 0.0, 0.0, 1.0], [0.3, 0.1]));
    for (state, gap) in [(leaving, 0.0), (coming, 0.1)] {
        let mut memory = [gap];
        let flux = wall(0.4).flux(&state, &AT, &step(0.01), &mut memory);
        assert_eq!(flux, Free.flux(&state, &AT, &NOW, &mut []));
        // gap <- gap - dt v*.N, of a state without traction: v* = v; one rounding of numbers of size .1.
        assert!((memory[0] - gap + 0.01 * dot(state.v, N)).abs() < 1e-16, "{memory:?}");
    }
}

#[test]
fn a_moving_wall_follows_the_gap_and_pushes_with_z_times_its_speed() {
    let rest = trace([1.0, 0.0, 0.0, 1.0], [0.0; 2]);
    let moving = Unilateral { gap: [0.05], speed: Some(constant(-0.2)), friction: 0.0 };
    let mut memory = moving.gap;
    moving.flux(&rest, &AT, &step(0.25), &mut memory);
    assert!(memory[0].abs() < 1e-16, "{memory:?}");
    memory = [0.0];
    let (v, t) = star_of(moving.flux(&rest, &AT, &step(0.25), &mut memory), N);
    let z = AT.impedance(&rest);
    // One rounding of numbers of size 1.
    assert!((dot(v, N) + 0.2).abs() < 1e-15 && (dot(t, N) + 0.2 * z).abs() < 1e-15 && memory == [0.0], "{v:?} {t:?}");
}

#[test]
fn friction_sticks_below_its_limit_and_slips_against_the_motion_above() {
    let tangential = tangent(N);
    // Pressed by z times a speed of .3, and pulled along by z times .1 or .2.
    for (along, sticks) in [(0.1, true), (-0.1, true), (0.2, false), (-0.2, false)] {
        let v = [0, 1].map(|i| 0.3 * N[i] + along * tangential[i]);
        let state = trace([1.0, 0.0, 0.0, 1.0], v);
        let z = AT.impedance(&state);
        let (v, t) = star_of(wall(0.5).flux(&state, &AT, &NOW, &mut [0.0]), N);
        let (slip, drag) = (dot(v, tangential), dot(t, tangential));
        let expected =
            if sticks { (0.0, -z * along) } else { (along - 0.15 * along.signum(), -0.15 * z * along.signum()) };
        // Roundings of numbers of size 1.
        assert!((slip - expected.0).abs() < 1e-15 && (drag - expected.1).abs() < 1e-15, "{along}: {slip} {drag}");
    }
}

#[test]
fn a_rotated_frame_rotates_the_contact() {
    let (c, s) = (0.28_f64, 0.96_f64);
    let turn = |a: [f64; 2]| [c * a[0] - s * a[1], s * a[0] + c * a[1]];
    let f = [0.95, 0.02, -0.03, 1.01];
    let turned_f = [c * f[0] - s * f[2], c * f[1] - s * f[3], s * f[0] + c * f[2], s * f[1] + c * f[3]];
    let square = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let x = [0.2, 0.7];
    let point = FacePoint { x, normal: [1.0, 0.0], medium: MEDIUM };
    // Position relative to the obstacle, as the memory has it.
    let moved = [0.05, -0.02];
    let law = NeoHookean::new(1.0, 0.3, 1.3);
    let state = |f: [f64; 4], v| Trace { f, v, t: times(law.stress(f), point.normal), c: law.speeds(f, point.normal) };
    let plain = Obstacle { shape: Shape::Polygon { corners: square.clone() }, velocity: None, friction: 0.3 };
    // A rotation of space alone: X stays, so the obstacle is turned about X and the memory has what X + u needs.
    let about = |p: [f64; 2]| turn([p[0] - x[0], p[1] - x[1]]);
    let corners = square.iter().map(|p| [0, 1].map(|i| x[i] + about(*p)[i])).collect();
    let rotated = Obstacle { shape: Shape::Polygon { corners }, ..plain.clone() };
    let v = [0.3, 0.1];
    let (mut one, mut two) = (moved, turn(moved));
    let (v1, t1) = star_of(plain.flux(&state(f, v), &point, &step(0.1), &mut one), point.normal);
    let (v2, t2) = star_of(rotated.flux(&state(turned_f, turn(v)), &point, &step(0.1), &mut two), point.normal);
    for k in 0..2 {
        // Roundings of a stress of size 1 in two frames.
        assert!((turn(v1)[k] - v2[k]).abs() < 1e-14 && (turn(t1)[k] - t2[k]).abs() < 1e-14, "{v1:?} {v2:?}");
        assert!((turn(one)[k] - two[k]).abs() < 1e-14, "{one:?} {two:?}");
    }
    assert!(t1 != [0.0; 2], "they touch");
}

#[test]
fn the_back_of_a_thin_body_does_not_see_an_obstacle_that_it_lies_in() {
    let state = trace([1.0, 0.0, 0.0, 1.0], [-0.3, 0.1]);
    let behind = FacePoint { normal: N.map(|n| -n), x: AT.x.map(|x| x + 0.01), ..AT };
    let flux = plane(0.0).flux(&state, &behind, &NOW, &mut [0.0; 2]);
    assert_eq!(flux, Free.flux(&state, &behind, &NOW, &mut [0.0; 2]));
}

#[test]
fn an_obstacle_that_moves_meets_the_body_where_it_has_come_to() {
    let away = Shape::Disc { centre: [AT.x[0] + 0.6, AT.x[1] + 0.8], radius: 0.9 };
    let w = [-0.6, -0.8];
    let disc = Obstacle { shape: away, velocity: Some(w.map(constant)), friction: 0.0 };
    let (rest, mut memory) = (trace([1.0, 0.0, 0.0, 1.0], [0.0; 2]), [0.0; 2]);
    // .1 of the way at speed 1: closed from the step on that begins there.
    let forces = (0..6).map(|_| star_of(disc.flux(&rest, &AT, &step(0.021), &mut memory), N).1);
    let pushes: Vec<bool> = forces.map(|t| dot(t, N) < 0.0).collect();
    assert_eq!(pushes, [false, false, false, false, false, true]);
}

#[test]
fn signed_distances_of_shapes_are_those_of_their_nearest_points() {
    let l = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let clockwise: Vec<_> = l.iter().rev().copied().collect();
    let half = 0.5_f64.sqrt();
    for corners in [l, clockwise] {
        let shape = Shape::Polygon { corners };
        for (x, distance, normal) in [
            ([0.5, -0.3], 0.3, [0.0, -1.0]),
            ([0.5, 0.1], -0.1, [0.0, -1.0]),
            ([1.5, 1.25], 0.25, [0.0, 1.0]),
            ([3.0, 2.0], 2.0_f64.sqrt(), [half, half]),
            // The re-entrant corner is the nearest point of what lies inside of it.
            ([0.9, 0.9], -0.02_f64.sqrt(), [half, half]),
            ([2.0, 0.4], 0.0, [1.0, 0.0]),
        ] {
            let (found, n) = shape.distance(x);
            // Roundings of coordinates of size 1.
            assert!((found - distance).abs() < 1e-15, "{x:?}: {found}");
            assert!((n[0] - normal[0]).abs() < 1e-14 && (n[1] - normal[1]).abs() < 1e-14, "{x:?}: {n:?}");
        }
    }
    assert_eq!(Shape::Disc { centre: [1.0, 0.0], radius: 0.5 }.distance([3.0, 0.0]), (1.5, [1.0, 0.0]));
    assert_eq!(Shape::Disc { centre: [1.0, 0.0], radius: 0.5 }.distance([1.0, 0.0]), (-0.5, [0.0, 1.0]));
    let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    assert_eq!(Shape::crossing(&bow), Some([0, 2]));
    assert_eq!(Shape::crossing(&bow[..3]), None);
    // Both shoulders of a T lie on one line and do not touch; the lips of a cut without width do.
    let t = [[-0.5, 0.2], [-0.5, 0.8], [-0.3, 0.8], [-0.3, 0.6], [-0.2, 0.6], [-0.2, 0.4], [-0.3, 0.4], [-0.3, 0.2]];
    assert_eq!(Shape::crossing(&t), None);
    let cut = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 0.5], [1.0, 1.0], [0.0, 1.0]];
    assert!(Shape::crossing(&cut).is_some());
}

proptest! {
    /// Whatever comes, the face loses energy and never makes any, and a rigid body at rest does no work on it but that of friction.
    #[test]
    fn contact_never_makes_energy(
        f in [-0.15..0.15, -0.15..0.15, -0.15..0.15, -0.15..0.15],
        v in [-0.5..0.5, -0.5..0.5],
        angle in 0.0..std::f64::consts::TAU,
        friction in prop_oneof![Just(0.0), 0.0..2.0],
        share in prop_oneof![Just(1.0), 0.5..1.0],
        gap in prop_oneof![Just(0.0), -0.01..0.01],
    ) {
        let n = [angle.cos(), angle.sin()];
        let law = NeoHookean::new(1.0, 0.3, 1.3);
        let f: [f64; 4] = std::array::from_fn(|k| f[k] + [1.0, 0.0, 0.0, 1.0][k]);
        let inside = Trace { f, v, t: times(law.stress(f), n), c: law.speeds(f, n) };
        let at = at(n, share);
        let tilted = [0.9 * n[0] - 0.4 * n[1], 0.4 * n[0] + 0.9 * n[1]];
        let shape = Shape::HalfPlane { point: [0, 1].map(|i| at.x[i] + gap * n[i]), normal: tensor::normalised(tilted.map(|n| -n)) };
        let conditions: [(&dyn Boundary, Vec<f64>); 2] = [
            // Without friction it has the flux of the bilateral wall.
            (&wall(f64::max(friction, 1e-3)), vec![gap]),
            (&Obstacle { shape, velocity: None, friction }, vec![0.0; 2]),
        ];
        for (condition, mut memory) in conditions {
            let (loss, work) = loss_and_work(&inside, condition.flux(&inside, &at, &step(0.1), &mut memory), n);
            // Roundings of tractions and velocities of size 1.
            prop_assert!(loss >= -1e-14 && work <= 1e-14, "loss {loss:e}, work {work:e}");
        }
    }
}

/// A tip that stands out from below, at height `y` over the face from (0, 0) to (1, 0) of a body above it.
fn spike(x: f64, y: f64, friction: f64) -> Obstacle {
    let shape = Shape::Polygon { corners: vec![[x - 0.1, -1.0], [x + 0.1, -1.0], [x, y]] };
    Obstacle { shape, velocity: None, friction }
}

proptest! {
    /// A tip between the points holds the face where it is, by a force that is shared out over the points; at rest it never makes energy.
    #[test]
    fn a_tip_between_the_points_of_a_face_holds_it_and_never_makes_energy(
        f in [-0.15..0.15, -0.15..0.15, -0.15..0.15, -0.15..0.15],
        v in prop::array::uniform3([-0.5..0.5, -0.5..0.2]),
        place in 0.02..0.98,
        depth in 0.0..0.03,
        friction in prop_oneof![Just(0.0), 0.0..2.0],
    ) {
        let (basis, n) = (crate::basis::Lagrange::new(2), [0.0, -1.0]);
        let law = NeoHookean::new(1.0, 0.3, 1.3);
        let f: [f64; 4] = std::array::from_fn(|k| f[k] + [1.0, 0.0, 0.0, 1.0][k]);
        let inside = v.map(|v| Trace { f, v, t: times(law.stress(f), n), c: law.speeds(f, n) });
        let points = [0, 1, 2].map(|i| FacePoint { x: [basis.nodes[i], 0.0], ..at(n, 1.0) });
        let face = WholeFace { ends: [[0.0; 2], [1.0, 0.0]], bulge: [0.0; 2], points: &points, inside: &inside, basis: &basis, beyond: [None; 2] };
        let (mut memory, mut flux) = ([0.0; 6], [[0.0; 6]; 3]);
        let obstacle = spike(place, depth, friction);
        // It comes at the face where v* of the free face goes down, unless a point holds it already.
        prop_assume!(obstacle.face_flux(&face, &step(0.1), &mut memory, &mut flux));
        let stars = flux.map(|flux| star_of(flux, n));
        let at_tip = basis.values(place).iter().zip(&stars).map(|(l, (v, _))| l * v[1]).sum::<f64>();
        let sum = |of: &dyn Fn(usize) -> f64| basis.weights.iter().enumerate().map(|(i, w)| w * of(i)).sum::<f64>();
        let force = sum(&|i| stars[i].1[1]);
        let work = sum(&|i| dot(stars[i].0, stars[i].1));
        let loss = sum(&|i| loss_and_work(&inside[i], flux[i], n).0);
        // Roundings of tractions and velocities of size 1, and of a spread of forces over the weights of 5/18.
        prop_assert!(force > 0.0 && at_tip >= -1e-12, "force {force:e}, velocity {at_tip:e}");
        prop_assert!(work <= 1e-12 && loss - work >= -1e-12, "loss {loss:e}, work {work:e}");
        for (i, (v, _)) in stars.iter().enumerate() {
            (0..2).for_each(|k| assert!((memory[2 * i + k] - 0.1 * v[k]).abs() < 1e-15));
        }
    }
}

#[test]
fn a_tip_acts_on_the_side_of_a_thin_body_that_it_comes_to_and_not_before_it_is_there() {
    let (basis, rest) = (crate::basis::Lagrange::new(2), [1.0, 0.0, 0.0, 1.0]);
    let law = NeoHookean::new(1.0, 0.3, 1.3);
    let acts = |n: [f64; 2], obstacle: &dyn Boundary| {
        let inside = [Trace { f: rest, v: [0.0, -0.3], t: [0.0; 2], c: law.speeds(rest, n) }; 3];
        let points = [0, 1, 2].map(|i| FacePoint { x: [basis.nodes[i], 0.0], ..at(n, 1.0) });
        let face = WholeFace {
            ends: [[0.0; 2], [1.0, 0.0]],
            bulge: [0.0; 2],
            points: &points,
            inside: &inside,
            basis: &basis,
            beyond: [None; 2],
        };
        obstacle.face_flux(&face, &step(0.1), &mut [0.0; 6], &mut [[0.0; 6]; 3])
    };
    let disc = |y: f64| Obstacle { shape: Shape::Disc { centre: [0.31, y], radius: 0.01 }, ..spike(0.3, 0.0, 0.0) };
    assert!(acts([0.0, -1.0], &spike(0.3, 0.01, 0.0)) && acts([0.0, -1.0], &disc(-0.005)));
    assert!(!acts([0.0, -1.0], &spike(0.3, -0.01, 0.0)) && !acts([0.0, -1.0], &disc(-0.015)));
    // Of a side that looks up, the same spike is behind.
    assert!(!acts([0.0, 1.0], &spike(0.3, 0.01, 0.0)));
}
