//! Where the energy that passes the faces of a block is booked.

use super::balance::BlockBalance;
use super::creep::Creep;
use super::outside::{ExternalWork, FaceForces};
use super::phase::Ticks;

/// Where the energy that passes the faces of a block goes.
pub(super) struct Meter<'a> {
    /// The work on the block; none where nothing outside touches it.
    pub external: Option<&'a mut ExternalWork>,
    /// The forces at the faces; none where nobody asks for them.
    pub forces: Option<&'a mut FaceForces>,
    /// The balance; none where it is off.
    pub balance: Option<&'a mut BlockBalance>,
    /// The memory of the conditions at the block.
    pub memory: &'a mut [f64],
    /// The creep of the faces of the block; none where they have no springs.
    pub creep: Option<Creep<'a>>,
    /// The clock of the thread.
    pub phases: &'a mut Ticks,
}
