//! Rates and errors of all methods on solutions that are known, as one table with one loop; through the library.
//! `cargo test --release --test convergence -- --nocapture` prints the table, with CPU seconds.

mod cloud_order;
mod meshes;
mod problem;
mod solve;
mod table;
mod time_order;
mod walls;

use dgmpm::material::{Law, LinearElastic};
use dgmpm::step::{Scheme, Survey, Work, cfl};
use meshes::Grid;
use problem::{Problem, manufactured};
use solve::{GAUSS, JITTER, KINDS, Kind, MIDPOINTS, MORE, PAPER, scheme, start};
use table::{Row, hold};

/// Cells per direction for S1 to S5 on squares: from where the rates of two pairs of meshes agree within .2 or better.
/// S3 falls at 3.65 from 4 to 8 cells and at 4.3 from 8 to 16 at t = .1; at t = .25 it is at 4.08.
const SQUARES: [&[usize]; 5] = [&[16, 32], &[8, 16], &[8, 16], &[6, 12], &[5, 10]];

/// The same for distorted meshes, S1 to S4.
const DISTORTED: [&[usize]; 4] = [&[16, 32], &[8, 16], &[8, 16], &[4, 8]];

#[test]
fn every_method_degree_and_layout_has_its_order_on_squares() {
    let mut rows = Vec::new();
    for kind in KINDS {
        for degree in 1..=5 {
            let mut row = Row::new(Grid::Squares, kind, degree, SQUARES[degree - 1]);
            if degree == 3 {
                row.problem.end = 0.25;
            }
            rows.push(row);
        }
    }
    hold(&rows);
}

#[test]
fn the_default_setting_has_the_errors_of_the_designs_prototype() {
    let rows = [
        (1, &[16, 32][..], &[3.48e-4, 8.54e-5][..]),
        // 2.75 from 8 to 16 cells, 2.89 from there on.
        (2, &[8, 16, 32], &[1.40e-4, 2.11e-5]),
        (3, &[8, 16], &[5.84e-6, 3.43e-7]),
        (4, &[4, 8], &[1.16e-5, 3.50e-7]),
    ];
    let row = |(degree, cells, known)| {
        // alpha = 3 at N = 4, too, as the prototype had it; the scene's default there is 6, for 12 % more error.
        Row { problem: manufactured(0.25, 3.0), known, ..Row::new(Grid::Squares, MIDPOINTS, degree, cells) }
    };
    hold(&rows.map(row));
}

#[test]
fn distorted_meshes_keep_the_order_of_every_method_and_layout() {
    // The mapped Q_N of a bilinear cell holds all P_N in X (and Q_N is P_N at least), so that the order of
    // approximation is that of squares; so are mass and stiffness exact. Gauss is ADER-DGFEM to the last digit.
    let mut rows = Vec::new();
    for grid in [Grid::Trapezoids, Grid::Random] {
        for kind in KINDS.into_iter().filter(|kind| *kind != GAUSS) {
            rows.extend((1..=4).map(|degree| Row::new(grid, kind, degree, DISTORTED[degree - 1])));
        }
    }
    hold(&rows);
}

#[test]
fn trapezoids_have_the_errors_of_the_designs_prototype() {
    let rows = [
        (1, &[4, 8, 16, 32][..], &[7.8e-3, 2.13e-3, 5.76e-4, 1.45e-4][..]),
        (2, &[4, 8, 16], &[1.61e-3, 2.39e-4, 3.05e-5]),
    ];
    hold(&rows.map(|(degree, cells, known)| Row { known, ..Row::new(Grid::Trapezoids, MIDPOINTS, degree, cells) }));
}

#[test]
fn for_a_linear_law_dgmpm_on_any_cloud_is_dgfem() {
    let law = Law::Linear(LinearElastic::new(1.0, 0.3, 1.0));
    let problem = Problem { law, ..manufactured(1.0, 3.0) };
    let mesh = Grid::Squares.mesh(6);
    for degree in 1..=3 {
        let states = [Kind::Fem, PAPER, MIDPOINTS, JITTER, MORE].map(|kind| {
            let scheme = Scheme { sources: vec![], ..scheme(&problem, &mesh, kind, degree, degree) };
            let mut state = start(&problem, &mesh, &scheme);
            let (mut work, mut survey) = (Work::new(&scheme, &state), Survey::default());
            for _ in 0..200 {
                scheme.survey(&state, &work, &mut survey).unwrap();
                let dt = 0.85 * cfl::limit(&scheme.method, degree) / 6.0 / survey.fastest;
                scheme.step(&state, dt, &survey, &mut work);
                std::mem::swap(&mut state, &mut work.next);
            }
            state.unpack(&scheme.operators.blocks, scheme.operators.nodes())
        });
        let size = states[0].iter().map(|u| u * u).sum::<f64>().sqrt();
        for other in &states[1..] {
            let difference = states[0].iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            println!("linear S{degree}: {:.1e}", difference / size);
            // The figure: rounding times the Lebesgue constants of the clouds.
            assert!(difference < 1e-11 * size, "S{degree}: {:e}", difference / size);
        }
    }
}
