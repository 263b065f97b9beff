//! (to come)

pub mod gmsh;
