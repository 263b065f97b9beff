//! Fluxes (3) of the four faces of a block, lifted: len w_k (Flux* - own flux of the F rows).

use super::balance::{FacePower, Sums};
use super::volume::{Arrays, Metric, width};
use super::{Scheme, Stage};
use crate::boundary::FacePoint;
use crate::lane::{F8, LANES, Lanes, Work, gather_run, load_array, store_array};
use crate::material::Law;
use crate::mesh::map;
use crate::operators::blocks::Across;
use crate::operators::{Neighbour, Side};
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

/// Where the traces of a face, numbered 4 block + local face, lie among those under way.
#[inline(always)]
fn face_in(slots: &[u32], face: usize) -> usize {
    4 * slots[face / 4] as usize + face % 4
}

/// How the traces across a face lie apart.
#[derive(Clone, Copy)]
enum Apart<'a> {
    /// See [`Side::Joined`].
    Joined { first: usize, second: usize, by: usize },
    /// Lane by lane.
    Anywhere(&'a [Across; LANES]),
}

/// Traces that lie apart, in the order of the points of this side.
struct Collect<'a> {
    /// Traces under way, [slot][face][point][width].
    traces: &'a [F8],
    /// The slot of each block.
    slots: &'a [u32],
    from: Apart<'a>,
    /// Numbers of a trace.
    width: usize,
    /// [point][width], out.
    out: &'a mut [F8],
}

impl Work for Collect<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        match self.width {
            9 => self.with::<L, 9>(),
            10 => self.with::<L, 10>(),
            11 => self.with::<L, 11>(),
            _ => self.with::<L, 12>(),
        }
    }
}

impl Collect<'_> {
    #[inline(always)]
    fn with<L: Lanes, const W: usize>(self) {
        let out = self.out.as_chunks_mut::<W>().0;
        match self.from {
            Apart::Joined { first, second, by } => {
                let of = |face: usize| &self.traces[face_in(self.slots, face) * out.len() * W..][..out.len() * W];
                L::join(of(first), of(second), by, out.as_flattened_mut());
            }
            Apart::Anywhere(across) => {
                let (m, stride) = (out.len(), (W * LANES) as isize);
                let (mut first, mut step) = ([0; LANES], [stride; LANES]);
                for lane in 0..LANES {
                    let there = &across[lane];
                    let point = if there.flip { m - 1 } else { 0 };
                    first[lane] = (face_in(self.slots, there.face) * m + point) * W * LANES + there.lane;
                    step[lane] = if there.flip { -stride } else { stride };
                }
                gather_run::<L, W>(self.traces, &first, &step, out);
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
    /// The other side's, by face, [point][width], with its own normal.
    other: [&'a [F8]; 4],
    metric: Metric<'a>,
    /// Weights of the points of a face.
    weights: &'a [f64],
    density: f64,
    /// [face][point][6], out.
    lift: &'a mut [F8],
}

impl Work for Faces<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        with_width!(self.flux, self.metered, riemann, W => self.with::<L, _, W>(riemann));
    }
}

impl Faces<'_> {
    #[inline(always)]
    fn with<L: Lanes, R: Riemann, const W: usize>(&mut self, riemann: &R) {
        let m = self.weights.len();
        let density = L::splat(self.density);
        for face in 0..4 {
            let own = &self.own.as_chunks::<W>().0[face * m..(face + 1) * m];
            let other = &self.other[face].as_chunks::<W>().0[..m];
            let normal = load_array::<L, 2>(&self.metric.normal[2 * face..2 * face + 2]);
            let length = L::load(&self.metric.length[face]);
            let lift = &mut self.lift.as_chunks_mut::<6>().0[m * face..m * (face + 1)];
            for point in 0..m {
                let minus = trace_of::<L, R, W>(&load_array::<L, W>(&own[point]));
                let plus = trace_of::<L, R, W>(&turned(load_array::<L, W>(&other[point])));
                let scale = length * L::splat(self.weights[point]);
                store_array(riemann.lifted(&minus, &plus, normal, density, scale), &mut lift[point]);
            }
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
    other: &'a [F8],
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
        let (scheme, metric, face) = (place.scheme, place.metric(), sides.face);
        let neighbours = &scheme.operators.blocks.neighbours[place.block][face];
        let factor = place.stage.dt * scheme.weight(place.stage.number);
        let normal = load_array::<L, 2>(&metric.normal[2 * face..2 * face + 2]);
        let density = L::splat(place.law().density());
        let weights = &scheme.operators.line.basis.weights[..scheme.operators.line.m];
        let points = sides.own.as_chunks::<W>().0.iter().zip(sides.other.as_chunks::<W>().0);
        for (point, ((own, other), weight)) in points.zip(weights).enumerate() {
            let beyond = turned(load_array::<L, W>(other));
            let minus = trace_of::<L, R, W>(&load_array::<L, W>(own));
            let plus = trace_of::<L, R, W>(&beyond);
            let (mut flux, mut there, mut scale) = ([F8::ZERO; 6], [F8::ZERO; W], F8::ZERO);
            store_array(riemann.flux(&minus, &plus, normal, density), &mut flux);
            store_array(beyond, &mut there);
            (L::load(&metric.length[face]) * L::splat(*weight) * L::splat(factor)).store(&mut scale);
            for (lane, neighbour) in neighbours.iter().enumerate() {
                let Some(special) = place.special(face, point, lane, [own, other]) else { continue };
                (0..6).for_each(|k| flux[k].0[lane] = special[k]);
                if matches!(neighbour, Neighbour::Boundary(_)) {
                    // Lanes at a boundary see themselves: they have no jumps.
                    (0..W).for_each(|k| there[k].0[lane] = own[k].0[lane]);
                    let at = [0, 1].map(|k| metric.normal[2 * face + k].0[lane]);
                    FacePower { minus: own, plus: own, flux: &flux }.boundary(&scale, at, lane, sums);
                }
            }
            let power = FacePower { minus: own, plus: &there, flux: &flux };
            power.jumps::<L, W>(&scale, normal, &mut sums.flux_dissipation);
        }
    }
}

/// Lifted numbers of all faces of a block, from the traces in the `slots` of the blocks, into `nodes.lift`; what they add to the balance
/// into `sums`.
pub(super) fn lift(place: Place, traces: &[F8], slots: &[u32], nodes: &mut Arrays, mut sums: Option<&mut Sums>) {
    let Place { scheme, block, .. } = place;
    let (blocks, m) = (&scheme.operators.blocks, scheme.operators.line.m);
    let (flux, metered) = (scheme.flux, sums.is_some());
    let width = width(flux.has_shear(), metered);
    let length = m * width;
    let plan = &blocks.plan[block];
    let mut other: [&[F8]; 4] = [&[]; 4];
    let mut room = &mut nodes.across[..];
    for face in 0..4 {
        let from = match plan[face].side {
            Side::Aligned(there) => {
                other[face] = &traces[face_in(slots, there) * length..][..length];
                continue;
            }
            Side::Joined { first, second, by } => Apart::Joined { first, second, by },
            Side::Gathered(entry) => Apart::Anywhere(&blocks.gathered[entry]),
        };
        let (out, rest) = room.split_at_mut(length);
        room = rest;
        scheme.kernel.run(Collect { traces, slots, from, width, out });
        other[face] = out;
    }
    let own = &traces[face_in(slots, 4 * block) * length..][..4 * length];
    let (metric, weights, density) = (place.metric(), &scheme.operators.line.basis.weights[..m], place.law().density());
    scheme.kernel.run(Faces { flux, metered, own, other, metric, weights, density, lift: &mut nodes.lift });
    for face in 0..4 {
        let sides = Sides { face, own: &own[face * length..][..length], other: other[face] };
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
    pub fn metric(&self) -> Metric<'a> {
        let operators = &self.scheme.operators;
        Metric::of(&operators.geometry, self.block, operators.nodes())
    }

    /// Its law.
    #[inline]
    pub fn law(&self) -> &'a Law {
        &self.scheme.laws[self.scheme.operators.blocks.material[self.block]]
    }

    /// The lifted numbers of lanes at a boundary or at another material, in `lift`, [point][6].
    fn put_right(&self, sides: Sides, lift: &mut [F8]) {
        let (metric, line, face) = (self.metric(), &self.scheme.operators.line, sides.face);
        let width = sides.own.len() / line.m;
        let points = sides.own.chunks_exact(width).zip(sides.other.chunks_exact(width));
        for (point, ((own, other), lift)) in points.zip(lift.as_chunks_mut::<6>().0).enumerate() {
            for lane in 0..LANES {
                let Some(flux) = self.special(face, point, lane, [own, other]) else { continue };
                let scale = metric.length[face].0[lane] * line.basis.weights[point];
                for (k, flux) in flux.iter().enumerate() {
                    let own =
                        if k < 4 { own[4 + k / 2].0[lane] * metric.normal[2 * face + k % 2].0[lane] } else { 0.0 };
                    lift[k].0[lane] = (flux + own) * scale;
                }
            }
        }
    }

    /// The flux of a lane at a boundary or at another material, from the numbers of both sides, each with its own normal;
    /// none elsewhere.
    fn special(&self, face: usize, point: usize, lane: usize, sides: [&[F8]; 2]) -> Option<[f64; 6]> {
        let neighbour = &self.scheme.operators.blocks.neighbours[self.block][face][lane];
        if matches!(neighbour, Neighbour::Cell(_) | Neighbour::Padding) {
            return None;
        }
        let law = self.law();
        let at = self.face_point(face, point, lane, law.density());
        let trace = |side: usize, law: &Law| {
            let x = |k: usize| sides[side][k].0[lane];
            let f = [x(0), x(1), x(2), x(3)];
            let c = if self.scheme.flux.has_shear() { [x(8), x(9)] } else { law.speeds(f, at.normal) };
            let sign = if side == 0 { 1.0 } else { -1.0 };
            Trace { f, v: [x(4), x(5)], t: [sign * x(6), sign * x(7)], c }
        };
        match *neighbour {
            Neighbour::Boundary(group) => {
                Some(self.scheme.boundaries[group].flux(&trace(0, law), &at, self.stage.times))
            }
            Neighbour::Interface(_, material) => {
                let other = &self.scheme.laws[material];
                Some(interface(&trace(0, law), &trace(1, other), at.normal, [law.density(), other.density()]))
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
        let normal = [0, 1].map(|k| geometry.normal[(self.block * 4 + face) * 2 + k].0[lane]);
        FacePoint { x, normal, density }
    }
}
