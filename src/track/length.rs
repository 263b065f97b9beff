//! The distance of two points, or how far a group of cells or edges or the whole body reaches, through time.

use super::{Column, Track};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::quantity::{Quantity, Seen};

/// A length that is a quantity: [`crate::quantity::Length`] or [`crate::quantity::Extent`]; m.
pub struct Lengths(pub Box<dyn Quantity>);

impl Track for Lengths {
    fn columns(&self) -> Vec<Column> {
        vec![("length".to_owned(), "m")]
    }

    fn push(&mut self, seen: &Seen, row: &mut Vec<f64>) {
        row.push(self.0.of(seen));
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        self.0.moved(mesh)
    }
}
