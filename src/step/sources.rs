//! Sources of momentum: rho0 b at points and nodes, and the work that they do.

use super::balance::add;
use super::block::Block;
use super::outside::ExternalWork;
use super::predictor::Arrays;
use super::sweeps::Sweep;
use super::volume;
use crate::lane::{F8, LANES, Lanes, Work, load_array};
use crate::mesh::map;
use crate::operators::Points;
use crate::state::UNKNOWNS;
use crate::tensor::{AXES, DEFORMATION, dot};

/// Time nodes of a step at most.
const MOST_TIMES: usize = 8;

impl Block<'_> {
    /// b at the points and time nodes with v of t_n, for the first guess of the predictor, into `arrays.source`.
    pub fn sources_at_points(&self, points: &Points, count: usize, arrays: &mut Arrays) {
        let (start, inverse) = (&arrays.start, 1.0 / self.law().density());
        let now = |p: usize, lane: usize| [0, 1].map(|k| start[UNKNOWNS * p + DEFORMATION + k].0[lane] * inverse);
        let v = |_: &[F8], p: usize, lane: usize| [now(p, lane); MOST_TIMES];
        self.sources_with(points, count, v, &mut arrays.source);
    }

    /// The same with v of the sweep before `sweep`, from its rates and from b itself.
    pub fn renew_sources(&self, points: &Points, integration: &[f64], sweep: &Sweep, arrays: &mut Arrays) {
        let count = self.scheme.operators.block_points(self.number);
        let (times, dt, density) = (self.stage.times.len(), self.stage.dt, self.law().density());
        let (start, rates) = (&arrays.start, &arrays.rates[0]);
        let at = |known: &[F8], s: usize, p: usize, lane: usize| {
            [0, 1].map(|k| {
                let rate = |j: usize| rates[UNKNOWNS * (j * count + p) + DEFORMATION + k].0[lane];
                let b = |j: usize| known[AXES * (j * count + p) + k].0[lane];
                let flux: f64 = (0..sweep.from).map(|j| sweep.at_times[s * sweep.from + j] * rate(j)).sum();
                let given: f64 = (0..times).map(|j| integration[s * times + j] * b(j)).sum();
                start[UNKNOWNS * p + DEFORMATION + k].0[lane] / density + dt * (flux / density + given)
            })
        };
        let v = |known: &[F8], p: usize, lane: usize| {
            std::array::from_fn(|s| if s < times { at(known, s, p, lane) } else { [0.0; AXES] })
        };
        self.sources_with(points, count, v, &mut arrays.source);
    }

    /// b at the points and time nodes, [time node][point][2], with v at all time nodes by v(b so far, point, lane).
    fn sources_with(
        &self,
        points: &Points,
        count: usize,
        v: impl Fn(&[F8], usize, usize) -> [[f64; AXES]; MOST_TIMES],
        out: &mut [F8],
    ) {
        for lane in 0..LANES {
            let corners = self.scheme.operators.geometry.corners_of(self.number, lane);
            for p in 0..count {
                let at = points.first[self.number] + p;
                let x = map::position(&corners, [0, 1].map(|k| points.parent[AXES * at + k].0[lane]));
                let v = v(out, p, lane);
                for (s, node) in self.stage.times.iter().enumerate() {
                    let b = self.acceleration(x, node.time, v[s], lane);
                    for (k, b) in b.into_iter().enumerate() {
                        out[AXES * (s * count + p) + k].0[lane] = b;
                    }
                }
            }
        }
    }

    /// b at the nodes, averaged over the time nodes, [2][node]; `mean` has F and v of the stage, [node][6].
    pub fn sources_at_nodes(&self, mean: &[F8], out: &mut [F8]) {
        let n = self.scheme.operators.nodes();
        for lane in 0..LANES {
            let corners = self.scheme.operators.geometry.corners_of(self.number, lane);
            for a in 0..n {
                let x = map::position(&corners, self.scheme.operators.line.basis.node_2d(a));
                let v = [0, 1].map(|k| mean[UNKNOWNS * a + DEFORMATION + k].0[lane]);
                let mut average = [0.0; 2];
                for node in self.stage.times {
                    let b = self.acceleration(x, node.time, v, lane);
                    average = [0, 1].map(|k| average[k] + node.weight * b[k]);
                }
                (0..AXES).for_each(|k| out[k * n + a].0[lane] = average[k]);
            }
        }
    }

    /// Sum of all sources; padding lanes stay at rest.
    fn acceleration(&self, x: [f64; 2], time: f64, v: [f64; 2], lane: usize) -> [f64; 2] {
        if lane >= self.cells() {
            return [0.0; 2];
        }
        self.scheme.sources.iter().fold([0.0; 2], |sum, source| {
            let b = source.acceleration(x, time, v, self.material());
            [sum[0] + b[0], sum[1] + b[1]]
        })
    }
}

/// Adds J rho0 b at the nodes to the rates of p, and the work of the stage to the external work.
pub(super) struct AddSources<'a> {
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
pub(super) struct SourceEnd<'a> {
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
