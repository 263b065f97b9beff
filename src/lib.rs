//! # dgmpm: the ADER Discontinuous Galerkin Material Point Method
//!
//! Fast transient, large-deformation dynamics of solids in their initial configuration (total Lagrangian), after
//! Lakiss, Heuzé, Tannous, Stainier, "La Méthode des Points Matériels couplée avec Galerkin discontinu et l'intégrateur
//! temporel ADER", CSMA 2024, hal-04610967 (cited by its equation numbers), beside RK-DGFEM and ADER-DGFEM.
//!
//! ## The method on one page
//!
//! Unknowns are U = (F11, F12, F21, F22, p1, p2), the deformation gradient F_ia = dx_i/dX_a and the momentum
//! p = rho0 v, in plane strain (F33 = 1); Q = (P, v) holds the first Piola-Kirchhoff stress P(F) ([`material`]).
//!
//! ```text
//! dF_ia/dt - dv_i/dX_a = 0        dp_i/dt - dP_ia/dX_a = rho0 b_i        (1), (2)      S [U] = [Flux].N at a jump (3)
//! ```
//!
//! The grid ([`mesh`]) has bilinear cells with polynomials Q_N at (N+1)^2 Gauss-Legendre points ([`basis::lagrange`]),
//! where the mass matrix w_a J_a is diagonal and exact. Material points ([`cloud`]) lie anywhere in the cells, with
//! moving-least-squares functions chi_p (18) on the full Q_N ([`basis::mls`]); where the points of a cell cannot carry it,
//! virtual ones on its Gauss nodes take their place ([`operators::carry`](mod@operators::carry)). A step ([`step`]) is:
//!
//! 1. grid to points (22): U_p = sum_a Phi_a(X_p) U_a;
//! 2. local predictor (15)-(21): at the time nodes tau_s, by Picard sweeps u_s,p <- U_p + dt sum_k At\[s,k\] r_k,p, with
//!    r = (Grad v, Div P + rho0 b) by derivatives of chi; the paper's N+1 sweeps on all nodes, or the ladder of N sweeps
//!    with one node more each ([`step::sweeps`]; not in the paper, the default where N_T = N);
//! 3. time averages of F, v and P at the points, to the grid by chi_p(X_a) (18);
//! 4. corrector (11)-(14): U_a += dt [ sum_b K_alpha\[a,b\] Flux_alpha(q_b) - faces ], one flux ([`riemann`],
//!    [`boundary`]) per face point and step, from averaged traces;
//! 5. control of the curl: rotation and deviator of what in F is no gradient of its cell ([`operators::curl_free`]) are
//!    relaxed, at a rate tied to compression. Without it the discrete system is unstable there, whatever dt (not in the
//!    paper; `docs/method.md`).
//!
//! [`step::Motion`] goes from step to step. What a scheme lists as [`step::Correction`]s, such as a [`limiter`] (step 3(c) of the
//! paper), changes the new state after a step. Where a scheme has a [`step::Rescue`], cells that a step loses are stepped again at
//! order 0.
//!
//! ADER-DGFEM has its points at the nodes (chi = Phi); RK-DGFEM replaces 1 to 3 by Runge-Kutta stages. Grid unknowns are
//! the master copy between steps; internal variables live at the points and are never projected. The step size follows
//! the largest current wave speed ([`step::cfl`]).
//!
//! ## Glossary
//!
//! `a`, `b` number nodes (a = i M + j, M = N + 1, i along xi1), `p` points, `s`, `k` time nodes, `N` also the unit outward
//! normal in X; `f` is F, `j` det F, `p` in laws is P, `t` a traction P N or the time, `c` wave speeds (c_p, c_s), `h` the
//! length h_e of a cell, `xi` parent coordinates. A *block* is eight cells, one a *lane* ([`lane`]).
//!
//! ## A run in ten lines
//!
//! ```no_run
//! use dgmpm::{Export, Folder, Problem};
//!
//! fn main() -> dgmpm::Result<()> {
//!     let mut problem = Problem::load("meshes/square_impact.toml".as_ref(), &["time.end=3e-4".to_owned()])?;
//!     let folder = Folder::new("runs/first".as_ref());
//!     let report = problem.run_in(&folder)?;
//!     println!("{} steps, energy {:.4} of the start", report.steps, report.energy_ratio());
//!     Export::new(&folder)?.vtu()
//! }
//! ```
//!
//! `examples/own_law.rs` adds a law, `examples/own_scene.rs` builds a run without a scene file. [`registry`] has all that scenes
//! can name; what a crate adds to its tables, scenes name as if it were built in.
//!
//! ## The house
//!
//! Data flows mesh, cloud, operators, state, step, output. Mesh to step stand in a crate of their own, `dgmpm-core`, which knows no
//! scene, no file and no command; this one hands on what a user needs of it. The order of the modules there and then below is the order of
//! dependency: a module uses only those above it (`tests/layers.rs` holds this). [`Scheme`] is read-only, [`State`] is all that changes.
//! A new law, flux, boundary condition, source, solution, output, quantity, grid, layout or limiter is one file and one entry of [`registry`]
//! (`docs/extend.md`). The modules are private: what a user needs stands on the page of `pub use` below.

// A program without an effect has code that nothing calls.
#![cfg_attr(not(feature = "effects"), allow(dead_code, unused_imports))]
#![deny(missing_docs)]
#![forbid(unsafe_code)]
// Links to private modules are for those who work on the crate: `cargo doc --document-private-items`.
#![allow(rustdoc::private_intra_doc_links)]

#[macro_use]
extern crate dgmpm_core;

// The modules of the discretisation, under the names that they have in their crate.
pub use dgmpm_core::tensor;
use dgmpm_core::{
    basis, boundary, built, cloud, contact, error, exact, exchange, expression, format, lane, limiter, material, mesh,
    names, operators, quadrature, regrid, riemann, source, state, step, sum, words,
};

mod file;
mod io;
mod chart;
mod observe;
mod run;
mod accuracy;
mod quantity;
mod track;
pub mod registry;
mod scene;
mod problem;
mod info;
mod picture;
mod stability;
mod study;
mod bench;
mod effects;
mod cli;

pub use error::{Error, Place, Result};

// A run: scene, problem, results.
pub use problem::{Body, Export, Files, Given, Outcome, Problem, Setup, Solve, Store};
pub use run::{Folder, Report, Settings};
pub use scene::Scene;

// A run by hand: mesh, points, matrices, scheme, state, steps.
pub use basis::TimeBasis;
pub use cloud::{Cloud, Locator, seed};
pub use mesh::{Mesh, links, periodic_links, rectangle};
pub use operators::{Needs, Operators, Sampling};
pub use state::State;
pub use step::{Control, Loss, Method, Motion, Relax, Scheme, Survey, Sweeps, Tableau, Totals, cfl};

// Several programs that step a body together.
pub use exchange::{BlockGraph, Exchange};

// What a crate may add: laws, fluxes, conditions, sources, corrections, observers.
pub use boundary::{
    Absorbing, Boundary, Data, FacePoint, Foundation, Free, GivesBack, Moment, Obstacle, Pressure, Shape, TimeNode,
    Traction, Unilateral, Velocity, Wall, WholeFace,
};
pub use lane::{F8, Kernel, LANES, Lane, Lanes};
pub use limiter::{Beside, Cell, CellLimiter, Limiter, Modes, MomentLimiter, Sensor, VertexLimiter};
pub use material::{
    J2, LinearElastic, Material, NeoHookean, Numbers, Past, PointLaw, Rank, Response, StVenantKirchhoff, Variable,
};
pub use observe::{Field, NewGrid, Observer, Point, Schedule, Sight, Solution, View};
pub use riemann::{Acoustic, AcousticCurl, Dual, Impedance, Looks, Medium, Riemann, Rusanov, Trace, star};
pub use source::{BodyForce, Damping, PressurePulse, Source, Varies};
pub use step::{Balance, Corrected, Correction, Flux, Law, Made, Notes, Rescue};
pub use words::{Saved, Words};

// Exact solutions and errors.
pub use accuracy::{Errors, Norms, errors};
pub use exact::Exact;

// Quantities of interest.
pub use quantity::{Quantity, Seen};
pub use track::{Column, Track, Tracked};

/// The command line, `dgmpm ..`. A program that adds to [`registry`] first has it with laws, conditions and sources of its own.
pub use cli::main;

/// The same on several ranks, each of which is a process that calls it. Rank 0 prints and writes files.
pub use cli::main_on;

/// Says from which commit a program was built, for the files that it writes.
pub use built::from_commit;

/// The recipes of `docs/extend.md`, compiled by the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../docs/extend.md")]
pub struct Recipes;

/// All modules, for the tests and benches of this crate: no part of its surface, and without promises.
#[doc(hidden)]
pub mod parts {
    pub use dgmpm_core::{
        basis, boundary, built, cloud, error, exact, exchange, expression, lane, limiter, material, mesh, operators,
        quadrature, regrid, riemann, source, state, step, words,
    };

    pub mod io {
        pub use crate::io::*;
    }
    pub mod chart {
        pub use crate::chart::*;
    }
    pub mod observe {
        pub use crate::observe::*;
    }
    pub mod run {
        pub use crate::run::*;
    }
    pub mod accuracy {
        pub use crate::accuracy::*;
    }
    pub mod quantity {
        pub use crate::quantity::*;
    }
    pub mod track {
        pub use crate::track::*;
    }
    pub mod scene {
        pub use crate::scene::*;
    }
    pub mod problem {
        pub use crate::problem::*;
    }
    pub mod stability {
        pub use crate::stability::*;
    }
    pub mod study {
        pub use crate::study::*;
    }
    pub mod bench {
        pub use crate::bench::*;
    }
    pub mod effects {
        pub use crate::effects::*;
    }
}
