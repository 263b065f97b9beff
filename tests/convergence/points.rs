//! Clouds that ignore the grid, as a scene's layouts make them, and those with cells that cannot carry the degree.

use dgmpm::parts::cloud::{Cloud, Layout, Locator, Pattern, body, from_points, seed};
use dgmpm::parts::mesh::{Mesh, map};
use dgmpm::parts::operators::{Carried, Limits, Line, carry};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A family of clouds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Points {
    /// (N+3)^2 anywhere in each cell.
    Random,
    /// (N+2)^2 in the mean, at a distance from each other, whatever the cells.
    PoissonDisk,
    /// (N+3)^2 in each cell around four centres.
    Cluster,
    /// A lattice with (N+2)^2 in the mean, turned by 30 degrees against the grid.
    Rotated,
    /// (N+1)^2 jittered ones, but one cell in eight is empty, and one in eight has a single point.
    Deficient,
    /// A lattice through the nodes of the grid, with N + 1 points on each edge: all cells share points, and corners.
    Edges,
}

pub const ALL: [Points; 6] =
    [Points::Random, Points::PoissonDisk, Points::Cluster, Points::Rotated, Points::Deficient, Points::Edges];

impl Points {
    /// The cloud as given.
    pub fn cloud(self, mesh: &Mesh, degree: usize) -> Cloud {
        let (k, cells) = (degree + 2, mesh.cells.len());
        let all = vec![true; cells];
        let spacing = body::mean_spacing(mesh, &all, k);
        match self {
            Points::Random => seed(Layout::Random { seed: 1 }, k + 1, cells),
            Points::Cluster => seed(Layout::Cluster { seed: 1, clusters: 4, radius: 0.2 }, k + 1, cells),
            Points::PoissonDisk => Pattern::PoissonDisk { seed: 1, spacing: Pattern::DISK * spacing }.seed(mesh, &all),
            Points::Rotated => Pattern::Rotated { angle: 30.0, spacing }.seed(mesh, &all),
            Points::Deficient => {
                let whole = seed(Layout::Jitter { seed: 1, amount: 0.2 }, degree + 1, cells);
                Cloud::of_cells(cells, |cell, xi| match fate(cell) {
                    0 => {}
                    1 => xi.push(whole.of(cell)[0]),
                    _ => xi.extend_from_slice(whole.of(cell)),
                })
            }
            Points::Edges => {
                let at = |i: usize| i as f64 / (degree + 1) as f64;
                let lattice = || (0..=degree + 1).flat_map(|i| (0..=degree + 1).map(move |j| [at(i), at(j)]));
                // Each point once: those of an edge or corner come from all cells around it, up to rounding.
                let mut points: Vec<[f64; 2]> =
                    (0..cells).flat_map(|c| lattice().map(move |xi| map::position(&mesh.map(c), xi))).collect();
                let same = |x: &[f64; 2]| x.map(|x| (x * 1e9).round() as i64);
                points.sort_by_key(same);
                points.dedup_by_key(|x| same(x));
                from_points(mesh, &Locator::new(mesh), &points).unwrap().0
            }
        }
    }

    /// The cloud that the scheme samples on.
    pub fn carried(self, mesh: &Mesh, degree: usize) -> Carried {
        carry(mesh, &Line::new(degree), &self.cloud(mesh, degree), &Limits::of_degree(degree), &[]).unwrap()
    }
}

/// 0 or 1 for one cell in eight each.
fn fate(cell: usize) -> u64 {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    random.set_stream(cell as u64);
    random.next_u64() >> 61
}
