//! Sources that act in the body.

use super::scenes::{NOISE, STEEL};
use super::{Body, Run};

#[test]
fn damping_slows_a_body_that_flies_by_exp_of_minus_alpha_t() {
    for (method, degree, bound) in [("rk-dgfem", 2, 1e-8), ("ader-dgmpm", 2, 1e-8), ("ader-dgfem", 1, 1e-5)] {
        let body = Body::square(2).velocity(["3", "-4"]).method(method).degree(degree).end(2e-3);
        let run = Run::of(body.table("[source]", "kind = \"damping\"\nrate = 500"));
        let (t, p) = (run.times(), run.momentum(0));
        let expected = p[0] * (-500.0 * t.last().unwrap()).exp();
        // (alpha dt)^(N+1) of steps of 1e-5 s, some (5e-3)^3/24 a step over 200 steps.
        let error = (p.last().unwrap() / expected - 1.0).abs();
        assert!(error < bound, "{method} {degree}: {error:e}");
        // What is lost is the work of the source.
        let energy = run.accounted();
        assert!((energy.last().unwrap() / energy[0] - 1.0).abs() < 1e-6, "{:?}", energy.last());
    }
}

#[test]
fn damping_faster_than_the_waves_of_a_cell_shortens_the_step_and_the_body_comes_to_rest() {
    // c/h = 6000 m/s over .5 m, a limit of .15 h/c: 1.2e-5 s, of which the rate of 1e6 1/s is 12 times. Noise, so that the fastest modes of
    // the grid have a part.
    for (method, degree) in [("rk-dgfem", 1), ("ader-dgmpm", 1), ("ader-dgmpm", 3)] {
        let body = Body::square(2).material("linear-elastic", STEEL, "").velocity(NOISE);
        let body = body.method(method).degree(degree).end(5e-5);
        let run = Run::of(body.table("[source]", "kind = \"damping\"\nrate = 1e6"));
        let energy = run.ledger.column("total_energy");
        // It falls but for the rounding of sums. What is left is the strain of displacements v/alpha = 5e-9 m between nodes: 1e-4 of the energy at
        // degree 1, 1.4e-3 at degree 3, whose nodes are closer.
        assert!(energy.windows(2).all(|pair| pair[1] <= pair[0] + 1e-13 * energy[0]), "{method} {degree}: {energy:?}");
        assert!(energy[energy.len() - 1] < 3e-3 * energy[0], "{method} {degree}: {energy:?}");
    }
}

#[test]
fn a_sponge_takes_a_wave_that_a_clamped_end_would_send_back() {
    // A wavelet runs to the right at 1 m/s in uniaxial strain, from x = 1 m to the end at 4 m and back. (A pulse with a mean has long waves
    // too, which a layer does not take.)
    let run = |more: bool| {
        let wavelet = "1e-3*sin(4*pi*(x - 1))*exp(-((x - 1)/0.3)^2)";
        let body = Body::rectangle([4.0, 0.1], [40, 1])
            .material("linear-elastic", [1.0, 0.0, 1.0], "")
            .initial(&format!("velocity = [\"{wavelet}\", \"0\"]\ndeformation = [\"1 - {wavelet}\", 0, 0, 1]"))
            .side("left", "absorbing", "")
            .side("right", "clamped", "")
            .side("bottom", "symmetry", "")
            .side("top", "symmetry", "")
            .method("ader-dgfem")
            .degree(2)
            .end(5.5);
        let layer = "kind = \"sponge\"\nrate = 6\nregion = \"((x - 2)/2)^2*step(x - 2)\"";
        let energy = Run::of(if more { body.table("[source]", layer) } else { body }).ledger.column("total_energy");
        energy.last().unwrap() / energy[0]
    };
    let (with, without) = (run(true), run(false));
    // The amplitude falls by exp(-int alpha/2 dx/c) there and back, int alpha dx = 4 m/s, and the mesh takes a part as it does without:
    // e^-8 = 3.4e-4 of the energy in all. A factor of 2 is for waves that are not short against the layer.
    assert!(without > 0.7 && with / without < 2.0 * (-8.0_f64).exp(), "{with:e} {without:e}");
}

#[test]
fn a_pressure_pulse_pushes_in_all_directions_alike_and_works() {
    let pulse = "kind = \"pressure-pulse\"\namplitude = 1e8\ncentre = [0.5, 0.5]\nradius = 0.3\nduration = 1e-4\ndensity = 7800";
    let body = Body::square(8).method("ader-dgfem").degree(2).end(1.5e-4).table("[source]", pulse);
    let run = Run::of(body);
    let (kinetic, work) = (run.ledger.column("kinetic_energy"), run.ledger.column("source_work"));
    assert!(*kinetic.last().unwrap() > 0.0 && *work.last().unwrap() > 0.0);
    // Pairs of forces cancel to rounding: impulse of a half of the disc is 1e8 Pa (.6 m) (5e-5 s) (1/2), some 1.5e3.
    for axis in [0, 1] {
        assert!(run.momentum(axis).iter().all(|p| p.abs() < 1e-9 * 1.5e3), "axis {axis}");
    }
    let energy = run.ledger.column("total_energy");
    // After its end the source does nothing.
    let end = run.times().iter().position(|t| *t > 1e-4).unwrap();
    assert!(work[end + 1..].iter().all(|w| *w == work[end + 1]) && energy.last() <= work.last());
}
