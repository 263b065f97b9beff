//! A point of the material, followed through time: where it is, and fields there. A line of one sample, at every step.

use super::{Column, Track};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::observe::{Field, Spot};
use crate::quantity::{Component, Places, Seen};

/// x = X + u in m, and components of fields at X. A point on an edge belongs to the cell of the lowest number, as that of a line.
pub struct Probe {
    at: Places,
    fields: Vec<Field>,
    /// The point on the present grid, once a state of it has been seen.
    spot: Option<Spot>,
}

impl Probe {
    /// Fields at a place.
    pub fn new(at: Places, fields: Vec<Field>) -> Self {
        Self { at, fields, spot: None }
    }
}

impl Track for Probe {
    fn columns(&self) -> Vec<Column> {
        let of = |field: &Field| {
            let unit = Component::unit(*field);
            field.components().map(move |name| (name, unit)).collect::<Vec<_>>()
        };
        let place = ["x", "y"].map(|name| (name.to_owned(), "m"));
        place.into_iter().chain(self.fields.iter().flat_map(of)).collect()
    }

    fn push(&mut self, seen: &Seen, row: &mut Vec<f64>) {
        let Some(place) = self.at.all.first() else { return };
        let spot = self.spot.get_or_insert_with(|| Spot::new(seen.scheme, place.cell, place.xi));
        let (x, u) = (Places::position(seen.mesh, place), spot.of(seen.scheme, seen.state).displacement);
        row.extend([x[0] + u[0], x[1] + u[1]]);
        spot.push(&self.fields, seen.scheme, seen.state, row);
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        self.spot = None;
        Ok(self.at.move_to(mesh)?)
    }
}
