//! The bilinear map of a cell, xi in [0, 1]^2 -> X, and its inverse.
//!
//! X(xi) = X0 + (X1 - X0) xi1 + (X3 - X0) xi2 + (X0 - X1 + X2 - X3) xi1 xi2, corners as in [`super::Mesh`].

/// Corners of a cell, in m.
pub type Corners = [[f64; 2]; 4];

/// Parent coordinates of the corners.
pub const CORNER_XI: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// X(xi), in m; exactly the corner at a corner.
pub fn position(corners: &Corners, xi: [f64; 2]) -> [f64; 2] {
    let [a, b] = xi;
    let weights = [(1.0 - a) * (1.0 - b), a * (1.0 - b), a * b, (1.0 - a) * b];
    [0, 1].map(|i| (0..4).map(|k| weights[k] * corners[k][i]).sum())
}

/// The Jacobian matrix `j[alpha][beta]` = dX_alpha / dxi_beta, in m.
pub fn jacobian(corners: &Corners, xi: [f64; 2]) -> [[f64; 2]; 2] {
    let [x0, x1, x2, x3] = corners;
    [0, 1].map(|i| {
        [
            (1.0 - xi[1]) * (x1[i] - x0[i]) + xi[1] * (x2[i] - x3[i]),
            (1.0 - xi[0]) * (x3[i] - x0[i]) + xi[0] * (x2[i] - x1[i]),
        ]
    })
}

/// The determinant of a 2 x 2 matrix.
pub fn determinant(m: &[[f64; 2]; 2]) -> f64 {
    m[0][0] * m[1][1] - m[0][1] * m[1][0]
}

/// The inverse of a 2 x 2 matrix. The inverse of [`jacobian`] is `k[beta][alpha]` = dxi_beta / dX_alpha.
pub fn inverse(m: &[[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let det = determinant(m);
    [[m[1][1] / det, -m[0][1] / det], [-m[1][0] / det, m[0][0] / det]]
}

/// The parent coordinates of a point, by Newton's method with step halving from the middle of the cell.
///
/// They lie outside [0, 1]^2 where the point lies outside the cell. `None` where the iteration finds no solution:
/// for a convex cell this happens only to points outside (beyond the fold of the map).
pub fn parent(corners: &Corners, x: [f64; 2]) -> Option<[f64; 2]> {
    // Relative to a corner, so that cells far from the origin lose no digits.
    let origin = corners[0];
    let shift = |x: [f64; 2]| [x[0] - origin[0], x[1] - origin[1]];
    let (corners, x) = (&corners.map(shift), shift(x));
    let gap = |xi: [f64; 2]| {
        let at = position(corners, xi);
        [x[0] - at[0], x[1] - at[1]]
    };
    let (mut xi, mut rest) = ([0.5, 0.5], gap([0.5, 0.5]));
    let mut norm = rest[0].hypot(rest[1]);
    // Quadratic convergence: 4 to 6 steps for ordinary cells; 50 is the limit for the thinnest cells.
    for _ in 0..50 {
        let k = inverse(&jacobian(corners, xi));
        let step = [k[0][0] * rest[0] + k[0][1] * rest[1], k[1][0] * rest[0] + k[1][1] * rest[1]];
        if !(step[0].is_finite() && step[1].is_finite()) {
            return None;
        }
        if step[0].abs().max(step[1].abs()) < 1e-14 {
            return Some([xi[0] + step[0], xi[1] + step[1]]);
        }
        let mut scale = 1.0;
        (xi, rest, norm) = loop {
            let next = [xi[0] + scale * step[0], xi[1] + scale * step[1]];
            let next_rest = gap(next);
            let next_norm = next_rest[0].hypot(next_rest[1]);
            if next_norm < norm {
                break (next, next_rest, next_norm);
            }
            scale *= 0.5;
            // No descent: either the result is exact to rounding (the step is tiny), or the point has no image nearby.
            if scale < 1e-3 {
                return (step[0].abs().max(step[1].abs()) < 1e-9).then_some(xi);
            }
        };
    }
    None
}

/// The length h_e of a cell: min over its 4 corners of 2 det(dX/dxi) / (|X_xi1| + |X_xi2|), in m.
///
/// It is h on squares and 2 hx hy / (hx + hy) on rectangles; the time step, `cfl` and the curl control use it.
pub fn h_e(corners: &Corners) -> f64 {
    let at = |xi| {
        let j = jacobian(corners, xi);
        2.0 * determinant(&j) / (j[0][0].hypot(j[1][0]) + j[0][1].hypot(j[1][1]))
    };
    CORNER_XI.into_iter().map(at).fold(f64::INFINITY, f64::min)
}

/// The area of a cell, in m^2; negative where its corners run clockwise.
pub fn area(corners: &Corners) -> f64 {
    let [x0, x1, x2, x3] = corners;
    0.5 * ((x2[0] - x0[0]) * (x3[1] - x1[1]) - (x3[0] - x1[0]) * (x2[1] - x0[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TRAPEZOID: Corners = [[1.0, 2.0], [2.5, 1.9], [2.2, 3.1], [1.1, 2.8]];

    #[test]
    fn corners_are_reached_exactly() {
        for k in 0..4 {
            assert_eq!(position(&TRAPEZOID, CORNER_XI[k]), TRAPEZOID[k]);
        }
    }

    #[test]
    fn jacobian_is_the_derivative_of_position() {
        let (xi, e) = ([0.3, 0.8], 1e-6);
        let j = jacobian(&TRAPEZOID, xi);
        for beta in 0..2 {
            let (mut up, mut down) = (xi, xi);
            up[beta] += e;
            down[beta] -= e;
            let (up, down) = (position(&TRAPEZOID, up), position(&TRAPEZOID, down));
            for alpha in 0..2 {
                // Central differences of a bilinear map are exact; rounding is 1e-16 / 1e-6.
                assert!((j[alpha][beta] - (up[alpha] - down[alpha]) / (2.0 * e)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn inverse_times_matrix_is_one() {
        let m = [[2.0, -0.5], [1.5, 3.0]];
        let k = inverse(&m);
        for (i, row) in k.iter().enumerate() {
            let product = [row[0] * m[0][0] + row[1] * m[1][0], row[0] * m[0][1] + row[1] * m[1][1]];
            assert!((product[i] - 1.0).abs() < 1e-15 && product[1 - i].abs() < 1e-15);
        }
    }

    #[test]
    fn h_e_is_h_on_squares_and_the_harmonic_mean_on_rectangles() {
        let rectangle = |w: f64, h: f64| [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]];
        assert_eq!(h_e(&rectangle(0.25, 0.25)), 0.25);
        // 2 hx hy / (hx + hy) = 2 * 3 * 1 / 4
        assert_eq!(h_e(&rectangle(3.0, 1.0)), 1.5);
        assert_eq!(area(&rectangle(3.0, 1.0)), 3.0);
    }

    #[test]
    fn h_e_of_a_distorted_cell_is_that_of_its_worst_corner() {
        // Corner 0: edges (1, .2) and (-1, .2), det .4, so 2 * .4 / (2 sqrt(1.04)) = .392; corner 1: edges (-1, .8) and
        // (-1, -.2), det 1, so 2 / (sqrt(1.64) + sqrt(1.04)) = .869; corner 2: det 1.6, 1.249.
        let kite = [[0.0, 0.0], [1.0, 0.2], [0.0, 1.0], [-1.0, 0.2]];
        assert!((h_e(&kite) - 0.4 / 1.04f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn area_is_that_of_the_integrated_determinant() {
        let (x, w) = crate::quadrature::gauss_legendre(2);
        let mut sum = 0.0;
        for i in 0..2 {
            for k in 0..2 {
                sum += w[i] * w[k] * determinant(&jacobian(&TRAPEZOID, [x[i], x[k]]));
            }
        }
        assert!((area(&TRAPEZOID) - sum).abs() < 1e-15);
    }

    /// Convex cells: one corner on each of four arms of a cross, which is convex whatever the lengths, then moved and scaled.
    fn convex() -> impl Strategy<Value = Corners> {
        (prop::array::uniform4(0.05..1.0f64), 0.0..6.3f64, -3.0..3.0f64, -10.0..10.0f64).prop_map(
            |(arm, turn, scale, shift)| {
                std::array::from_fn(|k| {
                    let angle = turn + k as f64 * std::f64::consts::FRAC_PI_2;
                    let s = 10f64.powf(scale);
                    [s * (arm[k] * angle.cos() + shift), s * (arm[k] * angle.sin() - shift)]
                })
            },
        )
    }

    proptest! {
        #[test]
        fn parent_inverts_position_inside_any_convex_cell(cell in convex(), a in 0.0..=1.0f64, b in 0.0..=1.0f64) {
            let found = parent(&cell, position(&cell, [a, b]));
            prop_assert!(found.is_some());
            let [c, d] = found.unwrap();
            // Positions up to 20 cell sizes away are rounded to 2e-15 of the size; the map's inverse is up to
            // 1 / sin(angle) ~ 400 times worse at the sharpest corner of these cells.
            prop_assert!((a - c).abs().max((b - d).abs()) < 1e-11, "{:?}", (c - a, d - b));
        }

        #[test]
        fn parent_of_any_point_is_a_solution_or_none(cell in convex(), x in -20.0..20.0f64, y in -20.0..20.0f64) {
            if let Some(xi) = parent(&cell, [x, y]) {
                let at = position(&cell, xi);
                let size = xi[0].abs().max(xi[1].abs()).max(1.0) * (1e4 + x.abs() + y.abs());
                prop_assert!((at[0] - x).hypot(at[1] - y) < 1e-9 * size);
            }
        }
    }
}
