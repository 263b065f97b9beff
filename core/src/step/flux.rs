//! Fluxes (3) of the four faces of a block, lifted: len (Flux* - own flux of the F rows).

mod special;

pub(super) use special::SpecialFaces;

use super::across::{Aligned, Apart, Beyond, Joined, LaneByLane, Other, Traces};
use super::balance::{BlockBalance, boundary_loss, boundary_power};
use super::block::Block;
use super::block_work::FluxWork;
use super::creep::{Creep, Pulling, Springs};
use super::face_balance::{FaceBalance, Sides};
use super::meeting_flux::Met;
use super::meetings::Meetings;
use super::outside::{ExternalWork, FaceForces};
use super::phase::{Part, Ticks};
use super::trace::{gap, held, trace_of, turn, turned, with_width};
use super::volume::{Arrays, width};
use crate::boundary::{FacePoint, Moment};
use crate::built;
use crate::lane::{F8, LANES, Lanes, load_array, store_array};
use crate::mesh::{FACES, map};
use crate::operators::{Metric, Neighbour, Side};
use crate::riemann::{Looks, Medium, Riemann, Trace, hold, interface};
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// The four faces of a block with straight cells and without springs, all lanes as faces between cells of one law.
pub(super) struct Faces<'a> {
    metered: bool,
    /// Own traces, [face][point][width].
    own: &'a [F8],
    /// The other side's, by face, with its own normal.
    other: &'a [Beyond<'a>; FACES],
    metric: &'a Metric<F8>,
    /// Points of a face.
    points: usize,
    /// See [`Block::turning`].
    turning: f64,
    medium: Medium<f64>,
    /// [face][point][6], out.
    lift: &'a mut [F8],
    /// What is held, [face][point][2], out where the flux looks at the displacement.
    held: &'a mut [F8],
}

/// Runs `$body` with `$other` as the [`Other`] that a [`Beyond`] is: one loop for each way in which the traces lie, so that none looks at
/// it point by point.
macro_rules! with_other {
    ($lanes:ident, $numbers:ident, $beyond:expr, $other:ident => $body:expr) => {
        match $beyond {
            Beyond::Aligned($other) => $body,
            Beyond::Joined($other) => $body,
            Beyond::Apart($other) if $lanes::PICKS => $body,
            Beyond::Apart(apart) => {
                let $other = LaneByLane::new::<$numbers>(apart);
                $body
            }
        }
    };
}
use with_other;

impl FluxWork for Faces<'_> {
    #[inline(always)]
    fn run<L: Lanes, R: Riemann>(mut self, riemann: &R) {
        with_width!(R::LOOKS, self.metered, W => {
            for face in 0..FACES {
                with_other!(L, W, self.other[face], other => self.of_face::<L, _, _, W>(face, other, riemann));
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
            medium.turn = turn::<L, O, W>(own, &other, self.turning);
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
    /// The creep of the faces of the block; none where they have no springs.
    pub creep: Option<Creep<'a>>,
    /// The clock of the thread.
    pub phases: &'a mut Ticks,
}

impl Meter<'_> {
    /// The work of the boundary on the block so far; none where nobody asks for forces.
    fn work_so_far(&self) -> Option<F8> {
        self.forces.as_ref().and(self.external.as_ref()).map(|external| external.boundary)
    }
}

impl Block<'_> {
    /// Lifted numbers of all faces into `nodes.lift`; the energy that they pass into `meter`.
    pub fn lifted_fluxes(&self, traces: &Traces, meetings: Option<&Meetings>, nodes: &mut Arrays, mut meter: Meter) {
        let scheme = self.scheme;
        let (blocks, m) = (&scheme.operators.blocks, scheme.operators.line.m);
        let (flux, metered) = (scheme.flux.block(), meter.balance.is_some());
        let length = m * width(flux.looks(), metered);
        let (plan, other) = (&blocks.plan[self.number], self.beyond(traces, length));
        let own = traces.faces(FACES * self.number, FACES, length);
        let (metric, medium) = (self.metric(), self.medium());
        let creep = meter.creep.take();
        let mut springs = creep.and_then(|creep| Springs::new(self, creep, &mut nodes.creep));
        let (pull, turning) = (springs.as_ref().map(|own| own.pull), self.turning());
        let faces = Faces {
            metered,
            own,
            other: &other,
            metric: metric.straight,
            points: m,
            turning,
            medium,
            lift: &mut nodes.lift,
            held: &mut nodes.held,
        };
        if springs.is_some() || metric.curved.is_some() {
            let springs = springs.as_mut().map(Springs::again);
            flux.special_faces(scheme.kernel, SpecialFaces { faces, metric, springs });
        } else {
            flux.faces(scheme.kernel, faces);
        }
        for face in 0..FACES {
            let met = meetings.filter(|_| built::CONTACT).map(|meetings| Met { meetings, traces });
            let sides = Sides { face, own: &own[face * length..][..length], other: &other[face], met };
            if plan[face].has_boundary_or_interface {
                let held = &mut nodes.held[2 * m * face..2 * m * (face + 1)];
                let lift = &mut nodes.lift[UNKNOWNS * m * face..UNKNOWNS * m * (face + 1)];
                let start = meter.phases.start();
                let before = if built::FORCES { meter.work_so_far() } else { None };
                self.boundary_and_interface_lanes(sides, lift, held, springs.as_mut(), &mut meter);
                if let Some(before) = before {
                    self.forces_at_face(face, lift, before, &mut meter);
                }
                meter.phases.book_part(Part::Conditions, start);
            }
            if let (true, Some(balance)) = (built::BALANCE, &mut meter.balance) {
                let start = meter.phases.start();
                flux.face_balance(scheme.kernel, FaceBalance { block: *self, sides, pull, balance });
                meter.phases.book_part(Part::FaceBalance, start);
            }
        }
    }

    /// The traces across the four faces, each face having `length` numbers.
    #[inline(always)]
    fn beyond<'t>(&'t self, traces: &'t Traces, length: usize) -> [Beyond<'t>; FACES] {
        let (blocks, points) = (&self.scheme.operators.blocks, self.scheme.operators.line.m);
        let mut other = [Beyond::Aligned(Aligned(&[])); FACES];
        for (other, plan) in other.iter_mut().zip(&blocks.plan[self.number]) {
            *other = match plan.side {
                Side::Aligned(there) => Beyond::Aligned(Aligned(traces.faces(there, 1, length))),
                Side::Joined { first, second, by } => Beyond::Joined(Joined {
                    first: traces.around(first, length),
                    second: traces.around(second, length),
                    by,
                }),
                Side::Gathered(entry) => Beyond::Apart(Apart { traces, from: &blocks.gathered[entry], points }),
            };
        }
        other
    }

    /// The lifted numbers of lanes at a boundary or at another material, in `lift`, [point][6]; what passes the boundary into
    /// `meter`.
    fn boundary_and_interface_lanes(
        &self,
        sides: Sides,
        lift: &mut [F8],
        held: &mut [F8],
        mut springs: Option<&mut Springs>,
        meter: &mut Meter,
    ) {
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
                let neighbour = &self.scheme.operators.blocks.neighbours[self.number][face][lane];
                if let (Some(springs), Neighbour::Boundary(_) | Neighbour::Interface(..)) = (&mut springs, neighbour) {
                    springs.keep(line.m * face + point, lane);
                }
                let met = sides.met.and_then(|met| self.flux_of_meeting(met, [face, point, lane], own, memory));
                let met = met.or_else(|| whole.iter().find(|whole| whole.0 == lane).map(|whole| whole.1[point]));
                let flux = met.or_else(|| {
                    let springs = springs.as_deref_mut().map(Pulling::Moving);
                    self.flux_of_lane([face, point, lane], own, sides.other, memory, springs)
                });
                let Some(flux) = flux else { continue };
                let between = self.held_between(face, point, lane, own, sides.other);
                (0..2).for_each(|k| held[2 * point + k].0[lane] = between[k]);
                let (normal, length) = self.metric().at_face_of(lane, face, point);
                for (k, flux) in flux.iter().enumerate() {
                    let own = if k < DEFORMATION { own[DEFORMATION + k / 2].0[lane] * normal[k % 2] } else { 0.0 };
                    lift[k].0[lane] = (flux + own) * length;
                }
                if let (Some(external), Neighbour::Boundary(_)) = (&mut meter.external, neighbour) {
                    let weight = line.basis.weights[point] * length * factor;
                    external.boundary.0[lane] += weight * boundary_power(&flux, normal);
                    if let (true, Some(balance)) = (built::BALANCE, &mut meter.balance) {
                        let stored = springs.as_ref().map_or(0.0, |springs| springs.stored);
                        balance.boundary.0[lane] += weight * (boundary_loss(own, &flux, normal, lane) - stored);
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
    pub(super) fn flux_of_lane(
        &self,
        [face, point, lane]: [usize; 3],
        own: &[F8],
        other: &Beyond,
        memory: &mut [f64],
        springs: Option<Pulling>,
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
                let condition = &self.scheme.boundaries[group];
                let mut flux = |inside: &Trace<f64>| condition.flux(inside, &at, &when, memory);
                Some(match springs {
                    None => flux(&minus),
                    Some(springs) => self.pulled_at_boundary([face, point, lane], group, &at, &minus, springs, flux),
                })
            }
            Neighbour::Interface(_, material) => {
                let beyond = &self.scheme.laws[material];
                let plus = trace(&|k| other.number(point, k, own.len(), lane), -1.0, beyond);
                let mut flux = interface(&minus, &plus, at.normal, [law.density(), beyond.density()]);
                if let Some(springs) = springs {
                    self.pull_between([face, point, lane], material, [&minus, &plus], springs, &mut flux);
                }
                Some(flux)
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
        let x = map::position(&geometry.map_of(self.number, lane), xi);
        let (normal, _) = self.metric().at_face_of(lane, face, point);
        FacePoint { x, normal, medium: self.medium() }
    }
}
