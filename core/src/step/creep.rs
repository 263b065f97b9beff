//! The creep of faces ([`crate::riemann::creep`]) in a step: a at each face point of each cell, in
//! [`crate::state::State::creep`]. Both cells of a face keep it, from the same numbers. Which faces have springs, and how stiff they are:
//! `springs`.
//!
//! All stages of a step see a of its start; the step is some hundredth of the relaxation time, and what the step then loses at a face
//! is Y^-1 |da/dt|^2 (1 - k Y dt/2), above 0.

use super::across::Other;
use super::block::Block;
use crate::boundary::{FacePoint, GivesBack};
use crate::lane::{F8, Lanes, load_array, store_array};
use crate::riemann::{Medium, Riemann, Trace, creep, summed_impedance, tangent};
use crate::state::UNKNOWNS;
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
    /// The step, s.
    step: f64,
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
    /// The power that the spring of the last lane at a boundary or at another material stores, W/m^2.
    pub stored: f64,
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
        Some(Self { pull: Pull { start, modulus, step: block.stage.dt }, before, now, dt: block.factor(), stored: 0.0 })
    }

    /// The same for a shorter time.
    pub fn again(&mut self) -> Springs<'_> {
        Springs { pull: self.pull, before: self.before, now: self.now, dt: self.dt, stored: 0.0 }
    }

    /// A point of a face between two cells of one law, with the `admittance` Y: moves a, and takes the pull of the spring out of what is `lifted`.
    #[inline(always)]
    pub fn act<L: Lanes>(
        &mut self,
        at: usize,
        face: &SpringFace<L>,
        [minus, plus]: [&Trace<L>; 2],
        admittance: L,
        lifted: &mut [L; UNKNOWNS],
    ) {
        // What is lifted has l v*, and v* has -Y k R a with k = modulus/l.
        let (pull, normal) = (self.pull.of::<L>(at, face.modulus), face.normal);
        let forgotten = L::splat(1.0 + creep::FORGETS) * face.inverse;
        for i in 0..AXES {
            let back = admittance * pull[i];
            for k in 0..AXES {
                lifted[AXES * i + k] = back.mul_add(normal[k], lifted[AXES * i + k]);
            }
        }
        // No closures: the compiler need not inline them, and a call stands without the features of the processor.
        let mut moved = [L::zero(); AXES];
        for i in 0..AXES {
            moved[i] = admittance * (plus.t[i] - minus.t[i] - pull[i] * forgotten);
        }
        let rate = creep::turned_back(face.rotation, moved);
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
        self.stored = 0.0;
    }

    /// A point of a lane whose creep grows by R^T `velocity`, m/s.
    fn follow(&mut self, spring: &Spring, velocity: [f64; 2]) {
        let rate = creep::turned_back(spring.rotation, velocity);
        for (i, rate) in rate.iter().enumerate() {
            let (k, lane) = (AXES * spring.at + i, spring.lane);
            self.now[k].0[lane] = self.dt.mul_add(*rate, self.before[k].0[lane]);
        }
    }
}

impl Pull<'_> {
    /// A face between cells of one law, from the numbers of its points on both sides, with the normal of `own` and 1/l.
    #[inline(always)]
    pub fn face<L: Lanes, O: Other, const W: usize>(
        &self,
        own: &[[F8; W]],
        other: &O,
        (normal, inverse): ([L; 2], L),
    ) -> SpringFace<L> {
        let (rotation, modulus) = (rotation_of::<L, O, W>(own, other), L::splat(self.modulus));
        SpringFace { rotation, modulus: [modulus * rotation[0], modulus * rotation[1]], inverse, normal }
    }

    /// l k R a, from l k R.
    #[inline(always)]
    fn of<L: Lanes>(&self, at: usize, modulus: [L; 2]) -> [L; 2] {
        creep::turned(modulus, load_array::<L, AXES>(&self.start[AXES * at..][..AXES]))
    }

    /// k R (a + dt/2 da/dt) . (R da/dt) at a point between two cells of one law, the power that its spring stores in the step, W/m^2; adds what
    /// k R a does to Flux*.
    #[inline(always)]
    pub fn meter<L: Lanes, R: Riemann>(
        &self,
        at: usize,
        face: &SpringFace<L>,
        riemann: &R,
        [minus, plus]: [&Trace<L>; 2],
        medium: &Medium<L>,
        flux: &mut [F8; UNKNOWNS],
    ) -> L {
        let admittance = riemann.admittance(minus, plus, medium);
        let ([one, two], grows, normal) = (self.of::<L>(at, face.modulus), L::splat(1.0 + creep::FORGETS), face.normal);
        let pull = [one * face.inverse, two * face.inverse];
        let half = L::splat(0.5 * self.modulus * self.step) * face.inverse;
        let (mut sum, mut stored) = (load_array::<L, UNKNOWNS>(flux), L::zero());
        for i in 0..AXES {
            let back = admittance * pull[i];
            for k in 0..AXES {
                sum[AXES * i + k] = back.mul_add(normal[k], sum[AXES * i + k]);
            }
            let velocity = admittance * (plus.t[i] - minus.t[i] - grows * pull[i]);
            stored = velocity.mul_add(half.mul_add(velocity, pull[i]), stored);
        }
        store_array(sum, flux);
        stored
    }

    /// A point in a lane, with its stiffness k, Pa/m.
    fn of_lane(&self, at: usize, lane: usize, rotation: [f64; 2], stiffness: f64) -> Spring {
        let a = [0, 1].map(|k| self.start[AXES * at + k].0[lane]);
        let pull = creep::turned(rotation, a).map(|a| stiffness * a);
        Spring { at, lane, rotation, stiffness, pull, step: self.step }
    }
}

/// The spring of a point in a lane.
struct Spring {
    at: usize,
    lane: usize,
    /// R.
    rotation: [f64; 2],
    /// k, Pa/m.
    stiffness: f64,
    /// k R a, Pa.
    pull: [f64; 2],
    /// The step, s.
    step: f64,
}

impl Spring {
    /// k R (a + dt/2 da/dt) . (R da/dt), W/m^2, with R da/dt = `velocity`: what it stores in the step.
    fn stores(&self, velocity: [f64; 2]) -> f64 {
        dot(self.pull, velocity) + 0.5 * self.stiffness * self.step * dot(velocity, velocity)
    }
}

/// Springs where a lane looks at them.
pub(super) enum Pulling<'a, 'b> {
    /// They move with their faces.
    Moving(&'b mut Springs<'a>),
    /// They only pull; what they store, W/m^2, is out.
    Still(Pull<'a>, &'b mut f64),
}

impl Pulling<'_, '_> {
    fn pull(&self) -> Pull<'_> {
        match self {
            Pulling::Moving(springs) => springs.pull,
            Pulling::Still(pull, _) => *pull,
        }
    }

    /// The face moves by R da/dt = `velocity`, m/s.
    fn follow(self, spring: &Spring, velocity: [f64; 2]) {
        match self {
            Pulling::Moving(springs) => {
                springs.follow(spring, velocity);
                springs.stored = spring.stores(velocity);
            }
            Pulling::Still(_, stored) => *stored = spring.stores(velocity),
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
        group: usize,
        here: &FacePoint,
        inside: &Trace<f64>,
        springs: Pulling,
        flux: impl FnOnce(&Trace<f64>) -> [f64; UNKNOWNS],
    ) -> [f64; UNKNOWNS] {
        let how = self.scheme.gives_back(group);
        if how == GivesBack::Nothing {
            return flux(inside);
        }
        let (normal, at) = (here.normal, face * self.scheme.operators.line.m + point);
        let (_, length) = self.metric().at_face_of(lane, face, point);
        let stiffness = self.scheme.spring_at(group, self.material()) / length;
        let admittance = here.admittance(inside);
        if how == GivesBack::Along {
            // The mean of F and its image turns nowhere, and the pull is shared with the image. What the condition adds to the rows of F for the
            // jump of F to the image is no creep.
            let spring = springs.pull().of_lane(at, lane, [1.0, 0.0], 0.5 * stiffness);
            let (mut flux, along) = (flux(inside), tangent(normal));
            let back = admittance * dot(spring.pull, along);
            (0..DEFORMATION).for_each(|k| flux[k] += back * along[k / 2] * normal[k % 2]);
            let velocity = -admittance * dot(inside.t, along) - (1.0 + creep::FORGETS) * back;
            springs.follow(&spring, along.map(|along| velocity * along));
            return flux;
        }
        let rotation = creep::rotation(inside.f);
        let spring = springs.pull().of_lane(at, lane, rotation, stiffness);
        let seen = Trace { t: [0, 1].map(|i| inside.t[i] + spring.pull[i]), ..*inside };
        let flux = flux(&seen);
        let back = times([flux[0], flux[1], flux[2], flux[3]], normal);
        let forgets = creep::FORGETS * admittance;
        let velocity = [0, 1].map(|i| -back[i] - inside.v[i] - forgets * spring.pull[i]);
        springs.follow(&spring, velocity);
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
        let (scheme, at) = (self.scheme, face * self.scheme.operators.line.m + point);
        let (normal, length) = self.metric().at_face_of(lane, face, point);
        let stiffness = self.spring_between(material) / length;
        if stiffness == 0.0 {
            return;
        }
        let rotation = creep::rotation(std::array::from_fn(|k| minus.f[k] + plus.f[k]));
        let spring = springs.pull().of_lane(at, lane, rotation, stiffness);
        let density = [self.material(), material].map(|law| scheme.laws[law].density());
        let moved = |t: [f64; 2]| summed_impedance([minus, plus], normal, density).solve(t);
        let back = moved(spring.pull);
        (0..DEFORMATION).for_each(|k| flux[k] += back[k / 2] * normal[k % 2]);
        let velocity = moved([0, 1].map(|i| plus.t[i] - minus.t[i] - (1.0 + creep::FORGETS) * spring.pull[i]));
        springs.follow(&spring, velocity);
    }
}

/// What springs know of a face between cells of one law.
pub(super) struct SpringFace<L> {
    /// R.
    rotation: [L; 2],
    /// l k R, Pa.
    modulus: [L; 2],
    /// 1/l, 1/m.
    inverse: L,
    normal: [L; 2],
}

/// R of the mean F of both sides at the first and the last point of a face: one square root a face. The sides must agree to the bit, whichever
/// of the two points is the first.
#[inline(always)]
fn rotation_of<L: Lanes, O: Other, const W: usize>(own: &[[F8; W]], other: &O) -> [L; 2] {
    let last = own.len() - 1;
    let (first_there, last_there) = (other.load::<L, W>(0), other.load::<L, W>(last));
    let mut f = [L::zero(); DEFORMATION];
    for k in 0..DEFORMATION {
        f[k] = (L::load(&own[0][k]) + first_there[k]) + (L::load(&own[last][k]) + last_there[k]);
    }
    creep::rotation(f)
}
