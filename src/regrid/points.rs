//! Where material points go at a regrid.
