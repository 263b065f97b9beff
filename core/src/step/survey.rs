//! The health of a state: current wave speeds (for dt and the control of the curl), min J, and where stability was lost.

use super::at_points::{PointValues, at_points, remember};
use super::block_work::LawWork;
use super::health;
use super::history::recall;
use super::loss::{FacePoint, Loss};
use super::worst::{Found, Worst};
use super::{Phase, Scheme, Scratch, Work as Memory, with_scratch};
use crate::lane::{self, F8, Lane, Lanes, Twin};
use crate::material::{Material, Past, count, virgin};
use crate::mesh::FACES;
use crate::operators::with_nodes;
use crate::state::State;
use crate::tensor::{self, DEFORMATION};
use rayon::prelude::*;
use std::sync::Mutex;

/// What a state tells before it is stepped.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Survey {
    /// The speeds of each cell: `[block]`.
    pub speed: Vec<Speeds>,
    /// The largest of all, m/s.
    pub fastest: f64,
    /// The smallest J at all places where it is looked at: material points, grid nodes, face points, see `step::health`.
    pub min_j: f64,
}

/// The speeds of the cells of a block, m/s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Speeds {
    /// Largest current wave speed over the points (nodes for RK).
    pub fastest: F8,
    /// s / (rho0 c_s), s = max(0, -tau_min, tau_mean - mu): how fast the prestress tau turns and strains what is no gradient. 0
    /// without stress and in moderate tension.
    pub prestress: F8,
}

impl Scheme {
    /// Surveys `state` into `out`: wave speeds at its points, and its health at points and grid nodes.
    ///
    /// # Errors
    /// The first cell (in the order of the blocks) that lost stability.
    pub fn survey(&self, state: &State, memory: &Memory, out: &mut Survey) -> Result<(), Loss> {
        out.speed.resize(self.operators.blocks.len(), Speeds::default());
        let blocks = out.speed.par_iter_mut().enumerate();
        let worst = blocks.map(|(block, speed)| self.worst_of_block(state, block, &memory.scratch, speed));
        self.judge(worst.reduce(|| Worst::NONE, Worst::and), state, out)
    }

    /// Surveys a block of `state` by itself.
    pub(super) fn worst_of_block(
        &self,
        state: &State,
        block: usize,
        scratch: &[Mutex<Scratch>],
        speed: &mut Speeds,
    ) -> Worst {
        with_scratch(scratch, |scratch| {
            let u = state.of_block(block, self.operators.nodes());
            let internal = self.histories.of(state, block);
            let (mut worst, history) = (Worst::NONE, History::Now(internal));
            let law = &self.laws[self.operators.blocks.material[block]];
            let examine = Examine { scheme: self, block, u, history, scratch, speed, worst: &mut worst };
            law.block().examine(self.kernel, examine);
            worst
        })
    }

    /// The survey of the state that the last step made, into `out`, from what the step saw on its way.
    ///
    /// # Errors
    /// As [`Scheme::survey`].
    pub(crate) fn surveyed(&self, memory: &mut Memory, out: &mut Survey) -> Result<(), Loss> {
        std::mem::swap(&mut out.speed, &mut memory.speed);
        memory.speed.resize(out.speed.len(), Speeds::default());
        let worst = memory.tiles.worst();
        let corrected = memory.corrections.as_ref().map_or(&[][..], |memory| &memory.worst);
        let worst = corrected.iter().fold(worst, |worst, block| worst.and(*block));
        if worst.lost != usize::MAX || worst.face.is_some() {
            // Where it was lost is told from the state.
            let whole = memory.fetch(self);
            return self.judge(worst, whole.as_ref().unwrap_or(&memory.next), out);
        }
        self.judge(worst, &memory.next, out)
    }

    /// [`Scheme::survey`], and the health at face points: of a state that no step has made, or that none will look at.
    ///
    /// # Errors
    /// As there.
    pub fn survey_all(&self, state: &State, memory: &Memory, out: &mut Survey) -> Result<(), Loss> {
        self.survey(state, memory, out)?;
        let blocks = (0..self.operators.blocks.len()).into_par_iter();
        let faces = blocks.map(|block| self.smallest_j_at_faces(state, block));
        let worst = faces.reduce_with(|a, b| if b.j < a.j || (b.j == a.j && b.block < a.block) { b } else { a });
        match worst {
            Some(face) if face.j <= 0.0 => Err(self.loss_at_face(&face)),
            Some(face) => {
                out.min_j = out.min_j.min(face.j);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// The smallest J at the face points of the real cells of a block.
    fn smallest_j_at_faces(&self, state: &State, block: usize) -> FacePoint {
        let lanes = 0..self.operators.blocks.count[block];
        let none = FacePoint { block: self.first_number(block), lane: 0, at: [0; 2], j: f64::INFINITY };
        lanes.map(|lane| self.faces_of_lane(state, block, lane)).fold(none, |a, b| if b.j < a.j { b } else { a })
    }

    /// The same of one lane.
    fn faces_of_lane(&self, state: &State, block: usize, lane: usize) -> FacePoint {
        let (line, n) = (&self.operators.line, self.operators.nodes());
        let (m, u) = (line.m, &state.of_block(block, n)[..DEFORMATION * n]);
        let mut worst = FacePoint { block: self.first_number(block), lane, at: [0; 2], j: f64::INFINITY };
        for face in 0..FACES {
            let ends = &line.ends[face % 2];
            for point in 0..m {
                let (first, stride) = line.across(face, point);
                let component = |k: usize| -> f64 {
                    ends.iter().enumerate().map(|(i, l)| l * u[k * n + first + stride * i].0[lane]).sum()
                };
                let j = tensor::det([0, 1, 2, 3].map(component));
                // A NaN is for those who look at the nodes.
                if j < worst.j {
                    worst = FacePoint { at: [face, point], j, ..worst };
                }
            }
        }
        worst
    }

    fn judge(&self, worst: Worst, state: &State, out: &mut Survey) -> Result<(), Loss> {
        out.fastest = worst.fastest.0.iter().fold(0.0, |a, b| a.max(*b));
        out.min_j = worst.min_j.0.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        match (worst.face, worst.lost) {
            // What the step began with comes before what it made of it.
            (Some(face), _) => Err(self.loss_at_face(&face)),
            (None, usize::MAX) => Ok(()),
            (None, number) => Err(self.find_loss(state, self.of_first_number(number))),
        }
    }
}

/// The internal variables of a block.
pub(super) enum History<'a> {
    /// Those of the state that is looked at.
    Now(&'a [F8]),
    /// Those of the state before the step; those after it are made here: h_(n+1) = law(F, h_n, dt), dt in s.
    Before(&'a [F8], &'a mut [F8], f64),
}

/// Looks at a block: wave speeds and J at its points.
pub(super) struct Examine<'a> {
    /// The scheme.
    pub scheme: &'a Scheme,
    /// The block.
    pub block: usize,
    /// Its unknowns.
    pub u: &'a [F8],
    /// Its internal variables.
    pub history: History<'a>,
    /// The thread's arrays.
    pub scratch: &'a mut Scratch,
    /// Its largest speed (out).
    pub speed: &'a mut Speeds,
    /// The worst of the blocks so far.
    pub worst: &'a mut Worst,
}

impl LawWork for Examine<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes, M: Material>(self, law: M) {
        let Self { scheme, block, u, history, scratch, speed, worst } = self;
        let mut clock = scratch.phases.clock();
        let (f, others) = u.split_at(DEFORMATION * scheme.operators.nodes());
        let at_nodes = match scheme.samples_at_nodes(block) {
            true => L::splat(f64::INFINITY),
            false => with_nodes!(scheme.operators.line.m, N => health::smallest_j::<L, N>(f)),
        };
        let points = at_points::<L>(scheme, u, block, &mut scratch.nodes, &mut scratch.points);
        let internal = match history {
            History::Now(internal) => internal,
            History::Before(before, after, dt) => {
                remember::<L, _>(law, &points, before, after, dt);
                after
            }
        };
        if scheme.curl.is_some() {
            prestress::<L, _>(&law, &points, internal).store(&mut speed.prestress);
        }
        let found = examine::<L, _>(law, &points, internal, at_nodes, others);
        speed.fastest = found.speed;
        worst.see::<L>(found, block, scheme.operators.blocks.count[block], scheme.partition.as_ref());
        scratch.phases.book(Phase::Survey, &mut clock);
    }
}

/// Squares of the wave speeds and J of the points so far.
struct Extremes<L> {
    fastest: L,
    slowest: L,
    min_j: L,
    /// 0, or NaN where a number is not finite.
    poison: L,
}

impl<L: Lane> Extremes<L> {
    #[inline(always)]
    fn new() -> Self {
        let most = L::splat(f64::INFINITY);
        Self { fastest: L::zero(), slowest: most, min_j: most, poison: L::zero() }
    }

    /// With a point.
    #[inline(always)]
    fn see<M: Material>(&mut self, law: &M, f: [L; 4], internal: &M::History<L>) {
        let (squares, j) = (law.largest_squares(f, internal), tensor::det(f));
        self.fastest = self.fastest.max(squares[0]);
        self.slowest = self.slowest.min(squares[1]);
        self.min_j = self.min_j.min(j);
        // What is not finite in F is not finite in J.
        self.poison = (squares[0] + squares[1] + j).mul_add(L::zero(), self.poison);
    }
}

/// s / (rho0 c_s) from the Kirchhoff stress tau = P F^T, see [`Speeds`]: at the mean F of the points for an elastic law, the
/// mean over the points for one with memory. It only sets a rate, so that no weights are needed.
#[inline(always)]
fn prestress<L: Lanes, M: Material>(law: &M, points: &PointValues, internal: &[F8]) -> L {
    if !M::OBJECTIVE {
        return L::zero();
    }
    let share = L::splat(1.0 / points.count as f64);
    let mut sum = [L::zero(); DEFORMATION];
    for p in 0..points.count {
        let f = points.at::<L>(p);
        let part = if count::<M>() == 0 { f } else { kirchhoff(law, f, recall::<L, M>(internal, p)) };
        for k in 0..DEFORMATION {
            sum[k] = part[k].mul_add(share, sum[k]);
        }
    }
    let tau = if count::<M>() == 0 { kirchhoff(law, sum, virgin::<L, M>()) } else { sum };
    let [largest, smallest] = tensor::eigenvalues(tau[0], L::splat(0.5) * (tau[1] + tau[2]), tau[3]);
    let mean = L::splat(0.5) * (largest + smallest);
    let s = L::zero().max(-smallest).max(mean - L::splat(law.shear_modulus()));
    s * L::splat(1.0 / (law.density() * law.shear_modulus()).sqrt())
}

/// tau = P F^T.
#[inline(always)]
fn kirchhoff<L: Lane, M: Material>(law: &M, f: [L; 4], history: M::History<L>) -> [L; 4] {
    tensor::times_transposed(law.stress(f, &mut Past::now(history)), f)
}

/// Looks at F at the points and at what else must be finite; `at_nodes` is the smallest J there.
#[inline(always)]
fn examine<L: Lanes, M: Material>(law: M, points: &PointValues, internal: &[F8], at_nodes: L, others: &[F8]) -> Found {
    // Two points at a time, where none brings numbers of its own.
    let pairs = if count::<M>() == 0 { points.count / 2 } else { 0 };
    let (mut twins, mut seen) = (Extremes::<Twin<L>>::new(), Extremes::<L>::new());
    for pair in 0..pairs {
        twins.see(&law, lane::twins(points.at::<L>(2 * pair), points.at::<L>(2 * pair + 1)), &virgin::<Twin<L>, M>());
    }
    for p in 2 * pairs..points.count {
        seen.see(&law, points.at::<L>(p), &recall::<L, M>(internal, p));
    }
    // Four sums that do not wait for each other.
    let mut poison = [twins.poison.0, twins.poison.1, seen.poison, L::zero()];
    let (fours, rest) = others.as_chunks::<4>();
    for u in fours {
        for k in 0..4 {
            poison[k] = L::load(&u[k]).mul_add(L::zero(), poison[k]);
        }
    }
    for u in rest {
        poison[0] = L::load(u).mul_add(L::zero(), poison[0]);
    }
    let fastest = twins.fastest.0.max(twins.fastest.1).max(seen.fastest);
    let slowest = twins.slowest.0.min(twins.slowest.1).min(seen.slowest);
    let min_j = twins.min_j.0.min(twins.min_j.1).min(seen.min_j).min(at_nodes);
    let mut found = Found { speed: F8::ZERO, min_j: F8::ZERO, lost: F8::ZERO };
    fastest.sqrt().store(&mut found.speed);
    min_j.store(&mut found.min_j);
    // The root of a negative square is NaN, too.
    let poison = (poison[0] + poison[1]) + (poison[2] + poison[3]) + L::zero() * slowest.sqrt();
    (poison + min_j.where_positive(L::zero(), L::splat(1.0))).store(&mut found.lost);
    found
}
