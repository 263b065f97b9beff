use super::cohesive::VIRGIN;
use super::*;
use crate::riemann::tangent;
use proptest::prelude::*;

fn side(v: [f64; 2], t: [f64; 2], z: [f64; 2]) -> Side {
    Side { v, t, z }
}

/// Both sides, a normal and the time of a step.
fn meeting() -> impl Strategy<Value = Meeting> {
    let pair = || [-1.0..1.0f64, -1.0..1.0];
    let one = move || (pair(), pair(), [0.1..10.0f64, 0.1..10.0]).prop_map(|(v, t, z)| side(v, t, z));
    ([one(), one()], 0.0..std::f64::consts::TAU, -0.1..0.1f64, 0.01..1.0f64).prop_map(|(sides, angle, gap, dt)| {
        let overlap = Overlap { depth: (-gap).max(0.0), stiffness: 3.0 };
        Meeting { sides, normal: [angle.cos(), angle.sin()], gap, overlap, length: 1.0, step: dt, dt }
    })
}

/// v_1* and v_2* under the traction t on the first side.
fn stars(at: &Meeting, t: [f64; 2]) -> [[f64; 2]; 2] {
    let axes = [at.normal, tangent(at.normal)];
    [0, 1].map(|k| {
        let (one, sign) = (&at.sides[k], [1.0, -1.0][k]);
        let push = [0, 1].map(|a| (sign * dot(t, axes[a]) - dot(one.t, axes[a])) / one.z[a]);
        [0, 1].map(|i| one.v[i] + push[0] * axes[0][i] + push[1] * axes[1][i])
    })
}

proptest! {
    #[test]
    fn sides_that_stick_have_one_velocity(at in meeting()) {
        let [(n, _), (s, _)] = at.stick();
        let t = [0, 1].map(|i| n * at.normal[i] + s * tangent(at.normal)[i]);
        let [one, two] = stars(&at, t);
        // Rounding of some operations on numbers below 100.
        (0..2).for_each(|i| assert!((one[i] - two[i]).abs() < 1e-12));
    }

    #[test]
    fn contact_pushes_and_never_makes_energy(at in meeting(), friction in 0.0..2.0f64) {
        let t = Sliding { friction }.traction(&at, &mut []);
        // Rounding of some operations on tractions below 100.
        prop_assert!(dot(t, at.normal) <= 1e-13);
        let pressure = Sliding { friction }.push(&at) - dot(t, at.normal);
        prop_assert!(dot(t, tangent(at.normal)).abs() <= friction * pressure + 1e-13);
        let [one, two] = stars(&at, t);
        // The power of both sides, to rounding of products below 1000.
        prop_assert!(dot(t, one) - dot(t, two) <= 1e-12);
    }

    #[test]
    fn a_gap_closes_at_the_end_of_the_step_and_not_before(at in meeting()) {
        let t = Sliding { friction: 0.0 }.traction(&at, &mut []);
        let [one, two] = stars(&at, t);
        let end = at.gap + at.step * (dot(two, at.normal) - dot(one, at.normal));
        prop_assert!(end >= at.gap.min(0.0) - 1e-12);
        prop_assert!(dot(t, at.normal) == 0.0 || at.gap <= 0.0 || end.abs() < 1e-12);
    }

    #[test]
    fn what_acts_turns_with_the_observer(at in meeting(), angle in 0.0..std::f64::consts::TAU) {
        let (c, s) = (angle.cos(), angle.sin());
        let turn = |x: [f64; 2]| [c * x[0] - s * x[1], s * x[0] + c * x[1]];
        let sides = at.sides.map(|one| side(turn(one.v), turn(one.t), one.z));
        let turned = Meeting { sides, normal: turn(at.normal), ..at };
        let law = Sliding { friction: 0.4 };
        let (a, b) = (turn(law.traction(&at, &mut [])), law.traction(&turned, &mut []));
        (0..2).for_each(|i| assert!((a[i] - b[i]).abs() < 1e-12));
    }
}

/// s = 2 Pa, G = 3 J/m^2, K = 40 Pa/m: damage from .05 m, broken at 3 m.
const EDGE: Cohesive = Cohesive { strength: 2.0, energy: 3.0, stiffness: 40.0 };

/// Sides so heavy that they part at their own speeds.
fn heavy(rate: f64, dt: f64) -> Meeting {
    let z = [1e9; 2];
    let sides = [side([0.0; 2], [0.0; 2], z), side([rate, 0.0], [0.0; 2], z)];
    Meeting { sides, normal: [1.0, 0.0], gap: 0.0, overlap: Overlap::default(), length: 1.0, step: dt, dt }
}

#[test]
fn a_cohesive_edge_takes_its_energy_to_break_and_its_strength_is_its_largest_traction() {
    // Whatever the step: .5 m is ten times the opening at the strength.
    for dt in [1e-3, 0.5] {
        let (mut memory, mut work, mut largest) = (VIRGIN, 0.0, 0.0_f64);
        for _ in 0..(4.0 / dt) as usize {
            let t = EDGE.traction(&heavy(1.0, dt), &mut memory)[0];
            work += t * dt;
            largest = largest.max(t);
        }
        // Sides of finite weight, 4e-9 m/s a second.
        assert!((work - EDGE.energy).abs() < 1e-7 * EDGE.energy, "{work}");
        assert!(largest < EDGE.strength && (dt > 0.1 || largest > 0.98 * EDGE.strength), "{largest}");
        assert_eq!(EDGE.traction(&heavy(1.0, dt), &mut memory), [0.0; 2]);
    }
}

#[test]
fn an_edge_that_is_let_go_before_damage_gives_all_back_and_a_damaged_one_returns_to_its_origin() {
    let dt = 1e-4;
    for (largest, kept) in [(0.04, 0.0), (1.0, 1.0)] {
        let (mut memory, mut work) = (VIRGIN, 0.0);
        let steps = (largest / dt) as usize;
        for rate in [1.0, -1.0] {
            (0..steps).for_each(|_| work += EDGE.traction(&heavy(rate, dt), &mut memory)[0] * rate * dt);
        }
        // The sides give way by t dt/z a step: 4e-9 m/s for 2 s.
        assert!(memory[0].abs() < 1e-7);
        // Of the triangle under the curve up to an opening l what is left is G (l - l_0)/(l_f - l_0): 3 .95/2.95 at 1 m.
        assert!((work - kept * 3.0 * 0.95 / 2.95).abs() < 1e-6, "{work}");
    }
}

#[test]
fn a_stiff_edge_is_the_body_without_it_and_a_broken_one_is_pressed_as_if_whole() {
    let at = Meeting {
        sides: [side([1.0, 0.3], [-2.0, 0.5], [2.0, 1.0]), side([-0.5, 0.1], [1.5, 0.2], [3.0, 1.5])],
        ..heavy(0.0, 0.1)
    };
    let [(n, _), (s, _)] = at.stick();
    let stiff = Cohesive { strength: 1e9, energy: 1e9, stiffness: 1e12 };
    let t = stiff.traction(&at, &mut VIRGIN.clone());
    // Off by 2/(K dt y), some 1e-11.
    assert!((t[0] - n).abs() < 1e-9 && (t[1] - s).abs() < 1e-9, "{t:?}");
    let broken = EDGE.traction(&at, &mut [0.0, 0.0, 10.0]);
    assert!(broken[0] < 0.0 && broken[1] == 0.0, "{broken:?}");
}

#[test]
fn broken_sides_that_have_slid_away_do_not_meet_and_an_edge_stores_the_same_from_both_sides() {
    let at = Meeting {
        sides: [side([1.0, 0.0], [-2.0, 0.0], [2.0, 1.0]), side([0.0; 2], [2.0, 0.0], [3.0, 1.5])],
        ..heavy(0.0, 0.1)
    };
    for (slid, acts) in [(0.9, true), (1.1, false)] {
        let t = EDGE.traction(&at, &mut [0.0, slid, 10.0]);
        assert_eq!(t[0] < 0.0, acts, "{slid}: {t:?}");
    }
    // Seen from the other side normal and tangent have the other sign, and the opening too.
    let [one, two] = &at.sides;
    let back = |one: &Side| side(one.v, one.t, one.z);
    let other = Meeting { sides: [back(two), back(one)], normal: [-1.0, 0.0], ..at };
    let (mut here, mut there) = ([0.01, 0.02, 0.06], [0.01, 0.02, 0.06]);
    let (t, back) = (EDGE.traction(&at, &mut here), EDGE.traction(&other, &mut there));
    (0..2).for_each(|i| assert!((t[i] + back[i]).abs() < 1e-12, "{t:?} {back:?}"));
    (0..3).for_each(|i| assert!((here[i] - there[i]).abs() < 1e-14, "{here:?} {there:?}"));
    assert!((EDGE.stored(&at.overlap, 1.0, &here) - EDGE.stored(&at.overlap, 1.0, &there)).abs() < 1e-12);
}

proptest! {
    #[test]
    fn the_push_of_an_overlap_is_the_slope_of_what_it_stores_and_half_of_it_for_sides_that_part(
        depth in 0.0..0.5f64,
        stiffness in 0.1..10.0f64,
    ) {
        let (law, by) = (Sliding { friction: 0.0 }, 1e-6);
        let at = |depth: f64| Overlap { depth, stiffness };
        let stored = |depth: f64| law.stored(&at(depth), 1.0, &[]);
        let slope = (stored(depth + by) - stored(depth)) / by;
        let push = |rate: f64| law.push(&Meeting { overlap: at(depth + 0.5 * by), ..heavy(rate, 0.1) });
        // A parabola: the slope is that in the middle.
        prop_assert!((slope - push(-1.0)).abs() < 1e-6 && (0.5 * slope - push(1.0)).abs() < 1e-6);
    }
}
