//! Blocks on inclines.

use super::{Body, Run, slope};

const G: f64 = 9.81;

/// A soft block of 20 kg/m lies on an incline of so many degrees, along x, with friction; gravity is there from the start.
fn block(condition: &str, keys: &str, degrees: f64, friction: f64, end: f64) -> Run {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let body = Body::rectangle([0.4, 0.05], [8, 1])
        .material("neo-hookean", [1e7, 0.3, 1000.0], "")
        .side("bottom", condition, &format!("{keys}friction = {friction}"))
        .method("ader-dgmpm")
        .degree(2)
        .end(end)
        .table("[source]", &format!("kind = \"gravity\"\nvalue = [{}, {}]", G * sin, -G * cos));
    Run::of(body)
}

/// Mass of a block, kg/m.
const MASS: f64 = 20.0;

#[test]
fn a_block_slides_down_an_incline_by_g_sin_a_minus_mu_g_cos_a() {
    let conditions = [("unilateral", ""), ("half-plane", "point = [0, 0]\nnormal = [0, 1]\n")];
    for (condition, keys) in conditions {
        for (degrees, friction) in [(30.0, 0.3), (20.0, 0.1)] {
            let run = block(condition, keys, degrees, friction, 0.1);
            // From 20 ms on: the block hops after its weight has come at once.
            let (t, p) = (run.times(), run.momentum(0));
            let from = t.iter().position(|t| *t > 0.02).unwrap();
            let found = slope(&t[from..], &p[from..]) / MASS;
            let angle = f64::to_radians(degrees);
            let exact = G * (angle.sin() - friction * angle.cos());
            assert!((found / exact - 1.0).abs() < 0.01, "{condition} {degrees} {friction}: {found} {exact}");
            // Friction takes energy, and nothing makes any: a share of the work of gravity is rounding.
            let energy = run.accounted();
            let work = run.ledger.column("source_work");
            let rise = energy.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
            assert!(rise < 1e-6 * work.last().unwrap(), "{rise:e} of {:e}", work.last().unwrap());
            if condition == "unilateral" {
                // A gap goes below 0 by a step of the hops at most, 2e-5 s at some .03 m/s; a hundred of them do not add up.
                let gaps = run.problem.scheme.boundary_memory_of(&run.problem.state);
                assert!(gaps.iter().all(|gap| *gap > -1e-6), "{gaps:?}");
            }
            assert!(run.ledger.column("boundary_work").windows(2).all(|pair| pair[1] <= pair[0]));
        }
    }
}

#[test]
fn a_block_sticks_on_an_incline_that_is_not_as_steep_as_its_friction() {
    let run = block("unilateral", "", 20.0, 0.7, 0.1);
    let p = run.momentum(0);
    // Without friction it would go at .34 m/s, on average .17 m/s; it vibrates in shear about v = 0, at 2 % of that.
    let mean = p[p.len() / 2..].iter().sum::<f64>() / (p.len() - p.len() / 2) as f64 / MASS;
    assert!(mean.abs() < 3e-3, "{mean}");
}
