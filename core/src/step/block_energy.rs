//! The energy of the cells of a block: what the balance meters in a step, and the watch over the energy from time to time.

use super::at_points::at_points;
use super::block_work::LawWork;
use super::history::recall;
use super::volume::Masses;
use super::{Scheme, Scratch, Work as Memory, dense, with_scratch};
use crate::lane::{F8, Lanes, store_array};
use crate::material::{Material, Past, count, virgin};
use crate::operators::with_nodes;
use crate::state::State;
use crate::sum::{ExactSum, exact_sum};
use crate::tensor::DEFORMATION;
use rayon::prelude::*;

/// sum_a m_a W(F_a), for a law with memory sum_p w_p (W + D)(F_p, h_p) with w_p = int chi_p dX, and the kinetic energy
/// sum_a m_a |p_a|^2 / (2 rho0); J/m, a lane a cell. D is what the law has dissipated, with one more
/// return from h_p to F_p where there is one to do. With what the springs of the faces store.
pub(super) struct BlockEnergy<'a> {
    pub scheme: &'a Scheme,
    pub block: usize,
    /// Its unknowns.
    pub u: &'a [F8],
    /// Its internal variables.
    pub internal: &'a [F8],
    /// The creep of its faces; empty where they have no springs.
    pub creep: &'a [F8],
    /// The time since the internal variables were those of `u`, s.
    pub dt: f64,
    /// The thread's arrays.
    pub scratch: &'a mut Scratch,
}

/// The energy of the cells of a block by kind, J/m, a lane a cell.
#[derive(Default)]
pub(super) struct Parts {
    /// Kinetic energy.
    pub kinetic: F8,
    /// Strain energy.
    pub strain: F8,
    /// What the law has dissipated; 0 of a law without memory.
    pub dissipated: F8,
    /// What the springs of the faces store.
    pub in_faces: F8,
}

impl BlockEnergy<'_> {
    /// Finds it.
    pub fn find(self) -> F8 {
        let Parts { kinetic, strain, dissipated, in_faces } = self.parts();
        F8(std::array::from_fn(|lane| kinetic.0[lane] + (strain.0[lane] + dissipated.0[lane]) + in_faces.0[lane]))
    }

    /// Finds it by kind.
    pub fn parts(self) -> Parts {
        let operators = &self.scheme.operators;
        let (line, metric) = (&operators.line, operators.geometry.of(self.block));
        let masses = &mut self.scratch.nodes.masses;
        with_nodes!(line.m, M => { self.scheme.kernel.run(Masses::<'_, M> { line, metric, masses }); });
        let law = &self.scheme.laws[self.scheme.operators.blocks.material[self.block]];
        let in_faces = self.scheme.stored_by_creep(self.block, self.creep);
        let [kinetic, strain, dissipated] = law.block().stored_energy(self.scheme.kernel, StoredEnergy(self));
        Parts { kinetic, strain, dissipated, in_faces }
    }
}

/// Kinetic, strain and dissipated energy under the type of the law.
pub(super) struct StoredEnergy<'a>(BlockEnergy<'a>);

impl LawWork for StoredEnergy<'_> {
    type Out = [F8; 3];
    #[inline(always)]
    fn run<L: Lanes, M: Material>(self, law: M) -> [F8; 3] {
        let BlockEnergy { scheme, block, u, internal, dt, scratch, .. } = self.0;
        let kinetic = kinetic_energy::<L>(law.density(), &scratch.nodes.masses, u);
        let (mut strain, mut dissipated) = (L::zero(), L::zero());
        if count::<M>() == 0 {
            strain = at_nodes::<L, _>(law, &scratch.nodes.masses, u);
        } else {
            let points = at_points::<L>(scheme, u, block, &mut scratch.nodes, &mut scratch.points);
            let weights = scheme.histories.weights(block);
            for (p, weight) in weights.iter().enumerate() {
                let (f, past) = (points.at::<L>(p), Past { history: recall::<L, M>(internal, p), dt });
                strain = L::load(weight).mul_add(law.energy(f, &past), strain);
                dissipated = L::load(weight).mul_add(law.dissipated(f, &past), dissipated);
            }
        }
        let mut out = [F8::ZERO; 3];
        store_array([kinetic, strain, dissipated], &mut out);
        out
    }
}

#[inline(always)]
fn at_nodes<L: Lanes, M: Material>(law: M, masses: &[F8], u: &[F8]) -> L {
    let mut sum = L::zero();
    for (a, mass) in masses.iter().enumerate() {
        let f = dense::gather::<L, DEFORMATION>(u, masses.len(), a);
        sum = L::load(mass).mul_add(law.energy(f, &Past::now(virgin::<L, M>())), sum);
    }
    sum
}

#[inline(always)]
fn kinetic_energy<L: Lanes>(density: f64, masses: &[F8], u: &[F8]) -> L {
    let (n, mut sum) = (masses.len(), L::zero());
    for (a, mass) in masses.iter().enumerate() {
        let (one, two) = (L::load(&u[DEFORMATION * n + a]), L::load(&u[(DEFORMATION + 1) * n + a]));
        sum = L::load(mass).mul_add(one.mul_add(one, two * two), sum);
    }
    sum * L::splat(0.5 / density)
}

impl Scheme {
    /// Kinetic, strain and dissipated energy of a state, J/m: [`super::Totals::accounted`] at a fraction of the cost. `cells` is
    /// memory for it; the blocks are added by an exact sum.
    pub fn energy(&self, state: &State, memory: &Memory, cells: &mut Vec<F8>) -> f64 {
        cells.resize(self.operators.blocks.len(), F8::ZERO);
        self.energy_of_cells((state, 0), memory, cells);
        self.sum_of_cells(cells)
    }

    /// The energy of the cells of some blocks from the `first` on.
    fn energy_of_cells(&self, (state, first): (&State, usize), memory: &Memory, cells: &mut [F8]) {
        cells.par_iter_mut().enumerate().for_each(|(number, out)| {
            let block = first + number;
            *out = with_scratch(&memory.scratch, |scratch| {
                let u = state.of_block(block, self.operators.nodes());
                let internal = self.histories.of(state, block);
                let creep = self.creep_of(state, block);
                BlockEnergy { scheme: self, block, u, internal, creep, dt: 0.0, scratch }.find()
            });
        });
    }

    fn sum_of_cells(&self, cells: &[F8]) -> f64 {
        exact_sum(of_blocks(cells, &self.operators.blocks.count))
    }
}

/// The sum of the cells of each of some blocks that have so many.
fn of_blocks(cells: &[F8], count: &[usize]) -> impl Iterator<Item = f64> {
    cells.iter().zip(count).map(|(cells, &count)| cells.0[..count].iter().sum())
}

impl Memory {
    /// [`Scheme::energy`] of a state of which each rank may have its part. All ranks call it.
    pub fn energy(&mut self, scheme: &Scheme, state: &State, cells: &mut Vec<F8>) -> f64 {
        let Some(own) = self.tiles.ranks.as_ref().map(|ranks| ranks.own()) else {
            return scheme.energy(state, self, cells);
        };
        cells.resize(own.len(), F8::ZERO);
        scheme.energy_of_cells((state, own.start), self, cells);
        let mut sum = ExactSum::default();
        of_blocks(cells, &scheme.operators.blocks.count[own]).for_each(|energy| sum.add(energy));
        let Some(ranks) = &mut self.tiles.ranks else { return sum.value() };
        let [energy] = ranks.sum([sum]);
        energy
    }
}
