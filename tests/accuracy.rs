//! Numbers of the scenes with a known answer, as a user gets them: digits, plateaus, orders, what a long run keeps.

mod runs;

use dgmpm::parts::io::gmsh;
use dgmpm::parts::io::snapshot::{self, Snapshot};
use dgmpm::parts::mesh::{Mesh, map, rectangle};
use dgmpm::parts::quadrature::gauss_legendre;
use dgmpm::parts::scene::Scene;
use runs::{Outcome, run};
use std::path::Path;

const METHODS: [&str; 3] = ["ader-dgmpm", "ader-dgfem", "rk-dgfem"];

/// A scene by a method of a degree, with more overrides.
fn run_by(scene: &str, method: &str, degree: usize, more: &[&str]) -> Outcome {
    let (method, degree) = (format!("scheme.method={method}"), format!("scheme.degree={degree}"));
    run(scene, &[&[method.as_str(), &degree], more].concat())
}

/// The slope of log error over log h by least squares, for meshes each finer by 2.
fn fitted_rate(errors: &[f64]) -> f64 {
    let middle = 0.5 * (errors.len() - 1) as f64;
    let terms = errors.iter().enumerate().map(|(k, error)| (k as f64 - middle, -error.log2()));
    let [above, below] = terms.fold([0.0; 2], |[a, b], (x, y)| [a + x * y, b + x * x]);
    above / below
}

#[test]
fn star_states_of_the_riemann_problem_are_exact_by_all_methods() {
    let hit: &[&str] = &["exact.left_stretch=1.0", "exact.left_velocity=400.0", "boundary.0.value=[\"400\",\"0\"]"];
    for (name, sets) in [("fan and shock", &[][..]), ("two shocks", hit)] {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/riemann.toml");
        let scene = Scene::load(&path, &sets).unwrap();
        let (exact, steel) = (scene.build_exact().unwrap(), &scene.laws()[0]);
        let star = ([1.49, 0.0], 2e-4);
        let (v, p) = (exact.velocity(star.0, star.1)[0], steel.stress(exact.deformation(star.0, star.1))[0]);
        for method in METHODS {
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let line = run_by("riemann.toml", method, 2, &sets).line("axis", 2e-4);
            let (x, found_v, found_p) = (line.column("x"), line.column("velocity_1"), line.column("piola_11"));
            // On each side of the interface, away from it and from the fronts at .33 m and 2.78 m.
            for [from, to] in [[0.7, 1.4], [1.6, 2.4]] {
                let stretch: Vec<usize> = (0..x.len()).filter(|&k| x[k] > from && x[k] < to).collect();
                let mean = |of: &[f64]| stretch.iter().map(|&k| of[k]).sum::<f64>() / stretch.len() as f64;
                let [wrong_v, wrong_p] = [mean(&found_v) / v - 1.0, mean(&found_p) / p - 1.0];
                println!("riemann, {name}, {method}, {from}: v {wrong_v:.1e}, P {wrong_p:.1e}");
                // Ten times less than the issue's .1 %; measured 3.4e-6 at most.
                assert!(wrong_v.abs() < 1e-4 && wrong_p.abs() < 1e-4, "{method}: {wrong_v:e} {wrong_p:e}");
            }
        }
    }
}

#[test]
fn the_smooth_box_has_eight_digits_of_the_reference_by_all_methods() {
    for method in METHODS {
        let outcome = run_by("smooth_box.toml", method, 5, &[]);
        let norm = |name: &str| outcome.summary["norms"][name].as_f64().unwrap();
        let at_point = outcome.line("middle", 1.5e-4).column("velocity_1")[0];
        for (name, found, expected) in [
            ("v1", norm("velocity_1"), 82.93803266471),
            ("P11", norm("piola_11"), 2166808838.231),
            ("sigma11", norm("cauchy_stress_11"), 2178339518.219),
            ("v1(.25, .25)", at_point, -87.00456456845),
        ] {
            let wrong = found / expected - 1.0;
            println!("box {method} S5 10: {name} {wrong:.1e}");
            // Eight digits. Measured: norms 2e-10 (by the N + 1 point rule of the summary), the point 2.6e-9.
            assert!(wrong.abs() < 5e-9, "{method} {name}: {wrong:e}");
        }
    }
}

#[test]
fn the_simple_wave_is_met_to_1e_8() {
    // A row of cells 3 m high: dt follows the length of the cells alone. LCF has nothing to do in uniaxial strain, and
    // .58 m ahead of the pulse are enough.
    let sets = [
        "mesh.rectangle.size=[2.8, 3.0]",
        "mesh.rectangle.cells=[280, 1]",
        "curl.control=off",
        "output.0.at=[2.5e-4]",
        "output.0.to=[2.8, 0.025]",
    ];
    let outcome = run_by("simple_wave.toml", "rk-dgfem", 6, &sets);
    let standard = outcome.summary["errors"]["standard"].as_f64().unwrap();
    println!("simple wave RK S6 280: {standard:.2e}, {:.1} CPU s", outcome.number("cpu_seconds"));
    // The figure; measured 5.1e-9. (Where the steep front ends in its cell counts: 8.3e-9 on 250 cells, 1.3e-8 on
    // 260.)
    assert!(standard < 1e-8, "{standard:e}");
}

/// L1 errors of v and P of the impact, per m of height, on 60 to 480 square cells.
fn impact_errors(method: &str, degree: usize, safety: &str) -> [Vec<f64>; 2] {
    let mut out = [vec![], vec![]];
    for cells in [60, 120, 240, 480] {
        let height = 3.0 / cells as f64;
        let (size, cells) =
            (format!("mesh.rectangle.size=[3.0, {height}]"), format!("mesh.rectangle.cells=[{cells}, 1]"));
        let sets = [
            size.as_str(),
            &cells,
            safety,
            "time.end=1e-4",
            "output.0.at=[1e-4]",
            "output.0.from=[0.0, 0.0]",
            "output.0.to=[3.0, 0.0]",
        ];
        let outcome = run_by("wall_impact.toml", method, degree, &sets);
        for (errors, field) in out.iter_mut().zip(["velocity", "piola"]) {
            errors.push(outcome.summary["errors"][field]["l1"].as_f64().unwrap() / height);
        }
    }
    out
}

#[test]
fn l1_errors_of_the_impact_fall_at_three_quarters_at_least_without_a_limiter() {
    for method in METHODS {
        for degree in 1..=3 {
            // ADER of degree 1 damps least at its limit: with the default .9 the rate is .71 (RK .79), with .5 .78. For
            // an advected jump, which so weak a shock (.8 % above c_p) nearly is, DG has (2N + 1) / (2N + 2): .75 for S1.
            let safety = if degree == 1 && method != "rk-dgfem" { 0.5 } else { 0.9 };
            let errors = impact_errors(method, degree, &format!("scheme.safety={safety}"));
            let [v, p] = errors.each_ref().map(|errors| fitted_rate(errors));
            println!("impact {method} S{degree}, safety {safety}: {:.3?}, rates v {v:.3}, P {p:.3}", errors[0]);
            // The figure.
            assert!(v >= 0.75 && p >= 0.75, "{method} S{degree}: {v} {p}");
        }
    }
}

#[test]
fn the_vortex_has_the_order_that_its_rims_allow() {
    for method in METHODS {
        for (degree, cells) in [(1, 24), (2, 16), (3, 12)] {
            let errors = [cells, 2 * cells].map(|cells| {
                let cells = format!("mesh.rectangle.cells=[{cells}, {cells}]");
                let times = ["time.end=5e-5", "output.0.at=[5e-5]", "output.1.at=[5e-5]"];
                let outcome = run_by("vortex.toml", method, degree, &[&[cells.as_str()], &times[..]].concat());
                outcome.summary["errors"]["standard"].as_f64().unwrap()
            });
            let rate = fitted_rate(&errors);
            println!("vortex {method} S{degree} {cells}: {:.3e} {:.3e} rate {rate:.2}", errors[0], errors[1]);
            // F has kinks at the rims: 3/2 in L2 for every degree; .25 as for all rates.
            assert!((rate - 1.5).abs() < 0.25, "{method} S{degree}: {rate}");
        }
    }
}

/// Angular momentum int x cross p dX per m of thickness about the middle (x = X + u), and max |F^T F - 1|, both by
/// grid quadrature.
fn spin_and_strain(mesh: &Mesh, snapshot: &Snapshot) -> [f64; 2] {
    let (points, weights) = gauss_legendre(snapshot.degree + 1);
    let (m, nodes) = (points.len(), points.len() * points.len());
    let (mut spin, mut strain) = (0.0, 0.0_f64);
    for cell in 0..mesh.cells.len() {
        let map = mesh.map(cell);
        for a in 0..nodes {
            let xi = [points[a / m], points[a % m]];
            let weight = weights[a / m] * weights[a % m] * map::determinant(&map::jacobian(&map, xi));
            let u = |k: usize| snapshot.u[(6 * cell + k) * nodes + a];
            let moved = |k: usize| snapshot.displacement[(2 * cell + k) * nodes + a];
            let x = map::position(&map, xi);
            let arm = [x[0] + moved(0) - 0.5, x[1] + moved(1) - 0.5];
            spin += weight * (arm[0] * u(5) - arm[1] * u(4));
            let (c11, c22) = (u(0).powi(2) + u(2).powi(2) - 1.0, u(1).powi(2) + u(3).powi(2) - 1.0);
            let c12 = u(0) * u(1) + u(2) * u(3);
            strain = [c11, c22, c12].iter().fold(strain, |most, c| most.max(c.abs()));
        }
    }
    [spin, strain]
}

/// The largest relative change of a distance on the deformed diagonal from its middle, and of its middle from (.5, .5).
fn diagonal(outcome: &Outcome, t: f64) -> f64 {
    let line = outcome.line("diagonal", t);
    let columns = ["x", "y", "displacement_1", "displacement_2"].map(|name| line.column(name));
    let at = |k: usize| [0, 1].map(|i| columns[i][k] + columns[i + 2][k]);
    let (count, middle) = (columns[0].len(), at(columns[0].len() / 2));
    let change = |k: usize| {
        let (x, start) = (at(k), (columns[0][k] - 0.5).hypot(columns[1][k] - 0.5));
        if k == count / 2 { 0.0 } else { (x[0] - middle[0]).hypot(x[1] - middle[1]) / start - 1.0 }
    };
    let drift = (middle[0] - 0.5).hypot(middle[1] - 0.5);
    (0..count).map(change).fold(drift, |most, change| most.max(change.abs()))
}

#[test]
fn a_spinning_square_keeps_energy_spin_and_shape_over_ten_turns() {
    // Size of the elastic strain: rho omega^2 L^2 / E.
    let size = 7800.0 * (200.0 * std::f64::consts::PI).powi(2) / 2e11;
    let mesh = rectangle([1.0, 1.0], [4, 4]).unwrap();
    // The bounds of change of spin and of loss of energy are about twice what was measured: spin 2.7e-4, 7.4e-7, 3.4e-5,
    // energy -8e-4 (-3.1e-4 with theta = .5), -1.0e-4, -8.0e-4. The scene's own mesh has less.
    // Energy never rises above its start: to rounding, but for one ledger row of RK, at 4.7e-7 (twice that is let by),
    // which the quadrature of the first waves from the sides makes; the rows fall below the start right after.
    for (method, degree, most_spin, most_loss, most_rise) in [
        ("ader-dgmpm", 2, 1.5e-3, 1.6e-3, 1e-13),
        ("ader-dgmpm", 3, 1.5e-6, 2e-4, 1e-13),
        ("rk-dgfem", 2, 7e-5, 1.6e-3, 1e-6),
    ] {
        let outcome = run_by("spinning_square.toml", method, degree, &["mesh.rectangle.cells=[4, 4]"]);
        let files = snapshot::list(&outcome.path().join("snapshots")).unwrap();
        let spins: Vec<[f64; 2]> =
            files.iter().map(|(_, file)| spin_and_strain(&mesh, &Snapshot::read(file).unwrap())).collect();
        let spin = spins.iter().map(|[spin, _]| (spin / spins[0][0] - 1.0).abs()).fold(0.0, f64::max);
        let strain = spins.iter().fold(0.0_f64, |most, [_, strain]| most.max(*strain));
        let shape = (0..=10).map(|turn| diagonal(&outcome, 0.01 * f64::from(turn))).fold(0.0, f64::max);
        let energy = outcome.ledger().column("total_energy");
        let loss = 1.0 - energy[energy.len() - 1] / energy[0];
        println!("spin {method} S{degree}: spin {spin:.1e} energy {loss:.1e} strain {strain:.1e} shape {shape:.1e}");
        assert!(files.len() == 6 && outcome.number("end_time") > 0.0999);
        assert!(spin < most_spin, "{method} S{degree}: {spin:e}");
        assert!(loss < most_loss, "{method} S{degree}: {loss:e}");
        assert!(energy.iter().all(|e| *e <= energy[0] * (1.0 + most_rise)), "{method} S{degree}");
        // F^T F - 1 is twice the strain; measured 5.5e-3 where the square is widest, .35 of the size.
        assert!(strain < size && strain > 0.05 * size, "{method} S{degree}: {strain:e}");
        assert!(shape < size, "{method} S{degree}: {shape:e}");
    }
}

/// Manufactured solution by the default flux on a mesh of n x n cells, whose nodes `place` moves, from n to 2n cells: the order.
fn order_on(place: &dyn Fn(usize, [usize; 2]) -> [f64; 2], method: &str, degree: usize, cells: usize) -> f64 {
    let errors = [cells, 2 * cells].map(|n| {
        let folder = tempfile::tempdir().unwrap();
        let mut mesh = rectangle([1.0; 2], [n; 2]).unwrap();
        mesh.nodes.iter_mut().enumerate().for_each(|(k, x)| *x = place(n, [k % (n + 1), k / (n + 1)]));
        let path = folder.path().join("mesh.msh");
        gmsh::write(&mesh, &path).unwrap();
        let sets = [format!("mesh={{file={path:?}}}"), "output=[]".to_owned()];
        let outcome = run_by("manufactured.toml", method, degree, &sets.each_ref().map(String::as_str));
        outcome.summary["errors"]["standard"].as_f64().unwrap()
    });
    (errors[0] / errors[1]).log2()
}

/// The order of the default flux on a family of meshes, by degree and number of cells: as on squares, within .25 of N + 1.
fn keeps_its_order(what: &str, place: &dyn Fn(usize, [usize; 2]) -> [f64; 2], runs: &[(&str, usize, usize)]) {
    for &(method, degree, cells) in runs {
        let order = order_on(place, method, degree, cells);
        println!("{what}, {method} S{degree}: {order:.2}");
        assert!((order - (degree + 1) as f64).abs() < 0.25, "{what}, {method} S{degree}: {order}");
    }
}

/// Rows and columns in turn of length 1 and 1.4: no mesh is the smooth image of squares. With traces of the displacement that do not know of the
/// other cell the orders are 1.1, 2.6 and 3.1.
#[test]
fn the_default_flux_keeps_its_order_between_cells_of_unequal_length() {
    let place =
        |n: usize, at: [usize; 2]| at.map(|k| (k / 2 * 2) as f64 * 1.2 + (k % 2) as f64).map(|x| x / (1.2 * n as f64));
    let both = |degree, cells| [("rk-dgfem", degree, cells), ("ader-dgmpm", degree, cells)];
    keeps_its_order("unequal cells", &place, &[both(1, 16), both(2, 8), both(3, 8)].concat());
}

/// Trapezoids, whose lines have a kink at every second face: 1.0, 1.9 and 2.95 with traces that do not know of the other cell.
#[test]
fn the_default_flux_keeps_its_order_where_lines_have_kinks() {
    let place = |n: usize, [i, j]: [usize; 2]| {
        let up = if j % n % 2 == 1 { [0.3, -0.3][i % n % 2] } else { 0.0 };
        [i as f64, j as f64 + up].map(|x| x / n as f64)
    };
    keeps_its_order(
        "kinks",
        &place,
        &[("rk-dgfem", 1, 16), ("rk-dgfem", 2, 8), ("rk-dgfem", 3, 8), ("ader-dgmpm", 2, 8)],
    );
}

/// Nodes anywhere within .2 of a cell: 1.4, 1.4 and 2.9 with traces that do not know of the other cell.
#[test]
fn the_default_flux_keeps_its_order_on_a_mesh_without_any_order() {
    let place = |n: usize, at: [usize; 2]| {
        // The same at both seams of the periodic mesh; the sides stay straight.
        let moved = |axis: usize| {
            let phase = (at[0] % n * 131 + at[1] % n * 17 + axis * 7) as f64;
            if at[axis].is_multiple_of(n) { 0.0 } else { 0.2 * (12.9898 * phase).sin() }
        };
        [0, 1].map(|axis| (at[axis] as f64 + moved(axis)) / n as f64)
    };
    keeps_its_order(
        "no order",
        &place,
        &[("rk-dgfem", 1, 16), ("rk-dgfem", 2, 8), ("rk-dgfem", 3, 8), ("ader-dgmpm", 2, 8)],
    );
}
