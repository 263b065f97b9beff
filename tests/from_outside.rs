//! What a crate that uses dgmpm may add, with its own types and the public surface alone: a law with memory and rate, a flux, a
//! condition with memory, a source that sees the velocity, a quantity, a correction. Each is an entry of the registry (a correction: of the
//! problem), named by a scene, run by the three methods and held to what is known.

use dgmpm::registry::conditions::Condition;
use dgmpm::registry::{
    ANY, CONDITIONS, Entry, FINITE, FLUXES, Form, LAWS, POSITIVE, Parameter, QUANTITIES, SOURCES, fluxes, quantities,
};
use dgmpm::{
    Boundary, Corrected, Correction, FacePoint, Flux, Folder, Lane, Law, Looks, Made, Material, Medium, Moment, Past,
    Problem, Quantity, Rank, Riemann, Rusanov, Scene, Seen, Setup, Source, Trace, Variable, Varies, star,
};
use std::path::Path;
use std::sync::{Arc, Once};

const METHODS: [&str; 3] = ["ader-dgmpm", "ader-dgfem", "rk-dgfem"];

/// Small strain, with a Maxwell element of modulus 2 G and relaxation time tau beside the spring:
/// P = lambda tr eps 1 + 2 mu eps + q, dq/dt = 2 G deps/dt - q/tau, by backward Euler. The history is (eps_n, q_n, dissipated).
#[derive(Debug, Clone, Copy)]
struct Maxwell {
    lambda: f64,
    mu: f64,
    branch: f64,
    time: f64,
    density: f64,
}

impl Maxwell {
    /// (eps, q, what is dissipated) at F, components 11, 22, 12.
    #[inline(always)]
    fn advanced<L: Lane>(&self, f: [L; 4], past: &Past<[L; 9]>) -> ([L; 3], [L; 3], L) {
        let (one, half) = (L::splat(1.0), L::splat(0.5));
        let eps = [f[0] - one, f[3] - one, half * (f[1] + f[2])];
        let decay = L::splat(1.0 / (1.0 + past.dt / self.time));
        let (modulus, h) = (L::splat(2.0 * self.branch), &past.history);
        let mut q = [h[4], h[5], h[6]];
        for k in 0..3 {
            q[k] = (q[k] + modulus * (eps[k] - h[k])) * decay;
        }
        let square = q[0] * q[0] + q[1] * q[1] + L::splat(2.0) * q[2] * q[2];
        (eps, q, h[8] + square * L::splat(past.dt / (2.0 * self.branch * self.time)))
    }
}

impl Material for Maxwell {
    const HISTORY: &'static [Variable] = &[
        Variable {
            name: "strain",
            about: "the small strain",
            rank: Rank::SymmetricTensor,
            numbers: &[("_11", 0.0), ("_22", 0.0), ("_12", 0.0), ("_33", 0.0)],
        },
        Variable {
            name: "viscous_stress",
            about: "the stress of the Maxwell element, Pa",
            rank: Rank::SymmetricTensor,
            numbers: &[("_11", 0.0), ("_22", 0.0), ("_12", 0.0), ("_33", 0.0)],
        },
        Variable {
            name: "viscous_work",
            about: "energy dissipated by it, J/m^3",
            rank: Rank::Scalar,
            numbers: &[("", 0.0)],
        },
    ];
    const OBJECTIVE: bool = false;
    type History<L: Lane> = [L; 9];

    fn density(&self) -> f64 {
        self.density
    }

    fn shear_modulus(&self) -> f64 {
        self.mu + self.branch
    }

    #[inline(always)]
    fn stress<L: Lane>(&self, f: [L; 4], past: &mut Past<[L; 9]>) -> [L; 4] {
        let (eps, q, dissipated) = self.advanced(f, past);
        let (zero, twice) = (L::zero(), L::splat(2.0 * self.mu));
        let pressure = L::splat(self.lambda) * (eps[0] + eps[1]);
        past.history = [eps[0], eps[1], eps[2], zero, q[0], q[1], q[2], zero, dissipated];
        let shear = twice * eps[2] + q[2];
        [pressure + twice * eps[0] + q[0], shear, shear, pressure + twice * eps[1] + q[1]]
    }

    #[inline(always)]
    fn stress33<L: Lane>(&self, f: [L; 4], _: &Past<[L; 9]>) -> L {
        L::splat(self.lambda) * (f[0] + f[3] - L::splat(2.0))
    }

    #[inline(always)]
    fn energy<L: Lane>(&self, f: [L; 4], past: &Past<[L; 9]>) -> L {
        let (eps, q, _) = self.advanced(f, past);
        let square = |a: [L; 3]| a[0] * a[0] + a[1] * a[1] + L::splat(2.0) * a[2] * a[2];
        let trace = eps[0] + eps[1];
        L::splat(0.5 * self.lambda) * trace * trace
            + L::splat(self.mu) * square(eps)
            + L::splat(0.25 / self.branch) * square(q)
    }

    #[inline(always)]
    fn dissipated<L: Lane>(&self, f: [L; 4], past: &Past<[L; 9]>) -> L {
        self.advanced(f, past).2
    }

    #[inline(always)]
    fn acoustic<L: Lane>(&self, _: [L; 4], n: [L; 2]) -> [L; 3] {
        let mu = self.mu + self.branch;
        let (mu, sum) = (L::splat(mu), L::splat(self.lambda + mu));
        [sum * n[0] * n[0] + mu, sum * n[0] * n[1], sum * n[1] * n[1] + mu]
    }
}

/// Local Lax-Friedrichs once more: its runs must have the bits of the built-in one.
#[derive(Debug, Clone, Copy)]
struct LaxFriedrichs;

impl Riemann for LaxFriedrichs {
    const LOOKS: Looks = Looks::Nothing;

    #[inline(always)]
    fn flux<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>) -> [L; 6] {
        Rusanov.flux(minus, plus, n, medium)
    }

    #[inline(always)]
    fn lifted<L: Lane>(&self, minus: &Trace<L>, plus: &Trace<L>, n: [L; 2], medium: &Medium<L>, scale: L) -> [L; 6] {
        Rusanov.lifted(minus, plus, n, medium, scale)
    }
}

/// A wall that the body may leave and reach: free while the gap (m) is open, a frictionless rigid wall where it is closed and
/// pressed. The gap is the memory: it grows by -v*.N dt.
struct GapWall {
    gap: [f64; 1],
}

impl Boundary for GapWall {
    fn memory(&self) -> &[f64] {
        &self.gap
    }

    fn flux(&self, inside: &Trace<f64>, at: &FacePoint, when: &Moment, memory: &mut [f64]) -> [f64; 6] {
        let n = at.normal;
        let along = |a: [f64; 2]| a[0] * n[0] + a[1] * n[1];
        // What the wall would have to push with.
        let pressure = along(inside.t) - at.impedance(inside) * along(inside.v);
        let closed = memory[0] <= 0.0 && pressure < 0.0;
        let z = 1.0 / at.impedance(inside);
        let free = [0, 1].map(|i| inside.v[i] - z * inside.t[i]);
        let v = if closed { [0, 1].map(|i| free[i] - along(free) * n[i]) } else { free };
        let t = if closed { n.map(|n| pressure * n) } else { [0.0; 2] };
        memory[0] -= when.dt * along(v);
        star(v, t, n)
    }
}

/// b = -c v.
struct Drag(f64);

impl Source for Drag {
    fn varies(&self) -> Varies {
        Varies::VELOCITY
    }

    fn acceleration(&self, _: [f64; 2], _: f64, v: [f64; 2], _: usize) -> [f64; 2] {
        v.map(|v| -self.0 * v)
    }
}

/// p <- p/2 in the blocks that move.
struct Halve;

impl Correction for Halve {
    fn name(&self) -> &str {
        "halve"
    }

    fn applies(&self, _: &Made, _: usize) -> bool {
        true
    }

    fn correct(&self, made: &Made, block: &mut Corrected) {
        let nodes = made.scheme.operators.nodes();
        block.u[4 * nodes..6 * nodes].iter_mut().flat_map(|numbers| &mut numbers.0).for_each(|p| *p *= 0.5);
    }
}

const MAXWELL: &[Parameter] = &[
    Parameter::required("lambda", "first Lame modulus", "Pa", Form::Number(FINITE)),
    Parameter::required("mu", "shear modulus of the spring", "Pa", Form::Number(POSITIVE)),
    Parameter::required("branch", "shear modulus of the Maxwell element", "Pa", Form::Number(POSITIVE)),
    Parameter::required("relaxation", "its relaxation time", "s", Form::Number(POSITIVE)),
    Parameter::required("density", "rho0", "kg/m^3", Form::Number(POSITIVE)),
];

/// int p_1 dX.
struct Momentum;

impl Quantity for Momentum {
    fn of(&self, seen: &Seen) -> f64 {
        seen.totals().momentum[0]
    }
}

/// Adds all of it once a program.
fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let law = |of: &dgmpm::registry::Values| {
            let [lambda, mu, branch] = ["lambda", "mu", "branch"].map(|name| of.number(name));
            Law::new(Maxwell { lambda, mu, branch, time: of.number("relaxation"), density: of.number("density") })
        };
        let about = "from outside";
        LAWS.add(Entry { name: "maxwell", about, parameters: MAXWELL, check: ANY, build: law }).unwrap();
        let build = fluxes::Flux { make: || Flux::new(LaxFriedrichs), when_lost: |_| None, share: 1.0 };
        FLUXES.add(Entry { name: "lax-friedrichs", about, parameters: &[], check: ANY, build }).unwrap();
        const GAP: &[Parameter] = &[Parameter::required("gap", "the gap at the start", "m", Form::Number(FINITE))];
        let build = Condition::of(|of| Arc::new(GapWall { gap: [of.number("gap")] }));
        CONDITIONS.add(Entry { name: "gap-wall", about, parameters: GAP, check: ANY, build }).unwrap();
        const RATE: &[Parameter] = &[Parameter::required("rate", "c in b = -c v", "1/s", Form::Number(POSITIVE))];
        let build: fn(&dgmpm::registry::Values, Option<usize>) -> Arc<dyn Source> =
            |of, _| Arc::new(Drag(of.number("rate")));
        SOURCES.add(Entry { name: "drag", about, parameters: RATE, check: ANY, build }).unwrap();
        let build = quantities::Kind {
            unit: |_| "kg/s",
            is_error: false,
            displacement: |_| false,
            check: |_, _| Ok(()),
            make: |_, _| Ok(Box::new(Momentum)),
        };
        QUANTITIES.add(Entry { name: "momentum", about, parameters: &[], check: ANY, build }).unwrap();
    });
}

/// A square of 4 x 4 cells of edge 1 m, S2, its parts from outside where `more` names them.
fn scene(method: &str, material: &str, sides: [&str; 4], end: f64, more: &str) -> Scene {
    register();
    let groups = ["left", "right", "bottom", "top"].iter().zip(sides);
    let boundaries: String =
        groups.map(|(group, kind)| format!("[[boundary]]\ngroup = \"{group}\"\n{kind}\n")).collect();
    let text = format!(
        "[mesh]\nrectangle = {{ size = [1.0, 1.0], cells = [4, 4] }}\n[[material]]\n{material}\n{boundaries}\
         [scheme]\nmethod = \"{method}\"\ndegree = 2\n[time]\nend = {end}\n{more}"
    );
    Scene::parse(&text, Path::new("outside.toml"), &[]).unwrap()
}

const RUBBER: &str = "law = \"neo-hookean\"\nyoung = 100.0\npoisson = 0.3\ndensity = 1.0";
const FREE: &str = "kind = \"free\"";
const CLAMPED: &str = "kind = \"clamped\"";
const SYMMETRY: &str = "kind = \"symmetry\"";

#[test]
fn the_stress_of_a_maxwell_element_from_outside_relaxes_in_time() {
    let material = "law = \"maxwell\"\nlambda = 1.0\nmu = 1.0\nbranch = 2.0\nrelaxation = 0.5\ndensity = 1.0";
    for method in METHODS {
        let held = "[initial]\ndeformation = [\"1.001\", \"0\", \"0\", \"1\"]\n";
        let mut problem = Problem::new(&scene(method, material, [CLAMPED; 4], 1.0, held)).unwrap();
        let report = problem.run().unwrap();
        let expected = 2.0 * 2.0 * 1e-3 * (-1.0_f64 / 0.5).exp();
        let history = problem.scheme.internal_of(&problem.state);
        assert_eq!(history.len() % 9, 0);
        for point in history.chunks(9) {
            // Backward Euler: 1 + dt/tau for exp(dt/tau) in each of the steps, a relative error of t dt / (2 tau^2).
            let allowed = 1.5 * report.dt[1] / (2.0 * 0.5 * 0.5);
            assert!((point[4] / expected - 1.0).abs() < allowed, "{method}: {} {expected}", point[4]);
            // The strain is that of the start, to the rounding of a uniform state.
            assert!((point[0] - 1e-3).abs() < 1e-12, "{method}: {}", point[0]);
        }
        // What the element has lost is accounted for, but for the error of the same scheme.
        let [first, last] = [report.first.unwrap(), report.last.unwrap()];
        let lost = first.strain - last.strain;
        assert!(lost > 0.0 && (last.dissipated.unwrap() / lost - 1.0).abs() < report.dt[1] / 0.5, "{method}: {last:?}");
    }
}

#[test]
fn a_flux_from_outside_that_is_the_built_in_one_has_its_bits() {
    for method in METHODS {
        let states = ["rusanov", "lax-friedrichs"].map(|flux| {
            let moving = "[initial]\nvelocity = [\"-x\", \"0.3*sin(3*y)\"]\n";
            let scene = scene(method, RUBBER, [FREE, CLAMPED, SYMMETRY, FREE], 0.05, moving);
            let mut problem = Problem::new(&scene.with(&[format!("scheme.flux={flux}")]).unwrap()).unwrap();
            problem.run().unwrap();
            problem.state
        });
        assert!(states[0].step > 10 && states[0].u == states[1].u, "{method}");
    }
}

/// Momentum along x of a body that flies at -1 m/s towards a wall .1 m away, at a time, and its gaps.
fn flown(method: &str, end: f64, more: &str) -> (f64, Vec<f64>, Problem) {
    let flight = format!("[initial]\nvelocity = [\"-1\", \"0\"]\n{more}");
    let wall = "kind = \"gap-wall\"\ngap = 0.1";
    let mut problem = Problem::new(&scene(method, RUBBER, [wall, FREE, SYMMETRY, SYMMETRY], end, &flight)).unwrap();
    problem.run().unwrap();
    let gaps = problem.scheme.boundary_memory_of(&problem.state);
    (problem.scheme.totals(&problem.state).momentum[0], gaps, problem)
}

#[test]
fn a_wall_with_a_gap_from_outside_is_reached_when_the_gap_is_flown_through() {
    for method in METHODS {
        let (before, open, _) = flown(method, 0.09, "");
        assert!((before + 1.0).abs() < 1e-12, "{method}: {before}");
        // 4 cells with 3 points each; what is left is .1 - .09, to the rounding of some hundred steps.
        assert!(open.len() == 12 && open.iter().all(|gap| (gap - 0.01).abs() < 1e-12), "{method}: {open:?}");
        let (after, closed, problem) = flown(method, 0.15, "");
        // A wave of 11.6 m/s has stopped .58 m of the body since .1 s.
        assert!((-0.6..-0.3).contains(&after), "{method}: {after}");
        // Closed within the step in which it closes.
        let dt = problem.settings.courant * 0.25 / 11.0;
        assert!(closed.iter().all(|gap| gap.abs() < 2.0 * dt), "{method}: {closed:?}");
    }
}

#[test]
fn the_memory_of_a_condition_goes_through_snapshots_and_regrids() {
    let folder = tempfile::tempdir().unwrap();
    for method in METHODS {
        let (straight, _, whole) = flown(method, 0.15, "");
        let fields = "[[output]]\nkind = \"fields\"\nat = [0.05]\n";
        let wall = "kind = \"gap-wall\"\ngap = 0.1";
        let flight = format!("[initial]\nvelocity = [\"-1\", \"0\"]\n{fields}");
        let sides = [wall, FREE, SYMMETRY, SYMMETRY];
        let run = Folder::new(&folder.path().join(method));
        Problem::new(&scene(method, RUBBER, sides, 0.06, &flight)).unwrap().run_in(&run).unwrap();
        let snapshot = std::fs::read_dir(run.snapshots()).unwrap().next().unwrap().unwrap().path();
        let again = format!("[initial]\nsnapshot = \"{}\"\n", snapshot.display());
        let mut problem = Problem::new(&scene(method, RUBBER, sides, 0.15, &again)).unwrap();
        let gaps = problem.scheme.boundary_memory_of(&problem.state);
        assert!(gaps.iter().all(|gap| (gap - 0.05).abs() < 0.005), "{method}: {gaps:?}");
        // Two walls with memory remember more than one: the snapshot is not that of such a run.
        let other = scene(method, RUBBER, [wall, wall, SYMMETRY, SYMMETRY], 0.15, &again);
        let why = Problem::new(&other).err().unwrap().to_string();
        assert!(why.contains("the memory of other boundary conditions") && why.contains("[[boundary]]"), "{why}");
        problem.run().unwrap();
        assert!(problem.state.step == whole.state.step && problem.state.u == whole.state.u, "{method}");
        // On a finer grid from .05 s on the body meets the wall at the same time.
        let grid = "[[regrid]]\nat = [0.05]\nrectangle = { size = [1.0, 1.0], cells = [6, 6] }\n";
        let (moved, _, problem) = flown(method, 0.15, grid);
        assert_eq!(problem.body.mesh.cells.len(), 36);
        // Both resolve the front of the stopping wave within a cell of .25 m of a body of 1 kg/m.
        assert!((moved - straight).abs() < 0.05, "{method}: {moved} {straight}");
    }
}

#[test]
fn a_drag_from_outside_slows_a_free_body_as_its_exponential() {
    for method in METHODS {
        let drag = "[initial]\nvelocity = [\"1\", \"0.5\"]\n[[source]]\nkind = \"drag\"\nrate = 2.0\n\
                    [[quantity]]\nname = \"p\"\nkind = \"momentum\"\n";
        let mut problem = Problem::new(&scene(method, RUBBER, [FREE; 4], 1.0, drag)).unwrap();
        let folder = tempfile::tempdir().unwrap();
        problem.run_in(&Folder::new(folder.path())).unwrap();
        let summary = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
        assert_eq!(summary["quantities"]["p"], summary["momentum"][0], "{method}");
        let momentum = problem.scheme.totals(&problem.state).momentum;
        for (found, start) in momentum.into_iter().zip([1.0, 0.5]) {
            let error = found / start / (-2.0_f64).exp() - 1.0;
            // Third order in 2 dt = 1e-3 in some 500 steps: (2 dt)^3 each, of which a sixth stays.
            assert!(error.abs() < 1e-7, "{method}: {error:e}");
        }
    }
}

#[test]
fn a_correction_from_outside_acts_after_each_step() {
    for method in METHODS {
        let scene =
            scene(method, RUBBER, [FREE; 4], 0.02, "[initial]\nvelocity = [\"1\", \"0\"]\n[watch]\nenergy = \"off\"\n");
        let mut problem = Setup::of(&scene).correction(Arc::new(Halve)).build().unwrap();
        problem.run().unwrap();
        let momentum = problem.scheme.totals(&problem.state).momentum[0];
        let steps = problem.state.step as i32;
        // Halves are exact.
        assert!(
            steps > 2 && (momentum / 0.5_f64.powi(steps) - 1.0).abs() < 1e-12,
            "{method}: {momentum:e} after {steps}"
        );
    }
}

#[test]
fn a_name_that_is_taken_is_refused() {
    register();
    let law = |_: &dgmpm::registry::Values| Law::from(dgmpm::NeoHookean::new(1.0, 0.3, 1.0));
    for name in ["j2", "maxwell"] {
        let why = LAWS.add(Entry { name, about: "", parameters: &[], check: ANY, build: law }).unwrap_err();
        assert!(why.to_string().contains(name), "{why}");
    }
}
