//! Sources of momentum: rho0 b at points and nodes, and the work that they do.

use super::acceleration::{Acceleration, Vectors, add_times, by_lane};
use super::balance::add;
use super::block::Block;
use super::outside::ExternalWork;
use super::phase::Ticks;
use super::predictor::Arrays;
use super::sweeps::Sweep;
use super::{Part, Scratch, volume};
use crate::lane::{F8, Lanes, Work, load_array, ticks};
use crate::operators::Points;
use crate::state::UNKNOWNS;
use crate::tensor::{AXES, DEFORMATION, dot};

/// Time nodes of a step at most.
const MOST_TIMES: usize = 8;

// What a step calls of these is never inlined into it: a step without sources has the tests for them alone, and no longer code between
// what it does.
impl Block<'_> {
    /// b at the points and time nodes with v of t_n, for the first guess of the predictor, into `arrays.source`.
    #[inline(never)]
    pub fn first_sources(&self, points: &Points, arrays: &mut Arrays, phases: &mut Ticks) {
        let begin = phases.start();
        let count = self.scheme.operators.block_points(self.number);
        let (start, inverse) = (&arrays.start, 1.0 / self.law().density());
        let v = |_: &[F8], p: usize, _: usize| {
            [0, 1].map(|k| by_lane(|lane| start[UNKNOWNS * p + DEFORMATION + k].0[lane] * inverse))
        };
        self.sources_with(points, count, v, &mut arrays.source);
        phases.book_part(Part::Sources, begin);
    }

    /// Whether a source depends on the velocity.
    #[inline(never)]
    pub fn sources_move(&self) -> bool {
        self.scheme.sources.iter().any(|source| source.varies().velocity)
    }

    /// The same with v of the sweep before `sweep`, from its rates and from b itself.
    #[inline(never)]
    pub fn renew_sources(&self, integration: &[f64], sweep: &Sweep, arrays: &mut Arrays) {
        let Some(points) = self.points() else { return };
        let begin = ticks();
        let count = self.scheme.operators.block_points(self.number);
        let (times, dt, density) = (self.stage.times.len(), self.stage.dt, self.law().density());
        let (start, rates) = (&arrays.start, &arrays.rates[0]);
        let v = |known: &[F8], p: usize, s: usize| {
            [0, 1].map(|k| {
                let (mut flux, mut given) = (F8::ZERO, F8::ZERO);
                for j in 0..sweep.from {
                    let rate = &rates[UNKNOWNS * (j * count + p) + DEFORMATION + k];
                    add_times(&mut flux, sweep.at_times[s * sweep.from + j], rate);
                }
                for j in 0..times {
                    add_times(&mut given, integration[s * times + j], &known[AXES * (j * count + p) + k]);
                }
                let now = &start[UNKNOWNS * p + DEFORMATION + k];
                by_lane(|lane| now.0[lane] / density + dt * (flux.0[lane] / density + given.0[lane]))
            })
        };
        self.sources_with(points, count, v, &mut arrays.source);
        arrays.ticks += ticks().wrapping_sub(begin);
    }

    /// b at the points and time nodes, [time node][point][2], with v at a time node by v(b so far, point, time node).
    fn sources_with(&self, points: &Points, count: usize, v: impl Fn(&[F8], usize, usize) -> Vectors, out: &mut [F8]) {
        let sources = Acceleration::of(self);
        for p in 0..count {
            let at = points.first[self.number] + p;
            let x = sources.places(|lane| [0, 1].map(|k| points.parent[AXES * at + k].0[lane]));
            let mut velocities = [[F8::ZERO; AXES]; MOST_TIMES];
            if sources.varies.velocity {
                // All of them before b is written over.
                for (s, velocity) in velocities.iter_mut().enumerate().take(self.stage.times.len()) {
                    *velocity = v(out, p, s);
                }
            }
            let mut b = [F8::ZERO; AXES];
            for (s, node) in self.stage.times.iter().enumerate() {
                if s == 0 || sources.varies.time || sources.varies.velocity {
                    b = sources.at(&x, node.time, &velocities[s]);
                }
                out[AXES * (s * count + p)..][..AXES].copy_from_slice(&b);
            }
        }
    }

    /// Books the work of sources in the step that ends with the momenta `after`.
    #[inline(never)]
    pub fn end_sources(self, before: &[F8], after: &[F8], masses: &mut [F8], external: &mut ExternalWork) {
        self.find_masses(masses);
        self.scheme.kernel.run(SourceEnd { masses, before, after, external });
    }

    /// Adds J rho0 b at the nodes to the rates of p, and the work of the stage to the external work.
    #[inline(never)]
    pub fn add_sources(self, scratch: &mut Scratch, rate: &mut [F8], external: Option<&mut ExternalWork>) {
        let Scratch { nodes, phases, .. } = scratch;
        let start = phases.start();
        self.sources_at_nodes(&nodes.mean, &mut nodes.source);
        self.find_masses(&mut nodes.masses);
        self.scheme.kernel.run(AddSources { block: self, nodes, rate, external });
        phases.book_part(Part::Sources, start);
    }

    /// b at the nodes, averaged over the time nodes, [2][node]; `mean` has F and v of the stage, [node][6].
    fn sources_at_nodes(&self, mean: &[F8], out: &mut [F8]) {
        let (n, sources) = (self.scheme.operators.nodes(), Acceleration::of(self));
        for a in 0..n {
            let xi = self.scheme.operators.line.basis.node_2d(a);
            let x = sources.places(|_| xi);
            let v = [0, 1].map(|k| mean[UNKNOWNS * a + DEFORMATION + k]);
            let (mut average, mut b) = ([F8::ZERO; AXES], [F8::ZERO; AXES]);
            for (s, node) in self.stage.times.iter().enumerate() {
                if s == 0 || sources.varies.time {
                    b = sources.at(&x, node.time, &v);
                }
                (0..AXES).for_each(|k| add_times(&mut average[k], node.weight, &b[k]));
            }
            (0..AXES).for_each(|k| out[k * n + a] = average[k]);
        }
    }
}

impl Scratch {
    /// Books the time that the predictor has spent on sources.
    #[inline(never)]
    pub fn book_ticks_of_sources(&mut self) {
        let ticks = std::mem::take(&mut self.points.ticks);
        self.phases.add_part(Part::Sources, ticks);
    }
}

/// [`Block::add_sources`] once b is known.
struct AddSources<'a> {
    /// The block.
    pub block: Block<'a>,
    /// With b, the masses, and v of the stage.
    pub nodes: &'a volume::Arrays,
    /// J dU/dt.
    pub rate: &'a mut [F8],
    /// The work on the block.
    pub external: Option<&'a mut ExternalWork>,
}

impl Work for AddSources<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { block, nodes, rate, external } = self;
        let operators = &block.scheme.operators;
        let (n, density) = (operators.nodes(), block.law().density());
        for (a, mass) in nodes.masses.iter().enumerate() {
            let factor = L::splat(density / operators.line.basis.weight_2d(a)) * L::load(mass);
            for k in 0..AXES {
                let rate = &mut rate[(DEFORMATION + k) * n + a];
                factor.mul_add(L::load(&nodes.source[k * n + a]), L::load(rate)).store(rate);
            }
        }
        if let Some(external) = external {
            let (masses, mean, source) = (&nodes.masses, &nodes.mean, &nodes.source);
            SourceStage { density, factor: block.factor(), masses, mean, source, external }.add::<L>();
        }
    }
}

/// A stage of the work of sources: their mean over the cell into the impulse, and the rest, b - mean b, with the velocity of the
/// stage into the work.
struct SourceStage<'a> {
    /// rho0.
    pub density: f64,
    /// dt b_i of the stage.
    pub factor: f64,
    /// By node.
    pub masses: &'a [F8],
    /// [node][6] with v behind F.
    pub mean: &'a [F8],
    /// b, [2][node].
    pub source: &'a [F8],
    /// Out.
    pub external: &'a mut ExternalWork,
}

impl SourceStage<'_> {
    /// Adds it.
    #[inline(always)]
    pub fn add<L: Lanes>(self) {
        let n = self.masses.len();
        let (mut all, mut sum, mut momentum, mut power) = (L::zero(), [L::zero(); 2], [L::zero(); 2], L::zero());
        for (a, mass) in self.masses.iter().enumerate() {
            let (mass, b) = (L::load(mass), [L::load(&self.source[a]), L::load(&self.source[n + a])]);
            let v = load_array::<L, 2>(&self.mean[UNKNOWNS * a + DEFORMATION..UNKNOWNS * (a + 1)]);
            all = all + mass;
            power = mass.mul_add(dot(b, v), power);
            for k in 0..2 {
                sum[k] = mass.mul_add(b[k], sum[k]);
                momentum[k] = mass.mul_add(v[k], momentum[k]);
            }
        }
        let (factor, inverse) = (L::splat(self.factor), L::splat(1.0) / all);
        let b = [sum[0] * inverse, sum[1] * inverse];
        add(factor * L::splat(self.density), power - dot(b, momentum), &mut self.external.source);
        (0..2).for_each(|k| add(factor, b[k], &mut self.external.impulse[k]));
    }
}

/// The rest of the work of sources at the end of a step: the impulse with the mean of the momenta before and after. It is what a
/// uniform source gives to the kinetic energy, exactly: the averages of ADER's predictor, which does not see the neighbours,
/// would miss it by what the faces correct.
struct SourceEnd<'a> {
    /// By node.
    pub masses: &'a [F8],
    /// Momenta before the step, [2][node].
    pub before: &'a [F8],
    /// And after.
    pub after: &'a [F8],
    /// Out.
    pub external: &'a mut ExternalWork,
}

impl Work for SourceEnd<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = self.masses.len();
        for k in 0..2 {
            let mut sum = L::zero();
            for (a, mass) in self.masses.iter().enumerate() {
                let momenta = L::load(&self.before[k * n + a]) + L::load(&self.after[k * n + a]);
                sum = L::load(mass).mul_add(momenta, sum);
            }
            add(L::splat(0.5) * L::load(&self.external.impulse[k]), sum, &mut self.external.source);
        }
    }
}
