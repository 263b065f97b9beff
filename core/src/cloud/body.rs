//! Seeding of a whole body that ignores the cells: some cells get many points, some cells at the edge get none.

use std::collections::HashMap;

use rand_chacha::rand_core::Rng;

use super::seed::{stream, uniform};
use super::{Cloud, Locator, locate};
use crate::mesh::{Mesh, map};

/// The arrangement of the points in a body.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// Random points that are at least `spacing` apart, as dense as possible: candidates come in a random order, and each
    /// candidate with enough room is taken.
    PoissonDisk {
        /// Seed of the generator.
        seed: u64,
        /// Least distance, m.
        spacing: f64,
    },
    /// A square lattice about the middle of the body's extent.
    Rotated {
        /// Angle from the x axis to that of the lattice, degrees.
        angle: f64,
        /// Distance of neighbours, m.
        spacing: f64,
    },
}

/// Candidates of a Poisson disk pattern for each point of a square lattice of spacing 1.25 times the least distance. On 60 x 60
/// squares 10 leave .89 points for one of the lattice, 20 leave .95, 40 leave .99.
const CANDIDATES: f64 = 20.0;

impl Pattern {
    /// Least distance of a Poisson disk pattern over the spacing of a lattice with about as many points.
    pub const DISK: f64 = 0.8;

    /// The points in the cells that are `member`s. All other cells have no points.
    pub fn seed(self, mesh: &Mesh, member: &[bool]) -> Cloud {
        match self {
            Pattern::PoissonDisk { seed, spacing } => poisson_disk(mesh, member, seed, spacing),
            Pattern::Rotated { angle, spacing } => rotated(mesh, member, angle, spacing),
        }
    }
}

/// The spacing of a square lattice with k^2 points in the mean of some cells, m.
pub fn mean_spacing(mesh: &Mesh, member: &[bool], k: usize) -> f64 {
    let cells = || (0..mesh.cells.len()).filter(|&cell| member[cell]);
    let area: f64 = cells().map(|cell| map::area(&mesh.map(cell))).sum();
    (area / cells().count().max(1) as f64).sqrt() / k as f64
}

fn rotated(mesh: &Mesh, member: &[bool], angle: f64, spacing: f64) -> Cloud {
    let (sine, cosine) = angle.to_radians().sin_cos();
    let corners = || (0..mesh.cells.len()).filter(|&cell| member[cell]).flat_map(|cell| map::hull(&mesh.map(cell)));
    let [low, high] =
        [f64::min, f64::max].map(|pick| corners().reduce(|a, b| [0, 1].map(|i| pick(a[i], b[i]))).unwrap_or_default());
    let middle = [0, 1].map(|i| 0.5 * (low[i] + high[i]));
    // Half the diagonal of the extent: whatever the angle, the lattice covers it.
    let reach = (0.5 * (high[0] - low[0]).hypot(high[1] - low[1]) / spacing).ceil() as i64;
    let inside = |x: &[f64; 2]| (0..2).all(|i| low[i] <= x[i] && x[i] <= high[i]);
    let at = |(i, j): (i64, i64)| {
        let [a, b] = [i, j].map(|i| (i as f64 + 0.5) * spacing);
        [middle[0] + cosine * a - sine * b, middle[1] + sine * a + cosine * b]
    };
    let points: Vec<[f64; 2]> =
        (-reach..reach).flat_map(|i| (-reach..reach).map(move |j| (i, j))).map(at).filter(inside).collect();
    let found = locate::find_all(&Locator::new(mesh), &points);
    locate::sorted(mesh.cells.len(), found.into_iter().map(|found| found.filter(|(cell, _)| member[*cell]))).0
}

/// A candidate: a point that is taken if it has enough room.
struct Candidate {
    priority: u64,
    cell: usize,
    xi: [f64; 2],
}

fn poisson_disk(mesh: &Mesh, member: &[bool], seed: u64, spacing: f64) -> Cloud {
    let mut candidates: Vec<Candidate> = (0..mesh.cells.len())
        .filter(|&cell| member[cell])
        .flat_map(|cell| candidates(mesh, cell, seed, spacing))
        .collect();
    candidates.sort_unstable_by_key(|c| (c.priority, c.cell));
    // Squares with the spacing as their diagonal hold one point at most.
    let size = spacing / 2f64.sqrt();
    let square = |x: [f64; 2]| x.map(|x| (x / size).floor() as i64);
    let mut taken: HashMap<[i64; 2], [f64; 2]> = HashMap::new();
    let mut accepted: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        let x = map::position(&mesh.map(candidate.cell), candidate.xi);
        let [i, j] = square(x);
        // Its own square first: for most candidates a point is already there.
        let shifts = [0, -1, 1, -2, 2];
        let around = shifts.into_iter().flat_map(|di| shifts.map(|dj| [i + di, j + dj]));
        let near = |other: &[f64; 2]| (x[0] - other[0]).hypot(x[1] - other[1]) < spacing;
        if !around.filter_map(|square| taken.get(&square)).any(near) {
            taken.insert([i, j], x);
            accepted.push(candidate);
        }
    }
    locate::sorted(mesh.cells.len(), accepted.into_iter().map(|c| Some((c.cell, c.xi)))).0
}

/// Candidates of a cell, even over its area.
fn candidates(mesh: &Mesh, cell: usize, seed: u64, spacing: f64) -> impl Iterator<Item = Candidate> {
    let map = mesh.map(cell);
    let density = |xi| map::determinant(&map::jacobian(&map, xi));
    // J is linear along both parent directions of a straight cell: largest at a corner.
    let mut densest = map::CORNER_XI.into_iter().map(density).fold(0.0, f64::max);
    if map.bulge.is_some() {
        let samples = (0..9).flat_map(|i| (0..9).map(move |j| [i, j].map(|k| f64::from(k) / 8.0)));
        // Of degree 3: between the samples it is larger by some percent.
        densest = 1.1 * samples.map(density).fold(densest, f64::max);
    }
    let count = (CANDIDATES * map::area(&map) * (Pattern::DISK / spacing).powi(2)).ceil() as usize;
    let mut random = stream(seed, cell);
    let mut draw = move || loop {
        let xi = [0; 2].map(|_| uniform(&mut random));
        if uniform(&mut random) * densest < density(xi) {
            return Candidate { priority: random.next_u64(), cell, xi };
        }
    };
    (0..count).map(move |_| draw()).collect::<Vec<_>>().into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    fn positions(mesh: &Mesh, cloud: &Cloud) -> Vec<[f64; 2]> {
        let of = |cell: usize| cloud.of(cell).iter().map(move |&xi| map::position(&mesh.map(cell), xi));
        (0..mesh.cells.len()).flat_map(of).collect()
    }

    fn all(mesh: &Mesh) -> Vec<bool> {
        vec![true; mesh.cells.len()]
    }

    /// Distance to the nearest other point.
    fn gaps(points: &[[f64; 2]]) -> Vec<f64> {
        let gap = |(p, x): (usize, &[f64; 2])| {
            let others = points.iter().enumerate().filter(|(q, _)| *q != p);
            others.map(|(_, y)| (x[0] - y[0]).hypot(x[1] - y[1])).fold(f64::INFINITY, f64::min)
        };
        points.iter().enumerate().map(gap).collect()
    }

    #[test]
    fn a_poisson_disk_pattern_keeps_its_distance_across_cells_and_leaves_no_hole() {
        let mut mesh = rectangle([3.0, 2.0], [6, 4]).unwrap();
        // An inner node far from its place: cells of different areas and shapes.
        mesh.nodes[9] = [1.2, 0.35];
        let spacing = Pattern::DISK * mean_spacing(&mesh, &all(&mesh), 3);
        let cloud = Pattern::PoissonDisk { seed: 1, spacing }.seed(&mesh, &all(&mesh));
        let gaps = gaps(&positions(&mesh, &cloud));
        assert!(gaps.iter().all(|gap| *gap >= spacing * (1.0 - 1e-9)));
        // A point without another within twice the distance would have room for one between them.
        assert!(gaps.iter().all(|gap| *gap < 2.0 * spacing));
        // As many as a lattice of 3 x 3 a cell has, within 10 % (216 points, their number varies little).
        assert!((cloud.len() as f64 / 216.0 - 1.0).abs() < 0.1, "{}", cloud.len());
        assert_ne!(cloud, Pattern::PoissonDisk { seed: 2, spacing }.seed(&mesh, &all(&mesh)));
    }

    #[test]
    fn a_rotated_lattice_is_one_and_fills_the_body_but_for_its_edge() {
        let mesh = rectangle([3.0, 2.0], [6, 4]).unwrap();
        for angle in [0.0, 30.0, 45.0, 77.0] {
            let spacing = mean_spacing(&mesh, &all(&mesh), 3);
            let cloud = Pattern::Rotated { angle, spacing }.seed(&mesh, &all(&mesh));
            // The area of the body over the area of a point, without a strip of half a spacing at the edge: 10 / (1/6) / 2 points.
            assert!((cloud.len() as f64 - 216.0).abs() < 30.0, "{}", cloud.len());
            // Positions are held to 2^-41 of a cell of .5.
            assert!(gaps(&positions(&mesh, &cloud)).iter().all(|gap| (gap - spacing).abs() < 1e-12));
        }
    }

    #[test]
    fn patterns_stay_in_the_cells_that_they_are_for() {
        let mesh = rectangle([3.0, 2.0], [6, 4]).unwrap();
        let member: Vec<bool> = (0..24).map(|cell| cell % 6 < 3).collect();
        for pattern in [Pattern::Rotated { angle: 20.0, spacing: 0.1 }, Pattern::PoissonDisk { seed: 1, spacing: 0.1 }]
        {
            let cloud = pattern.seed(&mesh, &member);
            assert!((0..24).all(|cell| cloud.of(cell).is_empty() != member[cell]));
        }
    }

    #[test]
    fn coarse_lattices_leave_cells_empty() {
        let mesh = rectangle([3.0, 2.0], [6, 4]).unwrap();
        let cloud = Pattern::Rotated { angle: 30.0, spacing: 0.9 }.seed(&mesh, &all(&mesh));
        assert!((0..24).any(|cell| cloud.of(cell).is_empty()) && !cloud.is_empty());
    }
}
