//! What a campaign compares: sizes, series and variants.

use crate::chart::Marker;
use crate::registry::Method;

/// Sizes, in grid unknowns: near the caches, in memory, and what fills it.
pub const SIZES: [usize; 3] = [60_000, 900_000, 10_000_000];
/// A series: method and layout, as the tables and pictures call it.
pub const SERIES: [(&str, Method, Option<&str>, Marker); 4] = [
    ("rk-dgfem", Method::RkDgfem, None, Marker::Circle),
    ("ader-dgfem", Method::AderDgfem, None, Marker::Triangle),
    ("ader-dgmpm, lattice", Method::AderDgmpm, Some("midpoints"), Marker::Square),
    ("ader-dgmpm, any cloud", Method::AderDgmpm, Some("jitter"), Marker::Cross),
];

/// The variants on the unstructured mesh and on squares beside it.
pub const UNSTRUCTURED: &str = "unstructured";
pub const AS_MANY: &str = "as many squares";
