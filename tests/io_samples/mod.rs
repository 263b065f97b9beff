//! A small distorted mesh with its cloud, and fields on it whose numbers are hard to carry.
#![allow(dead_code)]

use dgmpm::parts::cloud::Cloud;
use dgmpm::parts::io::grid::{Field, HighOrderGrid, Kind, PointCloud, lagrange_quad_nodes};
use dgmpm::parts::io::snapshot::Snapshot;
use dgmpm::parts::mesh::{BoundaryEdge, Mesh};

/// Cells along x and y.
pub const SIZE: [usize; 2] = [4, 3];

/// A distorted mesh of 4 x 3 cells on [0, 2] x [0, 1.5], two materials, four sides.
pub fn mesh() -> Mesh {
    let [nx, ny] = SIZE;
    let node = |i: usize, j: usize| j * (nx + 1) + i;
    let mut mesh = Mesh {
        groups: vec!["steel".into(), "acier \"doux\" é".into()],
        edge_groups: ["left", "right", "bottom", "top"].map(String::from).to_vec(),
        ..Mesh::default()
    };
    for j in 0..=ny {
        for i in 0..=nx {
            let inside = i > 0 && i < nx && j > 0 && j < ny;
            let shift = if inside { 0.11 * ((3 * i + 5 * j) as f64).sin() } else { 0.0 };
            mesh.nodes.push([0.5 * i as f64 + shift, 0.5 * j as f64 - 0.7 * shift]);
        }
    }
    for j in 0..ny {
        for i in 0..nx {
            let cell = mesh.cells.len();
            mesh.cells.push([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
            mesh.cell_group.push(usize::from(i >= 2));
            mesh.original.push(100 + 3 * cell as u64);
            let sides = [(i == 0, 0), (i == nx - 1, 1), (j == 0, 2), (j == ny - 1, 3)];
            let edges = sides.iter().filter(|s| s.0).map(|&(_, f)| BoundaryEdge { cell, face: f, group: f });
            mesh.edges.extend(edges);
        }
    }
    mesh
}

/// A cloud with 1 to 3 points a cell (cell 0 has none).
pub fn cloud(mesh: &Mesh) -> Cloud {
    let mut cloud = Cloud { first: vec![0], xi: Vec::new() };
    for cell in 0..mesh.cells.len() {
        cloud.xi.extend((0..cell % 4).map(|k| [0.25 * k as f64, 1.0 / (3.0 + cell as f64)]));
        cloud.first.push(cloud.xi.len());
    }
    cloud
}

/// Numbers without pattern, in (-1, 1).
pub fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as i64 as f64 / i64::MAX as f64
    };
    (0..count).map(|_| next()).collect()
}

/// Numbers that text, 32 bits or sums would lose.
pub fn awkward(count: usize) -> Vec<f64> {
    let list = [0.1 + 0.2, -0.0, 5e-324, f64::MAX, -1.0 / 3.0, f64::INFINITY, f64::NAN, 1e-310, -9.23654948e9];
    list.iter().copied().cycle().take(count).collect()
}

/// A snapshot for the mesh.
pub fn snapshot(degree: usize) -> Snapshot {
    let nodes = SIZE[0] * SIZE[1] * (degree + 1).pow(2);
    Snapshot {
        time: 1.77e-3 / 3.0,
        step: 123,
        degree,
        u: awkward(6 * nodes),
        displacement: noise(2 * nodes, 7),
        internal: noise(35, 8),
        ..Snapshot::default()
    }
}

fn linear(points: &[[f64; 3]], time: f64) -> Field {
    let at = |p: &[f64; 3]| [1.0 + 2.0 * p[0] - p[1] + 1e4 * time, 3.0 * p[1] - p[0], 0.0];
    Field::new("velocity", Kind::Vector, points.iter().flat_map(at).collect())
}

/// The grid with its fields at a time: `velocity` is linear in X.
pub fn grid(mesh: &Mesh, degree: usize, time: f64) -> HighOrderGrid {
    let mut grid = HighOrderGrid::of_mesh(mesh, degree);
    let (points, cells) = (grid.points.len(), grid.cells());
    let seed = 1 + (time * 1e6) as u64;
    grid.point_fields = vec![
        linear(&grid.points, time),
        Field::new("cauchy_stress", Kind::Tensor, noise(9 * points, seed).iter().map(|v| 1e9 * v).collect()),
        Field::new("jacobian", Kind::Scalar, awkward(points)),
    ];
    grid.cell_fields = vec![
        Field::new("lebesgue", Kind::Scalar, noise(cells, seed + 1)),
        Field::new("centre", Kind::Vector, noise(3 * cells, seed + 2)),
    ];
    grid
}

/// Points with fields: 4 a cell at the corners of a smaller cell.
pub fn points(mesh: &Mesh, time: f64) -> PointCloud {
    let grid = HighOrderGrid::of_mesh(mesh, 3);
    let inside = |k: usize| k % 16 >= 12;
    let points: Vec<_> = (0..grid.points.len()).filter(|&k| inside(k)).map(|k| grid.points[k]).collect();
    assert_eq!(lagrange_quad_nodes(3).len(), 16);
    let count = points.len();
    let fields = vec![
        linear(&points, time),
        Field::new("piola", Kind::Tensor, noise(9 * count, 99)),
        Field::new("von_mises", Kind::Scalar, awkward(count)),
    ];
    PointCloud { points, fields, about: String::new() }
}
