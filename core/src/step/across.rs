//! The traces across the faces of a block, where they lie.

use super::tiles::Slot;
use crate::lane::{F8, LANES, Lanes, load_array, load_lanes};
use crate::mesh::FACES;
use crate::operators::sides::Gathered;

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
    /// The array of a face, numbered FACES block + local face, with `length` numbers each, and where in it those before it end.
    #[inline(always)]
    fn find(&self, face: usize, length: usize) -> (&'a [F8], usize) {
        let slot = self.slots[face / FACES];
        let all = if slot.store == 0 { self.own } else { self.of_tiles(slot.store) };
        (all, (FACES * slot.index as usize + face % FACES) * length)
    }

    /// What tiles show. (No call, before which sums in registers would have to be stored: 10 % of a flux at S1.)
    #[inline(always)]
    fn of_tiles(&self, store: u32) -> &'a [F8] {
        self.seen.get(store as usize - 1).map_or(self.shown, |seen| &seen[..])
    }

    /// Those of a face, with the numbers before and behind them.
    #[inline(always)]
    pub fn around(&self, face: usize, length: usize) -> &'a [F8] {
        let (all, at) = self.find(face, length);
        &all[at..at + length + 2]
    }

    /// Those of `count` faces.
    #[inline(always)]
    pub fn faces(&self, face: usize, count: usize, length: usize) -> &'a [F8] {
        let (all, at) = self.find(face, length);
        &all[at + 1..at + 1 + count * length]
    }
}

/// Where the numbers of a point across a face come from: one way, so that no loop over points looks at it.
pub(super) trait Other {
    /// The numbers of a point.
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W];
}

/// [point][width], each lane's in the same lane.
#[derive(Clone, Copy)]
pub(super) struct Aligned<'a>(pub &'a [F8]);

impl Other for Aligned<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        load_array(&self.0[point * W..][..W])
    }
}

/// In two runs that begin with their second number, see [`Lanes::load_joined`].
#[derive(Clone, Copy)]
pub(super) struct Joined<'a> {
    pub first: &'a [F8],
    pub second: &'a [F8],
    pub by: usize,
}

impl Other for Joined<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        L::load_joined(self.first, self.second, 1 + point * W, self.by)
    }
}

/// In some faces, with `points` points each: all lanes that one of them has at once.
#[derive(Clone, Copy)]
pub(super) struct Apart<'a> {
    pub traces: &'a Traces<'a>,
    pub from: &'a Gathered,
    pub points: usize,
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
pub(super) struct LaneByLane<'a> {
    /// The face of each lane.
    faces: [&'a [F8]; LANES],
    /// Where its first number is.
    first: [usize; LANES],
    /// How far the next point is from there.
    step: [isize; LANES],
}

impl<'a> LaneByLane<'a> {
    #[inline(always)]
    pub fn new<const W: usize>(Apart { traces, from, points }: Apart<'a>) -> Self {
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
pub(super) enum Beyond<'a> {
    Aligned(Aligned<'a>),
    Joined(Joined<'a>),
    Apart(Apart<'a>),
}

/// On a path that need not be fast.
impl Other for Beyond<'_> {
    #[inline(always)]
    fn load<L: Lanes, const W: usize>(&self, point: usize) -> [L; W] {
        match *self {
            Beyond::Aligned(other) => other.load(point),
            Beyond::Joined(other) => other.load(point),
            Beyond::Apart(other) => other.load(point),
        }
    }
}

impl Beyond<'_> {
    /// Number k of a point with `width` numbers in one lane.
    pub fn number(&self, point: usize, k: usize, width: usize, lane: usize) -> f64 {
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
