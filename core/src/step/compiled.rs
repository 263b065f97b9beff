//! The laws and fluxes of this crate with their kernels, compiled here, once: [`Law::new`] and [`Flux::new`] compile those of a law or a flux in
//! the crate that calls them, which takes half a minute, at the optimisation of that crate. A new law or flux has a line here.

use super::{Flux, Law};
#[cfg(feature = "effect-memory")]
use crate::material::J2;
use crate::material::{LinearElastic, NeoHookean, StVenantKirchhoff};
use crate::riemann::{Acoustic, AcousticCurl, Dual, Rusanov};

macro_rules! compiled {
    ($whole:ident: $part:ty) => {
        impl From<$part> for $whole {
            #[inline(never)]
            fn from(part: $part) -> $whole {
                $whole::new(part)
            }
        }
    };
}
compiled!(Law: NeoHookean);
compiled!(Law: LinearElastic);
compiled!(Law: StVenantKirchhoff);
#[cfg(feature = "effect-memory")]
compiled!(Law: J2);
compiled!(Flux: Dual);
compiled!(Flux: Rusanov);
compiled!(Flux: Acoustic);
compiled!(Flux: AcousticCurl);
