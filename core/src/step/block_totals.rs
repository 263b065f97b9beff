//! What a state holds in the cells of a block: a lane a cell, by grid quadrature.

use super::block_energy::{BlockEnergy, Parts};
use super::volume::{row, square};
use super::{Scheme, Scratch, Totals};
use crate::lane::{F8, Lanes, Work, load_array, store_array};
use crate::mesh::map;
use crate::operators::{Cofactors, Line, NodeMetric, determinant, with_nodes, with_terms};
use crate::state::{State, UNKNOWNS};
use crate::tensor::{AXES, DEFORMATION, det};

/// [`Totals`] of each cell of a block.
pub(super) struct CellTotals {
    energy: Parts,
    sums: Sums,
}

impl CellTotals {
    /// Those of the cell in a lane; of `known`, what is there.
    pub fn lane(&self, lane: usize, known: &Totals) -> Totals {
        let of = |values: &F8| values.0[lane];
        let Self { energy, sums } = self;
        Totals {
            kinetic: of(&energy.kinetic),
            strain: of(&energy.strain),
            in_faces: of(&energy.in_faces),
            dissipated: known.dissipated.map(|_| of(&energy.dissipated)),
            momentum: sums.momentum.each_ref().map(of),
            angular_momentum: known.angular_momentum.map(|_| of(&sums.angular_momentum)),
            deformation: sums.deformation.each_ref().map(of),
            min_j: of(&sums.min_j),
            max_curl: of(&sums.max_curl),
            max_drift: known.max_drift.map(|_| (of(&sums.drift) / of(&sums.area)).sqrt()),
        }
    }
}

/// What needs no law, by lane.
#[derive(Default)]
struct Sums {
    /// int p dX.
    momentum: [F8; AXES],
    /// int F dX.
    deformation: [F8; DEFORMATION],
    /// int dX.
    area: F8,
    /// min J over the nodes.
    min_j: F8,
    /// Largest |dF_i2/dX_1 - dF_i1/dX_2| at the nodes.
    max_curl: F8,
    /// int (x_1 p_2 - x_2 p_1) dX; 0 where no displacement is known.
    angular_momentum: F8,
    /// int |grad u - (F - 1)|^2 dX; 0 where no displacement is known.
    drift: F8,
}

impl Scheme {
    /// Totals of the cells of a block.
    pub(super) fn totals_of_cells(&self, state: &State, block: usize, scratch: &mut Scratch) -> CellTotals {
        let (operators, u) = (&self.operators, state.of_block(block, self.operators.nodes()));
        let (internal, creep) = (self.histories.of(state, block), self.creep_of(state, block));
        let energy = BlockEnergy { scheme: self, block, u, internal, creep, dt: 0.0, scratch }.parts();
        let displaced = state.has_displacement();
        if displaced {
            self.node_places(block, &mut scratch.nodes.displacement);
        }
        let (line, metric, places) = (&operators.line, operators.geometry.of(block), &scratch.nodes.displacement);
        let sums = with_nodes!(line.m, M => {
            with_terms!(metric, metric => self.kernel.run(AddUp::<M, _> { line, metric, u, displaced, places }))
        });
        CellTotals { energy, sums }
    }

    /// X of the nodes of a block, `[node][2]`.
    fn node_places(&self, block: usize, places: &mut [F8]) {
        for lane in 0..self.operators.blocks.count[block] {
            let cell = self.operators.geometry.map_of(block, lane);
            for (a, place) in places.as_chunks_mut::<AXES>().0.iter_mut().enumerate() {
                let x = map::position(&cell, self.operators.line.basis.node_2d(a));
                (0..AXES).for_each(|axis| place[axis].0[lane] = x[axis]);
            }
        }
    }
}

/// Finds [`Sums`].
struct AddUp<'a, const M: usize, G> {
    line: &'a Line,
    metric: G,
    /// The unknowns of the block, `[component][node]`.
    u: &'a [F8],
    /// Whether the displacement is among them.
    displaced: bool,
    /// X of the nodes, `[node][2]`, where it is.
    places: &'a [F8],
}

impl<const M: usize, G: NodeMetric> Work for AddUp<'_, M, G> {
    type Out = Sums;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Sums {
        let (n, weights, cofactors) =
            (M * M, row::<M>(&self.line.basis.weights), self.metric.cofactors::<L, M>(self.line));
        let (mut unknowns, mut area) = ([L::zero(); UNKNOWNS], L::zero());
        let (mut min_j, mut max_curl) = (L::splat(f64::INFINITY), L::zero());
        let (mut turning, mut drift) = (L::zero(), L::zero());
        for i in 0..M {
            for j in 0..M {
                let (a, one, two) = (i * M + j, cofactors.one(i, j), cofactors.two(i, j));
                let j_of_cell = determinant(one, two);
                let mass = L::splat(weights[i] * weights[j]) * j_of_cell;
                let mut at_node = [L::zero(); UNKNOWNS];
                for k in 0..UNKNOWNS {
                    at_node[k] = L::load(&self.u[k * n + a]);
                    unknowns[k] = mass.mul_add(at_node[k], unknowns[k]);
                }
                area = area + mass;
                let [f11, f12, f21, f22, p1, p2] = at_node;
                min_j = det([f11, f12, f21, f22]).min(min_j);
                let inverse = L::splat(1.0) / j_of_cell;
                for row in 0..AXES {
                    let first = self.gradient::<L>(AXES * row, i, j, one, two);
                    let second = self.gradient::<L>(AXES * row + 1, i, j, one, two);
                    let curl = (second[0] - first[1]) * inverse;
                    max_curl = curl.max(-curl).max(max_curl);
                }
                if self.displaced {
                    let x = load_array::<L, AXES>(&self.places[AXES * a..]);
                    let u = [L::load(&self.u[UNKNOWNS * n + a]), L::load(&self.u[(UNKNOWNS + 1) * n + a])];
                    let y = [x[0] + u[0], x[1] + u[1]];
                    turning = mass.mul_add(y[0].mul_add(p2, -(y[1] * p1)), turning);
                    for row in 0..AXES {
                        let gradient = self.gradient::<L>(UNKNOWNS + row, i, j, one, two);
                        for axis in 0..AXES {
                            let unit = L::splat(f64::from(u8::from(row == axis)));
                            let off = gradient[axis].mul_add(inverse, unit - at_node[AXES * row + axis]);
                            drift = (mass * off).mul_add(off, drift);
                        }
                    }
                }
            }
        }
        let mut out = Sums::default();
        let [f11, f12, f21, f22, p1, p2] = unknowns;
        store_array([f11, f12, f21, f22], &mut out.deformation);
        store_array([p1, p2], &mut out.momentum);
        area.store(&mut out.area);
        min_j.store(&mut out.min_j);
        max_curl.store(&mut out.max_curl);
        turning.store(&mut out.angular_momentum);
        drift.store(&mut out.drift);
        out
    }
}

impl<const M: usize, G> AddUp<'_, M, G> {
    /// J grad of a component at the node (i, j), whose cofactors are `one` and `two`.
    #[inline(always)]
    fn gradient<L: Lanes>(&self, component: usize, i: usize, j: usize, one: [L; 2], two: [L; 2]) -> [L; 2] {
        let (slope, values) = (square::<M>(&self.line.slope), &self.u[component * M * M..(component + 1) * M * M]);
        let (mut first, mut second) = (L::zero(), L::zero());
        for k in 0..M {
            first = L::splat(slope[i][k]).mul_add(L::load(&values[k * M + j]), first);
            second = L::splat(slope[j][k]).mul_add(L::load(&values[i * M + k]), second);
        }
        [first.mul_add(one[0], second * two[0]), first.mul_add(one[1], second * two[1])]
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::map;
    use crate::state::State;
    use crate::step::tests::{Kind, distorted, midpoints, scheme, wall};
    use crate::tensor::det;

    /// F and p linear in X.
    fn linear(x: [f64; 2]) -> [f64; 6] {
        let at = |a: f64, b: f64, c: f64| a + b * x[0] + c * x[1];
        [
            at(1.1, 0.1, 0.05),
            at(0.02, 0.03, -0.04),
            at(0.01, -0.02, 0.06),
            at(0.9, 0.07, 0.1),
            at(0.3, 1.0, -2.0),
            at(-0.2, 0.5, 1.5),
        ]
    }

    /// A displacement that is quadratic in X, and its gradient.
    fn quadratic(x: [f64; 2]) -> ([f64; 2], [f64; 4]) {
        let [a, b] = x;
        let u = [0.05 * a * a + 0.02 * a * b, 0.03 * b * b - 0.01 * a * b];
        (u, [0.1 * a + 0.02 * b, 0.02 * a, -0.01 * b, 0.06 * b - 0.01 * a])
    }

    /// On cells of straight edges Q2 holds any quadratic function of X, so that gradients at the nodes are exact.
    #[test]
    fn totals_are_sums_over_the_nodes_of_what_is_known_there() {
        let mesh = distorted(5);
        let scheme = scheme(&mesh, Kind::AderDgmpm, 2, &midpoints(&mesh, 2), wall);
        let (operators, n) = (&scheme.operators, scheme.operators.nodes());
        let place = |cell: usize, a: usize| map::position(&mesh.map(cell), operators.line.basis.node_2d(a));
        let mut cells = vec![0.0; mesh.cells.len() * 8 * n];
        for (cell, values) in cells.chunks_mut(8 * n).enumerate() {
            for a in 0..n {
                let x = place(cell, a);
                let all = linear(x).into_iter().chain(quadratic(x).0);
                all.enumerate().for_each(|(k, value)| values[k * n + a] = value);
            }
        }
        let mut state = State::pack(&operators.blocks, n, 8, &cells);
        scheme.set_boundary_memory(&mut state, &[]);
        let (mut sums, mut min_j, mut drift) = ([0.0; 9], f64::INFINITY, 0.0_f64);
        for cell in 0..mesh.cells.len() {
            let ((block, lane), mut off, mut area) = (operators.blocks.slot[cell], 0.0, 0.0);
            for (a, mass) in operators.geometry.masses(&operators.line, block, lane).enumerate() {
                let x = place(cell, a);
                let ([f11, f12, f21, f22, p1, p2], (u, gradient)) = (linear(x), quadratic(x));
                let f = [f11, f12, f21, f22];
                let missing = [0, 1, 2, 3].map(|k| gradient[k] - f[k] + [1.0, 0.0, 0.0, 1.0][k]);
                let kinetic = (p1 * p1 + p2 * p2) / (2.0 * 1.3);
                let turning = (x[0] + u[0]) * p2 - (x[1] + u[1]) * p1;
                let strain = scheme.laws[0].energy(f);
                let all = [kinetic, strain, turning, p1, p2, f11, f12, f21, f22];
                sums.iter_mut().zip(all).for_each(|(sum, value)| *sum += mass * value);
                min_j = min_j.min(det(f));
                off += mass * missing.iter().map(|x| x * x).sum::<f64>();
                area += mass;
            }
            drift = drift.max((off / area).sqrt());
        }
        let totals = scheme.totals(&state);
        let [p, f] = [&totals.momentum[..], &totals.deformation[..]];
        let found =
            [totals.kinetic, totals.strain, totals.angular_momentum.unwrap(), p[0], p[1], f[0], f[1], f[2], f[3]];
        // Roundings of numbers of size 1, in sums of 225 terms.
        for (found, sum) in found.into_iter().zip(sums) {
            assert!((found - sum).abs() < 1e-13, "{found:e} {sum:e}");
        }
        // dF_12/dX_1 - dF_11/dX_2 = .03 - .05 and dF_22/dX_1 - dF_21/dX_2 = .07 - .06; derivatives over cells of size .2.
        assert!((totals.max_curl - 0.02).abs() < 1e-13, "{:e}", totals.max_curl);
        assert!((totals.min_j - min_j).abs() < 1e-15 && (totals.max_drift.unwrap() - drift).abs() < 1e-14);
    }
}
