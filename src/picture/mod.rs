//! `dgmpm plot`: maps of the fields of a run, and curves of its tables.

mod curves;
mod field;
mod maps;
mod unit;

pub use curves::curves;
pub use maps::{Maps, When};
