//! From a snapshot to the data for other programs: the grid as high-order quadrilaterals, and the material points.

use super::{Field, Solution};
use crate::cloud::Cloud;
use crate::io::grid::{self, HighOrderGrid, Kind, PointCloud, lagrange_quad_nodes};
use crate::io::snapshot::Snapshot;
use crate::io::vtu;
use crate::mesh::{Mesh, map};
use crate::operators::Certificate;

/// The grid with its fields at the Lagrange nodes of each cell, discontinuous between cells. Stresses come from the
/// law, at the value of the polynomial F.
pub fn grid(mesh: &Mesh, solution: &Solution, fields: &[Field], positions: Positions) -> HighOrderGrid {
    let degree = solution.basis.len() - 1;
    let mut out = HighOrderGrid::of_mesh(mesh, degree);
    let nodes = lagrange_quad_nodes(degree);
    let weights: Vec<_> = nodes.iter().map(|&xi| (xi, solution.basis.values_2d(xi))).collect();
    let points = (0..mesh.cells.len()).flat_map(|cell| weights.iter().map(move |at| (cell, at)));
    let points: Vec<_> = points.map(|(cell, (xi, w))| (cell, solution.combine(cell, *xi, w))).collect();
    out.point_fields = fields.iter().map(|&field| values(field, solution, &points)).collect();
    if positions == Positions::Deformed {
        move_points(&mut out.points, &values(Field::Displacement, solution, &points));
    }
    out
}

/// Moves points by their displacement u: x = X + u, from the initial configuration to the present one.
fn move_points(points: &mut [[f64; 3]], displacement: &grid::Field) {
    let moved = points.iter_mut().zip(displacement.values.as_chunks::<3>().0);
    moved.for_each(|(x, u)| (0..3).for_each(|i| x[i] += u[i]));
}

/// Where points are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Positions {
    /// Where they were in the initial configuration, X.
    Initial,
    /// Where they are at the time, x = X + u. Without a displacement that is X.
    Deformed,
}

impl Positions {
    /// The words for files.
    pub fn words(self) -> &'static str {
        match self {
            Positions::Initial => "X, in the initial configuration",
            Positions::Deformed => vtu::DEFORMED,
        }
    }
}

/// The material points as vertices, with their fields and the number of their cell.
///
/// `virtual_points` marks the points that stand on Gauss nodes because the points of their cell cannot carry the
/// degree. Empty: none.
pub fn points(
    mesh: &Mesh,
    cloud: &Cloud,
    virtual_points: &[bool],
    solution: &Solution,
    fields: &[Field],
    positions: Positions,
) -> PointCloud {
    let place = |cell: usize| {
        let map = mesh.map(cell);
        cloud.of(cell).iter().map(move |&xi| map::position(&map, xi))
    };
    let mut places: Vec<_> = (0..mesh.cells.len()).flat_map(place).map(|[x, y]| [x, y, 0.0]).collect();
    if positions == Positions::Deformed {
        let displacement = point_fields(mesh, cloud, solution, &[Field::Displacement]);
        displacement.iter().for_each(|field| move_points(&mut places, field));
    }
    let mut all = point_fields(mesh, cloud, solution, fields);
    let cells = (0..mesh.cells.len()).flat_map(|cell| cloud.of(cell).iter().map(move |_| mesh.number(cell) as f64));
    all.push(grid::Field::new("cell", Kind::Scalar, cells.collect()));
    let is_virtual = |p: usize| f64::from(u8::from(virtual_points.get(p) == Some(&true)));
    all.push(grid::Field::new("virtual", Kind::Scalar, (0..cloud.len()).map(is_virtual).collect()));
    PointCloud { points: places, fields: all, about: String::new() }
}

/// Fields at the material points.
pub fn point_fields(mesh: &Mesh, cloud: &Cloud, solution: &Solution, fields: &[Field]) -> Vec<grid::Field> {
    let at: Vec<_> = (0..mesh.cells.len())
        .flat_map(|cell| cloud.of(cell).iter().map(move |&xi| (cell, solution.at(cell, xi))))
        .collect();
    fields.iter().map(|&field| values(field, solution, &at)).collect()
}

fn values(field: Field, solution: &Solution, points: &[(usize, super::Point)]) -> grid::Field {
    let mut values = Vec::with_capacity(points.len() * field.kind().components());
    points.iter().for_each(|(cell, point)| field.push_spatial(solution.law(*cell), point, &mut values));
    grid::Field::new(field.name(), field.kind(), values)
}

/// Cell fields: the certificate of each cell (what its points can carry; class 0 lattice, 1 dense, 2 deficient, 3
/// nodes; dt in s at the initial state), the number in the mesh file, the group from 0, and the law.
pub fn cell_fields(mesh: &Mesh, certificates: &[Certificate], material: &[usize]) -> Vec<grid::Field> {
    let scalar = |name: &str, value: &dyn Fn(usize) -> f64| {
        grid::Field::new(name, Kind::Scalar, (0..mesh.cells.len()).map(value).collect())
    };
    vec![
        scalar("cell", &|cell| mesh.number(cell) as f64),
        scalar("group", &|cell| mesh.cell_group[cell] as f64),
        scalar("material", &|cell| material[cell] as f64),
        scalar("points", &|cell| certificates[cell].points as f64),
        scalar("rank", &|cell| certificates[cell].rank as f64),
        scalar("condition", &|cell| certificates[cell].condition),
        scalar("face_lebesgue", &|cell| certificates[cell].lebesgue),
        scalar("h", &|cell| certificates[cell].h),
        scalar("class", &|cell| certificates[cell].class as usize as f64),
        scalar("dt", &|cell| certificates[cell].dt),
    ]
}

/// Cell fields of a run with a limiter or a rescue: `corrected`, 1 where a limiter or another correction changed the cell in the last step; `rescued`, in how
/// many steps the cell was stepped again at order 0.
pub fn treated_fields(snapshot: &Snapshot) -> Vec<grid::Field> {
    let all = [("corrected", &snapshot.corrected), ("rescued", &snapshot.rescued)].into_iter();
    let there = all.filter(|(_, values)| !values.is_empty());
    there.map(|(name, values)| grid::Field::new(name, Kind::Scalar, values.clone())).collect()
}
