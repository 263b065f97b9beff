//! The displacement of a cell whose F was changed by something else than the velocity of the cell.

use super::Scheme;
use crate::lane::F8;
use crate::mesh::map;
use crate::operators::determinant;
use crate::state::UNKNOWNS;
use crate::tensor::{AXES, dot};

impl Scheme {
    /// Gives the displacement of a cell the mean gradient of F - 1, u += mean(F - 1 - grad u)(X - mean X); means over the cell are
    /// sum_a w_a J_a (.)_a / sum_a w_a J_a, that of u stays. Nothing where no displacement is carried. `u`: `[component][node]` of a
    /// block.
    pub(crate) fn follow(&self, block: usize, lane: usize, u: &mut [F8]) {
        let (n, m) = (self.operators.nodes(), self.operators.line.m);
        if u.len() < (UNKNOWNS + AXES) * n {
            return;
        }
        let (corners, nodes) = (self.operators.geometry.map_of(block, lane), &self.operators.line.basis.nodes);
        let place = |a: usize| map::position(&corners, [nodes[a / m], nodes[a % m]]);
        let weights = self.operators.node_weights(block, lane);
        let area: f64 = weights[..n].iter().sum();
        let mean = |value: &dyn Fn(usize) -> f64| (0..n).map(|a| weights[a] * value(a)).sum::<f64>() / area;
        let middle = [0, 1].map(|axis| mean(&|a| place(a)[axis]));
        for i in 0..AXES {
            let number = UNKNOWNS + i;
            let missing = [0, 1].map(|j| {
                let of_f = mean(&|a| u[(AXES * i + j) * n + a].0[lane]) - f64::from(u8::from(i == j));
                of_f - mean(&|a| self.gradient(u, block, lane, a, number)[j])
            });
            for (a, value) in u[number * n..(number + 1) * n].iter_mut().enumerate() {
                value.0[lane] += dot(missing, [0, 1].map(|axis| place(a)[axis] - middle[axis]));
            }
        }
    }
    /// The gradient of a component of a block at node a.
    fn gradient(&self, u: &[F8], block: usize, lane: usize, a: usize, component: usize) -> [f64; 2] {
        let (line, n) = (&self.operators.line, self.operators.nodes());
        let (m, i, j) = (line.m, a / line.m, a % line.m);
        let [one, two] = self.operators.geometry.of(block).at_node_of(line, lane, i, j);
        let at = |node: usize| u[component * n + node].0[lane];
        let along1: f64 = (0..m).map(|k| line.slope[i * m + k] * at(k * m + j)).sum();
        let along2: f64 = (0..m).map(|k| line.slope[j * m + k] * at(i * m + k)).sum();
        [0, 1].map(|axis| (along1 * one[axis] + along2 * two[axis]) / determinant(one, two))
    }
}
