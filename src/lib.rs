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
//! [`step::Motion`] goes from step to step. What a scheme lists as [`step::Correction`]s, limiters and dampings, changes the
//! new state after a step.
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
//! ## The house
//!
//! Data flows mesh, cloud, operators, state, step, output. The order of the modules below is the order of dependency: a
//! module uses only those above it (`tests/layers.rs` holds this). [`step::Scheme`] is read-only, [`state::State`] is all
//! that changes, [`step::Work`] carries nothing from step to step. A new law, flux, boundary condition or source is one
//! file and a line in its registry.

#![deny(missing_docs)]

#[macro_use]
mod names;
pub mod error;
mod format;
pub mod lane;
pub mod tensor;
pub mod quadrature;
pub mod basis;
pub mod mesh;
pub mod cloud;
pub mod operators;
pub mod state;
pub mod material;
pub mod riemann;
pub mod boundary;
pub mod source;
pub mod step;
pub mod regrid;
pub mod io;
pub mod chart;
pub mod observe;
pub mod run;
pub mod exact;
pub mod scene;
pub mod problem;
pub mod stability;
pub mod study;
pub mod bench;
pub mod cli;

pub use error::{Error, Place};
