//! The worst of the blocks that a step or a survey has seen.

use super::loss::FacePoint;
use super::partition::{Partition, first_number};
use crate::lane::{F8, LANES, Lanes};

/// The worst of some blocks. Minimum and maximum do not depend on the order: same bits for any number of threads.
#[derive(Debug, Clone, Copy)]
pub(super) struct Worst {
    /// The first block that lost stability, by [`first_number`]; `usize::MAX` where all are stable.
    pub lost: usize,
    /// The first block that began the step with J <= 0 at a face.
    pub face: Option<FacePoint>,
    /// Largest speed of the cells in each lane.
    pub fastest: F8,
    /// Smallest J of the cells in each lane.
    pub min_j: F8,
}

impl Worst {
    /// That of no block.
    pub const NONE: Self = Self { lost: usize::MAX, face: None, fastest: F8::ZERO, min_j: F8::splat(f64::INFINITY) };

    /// With what was found in a block with so many real cells; `partition` orders the blocks.
    #[inline(always)]
    pub fn see<L: Lanes>(&mut self, mut found: Found, block: usize, cells: usize, partition: Option<&Partition>) {
        for lane in cells..LANES {
            (found.speed.0[lane], found.min_j.0[lane], found.lost.0[lane]) = (0.0, f64::INFINITY, 0.0);
        }
        L::load(&self.fastest).max(L::load(&found.speed)).store(&mut self.fastest);
        L::load(&self.min_j).min(L::load(&found.min_j)).store(&mut self.min_j);
        let mut bits = 0;
        for lost in &found.lost.0 {
            bits |= lost.to_bits();
        }
        if bits != 0 {
            self.lost = self.lost.min(first_number(partition, block));
        }
    }

    /// With the smallest J at the face points of a block with so many real cells; whether one is not above 0.
    #[inline(always)]
    pub fn see_faces<L: Lanes>(&mut self, smallest: L, cells: usize) -> bool {
        let (mut j, mut lost, mut bits) = (F8::ZERO, F8::ZERO, 0);
        smallest.store(&mut j);
        for lane in cells..LANES {
            j.0[lane] = f64::INFINITY;
        }
        L::load(&self.min_j).min(L::load(&j)).store(&mut self.min_j);
        L::load(&j).where_positive(L::zero(), L::splat(1.0)).store(&mut lost);
        for lost in &lost.0 {
            bits |= lost.to_bits();
        }
        bits != 0
    }

    /// With a face point where J <= 0.
    #[cold]
    pub fn lost_at(&mut self, face: FacePoint) {
        self.face = FacePoint::first(self.face, Some(face));
    }

    /// The worst of both sets of blocks.
    pub fn and(mut self, other: Self) -> Self {
        self.lost = self.lost.min(other.lost);
        self.face = FacePoint::first(self.face, other.face);
        for lane in 0..LANES {
            self.fastest.0[lane] = self.fastest.0[lane].max(other.fastest.0[lane]);
            self.min_j.0[lane] = self.min_j.0[lane].min(other.min_j.0[lane]);
        }
        self
    }
}

/// What is found in a block.
pub(super) struct Found {
    /// Largest wave speeds.
    pub speed: F8,
    /// Smallest J.
    pub min_j: F8,
    /// 0 in the lanes of cells that are stable.
    pub lost: F8,
}
