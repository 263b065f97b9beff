//! Seeding cell by cell: the same lattice of k x k points in every cell, or random points in their parent squares.
//!
//! Points of a lattice are ordered with xi1 slowest: point `p = i k + j` has the i-th fraction in xi1, the j-th in xi2.
//! Each cell has its own stream of random numbers, so that the points do not depend on the order of the cells.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::Cloud;
use crate::quadrature::gauss_legendre;

/// The arrangement of the points in a cell, as fractions of its parent square in each direction.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// The paper's: {1/2}, {1/4, 3/4}, {1/4, 1/2, 3/4}, and {i/(k+1)} for k >= 4.
    Paper,
    /// {(i - 1/2) / k}: the points stand for equal parts of the cell.
    Midpoints,
    /// The k Gauss-Legendre points: ADER-DGMPM is then ADER-DGFEM to the last digit.
    Gauss,
    /// Midpoints, each moved in each direction by a random part of its share of the cell.
    Jitter {
        /// Seed of the generator.
        seed: u64,
        /// Largest move in units of 1/k, 0 to 1/2 (beyond, points are held inside the cell).
        amount: f64,
    },
    /// Random points in the parent square, independent of each other.
    Random {
        /// Seed of the generator.
        seed: u64,
    },
    /// Random points around random centres.
    Cluster {
        /// Seed of the generator.
        seed: u64,
        /// The number of centres in a cell. Its points belong to the centres in turn.
        clusters: usize,
        /// Largest distance from the centre in each parent direction (points are held inside the cell).
        radius: f64,
    },
}

impl Layout {
    /// The default of `amount` of a jitter.
    pub const JITTER: f64 = 0.2;
    /// The default of `clusters` of a cluster layout.
    pub const CLUSTERS: usize = 4;
    /// The default of `radius` of a cluster layout.
    pub const RADIUS: f64 = 0.2;

    /// The k fractions per direction, ascending. For a jitter they are those of the lattice before its points are
    /// moved; for layouts without a lattice they are the midpoints.
    pub fn fractions(self, k: usize) -> Vec<f64> {
        let n = k as f64;
        match self {
            Layout::Paper if k == 2 => vec![0.25, 0.75],
            Layout::Paper if k == 3 => vec![0.25, 0.5, 0.75],
            Layout::Paper => (1..=k).map(|i| i as f64 / (n + 1.0)).collect(),
            Layout::Midpoints | Layout::Jitter { .. } | Layout::Random { .. } | Layout::Cluster { .. } => {
                (0..k).map(|i| (i as f64 + 0.5) / n).collect()
            }
            Layout::Gauss => gauss_legendre(k).0,
        }
    }

    /// The k^2 points of a cell.
    pub fn points(self, k: usize, cell: usize) -> Vec<[f64; 2]> {
        let at = self.fractions(k);
        let mut points: Vec<[f64; 2]> = at.iter().flat_map(|&a| at.iter().map(move |&b| [a, b])).collect();
        match self {
            Layout::Paper | Layout::Midpoints | Layout::Gauss => {}
            Layout::Jitter { seed, amount } => {
                let mut random = stream(seed, cell);
                for x in points.iter_mut().flatten() {
                    *x = (*x + amount / k as f64 * (2.0 * uniform(&mut random) - 1.0)).clamp(0.0, 1.0);
                }
            }
            Layout::Random { seed } => {
                let mut random = stream(seed, cell);
                points.iter_mut().flatten().for_each(|x| *x = uniform(&mut random));
            }
            Layout::Cluster { seed, clusters, radius } => {
                let mut random = stream(seed, cell);
                let centres: Vec<_> = (0..clusters).map(|_| [0; 2].map(|_| uniform(&mut random))).collect();
                for (point, centre) in points.iter_mut().zip(centres.iter().cycle()) {
                    *point = centre.map(|x| (x + radius * (2.0 * uniform(&mut random) - 1.0)).clamp(0.0, 1.0));
                }
            }
        }
        points
    }
}

/// The random numbers of a cell.
pub(super) fn stream(seed: u64, cell: usize) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(cell as u64);
    random
}

/// 53 random bits: uniform in [0, 1).
pub(super) fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * 2f64.powi(-53)
}

/// The default layout of a degree: the paper's up to N = 2; midpoints above, because there the paper's layout amplifies
/// errors too much at the faces (Lebesgue constant 124 against 17 for N = 3 on a square cell).
pub fn default_layout(degree: usize) -> Layout {
    if degree <= 2 { Layout::Paper } else { Layout::Midpoints }
}

/// `per_direction`^2 points in each of the cells 0..`cells`, all by one layout.
pub fn seed(layout: Layout, per_direction: usize, cells: usize) -> Cloud {
    seed_by(cells, |_| (layout, per_direction))
}

/// Points in the cells 0..`cells`, where `choice` gives each cell its layout and number per direction.
pub fn seed_by(cells: usize, choice: impl Fn(usize) -> (Layout, usize)) -> Cloud {
    Cloud::of_cells(cells, |cell, xi| {
        let (layout, per_direction) = choice(cell);
        xi.extend(layout.points(per_direction, cell));
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_fractions_are_quarters_then_equal_spacings() {
        assert_eq!(Layout::Paper.fractions(1), [0.5]);
        assert_eq!(Layout::Paper.fractions(2), [0.25, 0.75]);
        assert_eq!(Layout::Paper.fractions(3), [0.25, 0.5, 0.75]);
        assert_eq!(Layout::Paper.fractions(4), [0.2, 0.4, 0.6, 0.8]);
        assert_eq!(Layout::Midpoints.fractions(2), [0.25, 0.75]);
        assert_eq!(Layout::Midpoints.fractions(5), [0.1, 0.3, 0.5, 0.7, 0.9]);
        assert_eq!(Layout::Gauss.fractions(3), gauss_legendre(3).0);
    }

    #[test]
    fn points_run_with_xi2_fastest() {
        let cloud = seed(Layout::Paper, 3, 4);
        assert_eq!(cloud.first, [0, 9, 18, 27, 36]);
        assert_eq!(cloud.of(2)[3], [0.5, 0.25]);
        assert_eq!(cloud.of(2)[1], [0.25, 0.5]);
        assert_eq!(cloud.of(0), cloud.of(3));
    }

    #[test]
    fn layouts_may_differ_from_cell_to_cell_even_to_none() {
        let cloud = seed_by(3, |cell| (Layout::Midpoints, cell));
        assert_eq!(cloud.first, [0, 0, 1, 5]);
        assert!(cloud.of(0).is_empty() && cloud.of(1) == [[0.5, 0.5]] && !cloud.is_empty());
    }

    #[test]
    fn the_default_is_the_papers_layout_up_to_degree_2() {
        assert_eq!([0, 2, 3].map(default_layout), [Layout::Paper, Layout::Paper, Layout::Midpoints]);
    }

    #[test]
    fn jitter_moves_each_point_by_at_most_its_amount_and_really_moves() {
        let (k, amount) = (3, Layout::JITTER);
        let cloud = seed(Layout::Jitter { seed: 1, amount }, k, 200);
        let still = Layout::Midpoints.points(k, 0);
        let moves: Vec<f64> = (0..200)
            .flat_map(|c| {
                cloud.of(c).iter().zip(&still).flat_map(|(x, y)| [x[0] - y[0], x[1] - y[1]]).collect::<Vec<_>>()
            })
            .map(|d| d * k as f64 / amount)
            .collect();
        // Rounding of the difference of numbers below 1.
        assert!(moves.iter().all(|m| m.abs() <= 1.0 + 1e-14));
        let (n, mean) = (moves.len() as f64, moves.iter().sum::<f64>() / moves.len() as f64);
        let variance = moves.iter().map(|m| m * m).sum::<f64>() / n;
        // Uniform in (-1, 1): mean 0, variance 1/3; five standard deviations of 3600 samples are .048 and .025.
        assert!(mean.abs() < 0.05 && (variance - 1.0 / 3.0).abs() < 0.03, "{mean} {variance}");
    }

    #[test]
    fn jitter_depends_on_seed_and_cell_and_on_nothing_else() {
        let jitter = |seed| Layout::Jitter { seed, amount: 0.2 };
        let (few, many) = (seed(jitter(1), 2, 5), seed_by(9, |c| (jitter(1), if c < 3 { 4 } else { 2 })));
        assert_eq!(few.of(4), many.of(4));
        assert_ne!(few.of(4), few.of(3));
        assert_ne!(few.of(4), seed(jitter(2), 2, 5).of(4));
    }

    #[test]
    fn random_points_and_clusters_depend_on_seed_and_cell_and_lie_where_they_should() {
        let random = |seed| Layout::Random { seed };
        let cloud = seed(random(1), 3, 400);
        assert_eq!(cloud.of(7), random(1).points(3, 7));
        assert_ne!(cloud.of(7), random(2).points(3, 7));
        assert_ne!(cloud.of(7), cloud.of(8));
        let mean = cloud.xi.iter().flatten().sum::<f64>() / (2 * cloud.len()) as f64;
        // Uniform in (0, 1): five standard deviations of the mean of 7200 samples are .017.
        assert!((mean - 0.5).abs() < 0.017 && cloud.xi.iter().flatten().all(|x| (0.0..1.0).contains(x)));
        let cluster = Layout::Cluster { seed: 1, clusters: 2, radius: 0.05 };
        for cell in 0..50 {
            let points = cluster.points(4, cell);
            // Every second point belongs to the same centre: none is farther from another than twice the radius.
            for (p, x) in points.iter().enumerate().skip(2) {
                let other = points[p % 2];
                assert!((0..2).all(|k| (x[k] - other[k]).abs() <= 0.1 + 1e-15), "{cell} {p}");
            }
            assert!(points.iter().flatten().all(|x| (0.0..=1.0).contains(x)) && points.len() == 16);
        }
    }

    #[test]
    fn a_jitter_beyond_one_half_stays_inside_the_cell() {
        let cloud = seed(Layout::Jitter { seed: 3, amount: 5.0 }, 3, 50);
        assert!(cloud.xi.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
    }
}
