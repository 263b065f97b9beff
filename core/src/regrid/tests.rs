//! The transfer against what an L2 projection has to be.

use super::*;
use crate::mesh::rectangle;

const SCALE: [[f64; 8]; 1] = [[1.0; 8]];

/// A rectangle with its inner nodes moved: no cell is a parallelogram.
fn distorted(size: [f64; 2], cells: [usize; 2], amount: f64) -> Mesh {
    let mut mesh = rectangle(size, cells).unwrap();
    let h = [size[0] / cells[0] as f64, size[1] / cells[1] as f64];
    for (k, x) in mesh.nodes.iter_mut().enumerate() {
        if x[0] > 0.0 && x[0] < size[0] && x[1] > 0.0 && x[1] < size[1] {
            x[0] += amount * h[0] * (k as f64 * 1.7).sin();
            x[1] += amount * h[1] * (k as f64 * 2.9).cos();
        }
    }
    mesh.checked().unwrap()
}

/// Unknowns at the nodes from a function of X.
fn sampled(mesh: &Mesh, basis: &Lagrange, f: impl Fn([f64; 2]) -> [f64; 6]) -> Vec<f64> {
    let n = basis.len() * basis.len();
    let mut u = vec![0.0; mesh.cells.len() * 6 * n];
    for (cell, u) in u.chunks_exact_mut(6 * n).enumerate() {
        for a in 0..n {
            let values = f(map::position(&mesh.map(cell), basis.node_2d(a)));
            (0..6).for_each(|k| u[k * n + a] = values[k]);
        }
    }
    u
}

fn wavy(x: [f64; 2]) -> [f64; 6] {
    let s = |k: f64| (2.0 * x[0] + k * x[1] + k).sin();
    [1.0 + 0.1 * s(1.0), 0.1 * s(2.0), 0.1 * s(3.0), 1.0 + 0.1 * s(4.0), 100.0 * s(1.5), 50.0 * s(2.5)]
}

fn totals(mesh: &Mesh, basis: &Lagrange, u: &[f64]) -> ([f64; 6], f64) {
    let n = basis.len() * basis.len();
    let (mut sum, mut square) = ([0.0; 6], 0.0);
    for (cell, u) in u.chunks_exact(6 * n).enumerate() {
        for a in 0..n {
            let mass = mass(mesh, cell, basis, a);
            (0..6).for_each(|k| sum[k] += mass * u[k * n + a]);
            square += mass * (u[4 * n + a].powi(2) + u[5 * n + a].powi(2));
        }
    }
    (sum, square)
}

fn moved(old: &Mesh, new: &Mesh, basis: &Lagrange, u: &[f64]) -> Transfer {
    let material = [vec![0; old.cells.len()], vec![0; new.cells.len()]];
    let (from, to) = (Grid { mesh: old, material: &material[0] }, Grid { mesh: new, material: &material[1] });
    transfer(&from, &to, &Field { basis, components: 6, u, scale: &SCALE }).unwrap()
}

#[test]
fn totals_stay_and_squares_do_not_grow_between_all_kinds_of_grids() {
    let size = [1.0, 0.8];
    let meshes = [
        rectangle(size, [7, 5]).unwrap(),
        rectangle(size, [9, 4]).unwrap(),
        distorted(size, [6, 6], 0.2),
        distorted(size, [11, 7], 0.2),
    ];
    for degree in 0..=4 {
        let basis = Lagrange::new(degree);
        for (i, old) in meshes.iter().enumerate() {
            for (j, new) in meshes.iter().enumerate().filter(|(j, _)| *j != i) {
                let u = sampled(old, &basis, wavy);
                let out = moved(old, new, &basis, &u);
                assert_eq!((out.structured, out.uncovered), (i < 2 && j < 2, [0.0; 2]));
                let ((a, before), (b, after)) = (totals(old, &basis, &u), totals(new, &basis, &out.u));
                for k in 0..6 {
                    // Sums of some hundred numbers of the size of the unknowns.
                    let size = if k < 4 { 1.0 } else { 100.0 };
                    assert!((a[k] - b[k]).abs() < 1e-13 * size, "S{degree} {i} -> {j}, {k}: {:e}", a[k] - b[k]);
                }
                let growth = after / before - 1.0;
                println!("S{degree} {i} -> {j}: growth {growth:.2e}, error {:.2e}", out.error);
                assert!(growth < 1e-12, "S{degree} {i} -> {j}: {growth:e}");
            }
        }
    }
}

#[test]
fn polynomials_of_the_degree_come_over_exactly_on_parallelograms() {
    // Sheared and turned rectangles: Q_N in parent coordinates is not Q_N in X there; P_N is in both.
    let affine = |mut mesh: Mesh| {
        mesh.nodes.iter_mut().for_each(|x| *x = [0.8 * x[0] - 0.3 * x[1], 0.4 * x[0] + 0.9 * x[1]]);
        mesh
    };
    for degree in 1..=4 {
        let basis = Lagrange::new(degree);
        let poly = |x: [f64; 2]| std::array::from_fn(|k| (x[0] + 0.3 * k as f64 * x[1] + 0.1).powi(degree as i32));
        let (old, new) =
            (affine(rectangle([1.0, 1.0], [5, 4]).unwrap()), affine(rectangle([1.0, 1.0], [4, 7]).unwrap()));
        let out = moved(&old, &new, &basis, &sampled(&old, &basis, poly));
        let wanted = sampled(&new, &basis, poly);
        let gap = out.u.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Values up to (1 + .3 * 5 + .1)^4 ~ 50, some hundred roundings each.
        assert!(gap < 1e-12 && out.error < 1e-12 && !out.structured, "S{degree}: {gap:e} {:e}", out.error);
    }
}

#[test]
fn products_of_1d_matrices_and_clipping_agree() {
    let (old, new) = (rectangle([2.0, 1.0], [5, 6]).unwrap(), rectangle([2.0, 1.0], [7, 4]).unwrap());
    for degree in 0..=3 {
        let basis = Lagrange::new(degree);
        let u = sampled(&old, &basis, wavy);
        let out = moved(&old, &new, &basis, &u);
        let material = [vec![0; 30], vec![0; 28]];
        let (from, to) = (Grid { mesh: &old, material: &material[0] }, Grid { mesh: &new, material: &material[1] });
        let field = Field { basis: &basis, components: 6, u: &u, scale: &SCALE };
        let mut other = vec![0.0; out.u.len()];
        let shares = match degree {
            0 => general::project::<1>(&from, &to, &field, &out.same, &mut other),
            1 => general::project::<2>(&from, &to, &field, &out.same, &mut other),
            2 => general::project::<3>(&from, &to, &field, &out.same, &mut other),
            _ => general::project::<4>(&from, &to, &field, &out.same, &mut other),
        };
        let error = shares.unwrap().iter().map(|s| s.error).sum::<f64>().sqrt();
        let gap = out.u.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Momenta up to 100.
        assert!(out.structured && gap < 1e-11, "S{degree}: {gap:e}");
        assert!((error / out.error - 1.0).abs() < 1e-9, "{error:e} {:e}", out.error);
    }
}

#[test]
fn cells_that_start_at_another_corner_are_read_in_their_own_axes() {
    let (old, mut new) = (rectangle([1.0, 1.0], [4, 3]).unwrap(), rectangle([1.0, 1.0], [5, 5]).unwrap());
    let basis = Lagrange::new(2);
    let u = sampled(&old, &basis, wavy);
    let straight = moved(&old, &new, &basis, &u);
    for (cell, nodes) in new.cells.iter_mut().enumerate() {
        nodes.rotate_left(cell % 4);
    }
    let turned = moved(&old, &new, &basis, &u);
    assert!(straight.structured && turned.structured);
    let (a, b) = (totals(&new, &basis, &straight.u), totals(&new, &basis, &turned.u));
    assert!((a.1 - b.1).abs() < 1e-12 * a.1 && (straight.error - turned.error).abs() < 1e-12);
    // And back: the old grid is then the turned one.
    let back = [moved(&new, &old, &basis, &turned.u), {
        let plain = rectangle([1.0, 1.0], [5, 5]).unwrap();
        moved(&plain, &old, &basis, &straight.u)
    }];
    let gap = back[0].u.iter().zip(&back[1].u).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(gap < 1e-12, "{gap:e}");
}

#[test]
fn the_error_falls_with_the_order_of_the_space() {
    // The bound of the ratio is 2^(N+1) less 15 %; measured 4.0, 8.0, 16 and above.
    for degree in 1..=3 {
        let basis = Lagrange::new(degree);
        let error = |k: usize| {
            let (old, new) =
                (distorted([1.0, 1.0], [6 * k, 6 * k], 0.15), rectangle([1.0, 1.0], [7 * k, 5 * k]).unwrap());
            moved(&old, &new, &basis, &sampled(&old, &basis, wavy)).error
        };
        let ratio = error(1) / error(2);
        println!("S{degree}: {ratio:.2}");
        assert!(ratio > 0.85 * 2f64.powi(degree as i32 + 1), "S{degree}: {ratio}");
    }
}

#[test]
fn equal_cells_are_copied_to_the_bit_and_the_others_are_not() {
    let (old, mut new) = (rectangle([1.0, 1.0], [4, 4]).unwrap(), rectangle([1.0, 1.0], [4, 4]).unwrap());
    new.nodes[6][0] += 0.05;
    let basis = Lagrange::new(2);
    let u = sampled(&old, &basis, wavy);
    let out = moved(&old, &new, &basis, &u);
    for cell in 0..16 {
        let changed = new.cells[cell].contains(&6);
        assert_eq!(out.same[cell], (!changed).then_some(cell));
        if !changed {
            assert_eq!(out.u[54 * cell..54 * (cell + 1)], u[54 * cell..54 * (cell + 1)]);
        }
    }
    assert_eq!(out.same.iter().flatten().count(), 12);
}

/// A square whose right side is an arc, meshed by its chords.
fn bulged(cells: usize) -> Mesh {
    let mut mesh = rectangle([1.0, 1.0], [cells, cells]).unwrap();
    mesh.nodes.iter_mut().for_each(|x| x[0] *= 1.0 + 0.2 * (1.0 - (2.0 * x[1] - 1.0).powi(2)));
    mesh
}

#[test]
fn where_grids_do_not_cover_the_same_region_means_and_momentum_are_restored() {
    let (old, new) = (bulged(5), bulged(8));
    let basis = Lagrange::new(2);
    let u = sampled(&old, &basis, wavy);
    let out = moved(&old, &new, &basis, &u);
    // Chords of the arc: 8 against 5.
    assert!(out.uncovered[0] > 1e-3 && out.uncovered[0] < 5e-3, "{:?}", out.uncovered);
    let ((a, _), (b, _)) = (totals(&old, &basis, &u), totals(&new, &basis, &out.u));
    let area = |mesh: &Mesh| (0..mesh.cells.len()).map(|c| map::area(&mesh.map(c))).sum::<f64>();
    for k in 0..6 {
        let factor = if k < 4 { area(&old) / area(&new) } else { 1.0 };
        assert!((a[k] - factor * b[k]).abs() < 1e-12 * if k < 4 { 1.0 } else { 100.0 });
    }
    // The polynomial goes on: a linear field stays linear up to what its restored mean adds, of the size of the slivers.
    let linear = |x: [f64; 2]| [1.0, x[0], x[1], 1.0 + x[0], x[0], x[0] - x[1]];
    let out = moved(&old, &new, &basis, &sampled(&old, &basis, linear));
    let wanted = sampled(&new, &basis, linear);
    let gap = out.u.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(gap < 5e-3, "{gap}");
    assert!(out.u.iter().zip(&wanted).take(54).all(|(a, b)| (a - b).abs() < 5e-3));
}

#[test]
fn another_body_is_refused_with_both_areas() {
    let (old, new) = (rectangle([1.0, 1.0], [4, 4]).unwrap(), rectangle([1.2, 1.0], [4, 4]).unwrap());
    let basis = Lagrange::new(1);
    let material = vec![0; 16];
    let (from, to) = (Grid { mesh: &old, material: &material }, Grid { mesh: &new, material: &material });
    let u = sampled(&old, &basis, wavy);
    let message =
        transfer(&from, &to, &Field { basis: &basis, components: 6, u: &u, scale: &SCALE }).unwrap_err().to_string();
    assert!(message.contains("2.000e-1 m^2 of it lie outside"), "{message}");
}

#[test]
fn a_cell_takes_nothing_from_another_material() {
    // Two materials, whose border x = 1/2 is a line of both grids.
    let (old, new) = (rectangle([1.0, 1.0], [4, 4]).unwrap(), rectangle([1.0, 1.0], [6, 5]).unwrap());
    let half = |mesh: &Mesh| -> Vec<usize> {
        (0..mesh.cells.len()).map(|c| usize::from(map::position(&mesh.map(c), [0.5; 2])[0] > 0.5)).collect()
    };
    let (a, b) = (half(&old), half(&new));
    let basis = Lagrange::new(2);
    let u = sampled(&old, &basis, |x| if x[0] < 0.5 { [1.0; 6] } else { [7.0; 6] });
    let scale = [[1.0; 8]; 2];
    let (from, to) = (Grid { mesh: &old, material: &a }, Grid { mesh: &new, material: &b });
    let field = Field { basis: &basis, components: 6, u: &u, scale: &scale };
    let out = transfer(&from, &to, &field).unwrap();
    for (cell, u) in out.u.chunks_exact(54).enumerate() {
        let wanted = if b[cell] == 0 { 1.0 } else { 7.0 };
        assert!(u.iter().all(|u| (u - wanted).abs() < 1e-13));
    }
    // One material instead: there is nothing to take for the other.
    let field = Field { u: &u, ..field };
    let one = vec![0; 16];
    let error = transfer(&Grid { mesh: &old, material: &one }, &to, &field).unwrap_err().to_string();
    assert!(error.contains("has a material that the old grid lacks"), "{error}");
}

/// A rectangle of cells of 9 nodes whose edges and middles are curved by some percent of a cell, the outer ones too if `outer`.
fn bulging(size: [f64; 2], cells: [usize; 2], outer: bool) -> Mesh {
    let mut mesh = rectangle(size, cells).unwrap();
    let h = size[0] / cells[0] as f64;
    let by = |k: usize| [0.06 * h * (k as f64 * 1.7).sin(), 0.06 * h * (k as f64 * 2.9).cos()];
    let links = crate::mesh::links(&mesh).unwrap();
    let bulge = |cell: usize| -> map::Bulge {
        std::array::from_fn(|face| {
            if face == 4 {
                return by(cell);
            }
            let [a, b] = mesh.face_nodes(cell, face);
            let is_inner = links[cell][face].cell().is_some();
            if is_inner || outer { by(a * b + a + b) } else { [0.0; 2] }
        })
    };
    let bulges = (0..mesh.cells.len()).map(bulge).collect();
    mesh.bulges = bulges;
    mesh.checked().unwrap()
}

#[test]
fn curved_grids_keep_uniform_states_and_totals() {
    let size = [1.0, 0.8];
    let grids = [
        bulging(size, [4, 4], false),
        bulging(size, [5, 3], false),
        bulging(size, [4, 4], false).refined(2),
        distorted(size, [4, 3], 0.2),
        bulging(size, [4, 4], true),
    ];
    let uniform = |_: [f64; 2]| [1.1, 0.2, -0.1, 0.9, 30.0, -20.0];
    for degree in 1..=3 {
        let basis = Lagrange::new(degree);
        for (i, old) in grids.iter().enumerate() {
            for (j, new) in grids.iter().enumerate() {
                let u = sampled(old, &basis, uniform);
                let moved_to = moved(old, new, &basis, &u);
                // Bodies of one area: all states stay. The last grid is another body by its curved outline: p changes with its area.
                let most = if (i == 4) == (j == 4) { 6 } else { 4 };
                let wanted = sampled(new, &basis, uniform);
                let n = basis.len() * basis.len();
                let off = |(k, (a, b)): (usize, (&f64, &f64))| if k / n % 6 < most { (a - b).abs() } else { 0.0 };
                let off = moved_to.u.iter().zip(&wanted).enumerate().map(off).fold(0.0, f64::max);
                // Rounding of numbers up to 30, and of sums over some hundred pieces.
                assert!(off < 1e-11, "S{degree}, {i} to {j}: {off:e}");
                let before = totals(old, &basis, &sampled(old, &basis, wavy));
                let after = totals(new, &basis, &moved(old, new, &basis, &sampled(old, &basis, wavy)).u);
                for k in 4..6 {
                    // Rounding of totals of size 100.
                    assert!(
                        (before.0[k] - after.0[k]).abs() < 1e-11,
                        "S{degree}, {i} to {j}: {:?} {:?}",
                        before.0,
                        after.0
                    );
                }
            }
        }
    }
}

#[test]
fn parts_of_a_curved_cell_get_its_polynomial() {
    let old = bulging([1.0, 0.8], [4, 4], true);
    let new = old.refined(2);
    let basis = Lagrange::new(2);
    let u = sampled(&old, &basis, wavy);
    let fine = moved(&old, &new, &basis, &u).u;
    let n = basis.len() * basis.len();
    let (mut worst, mut largest) = (0.0f64, 0.0f64);
    for (cell, values) in fine.chunks_exact(6 * n).enumerate() {
        let (whole, part) = (cell / 4, cell % 4);
        for a in 0..n {
            let xi = basis.node_2d(a);
            let weights = basis.values_2d([((part % 2) as f64 + xi[0]) / 2.0, ((part / 2) as f64 + xi[1]) / 2.0]);
            for k in 4..6 {
                let exact: f64 = (0..n).map(|b| weights[b] * u[(6 * whole + k) * n + b]).sum();
                worst = worst.max((values[k * n + a] - exact).abs());
                largest = largest.max(exact.abs());
            }
        }
    }
    // Chords of parts lie beside those of the whole by 6 % of a quarter of a cell; there the polynomial of the neighbour is taken, which
    // differs by some percent: measured below.
    assert!(worst < 2e-2 * largest, "{worst:e} of {largest:e}");
}

#[test]
fn a_curved_body_is_not_the_polygon_of_its_corners_where_their_areas_differ() {
    let polygon = rectangle([1.0, 1.0], [1, 1]).unwrap();
    // 2/3 of chord times bulge at four sides: .133 of the area.
    let out = [[-0.05, 0.0], [0.05, 0.0], [0.0, -0.05], [0.0, 0.05], [0.0; 2]];
    let round = Mesh { bulges: vec![out], ..polygon.clone() };
    let basis = Lagrange::new(1);
    let (from, to) = (Grid { mesh: &round, material: &[0] }, Grid { mesh: &polygon, material: &[0] });
    let why = transfer(&from, &to, &Field { basis: &basis, components: 6, u: &[1.0; 24], scale: &SCALE }).unwrap_err();
    assert!(why.to_string().contains("with its curved edges its area is 1.000e0 m^2"), "{why}");
}
