//! The points of groups of cells, to be searched for the nearest.

use super::Cloud;
use crate::mesh::{Mesh, map};
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Points by X, with their numbers.
pub type Tree = RTree<GeomWithData<[f64; 2], usize>>;

/// The points of each group of cells, of which `group` has the number; none for groups that are not asked for.
pub fn trees(mesh: &Mesh, cloud: &Cloud, group: &[usize], asked: &[bool]) -> Vec<Option<Tree>> {
    let mut points = vec![vec![]; asked.len()];
    for cell in (0..mesh.cells.len()).filter(|&cell| asked[group[cell]]) {
        let map = mesh.map(cell);
        let numbered = cloud.of(cell).iter().zip(cloud.first[cell]..);
        points[group[cell]].extend(numbered.map(|(&xi, p)| GeomWithData::new(map::position(&map, xi), p)));
    }
    points.into_iter().zip(asked).map(|(points, asked)| asked.then(|| RTree::bulk_load(points))).collect()
}
