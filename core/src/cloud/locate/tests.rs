//! Points are found in the cells that they lie in, by the walk and by the hierarchy.

use super::*;
use crate::cloud::{Layout, seed};
use crate::mesh::rectangle;

/// A 7 x 5 rectangle with its inner nodes moved: all cells are distorted, none is concave.
fn distorted() -> Mesh {
    let mut mesh = rectangle([7.0, 5.0], [7, 5]).unwrap();
    for (k, x) in mesh.nodes.iter_mut().enumerate() {
        let inner = x[0] % 7.0 != 0.0 && x[1] % 5.0 != 0.0;
        if inner {
            x[0] += 0.3 * (k as f64 * 1.7).sin();
            x[1] += 0.3 * (k as f64 * 2.9).cos();
        }
    }
    mesh.checked().unwrap()
}

#[test]
fn trees_of_every_size_find_all_their_cells() {
    for n in 1..50 {
        let locator = Locator::new(&rectangle([n as f64, 1.0], [n, 1]).unwrap());
        assert!((0..n).all(|cell| locator.find([cell as f64 + 0.25, 0.5]).map(|f| f.0) == Some(cell)));
    }
    assert_eq!(Locator::new(&Mesh::default()).find([0.0, 0.0]), None);
}

#[test]
fn cells_whose_boxes_meet_a_box_are_all_found_and_no_others() {
    let mesh = distorted();
    let locator = Locator::new(&mesh);
    for [low, high] in
        [[[0.0, 0.0], [7.0, 5.0]], [[2.2, 1.1], [3.4, 1.3]], [[6.5, 4.9], [9.0, 9.0]], [[8.0, 1.0], [9.0, 2.0]]]
    {
        let mut found = Vec::new();
        locator.overlapping(low, high, &mut found);
        found.sort_unstable();
        let meets = |cell: &usize| {
            let corners = mesh.corners(*cell);
            (0..2).all(|i| corners.iter().any(|x| x[i] <= high[i]) && corners.iter().any(|x| x[i] >= low[i]))
        };
        assert_eq!(found, (0..mesh.cells.len()).filter(meets).collect::<Vec<_>>());
    }
}

#[test]
fn points_inside_cells_are_found_with_their_parent_coordinates() {
    let mesh = distorted();
    let locator = Locator::new(&mesh);
    let cloud = seed(Layout::Jitter { seed: 4, amount: 0.3 }, 4, mesh.cells.len());
    for cell in 0..mesh.cells.len() {
        for &xi in cloud.of(cell) {
            let (found, at) = locator.find(map::position(&mesh.map(cell), xi)).unwrap();
            // Newton ends at rounding, amplified by 1 / det of these cells, above 0.1.
            assert!(found == cell && (at[0] - xi[0]).abs().max((at[1] - xi[1]).abs()) < 1e-14);
        }
    }
}

#[test]
fn points_on_edges_and_corners_belong_to_the_lowest_cell_that_they_touch() {
    for mesh in [distorted(), rectangle([7.0, 5.0], [7, 5]).unwrap()] {
        let locator = Locator::new(&mesh);
        for cell in 0..mesh.cells.len() {
            for t in [0.0, 0.3, 0.5, 1.0] {
                for xi in [[0.0, t], [1.0, t], [t, 0.0], [t, 1.0]] {
                    let x = map::position(&mesh.map(cell), xi);
                    let touches = |&c: &usize| {
                        map::parent(&mesh.map(c), x)
                            .is_some_and(|xi| xi.iter().all(|xi| (-1e-9..=1.0 + 1e-9).contains(xi)))
                    };
                    let lowest = (0..mesh.cells.len()).find(touches);
                    assert_eq!(locator.find(x).map(|f| f.0), lowest, "{x:?}");
                }
            }
        }
    }
}

#[test]
fn the_outer_boundary_belongs_to_the_mesh_up_to_1e_12_and_not_beyond() {
    let locator = Locator::new(&rectangle([3.0, 3.0], [30, 30]).unwrap());
    assert_eq!(locator.find([3.0 + 0.5e-13, 3.0]), Some((899, [1.0, 1.0])));
    assert_eq!(locator.find([-0.5e-13, 0.05]).map(|f| f.0), Some(0));
    // Cells are 0.1 m wide: 1e-12 of that.
    assert_eq!(locator.find([3.0 + 1e-11, 1.5]), None);
    assert_eq!(locator.find([f64::NAN, 0.0]), None);
    assert_eq!(locator.find([f64::INFINITY, 0.0]), None);
}

/// A rectangle without the cells of its middle: not convex, with a hole.
fn frame() -> Mesh {
    let mut mesh = distorted();
    let keep = |cell: usize| !((2..5).contains(&(cell % 7)) && (1..4).contains(&(cell / 7)));
    let kept: Vec<usize> = (0..35).filter(|&cell| keep(cell)).collect();
    mesh.cells = kept.iter().map(|&cell| mesh.cells[cell]).collect();
    (mesh.cell_group, mesh.original) = (vec![0; kept.len()], vec![]);
    mesh.edges.clear();
    mesh
}

#[test]
fn the_walk_finds_what_the_hierarchy_finds_to_the_bit_from_any_cell() {
    for mesh in [distorted(), frame(), rectangle([7.0, 5.0], [7, 5]).unwrap()] {
        let locator = Locator::new(&mesh);
        let random = seed(Layout::Random { seed: 5 }, 20, 1);
        // Some lie outside, and in the hole.
        let mut points: Vec<_> = random.xi.iter().map(|x| [7.4 * x[0] - 0.2, 5.4 * x[1] - 0.2]).collect();
        for cell in 0..mesh.cells.len() {
            let edge = [[0.0, 0.0], [1.0, 0.37], [0.37, 1.0], [0.5, 0.0], [1.0, 1.0], [1e-11, 0.5]];
            points.extend(edge.map(|xi| map::position(&mesh.map(cell), xi)));
        }
        points.extend([[f64::NAN, 1.0], [f64::INFINITY, 1.0], [1e300, -1e300]]);
        let mut walked = 0;
        for (k, &x) in points.iter().enumerate() {
            let expected = locator.find(x);
            for from in [0, (k * 7) % mesh.cells.len(), mesh.cells.len() - 1, usize::MAX] {
                walked += usize::from(locator.walk.find(from, x, &[]).is_some());
                assert_eq!(locator.find_from(from, x), expected, "{x:?} from {from}");
            }
        }
        // Not by falling back to the hierarchy: of 400 points from three cells each most are walked to, or, around the
        // hole, nearly half (484).
        assert!(walked > 450, "{walked}");
    }
}

#[test]
fn points_on_edges_are_not_lost_far_from_the_origin() {
    let mut mesh = rectangle([1e-3, 1e-3], [10, 10]).unwrap();
    mesh.nodes.iter_mut().flatten().for_each(|x| *x += 1234.5678);
    let locator = Locator::new(&mesh);
    for cell in 0..100 {
        for t in [0.0, 0.123, 0.77, 1.0] {
            assert!(locator.find(map::position(&mesh.map(cell), [t, 1.0])).is_some());
            assert!(locator.find(map::position(&mesh.map(cell), [1.0, t])).is_some());
        }
    }
}

#[test]
fn a_seeded_cloud_shuffled_comes_back_from_its_positions() {
    let mesh = distorted();
    let cloud = seed(Layout::Midpoints, 3, mesh.cells.len());
    let mut points: Vec<[f64; 2]> = (0..mesh.cells.len())
        .flat_map(|c| cloud.of(c).iter().map(|&xi| map::position(&mesh.map(c), xi)).collect::<Vec<_>>())
        .collect();
    points.reverse();
    let (found, order) = from_points(&mesh, &Locator::new(&mesh), &points).unwrap();
    assert_eq!(found.first, cloud.first);
    // Points of a cell keep their order among each other, which is the reversed one here.
    for cell in 0..mesh.cells.len() {
        let mut xi = found.of(cell).to_vec();
        xi.reverse();
        for (a, b) in xi.iter().flatten().zip(cloud.of(cell).iter().flatten()) {
            // Half a step of 2^-40, and Newton's rounding amplified by 1 / det of these cells, above 0.1.
            assert!((a - b).abs() < 0.5 * 2f64.powi(-40) + 1e-14);
        }
    }
    let last = points.len() - 1;
    assert_eq!(order[..9], [8, 7, 6, 5, 4, 3, 2, 1, 0].map(|k| last - k));
}

#[test]
fn points_outside_are_counted_and_the_first_is_named() {
    let mesh = rectangle([1.0, 1.0], [2, 2]).unwrap();
    let points = [[0.5, 0.5], [1.5, 0.5], [0.1, 0.2], [0.5, f64::NAN]];
    let outside = from_points(&mesh, &Locator::new(&mesh), &points).unwrap_err();
    assert_eq!(outside, Outside { count: 2, first: 1, at: [1.5, 0.5], extent: [[0.0, 0.0], [1.0, 1.0]] });
    assert_eq!(crate::Error::from(outside).exit_code(), 2);
}
