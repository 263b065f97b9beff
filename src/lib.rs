//! # dgmpm: the ADER Discontinuous Galerkin Material Point Method
//!
//! Fast transient, large-deformation dynamics of solids in their initial configuration (total
//! Lagrangian), after Lakiss, Heuzé, Tannous, Stainier, "La Méthode des Points Matériels couplée avec
//! Galerkin discontinu et l'intégrateur temporel ADER", CSMA 2024, hal-04610967 (cited below by its
//! equation numbers), beside RK-DGFEM and ADER-DGFEM.
//!
//! The order of the modules is the order of dependency: a module uses only those above it
//! (`tests/layers.rs` holds this).

#![deny(missing_docs)]

#[macro_use]
mod names;
pub mod error;
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
pub mod io;
pub mod observe;
pub mod run;
pub mod exact;
pub mod scene;
pub mod cli;

pub use error::{Error, Place};
