//! Fluxes (3) of the four faces of a block, lifted: len (Flux* - own flux of the F rows).

use super::balance::{FacePower, Sums};
use super::tiles::Slot;
use super::volume::{Arrays, width};
use super::{Scheme, Stage};
use crate::boundary::FacePoint;
use crate::lane::{F8, LANES, Lanes, Work, load_array, load_lanes, store_array};
use crate::material::Law;
use crate::mesh::map;
use crate::operators::sides::Gathered;
use crate::operators::{Metric, Neighbour, Side};
use crate::riemann::{Flux, Riemann, Trace, interface};
use crate::with_flux;

/// Runs `$body` with `$riemann` bound to the flux and `$numbers` to the constant numbers of a trace, see [`width`].
macro_rules! with_width {
    ($flux:expr, $metered:expr, $riemann:ident, $numbers:ident => $body:expr) => {
        with_flux!($flux, $riemann => match (shear($riemann), $metered) {
            (false, false) => with_width!(@ false, false, $numbers, $body),
            (true, false) => with_width!(@ true, false, $numbers, $body),
            (false, true) => with_width!(@ false, true, $numbers, $body),
            (true, true) => with_width!(@ true, true, $numbers, $body),
        })
    };
    (@ $shear:literal, $metered:literal, $numbers:ident, $body:expr) => {{
        const $numbers: usize = width($shear, $metered);
        $body
    }};
}

#[inline(always)]
fn shear<R: Riemann>(_: &R) -> bool {
    R::SHEAR
}

/// A trace of some lanes from its numbers.
#[inline(always)]
fn trace_of<L: Lanes, R: Riemann, const W: usize>(x: &[L; W]) -> Trace<L> {
    let shear = if R::SHEAR { x[9] } else { L::zero() };
    Trace { f: [x[0], x[1], x[2], x[3]], v: [x[4], x[5]], t: [x[6], x[7]], c: [x[8], shear] }
}

/// The other side's trace with this side's normal: its traction is P N^+ with N^+ = -N, and so is s = P T, which stands
/// behind c.
#[inline(always)]
fn turned<L: Lanes, const W: usize>(mut x: [L; W]) -> [L; W] {
    x[6] = -x[6];
    x[7] = -x[7];
    if W >= width(false, true) {
        x[W - 2] = -x[W - 2];
        x[W - 1] = -x[W - 1];
    }
    x
}

/// All traces under way.
#[derive(Clone, Copy)]
pub(super) struct Traces<'a> {
    /// Those of the tile: one number, then [slot][face][point][width], then one more. So are the others.
    pub own: &'a [F8],
    /// What all tiles have shown before this phase, by store.
    pub seen: &'a [Vec<F8>],
    /// What the tile will have shown after it.
    pub shown: &'a [F8],
    /// The slot of each block.
    pub slots: &'a [Slot],
}

impl<'a> Traces<'a> {
    /// The array of a face, numbered 4 block + local face, with `length` numbers each, and where in it those before it end.
    #[inline(always)]
    fn find(&self, face: usize, length: usize) -> (&'a [F8], usize) {
        let slot = self.slots[face / 4];
        let all = if slot.store == 0 { self.own } else { self.of_tiles(slot.store) };
        (all, (4 * slot.index as usize + face % 4) * length)
    }

    #[inline(always)]
    fn of_tiles(&self, store: u32) -> &'a [F8] {
        self.seen.get(store as usize - 1).map_or(self.shown, |seen| &seen[..])
    }

    /// Those of a face, with the numbers before and behind them.
    #[inline(always)]
    fn around(&self, face: usize, length: usize) -> &'a [F8] {
        let (all, at) = self.find(face, length);
        &all[at..at + length + 2]
    }

    /// Those of `count` faces.
    #[inline(always)]
    fn faces(&self, face: usize, count: usize, length: usize) -> &'a [F8] {
        let (all, at) = self.find(face, length);
        &all[at + 1..at + 1 + count * length]
    }
}

/// Where the numbers of a point across a face come from: one way, so that no loop over points looks at it.
trait Other {
    /// The numbers of a point.
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W];
}

/// [point][width], each lane's in the same lane.
#[derive(Clone, Copy)]
struct Aligned<'a>(&'a [F8]);

impl Other for Aligned<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        load_array(&self.0[point * W..][..W])
    }
}

/// In two runs that begin with their second number, see [`Lanes::load_joined`].
#[derive(Clone, Copy)]
struct Joined<'a> {
    first: &'a [F8],
    second: &'a [F8],
    by: usize,
}

impl Other for Joined<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        L::load_joined(self.first, self.second, 1 + point * W, self.by)
    }
}

/// In some faces, with `points` points each: all lanes that one of them has at once.
#[derive(Clone, Copy)]
struct Apart<'a> {
    traces: &'a Traces<'a>,
    from: &'a Gathered,
    points: usize,
}

impl Other for Apart<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        let mut all = [L::zero(); W];
        for source in self.from.sources() {
            let at = if source.flip { self.points - 1 - point } else { point };
            let face = self.traces.faces(source.face as usize, 1, self.points * W);
            for (all, there) in all.iter_mut().zip(&face[at * W..][..W]) {
                *all = all.pick(there, &self.from.lane, source.lanes);
            }
        }
        all
    }
}

/// In some faces: lane by lane, see [`load_lanes`].
struct LaneByLane<'a> {
    /// The face of each lane.
    faces: [&'a [F8]; LANES],
    /// Where its first number is.
    first: [usize; LANES],
    /// How far the next point is from there.
    step: [isize; LANES],
}

impl<'a> LaneByLane<'a> {
    #[inline(always)]
    fn new<const W: usize>(Apart { traces, from, points }: Apart<'a>) -> Self {
        let stride = (W * LANES) as isize;
        let (mut faces, mut first, mut step) = ([&[][..]; LANES], [0; LANES], [stride; LANES]);
        for source in from.sources() {
            let face = traces.faces(source.face as usize, 1, points * W);
            let point = if source.flip { points - 1 } else { 0 };
            for lane in 0..LANES {
                if source.lanes >> lane & 1 == 1 {
                    faces[lane] = face;
                    first[lane] = point * W * LANES + usize::from(from.lane[lane]);
                    step[lane] = if source.flip { -stride } else { stride };
                }
            }
        }
        Self { faces, first, step }
    }
}

impl Other for LaneByLane<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        let mut at = self.first;
        for (at, step) in at.iter_mut().zip(&self.step) {
            *at = at.wrapping_add_signed(point as isize * step);
        }
        load_lanes(&self.faces, &at)
    }
}

/// The traces across a face of a block.
#[derive(Clone, Copy)]
enum Beyond<'a> {
    Aligned(Aligned<'a>),
    Joined(Joined<'a>),
    Apart(Apart<'a>),
}

impl Beyond<'_> {
    /// The numbers of a point, on a path that need not be fast.
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        match *self {
            Beyond::Aligned(other) => other.load(point),
            Beyond::Joined(other) => other.load(point),
            Beyond::Apart(other) => other.load(point),
        }
    }

    /// Number k of a point with `width` numbers in one lane.
    fn number(&self, point: usize, k: usize, width: usize, lane: usize) -> f64 {
        let at = |point: usize| point * width + k;
        match *self {
            Beyond::Aligned(Aligned(traces)) => traces[at(point)].0[lane],
            Beyond::Joined(Joined { first, second, by }) => {
                let (run, lane) = if lane + by < LANES { (first, lane + by) } else { (second, lane + by - LANES) };
                run[1 + at(point)].0[lane]
            }
            Beyond::Apart(Apart { traces, from, points }) => {
                let there = from.across(lane);
                let point = if there.flip { points - 1 - point } else { point };
                traces.faces(there.face, 1, points * width)[at(point)].0[there.lane]
            }
        }
    }
}

/// The four faces of a block, all lanes as faces between cells of one law.
struct Faces<'a> {
    flux: Flux,
    metered: bool,
    /// Own traces, [face][point][width].
    own: &'a [F8],
    /// The other side's, by face, with its own normal.
    other: &'a [Beyond<'a>; 4],
    metric: &'a Metric<F8>,
    /// Points of a face.
    points: usize,
    density: f64,
    /// [face][point][6], out.
    lift: &'a mut [F8],
}

impl Work for Faces<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        with_width!(self.flux, self.metered, riemann, W => {
            for face in 0..4 {
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
        let density = L::splat(self.density);
        let own = &self.own.as_chunks::<W>().0[face * m..(face + 1) * m];
        let metric = self.metric.load::<L>();
        let (normal, length) = (metric.normal(face), metric.length(face));
        let lift = &mut self.lift.as_chunks_mut::<6>().0[m * face..m * (face + 1)];
        for point in 0..m {
            let minus = trace_of::<L, R, W>(&load_array::<L, W>(&own[point]));
            let plus = trace_of::<L, R, W>(&turned(other.load::<L, W>(point)));
            store_array(riemann.lifted(&minus, &plus, normal, density, length), &mut lift[point]);
        }
    }
}

/// A block in a stage: all that the flux of a face needs to know beside the traces.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub scheme: &'a Scheme,
    pub stage: &'a Stage<'a>,
    pub block: usize,
}

/// The traces of a face of a block, [point][width].
#[derive(Clone, Copy)]
struct Sides<'a> {
    face: usize,
    own: &'a [F8],
    /// With its own normal; lanes at a boundary see themselves or what they must not use.
    other: &'a Beyond<'a>,
}

/// What a face adds to the balance of the block. The fluxes are found once more: without the balance they never come to
/// memory.
struct Meter<'a, 'b> {
    place: Place<'a>,
    sides: Sides<'a>,
    sums: &'b mut Sums,
}

impl Work for Meter<'_, '_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        with_width!(self.place.scheme.flux, true, riemann, W => self.with::<L, _, W>(riemann));
    }
}

impl Meter<'_, '_> {
    #[inline(always)]
    fn with<L: Lanes, R: Riemann, const W: usize>(self, riemann: &R) {
        let Self { place, sides, sums } = self;
        let (scheme, metric, face) = (place.scheme, place.metric().load::<L>(), sides.face);
        let neighbours = &scheme.operators.blocks.neighbours[place.block][face];
        let factor = place.stage.dt * scheme.weight(place.stage.number);
        let normal = metric.normal(face);
        let density = L::splat(place.law().density());
        let weights = &scheme.operators.line.basis.weights[..scheme.operators.line.m];
        for (point, (own, weight)) in sides.own.as_chunks::<W>().0.iter().zip(weights).enumerate() {
            let beyond = turned(sides.other.load::<L, W>(point));
            let minus = trace_of::<L, R, W>(&load_array::<L, W>(own));
            let plus = trace_of::<L, R, W>(&beyond);
            let (mut flux, mut there, mut scale) = ([F8::ZERO; 6], [F8::ZERO; W], F8::ZERO);
            store_array(riemann.flux(&minus, &plus, normal, density), &mut flux);
            store_array(beyond, &mut there);
            (metric.length(face) * L::splat(*weight * factor)).store(&mut scale);
            for (lane, neighbour) in neighbours.iter().enumerate() {
                let Some(special) = place.special(face, point, lane, own, sides.other) else { continue };
                (0..6).for_each(|k| flux[k].0[lane] = special[k]);
                if matches!(neighbour, Neighbour::Boundary(_)) {
                    // Lanes at a boundary see themselves: they have no jumps.
                    (0..W).for_each(|k| there[k].0[lane] = own[k].0[lane]);
                    let at = place.metric().lane(lane).normal(face);
                    FacePower { minus: own, plus: own, flux: &flux }.boundary(&scale, at, lane, sums);
                }
            }
            let power = FacePower { minus: own, plus: &there, flux: &flux };
            power.jumps::<L, W>(&scale, normal, &mut sums.flux_dissipation);
        }
    }
}

/// Lifted numbers of all faces of a block into `nodes.lift`; what they add to the balance into `sums`.
pub(super) fn lift(place: Place, traces: &Traces, nodes: &mut Arrays, mut sums: Option<&mut Sums>) {
    let Place { scheme, block, .. } = place;
    let (blocks, m) = (&scheme.operators.blocks, scheme.operators.line.m);
    let (flux, metered) = (scheme.flux, sums.is_some());
    let width = width(flux.has_shear(), metered);
    let length = m * width;
    let plan = &blocks.plan[block];
    let mut other = [Beyond::Aligned(Aligned(&[])); 4];
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
    let own = traces.faces(4 * block, 4, length);
    let (metric, density) = (place.metric(), place.law().density());
    scheme.kernel.run(Faces { flux, metered, own, other: &other, metric, points: m, density, lift: &mut nodes.lift });
    for face in 0..4 {
        let sides = Sides { face, own: &own[face * length..][..length], other: &other[face] };
        if plan[face].special {
            place.put_right(sides, &mut nodes.lift[6 * m * face..6 * m * (face + 1)]);
        }
        if let Some(sums) = &mut sums {
            scheme.kernel.run(Meter { place, sides, sums });
        }
    }
}

impl<'a> Place<'a> {
    /// Its metric terms.
    #[inline]
    pub fn metric(&self) -> &'a Metric<F8> {
        &self.scheme.operators.geometry.blocks[self.block]
    }

    /// Its law.
    #[inline]
    pub fn law(&self) -> &'a Law {
        &self.scheme.laws[self.scheme.operators.blocks.material[self.block]]
    }

    /// The lifted numbers of lanes at a boundary or at another material, in `lift`, [point][6].
    fn put_right(&self, sides: Sides, lift: &mut [F8]) {
        let (face, width) = (sides.face, sides.own.len() / self.scheme.operators.line.m);
        for (point, (own, lift)) in sides.own.chunks_exact(width).zip(lift.as_chunks_mut::<6>().0).enumerate() {
            for lane in 0..LANES {
                let Some(flux) = self.special(face, point, lane, own, sides.other) else { continue };
                let metric = self.metric().lane(lane);
                let (normal, length) = (metric.normal(face), metric.length(face));
                for (k, flux) in flux.iter().enumerate() {
                    let own = if k < 4 { own[4 + k / 2].0[lane] * normal[k % 2] } else { 0.0 };
                    lift[k].0[lane] = (flux + own) * length;
                }
            }
        }
    }

    /// The flux of a lane at a boundary or at another material, from the `own` numbers at a point and the traces of the other
    /// side, each with its own normal; none elsewhere.
    fn special(&self, face: usize, point: usize, lane: usize, own: &[F8], other: &Beyond) -> Option<[f64; 6]> {
        let neighbour = &self.scheme.operators.blocks.neighbours[self.block][face][lane];
        if matches!(neighbour, Neighbour::Cell(_) | Neighbour::Padding) {
            return None;
        }
        let law = self.law();
        let at = self.face_point(face, point, lane, law.density());
        let trace = |x: &dyn Fn(usize) -> f64, sign: f64, law: &Law| {
            let f = [x(0), x(1), x(2), x(3)];
            let c = if self.scheme.flux.has_shear() { [x(8), x(9)] } else { law.speeds(f, at.normal) };
            Trace { f, v: [x(4), x(5)], t: [sign * x(6), sign * x(7)], c }
        };
        let minus = trace(&|k| own[k].0[lane], 1.0, law);
        match *neighbour {
            Neighbour::Boundary(group) => Some(self.scheme.boundaries[group].flux(&minus, &at, self.stage.times)),
            Neighbour::Interface(_, material) => {
                let beyond = &self.scheme.laws[material];
                let plus = trace(&|k| other.number(point, k, own.len(), lane), -1.0, beyond);
                Some(interface(&minus, &plus, at.normal, [law.density(), beyond.density()]))
            }
            Neighbour::Cell(_) | Neighbour::Padding => None,
        }
    }

    fn face_point(&self, face: usize, point: usize, lane: usize, density: f64) -> FacePoint {
        let geometry = &self.scheme.operators.geometry;
        let along = self.scheme.operators.line.basis.nodes[point];
        let end = (face % 2) as f64;
        let xi = if face < 2 { [end, along] } else { [along, end] };
        let x = map::position(&geometry.corners_of(self.block, lane), xi);
        let normal = geometry.blocks[self.block].lane(lane).normal(face);
        FacePoint { x, normal, density }
    }
}
