//! From a problem, a mesh and a method to an error.

use crate::points::Points;
use crate::problem::Problem;
use cpu_time::ThreadTime;
use dgmpm::parts::accuracy::{Errors, errors};
use dgmpm::parts::basis::TimeBasis;
use dgmpm::parts::boundary::{Boundary, Free, Wall};
use dgmpm::parts::cloud::{Cloud, seed};
use dgmpm::parts::exact::ExactForce;
use dgmpm::parts::mesh::{Mesh, map, periodic_links};
use dgmpm::parts::operators::{Needs, Operators, Sampling};
use dgmpm::parts::riemann::Rusanov;
use dgmpm::parts::run::{Report, Run, Settings};
use dgmpm::parts::source::Source;
use dgmpm::parts::state::State;
use dgmpm::parts::step::Flux;
use dgmpm::parts::step::{Control, Method, Relax, Scheme, Sweeps, Tableau, cfl};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A method, with the layout of its points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    Rk,
    Fem,
    /// DGMPM on a layout with so many points per direction more than N + 1.
    Mpm(seed::Layout, usize),
    /// DGMPM on midpoints, with the paper's sweeps instead of the ladder.
    PaperSweeps,
    /// DGMPM on a cloud that ignores the grid.
    Cloud(Points),
}

pub const MIDPOINTS: Kind = Kind::Mpm(seed::Layout::Midpoints, 0);
pub const PAPER: Kind = Kind::Mpm(seed::Layout::Paper, 0);
pub const GAUSS: Kind = Kind::Mpm(seed::Layout::Gauss, 0);
pub const JITTER: Kind = Kind::Mpm(seed::Layout::Jitter { seed: 1, amount: 0.2 }, 0);
pub const MORE: Kind = Kind::Mpm(seed::Layout::Midpoints, 1);

/// All methods, all layouts of the points, and both schedules of the sweeps.
pub const KINDS: [Kind; 8] = [MIDPOINTS, PAPER, GAUSS, JITTER, MORE, Kind::PaperSweeps, Kind::Fem, Kind::Rk];

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = match *self {
            Kind::Rk => "rk-dgfem",
            Kind::Fem => "ader-dgfem",
            Kind::PaperSweeps => "paper's sweeps",
            MIDPOINTS => "dgmpm midpoints",
            PAPER => "dgmpm paper",
            GAUSS => "dgmpm gauss",
            MORE => "dgmpm more points",
            Kind::Mpm(..) => "dgmpm jitter",
            Kind::Cloud(points) => return f.pad(&format!("{points:?}")),
        };
        f.pad(name)
    }
}

/// The scheme of a method of degree N in space and N_T in time, with the Rusanov flux.
pub fn scheme(problem: &Problem, mesh: &Mesh, kind: Kind, degree: usize, time_degree: usize) -> Scheme {
    let cloud = match kind {
        Kind::Mpm(layout, more) => seed::seed(layout, degree + 1 + more, mesh.cells.len()),
        Kind::PaperSweeps => seed::seed(seed::Layout::Midpoints, degree + 1, mesh.cells.len()),
        Kind::Cloud(points) => points.carried(mesh, degree).cloud,
        _ => Cloud::default(),
    };
    let sampling = match kind {
        Kind::Rk => None,
        Kind::Fem => Some(Sampling::Nodes),
        Kind::Mpm(..) | Kind::PaperSweeps | Kind::Cloud(_) => Some(Sampling::Cloud(&cloud)),
    };
    let method = match kind {
        Kind::Rk => Method::RungeKutta(Tableau::of_degree(time_degree)),
        Kind::PaperSweeps => {
            let time = TimeBasis::new(time_degree);
            Method::Ader { sweeps: Sweeps::paper(&time, degree.max(time_degree) + 1), time }
        }
        _ => Method::ader(degree, time_degree),
    };
    sampled(problem, mesh, sampling, degree, method)
}

/// ADER of degree N in space and time on these points.
pub fn scheme_on(problem: &Problem, mesh: &Mesh, sampling: Sampling, degree: usize) -> Scheme {
    sampled(problem, mesh, Some(sampling), degree, Method::ader(degree, degree))
}

fn sampled(problem: &Problem, mesh: &Mesh, sampling: Option<Sampling>, degree: usize, method: Method) -> Scheme {
    let links = periodic_links(mesh, &problem.periodic).unwrap();
    let needs = Needs { degree, sampling, curl_free: problem.alpha.is_some(), held: true };
    let operators = Operators::build(mesh, &links, &vec![0; mesh.cells.len()], &needs).unwrap();
    let force = problem.exact.body_force([0.0; 2], 0.0).is_some();
    let sources: Vec<Arc<dyn Source>> = if force { vec![Arc::new(ExactForce(problem.exact.clone()))] } else { vec![] };
    let wall = |_| Arc::new(Wall { speed: None }) as Arc<dyn Boundary>;
    let mut boundaries: Vec<_> = (0..mesh.edge_groups.len()).map(wall).collect();
    boundaries[1] = Arc::new(Free);
    let laws = vec![problem.law.clone()];
    let scheme = Scheme::new(operators, laws, method, Flux::from(Rusanov), boundaries).unwrap().with_sources(sources);
    match problem.alpha {
        Some(alpha) => scheme.with_curl(Control { relax: Relax::Gradient, rate: alpha * degree as f64 }).unwrap(),
        None => scheme,
    }
}

/// The exact state at t = 0, at the nodes.
pub fn start(problem: &Problem, mesh: &Mesh, scheme: &Scheme) -> State {
    let n = scheme.operators.nodes();
    let mut cells = vec![0.0; mesh.cells.len() * 6 * n];
    for (cell, values) in cells.chunks_mut(6 * n).enumerate() {
        for a in 0..n {
            let x = map::position(&mesh.map(cell), scheme.operators.line.basis.node_2d(a));
            let (f, v) = (problem.exact.deformation(x, 0.0), problem.exact.velocity(x, 0.0));
            let p = v.map(|v| problem.law.density() * v);
            let u = [f[0], f[1], f[2], f[3], p[0], p[1]];
            u.into_iter().enumerate().for_each(|(k, u)| values[k * n + a] = u);
        }
    }
    State::pack(&scheme.operators.blocks, n, 6, &cells)
}

/// The state at the end; none where the run loses stability before.
pub fn advanced(problem: &Problem, mesh: &Mesh, scheme: &Scheme) -> Option<State> {
    advance_to(problem, mesh, scheme, None, problem.end)
}

/// The state at `end`, from another or from the exact one at t = 0.
pub fn advance_to(problem: &Problem, mesh: &Mesh, scheme: &Scheme, from: Option<State>, end: f64) -> Option<State> {
    let mut state = from.unwrap_or_else(|| start(problem, mesh, scheme));
    let courant = problem.safety * cfl::limit(&scheme.method, scheme.operators.degree);
    let settings = Settings { end, courant, decay: 0.0, watch: None };
    let interrupt = AtomicBool::new(false);
    let mut run = Run { mesh, scheme, settings, observers: vec![], interrupt: &interrupt };
    run.advance(&mut state, &mut Report::default()).ok().map(|()| state)
}

/// Errors at the end, infinite where the run loses stability, and the CPU seconds that it took.
pub fn error(problem: &Problem, mesh: &Mesh, kind: Kind, degree: usize, time_degree: usize) -> (Errors, f64) {
    let solve = || {
        let start = ThreadTime::now();
        let scheme = scheme(problem, mesh, kind, degree, time_degree);
        let lost = Errors { distance: f64::INFINITY, standard: f64::INFINITY, ..Errors::default() };
        let found = advanced(problem, mesh, &scheme)
            .map_or(lost, |state| errors(problem.exact.as_ref(), mesh, &scheme, &state, &vec![0; mesh.cells.len()]));
        (found, start.elapsed().as_secs_f64())
    };
    alone(solve)
}

/// Runs `body` on one thread: threads go to rows of the table instead, as the meshes have some hundred cells only, and
/// the CPU time of a row is its own.
pub fn alone<R: Send>(body: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(body)
}
