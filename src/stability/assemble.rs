//! The derivative of a step of the program with respect to the state, by differences: no second code of the method.
//!
//! A column is sum_l w_l (step(U + l e D_j) - step(U - l e D_j)) / (2 l e D_i), central differences at the distances e, 2 e, ..
//! that are extrapolated to 0 (Richardson): exact up to the power 2 L of e, or L where the step bends at the state. D are the units 1 of F, rho0 c_p of p and h
//! (the smallest of the mesh) of u. The distance is chosen by the error of the result, which is measured: far where the step is affine (the linear law), nearer
//! where the law bends.
//!
//! The semi-discrete operator is the limit of (S(dt) - 1) / dt: its value at 0 of the polynomial through ten small dt.

use super::Problem;
use crate::error::{Error, Result};
use crate::state::{State, UNKNOWNS};
use crate::step::Law;
use crate::step::{Survey, Work};
use crate::tensor::DEFORMATION;
use rayon::prelude::*;

/// Distances e, numbers of levels L and orders that are tried, from far to near. Rounding errs by 1e-16 / e. The law, normals
/// of faces and speeds bend on the scale of F itself, which shapes at the faces multiply: a distance L e of .1 is far.
const DISTANCES: [(f64, usize, Order); 9] = [
    (0.25, 1, Order::Even),
    (1.0 / 64.0, 7, Order::Even),
    (1.0 / 256.0, 4, Order::Even),
    (1.0 / 64.0, 8, Order::All),
    (1.0 / 128.0, 6, Order::All),
    (1.0 / 512.0, 5, Order::All),
    (1.0 / 4096.0, 3, Order::All),
    (1e-5, 2, Order::All),
    (1e-6, 1, Order::Even),
];
/// Largest of the small dt, over the limit of ADER; the second serves control rates far above the default.
const SPANS: [f64; 2] = [1.0, 0.125];
/// Columns by which ways of taking differences are compared.
const SAMPLES: usize = 8;
/// Number of the small dt.
const SMALL_STEPS: usize = 10;
/// Where the polynomial of the semi-discrete limit ends: dt c / h by degree, three times the limit of ADER. There the control
/// of default rate N 3 c/h has relaxed by exp(-1.5), and the polynomial errs by 3e-12 of its rate.
const SPAN: [f64; 7] = [0.9, 0.5, 0.25, 0.15, 0.06, 0.04, 0.03];

/// The powers of e in the error of a difference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Even ones, where the step is smooth.
    Even,
    /// All: the speed of a face is the larger one of two, which bends at the state itself.
    All,
}

/// How differences are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Differences {
    /// e.
    pub distance: f64,
    /// L.
    pub levels: usize,
    /// The powers that are extrapolated.
    pub order: Order,
    /// The largest of the small dt c / h.
    pub span: f64,
    /// What the result is off by, measured: the largest entry of the difference of two ways, in c/h.
    pub noise: f64,
}

/// Which operator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operator {
    /// G = lim (S - 1) / dt, in c/h.
    SemiDiscrete,
    /// S of a step dt c / h.
    Step(f64),
}

/// A column of the operator: the change of all unknowns.
pub struct Assembler<'a> {
    problem: &'a Problem,
    /// D, by unknown.
    units: Vec<f64>,
    base: Vec<f64>,
}

/// What a thread steps in.
struct Memory {
    state: State,
    work: Work,
    survey: Survey,
}

impl<'a> Assembler<'a> {
    /// For a problem.
    pub fn new(problem: &'a Problem) -> Self {
        let (nodes, blocks) = (problem.scheme.operators.nodes(), &problem.scheme.operators.blocks);
        let mut units = Vec::new();
        for (cell, &(block, _)) in blocks.slot.iter().enumerate() {
            let impedance = problem.scheme.laws[blocks.material[block]].density() * problem.speeds[cell];
            // The creep is a displacement, too.
            units.extend((0..problem.per_cell()).map(|k| match k / nodes {
                ..DEFORMATION => 1.0,
                DEFORMATION..UNKNOWNS => impedance,
                _ => problem.h,
            }));
        }
        let at_rest = problem.state.unpack(blocks, nodes);
        let mut base = Vec::with_capacity(units.len());
        for cell in at_rest.chunks(problem.at_nodes()) {
            base.extend_from_slice(cell);
            base.resize(base.len() + problem.per_cell() - problem.at_nodes(), 0.0);
        }
        Self { problem, units, base }
    }

    fn memory(&self) -> Memory {
        let (scheme, state) = (&self.problem.scheme, &self.problem.state);
        Memory { state: state.clone(), work: Work::new(scheme, state), survey: Survey::default() }
    }

    /// Gives unknown `at` of a state a value.
    fn set(&self, state: &mut State, at: usize, value: f64) {
        let (stride, nodes) = (self.problem.per_cell(), self.problem.at_nodes());
        let (cell, k) = (at / stride, at % stride);
        let (block, lane) = self.problem.scheme.operators.blocks.slot[cell];
        match k.checked_sub(nodes) {
            None => state.u[block * nodes + k].0[lane] = value,
            Some(k) => self.problem.set_creep(state, cell, k, value),
        }
    }

    /// Unknown `at` of a state.
    fn get(&self, state: &State, at: usize) -> f64 {
        let (stride, nodes) = (self.problem.per_cell(), self.problem.at_nodes());
        let (cell, k) = (at / stride, at % stride);
        let (block, lane) = self.problem.scheme.operators.blocks.slot[cell];
        match k.checked_sub(nodes) {
            None => state.u[block * nodes + k].0[lane],
            Some(k) => state.creep[block * (stride - nodes) + k].0[lane],
        }
    }

    /// The unknown that is the same as unknown `at`: the creep of a face, which both of its cells keep.
    fn twin(&self, at: usize) -> Option<usize> {
        let (stride, nodes) = (self.problem.per_cell(), self.problem.at_nodes());
        let k = (at % stride).checked_sub(nodes)?;
        self.problem.twin_of_creep(at / stride, k).map(|(cell, k)| cell * stride + nodes + k)
    }

    /// Adds `factor` step(U + amount direction) / D to `out`.
    fn add_image(
        &self,
        m: &mut Memory,
        direction: &[(usize, f64)],
        amount: f64,
        dt: f64,
        factor: f64,
        out: &mut [f64],
    ) {
        let scheme = &self.problem.scheme;
        for &(at, value) in direction {
            self.set(&mut m.state, at, self.base[at] + amount * value * self.units[at]);
        }
        // A state that the law does not hold shows in numbers that are not finite.
        let _ = scheme.survey(&m.state, &m.work, &mut m.survey);
        scheme.step(&m.state, dt, &m.survey, &mut m.work);
        for (at, out) in out.iter_mut().enumerate() {
            *out += factor * self.get(&m.work.next, at) / self.units[at];
        }
        for &(at, _) in direction {
            self.set(&mut m.state, at, self.base[at]);
        }
    }

    /// The derivative of a step along a direction.
    fn along(&self, m: &mut Memory, direction: &[(usize, f64)], how: &Differences, dt: f64, out: &mut [f64]) {
        out.fill(0.0);
        for level in 1..=how.levels {
            let amount = level as f64 * how.distance;
            let weight = richardson(level, how.levels, how.order) / (2.0 * amount);
            self.add_image(m, direction, amount, dt, weight, out);
            self.add_image(m, direction, -amount, dt, -weight, out);
        }
    }

    /// The operator times a direction.
    fn apply(&self, m: &mut Memory, direction: &[(usize, f64)], how: &Differences, operator: Operator) -> Vec<f64> {
        let mut out = vec![0.0; self.base.len()];
        let courant = match operator {
            Operator::Step(courant) => {
                self.along(m, direction, how, self.problem.dt(courant), &mut out);
                return out;
            }
            Operator::SemiDiscrete => small_steps(how.span),
        };
        let mut image = vec![0.0; self.base.len()];
        for (courant, weight) in courant {
            self.along(m, direction, how, self.problem.dt(courant), &mut image);
            direction.iter().for_each(|&(at, value)| {
                image[at] -= value;
                // What two cells keep has moved in both.
                self.twin(at).into_iter().for_each(|at| image[at] -= value);
            });
            out.iter_mut().zip(&image).for_each(|(out, image)| *out += weight / courant * image);
        }
        out
    }

    /// The way of taking differences that errs least, told by some columns.
    ///
    /// # Errors
    /// No way gives finite numbers.
    pub fn best(&self, operator: Operator) -> Result<Differences> {
        let spans: &[f64] = if operator == Operator::SemiDiscrete { &SPANS } else { &SPANS[..1] };
        let degree = self.problem.scheme.operators.degree;
        let near = self.nearness();
        let ways = DISTANCES.iter().flat_map(|way| spans.iter().map(move |span| (*way, span * SPAN[degree.min(6)])));
        let tried: Vec<Differences> = ways
            .collect::<Vec<_>>()
            .into_par_iter()
            .map_init(
                || self.memory(),
                |memory, ((distance, levels, order), span)| {
                    let how = Differences { distance: near * distance, levels, order, span, noise: 0.0 };
                    Differences { noise: self.noise(memory, &how, operator), ..how }
                },
            )
            .collect();
        let nothing = Differences { distance: 0.0, levels: 0, order: Order::Even, span: 0.0, noise: f64::INFINITY };
        let mut best = tried.into_iter().fold(nothing, |best, way| if way.noise < best.noise { way } else { best });
        if let Operator::Step(courant) = operator {
            best.noise /= courant;
        }
        match best.levels {
            0 => Err(Error::input("a step from this state gives numbers that are not finite", "give another state")),
            _ => Ok(best),
        }
    }

    /// What distances are multiplied by. A law that stiffens by pressure bends on the scale mu/kappa: the prestress of a difference e is
    /// kappa e, and bends at a state without any. The few columns that tell how much a way errs may not see it.
    fn nearness(&self) -> f64 {
        let of = |law: &Law| {
            let [c_p, c_s] = law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0]);
            if law.is_objective() { (4.0 * (c_s / c_p).powi(2)).min(1.0) } else { 1.0 }
        };
        self.problem.scheme.laws.iter().map(of).fold(1.0, f64::min)
    }

    /// The largest difference of some columns by two ways, infinite where numbers are not finite.
    fn noise(&self, memory: &mut Memory, how: &Differences, operator: Operator) -> f64 {
        let other = Differences { distance: 0.6 * how.distance, span: 0.7 * how.span, ..*how };
        let cells = self.problem.columns();
        let stride = self.problem.per_cell();
        let mut largest = 0.0_f64;
        for k in 0..SAMPLES {
            // Spread over cells, components and nodes by the golden section.
            let part = 0.618_033_988_749_894_9 * (k + 1) as f64 % 1.0;
            let at = (part * (cells.len() * stride) as f64) as usize;
            let at = cells[at / stride] * stride + at % stride;
            let [a, b] = [how, &other].map(|how| self.apply(memory, &[(at, 1.0)], how, operator));
            for (a, b) in a.iter().zip(&b) {
                let difference = (a - b).abs();
                largest = if difference.is_finite() { largest.max(difference) } else { f64::INFINITY };
            }
        }
        largest
    }

    /// Columns of the operator for the unknowns of some cells.
    pub fn columns(&self, cells: &[usize], how: &Differences, operator: Operator) -> Vec<Vec<f64>> {
        let stride = self.problem.per_cell();
        let unknowns: Vec<usize> = cells.iter().flat_map(|cell| cell * stride..(cell + 1) * stride).collect();
        let column = |m: &mut Memory, at: usize| self.apply(m, &[(at, 1.0)], how, operator);
        unknowns.into_par_iter().map_init(|| self.memory(), column).collect()
    }
}

/// Weight of the central difference at the distance `level` e: the polynomial in e^2 or in e at 0.
fn richardson(level: usize, levels: usize, order: Order) -> f64 {
    let at = |k: usize| if order == Order::Even { (k * k) as f64 } else { k as f64 };
    (1..=levels).filter(|k| *k != level).map(|k| at(k) / (at(k) - at(level))).product()
}

/// The small dt c / h, Chebyshev's points of (0, span), with the weights of a polynomial through them at 0.
fn small_steps(span: f64) -> Vec<(f64, f64)> {
    let at =
        |j: usize| 0.5 * span * (1.0 - ((2 * j + 1) as f64 * std::f64::consts::PI / (2 * SMALL_STEPS) as f64).cos());
    let weight = |j: usize| (0..SMALL_STEPS).filter(|k| *k != j).map(|k| at(k) / (at(k) - at(j))).product();
    (0..SMALL_STEPS).map(|j| (at(j), weight(j))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_extrapolate_polynomials_to_zero_exactly() {
        let value = |x: f64| 1.0 + x * (2.0 + x * (3.0 - x));
        for (at, weights) in [(0.1, small_steps(0.1)), (0.7, small_steps(0.7))] {
            let sum: f64 = weights.iter().map(|(x, w)| w * value(*x)).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{at}: {sum}");
        }
        // sin(e)/e = 1 - e^2/6 + e^4/120 - ..: five levels leave the power 10.
        let sum: f64 = (1..=5).map(|l| richardson(l, 5, Order::Even) * (0.1 * l as f64).sin() / (0.1 * l as f64)).sum();
        assert!((sum - 1.0).abs() < 1e-13, "{sum}");
        let sum: f64 = (1..=4).map(|l| richardson(l, 4, Order::All) * value(0.1 * l as f64)).sum();
        assert!((sum - 1.0).abs() < 1e-13, "{sum}");
    }
}
