//! Totals of a state by grid quadrature (sums over points with volumes are wrong for most layouts). What a law with memory
//! stores and dissipates is known at its points alone, from their own F and history: there the weights are int chi_p dX.

use super::{Scheme, Scratch, Work};
use crate::state::State;
use crate::sum::ExactSum;
use crate::tensor::DEFORMATION;
use rayon::prelude::*;
use std::ops::Range;

/// Totals per unit thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Totals {
    /// int |p|^2 / (2 rho0) dX, J/m.
    pub kinetic: f64,
    /// int W dX, J/m: all that is stored.
    pub strain: f64,
    /// What the springs against the creep of faces store ([`crate::riemann::creep`]), J/m: part of the energy.
    pub in_faces: f64,
    /// What laws have dissipated since their material was virgin, J/m; only where one has memory.
    pub dissipated: Option<f64>,
    /// int p dX, kg/s (per metre of thickness).
    pub momentum: [f64; 2],
    /// int (x_1 p_2 - x_2 p_1) dX with x = X + u, kg m/s (per metre of thickness), about the origin; only where the
    /// displacement is known.
    pub angular_momentum: Option<f64>,
    /// int F dX, m^2.
    pub deformation: [f64; DEFORMATION],
    /// min J over the nodes.
    pub min_j: f64,
    /// Largest |dF_i2/dX_1 - dF_i1/dX_2| at the nodes, 1/m.
    pub max_curl: f64,
    /// The largest over the cells of sqrt(int |grad u - (F - 1)|^2 dX / int dX), what F and the shape differ by; only where the
    /// displacement is known. (Of a body that starts strained, with a displacement that counts from there, it holds that strain.)
    pub max_drift: Option<f64>,
}

/// Energy that was made out of nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyMade {
    /// J/m.
    pub joule: f64,
    /// Over the largest of the energy at the start, the work done so far, and what is told from rounding.
    pub share: f64,
    /// When it was found, s.
    pub time: f64,
    /// After so many steps.
    pub step: usize,
    /// Whether laws are sampled away from the Gauss nodes, which may be why.
    pub between_nodes: bool,
}

/// As a clause, for messages.
impl std::fmt::Display for EnergyMade {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let EnergyMade { joule, share, time, step, between_nodes } = self;
        let percent = 100.0 * share;
        write!(
            f,
            "{joule:.3e} J/m made out of nothing ({percent:.2} % of the energy at the start or the work done), step {step}, \
             t = {time:.6e} s"
        )?;
        match between_nodes {
            true => write!(
                f,
                "; laws sampled at the Gauss nodes ([cloud] layout = \"gauss\") or at more points (per_direction) may make none"
            ),
            false => Ok(()),
        }
    }
}

impl Totals {
    /// No cell yet.
    const EMPTY: Totals = Totals {
        kinetic: 0.0,
        strain: 0.0,
        in_faces: 0.0,
        dissipated: None,
        momentum: [0.0; 2],
        angular_momentum: None,
        deformation: [0.0; DEFORMATION],
        min_j: f64::INFINITY,
        max_curl: 0.0,
        max_drift: None,
    };

    /// Kinetic and strain energy, and that of the springs in faces, J/m.
    pub fn energy(&self) -> f64 {
        self.kinetic + self.strain + self.in_faces
    }

    /// [`Totals::energy`] and what laws have dissipated: what the balance of a step is about, J/m.
    pub fn accounted(&self) -> f64 {
        self.energy() + self.dissipated.unwrap_or(0.0)
    }

    fn add(&mut self, other: &Totals) {
        self.kinetic += other.kinetic;
        self.strain += other.strain;
        self.in_faces += other.in_faces;
        self.dissipated = self.dissipated.zip(other.dissipated).map(|(a, b)| a + b);
        self.momentum.iter_mut().zip(other.momentum).for_each(|(a, b)| *a += b);
        self.angular_momentum = self.angular_momentum.zip(other.angular_momentum).map(|(a, b)| a + b);
        self.deformation.iter_mut().zip(other.deformation).for_each(|(a, b)| *a += b);
        self.min_j = self.min_j.min(other.min_j);
        self.max_curl = self.max_curl.max(other.max_curl);
        self.max_drift = self.max_drift.zip(other.max_drift).map(|(a, b)| a.max(b));
    }

    /// Those that are sums over the body.
    fn sums(&self) -> [f64; SUMS] {
        let ([p1, p2], [f11, f12, f21, f22]) = (self.momentum, self.deformation);
        let (dissipated, turning) = (self.dissipated.unwrap_or(0.0), self.angular_momentum.unwrap_or(0.0));
        [self.kinetic, self.strain, self.in_faces, dissipated, turning, p1, p2, f11, f12, f21, f22]
    }

    /// These, with others for [`Totals::sums`].
    fn with_sums(self, sums: [f64; SUMS]) -> Self {
        let [kinetic, strain, in_faces, dissipated, turning, p1, p2, f11, f12, f21, f22] = sums;
        Totals {
            kinetic,
            strain,
            in_faces,
            dissipated: self.dissipated.map(|_| dissipated),
            angular_momentum: self.angular_momentum.map(|_| turning),
            momentum: [p1, p2],
            deformation: [f11, f12, f21, f22],
            ..self
        }
    }
}

/// How many of the [`Totals`] are sums over the body.
const SUMS: usize = 11;

/// Totals of blocks that are added up: by exact sums until they are rounded once, so that the order of the blocks does not matter.
struct Sum {
    sums: [ExactSum; SUMS],
    /// What is largest or smallest.
    rest: Totals,
}

impl Sum {
    /// The sum of `blocks`; `none` are the totals of no cell.
    fn of<'a>(none: Totals, blocks: impl IntoIterator<Item = &'a Totals>) -> Self {
        let mut out = Self { sums: Default::default(), rest: none };
        for block in blocks {
            out.rest.add(block);
            out.sums.iter_mut().zip(block.sums()).for_each(|(sum, value)| sum.add(value));
        }
        out
    }

    fn rounded(self) -> Totals {
        self.rest.with_sums(self.sums.map(|sum| sum.value()))
    }
}

impl Scheme {
    /// Totals of a state.
    pub fn totals(&self, state: &State) -> Totals {
        let blocks = self.totals_of_blocks(state, 0..self.operators.blocks.len());
        Sum::of(self.no_totals(state), &blocks).rounded()
    }

    /// Totals of the cells of each law, in the order of the laws.
    pub fn totals_by_law(&self, state: &State) -> Vec<Totals> {
        let blocks = self.totals_of_blocks(state, 0..self.operators.blocks.len());
        let of_law = |law: usize| {
            let own = blocks.iter().zip(&self.operators.blocks.material).filter(|(_, of)| **of == law);
            Sum::of(self.no_totals(state), own.map(|(block, _)| block)).rounded()
        };
        (0..self.laws.len()).map(of_law).collect()
    }

    /// Totals of no cell.
    fn no_totals(&self, state: &State) -> Totals {
        let known = state.has_displacement().then_some(0.0);
        let dissipated = (!self.histories.is_empty()).then_some(0.0);
        Totals { angular_momentum: known, max_drift: known, dissipated, ..Totals::EMPTY }
    }

    /// Totals of some blocks, one after the other.
    fn totals_of_blocks(&self, state: &State, blocks: Range<usize>) -> Vec<Totals> {
        let none = self.no_totals(state);
        let of_block = |scratch: &mut Scratch, block: usize| {
            let (cells, mut sum) = (self.totals_of_cells(state, block, scratch), none);
            (0..self.operators.blocks.count[block]).for_each(|lane| sum.add(&cells.lane(lane, &none)));
            sum
        };
        blocks.into_par_iter().map_init(|| Scratch::for_energy(self, state), of_block).collect()
    }
}

impl Work {
    /// [`Scheme::totals`] of a state of which each rank may have its part. All ranks call it.
    pub fn totals(&mut self, scheme: &Scheme, state: &State) -> Totals {
        let Some(ranks) = self.tiles.ranks.as_deref_mut() else { return scheme.totals(state) };
        let Sum { sums, rest } = Sum::of(scheme.no_totals(state), &scheme.totals_of_blocks(state, ranks.own()));
        let sums = ranks.sum(sums);
        let [below, max_curl, drift] = ranks.most([-rest.min_j, rest.max_curl, rest.max_drift.unwrap_or(0.0)]);
        Totals { min_j: -below, max_curl, max_drift: rest.max_drift.map(|_| drift), ..rest }.with_sums(sums)
    }
}
