//! A run built by hand, without a scene file: mesh, material points, matrices, scheme, state, steps.
//!
//! `cargo run --release --example own_scene` prints the energy of a square of steel that is thrown against a wall.

use dgmpm::{
    Boundary, Cloud, Control, Dual, Flux, Free, Law, Method, Motion, Needs, NeoHookean, Operators, Relax, Result,
    Sampling, Scheme, State, Wall, cfl, links, rectangle, seed,
};
use std::sync::Arc;

const DEGREE: usize = 2;

fn main() -> Result<()> {
    let mesh = rectangle([1.0, 1.0], [10, 10])?;
    let cells = mesh.cells.len();
    let cloud: Cloud = seed::seed(seed::Layout::Midpoints, DEGREE + 1, cells);
    let needs = Needs { degree: DEGREE, sampling: Some(Sampling::Cloud(&cloud)), curl_free: true, held: true };
    let operators = Operators::build(&mesh, &links(&mesh)?, &vec![0; cells], &needs)?;

    // The groups of a rectangle are left, right, bottom, top.
    let wall = || Arc::new(Wall { speed: None }) as Arc<dyn Boundary>;
    let boundaries = vec![wall(), Arc::new(Free), wall(), Arc::new(Free)];
    let steel = NeoHookean::new(2e11, 0.3, 7800.0);
    let (method, laws) = (Method::ader(DEGREE, DEGREE), vec![Law::from(steel)]);
    let scheme = Scheme::new(operators, laws, method, Flux::from(Dual), boundaries)?
        .with_curl(Control { relax: Relax::Rotation, rate: 3.0 * DEGREE as f64 })?;

    // F = 1 and p = rho0 v at every node: [cell][component][node] with F11, F12, F21, F22, p1, p2, u1, u2.
    let (nodes, components) = (scheme.operators.nodes(), scheme.flux.components());
    let at_node = [1.0, 0.0, 0.0, 1.0, 7800.0 * -100.0, 0.0, 0.0, 0.0];
    let of_cell = (0..components * nodes).map(|k| at_node[k / nodes]);
    let start: Vec<f64> = of_cell.collect::<Vec<_>>().repeat(cells);
    let state = State::pack(&scheme.operators.blocks, nodes, components, &start);

    let mut motion =
        Motion::new(&scheme, state).map_err(|loss| dgmpm::Error::input(format!("{loss:?}"), "another start"))?;
    let first = scheme.totals(&motion.state).energy();
    let courant = 0.9 * cfl::limit(&scheme.method, DEGREE);
    while motion.state.time < 1e-4 {
        let dt = courant * mesh.smallest_h() / motion.survey.fastest;
        motion.advance(&scheme, dt).map_err(|loss| dgmpm::Error::input(format!("{loss:?}"), "a smaller step"))?;
    }
    let last = scheme.totals(&motion.state);
    println!("{} steps, energy {:.4} of the start, min J {:.3}", motion.state.step, last.energy() / first, last.min_j);
    Ok(())
}
