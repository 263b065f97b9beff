//! Fluxes (3) of the four faces of a block, lifted: len (Flux* - own flux of the F rows).

use super::across::{Aligned, Apart, Beyond, Joined, LaneByLane, Other, Traces};
use super::balance::{BlockBalance, FacePower, boundary_loss, boundary_power};
use super::block::Block;
use super::block_work::FluxWork;
use super::meeting_flux::Met;
use super::meetings::Meetings;
use super::outside::{ExternalWork, FaceForces};
use super::phase::{Part, Ticks};
use super::volume::{Arrays, width};
use crate::boundary::{FacePoint, Moment};
use crate::built;
use crate::lane::{F8, LANES, Lane, Lanes, load_array, store_array};
use crate::mesh::{FACES, map};
use crate::operators::{Metric, Neighbour, Side};
use crate::riemann::{Looks, Medium, Riemann, Trace, hold, interface};
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// Runs `$body` with `$numbers` bound to the constant numbers of a trace, see [`width`].
macro_rules! with_width {
    ($looks:expr, $metered:expr, $numbers:ident => $body:expr) => {
        match ($looks, $metered) {
            (Looks::Nothing, false) => with_width!(@ Nothing, false, $numbers, $body),
            (Looks::Nothing, true) => with_width!(@ Nothing, true, $numbers, $body),
            (Looks::Shear, false) => with_width!(@ Shear, false, $numbers, $body),
            (Looks::Shear, true) => with_width!(@ Shear, true, $numbers, $body),
            (Looks::Displacement, false) => with_width!(@ Displacement, false, $numbers, $body),
            (Looks::Displacement, true) => with_width!(@ Displacement, true, $numbers, $body),
        }
    };
    (@ $looks:ident, $metered:literal, $numbers:ident, $body:expr) => {{
        const $numbers: usize = width(Looks::$looks, $metered);
        $body
    }};
}

/// A trace of some lanes from its numbers.
#[inline(always)]
fn trace_of<L: Lanes, R: Riemann, const W: usize>(x: &[L; W]) -> Trace<L> {
    let shear = if R::LOOKS == Looks::Shear { x[9] } else { L::zero() };
    Trace { f: [x[0], x[1], x[2], x[3]], v: [x[4], x[5]], t: [x[6], x[7]], c: [x[8], shear] }
}

/// The other side's trace with this side's normal: its traction is P N^+ with N^+ = -N, and so is s = P T, which stands
/// behind c.
#[inline(always)]
fn turned<L: Lanes, R: Riemann, const W: usize>(mut x: [L; W]) -> [L; W] {
    x[6] = -x[6];
    x[7] = -x[7];
    if W == width(R::LOOKS, true) {
        x[W - 2] = -x[W - 2];
        x[W - 1] = -x[W - 1];
    }
    x
}

/// How fast a face turns, [`Medium::turn`], from v at its first and last point, which are `span` of its length apart.
#[inline(always)]
fn turn<L: Lanes, O: Other, const W: usize>(own: &[[F8; W]], other: &O, span: f64) -> L {
    let Some(last) = own.len().checked_sub(1).filter(|last| *last > 0) else { return L::zero() };
    let (first, beyond, beyond_last) = (&own[0], other.load::<L, W>(0), other.load::<L, W>(last));
    let mut square = L::zero();
    for k in DEFORMATION..UNKNOWNS {
        let change = (L::load(&own[last][k]) - L::load(&first[k])) + (beyond_last[k] - beyond[k]);
        square = change.mul_add(change, square);
    }
    square.sqrt() * L::splat(0.5 / span)
}

/// What is lifted of the held jump of displacement, [`hold`], from the numbers of both sides of one law.
#[inline(always)]
fn held<L: Lane>(own: &[L], there: &[L], density: f64) -> [L; 2] {
    hold(gap(own, there), [own[8] * own[8], there[8] * there[8]], density)
}

/// The jump of displacement, from the numbers of both sides.
#[inline(always)]
fn gap<L: Lane>(own: &[L], there: &[L]) -> [L; 2] {
    [there[9] - own[9], there[10] - own[10]]
}

/// The four faces of a block, all lanes as faces between cells of one law.
pub(super) struct Faces<'a> {
    metered: bool,
    /// Own traces, [face][point][width].
    own: &'a [F8],
    /// The other side's, by face, with its own normal.
    other: &'a [Beyond<'a>; FACES],
    metric: &'a Metric<F8>,
    /// Points of a face.
    points: usize,
    /// From the first to the last of them, over the length of the face.
    span: f64,
    medium: Medium<f64>,
    /// [face][point][6], out.
    lift: &'a mut [F8],
    /// What is held, [face][point][2], out where the flux looks at the displacement.
    held: &'a mut [F8],
}

impl FluxWork for Faces<'_> {
    #[inline(always)]
    fn run<L: Lanes, R: Riemann>(mut self, riemann: &R) {
        with_width!(R::LOOKS, self.metered, W => {
            for face in 0..FACES {
                // One loop for each way in which the traces lie: none looks at it point by point.
                match self.other[face] {
                    Beyond::Aligned(other) => self.of_face::<L, _, _, W>(face, other, riemann),
                    Beyond::Joined(other) => self.of_face::<L, _, _, W>(face, other, riemann),
                    Beyond::Apart(other) if L::PICKS => self.of_face::<L, _, _, W>(face, other, riemann),
                    Beyond::Apart(other) => {
                        self.of_face::<L, _, _, W>(face, LaneByLane::new::<W>(other), riemann);
                    }
                }
            }
        });
    }
}

impl Faces<'_> {
    #[inline(always)]
    fn of_face<L: Lanes, O: Other, R: Riemann, const W: usize>(&mut self, face: usize, other: O, riemann: &R) {
        let m = self.points;
        let mut medium = self.medium.splat::<L>();
        let own = &self.own.as_chunks::<W>().0[face * m..(face + 1) * m];
        if R::LOOKS == Looks::Displacement {
            medium.turn = turn::<L, O, W>(own, &other, self.span);
        }
        let metric = self.metric.load::<L>();
        let (normal, length) = (metric.normal(face), metric.length(face));
        let lift = &mut self.lift.as_chunks_mut::<UNKNOWNS>().0[m * face..m * (face + 1)];
        for point in 0..m {
            let minus = trace_of::<L, R, W>(&load_array::<L, W>(&own[point]));
            let there = turned::<L, R, W>(other.load::<L, W>(point));
            let plus = trace_of::<L, R, W>(&there);
            if R::LOOKS == Looks::Displacement {
                let held = held(&load_array::<L, W>(&own[point]), &there, self.medium.density);
                store_array(held, &mut self.held.as_chunks_mut::<2>().0[m * face + point]);
            }
            store_array(riemann.lifted(&minus, &plus, normal, &medium, length), &mut lift[point]);
        }
    }
}

/// The traces of a face of a block, [point][width].
#[derive(Clone, Copy)]
struct Sides<'a> {
    face: usize,
    own: &'a [F8],
    /// With its own normal; lanes at a boundary see themselves or what they must not use.
    other: &'a Beyond<'a>,
    /// What else faces of the block meet; none where no condition pairs faces.
    met: Option<Met<'a>>,
}

/// Where the energy that passes the faces of a block goes.
pub(super) struct Meter<'a> {
    /// The work on the block; none where nothing outside touches it.
    pub external: Option<&'a mut ExternalWork>,
    /// The forces at the faces; none where nobody asks for them.
    pub forces: Option<&'a mut FaceForces>,
    /// The balance; none where it is off.
    pub balance: Option<&'a mut BlockBalance>,
    /// The memory of the conditions at the block.
    pub memory: &'a mut [f64],
    /// The clock of the thread.
    pub phases: &'a mut Ticks,
}

impl Meter<'_> {
    /// The work of the boundary on the block so far; none where nobody asks for forces.
    fn work_so_far(&self) -> Option<F8> {
        self.forces.as_ref().and(self.external.as_ref()).map(|external| external.boundary)
    }
}

/// What a face between cells adds to the balance of the block. The fluxes are found once more: without the balance they never come to
/// memory.
pub(super) struct FaceBalance<'a, 'b> {
    block: Block<'a>,
    sides: Sides<'a>,
    balance: &'b mut BlockBalance,
}

impl FluxWork for FaceBalance<'_, '_> {
    #[inline(always)]
    fn run<L: Lanes, R: Riemann>(self, riemann: &R) {
        with_width!(R::LOOKS, true, W => self.with::<L, _, W>(riemann));
    }
}

impl FaceBalance<'_, '_> {
    #[inline(always)]
    fn with<L: Lanes, R: Riemann, const W: usize>(self, riemann: &R) {
        let Self { block, sides, balance } = self;
        let (scheme, metric, face) = (block.scheme, block.metric().load::<L>(), sides.face);
        let neighbours = &scheme.operators.blocks.neighbours[block.number][face];
        let factor = block.factor();
        let normal = metric.normal(face);
        let mut medium = block.medium().splat::<L>();
        if R::LOOKS == Looks::Displacement {
            medium.turn = turn::<L, _, W>(sides.own.as_chunks::<W>().0, sides.other, scheme.span());
        }
        let weights = &scheme.operators.line.basis.weights[..scheme.operators.line.m];
        for (point, (own, weight)) in sides.own.as_chunks::<W>().0.iter().zip(weights).enumerate() {
            let beyond = turned::<L, R, W>(sides.other.load::<L, W>(point));
            let minus = trace_of::<L, R, W>(&load_array::<L, W>(own));
            let plus = trace_of::<L, R, W>(&beyond);
            let (mut flux, mut there, mut scale) = ([F8::ZERO; UNKNOWNS], [F8::ZERO; W], F8::ZERO);
            store_array(riemann.flux(&minus, &plus, normal, &medium), &mut flux);
            store_array(beyond, &mut there);
            (metric.length(face) * L::splat(*weight * factor)).store(&mut scale);
            for (lane, neighbour) in neighbours.iter().enumerate() {
                match neighbour {
                    // What a condition loses is booked with its work; it has no jumps, and no flux that means anything.
                    Neighbour::Boundary(_) => {
                        (0..W).for_each(|k| there[k].0[lane] = own[k].0[lane]);
                        flux.iter_mut().for_each(|flux| flux.0[lane] = 0.0);
                    }
                    Neighbour::Interface(..) => {
                        let between = block.flux_of_lane(face, point, lane, own, sides.other, &mut []);
                        between.iter().for_each(|f| (0..UNKNOWNS).for_each(|k| flux[k].0[lane] = f[k]));
                    }
                    Neighbour::Cell(_) | Neighbour::Padding => {}
                }
            }
            let power = FacePower { minus: own, plus: &there, flux: &flux };
            power.jumps::<L, W>(&scale, normal, &mut balance.flux);
        }
    }
}

impl Block<'_> {
    /// Lifted numbers of all faces into `nodes.lift`; the energy that they pass into `meter`.
    pub fn lifted_fluxes(&self, traces: &Traces, meetings: Option<&Meetings>, nodes: &mut Arrays, mut meter: Meter) {
        let scheme = self.scheme;
        let (blocks, m) = (&scheme.operators.blocks, scheme.operators.line.m);
        let (flux, metered) = (scheme.flux.block(), meter.balance.is_some());
        let length = m * width(flux.looks(), metered);
        let plan = &blocks.plan[self.number];
        let mut other = [Beyond::Aligned(Aligned(&[])); FACES];
        for (other, plan) in other.iter_mut().zip(plan) {
            *other = match plan.side {
                Side::Aligned(there) => Beyond::Aligned(Aligned(traces.faces(there, 1, length))),
                Side::Joined { first, second, by } => Beyond::Joined(Joined {
                    first: traces.around(first, length),
                    second: traces.around(second, length),
                    by,
                }),
                Side::Gathered(entry) => Beyond::Apart(Apart { traces, from: &blocks.gathered[entry], points: m }),
            };
        }
        let own = traces.faces(FACES * self.number, FACES, length);
        let (metric, medium, span) = (self.metric(), self.medium(), scheme.span());
        let (lift, held) = (&mut nodes.lift[..], &mut nodes.held[..]);
        flux.faces(scheme.kernel, Faces { metered, own, other: &other, metric, points: m, span, medium, lift, held });
        for face in 0..FACES {
            let met = meetings.filter(|_| built::CONTACT).map(|meetings| Met { meetings, traces });
            let sides = Sides { face, own: &own[face * length..][..length], other: &other[face], met };
            if plan[face].has_boundary_or_interface {
                let held = &mut nodes.held[2 * m * face..2 * m * (face + 1)];
                let lift = &mut nodes.lift[UNKNOWNS * m * face..UNKNOWNS * m * (face + 1)];
                let start = meter.phases.start();
                let before = if built::FORCES { meter.work_so_far() } else { None };
                self.boundary_and_interface_lanes(sides, lift, held, &mut meter);
                if let Some(before) = before {
                    self.forces_at_face(face, lift, before, &mut meter);
                }
                meter.phases.book_part(Part::Conditions, start);
            }
            if let (true, Some(balance)) = (built::BALANCE, &mut meter.balance) {
                let start = meter.phases.start();
                flux.face_balance(scheme.kernel, FaceBalance { block: *self, sides, balance });
                meter.phases.book_part(Part::FaceBalance, start);
            }
        }
    }

    /// The lifted numbers of lanes at a boundary or at another material, in `lift`, [point][6]; what passes the boundary into
    /// `meter`.
    fn boundary_and_interface_lanes(&self, sides: Sides, lift: &mut [F8], held: &mut [F8], meter: &mut Meter) {
        let line = &self.scheme.operators.line;
        let (face, width) = (sides.face, sides.own.len() / line.m);
        let factor = self.factor();
        let whole = if built::OBSTACLES && self.scheme.sees_faces {
            self.fluxes_of_whole_faces(face, sides.own, meter.memory)
        } else {
            vec![]
        };
        for (point, (own, lift)) in sides.own.chunks_exact(width).zip(lift.as_chunks_mut::<UNKNOWNS>().0).enumerate() {
            for lane in 0..LANES {
                let memory = &mut *meter.memory;
                let met = sides.met.and_then(|met| self.flux_of_meeting(met, [face, point, lane], own, memory));
                let met = met.or_else(|| whole.iter().find(|whole| whole.0 == lane).map(|whole| whole.1[point]));
                let flux = met.or_else(|| self.flux_of_lane(face, point, lane, own, sides.other, memory));
                let Some(flux) = flux else { continue };
                let between = self.held_between(face, point, lane, own, sides.other);
                (0..2).for_each(|k| held[2 * point + k].0[lane] = between[k]);
                let metric = self.metric().lane(lane);
                let (normal, length) = (metric.normal(face), metric.length(face));
                for (k, flux) in flux.iter().enumerate() {
                    let own = if k < DEFORMATION { own[DEFORMATION + k / 2].0[lane] * normal[k % 2] } else { 0.0 };
                    lift[k].0[lane] = (flux + own) * length;
                }
                let neighbour = &self.scheme.operators.blocks.neighbours[self.number][face][lane];
                if let (Some(external), Neighbour::Boundary(_)) = (&mut meter.external, neighbour) {
                    let weight = line.basis.weights[point] * length * factor;
                    external.boundary.0[lane] += weight * boundary_power(&flux, normal);
                    if let (true, Some(balance)) = (built::BALANCE, &mut meter.balance) {
                        balance.boundary.0[lane] += weight * boundary_loss(own, &flux, normal, lane);
                    }
                }
            }
        }
    }

    /// Books the forces at a face, from its lifted numbers and the work on the block before it: once a face, so that where nobody asks
    /// for forces no boundary point knows of them.
    fn forces_at_face(&self, face: usize, lift: &[F8], before: F8, meter: &mut Meter) {
        let (Some(external), Some(forces)) = (&meter.external, &mut meter.forces) else { return };
        let neighbours = &self.scheme.operators.blocks.neighbours[self.number][face];
        let (weights, factor) = (&self.scheme.operators.line.basis.weights, self.factor());
        for (lane, _) in neighbours.iter().enumerate().filter(|(_, beyond)| matches!(beyond, Neighbour::Boundary(_))) {
            forces.work[face].0[lane] += external.boundary.0[lane] - before.0[lane];
            for (lift, weight) in lift.as_chunks::<UNKNOWNS>().0.iter().zip(weights) {
                // The flux of momentum is -t*, and its lifted numbers are those times the length of the face.
                let axes = lift[DEFORMATION..].iter().enumerate();
                axes.for_each(|(axis, flux)| forces.impulse[face][axis].0[lane] -= weight * factor * flux.0[lane]);
            }
        }
    }

    /// The flux of a lane at a boundary or at another material, from the `own` numbers at a point and the traces of the other
    /// side, each with its own normal; none elsewhere.
    fn flux_of_lane(
        &self,
        face: usize,
        point: usize,
        lane: usize,
        own: &[F8],
        other: &Beyond,
        memory: &mut [f64],
    ) -> Option<[f64; UNKNOWNS]> {
        let neighbour = &self.scheme.operators.blocks.neighbours[self.number][face][lane];
        if matches!(neighbour, Neighbour::Cell(_) | Neighbour::Padding) {
            return None;
        }
        let law = self.law();
        let at = self.face_point(face, point, lane);
        let trace = |x: &dyn Fn(usize) -> f64, sign: f64, law: &super::Law| {
            let f = [x(0), x(1), x(2), x(3)];
            let c = if self.scheme.flux.looks() == Looks::Shear { [x(8), x(9)] } else { law.speeds(f, at.normal) };
            Trace { f, v: [x(4), x(5)], t: [sign * x(6), sign * x(7)], c }
        };
        let minus = trace(&|k| own[k].0[lane], 1.0, law);
        match *neighbour {
            Neighbour::Boundary(group) => {
                let memory = self.scheme.boundary_memory.of_point(memory, [self.number, face, lane, point]);
                let when = Moment { times: self.stage.times, dt: self.factor() };
                Some(self.scheme.boundaries[group].flux(&minus, &at, &when, memory))
            }
            Neighbour::Interface(_, material) => {
                let beyond = &self.scheme.laws[material];
                let plus = trace(&|k| other.number(point, k, own.len(), lane), -1.0, beyond);
                Some(interface(&minus, &plus, at.normal, [law.density(), beyond.density()]))
            }
            Neighbour::Cell(_) | Neighbour::Padding => None,
        }
    }

    /// What is held in a lane at a boundary, nothing, or between two laws.
    fn held_between(&self, face: usize, point: usize, lane: usize, own: &[F8], other: &Beyond) -> [f64; 2] {
        let neighbour = &self.scheme.operators.blocks.neighbours[self.number][face][lane];
        match (self.scheme.flux.looks(), neighbour) {
            (Looks::Displacement, Neighbour::Interface(_, material)) => {
                let there: [f64; 11] = std::array::from_fn(|k| other.number(point, k, own.len(), lane));
                let here: [f64; 11] = std::array::from_fn(|k| own[k].0[lane]);
                let densities = [self.law().density(), self.scheme.laws[*material].density()];
                hold(
                    gap(&here, &there),
                    [densities[0] * (here[8] * here[8]), densities[1] * (there[8] * there[8])],
                    1.0,
                )
            }
            _ => [0.0; 2],
        }
    }

    pub(super) fn face_point(&self, face: usize, point: usize, lane: usize) -> FacePoint {
        let geometry = &self.scheme.operators.geometry;
        let along = self.scheme.operators.line.basis.nodes[point];
        let end = (face % 2) as f64;
        let xi = if face < 2 { [end, along] } else { [along, end] };
        let x = map::position(&geometry.corners_of(self.number, lane), xi);
        let normal = geometry.blocks[self.number].lane(lane).normal(face);
        FacePoint { x, normal, medium: self.medium() }
    }
}
