//! The fluxes on inner faces, `[scheme] flux = ..`.

use super::{ANY, Entry, Table};
use crate::riemann::{Acoustic, AcousticCurl, Dual, Looks, Rusanov};
use crate::step;

/// What there is to know of a flux.
pub struct Flux {
    /// Makes it.
    pub make: fn() -> step::Flux,
    /// What may help a run that lost stability with the default flux, and why another flux may be the reason. Its argument
    /// says whether a law of the run has a memory.
    pub when_lost: fn(bool) -> Option<&'static str>,
    /// Share of the limit of the step that it leaves; 1 for most.
    pub share: f64,
}

/// The flux of a scene that names none.
pub const DEFAULT: &str = "dual";

/// The same in words, see [`super::limiters::Kind::flux`].
pub const DEFAULTS: &str =
    "dual; with a limiter rusanov, but for laws with internal variables or a Poisson's ratio above .45";

const WITH_MEMORY: &str = "makes energy where a law with internal variables flows";

const OTHER: &str = "scheme.flux = \"rusanov\" damps all jumps of F, and holds some corners that are crushed";

/// Every flux.
pub static FLUXES: Table<Flux> = Table::new(&[
    Entry {
        name: "dual",
        about: "Lax-Friedrichs in velocity and traction, with the jump of the rotation of F, which does no work",
        parameters: &[],
        check: ANY,
        build: Flux { make: || step::Flux::from(Dual), when_lost: |memory| (!memory).then_some(OTHER), share: 1.0 },
    },
    Entry {
        name: "rusanov",
        about: "local Lax-Friedrichs: damps all jumps",
        parameters: &[],
        check: ANY,
        build: Flux {
            make: || step::Flux::from(Rusanov),
            when_lost: |memory| match memory {
                true => Some(WITH_MEMORY),
                false => Some("makes energy in large motions of a nearly incompressible body"),
            },
            share: 1.0,
        },
    },
    Entry {
        name: "acoustic",
        about: "linearised Godunov; unstable in compression where the curl of F is not controlled",
        parameters: &[],
        check: ANY,
        build: Flux { make: || step::Flux::from(Acoustic), when_lost, share: 1.0 },
    },
    // Measured by `dgmpm stability`: .82 of the limit of the other fluxes at degree 1, .82 to .75 at 2, for nu .3 to .4, and less beyond.
    Entry {
        name: "acoustic-curl",
        about: "acoustic with a penalty on the tangential jump of F, which shortens the step",
        parameters: &[],
        check: ANY,
        build: Flux { make: || step::Flux::from(AcousticCurl), when_lost, share: 0.6 },
    },
]);

/// Whether faces with a flux can give back what they creep ([`crate::riemann::creep`]).
pub fn may_have_springs(flux: &Flux) -> bool {
    (flux.make)().looks() == Looks::Displacement
}

fn when_lost(memory: bool) -> Option<&'static str> {
    Some(if memory { WITH_MEMORY } else { "holds less in compression" })
}
