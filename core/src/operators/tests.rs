//! Exact on polynomials, on distorted cells, for any cloud.
use super::sides::Across;
use super::*;
use crate::cloud::{Cloud, seed};
use crate::lane::LANES;
use crate::mesh::{self, links, map, rectangle};

/// A 3 x 3 mesh of the unit square whose inner nodes are moved by up to a fifth of a cell: no two cells congruent.
fn distorted() -> Mesh {
    let mut mesh = rectangle([1.0, 1.0], [3, 3]).unwrap();
    for (i, x) in mesh.nodes.iter_mut().enumerate() {
        let inside = x.iter().all(|x| *x > 0.0 && *x < 1.0);
        let angle = i as f64 * 2.4;
        if inside {
            *x = [x[0] + angle.cos() / 15.0, x[1] + angle.sin() / 15.0];
        }
    }
    mesh
}

fn build(mesh: &Mesh, degree: usize, cloud: &Cloud) -> Operators {
    let needs = Needs { degree, sampling: Some(Sampling::Cloud(cloud)), curl_free: true, held: true };
    Operators::build(mesh, &links(mesh).unwrap(), &vec![0; mesh.cells.len()], &needs).unwrap()
}

/// Entry of a lane of a matrix that may be shared.
fn entry(share: Share, shared: &[Matrix<f64>], own: &[Matrix<F8>], lane: usize, r: usize, c: usize) -> f64 {
    match share {
        Share::Shared(k) => shared[k].row(r)[c],
        Share::Own(k) => own[k].row(r)[c].0[lane],
    }
}

use crate::lane::F8;

#[test]
fn masses_sum_to_the_area_and_normals_close_each_cell() {
    let mesh = distorted();
    let operators = build(&mesh, 2, &seed::seed(seed::Layout::Gauss, 3, 9));
    let geometry = &operators.geometry;
    for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
        let mass: f64 = geometry.masses(&operators.line, block, lane).sum();
        let metric = geometry.blocks[block].lane(lane);
        // Exact quadrature: rounding of a sum of 9 numbers of size .01.
        assert!((mass - map::area(&mesh.map(cell))).abs() < 1e-16);
        for axis in 0..2 {
            let face = |f: usize| metric.normal(f)[axis] * metric.length(f);
            // The boundary of a cell is closed: four edges of size .3, each a product of six roundings.
            assert!((0..4).map(face).sum::<f64>().abs() < 4.0 * 6.0 * 0.3 * 1.2e-16);
        }
    }
}

#[test]
fn metric_terms_are_those_of_the_bilinear_map() {
    let mesh = distorted();
    let operators = build(&mesh, 2, &seed::seed(seed::Layout::Gauss, 3, 9));
    for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
        let (metric, corners) = (operators.geometry.blocks[block].lane(lane), mesh.corners(cell));
        for xi in [[0.0, 0.0], [1.0, 0.0], [0.3, 0.8], [1.0, 1.0]] {
            let (one, two) = (metric.cofactor1(xi[0]), metric.cofactor2(xi[1]));
            let jacobian = map::jacobian(&corners, xi);
            let j = map::determinant(&jacobian);
            let inverse = map::inverse(&jacobian);
            for a in 0..2 {
                // Differences of coordinates of size 1: a few roundings of 1e-16.
                assert!((one[a] - j * inverse[0][a]).abs() < 1e-15 && (two[a] - j * inverse[1][a]).abs() < 1e-15);
            }
            assert!((super::determinant(one, two) - j).abs() < 1e-15);
        }
        for face in 0..4 {
            let [a, b] = crate::mesh::FACE_CORNERS[face].map(|k| corners[k]);
            let (along, n) = ([b[0] - a[0], b[1] - a[1]], metric.normal(face));
            assert!((metric.length(face) - along[0].hypot(along[1])).abs() < 1e-15);
            assert!((n[0] * along[0] + n[1] * along[1]).abs() < 1e-15 && (n[0].hypot(n[1]) - 1.0).abs() < 4e-15);
            // Outward: away from the middle of the cell.
            let middle = map::position(&corners, [0.5, 0.5]);
            assert!(n[0] * (a[0] - middle[0]) + n[1] * (a[1] - middle[1]) > 0.0);
        }
        assert!((metric.h - map::h_e(&corners)).abs() < 1e-16);
    }
}

#[test]
fn transfer_and_slopes_are_exact_on_q_n_for_any_cloud() {
    let mesh = distorted();
    for degree in 1..=4 {
        let cloud = seed::seed(seed::Layout::Jitter { seed: 3, amount: 0.3 }, degree + 2, 9);
        let operators = build(&mesh, degree, &cloud);
        let points = operators.points.as_ref().unwrap();
        let power = degree as i32;
        let field = |xi: [f64; 2]| xi[0].powi(power) * xi[1].powi(power) - 0.3 * xi[0];
        let slope = |xi: [f64; 2]| {
            let along = |b: usize| power as f64 * xi[b].powi(power - 1) * xi[1 - b].powi(power);
            [along(0) - 0.3, along(1)]
        };
        for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
            let matrices = lane_of(points, block, lane);
            let PointMatrices::Dense { to_nodes, from_nodes, slope: along } = &matrices else { panic!("a lattice") };
            let apply = |m: &Matrix<f64>, rows: usize, input: &[f64]| -> Vec<f64> {
                (0..rows).map(|r| input.iter().enumerate().map(|(c, x)| m.row(r)[c] * x).sum()).collect()
            };
            let at_points: Vec<f64> = cloud.of(cell).iter().map(|&xi| field(xi)).collect();
            let at_nodes: Vec<f64> = operators.line.nodes().into_iter().map(field).collect();
            let (np, n) = (at_points.len(), at_nodes.len());
            // Rounding times the condition of the fit (below 1e3) and, for slopes, of the derivative (below 1e2).
            let close = |a: &[f64], b: &[f64], bound: f64| a.iter().zip(b).all(|(a, b)| (a - b).abs() < bound);
            assert!(close(&apply(to_nodes, n, &at_points), &at_nodes, 1e-12), "P2G {degree}");
            assert!(close(&apply(from_nodes, np, &at_nodes), &at_points, 1e-13), "G2P {degree}");
            // Where each lane has its own matrices the metric is in them. (The ninth cell is alone in its block, and so
            // shares its matrices with the copies of it that fill the block.)
            let alone = operators.blocks.count[block] == 1;
            assert_eq!(points.metric_of(block).is_empty(), !alone);
            for axis in 0..2 {
                let exact = cloud.of(cell).iter().map(|&xi| {
                    let inverse = map::inverse(&map::jacobian(&mesh.map(cell), xi));
                    let along = slope(xi)[0] * inverse[0][axis] + slope(xi)[1] * inverse[1][axis];
                    if alone { slope(xi)[axis] } else { along }
                });
                // dxi/dX is 3 to 6 here.
                let exact: Vec<f64> = exact.collect();
                assert!(close(&apply(&along[axis], np, &at_points), &exact, 6e-10), "slope {degree}");
            }
        }
    }
}

/// The matrices of one cell.
fn lane_of(points: &Points, block: usize, lane: usize) -> PointMatrices<f64> {
    match points.pool.share[block] {
        Share::Shared(k) => points.pool.shared[k].clone(),
        Share::Own(k) => points.pool.own[k].lane(lane),
    }
}

/// Largest difference of all entries of two sets of matrices of one kind.
fn difference(a: &PointMatrices<f64>, b: &PointMatrices<f64>) -> f64 {
    let (a, b) = (a.matrices(), b.matrices());
    assert_eq!(a.len(), b.len());
    let all = |list: &[&Matrix<f64>]| list.iter().flat_map(|m| m.data.clone()).collect::<Vec<f64>>();
    all(&a).iter().zip(all(&b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn lattices_are_found_by_their_coordinates_and_their_factors_multiply_to_the_dense_matrices() {
    for degree in 0..=5 {
        let line = Line::new(degree);
        for k in [degree + 1, degree + 2] {
            let mut xi = seed::Layout::Midpoints.points(k, 0);
            // Other coordinates along xi2 than along xi1.
            xi.iter_mut().for_each(|xi| xi[1] *= 0.9);
            let factors = PointMatrices::at_points(&line, &xi, 0).unwrap();
            assert_eq!(factors.kind(), (1, k));
            assert_eq!(factors.is_overdetermined(), k > degree + 1);
            // The same points with xi1 fastest: any cloud.
            let other = |p: usize| (p % k) * k + p / k;
            let crossed: Vec<[f64; 2]> = (0..k * k).map(|p| xi[other(p)]).collect();
            let dense = PointMatrices::at_points(&line, &crossed, 0).unwrap();
            // A single point is the same in any order.
            assert_eq!(dense.kind(), if k == 1 { (1, 1) } else { (0, k * k) });
            let back = |m: &Matrix<f64>, rows: bool, columns: bool| {
                let turn = |r: usize, yes: bool| if yes { other(r) } else { r };
                let entry = |e: usize| m.row(turn(e / m.columns, rows))[turn(e % m.columns, columns)];
                Matrix::new(m.rows, m.columns, (0..m.data.len()).map(entry).collect())
            };
            let PointMatrices::Dense { to_nodes, from_nodes, slope: [a, b] } = dense.to_dense() else { panic!() };
            let turned = PointMatrices::Dense {
                to_nodes: back(&to_nodes, false, true),
                from_nodes: back(&from_nodes, true, false),
                slope: [back(&a, true, true), back(&b, true, true)],
            };
            // Rounding times the condition of the fit, and up to 1e2 for derivatives of degree 5.
            let found = difference(&factors.to_dense(), &turned);
            assert!(found < 1e-11, "S{degree} {k}: {found:e}");
        }
    }
}

#[test]
fn a_lattice_from_a_file_is_one_to_2_pow_minus_40_and_not_beyond() {
    let line = Line::new(2);
    let kind = |shift: f64| {
        let mut xi = seed::Layout::Paper.points(3, 0);
        xi[4][0] += shift;
        PointMatrices::at_points(&line, &xi, 0).unwrap().kind()
    };
    assert_eq!(kind(2f64.powi(-41)), (1, 3));
    assert_eq!(kind(2f64.powi(-38)), (0, 9));
}

#[test]
fn affine_cells_hold_one_metric_and_bilinear_ones_one_a_point() {
    for (mesh, count) in [(rectangle([2.0, 1.0], [3, 3]).unwrap(), 1), (distorted(), 9)] {
        let operators = build(&mesh, 2, &seed::seed(seed::Layout::Paper, 3, 9));
        let points = operators.points.as_ref().unwrap();
        for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
            let metric = points.metric_of(block);
            // The block of the ninth cell alone, padded with copies of it, is affine where that cell is.
            assert!(metric.len() == 4 * count || operators.blocks.count[block] == 1, "{}", metric.len());
            let xi = seed::Layout::Paper.points(3, cell)[0];
            let inverse = map::inverse(&map::jacobian(&mesh.map(cell), xi));
            for (k, m) in metric[..4].iter().enumerate() {
                // Rounding of coordinates of size 1 over cells of size .3.
                assert!((m.0[lane] - inverse[k / 2][k % 2]).abs() < 1e-13, "{cell} {k}");
            }
        }
    }
}

#[test]
fn the_curl_free_complement_is_orthonormal_and_blind_to_gradients() {
    for (mesh, ranks) in [(rectangle([2.0, 1.0], [2, 2]).unwrap(), [5, 10, 17]), (distorted(), [6, 12, 20])] {
        for degree in 1..=3 {
            let cloud = seed::seed(seed::Layout::Midpoints, degree + 1, mesh.cells.len());
            let operators = build(&mesh, degree, &cloud);
            let (line, n) = (&operators.line, operators.nodes());
            let pool = CurlFree::matrices(&mesh, &operators.blocks, line);
            for (cell, &(block, lane)) in operators.blocks.slot.iter().enumerate() {
                let columns = match pool.share[block] {
                    Share::Shared(k) => pool.shared[k].columns,
                    Share::Own(k) => pool.own[k].columns,
                };
                assert_eq!(2 * n - columns, ranks[degree - 1], "degree {degree}");
                let c = |r: usize, k: usize| entry(pool.share[block], &pool.shared, &pool.own, lane, r, k);
                let masses: Vec<f64> = operators.geometry.masses(line, block, lane).collect();
                let mass = |r: usize| masses[r % n];
                let against = |field: &dyn Fn(usize, [f64; 2]) -> f64, k: usize| -> f64 {
                    (0..2 * n)
                        .map(|r| {
                            c(r, k) * mass(r) * field(r / n, map::position(&mesh.map(cell), line.basis.node_2d(r % n)))
                        })
                        .sum()
                };
                for k in 0..columns {
                    let norm: f64 = (0..2 * n).map(|r| c(r, k) * c(r, k) * mass(r)).sum();
                    // Columns of an orthogonal matrix of order 32: rounding of the decomposition.
                    assert!((norm - 1.0).abs() < 1e-13);
                    let power = degree as i32;
                    // The gradient of x^(N+1) + x^N y, and uniform F: weights sum to 1/mass ~ 10, so 1e-13 is rounding.
                    let gradient = |axis: usize, x: [f64; 2]| match axis {
                        0 => (power + 1) as f64 * x[0].powi(power) + power as f64 * x[0].powi(power - 1) * x[1],
                        _ => x[0].powi(power),
                    };
                    assert!(against(&gradient, k).abs() < 1e-13, "{degree} {:e}", against(&gradient, k));
                    assert!(against(&|axis, _| axis as f64 + 0.5, k).abs() < 1e-13);
                    // The mean of each row is kept: each column of C is orthogonal to uniform fields of each axis.
                    assert!(against(&|axis, _| if axis == 0 { 1.0 } else { 0.0 }, k).abs() < 1e-13);
                }
            }
        }
    }
}

#[test]
fn plans_of_faces_read_what_the_neighbours_say() {
    let mesh = rectangle([1.0, 1.0], [13, 11]).unwrap();
    let links = links(&mesh).unwrap();
    let blocks = Blocks::new(&vec![0; mesh.cells.len()], &links);
    let mut near = 0;
    for block in 0..blocks.len() {
        for face in 0..4 {
            for (lane, neighbour) in blocks.neighbours[block][face].iter().enumerate() {
                let across = match *neighbour {
                    Neighbour::Cell(across) | Neighbour::Interface(across, _) => across,
                    Neighbour::Boundary(_) | Neighbour::Padding => continue,
                };
                match blocks.plan[block][face].side {
                    Side::Aligned(there) => assert_eq!((across.face, across.lane, across.flip), (there, lane, false)),
                    Side::Joined { first, second, by } => {
                        let face = if lane + by < LANES { first } else { second };
                        assert_eq!(across, Across { face, lane: (lane + by) % LANES, flip: false });
                    }
                    Side::Gathered(entry) => assert_eq!(blocks.gathered[entry].across(lane), across),
                }
            }
            near += usize::from(!matches!(blocks.plan[block][face].side, Side::Gathered(_)));
        }
    }
    // Rows of 13 cells follow each other: all but the block that is padded and what lies beside it.
    assert!(near > 4 * (blocks.len() - 4), "{near} of {}", 4 * blocks.len());
    let mesh = rectangle([1.0, 1.0], [16, 8]).unwrap();
    let blocks = Blocks::new(&[0; 128], &mesh::links(&mesh).unwrap());
    let count = |is: fn(&Side) -> bool| blocks.plan.iter().flatten().filter(|plan| is(&plan.side)).count();
    assert_eq!(count(|side| matches!(side, Side::Aligned(_))), 2 * 16);
    assert_eq!(count(|side| matches!(side, Side::Joined { .. })), 2 * 16);
}

#[test]
fn blocks_keep_every_cell_once_and_neighbours_point_back() {
    let mesh = distorted();
    let links = links(&mesh).unwrap();
    let material = [0, 1, 0, 1, 1, 0, 0, 0, 1];
    let blocks = Blocks::new(&material, &links);
    let values: Vec<f64> = (0..18).map(f64::from).collect();
    assert_eq!(blocks.unpack(&blocks.pack(&values, 2, |_| -1.0), 2), values);
    assert_eq!(blocks.count.iter().sum::<usize>(), 9);
    for block in 0..blocks.len() {
        for face in 0..4 {
            for lane in 0..LANES {
                match blocks.neighbours[block][face][lane] {
                    Neighbour::Cell(across) | Neighbour::Interface(across, _) => {
                        let back = blocks.neighbours[across.face / 4][across.face % 4][across.lane];
                        let (Neighbour::Cell(back) | Neighbour::Interface(back, _)) = back else { panic!("one-sided") };
                        assert_eq!((back.face, back.lane, back.flip), (4 * block + face, lane, across.flip));
                    }
                    Neighbour::Boundary(_) => assert!(lane < blocks.count[block]),
                    Neighbour::Padding => assert!(lane >= blocks.count[block]),
                }
            }
        }
    }
}

#[test]
fn congruent_cells_share_matrices_and_a_cell_that_cannot_carry_q_n_is_named() {
    let mesh = rectangle([3.0, 3.0], [4, 4]).unwrap();
    let operators = build(&mesh, 2, &seed::seed(seed::Layout::Paper, 3, 16));
    assert_eq!(operators.points.as_ref().unwrap().pool.shared.len(), 1);
    assert_eq!(operators.points.as_ref().unwrap().pool.own.len(), 0);
    assert_eq!(operators.curl_free.as_ref().unwrap().pool.shared.len(), 1);
    let mut cloud = seed::seed(seed::Layout::Paper, 3, 16);
    cloud.xi[9 * 5 + 1] = cloud.xi[9 * 5];
    let needs = Needs { degree: 2, sampling: Some(Sampling::Cloud(&cloud)), curl_free: false, held: true };
    let error = Operators::build(&mesh, &links(&mesh).unwrap(), &[0; 16], &needs).unwrap_err().to_string();
    assert!(error.contains(&format!("cell {}", mesh.number(5))) && error.contains("rank 8"), "{error}");
}
