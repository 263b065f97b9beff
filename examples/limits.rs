//! Measures the limits of the time step that `step::cfl` and `step::runge_kutta` hold: the largest dt c / h at which
//! noise of 1e-7 on a uniform state does not grow by 20 % from step 300 to step 1500, on 4 x 4 cells between walls.
//!
//! `cargo run --release --example limits -- F11 F22` (default 1 1; .9 .9 is the compressed state of the design). The
//! third argument `ladder` measures the two schedules of the predictor's sweeps side by side, N_T = N, and nothing else.

use dgmpm::parts::basis::TimeBasis;
use dgmpm::parts::boundary::{Boundary, Wall};
use dgmpm::parts::material::NeoHookean;
use dgmpm::parts::mesh::{links, rectangle};
use dgmpm::parts::operators::{Needs, Operators, Sampling};
use dgmpm::parts::riemann::Rusanov;
use dgmpm::parts::state::State;
use dgmpm::parts::step::Flux;
use dgmpm::parts::step::Law;
use dgmpm::parts::step::{Control, Method, Motion, Relax, Scheme, Sweeps, Tableau};
use std::sync::Arc;

const CELLS: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let given: Vec<f64> = std::env::args().skip(1).take(2).map(|x| x.parse()).collect::<Result<_, _>>()?;
    let [f11, f22] = given.try_into().unwrap_or([1.0, 1.0]);
    let uniform = [f11, 0.0, 0.0, f22, 0.0, 0.0];
    if std::env::args().nth(3).is_some_and(|word| word == "ladder") {
        return compare(uniform);
    }
    println!("F = diag({f11}, {f22})\nmethod                 N  N_T  limit dt c / h");
    for runge_kutta in [false, true] {
        for degree in 0..=6 {
            for time_degree in (1..=6).filter(|&t| !runge_kutta || t != 3) {
                let method = match runge_kutta {
                    true => Method::RungeKutta(Tableau::of_degree(time_degree)),
                    false => paper(degree, time_degree),
                };
                let name = match &method {
                    Method::RungeKutta(tableau) => tableau.name,
                    Method::Ader { .. } => "ADER",
                };
                let limit = bisect(&scheme(method.clone(), degree)?, uniform);
                println!("{name:22} {degree}  {time_degree}    {limit:.4}");
            }
        }
    }
    Ok(())
}

/// The limits of both schedules.
fn compare(uniform: [f64; 6]) -> Result<(), Box<dyn std::error::Error>> {
    println!("F = diag({}, {})\nN  paper   ladder", uniform[0], uniform[3]);
    for degree in 1..=6 {
        let methods = [paper(degree, degree), Method::ader(degree, degree)];
        let [a, b] = methods.map(|method| scheme(method, degree).map(|scheme| bisect(&scheme, uniform)));
        println!("{degree}  {:.4}  {:.4}", a?, b?);
    }
    Ok(())
}

/// ADER with the paper's sweeps.
fn paper(degree: usize, time_degree: usize) -> Method {
    let time = TimeBasis::new(time_degree);
    Method::Ader { sweeps: Sweeps::paper(&time, degree.max(time_degree) + 1), time }
}

fn scheme(method: Method, degree: usize) -> Result<Scheme, Box<dyn std::error::Error>> {
    let mesh = rectangle([1.0, 1.0], [CELLS, CELLS])?;
    let sampling = matches!(method, Method::Ader { .. }).then_some(Sampling::Nodes);
    let needs = Needs { degree, sampling, curl_free: degree > 0, held: true };
    let operators = Operators::build(&mesh, &links(&mesh)?, &vec![0; mesh.cells.len()], &needs)?;
    let alpha = if degree >= 4 { 6.0 } else { 3.0 };
    let laws = vec![Law::from(NeoHookean::new(1.0, 0.3, 1.0))];
    let boundaries = (0..4).map(|_| Arc::new(Wall { speed: None }) as Arc<dyn Boundary>).collect();
    let scheme = Scheme::new(operators, laws, method, Flux::from(Rusanov), boundaries)?;
    match degree {
        0 => Ok(scheme),
        _ => Ok(scheme.with_curl(Control { relax: Relax::Gradient, rate: alpha * degree as f64 })?),
    }
}

/// The largest stable dt c / h to 1.5 %.
fn bisect(scheme: &Scheme, uniform: [f64; 6]) -> f64 {
    let (mut stable, mut unstable) = (0.002_f64, 0.8);
    while unstable / stable > 1.015 {
        let middle = (stable * unstable).sqrt();
        if grows(scheme, uniform, middle) { unstable = middle } else { stable = middle }
    }
    stable
}

fn grows(scheme: &Scheme, uniform: [f64; 6], courant: f64) -> bool {
    let nodes = scheme.operators.nodes();
    let mean = |i: usize| uniform[(i / nodes) % 6];
    let mut seed = 12345_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((seed >> 33) as f64 / (1_u64 << 31) as f64 - 0.5) * 1e-7
    };
    let start: Vec<f64> = (0..CELLS * CELLS * 6 * nodes).map(|i| mean(i) + noise()).collect();
    let state = State::pack(&scheme.operators.blocks, nodes, 6, &start);
    let Ok(mut motion) = Motion::new(scheme, state) else { return true };
    let size = |state: &State| -> f64 {
        let values = state.unpack(&scheme.operators.blocks, nodes);
        values.iter().enumerate().map(|(i, u)| (u - mean(i)).powi(2)).sum::<f64>().sqrt()
    };
    let mut early = f64::INFINITY;
    for step in 0..1500 {
        if step == 300 {
            early = size(&motion.state);
        }
        if motion.advance(scheme, courant / CELLS as f64 / motion.survey.fastest).is_err() {
            return true;
        }
    }
    let late = size(&motion.state);
    late.is_nan() || late >= 1.2 * early
}
