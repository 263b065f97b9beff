//! What ranks send to each other, as plain numbers.

use super::Speeds;
use super::balance::BlockBalance;
use super::loss::FacePoint;
use super::outside::{ExternalWork, FaceForces, Torques};
use super::worst::Worst;
use crate::lane::{F8, LANES};

/// A fixed count of numbers, to be sent.
pub trait Numbers {
    const COUNT: usize;
    fn write(&self, to: &mut [f64]);
    fn read(&mut self, from: &[f64]);
}

impl Numbers for f64 {
    const COUNT: usize = 1;
    fn write(&self, to: &mut [f64]) {
        to[0] = *self;
    }
    fn read(&mut self, from: &[f64]) {
        *self = from[0];
    }
}

impl Numbers for F8 {
    const COUNT: usize = LANES;
    fn write(&self, to: &mut [f64]) {
        to.copy_from_slice(&self.0);
    }
    fn read(&mut self, from: &[f64]) {
        self.0.copy_from_slice(from);
    }
}

/// A type that consists of fields of eight lanes, in this order.
macro_rules! of_lanes {
    ($type:ty, $count:literal, $value:ident => $fields:expr) => {
        impl Numbers for $type {
            const COUNT: usize = $count * LANES;
            fn write(&self, to: &mut [f64]) {
                let mut copy = *self;
                let $value = &mut copy;
                $fields.into_iter().zip(to.chunks_exact_mut(LANES)).for_each(|(from, to)| from.write(to));
            }
            fn read(&mut self, from: &[f64]) {
                let $value = self;
                $fields.into_iter().zip(from.chunks_exact(LANES)).for_each(|(to, from)| to.read(from));
            }
        }
    };
}

of_lanes!(ExternalWork, 4, of => [&mut of.boundary, &mut of.source].into_iter().chain(&mut of.impulse));
of_lanes!(FaceForces, 12, of => of.impulse.iter_mut().flatten().chain(&mut of.work));
of_lanes!(Torques, 4, of => of);
of_lanes!(BlockBalance, 4, of => [&mut of.flux, &mut of.boundary, &mut of.corrected, &mut of.energy]);
of_lanes!(Speeds, 2, of => [&mut of.fastest, &mut of.prestress]);

impl Numbers for Worst {
    /// The lanes of the fastest and of the least J, the lost block, and the face point: its block (none: below 0), lane, face, point, J.
    const COUNT: usize = 2 * LANES + 6;
    fn write(&self, to: &mut [f64]) {
        let face = self.face.map_or([-1.0; 5], |face| {
            [face.block as f64, face.lane as f64, face.at[0] as f64, face.at[1] as f64, face.j]
        });
        let lost = if self.lost == usize::MAX { -1.0 } else { self.lost as f64 };
        let numbers = self.fastest.0.into_iter().chain(self.min_j.0).chain([lost]).chain(face);
        to.iter_mut().zip(numbers).for_each(|(to, from)| *to = from);
    }
    fn read(&mut self, from: &[f64]) {
        let (lanes, rest) = from.split_at(2 * LANES);
        self.fastest.read(&lanes[..LANES]);
        self.min_j.read(&lanes[LANES..]);
        self.lost = if rest[0] < 0.0 { usize::MAX } else { rest[0] as usize };
        let [block, lane, face, point] = [1, 2, 3, 4].map(|k| rest[k] as usize);
        self.face = (rest[1] >= 0.0).then_some(FacePoint { block, lane, at: [face, point], j: rest[5] });
    }
}
