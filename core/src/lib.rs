//! # dgmpm-core: the discretisation of dgmpm
//!
//! Mesh, points, matrices and the step of `dgmpm`, whose documentation has the method on one page and what a user needs of this crate.
//! The modules are open to `dgmpm`, which has scenes, files, commands and tables of what can be named; they are no surface with promises.
//!
//! The order of the modules below is the order of dependency: a module uses only those above it (`tests/layers.rs` of `dgmpm` holds this).

// A program without an effect has code that nothing calls.
#![cfg_attr(
    not(all(
        feature = "kernel-avx512",
        feature = "effect-forces",
        feature = "effect-balance",
        feature = "effect-sources",
        feature = "effect-corrections",
        feature = "effect-curl",
        feature = "effect-contact",
        feature = "effect-memory",
        feature = "effect-conditions",
    )),
    allow(dead_code, unused_imports)
)]
#![deny(missing_docs)]
// All `unsafe` is in `lane`, which has the one exception (`tests/layers.rs` holds this).
#![deny(unsafe_code)]
// Links to private modules are for those who work on the crate: `cargo doc --document-private-items`.
#![allow(rustdoc::private_intra_doc_links)]

#[macro_use]
#[doc(hidden)]
pub mod names;
#[doc(hidden)]
pub mod error;
#[doc(hidden)]
pub mod built;
#[doc(hidden)]
pub mod format;
#[doc(hidden)]
#[allow(unsafe_code)]
pub mod lane;
#[doc(hidden)]
pub mod words;
#[doc(hidden)]
pub mod sum;
pub mod tensor;
#[doc(hidden)]
pub mod quadrature;
#[doc(hidden)]
pub mod basis;
#[doc(hidden)]
pub mod mesh;
#[doc(hidden)]
pub mod cloud;
#[doc(hidden)]
pub mod operators;
#[doc(hidden)]
pub mod state;
#[doc(hidden)]
pub mod material;
#[doc(hidden)]
pub mod riemann;
#[doc(hidden)]
pub mod boundary;
#[doc(hidden)]
pub mod contact;
#[doc(hidden)]
pub mod source;
#[doc(hidden)]
pub mod exchange;
#[doc(hidden)]
pub mod step;
#[doc(hidden)]
pub mod limiter;
#[doc(hidden)]
pub mod regrid;
#[doc(hidden)]
pub mod exact;
#[doc(hidden)]
pub mod expression;

pub use error::{Error, Place, Result};
