//! The creep of faces ([`crate::riemann::creep`]) in a step: a at each face point of each cell, in [`State::creep`]. Both cells of a face
//! keep it, from the same numbers.
//!
//! All stages of a step see a of its start; the step is some hundredth of the relaxation time, and what the step then loses at a face
//! is Y^-1 |da/dt|^2 (1 - k Y dt/2), above 0.

use super::block::Block;
use super::{Flux, Law, Scheme};
use crate::boundary::GivesBack;
use crate::error::{Error, Result};
use crate::lane::{F8, LANES, Lanes, load_array, store_array};
use crate::mesh::FACES;
use crate::operators::Neighbour;
use crate::riemann::{Looks, Medium, Riemann, Trace, creep, summed_impedance, tangent};
use crate::state::{State, UNKNOWNS};
use crate::tensor::{AXES, DEFORMATION, dot, times};

/// The creep of the faces of a block in a stage, [face][point][2], m.
pub(super) struct Creep<'a> {
    /// At the start of the step.
    pub start: &'a [F8],
    /// As the stage before has left it (in), and with this one (out).
    pub now: &'a mut [F8],
}

/// What pulls at the faces of a block: the creep at the start of the step.
#[derive(Clone, Copy)]
pub(super) struct Pull<'a> {
    start: &'a [F8],
    /// k l, Pa.
    modulus: f64,
}

/// The springs of the faces of a block in a stage.
pub(super) struct Springs<'a> {
    /// What they pull with.
    pub pull: Pull<'a>,
    /// a after the stage before.
    before: &'a [F8],
    /// With this stage, out.
    now: &'a mut [F8],
    /// What a rate counts in the step, s.
    dt: f64,
}

impl<'a> Springs<'a> {
    /// Those of a block, if it has any; `memory` has room for a.
    pub fn new(block: &Block, creep: Creep<'a>, memory: &'a mut [F8]) -> Option<Self> {
        let modulus = block.scheme.spring_between([block.material(); 2]);
        if modulus == 0.0 {
            return None;
        }
        let Creep { start, now } = creep;
        let before = if block.stage.number == 0 {
            start
        } else {
            memory.copy_from_slice(now);
            memory
        };
        Some(Self { pull: Pull { start, modulus }, before, now, dt: block.factor() })
    }

    /// The same for a shorter time.
    pub fn again(&mut self) -> Springs<'_> {
        Springs { pull: self.pull, before: self.before, now: self.now, dt: self.dt }
    }

    /// A point between two cells of one law: moves a, and takes the pull of the spring out of what is lifted.
    #[inline(always)]
    pub fn act<L: Lanes, R: Riemann>(
        &mut self,
        at: usize,
        riemann: &R,
        sides: [&Trace<L>; 2],
        (normal, length): ([L; 2], L),
        medium: &Medium<L>,
        lift: &mut [F8; UNKNOWNS],
    ) {
        let point = Point::new(riemann, sides, medium);
        // What is lifted has l v*, and v* has -Y k R a with k = modulus/l.
        let pull = self.pull.of::<L>(at, point.rotation);
        let mut lifted = load_array::<L, UNKNOWNS>(lift);
        for i in 0..AXES {
            let back = point.admittance * pull[i];
            for k in 0..AXES {
                lifted[AXES * i + k] = back.mul_add(normal[k], lifted[AXES * i + k]);
            }
        }
        store_array(lifted, lift);
        let (inverse, [minus, plus]) = (L::splat(1.0) / length, sides);
        // No closures: the compiler need not inline them, and a call stands without the features of the processor.
        let mut moved = [L::zero(); AXES];
        for i in 0..AXES {
            moved[i] = point.admittance * (plus.t[i] - minus.t[i] - pull[i] * inverse);
        }
        let rate = creep::turned_back(point.rotation, moved);
        for (i, rate) in rate.iter().enumerate() {
            let before = L::load(&self.before[AXES * at + i]);
            L::splat(self.dt).mul_add(*rate, before).store(&mut self.now[AXES * at + i]);
        }
    }

    /// A point of a lane whose face has no spring: a stays.
    pub fn keep(&mut self, at: usize, lane: usize) {
        for k in AXES * at..AXES * (at + 1) {
            self.now[k].0[lane] = self.before[k].0[lane];
        }
    }

    /// A point of a lane whose face has moved with v* - mean v, m/s.
    pub fn follow(&mut self, at: usize, lane: usize, rotation: [f64; 2], velocity: [f64; 2]) {
        let rate = creep::turned_back(rotation, velocity);
        for (i, rate) in rate.iter().enumerate() {
            let k = AXES * at + i;
            self.now[k].0[lane] = self.dt.mul_add(*rate, self.before[k].0[lane]);
        }
    }
}

impl Pull<'_> {
    /// l k R a.
    #[inline(always)]
    fn of<L: Lanes>(&self, at: usize, rotation: [L; 2]) -> [L; 2] {
        let a = load_array::<L, AXES>(&self.start[AXES * at..][..AXES]);
        let ([one, two], modulus) = (creep::turned(rotation, a), L::splat(self.modulus));
        [modulus * one, modulus * two]
    }

    /// k R a at a point between two cells of one law, Pa; adds what it does to Flux*.
    #[inline(always)]
    pub fn meter<L: Lanes, R: Riemann>(
        &self,
        at: usize,
        riemann: &R,
        sides: [&Trace<L>; 2],
        (normal, length): ([L; 2], L),
        medium: &Medium<L>,
        flux: &mut [F8; UNKNOWNS],
    ) -> [L; 2] {
        let point = Point::new(riemann, sides, medium);
        let inverse = L::splat(1.0) / length;
        let [one, two] = self.of::<L>(at, point.rotation);
        let pull = [one * inverse, two * inverse];
        let mut sum = load_array::<L, UNKNOWNS>(flux);
        for i in 0..AXES {
            for k in 0..AXES {
                sum[AXES * i + k] = (point.admittance * pull[i]).mul_add(normal[k], sum[AXES * i + k]);
            }
        }
        store_array(sum, flux);
        pull
    }

    /// k R a in a lane, Pa.
    fn of_lane(&self, at: usize, lane: usize, rotation: [f64; 2], stiffness: f64) -> [f64; 2] {
        let a = [0, 1].map(|k| self.start[AXES * at + k].0[lane]);
        creep::turned(rotation, a).map(|a| stiffness * a)
    }
}

/// Springs where a lane looks at them.
pub(super) enum Pulling<'a, 'b> {
    /// They move with their faces.
    Moving(&'b mut Springs<'a>),
    /// They only pull.
    Still(Pull<'a>),
}

impl Pulling<'_, '_> {
    fn pull(&self) -> Pull<'_> {
        match self {
            Pulling::Moving(springs) => springs.pull,
            Pulling::Still(pull) => *pull,
        }
    }

    fn follow(self, at: usize, lane: usize, rotation: [f64; 2], velocity: [f64; 2]) {
        if let Pulling::Moving(springs) = self {
            springs.follow(at, lane, rotation, velocity);
        }
    }
}

impl Block<'_> {
    /// beta M = k l of a face to another law, Pa.
    pub(super) fn spring_between(&self, material: usize) -> f64 {
        self.scheme.spring_between([self.material(), material])
    }

    /// The flux of a condition that gives back what its face creeps: it sees the traction of the inside with the pull of the spring.
    pub(super) fn pulled_at_boundary(
        &self,
        [face, point, lane]: [usize; 3],
        how: GivesBack,
        inside: &Trace<f64>,
        springs: Pulling,
        flux: impl FnOnce(&Trace<f64>) -> [f64; UNKNOWNS],
    ) -> [f64; UNKNOWNS] {
        let (metric, at) = (self.metric().lane(lane), face * self.scheme.operators.line.m + point);
        let Neighbour::Boundary(group) = self.scheme.operators.blocks.neighbours[self.number][face][lane] else {
            return flux(inside);
        };
        let (normal, length) = (metric.normal(face), metric.length(face));
        let stiffness = self.scheme.spring_at(group, self.material()) / length;
        if how == GivesBack::Along {
            // The mean of F and its image turns nowhere, and the pull is shared with the image. What the condition adds to the rows of F for the
            // jump of F to the image is no creep.
            let pull = springs.pull().of_lane(at, lane, [1.0, 0.0], 0.5 * stiffness);
            let (mut flux, along) = (flux(inside), tangent(normal));
            let admittance = self.face_point(face, point, lane).admittance(inside);
            let back = admittance * dot(pull, along);
            (0..DEFORMATION).for_each(|k| flux[k] += back * along[k / 2] * normal[k % 2]);
            let velocity = -admittance * dot(inside.t, along) - back;
            springs.follow(at, lane, [1.0, 0.0], along.map(|along| velocity * along));
            return flux;
        }
        let rotation = creep::rotation(inside.f);
        let pull = springs.pull().of_lane(at, lane, rotation, stiffness);
        let seen = Trace { t: [0, 1].map(|i| inside.t[i] + pull[i]), ..*inside };
        let flux = flux(&seen);
        let back = times([flux[0], flux[1], flux[2], flux[3]], normal);
        springs.follow(at, lane, rotation, [0, 1].map(|i| -back[i] - inside.v[i]));
        flux
    }

    /// Takes the pull of the spring of a face to another law out of its flux, and moves the face.
    pub(super) fn pull_between(
        &self,
        [face, point, lane]: [usize; 3],
        material: usize,
        [minus, plus]: [&Trace<f64>; 2],
        springs: Pulling,
        flux: &mut [f64; UNKNOWNS],
    ) {
        let (metric, at) = (self.metric().lane(lane), face * self.scheme.operators.line.m + point);
        let (normal, scheme) = (metric.normal(face), self.scheme);
        let stiffness = self.spring_between(material) / metric.length(face);
        if stiffness == 0.0 {
            return;
        }
        let rotation = creep::rotation(std::array::from_fn(|k| minus.f[k] + plus.f[k]));
        let pull = springs.pull().of_lane(at, lane, rotation, stiffness);
        let density = [self.material(), material].map(|law| scheme.laws[law].density());
        let moved = |t: [f64; 2]| summed_impedance([minus, plus], normal, density).solve(t);
        let back = moved(pull);
        (0..DEFORMATION).for_each(|k| flux[k] += back[k / 2] * normal[k % 2]);
        springs.follow(at, lane, rotation, moved([0, 1].map(|i| plus.t[i] - minus.t[i] - pull[i])));
    }
}

/// What springs see of a point between two cells of one law.
struct Point<L> {
    rotation: [L; 2],
    admittance: L,
}

impl<L: Lanes> Point<L> {
    #[inline(always)]
    fn new<R: Riemann>(riemann: &R, [minus, plus]: [&Trace<L>; 2], medium: &Medium<L>) -> Self {
        let (m, p) = (minus.f, plus.f);
        let f = [m[0] + p[0], m[1] + p[1], m[2] + p[2], m[3] + p[3]];
        Self { rotation: creep::rotation(f), admittance: riemann.admittance(minus, plus, medium) }
    }
}

/// rho0 c_p^2 at F = 1 by law, Pa; empty where the flux has no springs.
pub(super) fn moduli(laws: &[Law], flux: &Flux) -> Vec<f64> {
    let modulus = |law: &Law| law.density() * law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0])[0].powi(2);
    let has_springs = flux.looks() == Looks::Displacement;
    if has_springs { laws.iter().map(modulus).collect() } else { vec![] }
}

impl Scheme {
    /// With springs that give back what faces creep ([`creep`]).
    ///
    /// # Errors
    /// A flux that lets no face creep so.
    pub fn with_springs(self) -> Result<Self> {
        if self.moduli.is_empty() {
            let what = "springs in the faces need the flux `dual`";
            return Err(Error::input(what, "give flux = \"dual\", or remove `springs` of [scheme]"));
        }
        if self.laws.iter().all(|law| law.has_memory()) {
            let what =
                "a law with internal variables has no springs in its faces: where it flows they would make energy";
            return Err(Error::input(what, "remove `springs` of [scheme], or give a part of the body another law"));
        }
        Ok(Self { gives_back: true, ..self })
    }

    /// Whether springs give back what faces creep.
    pub fn has_springs(&self) -> bool {
        self.gives_back
    }

    /// Whether faces keep their creep.
    fn keeps_creep(&self) -> bool {
        (0..self.moduli.len()).any(|law| self.spring_between([law; 2]) > 0.0)
    }

    /// k l at a boundary whose faces give back what they creep, Pa. The shear of a free side creeps at 1/(rho0 c_s): k is so much less that
    /// its relaxation is no faster than inside, at any c_p/c_s.
    pub(crate) fn spring_at(&self, group: usize, law: usize) -> f64 {
        let inside = self.spring_between([law; 2]);
        match self.boundaries[group].gives_back() {
            GivesBack::Nothing => 0.0,
            GivesBack::Along => inside,
            GivesBack::All if inside > 0.0 => inside * (self.laws[law].shear_modulus() / self.moduli[law]).sqrt(),
            GivesBack::All => 0.0,
        }
    }

    /// beta M = k l of a face between two laws, Pa; 0 where one of them has memory, see [`creep::spring`].
    pub(crate) fn spring_between(&self, laws: [usize; 2]) -> f64 {
        let flows = laws.iter().any(|law| self.laws[*law].has_memory());
        if flows || !self.gives_back { 0.0 } else { creep::spring(self.operators.degree) * self.modulus_between(laws) }
    }

    /// M of a face between two laws, Pa.
    fn modulus_between(&self, laws: [usize; 2]) -> f64 {
        let of = |law: usize| self.moduli.get(law).copied().unwrap_or(0.0);
        if laws.iter().all(|law| of(*law) > 0.0) { creep::in_series(laws.map(of)) } else { 0.0 }
    }

    /// Numbers of the creep of a block.
    pub(crate) fn creep_of_block(&self) -> usize {
        FACES * self.operators.line.m * AXES
    }

    /// The creep of the faces of a block in a state; empty where they have no springs.
    pub(super) fn creep_of<'s>(&self, state: &'s State, block: usize) -> &'s [F8] {
        let count = self.creep_of_block();
        state.creep.get(count * block..count * (block + 1)).unwrap_or_default()
    }

    /// A state with room for the creep of its faces, which begins at 0 where the state has none.
    pub(super) fn make_room_for_creep(&self, state: &mut State) {
        let wanted = if self.keeps_creep() { self.creep_of_block() * self.operators.blocks.len() } else { 0 };
        if state.creep.len() != wanted {
            state.creep = vec![F8::ZERO; wanted];
        }
    }

    /// The creep of a state of `before` on this grid, whose cells that are copies of old ones `same` names: faces between two of
    /// them keep it, others begin at 0; empty where they have no springs.
    pub fn creep_from(&self, before: &Scheme, state: &State, same: &[Option<usize>]) -> Vec<F8> {
        if state.creep.is_empty() || !self.keeps_creep() {
            return vec![];
        }
        let (blocks, count) = (&self.operators.blocks, self.creep_of_block());
        let old = before.operators.blocks.unpack(&state.creep, count);
        let mut new = vec![0.0; count * blocks.slot.len()];
        let copied = |cell: usize| same.get(cell).copied().flatten();
        for (cell, &(block, lane)) in blocks.slot.iter().enumerate() {
            let Some(twin) = copied(cell) else { continue };
            for face in 0..FACES {
                let stays = match blocks.neighbours[block][face][lane] {
                    Neighbour::Cell(there) | Neighbour::Interface(there, _) => {
                        copied(blocks.cells[there.face / FACES][there.lane]).is_some()
                    }
                    Neighbour::Boundary(_) => true,
                    Neighbour::Padding => false,
                };
                if stays {
                    let of_face = face * count / FACES..(face + 1) * count / FACES;
                    new[count * cell..][of_face.clone()].copy_from_slice(&old[count * twin..][of_face]);
                }
            }
        }
        blocks.pack(&new, count, |_| 0.0)
    }

    /// What the springs of the faces of a block store, sum k/2 |a|^2 w l, J/m, a lane a cell; each side of an inner face has half.
    pub(super) fn stored_by_creep(&self, block: usize, creep: &[F8]) -> F8 {
        let mut out = F8::ZERO;
        if creep.is_empty() || self.spring_between([self.operators.blocks.material[block]; 2]) == 0.0 {
            return out;
        }
        let (m, blocks) = (self.operators.line.m, &self.operators.blocks);
        let law = blocks.material[block];
        let own = self.spring_between([law; 2]);
        let faces = creep.as_chunks::<AXES>().0.chunks_exact(m).zip(&blocks.neighbours[block]);
        for (points, neighbours) in faces {
            let mut sum = F8::ZERO;
            for (a, weight) in points.iter().zip(&self.operators.line.basis.weights) {
                for lane in 0..LANES {
                    sum.0[lane] += weight * (a[0].0[lane] * a[0].0[lane] + a[1].0[lane] * a[1].0[lane]);
                }
            }
            for (lane, neighbour) in neighbours.iter().enumerate() {
                let modulus = match neighbour {
                    Neighbour::Boundary(group) => match self.boundaries[*group].gives_back() {
                        GivesBack::Along => 0.5 * own,
                        _ => self.spring_at(*group, law),
                    },
                    Neighbour::Cell(_) => 0.5 * own,
                    Neighbour::Interface(_, there) => 0.5 * self.spring_between([law, *there]),
                    Neighbour::Padding => 0.0,
                };
                out.0[lane] += 0.5 * modulus * sum.0[lane];
            }
        }
        out
    }
}
