//! The degree in time, apart from that in space.

use crate::meshes::Grid;
use crate::problem::manufactured;
use crate::solve::{Kind, MIDPOINTS, advanced, alone, scheme};
use crate::table::{Row, hold, last_rate, short};

#[test]
fn runge_kutta_of_time_degree_1_limits_the_order_of_s4_to_2() {
    // Steps proportional to h. From 8 cells on RK2 hides the error in space, 5 and 40 times smaller: measured 2.02.
    // (S3T1 comes there only beyond 16 cells: 3.23 from 8 to 16.)
    hold(&[Row { time_degree: 1, rate: [1.75, 2.25], ..Row::new(Grid::Squares, Kind::Rk, 4, &[8, 16]) }]);
}

#[test]
fn ader_of_time_degree_n_t_has_the_order_2_n_t_plus_1_in_time() {
    // The predictor is discontinuous Galerkin in time: N_T + 1 in between, but 2 N_T + 1 in the averages that the
    // corrector takes. Steps proportional to h; the coarse meshes leave the rates at 3.17, 3.16, 3.07, 4.83.
    for (kind, degree, time_degree) in [(MIDPOINTS, 3, 1), (Kind::Fem, 3, 1), (MIDPOINTS, 4, 1), (MIDPOINTS, 4, 2)] {
        let cells = [4, 8];
        let errors = cells.map(|n| time_error(kind, degree, time_degree, n));
        let rate = last_rate(&cells, &errors);
        println!("in time alone: {kind} S{degree}T{time_degree} {cells:?} {} rate {rate:.2}", short(&errors));
        let order = (2 * time_degree + 1) as f64;
        assert!((rate - order).abs() < 0.25, "{kind} S{degree}T{time_degree}: {rate:.2}");
    }
}

/// Root mean square over nodes and components of the difference to the run with N_T = N: the same mesh, points, steps.
fn time_error(kind: Kind, degree: usize, time_degree: usize, cells: usize) -> f64 {
    let (problem, mesh) = (manufactured(0.1, 3.0), Grid::Squares.mesh(cells));
    let end = |time_degree| {
        let scheme = scheme(&problem, &mesh, kind, degree, time_degree);
        let state = advanced(&problem, &mesh, &scheme).expect("the problem is smooth: no run loses stability");
        state.unpack(&scheme.operators.blocks, scheme.operators.nodes())
    };
    let (low, full) = alone(|| (end(time_degree), end(degree)));
    (low.iter().zip(&full).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / low.len() as f64).sqrt()
}
