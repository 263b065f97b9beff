//! Volume term of the corrector (11), (12) and traces, from averages at the Gauss nodes.
//!
//! F rows in strong form (D v; `finish` adds the lifted jump of v), exact on uniform states; p rows in weak form. Both
//! are exact integrals, on straight cells and on curved ones ([`crate::operators::curved`]), so the two forms agree to rounding.

use super::block_work::LawWork;
use super::worst::Worst;
use crate::lane::{F8, Lane, Lanes, Twin, Work, load_array, store_array, twins};
use crate::material::Material;
use crate::mesh::FACES;
use crate::operators::{BlockMetric, Cofactors, Line, NodeMetric, determinant, with_terms};
use crate::riemann::{Looks, tangent};
use crate::state::UNKNOWNS;
use crate::tensor::{self, AXES, DEFORMATION};

/// Numbers of a trace: F, v, t, c_p, then c_s or u where the flux is one that looks at it, then s = P T where the balance is on
/// (`metered`).
pub const fn width(looks: Looks, metered: bool) -> usize {
    let more = match looks {
        Looks::Nothing => 0,
        Looks::Shear => 1,
        Looks::Displacement => 2,
    };
    9 + more + 2 * metered as usize
}

/// Arrays of one block at its nodes.
#[derive(Default)]
pub struct Arrays {
    /// U of a Runge-Kutta stage, as in the state.
    pub stage: Vec<F8>,
    /// Averages of F and v, [node][6].
    pub mean: Vec<F8>,
    /// Averages of P, [node][4].
    pub mean_stress: Vec<F8>,
    /// Contravariant tractions J dxi_b/dX_a P_ia, [node][b][i].
    contravariant: Vec<F8>,
    /// Sources b, averaged over time, [2][node].
    pub source: Vec<F8>,
    /// Averages of u, [node][2], where the flux looks at it.
    pub displacement: Vec<F8>,
    /// Lifted numbers: [face][face point][6].
    pub lift: Vec<F8>,
    /// Lifted by the traces of what is held: [face][face point][2].
    pub held: Vec<F8>,
    /// The creep of the faces before a stage, [face][point][2]; empty where they have no springs.
    pub creep: Vec<F8>,
    /// The mass matrix, by node, where it is wanted.
    pub masses: Vec<F8>,
    /// Rows of F in the weighted inner product, and their coefficients, for the curl-free projection.
    pub weighted: Vec<F8>,
    /// Coefficients of the complement, [row][column].
    pub coefficients: Vec<F8>,
}

impl Arrays {
    /// For M nodes a direction, `components` components of the state and so many numbers of the creep of a block.
    pub fn new(m: usize, components: usize, creep: usize) -> Self {
        let zeros = |count: usize| vec![F8::ZERO; count];
        let n = m * m;
        Self {
            stage: zeros(components * n),
            mean: zeros(UNKNOWNS * n),
            mean_stress: zeros(DEFORMATION * n),
            contravariant: zeros(DEFORMATION * n),
            source: zeros(AXES * n),
            displacement: zeros(AXES * n),
            lift: zeros(FACES * UNKNOWNS * m),
            held: zeros(FACES * AXES * m),
            creep: zeros(creep),
            masses: zeros(n),
            weighted: zeros(DEFORMATION * n),
            coefficients: zeros(DEFORMATION * n),
        }
    }
}

/// The first M rows of M numbers. (Arrays of constant size: a loop over slices becomes a call of `memcpy`.)
#[inline(always)]
pub fn square<const M: usize>(numbers: &[f64]) -> [[f64; M]; M] {
    let mut out = [[0.0; M]; M];
    if let Some(rows) = numbers.as_chunks::<M>().0.first_chunk::<M>() {
        out = *rows;
    }
    out
}

/// J dF_ia/dt = J dv_i/dX_a, J dp_i/dt = - sum_b K_a[., b] P_ia(b), into the first six components of `rate`; J, the
/// determinant of dX/dxi, is left to `finish`, which divides once.
pub struct Volume<'a, const M: usize, G> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The block.
    pub metric: G,
    /// Averages in.
    pub arrays: &'a mut Arrays,
    /// J dU/dt of the block, out.
    pub rate: &'a mut [F8],
}

impl<const M: usize, G: NodeMetric> Work for Volume<'_, M, G> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let n = M * M;
        let cofactors = self.metric.cofactors::<L, M>(self.line);
        let stress = &self.arrays.mean_stress.as_chunks::<DEFORMATION>().0[..n];
        let contravariant = &mut self.arrays.contravariant.as_chunks_mut::<DEFORMATION>().0[..n];
        for i in 0..M {
            for j in 0..M {
                let a = i * M + j;
                let p = load_array::<L, DEFORMATION>(&stress[a]);
                let (t1, t2) = (tensor::times(p, cofactors.one(i, j)), tensor::times(p, cofactors.two(i, j)));
                store_array([t1[0], t1[1], t2[0], t2[1]], &mut contravariant[a]);
            }
        }
        self.rates::<L, _>(&cofactors);
    }
}

/// sum_k row_k values_k for the K numbers from `first` of each value.
#[inline(always)]
fn line_sum<L: Lanes, const M: usize, const W: usize, const K: usize>(
    row: &[f64; M],
    values: [&[F8; W]; M],
    first: usize,
) -> [L; K] {
    let mut sum = [L::zero(); K];
    for e in 0..K {
        sum[e] = L::splat(row[0]) * L::load(&values[0][first + e]);
    }
    for k in 1..M {
        let factor = L::splat(row[k]);
        for e in 0..K {
            sum[e] = factor.mul_add(L::load(&values[k][first + e]), sum[e]);
        }
    }
    sum
}

/// The M values of a line of nodes: i or j runs.
#[inline(always)]
fn nodes_of<const M: usize, const W: usize>(values: &[[F8; W]], first: usize, stride: usize) -> [&[F8; W]; M] {
    let mut out = [&values[0]; M];
    for k in 0..M {
        out[k] = &values[first + stride * k];
    }
    out
}

impl<const M: usize, G> Volume<'_, M, G> {
    /// Rows of F: D v; rows of p in weak form.
    #[inline(always)]
    fn rates<L: Lanes, C: Cofactors<L>>(&mut self, cofactors: &C) {
        let (slope, weak) = (square::<M>(&self.line.slope), square::<M>(&self.line.weak));
        let n = M * M;
        let mean = &self.arrays.mean.as_chunks::<UNKNOWNS>().0[..n];
        let traction = &self.arrays.contravariant.as_chunks::<DEFORMATION>().0[..n];
        let rate = &mut self.rate[..UNKNOWNS * n];
        for i in 0..M {
            for j in 0..M {
                let a = i * M + j;
                let first = line_sum::<L, M, UNKNOWNS, AXES>(&slope[i], nodes_of(mean, j, M), DEFORMATION);
                let second = line_sum::<L, M, UNKNOWNS, AXES>(&slope[j], nodes_of(mean, i * M, 1), DEFORMATION);
                let (one, two) = (cofactors.one(i, j), cofactors.two(i, j));
                for r in 0..2 {
                    for axis in 0..2 {
                        let gradient = first[r].mul_add(one[axis], second[r] * two[axis]);
                        gradient.store(&mut rate[(2 * r + axis) * n + a]);
                    }
                }
                let first = line_sum::<L, M, DEFORMATION, AXES>(&weak[i], nodes_of(traction, j, M), 0);
                let second = line_sum::<L, M, DEFORMATION, AXES>(&weak[j], nodes_of(traction, i * M, 1), 2);
                for r in 0..2 {
                    (-(first[r] + second[r])).store(&mut rate[(DEFORMATION + r) * n + a]);
                }
            }
        }
    }
}

/// w_a J_a at all nodes, the diagonal mass matrix; m^2.
pub struct Masses<'a, const M: usize> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The block.
    pub metric: BlockMetric<'a>,
    /// By node, out.
    pub masses: &'a mut [F8],
}

impl<'a, const M: usize> Work for Masses<'a, M> {
    type Out = &'a [F8];
    #[inline(always)]
    fn run<L: Lanes>(self) -> &'a [F8] {
        let Self { line, metric, masses } = self;
        let masses = &mut masses[..M * M];
        with_terms!(metric, terms => of_masses::<L, M, _>(line, &terms.cofactors::<L, M>(line), masses));
        masses
    }
}

#[inline(always)]
fn of_masses<L: Lanes, const M: usize, C: Cofactors<L>>(line: &Line, cofactors: &C, masses: &mut [F8]) {
    let weights = row::<M>(&line.basis.weights);
    for i in 0..M {
        for j in 0..M {
            let weight = L::splat(weights[i] * weights[j]);
            (weight * determinant(cofactors.one(i, j), cofactors.two(i, j))).store(&mut masses[i * M + j]);
        }
    }
}

/// The first M numbers.
#[inline(always)]
pub fn row<const M: usize>(numbers: &[f64]) -> [f64; M] {
    match numbers.first_chunk::<M>() {
        Some(row) => *row,
        None => [0.0; M],
    }
}

/// Traces of all faces but for the speeds, from the averages at the nodes; with s = P T where METERED.
pub struct Traces<'a, const M: usize, const METERED: bool> {
    /// The 1D tables.
    pub line: &'a Line,
    /// The block.
    pub metric: BlockMetric<'a>,
    /// Averages in.
    pub arrays: &'a Arrays,
    /// Numbers of a trace, see [`width`].
    pub width: usize,
    /// Whether u is among them.
    pub with_displacement: bool,
    /// [face][point][`width`], out.
    pub traces: &'a mut [F8],
}

impl<const M: usize, const METERED: bool> Work for Traces<'_, M, METERED> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let [left, right, below, above] = self.metric.normals::<L>();
        self.of_face::<L, true>(0, left);
        self.of_face::<L, true>(1, right);
        self.of_face::<L, false>(2, below);
        self.of_face::<L, false>(3, above);
    }
}

impl<const M: usize, const METERED: bool> Traces<'_, M, METERED> {
    /// Those of a face that xi1 runs towards (FIRST), or xi2; `straight` is its normal where it is straight.
    #[inline(always)]
    fn of_face<L: Lanes, const FIRST: bool>(&mut self, face: usize, straight: [L; 2]) {
        let (ends, held) = (row::<M>(&self.line.ends[face % 2]), row::<M>(&self.line.held[face % 2]));
        let mean = &self.arrays.mean.as_chunks::<UNKNOWNS>().0[..M * M];
        let mean_stress = &self.arrays.mean_stress.as_chunks::<DEFORMATION>().0[..M * M];
        let width = self.width;
        let out = &mut self.traces[face * M * width..(face + 1) * M * width];
        for (point, out) in out.chunks_exact_mut(width).enumerate().take(M) {
            let (first, stride) = if FIRST { (point, M) } else { (point * M, 1) };
            let normal = self.metric.normal_at(straight, face, point);
            let stress = line_sum::<L, M, DEFORMATION, DEFORMATION>(&ends, nodes_of(mean_stress, first, stride), 0);
            store_array(tensor::times(stress, normal), &mut out[UNKNOWNS..UNKNOWNS + AXES]);
            if METERED {
                store_array(tensor::times(stress, tangent(normal)), &mut out[width - 2..]);
            }
            store_array(
                line_sum::<L, M, UNKNOWNS, UNKNOWNS>(&ends, nodes_of(mean, first, stride), 0),
                &mut out[..UNKNOWNS],
            );
            if self.with_displacement {
                let displacement = &self.arrays.displacement.as_chunks::<2>().0[..M * M];
                store_array(
                    line_sum::<L, M, AXES, AXES>(&held, nodes_of(displacement, first, stride), 0),
                    &mut out[9..11],
                );
            }
        }
    }
}

/// The speeds of all traces: those of the averaged F. W numbers a trace, see [`width`]; c_s where the flux is one that looks
/// at it.
pub struct Speeds<'a> {
    /// The block.
    pub metric: BlockMetric<'a>,
    /// Numbers of a trace, see [`width`].
    pub width: usize,
    /// What the flux looks at.
    pub looks: Looks,
    /// [face][point][`width`]; F in, c out.
    pub traces: &'a mut [F8],
    /// The worst of the blocks so far, which the smallest J of the traces goes to, and the number of real cells of this one;
    /// none where nobody asks. (The determinant is that of the speed, found once.)
    pub worst: Option<(&'a mut Worst, usize)>,
}

impl LawWork for Speeds<'_> {
    /// Whether a J is not above 0.
    type Out = bool;
    #[inline(always)]
    fn run<L: Lanes, M: Material>(mut self, law: M) -> bool {
        let smallest = match (self.looks, self.width == width(self.looks, true)) {
            (Looks::Nothing, false) => self.of_pressure::<L, _, { width(Looks::Nothing, false) }>(law),
            (Looks::Nothing, true) => self.of_pressure::<L, _, { width(Looks::Nothing, true) }>(law),
            (Looks::Shear, false) => self.of_both::<L, _, { width(Looks::Shear, false) }>(law),
            (Looks::Shear, true) => self.of_both::<L, _, { width(Looks::Shear, true) }>(law),
            (Looks::Displacement, false) => self.of_pressure::<L, _, { width(Looks::Displacement, false) }>(law),
            (Looks::Displacement, true) => self.of_pressure::<L, _, { width(Looks::Displacement, true) }>(law),
        };
        match self.worst {
            Some((worst, cells)) => worst.see_faces::<L>(smallest, cells),
            None => false,
        }
    }
}

impl Speeds<'_> {
    #[inline(always)]
    fn of_pressure<L: Lanes, M: Material, const W: usize>(&mut self, law: M) -> L {
        let (m, mut room) = (self.traces.len() / W / FACES, [[F8::ZERO; 3]; FACES]);
        let (normals, each) = self.metric.normals_of_points::<L>(m, &mut room);
        let mut smallest = Twin(L::splat(f64::INFINITY), L::splat(f64::INFINITY));
        for pair in 0..2 * m {
            let (a, b) = (2 * pair, 2 * pair + 1);
            let normals = twins(
                load_array::<L, AXES>(&normals[a / each][..AXES]),
                load_array::<L, AXES>(&normals[b / each][..AXES]),
            );
            let traces = &mut self.traces.as_chunks_mut::<W>().0[a..a + 2];
            let f = twins(
                load_array::<L, DEFORMATION>(&traces[0][..DEFORMATION]),
                load_array::<L, DEFORMATION>(&traces[1][..DEFORMATION]),
            );
            smallest = smallest.min(tensor::det(f));
            let Twin(one, two) = law.pressure_speed(f, normals);
            one.store(&mut traces[0][8]);
            two.store(&mut traces[1][8]);
        }
        smallest.0.min(smallest.1)
    }

    #[inline(always)]
    fn of_both<L: Lanes, M: Material, const W: usize>(&mut self, law: M) -> L {
        let (m, mut room) = (self.traces.len() / W / FACES, [[F8::ZERO; 3]; FACES]);
        let (normals, each) = self.metric.normals_of_points::<L>(m, &mut room);
        let mut smallest = L::splat(f64::INFINITY);
        for point in 0..FACES * m {
            let normal = load_array::<L, AXES>(&normals[point / each][..AXES]);
            let trace = &mut self.traces.as_chunks_mut::<W>().0[point];
            let f = load_array::<L, DEFORMATION>(&trace[..DEFORMATION]);
            smallest = smallest.min(tensor::det(f));
            store_array(law.speeds(f, normal), &mut trace[8..10]);
        }
        smallest
    }
}
