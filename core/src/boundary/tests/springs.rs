//! Pressure and foundation.

use super::*;
use crate::riemann::tangent;
use crate::tensor::{cofactor, dot, times};
use proptest::prelude::*;

fn star_of(flux: [f64; 6]) -> ([f64; 2], [f64; 2]) {
    (times([flux[0], flux[1], flux[2], flux[3]], N).map(|v| -v), [-flux[4], -flux[5]])
}

#[test]
fn pressure_acts_along_the_current_normal_on_the_current_area() {
    // A rotation by 90 degrees and a stretch of 2 along the edge: the force is twice as large and turned.
    let stretch = [0, 1, 2, 3].map(|k| {
        let (n, t) = (N, tangent(N));
        let (i, j) = (k / 2, k % 2);
        let turned = |a: [f64; 2]| [-a[1], a[0]];
        turned(n)[i] * n[j] + 2.0 * turned(t)[i] * t[j]
    });
    let state = trace(stretch, [0.1, 0.2]);
    let (_, t) = star_of(Pressure { value: constant(0.5) }.flux(&state, &AT, &NOW, &mut []));
    // 2 (.5) along -N turned by 90 degrees; roundings of numbers of size 1.
    assert!((t[0] - N[1]).abs() < 1e-15 && (t[1] + N[0]).abs() < 1e-15, "{t:?}");
    assert!((dot(t, times(cofactor(stretch), N)) + 2.0).abs() < 1e-14);
}

#[test]
fn springs_act_along_normal_and_tangent_each_with_its_stiffness() {
    let foundation = Foundation { stiffness: [2.0, 3.0], damping: [0.0; 2] };
    let rest = trace([1.0, 0.0, 0.0, 1.0], [0.0; 2]);
    let mut memory = [0.1, -0.2];
    let (_, t) = star_of(foundation.flux(&rest, &AT, &NOW, &mut memory));
    // A step of no length: -k u along each; roundings of numbers of size 1.
    assert!((dot(t, N) + 0.2).abs() < 1e-15 && (dot(t, tangent(N)) - 0.6).abs() < 1e-15, "{t:?}");
    assert_eq!(memory, [0.1, -0.2]);
}

proptest! {
    /// The work of the foundation is what its springs give and its dampers take, in each step and however stiff it is; the face itself loses.
    #[test]
    fn the_work_of_a_foundation_is_the_energy_of_its_springs_and_the_loss_of_its_dampers(
        v in [-0.5..0.5, -0.5..0.5],
        u in [-0.1..0.1, -0.1..0.1],
        stretch in 0.9..1.1,
        stiffness in [0.0..1e3, 0.0..1e3],
        damping in [0.0..5.0, 0.0..5.0],
        dt in 1e-3..1.0,
    ) {
        let foundation = Foundation { stiffness, damping };
        let inside = trace([stretch, 0.0, 0.02, 1.0], v);
        let mut memory = u;
        let (star_v, star_t) = star_of(foundation.flux(&inside, &AT, &Moment { dt, ..NOW }, &mut memory));
        let stored = |u: [f64; 2]| 0.5 * (stiffness[0] * u[0] * u[0] + stiffness[1] * u[1] * u[1]);
        let (n, t) = (dot(star_v, N), dot(star_v, tangent(N)));
        let taken = dt * (damping[0] * n * n + damping[1] * t * t);
        let work = dt * dot(star_t, star_v);
        // Roundings of the energies in the springs.
        let size = 1.0 + stored(u) + stored(memory) + taken;
        prop_assert!((work + stored(memory) - stored(u) + taken).abs() < 1e-13 * size, "{work:e}");
        let loss: f64 = (0..2).map(|i| (star_v[i] - inside.v[i]) * (star_t[i] - inside.t[i])).sum();
        prop_assert!(loss >= -1e-13 * size, "{loss:e}");
    }
}
