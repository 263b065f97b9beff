//! The maps against their derivatives, their inverses and their integrals.

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

/// The trapezoid with curved edges, as a cell of 9 nodes.
const CURVED: CellMap =
    CellMap { corners: TRAPEZOID, bulge: Some([[-0.1, 0.02], [0.15, -0.05], [0.0, 0.1], [0.05, 0.12], [0.03, -0.04]]) };

#[test]
fn a_curved_cell_has_its_middles_where_the_map_has_them_and_its_bulge_comes_back_from_them_to_the_bit() {
    let at = middles(&CURVED);
    let xi = [[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0], [0.5, 0.5]];
    for (x, xi) in at.iter().zip(xi) {
        let map = position(&CURVED, xi);
        // Sums of some terms of size 3.
        assert!((x[0] - map[0]).hypot(x[1] - map[1]) < 2e-15, "{xi:?}");
    }
    let [a, b, c, d, own] = at;
    let again = bulge_of(&TRAPEZOID, [a, b, c, d], Some(own));
    let first = CellMap { bulge: again, ..CURVED };
    // What one reading has made stays.
    assert_eq!(middles(&first), at);
    let [a, b, c, d, own] = middles(&first);
    assert_eq!(bulge_of(&TRAPEZOID, [a, b, c, d], Some(own)), again);
    // Without a middle of its own it is the serendipity cell.
    assert_eq!(bulge_of(&TRAPEZOID, [a, b, c, d], None).unwrap()[4], [0.0; 2]);
}

#[test]
fn rounding_of_the_middles_of_straight_edges_is_no_curve() {
    let [a, b, c, d, own] = middles(&TRAPEZOID);
    let off = |x: [f64; 2]| [x[0] + 1e-13, x[1] - 1e-13];
    assert_eq!(bulge_of(&TRAPEZOID, [off(a), b, off(c), d], Some(off(own))), None);
    assert!(bulge_of(&TRAPEZOID, [[a[0] + 1e-9, a[1]], b, c, d], Some(own)).is_some());
}

#[test]
fn the_jacobian_of_a_curved_cell_is_the_derivative_of_its_position() {
    for (k, l) in (0..=4).flat_map(|k| (0..=4).map(move |l| (k, l))) {
        let (xi, e) = ([f64::from(k) / 4.0, f64::from(l) / 4.0], 1e-5);
        let j = jacobian(&CURVED, xi);
        for beta in 0..2 {
            let (mut up, mut down) = (xi, xi);
            up[beta] += e;
            down[beta] -= e;
            let (up, down) = (position(&CURVED, up), position(&CURVED, down));
            for alpha in 0..2 {
                // Central differences of a polynomial of degree 2 along each direction are exact; rounding is 1e-16 / 1e-5.
                assert!((j[alpha][beta] - (up[alpha] - down[alpha]) / (2.0 * e)).abs() < 1e-10);
            }
        }
    }
}

#[test]
fn the_area_of_a_curved_cell_is_that_of_its_determinant_and_its_hull_holds_it() {
    let (x, w) = crate::quadrature::gauss_legendre(3);
    let pairs = || (0..3).flat_map(|i| (0..3).map(move |k| (i, k)));
    let sum: f64 = pairs().map(|(i, k)| w[i] * w[k] * determinant(&jacobian(&CURVED, [x[i], x[k]]))).sum();
    // Of degree 3 in each direction: three points are exact.
    assert!((area(&CURVED) - sum).abs() < 1e-14, "{} {sum}", area(&CURVED));
    let of = |axis: usize, pick: fn(f64, f64) -> f64| hull(&CURVED).map(|x| x[axis]).reduce(pick).unwrap();
    for xi in (0..=8).flat_map(|k| (0..=8).map(move |l| [f64::from(k) / 8.0, f64::from(l) / 8.0])) {
        let x = position(&CURVED, xi);
        for (axis, x) in x.into_iter().enumerate() {
            assert!(of(axis, f64::min) <= x && x <= of(axis, f64::max), "{xi:?}");
        }
    }
}

#[test]
fn the_parent_coordinates_of_a_place_in_a_curved_cell_are_found() {
    for xi in (0..=8).flat_map(|k| (0..=8).map(move |l| [f64::from(k) / 8.0, f64::from(l) / 8.0])) {
        let [a, b] = parent(&CURVED, position(&CURVED, xi)).unwrap();
        // Newton ends below 1e-14; positions of size 3 are rounded to 4e-16.
        assert!((a - xi[0]).abs().max((b - xi[1]).abs()) < 1e-14, "{xi:?}");
    }
}

#[test]
fn the_outward_normals_of_a_curved_cell_close_and_have_the_length_of_its_edges() {
    // int n |dX/ds| ds around a cell is 0 (the free stream); two points are exact, since dX/ds is linear.
    let (s, w) = crate::quadrature::gauss_legendre(2);
    let mut sum = [0.0; 2];
    for face in 0..4 {
        for (s, w) in s.iter().zip(&w) {
            let (n, length) = outward(&CURVED, face, *s);
            (0..2).for_each(|k| sum[k] += w * length * n[k]);
        }
    }
    assert!(sum[0].hypot(sum[1]) < 1e-15, "{sum:?}");
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
