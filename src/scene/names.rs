//! The names that scenes choose from and that are not names of types elsewhere.

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
    /// Where P and the internal variables of a law with memory stand, for the method with points.
    Histories {
        /// On the Gauss nodes, wherever the points are: no energy is made.
        Nodes = "nodes",
        /// At the points. Away from the Gauss nodes flow makes energy: for studies.
        Points = "points",
    }
}

names! {
    /// The schedule of the predictor's Picard sweeps.
    Sweeps {
        /// max(N, N_T) + 1 sweeps on all time nodes.
        Paper = "paper",
        /// N sweeps, the j-th from j time nodes to j + 1, where N_T = N: fewer evaluations of the law (not in the paper).
        Ladder = "ladder",
    }
}

names! {
    /// The flux on inner faces.
    Flux {
        /// Local Lax-Friedrichs.
        Rusanov = "rusanov",
        /// Linearised Godunov; alone it is unstable under compression, where F loses its being a gradient.
        Acoustic = "acoustic",
        /// Acoustic with a penalty on the tangential jump of F.
        AcousticCurl = "acoustic-curl",
        /// Lax-Friedrichs in velocity and traction, with the jump of the rotation of F, which does no work.
        Dual = "dual",
    }
}

impl Flux {
    /// What computes it.
    pub fn build(self) -> crate::step::Flux {
        use crate::riemann::{Acoustic, AcousticCurl, Dual, Rusanov};
        match self {
            Flux::Rusanov => crate::step::Flux::new(Rusanov),
            Flux::Acoustic => crate::step::Flux::new(Acoustic),
            Flux::AcousticCurl => crate::step::Flux::new(AcousticCurl),
            Flux::Dual => crate::step::Flux::new(Dual),
        }
    }
}
