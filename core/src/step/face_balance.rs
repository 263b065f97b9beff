//! What faces between cells add to the balance of energy.

use super::across::Other;
use super::balance::{BlockBalance, FacePower};
use super::block::Block;
use super::block_work::FluxWork;
use super::creep::{Pull, Pulling};
use super::sides::Sides;
use super::trace::{trace_of, turn, turned, with_width};
use super::volume::width;
use crate::lane::{F8, Lanes, load_array, store_array};
use crate::operators::Neighbour;
use crate::riemann::{Looks, Riemann};
use crate::state::UNKNOWNS;

/// What a face between cells adds to the balance of the block. The fluxes are found once more: without the balance they never come to
/// memory.
pub(super) struct FaceBalance<'a, 'b> {
    pub block: Block<'a>,
    pub sides: Sides<'a>,
    /// What pulls at the faces; none where they have no springs.
    pub pull: Option<Pull<'a>>,
    pub balance: &'b mut BlockBalance,
}

impl FluxWork for FaceBalance<'_, '_> {
    #[inline(always)]
    fn run<L: Lanes, R: Riemann>(self, riemann: &R) {
        with_width!(R::LOOKS, true, W => self.with::<L, _, W>(riemann));
    }
}

impl FaceBalance<'_, '_> {
    #[inline(always)]
    fn with<L: Lanes, R: Riemann, const W: usize>(self, riemann: &R) {
        let Self { block, sides, pull, balance } = self;
        let (scheme, metric, face) = (block.scheme, block.metric(), sides.face);
        let neighbours = &scheme.operators.blocks.neighbours[block.number][face];
        let factor = block.factor();
        let mut medium = block.medium().splat::<L>();
        if R::LOOKS == Looks::Displacement {
            medium.turn = turn::<L, _, W>(sides.own.as_chunks::<W>().0, sides.other, block.turning());
        }
        let weights = &scheme.operators.line.basis.weights[..scheme.operators.line.m];
        let points = sides.own.as_chunks::<W>().0;
        for (point, (own, weight)) in points.iter().zip(weights).enumerate() {
            let (normal, length) = metric.at_face::<L>(face, point);
            let springs = match pull {
                Some(pull) => {
                    let inverse = metric.inverse_length::<L>(face, point);
                    Some((pull, pull.face::<L, _, W>(points, sides.other, (normal, inverse))))
                }
                None => None,
            };
            let beyond = turned::<L, R, W>(sides.other.load::<L, W>(point));
            let minus = trace_of::<L, R, W>(&load_array::<L, W>(own));
            let plus = trace_of::<L, R, W>(&beyond);
            let (mut flux, mut there, mut scale) = ([F8::ZERO; UNKNOWNS], [F8::ZERO; W], F8::ZERO);
            store_array(riemann.flux(&minus, &plus, normal, &medium), &mut flux);
            store_array(beyond, &mut there);
            let mut stored = F8::ZERO;
            if let Some((pull, of_face)) = &springs {
                let at = face * scheme.operators.line.m + point;
                pull.meter(at, of_face, riemann, [&minus, &plus], &medium, &mut flux).store(&mut stored);
            }
            (length * L::splat(*weight * factor)).store(&mut scale);
            for (lane, neighbour) in neighbours.iter().enumerate() {
                match neighbour {
                    // What a condition loses is booked with its work; it has no jumps, and no flux that means anything.
                    Neighbour::Boundary(_) => {
                        (0..W).for_each(|k| there[k].0[lane] = own[k].0[lane]);
                        flux.iter_mut().for_each(|number| number.0[lane] = 0.0);
                        stored.0[lane] = 0.0;
                    }
                    Neighbour::Interface(..) => {
                        let stored = &mut stored.0[lane];
                        *stored = 0.0;
                        let pulling = pull.map(|pull| Pulling::Still(pull, stored));
                        let between =
                            block.single_face(face, lane).map(|face| face.flux(sides, point, &mut [], pulling));
                        between.iter().for_each(|f| (0..UNKNOWNS).for_each(|k| flux[k].0[lane] = f[k]));
                    }
                    Neighbour::Cell(_) | Neighbour::Padding => {}
                }
            }
            let power = FacePower { minus: own, plus: &there, flux: &flux, stored: &stored };
            power.jumps::<L, W>(&scale, normal, &mut balance.flux);
        }
    }
}
