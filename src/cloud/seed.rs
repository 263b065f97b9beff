//! Seeding: the same lattice of k x k points in every cell, or a jittered one.
//!
//! Points of a cell are ordered with xi1 slowest: point `p = i k + j` has the i-th fraction in xi1, the j-th in xi2.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::Cloud;
use crate::quadrature::gauss_legendre;

/// Where the points of a cell lie, as fractions of its parent square in each direction.
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
        /// Seed of the generator; each cell has its own stream, so that numbers do not depend on the order of cells.
        seed: u64,
        /// Largest move in units of 1/k, 0 to 1/2 (beyond, points are held inside the cell).
        amount: f64,
    },
}

impl Layout {
    /// The `amount` of a jitter that does not name one.
    pub const JITTER: f64 = 0.2;

    /// The k fractions per direction, ascending (those of the lattice before it is moved, for a jitter).
    pub fn fractions(self, k: usize) -> Vec<f64> {
        let n = k as f64;
        match self {
            Layout::Paper if k == 2 => vec![0.25, 0.75],
            Layout::Paper if k == 3 => vec![0.25, 0.5, 0.75],
            Layout::Paper => (1..=k).map(|i| i as f64 / (n + 1.0)).collect(),
            Layout::Midpoints | Layout::Jitter { .. } => (0..k).map(|i| (i as f64 + 0.5) / n).collect(),
            Layout::Gauss => gauss_legendre(k).0,
        }
    }

    /// The k x k points of a cell.
    pub fn points(self, k: usize, cell: usize) -> Vec<[f64; 2]> {
        let at = self.fractions(k);
        let mut points: Vec<[f64; 2]> = at.iter().flat_map(|&a| at.iter().map(move |&b| [a, b])).collect();
        if let Layout::Jitter { seed, amount } = self {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(cell as u64);
            for x in points.iter_mut().flatten() {
                // 53 random bits: uniform in [0, 1), then in [-1, 1).
                let uniform = (random.next_u64() >> 11) as f64 * 2f64.powi(-53);
                *x = (*x + amount / k as f64 * (2.0 * uniform - 1.0)).clamp(0.0, 1.0);
            }
        }
        points
    }
}

/// The layout of a degree that names none: the paper's up to N = 2; midpoints above, where the paper's amplifies too
/// much at the faces (Lebesgue constant 124 against 17 for N = 3 on a square cell).
pub fn default_layout(degree: usize) -> Layout {
    if degree <= 2 { Layout::Paper } else { Layout::Midpoints }
}

/// `per_direction`^2 points in each of the cells 0..`cells`, all by one layout.
pub fn seed(layout: Layout, per_direction: usize, cells: usize) -> Cloud {
    seed_by(cells, |_| (layout, per_direction))
}

/// Points in the cells 0..`cells`, where `choice` gives each cell its layout and number per direction.
pub fn seed_by(cells: usize, choice: impl Fn(usize) -> (Layout, usize)) -> Cloud {
    let mut cloud = Cloud { first: vec![0], xi: Vec::new() };
    for cell in 0..cells {
        let (layout, per_direction) = choice(cell);
        cloud.xi.extend(layout.points(per_direction, cell));
        cloud.first.push(cloud.xi.len());
    }
    cloud
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
    fn a_jitter_beyond_one_half_stays_inside_the_cell() {
        let cloud = seed(Layout::Jitter { seed: 3, amount: 5.0 }, 3, 50);
        assert!(cloud.xi.iter().flatten().all(|x| (0.0..=1.0).contains(x)));
    }
}
