//! Cells with curved edges of degree 2.

use crate::clouds::{distance, noisy, walk};
use crate::meshes::Grid;
use crate::problem::manufactured;
use crate::solve::{JITTER, Kind, MIDPOINTS, alone, scheme};
use crate::table::{Row, hold};

/// Cells per direction for S1 to S4.
const CELLS: [&[usize]; 4] = [&[16, 32], &[8, 16], &[6, 12], &[6, 12]];

/// Q_N of a curved cell holds the polynomials of X only up to terms that fall as h^(N+1) where the mesh is the smooth image of squares: the
/// order is that of straight cells.
#[test]
fn smooth_curved_meshes_keep_the_order_of_every_method() {
    let mut rows = Vec::new();
    // Degree 4 on one kind: it takes as long as all others together. (All kinds were within .25 of 5 when it was tried.)
    for (kind, most) in [(Kind::Rk, 3), (Kind::Fem, 3), (MIDPOINTS, 4), (JITTER, 3)] {
        for degree in 1..=most {
            rows.push(Row::new(Grid::Curved, kind, degree, CELLS[degree - 1]));
        }
    }
    hold(&rows);
}

/// The free stream: on cells curved in any way a uniform state stays, since the quadrature sees exact metric terms
/// (core/src/operators/curved.rs).
#[test]
fn any_curved_cells_keep_a_uniform_state() {
    let problem = manufactured(1.0, 3.0);
    let base = [1.1, 0.2, -0.1, 0.9, 0.3, -0.2];
    let mesh = Grid::Bulging.mesh(8);
    assert_eq!(mesh.curved_cells(), 64);
    for kind in [Kind::Rk, Kind::Fem, MIDPOINTS, JITTER] {
        for degree in 1..=4 {
            let scheme = scheme(&problem, &mesh, kind, degree, degree).with_sources(vec![]);
            let mut state = noisy(&problem, &mesh, &scheme, base, 0.0);
            alone(|| walk(&scheme, degree, &mut state, 1.0 / 8.0, 50, |_, _| {}));
            let off = distance(&problem, &scheme, &state, base);
            println!("uniform state on curved cells, {kind} S{degree}: {off:.1e}");
            // A step makes eps times the sum of |D| dt/h, which is of size 1: some 1e-15 after 50 steps of any sign.
            assert!(off < 1e-13, "{kind} S{degree}: {off:e}");
        }
    }
}
