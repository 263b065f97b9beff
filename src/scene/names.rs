//! The names that scenes choose from, each list written once.

/// An enum whose variants have names in scenes: `NAMES`, `name()` and serialisation as the name.
macro_rules! names {
    ($(#[$doc:meta])* $type:ident { $($(#[$variant_doc:meta])* $variant:ident = $name:literal,)+ }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $type {
            $($(#[$variant_doc])* $variant,)+
        }

        impl $type {
            /// Every variant with its name.
            pub const NAMES: &'static [(&'static str, $type)] = &[$(($name, $type::$variant),)+];

            /// The name in scenes and results.
            pub fn name(self) -> &'static str {
                match self {
                    $($type::$variant => $name,)+
                }
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }
    };
}

names! {
    /// The method of the step.
    Method {
        /// ADER-DG on material points (the paper's method).
        AderDgmpm = "ader-dgmpm",
        /// ADER-DG with the Gauss nodes as points.
        AderDgfem = "ader-dgfem",
        /// Runge-Kutta DG on the Gauss nodes.
        RkDgfem = "rk-dgfem",
    }
}

names! {
    /// The flux on faces between cells of one material.
    Flux {
        /// Mean of both sides and c_p/2 times the jump of U.
        Rusanov = "rusanov",
        /// The exact linear solver for pressure and shear waves; unstable in compression on its own.
        Acoustic = "acoustic",
        /// `acoustic` with c_p/2 times the tangential jump of F.
        AcousticCurl = "acoustic-curl",
    }
}

names! {
    /// The schedule of the predictor's Picard sweeps.
    Sweeps {
        /// max(N, N_T) + 1 sweeps on all time nodes.
        Paper = "paper",
    }
}

names! {
    /// A field of outputs and exports.
    Field {
        /// v, in m/s.
        Velocity = "velocity",
        /// x - X, in m.
        Displacement = "displacement",
        /// F.
        Deformation = "deformation",
        /// First Piola-Kirchhoff stress P, in Pa.
        Piola = "piola",
        /// sigma = P F^T / J, in Pa.
        CauchyStress = "cauchy_stress",
        /// J = det F.
        Jacobian = "jacobian",
        /// Von Mises stress of sigma (with sigma33), in Pa.
        VonMises = "von_mises",
    }
}
