//! The matrices of the points of a cell: dense for any cloud; 1D factors if the points are a lattice (a regular K x K grid).

use super::{Line, Matrix};
use crate::basis::MovingLeastSquares;
use crate::basis::mls::LineFit;
use crate::error::Error;
use crate::lane::{Coefficient, F8, LANES, Lane, Lanes, Portable};

/// Coordinates that differ by less count as equal. Points from files are rounded to 2^-40 of the cell (`cloud::locate`).
const SAME: f64 = 1.0 / (1_u64 << 40) as f64;

/// Matrices of one class of clouds, in parent coordinates.
#[derive(Debug, Clone, PartialEq)]
pub enum PointMatrices<C> {
    /// Any cloud.
    Dense {
        /// P2G at the nodes: chi_p(xi_a), (N+1)^2 x N_p.
        to_nodes: Matrix<C>,
        /// G2P: Phi_a(xi_p), N_p x (N+1)^2.
        from_nodes: Matrix<C>,
        /// d chi_q / d xi_b (xi_p), N_p x N_p, b = 1, 2. (Where each cell of a block has its own, `Points` turns them
        /// to d chi_q / dX_b, 1/m, once.)
        slope: [Matrix<C>; 2],
    },
    /// K x K points `p = i K + j` at (x_i, y_j): factors along xi1, xi2, since constant-weight least squares on a lattice
    /// is the product of those on its lines. Transfers are products of two factors. So are derivatives, of `slope` and
    /// of the fit's value at its own points, which is 1 for K = N + 1 ([`PointMatrices::is_overdetermined`]).
    Lattice([Factor<C>; 2]),
    /// The Gauss nodes themselves, chi = Phi: nothing to transfer, l_k'(x_i), (N+1) x (N+1).
    Nodes(Matrix<C>),
}

/// The matrices of K points on a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor<C> {
    /// P2G, (N+1) x K.
    pub to_nodes: Matrix<C>,
    /// G2P, K x (N+1).
    pub from_nodes: Matrix<C>,
    /// Derivatives of chi at the points, K x K.
    pub slope: Matrix<C>,
}

impl<C: Coefficient> PointMatrices<C> {
    /// N_p, the number of points of a cell (of the cell with the most points in the block).
    pub fn points(&self) -> usize {
        match self {
            PointMatrices::Dense { from_nodes, .. } => from_nodes.rows,
            PointMatrices::Lattice([a, b]) => a.slope.rows * b.slope.rows,
            PointMatrices::Nodes(slope) => slope.rows * slope.rows,
        }
    }

    /// Whether a lattice has more points than Q_N has unknowns. Then a field has to be fitted (G2P after P2G) before it is
    /// differentiated by factors.
    pub fn is_overdetermined(&self) -> bool {
        match self {
            PointMatrices::Lattice([a, _]) => a.from_nodes.rows > a.from_nodes.columns,
            _ => false,
        }
    }

    /// sum_a m_a chi_p(X_a) of all points for numbers m_a at the nodes: with the mass matrix the integrals of the chi_p over
    /// each cell, exact and of either sign. They are 0 for points that only fill up a lane.
    pub fn integrals(&self, masses: &[F8]) -> Vec<F8> {
        let m = masses.len().isqrt();
        let of = |matrix: &Matrix<C>, a: usize, p: usize| matrix.data[a * matrix.columns + p].lanes::<Portable>();
        let chi = |a: usize, p: usize| match self {
            PointMatrices::Dense { to_nodes, .. } => of(to_nodes, a, p),
            PointMatrices::Lattice([first, second]) => {
                let k = second.to_nodes.columns;
                of(&first.to_nodes, a / m, p / k) * of(&second.to_nodes, a % m, p % k)
            }
            PointMatrices::Nodes(_) => Portable::splat(if a == p { 1.0 } else { 0.0 }),
        };
        let integral = |p: usize| {
            let mut out = F8::ZERO;
            let add = |sum: Portable, a: usize| Portable::load(&masses[a]).mul_add(chi(a, p), sum);
            (0..masses.len()).fold(Portable::zero(), add).store(&mut out);
            out
        };
        (0..self.points()).map(integral).collect()
    }

    /// All matrices in the order of storage.
    pub fn matrices(&self) -> Vec<&Matrix<C>> {
        match self {
            PointMatrices::Dense { to_nodes, from_nodes, slope: [a, b] } => vec![to_nodes, from_nodes, a, b],
            PointMatrices::Lattice(factors) => {
                factors.iter().flat_map(|f| [&f.to_nodes, &f.from_nodes, &f.slope]).collect()
            }
            PointMatrices::Nodes(slope) => vec![slope],
        }
    }

    /// Kind and count, which determine all shapes: 0 and N_p for any cloud, 1 and K for lattices, 2 and N + 1 for the nodes.
    pub fn kind(&self) -> (usize, usize) {
        match self {
            PointMatrices::Dense { from_nodes, .. } => (0, from_nodes.rows),
            PointMatrices::Lattice([a, _]) => (1, a.slope.rows),
            PointMatrices::Nodes(slope) => (2, slope.rows),
        }
    }

    /// Shapes of [`PointMatrices::matrices`] for a kind, a count and m nodes per direction; `None` for other kinds.
    pub fn shapes(kind: usize, count: usize, m: usize) -> Option<Vec<(usize, usize)>> {
        let n = m * m;
        match kind {
            0 => Some(vec![(n, count), (count, n), (count, count), (count, count)]),
            1 => Some([[(m, count), (count, m), (count, count)]; 2].concat()),
            2 if count == m => Some(vec![(m, m)]),
            _ => None,
        }
    }

    /// The inverse of [`PointMatrices::matrices`]; `None` if no kind has this number of matrices.
    pub fn from_list(list: Vec<Matrix<C>>) -> Option<Self> {
        let mut list = list.into_iter();
        let mut next = || list.next();
        Some(match (next(), next(), next(), next(), next(), next(), next()) {
            (Some(slope), None, ..) => PointMatrices::Nodes(slope),
            (Some(to_nodes), Some(from_nodes), Some(a), Some(b), None, ..) => {
                PointMatrices::Dense { to_nodes, from_nodes, slope: [a, b] }
            }
            (Some(t1), Some(f1), Some(s1), Some(t2), Some(f2), Some(s2), None) => PointMatrices::Lattice([
                Factor { to_nodes: t1, from_nodes: f1, slope: s1 },
                Factor { to_nodes: t2, from_nodes: f2, slope: s2 },
            ]),
            _ => return None,
        })
    }
}

impl PointMatrices<f64> {
    /// The Gauss nodes as points.
    pub fn at_nodes(line: &Line) -> Self {
        PointMatrices::Nodes(Matrix::new(line.m, line.m, line.slope.clone()))
    }

    /// Moving least squares on any points that determine a polynomial of Q_N.
    ///
    /// # Errors
    /// A cloud that cannot carry Q_N, with the remedy.
    pub fn at_points(line: &Line, xi: &[[f64; 2]], number: u64) -> Result<Self, Error> {
        match factors(line, xi) {
            Some(factors) => Ok(PointMatrices::Lattice(factors)),
            None => dense(line, xi, number),
        }
    }

    /// Whether the points of a cell are a lattice that carries Q_N.
    pub fn is_lattice(line: &Line, xi: &[[f64; 2]]) -> bool {
        factors(line, xi).is_some()
    }

    /// The same as dense matrices.
    pub fn to_dense(&self) -> Self {
        let identity = |m: usize| Matrix::new(m, m, (0..m * m).map(|e| f64::from(u8::from(e / m == e % m))).collect());
        match self {
            PointMatrices::Dense { .. } => self.clone(),
            PointMatrices::Lattice([a, b]) => expand(a, b),
            PointMatrices::Nodes(slope) => {
                let one = identity(slope.rows);
                let line = Factor { to_nodes: one.clone(), from_nodes: one, slope: slope.clone() };
                expand(&line, &line)
            }
        }
    }

    /// Eight different cells side by side. If all are lattices of one size they keep their factors. Otherwise all are
    /// dense, and cells with fewer points than the largest cell get copies of their first point, which no fit uses
    /// (zero columns).
    pub fn interleave(lanes: [&Self; LANES]) -> PointMatrices<F8> {
        let first = lanes[0].kind();
        if first.0 != 0 && lanes.iter().all(|lane| lane.kind() == first) {
            let lists = lanes.map(|lane| lane.matrices());
            let side = |k: usize| Matrix::interleave(lists.each_ref().map(|list| list[k]));
            if let Some(found) = PointMatrices::from_list((0..lists[0].len()).map(side).collect()) {
                return found;
            }
        }
        let dense = lanes.map(|lane| lane.to_dense());
        let np = dense.iter().map(|m| m.points()).max().unwrap_or(0);
        let side = |k: usize, rows: Option<usize>, columns: Option<usize>| {
            let padded = dense.each_ref().map(|lane| {
                let matrix = lane.matrices()[k];
                pad(matrix, rows.unwrap_or(matrix.rows), columns.unwrap_or(matrix.columns))
            });
            Matrix::interleave(padded.each_ref())
        };
        PointMatrices::Dense {
            to_nodes: side(0, None, Some(np)),
            from_nodes: side(1, Some(np), None),
            slope: [side(2, Some(np), Some(np)), side(3, Some(np), Some(np))],
        }
    }
}

impl PointMatrices<F8> {
    /// The matrices of one lane.
    pub fn lane(&self, lane: usize) -> PointMatrices<f64> {
        let one = |m: &Matrix<F8>| Matrix::new(m.rows, m.columns, m.data.iter().map(|x| x.0[lane]).collect());
        match self {
            PointMatrices::Dense { to_nodes, from_nodes, slope: [a, b] } => {
                PointMatrices::Dense { to_nodes: one(to_nodes), from_nodes: one(from_nodes), slope: [one(a), one(b)] }
            }
            PointMatrices::Lattice(factors) => PointMatrices::Lattice(factors.each_ref().map(|f| Factor {
                to_nodes: one(&f.to_nodes),
                from_nodes: one(&f.from_nodes),
                slope: one(&f.slope),
            })),
            PointMatrices::Nodes(slope) => PointMatrices::Nodes(one(slope)),
        }
    }
}

impl Factor<f64> {
    /// Least squares on points of a line; `None` if they cannot carry P_N.
    fn new(line: &Line, x: &[f64]) -> Option<Self> {
        let (m, k, fit) = (line.m, x.len(), LineFit::new(line.m - 1, x)?);
        Some(Self {
            to_nodes: Matrix::new(m, k, line.basis.nodes.iter().flat_map(|&x| fit.values(x)).collect()),
            from_nodes: Matrix::new(k, m, x.iter().flat_map(|&x| line.basis.values(x)).collect()),
            slope: Matrix::new(k, k, x.iter().flat_map(|&x| fit.derivatives(x)).collect()),
        })
    }
}

/// The factors of a lattice that carries Q_N; `None` for any other cloud.
fn factors(line: &Line, xi: &[[f64; 2]]) -> Option<[Factor<f64>; 2]> {
    let [x, y] = lattice(xi)?;
    Some([Factor::new(line, &x)?, Factor::new(line, &y)?])
}

/// The coordinates x_i, y_j of K x K points `p = i K + j` at (x_i, y_j); `None` for any other cloud.
fn lattice(xi: &[[f64; 2]]) -> Option<[Vec<f64>; 2]> {
    let k = xi.len().isqrt();
    if k == 0 || k * k != xi.len() {
        return None;
    }
    let (x, y): (Vec<f64>, Vec<f64>) = (0..k).map(|i| (xi[i * k][0], xi[i][1])).unzip();
    let same = |(p, at): (usize, &[f64; 2])| (at[0] - x[p / k]).abs() <= SAME && (at[1] - y[p % k]).abs() <= SAME;
    xi.iter().enumerate().all(same).then_some([x, y])
}

fn dense(line: &Line, xi: &[[f64; 2]], number: u64) -> Result<PointMatrices<f64>, Error> {
    let (n, np) = (line.m * line.m, xi.len());
    let fit = MovingLeastSquares::new(line.m - 1, xi)?;
    if fit.rank < n {
        return Err(Error::input(
            format!(
                "cell {number} cannot carry degree {}: its {np} points have rank {}, needed is {n}",
                line.m - 1,
                fit.rank
            ),
            format!(
                "put at least {} x {} points in general position into each cell, or lower scheme.degree",
                line.m, line.m
            ),
        ));
    }
    let slopes: Vec<[Vec<f64>; 2]> = xi.iter().map(|&x| fit.gradients(x)).collect();
    let to_nodes = (0..n).flat_map(|a| fit.values(line.basis.node_2d(a))).collect();
    let from_nodes = xi.iter().flat_map(|&x| line.basis.values_2d(x)).collect();
    Ok(PointMatrices::Dense {
        to_nodes: Matrix::new(n, np, to_nodes),
        from_nodes: Matrix::new(np, n, from_nodes),
        slope: [0, 1].map(|b| Matrix::new(np, np, slopes.iter().flat_map(|s| s[b].clone()).collect())),
    })
}

/// Products of factors. The derivative along one direction is, along the other, the fit's value at its own points:
/// chi_q(x_p), a projection where K > N + 1.
fn expand(a: &Factor<f64>, b: &Factor<f64>) -> PointMatrices<f64> {
    let (at_a, at_b) = (a.from_nodes.times(&a.to_nodes), b.from_nodes.times(&b.to_nodes));
    PointMatrices::Dense {
        to_nodes: a.to_nodes.kron(&b.to_nodes),
        from_nodes: a.from_nodes.kron(&b.from_nodes),
        slope: [a.slope.kron(&at_b), at_a.kron(&b.slope)],
    }
}

/// Extras rows by repeating the first, more columns by zeros.
fn pad(matrix: &Matrix<f64>, rows: usize, columns: usize) -> Matrix<f64> {
    let mut data = Vec::with_capacity(rows * columns);
    for r in 0..rows {
        let row = matrix.row(if r < matrix.rows { r } else { 0 });
        data.extend_from_slice(row);
        data.resize((r + 1) * columns, 0.0);
    }
    Matrix::new(rows, columns, data)
}
