//! The acceleration b of all sources at a place of 8 cells.

use super::block::Block;
use crate::lane::{F8, LANES};
use crate::mesh::map::{self, CellMap};
use crate::source::Varies;
use crate::tensor::AXES;

/// Vectors of 8 cells.
pub(super) type Vectors = [F8; AXES];

/// Places of 8 cells.
pub(super) type Places = [[f64; AXES]; LANES];

/// One number for each lane.
pub(super) fn by_lane(number: impl FnMut(usize) -> f64) -> F8 {
    F8(std::array::from_fn(number))
}

/// sum += factor number.
pub(super) fn add_times(sum: &mut F8, factor: f64, number: &F8) {
    sum.0.iter_mut().zip(number.0).for_each(|(sum, number)| *sum += factor * number);
}

/// The sum of all sources on a block.
pub(super) struct Acceleration<'a> {
    block: Block<'a>,
    /// What it varies with.
    pub varies: Varies,
    /// The maps of the cells; of none where no source asks for the place.
    maps: [Option<CellMap>; LANES],
    /// Cells that are evaluated; the others have what the first one has.
    evaluated: usize,
}

impl<'a> Acceleration<'a> {
    /// Of the sources of the scheme.
    pub fn of(block: &Block<'a>) -> Self {
        let sources = block.scheme.sources.iter();
        let varies = sources.fold(Varies::default(), |all, source| all.or(source.varies()));
        let mut maps = [None; LANES];
        if varies.place {
            for (lane, map) in maps.iter_mut().enumerate() {
                *map = Some(block.scheme.operators.geometry.map_of(block.number, lane));
            }
        }
        let evaluated = if varies.place || varies.velocity { block.cells() } else { 1 };
        Self { block: *block, varies, maps, evaluated }
    }

    /// X at parent coordinates, by lane; 0 where no source asks for it.
    pub fn places(&self, xi: impl Fn(usize) -> [f64; AXES]) -> Places {
        let mut places = [[0.0; AXES]; LANES];
        for (lane, (place, map)) in places.iter_mut().zip(&self.maps).enumerate() {
            if let Some(map) = map {
                *place = map::position(map, xi(lane));
            }
        }
        places
    }

    /// b at places, a time and velocities; 0 in padding lanes, which stay at rest.
    pub fn at(&self, places: &Places, time: f64, v: &Vectors) -> Vectors {
        let (material, mut out) = (self.block.material(), [F8::ZERO; AXES]);
        for source in &self.block.scheme.sources {
            for (lane, x) in places.iter().enumerate().take(self.evaluated) {
                let b = source.acceleration(*x, time, [v[0].0[lane], v[1].0[lane]], material);
                (0..AXES).for_each(|k| out[k].0[lane] += b[k]);
            }
        }
        for b in &mut out {
            let first = b.0[0];
            b.0[self.evaluated..self.block.cells()].fill(first);
        }
        out
    }
}
