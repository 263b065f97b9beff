//! Tables of loads, pressure that follows, and foundations.

use super::{Body, Run, largest, slope};
use dgmpm::parts::scene::Scene;
use dgmpm::{Folder, Problem};
use std::f64::consts::PI;
use std::path::Path;

fn square() -> Body {
    Body::square(3).method("ader-dgmpm").degree(2).end(2e-4)
}

/// The problem of a scene that is written into a folder.
fn problem(body: &Body, folder: &Path) -> dgmpm::Result<Problem> {
    let path = body.write(folder, "loaded");
    Problem::new(&Scene::load(&path, &[])?)
}

#[test]
fn a_table_has_the_bits_of_the_expression_that_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let pairs = [
        (
            "traction",
            "value = [\"-1e8*min(t, 1e-4)/1e-4\", \"5e7\"]",
            "t [s],t1 (Pa),t2\n0,0,5e7\n1e-4,-1e8,5e7\n1,-1e8,5e7\n",
        ),
        ("velocity", "value = [\"-1e4*t\", \"0\"]", "t,v1,v2\n0,0,0\n1,-1e4,0\n"),
        ("pressure", "value = \"2e12*t\"", "# a ramp\ntime,p [Pa]\n0,0\n1,2e12\n"),
    ];
    for (kind, value, table) in pairs {
        std::fs::write(folder.path().join("load.csv"), table).unwrap();
        let run = |keys: &str| {
            let mut problem = problem(&square().side("right", kind, keys), folder.path()).unwrap();
            problem.run().unwrap();
            problem.state
        };
        let (a, b) = (run(value), run("file = \"load.csv\""));
        assert_eq!(a.step, b.step, "{kind}");
        let apart = |(a, b): (&dgmpm::F8, &dgmpm::F8)| (0..8).map(|k| (a.0[k] - b.0[k]).abs()).fold(0.0, f64::max);
        let size = b.u.iter().flat_map(|x| x.0).fold(0.0, |size: f64, x| size.max(x.abs()));
        let most = a.u.iter().zip(&b.u).map(apart).fold(0.0, f64::max);
        // The same ramp in another order of operations: roundings of momenta in some 100 steps.
        assert!(most < 1e-11 * size, "{kind}: {most:e} of {size:e}");
    }
}

#[test]
fn a_table_goes_with_the_run_and_is_checked_before_it() {
    let folder = tempfile::tempdir().unwrap();
    let loaded = square().side("right", "pressure", "file = \"load.csv\"");
    std::fs::write(folder.path().join("load.csv"), "t,p\n0,1e8\n2e-4,0\n").unwrap();
    let run = Folder::new(&folder.path().join("run"));
    let mut first = problem(&loaded, folder.path()).unwrap();
    first.run_in(&run).unwrap();
    // The folder of the run alone is run again, to the same bits.
    std::fs::remove_file(folder.path().join("load.csv")).unwrap();
    let scene = Scene::load(&run.scene(), &[]).unwrap();
    assert!(scene.to_toml().contains("boundary_1_file.csv"), "{}", scene.to_toml());
    let mut second = Problem::new(&scene).unwrap();
    second.run().unwrap();
    assert!(first.state.u == second.state.u);
    for (table, words) in [
        (None, "there is no file"),
        (Some("t,p\n0,1e8\n1e-4,0\n"), "the table ends at t = 0.0001 s, before the run does at 0.0002 s"),
        (Some("t,p\n0,1e8\n1e-4,zero\n"), "load.csv:3:6: `zero` is not a number"),
    ] {
        if let Some(table) = table {
            std::fs::write(folder.path().join("load.csv"), table).unwrap();
        }
        let message = problem(&loaded, folder.path()).err().unwrap().to_string();
        assert!(message.contains(words), "{message}");
    }
    for (keys, words) in [("value = 1\nfile = \"load.csv\"", "has both `value` and `file`"), ("", "or give `file`")] {
        let message = problem(&square().side("right", "pressure", keys), folder.path()).err().unwrap().to_string();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn pressure_on_all_sides_of_a_body_that_spins_has_no_force_and_no_moment() {
    // 200 turns a second, under 100 MPa that come in 1e-4 s.
    let body = Body::square(3)
        .sides("pressure")
        .side("left", "pressure", "value = \"1e8*min(1, t/1e-4)\"")
        .side("right", "pressure", "value = \"1e8*min(1, t/1e-4)\"")
        .side("bottom", "pressure", "value = \"1e8*min(1, t/1e-4)\"")
        .side("top", "pressure", "value = \"1e8*min(1, t/1e-4)\"")
        .velocity(["-1256.6*(y - 0.5)", "1256.6*(x - 0.5)"])
        .method("ader-dgmpm")
        .degree(2)
        .end(5e-4);
    let run = Run::of(body);
    // Momenta against that of the parts of the body, 7800 kg/m^3 at some 600 m/s: the body turns by 36 degrees. A traction that does not
    // turn would give (1e8 Pa) (1 m) (5e-4 s) (sin 36 degrees) of it.
    let all = [run.momentum(0), run.momentum(1)].concat();
    assert!(all.iter().all(|p| p.abs() < 1e-6 * 7800.0 * 600.0), "{:e}", largest(&all));
    let spin = run.ledger.column("angular_momentum");
    // The force of a pressure on a closed line has no moment; what is kept of the spin is the accuracy of the scheme.
    assert!((spin.last().unwrap() / spin[0] - 1.0).abs() < 2e-3, "{:?}", [spin[0], *spin.last().unwrap()]);
}

#[test]
fn a_small_pressure_is_a_traction_against_the_normal() {
    let run = |kind: &str, keys: &str| {
        let mut problem = square().side("right", kind, keys).problem(&[]);
        problem.run().unwrap();
        problem.scheme.totals(&problem.state).momentum[0]
    };
    let (pressure, traction) = (run("pressure", "value = 1e5"), run("traction", "value = [-1e5, 0]"));
    // The area differs by the strain across, 1e5 Pa over 2e11 Pa.
    assert!((pressure / traction - 1.0).abs() < 2e-6, "{pressure} {traction}");
}

/// A block that is stiff against its foundation moves as a mass on springs: omega^2 = k/(rho0 h).
#[test]
fn a_stiff_block_on_a_foundation_swings_with_the_period_of_a_mass_on_a_spring() {
    // 2 pi sqrt(7800 (.1) / 1e9) = 5.549e-3 s; shear and pressure waves need some 5e-5 s through it.
    let stiffness: [f64; 2] = [1e9, 4e8];
    for axis in [1, 0] {
        let velocity = if axis == 1 { ["0", "0.1"] } else { ["0.1", "0"] };
        let period = 2.0 * PI * (7800.0 * 0.1 / stiffness[1 - axis]).sqrt();
        // The energy of the linear law has no rounding of the size of its moduli.
        let body = Body::rectangle([0.2, 0.1], [2, 1])
            .material("linear-elastic", [2e11, 0.3, 7800.0], "")
            .velocity(velocity)
            .side("bottom", "foundation", &format!("stiffness = {stiffness:?}"))
            .side("left", "symmetry", "")
            .side("right", "symmetry", "")
            .method("ader-dgfem")
            .degree(2)
            .end(1.1 * period);
        // Walls would hold it along x.
        let sides = [("left", "right"), ("right", "left")];
        let periodic = |body: Body, (side, other)| body.side(side, "periodic", &format!("partner = \"{other}\""));
        let body = if axis == 0 { sides.into_iter().fold(body, periodic) } else { body };
        let run = Run::of(body);
        let (p, t) = (run.momentum(axis), run.times());
        // Through 0 upwards, at 3/4 of the period.
        let k = (0..p.len() - 1).find(|&k| p[k] < 0.0 && p[k + 1] >= 0.0).unwrap();
        let share = -p[k] / (p[k + 1] - p[k]);
        let found = (t[k] + share * (t[k + 1] - t[k])) / 0.75;
        assert!((found / period - 1.0).abs() < 5e-3, "axis {axis}: {found:e} {period:e}");
        // What is in the springs is negative work of the boundary: all of it after a quarter, nothing is made.
        let (work, kinetic) = (run.ledger.column("boundary_work"), run.ledger.column("kinetic_energy"));
        let lowest = work.iter().copied().fold(0.0, f64::min);
        assert!((lowest / kinetic[0] + 1.0).abs() < 0.01, "{lowest:e} {:e}", kinetic[0]);
        let energy = run.accounted();
        // The work is t*.v* of averages over a step, (omega dt)^2/12 = 1e-7 from the average of the product, up and down. Found: 1.7e-7.
        assert!(largest(&energy) <= energy[0] * (1.0 + 1e-6), "{:e}", largest(&energy) / energy[0] - 1.0);
    }
}

#[test]
fn a_foundation_far_stiffer_than_the_body_holds_it_at_the_step_of_the_body() {
    // k dt/(rho0 c_p) is some 1e3: explicit springs would blow up at 1.
    let body =
        square().velocity(["0", "-10"]).side("bottom", "foundation", "stiffness = [1e16, 1e16]\ndamping = [1e5, 1e5]");
    let run = Run::of(body.end(1e-3));
    let energy = run.accounted();
    assert!(largest(&energy) <= energy[0] * (1.0 + 1e-10), "{:e}", largest(&energy) / energy[0] - 1.0);
    let clamped = Run::of(square().velocity(["0", "-10"]).side("bottom", "clamped", "").end(1e-3));
    let [a, b] = [&run, &clamped].map(|run| *run.momentum(1).last().unwrap());
    // 1 % of the momentum at the start.
    assert!((a - b).abs() < 0.01 * 7.8e4, "{a} {b}");
}

#[test]
fn dampers_alone_slow_a_body_down_as_their_c_over_its_mass() {
    let body = Body::rectangle([0.2, 0.1], [2, 1])
        .velocity(["0", "1"])
        .side("bottom", "foundation", "stiffness = [0, 0]\ndamping = [1e5, 0]")
        .side("left", "symmetry", "")
        .side("right", "symmetry", "")
        .method("ader-dgfem")
        .degree(2)
        .end(5e-3);
    let run = Run::of(body);
    let (t, p) = (run.times(), run.momentum(1));
    let logs: Vec<f64> = p.iter().map(|p| p.ln()).collect();
    let rate = -slope(&t, &logs);
    // c/(rho0 h) = 128.2 1/s; the block is 1.4e3 times as stiff in a wave, z/c = 458, so .3 %.
    assert!((rate / (1e5 / 780.0) - 1.0).abs() < 5e-3, "{rate}");
}
