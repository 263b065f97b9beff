//! Fluxes (3) of the four faces of a block, lifted: len (Flux* - own flux of the F rows).

mod special;

pub(super) use special::SpecialFaces;

use super::across::{Aligned, Apart, Beyond, Joined, LaneByLane, Other, Traces};
use super::block::Block;
use super::block_work::FluxWork;
use super::creep::{Pull, Springs};
use super::face_balance::FaceBalance;
use super::meetings::Meetings;
use super::meter::Meter;
use super::phase::Part;
use super::sides::{Met, Sides};
use super::trace::{held, trace_of, turn, turned, with_width};
use super::volume::{Arrays, width};
use crate::built;
use crate::lane::{F8, Lanes, load_array, store_array};
use crate::mesh::FACES;
use crate::operators::{Metric, Neighbour, Side};
use crate::riemann::{Looks, Medium, Riemann};
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

/// The four faces of a block with straight cells and without springs, of a law that sees how the body turns; all lanes as faces between
/// cells of one law.
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
        // Known here: asked at each point it is 1 % of all instructions.
        let mut medium = self.medium.objective(true).splat::<L>();
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

/// The traces of the faces of a block.
struct SidesOfFaces<'a> {
    /// [face][point][width].
    own: &'a [F8],
    other: &'a [Beyond<'a>; FACES],
    met: Option<Met<'a>>,
}

impl<'a> SidesOfFaces<'a> {
    /// Those of a face.
    fn of(&self, face: usize) -> Sides<'a> {
        let length = self.own.len() / FACES;
        Sides { face, own: &self.own[face * length..][..length], other: &self.other[face], met: self.met }
    }
}

impl Block<'_> {
    /// Lifted numbers of all faces into `nodes.lift`; the energy that they pass into `meter`.
    #[inline(always)]
    pub fn lifted_fluxes(&self, traces: &Traces, meetings: Option<&Meetings>, nodes: &mut Arrays, mut meter: Meter) {
        let scheme = self.scheme;
        let (blocks, m) = (&scheme.operators.blocks, scheme.operators.line.m);
        let (flux, metered) = (scheme.flux.block(), meter.balance.is_some());
        let length = m * width(flux.looks(), metered);
        let (plan, other) = (&blocks.plan[self.number], self.beyond(traces, length));
        let own = traces.faces(FACES * self.number, FACES, length);
        let (metric, medium) = (self.metric(), self.medium());
        let creep = meter.creep.take();
        let creeping = &mut nodes.creep;
        let mut springs = creep.and_then(|creep| Springs::new(self, creep, creeping));
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
        if springs.is_some() || metric.curved.is_some() || !medium.is_objective {
            let springs = springs.as_mut().map(Springs::again);
            flux.special_faces(scheme.kernel, SpecialFaces { faces, metric, springs });
        } else {
            flux.faces(scheme.kernel, faces);
        }
        let met = meetings.filter(|_| built::CONTACT).map(|meetings| Met { meetings, traces });
        let sides = SidesOfFaces { own, other: &other, met };
        if plan.iter().any(|face| face.has_boundary_or_interface) {
            let (lift, held) = (&mut nodes.lift[..], &mut nodes.held[..]);
            match built::FORCES && meter.forces.is_some() {
                true => self.single_faces::<true>(&sides, lift, held, springs, &mut meter),
                false => self.single_faces::<false>(&sides, lift, held, springs, &mut meter),
            }
        }
        if built::BALANCE && metered {
            self.balance_of_faces(&sides, pull, &mut meter);
        }
    }

    /// Lifted numbers of the faces at a boundary or at another material; with FORCES, the forces there are booked. By itself, as
    /// [`Block::balance_of_faces`], so that blocks inside the body have no instruction of it, nor those at a boundary one of forces.
    #[inline(never)]
    fn single_faces<const FORCES: bool>(
        &self,
        sides: &SidesOfFaces,
        lift: &mut [F8],
        held: &mut [F8],
        mut springs: Option<Springs>,
        meter: &mut Meter,
    ) {
        let (plan, m) = (&self.scheme.operators.blocks.plan[self.number], self.scheme.operators.line.m);
        for face in (0..FACES).filter(|face| plan[*face].has_boundary_or_interface) {
            let held = &mut held[2 * m * face..2 * m * (face + 1)];
            let lift = &mut lift[UNKNOWNS * m * face..UNKNOWNS * m * (face + 1)];
            let start = meter.phases.start();
            let before = if FORCES { meter.external.as_ref().map(|external| external.boundary) } else { None };
            self.single_fluxes(sides.of(face), lift, held, springs.as_mut(), meter);
            if let (true, Some(before)) = (FORCES, before) {
                self.forces_at_face(face, lift, before, meter);
            }
            meter.phases.book_part(Part::Conditions, start);
        }
    }

    /// What all faces add to the balance.
    #[inline(never)]
    fn balance_of_faces(&self, sides: &SidesOfFaces, pull: Option<Pull>, meter: &mut Meter) {
        let (scheme, Some(balance)) = (self.scheme, &mut meter.balance) else { return };
        for face in 0..FACES {
            let start = meter.phases.start();
            let sides = sides.of(face);
            scheme.flux.block().face_balance(scheme.kernel, FaceBalance { block: *self, sides, pull, balance });
            meter.phases.book_part(Part::FaceBalance, start);
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
}
