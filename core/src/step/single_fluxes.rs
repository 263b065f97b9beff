//! Fluxes of faces at a boundary or at another material: cell by cell, not 8 at once.

use super::balance::{BlockBalance, boundary_loss, boundary_power};
use super::block::Block;
use super::creep::{Pulling, Springs};
use super::meter::Meter;
use super::sides::Sides;
use super::single_face::SingleFace;
use super::trace::gap;
use crate::boundary::Moment;
use crate::built;
use crate::lane::{F8, LANES};
use crate::operators::{MOST_FACE_POINTS, Neighbour};
use crate::riemann::{Looks, Trace, hold, interface};
use crate::state::UNKNOWNS;
use crate::tensor::DEFORMATION;

impl SingleFace<'_> {
    /// The flux at a point, from the traces of both sides, each with its own normal.
    ///
    /// Not inlined, nor are other functions here that are called once a face or a point: else what a program was built with decided
    /// how, and a run without an effect had other instructions than one by a program without it.
    #[inline(never)]
    pub fn flux(&self, sides: Sides, point: usize, memory: &mut [f64], springs: Option<Pulling>) -> [f64; UNKNOWNS] {
        let (block, at, lane) = (self.block, self.point(point), self.lane);
        let (scheme, law) = (block.scheme, block.law());
        let own = sides.of_point(point, scheme.operators.line.m);
        let trace = |x: &dyn Fn(usize) -> f64, sign: f64, law: &super::Law| {
            let f = [x(0), x(1), x(2), x(3)];
            let c = if scheme.flux.looks() == Looks::Shear { [x(8), x(9)] } else { law.speeds(f, at.normal) };
            Trace { f, v: [x(4), x(5)], t: [sign * x(6), sign * x(7)], c }
        };
        let minus = trace(&|k| own[k].0[lane], 1.0, law);
        match self.neighbour {
            Neighbour::Boundary(group) => {
                let memory = scheme.boundary_memory.of_point(memory, [block.number, self.face, lane, point]);
                let when = Moment { times: block.stage.times, dt: block.factor() };
                let condition = &scheme.boundaries[group];
                let mut flux = |inside: &Trace<f64>| condition.flux(inside, &at, &when, memory);
                match springs {
                    None => flux(&minus),
                    Some(springs) => {
                        block.pulled_at_boundary([self.face, point, lane], group, &at, &minus, springs, flux)
                    }
                }
            }
            Neighbour::Interface(_, material) => {
                let beyond = &scheme.laws[material];
                let plus = trace(&|k| sides.other.number(point, k, own.len(), lane), -1.0, beyond);
                // Between two laws of the small strain no direction turns.
                let turns = law.is_objective() || beyond.is_objective();
                let [minus, plus] =
                    [minus, plus].map(|side| if turns { side } else { Trace { f: [1.0, 0.0, 0.0, 1.0], ..side } });
                let mut flux = interface(&minus, &plus, at.normal, [law.density(), beyond.density()]);
                if let Some(springs) = springs {
                    block.pull_between([self.face, point, lane], material, [&minus, &plus], springs, &mut flux);
                }
                flux
            }
            Neighbour::Cell(_) | Neighbour::Padding => [0.0; UNKNOWNS],
        }
    }

    /// The lifted numbers at a point.
    #[inline(always)]
    fn lift(&self, own: &[F8], point: usize, flux: &[f64; UNKNOWNS], lift: &mut [F8; UNKNOWNS]) {
        let (normal, length) = self.normal_and_length(point);
        for (k, flux) in flux.iter().enumerate() {
            let own = if k < DEFORMATION { own[DEFORMATION + k / 2].0[self.lane] * normal[k % 2] } else { 0.0 };
            lift[k].0[self.lane] = (flux + own) * length;
        }
    }

    /// Books what the fluxes at the boundary give to the body.
    #[inline(always)]
    fn book_work(&self, fluxes: &[[f64; UNKNOWNS]], meter: &mut Meter) {
        let Some(external) = &mut meter.external else { return };
        for (point, flux) in fluxes.iter().enumerate() {
            external.boundary.0[self.lane] +=
                self.weight(point) * boundary_power(flux, self.normal_and_length(point).0);
        }
    }

    /// Books what a condition loses; `stored`: what the springs store, W/m^2.
    #[inline(never)]
    fn book_loss(&self, sides: Sides, fluxes: &[[f64; UNKNOWNS]], stored: &[f64], balance: &mut BlockBalance) {
        for (point, (flux, stored)) in fluxes.iter().zip(stored).enumerate() {
            let (own, normal) = (sides.of_point(point, fluxes.len()), self.normal_and_length(point).0);
            balance.boundary.0[self.lane] +=
                self.weight(point) * (boundary_loss(own, flux, normal, self.lane) - stored);
        }
    }

    /// dt b_s w len of a point.
    #[inline(always)]
    fn weight(&self, point: usize) -> f64 {
        let length = self.normal_and_length(point).1;
        self.block.scheme.operators.line.basis.weights[point] * length * self.block.factor()
    }

    /// What is held at a point: nothing at a boundary, and by fluxes that do not look at the displacement.
    #[inline(always)]
    fn held(&self, sides: Sides, point: usize) -> [f64; 2] {
        match (self.block.scheme.flux.looks(), self.neighbour) {
            (Looks::Displacement, Neighbour::Interface(_, material)) => self.held_between(material, sides, point),
            _ => [0.0; 2],
        }
    }

    /// The same between two laws.
    #[inline(never)]
    fn held_between(&self, material: usize, sides: Sides, point: usize) -> [f64; 2] {
        let (scheme, law) = (self.block.scheme, self.block.law());
        let own = sides.of_point(point, scheme.operators.line.m);
        let there: [f64; 11] = std::array::from_fn(|k| sides.other.number(point, k, own.len(), self.lane));
        let here: [f64; 11] = std::array::from_fn(|k| own[k].0[self.lane]);
        let densities = [law.density(), scheme.laws[material].density()];
        hold(gap(&here, &there), [densities[0] * (here[8] * here[8]), densities[1] * (there[8] * there[8])], 1.0)
    }
}

impl Block<'_> {
    /// The lifted numbers of lanes at a boundary or at another material, in `lift`, [point][6]; what passes the boundary into
    /// `meter`.
    #[inline(never)]
    pub(super) fn single_fluxes(
        &self,
        sides: Sides,
        lift: &mut [F8],
        held: &mut [F8],
        mut springs: Option<&mut Springs>,
        meter: &mut Meter,
    ) {
        let is_special = sides.met.is_some() || springs.is_some() || (built::OBSTACLES && self.scheme.sees_faces);
        for lane in 0..LANES {
            let Some(face) = self.single_face(sides.face, lane) else { continue };
            let (mut all, mut stored) = ([[0.0; UNKNOWNS]; MOST_FACE_POINTS], [0.0; MOST_FACE_POINTS]);
            let fluxes = &mut all[..lift.len() / UNKNOWNS];
            if is_special {
                self.special_fluxes(&face, sides, springs.as_deref_mut(), meter.memory, (fluxes, &mut stored));
            } else {
                fluxes.iter_mut().enumerate().for_each(|(k, flux)| *flux = face.flux(sides, k, meter.memory, None));
            }
            for (point, (flux, lift)) in fluxes.iter().zip(lift.as_chunks_mut::<UNKNOWNS>().0).enumerate() {
                let between = face.held(sides, point);
                (0..2).for_each(|k| held[2 * point + k].0[lane] = between[k]);
                face.lift(sides.of_point(point, fluxes.len()), point, flux, lift);
            }
            if matches!(face.neighbour, Neighbour::Boundary(_)) {
                face.book_work(fluxes, meter);
                if let (true, Some(balance)) = (built::BALANCE, &mut meter.balance) {
                    face.book_loss(sides, fluxes, &stored, balance);
                }
            }
        }
    }

    /// The fluxes of a face that may have springs, may meet other faces, or whose condition may find them for all points at once; and what its springs
    /// store, W/m^2.
    #[inline(never)]
    fn special_fluxes(
        &self,
        face: &SingleFace,
        sides: Sides,
        mut springs: Option<&mut Springs>,
        memory: &mut [f64],
        (fluxes, stored): (&mut [[f64; UNKNOWNS]], &mut [f64]),
    ) {
        let m = fluxes.len();
        let sees_faces = built::OBSTACLES && self.scheme.sees_faces;
        let whole = if sees_faces { self.flux_of_whole_face([sides.face, face.lane], sides.own, memory) } else { None };
        for (point, (flux, stored)) in fluxes.iter_mut().zip(stored).enumerate() {
            if let Some(springs) = &mut springs {
                springs.keep(m * sides.face + point, face.lane);
            }
            let own = sides.of_point(point, m);
            let met = sides.met.and_then(|met| self.flux_of_meeting(met, face, own, point, memory));
            let found = met.or_else(|| whole.as_ref().map(|whole| whole[point]));
            let moving = springs.as_deref_mut().map(Pulling::Moving);
            *flux = found.unwrap_or_else(|| face.flux(sides, point, memory, moving));
            *stored = springs.as_ref().map_or(0.0, |springs| springs.stored);
        }
    }
}
