//! J2 plasticity: the elastoplastic impact against its exact solution, and what internal variables must keep.

mod runs;
mod scenes;

use dgmpm::parts::exact::{Exact, J2Impact};
use dgmpm::parts::io::snapshot::{self, Snapshot};
use dgmpm::parts::io::vtu;
use dgmpm::parts::lane::{Kernel, as_f64};
use dgmpm::parts::material::J2;
use dgmpm::parts::problem::{Given, Problem, Setup};
use dgmpm::parts::state::State;
use dgmpm::parts::step::Law;
use dgmpm::parts::step::{Corrected, Correction, Made, Motion, Scheme};
use runs::run;
use scenes::{Body, STEEL};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

const METHODS: [&str; 3] = ["ader-dgmpm", "ader-dgfem", "rk-dgfem"];

/// Mean and largest deviation from it.
fn mean(values: &[f64]) -> (f64, f64) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (mean, values.iter().fold(0.0, |far: f64, x| far.max((x - mean).abs())))
}

/// Where a quantity that falls along x passes a level, by linear interpolation.
fn crossing(x: &[f64], values: &[f64], level: f64) -> f64 {
    let i = (0..values.len() - 1).rfind(|&i| values[i] >= level).unwrap();
    x[i] + (x[i + 1] - x[i]) * (values[i] - level) / (values[i] - values[i + 1])
}

#[test]
fn the_elastoplastic_impact_has_the_plateau_and_the_front_of_finite_strain() {
    for method in METHODS {
        for degree in [1, 2] {
            let sets = [format!("scheme.method={method}"), format!("scheme.degree={degree}")];
            let outcome = run("bar_plastic.toml", &sets.each_ref().map(String::as_str));
            let line = outcome.line("axis", 3e-4);
            let (x, t) = (line.column("x"), line.column("t")[0]);
            let of = |name: &str, from: f64, to: f64| {
                let all = x.iter().zip(line.column(name)).filter(|(x, _)| (from..to).contains(*x));
                mean(&all.map(|(_, value)| value).collect::<Vec<_>>())
            };
            // Away from the wall, whose first cells heat up in any scheme of this kind, and from the front at 1.41 m.
            let (p, p_off) = of("piola_11", 0.2, 1.2);
            let (strain, strain_off) = of("plastic_strain", 0.2, 1.2);
            let front = crossing(&x, &line.column("plastic_strain"), 0.5 * 0.02575) / t;
            println!("{method} S{degree}: P {p:.6e} +-{p_off:.1e}, p {strain:.6} +-{strain_off:.1e}, front {front:.1}");
            // The issue's figures.
            assert!((p / -7.4570e9 - 1.0).abs() < 2e-3, "{method} S{degree}: {p:e}");
            // RK-DGFEM S1, whose strain varies by 2 % from cell to cell, has .58 %.
            let bound = if (method, degree) == ("rk-dgfem", 1) { 7e-3 } else { 5e-3 };
            assert!((strain / 0.025753 - 1.0).abs() < bound, "{method} S{degree}: {strain}");
            assert!((front / 4689.0 - 1.0).abs() < 1e-2, "{method} S{degree}: {front}");
        }
    }
}

#[test]
fn errors_of_the_elastoplastic_impact_fall_with_the_mesh_for_all_methods() {
    for method in METHODS {
        for degree in [1, 2] {
            let mut before = [f64::INFINITY; 3];
            for cells in [40, 80, 160] {
                let mesh = format!("mesh.rectangle={{size=[3.0,{}],cells=[{cells},1]}}", 3.0 / f64::from(cells));
                let (from, to) = (format!("output.1.from=[0.0,{}]", 1.0 / f64::from(cells)), 1.0 / f64::from(cells));
                let (degree, to) = (format!("scheme.degree={degree}"), format!("output.1.to=[3.0,{to}]"));
                let outcome =
                    run("bar_plastic.toml", &[&format!("scheme.method={method}"), &degree, &mesh, &from, &to]);
                let l1 = ["deformation", "velocity", "piola"].map(|field| {
                    // A mean over the height: the bar of a finer mesh is thinner.
                    outcome.summary["errors"][field]["l1"].as_f64().unwrap() * f64::from(cells)
                });
                println!("{method} {degree} {cells}: {l1:?}");
                for (now, before) in l1.iter().zip(before) {
                    // Of first order at shocks, less what the plastic one takes to form: measured .54 to .63.
                    assert!(*now < 0.75 * before, "{method} {degree} {cells}: {l1:?} {before:?}");
                }
                before = l1;
            }
        }
    }
}

/// A square of J2 steel that yields at so many Pa, and hardens. Histories are at the paper's points, also away from the nodes: the
/// update of points is what is tested.
fn steel(yields: f64, hardening: f64) -> Body {
    let law = format!("yield_stress = {yields:e}\nhardening = {hardening:e}");
    let square = Body::square(2).material("j2", STEEL, &law).side("bottom", "symmetry", "");
    square.table("cloud", "layout = \"paper\"\nhistories = \"points\"").method("ader-dgmpm").end(1.0)
}

/// Such a square, pushed and sheared to and fro.
fn cycles() -> Body {
    let pushed = steel(4e8, 1e8).degree(1).velocity(["50*sin(3*y)", "20*x*y"]).side("left", "clamped", "");
    pushed.side("right", "velocity", r#"value = ["-20*cos(8e3*t)", "30*cos(5e3*t)"]"#)
}

struct March {
    scheme: Scheme,
    motion: Motion,
    courant: f64,
    h: f64,
}

impl March {
    fn new(sets: &[&str], kernel: Kernel) -> Self {
        Self::of(&cycles(), sets, kernel)
    }

    fn of(body: &Body, sets: &[&str], kernel: Kernel) -> Self {
        let problem = Setup::of(&body.scene(sets)).kernel(kernel).build().unwrap();
        let (courant, h) = (problem.settings.courant, problem.body.mesh.smallest_h());
        let Problem { scheme, state, .. } = problem;
        let mut motion = Motion::unsurveyed(&scheme, state).with_balance(&scheme);
        motion.survey(&scheme).unwrap();
        Self { scheme, motion, courant, h }
    }

    fn step(&mut self) {
        let dt = self.courant * self.h / self.motion.survey.fastest;
        self.motion.advance(&self.scheme, dt).unwrap();
    }

    fn steps(mut self, count: usize) -> Self {
        (0..count).for_each(|_| self.step());
        self
    }

    /// The unknowns of all cells and the internal variables of all points, bit for bit.
    fn bits(&self) -> Vec<u64> {
        let u = self.motion.state.unpack(&self.scheme.operators.blocks, self.scheme.operators.nodes());
        u.into_iter().chain(self.scheme.internal_of(&self.motion.state)).map(f64::to_bits).collect()
    }

    /// Internal variables, point by point.
    fn internal(&self) -> Vec<[f64; 5]> {
        self.scheme.internal_of(&self.motion.state).as_chunks::<5>().0.to_vec()
    }
}

#[test]
fn plastic_flow_keeps_the_volume_over_10_000_steps_and_plastic_strain_never_falls() {
    for method in METHODS {
        let mut march = March::new(&[&format!("scheme.method={method}")], Kernel::widest());
        let mut before = march.internal();
        let mut flowed = 0;
        for _ in 0..10_000 {
            march.step();
            let now = march.internal();
            for (now, before) in now.iter().zip(&before) {
                assert!(now[4] >= before[4], "{method}: {} {}", now[4], before[4]);
                flowed += usize::from(now[4] > before[4]);
            }
            before = now;
        }
        let worst = before.iter().fold(0.0, |far: f64, c| far.max(((c[0] * c[1] - c[2] * c[2]) * c[3] - 1.0).abs()));
        let most = before.iter().fold(0.0, |most: f64, c| most.max(c[4]));
        println!("{method}: |det Cp^-1 - 1| {worst:.1e}, p up to {most:.3}, {flowed} returns of 160000");
        // The issue's figure; each return sets the determinant anew.
        assert!(worst < 1e-10, "{method}: {worst:e}");
        // A test without flow to the end would test nothing.
        assert!(most > 0.05 && flowed > 10_000, "{method}: {most} {flowed}");
    }
}

#[test]
fn with_points_at_the_nodes_ader_dgmpm_is_ader_dgfem() {
    for degree in 1..=3 {
        let degree = format!("scheme.degree={degree}");
        let of = |sets: &[&str]| {
            March::new(&[sets, &[degree.as_str(), "mesh.rectangle.cells=[3,2]"]].concat(), Kernel::widest()).steps(60)
        };
        let mpm = of(&["scheme.method=ader-dgmpm", "cloud.layout=gauss"]);
        let fem = of(&["scheme.method=ader-dgfem"]);
        let (mut largest, mut size) = ([0.0_f64; 6], [0.0_f64; 6]);
        let n = mpm.scheme.operators.nodes();
        for (i, (a, b)) in as_f64(&mpm.motion.state.u).iter().zip(as_f64(&fem.motion.state.u)).enumerate() {
            let k = (i / 8 / n) % 6;
            (largest[k], size[k]) = (largest[k].max((a - b).abs()), size[k].max(b.abs()));
        }
        for k in 0..6 {
            // The issue's figure, of each component's size; F12 and F21 are small parts of F.
            let size = if k < 4 { 1.0 } else { size[k] };
            assert!(largest[k] <= 1e-12 * size, "{degree} {k}: {:e}", largest[k] / size);
        }
        assert!(mpm.internal().iter().any(|c| c[4] > 1e-3));
        for (a, b) in mpm.internal().iter().flatten().zip(fem.internal().iter().flatten()) {
            assert!((a - b).abs() < 1e-12, "{degree}: {a} {b}");
        }
    }
}

#[test]
fn kernels_agree_to_rounding() {
    for method in METHODS {
        let of = |kernel| March::new(&[&format!("scheme.method={method}"), "scheme.degree=2"], kernel).steps(50);
        let (widest, portable) = (of(Kernel::widest()), of(Kernel::Portable));
        let u = |march: &March| march.motion.state.unpack(&march.scheme.operators.blocks, 9);
        for (i, (a, b)) in u(&widest).iter().zip(u(&portable)).enumerate() {
            // 50 steps of some 1e-15, of F of size 1, p of size rho0 50 m/s, and u, which is smaller.
            let size = if [4, 5].contains(&((i / 9) % 8)) { 4e5 } else { 1.0 };
            assert!((a - b).abs() < 1e-12 * size, "{method}: {a} {b}");
        }
        for (a, b) in widest.internal().iter().flatten().zip(portable.internal().iter().flatten()) {
            assert!((a - b).abs() < 1e-12, "{method}: {a} {b}");
        }
    }
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    // Large enough for three tiles of the step.
    let sets = ["mesh.rectangle.cells=[48,40]", "scheme.degree=2"];
    for method in METHODS {
        let of = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let method = format!("scheme.method={method}");
            pool.install(|| {
                March::new(&[&sets[..], &[&method, "cloud.layout=jitter"]].concat(), Kernel::widest()).steps(6)
            })
        };
        let (one, three) = (of(1), of(3));
        assert!(one.internal().iter().any(|c| c[4] > 0.0));
        assert!(one.bits() == three.bits(), "{method}");
    }
}

#[test]
fn a_run_goes_on_bit_for_bit_from_what_a_snapshot_holds() {
    for method in METHODS {
        let sets = [&format!("scheme.method={method}"), "cloud.layout=jitter", "mesh.rectangle.cells=[5,3]"];
        let straight = March::new(&sets, Kernel::widest()).steps(40);
        let half = March::new(&sets, Kernel::widest()).steps(20);
        let snapshot = dgmpm::parts::observe::take(&half.scheme, &half.motion.state);
        assert_eq!(snapshot.internal.len(), 5 * 4 * 15);
        let mut other = March::new(&sets, Kernel::widest());
        let blocks = &other.scheme.operators.blocks;
        other.motion.state =
            State { time: snapshot.time, step: snapshot.step, ..State::pack(blocks, 4, 8, &snapshot.unknowns(8)) };
        other.scheme.set_internal(&mut other.motion.state, &snapshot.internal);
        other.motion.survey(&other.scheme).unwrap();
        assert!(other.bits() == half.bits(), "{method}");
        assert!(other.steps(20).bits() == straight.bits(), "{method}: on from there");
    }
}

/// Copies all blocks, and adds to the plastic strain of block 17.
struct Harden {
    by: f64,
    after_stages: bool,
}

impl Correction for Harden {
    fn name(&self) -> &str {
        "harden"
    }
    fn after_stages(&self) -> bool {
        self.after_stages
    }
    fn applies(&self, _: &Made, _: usize) -> bool {
        true
    }
    fn correct(&self, _: &Made, block: &mut Corrected) {
        for history in block.internal.as_chunks_mut::<5>().0.iter_mut().filter(|_| block.number == 17) {
            history[4].0.iter_mut().for_each(|strain| *strain += self.by);
        }
    }
}

#[test]
fn a_correction_from_outside_the_crate_sees_and_changes_the_memory_of_the_material() {
    for method in METHODS {
        let march = |corrections: Vec<Arc<dyn Correction>>| {
            let sets = [&format!("scheme.method={method}"), "mesh.rectangle.cells=[24,8]"];
            let mut march = March::new(&sets, Kernel::widest());
            march.scheme.corrections = corrections;
            march.motion = Motion::new(&march.scheme, march.motion.state).unwrap();
            march.steps(5)
        };
        let plain = march(vec![]);
        for after_stages in [false, true] {
            let same = march(vec![Arc::new(Harden { by: 0.0, after_stages })]);
            assert!(same.bits() == plain.bits() && same.motion.survey == plain.motion.survey, "{method}");
            let other = march(vec![Arc::new(Harden { by: 1e-3, after_stages })]);
            let more = other.internal().iter().zip(plain.internal()).map(|(a, b)| a[4] - b[4]).collect::<Vec<_>>();
            // After five steps 5e-3 at the points of eight cells, less what flows less there (1e-6); elsewhere what the waves carry.
            let changed = more.iter().filter(|more| (**more - 5e-3).abs() < 1e-5).count();
            assert!(more.iter().all(|more| (*more - 5e-3).abs() < 1e-5 || more.abs() < 1e-6), "{method}");
            assert_eq!(changed, 8 * more.len() / 192, "{method}");
        }
    }
}

/// Two materials in one body, of which one has memory; the test makes the mesh.
fn mixed() -> Body {
    let rectangle = Body::default().mesh_file(Path::new("given.msh")).sides("symmetry");
    let body = rectangle.side("left", "wall", "").side("right", "free", "").method("ader-dgmpm").degree(1).end(1.0);
    body.material("neo-hookean", STEEL, "group = \"hard\"").material(
        "j2",
        [7e10, 0.3, 2700.0],
        "group = \"soft\"\nyield_stress = 1e8\nhardening = 1e9",
    )
}

#[test]
fn elastic_cells_hold_nothing_and_plastic_ones_what_their_points_need() {
    let scene = mixed().scene(&["cloud.histories=points"]);
    let mut mesh = dgmpm::parts::mesh::rectangle([4.0, 5.0], [4, 5]).unwrap();
    mesh.groups = vec!["hard".to_owned(), "soft".to_owned()];
    (0..20).for_each(|cell| mesh.cell_group[cell] = usize::from(cell % 4 >= 2));
    // 4, 5 or 6 points a cell.
    let extra = [[0.5, 0.5], [0.3, 0.6]];
    let mut cloud = dgmpm::parts::cloud::Cloud { first: vec![0], xi: vec![] };
    for cell in 0..20 {
        cloud.xi.extend([[0.2, 0.2], [0.2, 0.8], [0.8, 0.2], [0.8, 0.8]]);
        cloud.xi.extend(&extra[..cell % 3]);
        cloud.first.push(cloud.xi.len());
    }
    let given = Given { cloud: cloud.clone(), ..Given::default() };
    let problem = Setup::of(&scene).mesh(mesh).points(given).build().unwrap();
    let Problem { scheme, mut state, .. } = problem;
    let points: usize = (0..20).filter(|cell| cell % 4 >= 2).map(|cell| 4 + cell % 3).sum();
    let virgin = scheme.virgin_internal();
    assert_eq!((virgin.len(), scheme.internal_of(&state)), (5 * points, virgin.clone()));
    assert_eq!((&scheme.places().first, scheme.places().xi.len()), (&cloud.first, cloud.xi.len()));
    // 10 plastic cells are two blocks, of cells with at most 6 and 5 points: elastic blocks take no memory.
    assert_eq!(state.internal.len(), (6 + 5) * 5);
    let numbers: Vec<f64> = (0..virgin.len()).map(|i| i as f64).collect();
    scheme.set_internal(&mut state, &numbers);
    assert_eq!(scheme.internal_of(&state), numbers);
    let elastic = March::of(
        &cycles(),
        &["material.0={law=\"neo-hookean\",young=2e11,poisson=0.3,density=7800}"],
        Kernel::widest(),
    );
    assert!(elastic.motion.state.internal.is_empty() && elastic.scheme.histories.is_empty());
    assert!(elastic.scheme.internal_of(&elastic.motion.state).is_empty());
}

#[test]
fn a_step_that_loses_stability_leaves_the_old_state_whole() {
    let mut march = March::new(&[], Kernel::widest()).steps(10);
    let before = march.bits();
    let dt = 100.0 * march.courant * march.h / march.motion.survey.fastest;
    let lost = march.motion.advance(&march.scheme, dt);
    assert!(lost.is_err() && march.bits() == before);
}

#[test]
fn energy_goes_into_plastic_flow_and_jumps_and_nowhere_else() {
    let sets = ["output.2.every_steps=1", "mesh.rectangle={size=[3.0,0.05],cells=[60,1]}"];
    for (method, largest) in [("ader-dgmpm", 0.01), ("rk-dgfem", 1e-3)] {
        let outcome = run("bar_plastic.toml", &[&sets[..], &[&format!("scheme.method={method}")]].concat());
        let ledger = outcome.ledger();
        let (plastic, total) = (ledger.column("material_dissipation"), ledger.column("total_energy"));
        assert!(plastic.windows(2).all(|pair| pair[1] >= pair[0]) && plastic[0] == 0.0);
        let end = *plastic.last().unwrap();
        // The exact solution: sigma_y p behind the plastic shock, over .05 m x 4689 m/s x 3e-4 s.
        let exact = J2Impact::new(&Law::from(J2::new(2e11, 0.3, 7800.0, 4e8, 1e10)), 200.0).unwrap();
        let expected = 4e8 * exact.internal([0.0; 2], 3e-4).unwrap()[4] * 0.05 * exact.shocks()[1].1 * 3e-4;
        println!("{method}: plastic {end:.5e}, exact {expected:.5e}");
        // The wall cell and the smeared front: of 28 cells behind the front one counts 4 %.
        assert!((end / expected - 1.0).abs() < 0.02, "{method}: {end:e} {expected:e}");
        let remainder = *ledger.column("remainder").last().unwrap() / total[0];
        println!(
            "{method}: remainder {remainder:.2e} of the energy at the start, total {:.4}",
            total.last().unwrap() / total[0]
        );
        // What time integration leaves, see docs/method.md: at a shock ADER's is large, RK's is not.
        assert!(remainder.abs() < largest, "{method}: {remainder:e}");
        assert_eq!(outcome.number("material_dissipation"), end);
    }
}

/// The values of a point field of a VTU file, if it is there.
fn vtu_field(path: &Path, name: &str) -> Option<Vec<f64>> {
    let (_, fields) = vtu::points(&std::fs::read(path).unwrap()).unwrap();
    fields.into_iter().find(|field| field.name == name).map(|field| field.values)
}

/// Exports a run; the last snapshot, and the files of its grid and points.
fn export(run: &Path) -> (Snapshot, PathBuf, PathBuf) {
    let output = Command::new(env!("CARGO_BIN_EXE_dgmpm")).arg("export").arg(run).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let (step, path) = snapshot::list(&run.join("snapshots")).unwrap().pop().unwrap();
    let file = |kind: &str| run.join(format!("export/{kind}_{step:06}.vtu"));
    (Snapshot::read(&path).unwrap(), file("grid"), file("points"))
}

const FIELDS: [&str; 2] = ["plastic_strain", "inverse_plastic_metric"];

#[test]
fn exported_points_show_their_own_history_and_the_grid_that_of_the_nearest() {
    for method in METHODS {
        let cloud = "cloud={layout=\"jitter\",histories=\"points\"}";
        let sets = ["mesh.rectangle={size=[3.0,0.1],cells=[30,1]}", cloud, "output.1.samples=31"];
        let outcome = run("bar_plastic.toml", &[&sets[..], &[&format!("scheme.method={method}")]].concat());
        let (snapshot, grid, points) = export(&outcome.path());
        let of = |path: &Path| vtu_field(path, FIELDS[0]).unwrap();
        let stored: Vec<f64> = snapshot.internal.as_chunks::<5>().0.iter().map(|c| c[4]).collect();
        let (at_points, on_grid) = (of(&points), of(&grid));
        assert_eq!((stored.len(), at_points.len(), on_grid.len()), (270, 270, 270), "{method}");
        if method == "ader-dgmpm" {
            assert_eq!(at_points, stored);
        }
        // Never interpolated: every number shown is one that is stored in the cell.
        for (cell, stored) in stored.chunks(9).enumerate() {
            let shown = at_points[9 * cell..][..9].iter().chain(&on_grid[9 * cell..][..9]);
            shown.for_each(|p| assert!(stored.contains(p), "{method}: {p} {stored:?}"));
        }
        assert!(stored.iter().any(|p| *p > 0.02) && vtu_field(&points, FIELDS[1]).is_some());
    }
}

#[test]
fn an_elastic_scene_stores_and_writes_no_internal_variable() {
    let outcome = run("bar.toml", &["output.0.at=[1e-5]", "output.1.at=[1e-5]", "time.end=1e-5"]);
    let (snapshot, grid, points) = export(&outcome.path());
    assert!(snapshot.internal.is_empty());
    for path in [grid, points] {
        assert!(vtu_field(&path, "cauchy_stress").is_some());
        assert!(FIELDS.iter().all(|name| vtu_field(&path, name).is_none()));
    }
    let header = std::fs::read_to_string(outcome.path().join("ledger.csv")).unwrap();
    assert!(!header.contains("plastic") && outcome.summary["material_dissipation"].is_null());
}

/// Energies of a law with memory are taken where its history stands: with the points on the Gauss nodes they are those of
/// ADER-DGFEM; elsewhere they differ by what the points sample, and not by a return that no step has done. (Measured at the
/// nodes with the history of the nearest point the paper's layout is 5e-3 above the others here.)
#[test]
fn energies_are_those_of_the_points() {
    let start = ["20*sin(pi*x)*cos(pi*y)", "-20*cos(pi*x)*sin(pi*y)"];
    let vortex = steel(1e7, 0.0).degree(2).velocity(start).sides("free");
    let sets = ["mesh.rectangle.cells=[6,6]", "curl.control=off"];
    let energies = |more: &str| {
        let march = March::of(&vortex, &[&sets[..], &[more]].concat(), Kernel::widest()).steps(300);
        let totals = march.scheme.totals(&march.motion.state);
        let energy = march.scheme.energy(&march.motion.state, &march.motion.work, &mut vec![]);
        // Sums in lanes and number by number.
        assert!((energy / totals.accounted() - 1.0).abs() < 1e-13, "{more}: {energy:e} {totals:?}");
        assert!(totals.dissipated.unwrap() > 0.05 * totals.accounted(), "{more}: it yields, {totals:?}");
        totals
    };
    let [nodes, gauss] = ["scheme.method=ader-dgfem", "cloud.layout=gauss"].map(energies);
    // Rounding of 300 steps.
    for (a, b) in [(nodes.strain, gauss.strain), (nodes.dissipated.unwrap(), gauss.dissipated.unwrap())] {
        assert!((a / b - 1.0).abs() < 1e-10, "{nodes:?} {gauss:?}");
    }
    for layout in ["paper", "midpoints", "jitter"] {
        let other = energies(&format!("cloud.layout={layout}"));
        let ratio = other.accounted() / gauss.accounted() - 1.0;
        println!("{layout}: {ratio:.2e}");
        assert!(ratio.abs() < 1e-3, "{layout}: {ratio:e}");
    }
}

/// sum_p w_p = area and sum_p w_p X_p = its first moments, on lattices and any cloud, also where points fill up lanes: the
/// energy of a uniform state is that of its area.
#[test]
fn the_weights_of_the_points_integrate_a_uniform_state_exactly() {
    let uniform = "initial={deformation=[\"1.01\",\"0.002\",\"0\",\"0.99\"]}";
    for layout in ["paper", "midpoints", "gauss", "jitter", "random", "cluster", "rotated"] {
        for degree in 1..=3 {
            let (layout, degree) = (format!("cloud.layout={layout}"), format!("scheme.degree={degree}"));
            let sets = ["mesh.rectangle.cells=[3,4]", &layout, &degree, uniform];
            let march = March::of(&cycles(), &sets, Kernel::widest());
            let law = &march.scheme.laws[0];
            let expected = law.response([1.01, 0.002, 0.0, 0.99], &law.virgin());
            let totals = march.scheme.totals(&march.motion.state);
            // Rounding, times the Lebesgue constant of random points (1e3 and less).
            let (strain, plastic) =
                (totals.strain / expected.energy - 1.0, totals.dissipated.unwrap() / expected.dissipated - 1.0);
            assert!(strain.abs() < 1e-10 && plastic.abs() < 1e-10, "{layout} {degree}: {strain:e} {plastic:e}");
        }
    }
}
