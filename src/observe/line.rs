//! `lines/<name>.csv`: fields along a straight line of the initial configuration.

use super::{Field, NewGrid, Observer, Schedule, Spot, View};
use crate::cloud::locate::Locator;
use crate::error::Error;
use crate::io::csv::Table;
use crate::mesh::Mesh;
use crate::words::{Saved, Words};
use std::path::Path;

/// A line of samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// First and last point, reference coordinates in m.
    pub ends: [[f64; 2]; 2],
    /// The number of samples, at least 2: s_i = i L / (count - 1).
    pub count: usize,
    /// The fields.
    pub fields: Vec<Field>,
}

/// Writes the rows t, s, x, y, components; a point on an edge belongs to the cell of the lowest number.
pub struct Line {
    schedule: Schedule,
    table: Table,
    samples: Samples,
    at: Vec<Sample>,
    /// The samples on the present grid, once a state of it has been seen.
    spots: Vec<Spot>,
}

/// A sample of a line in the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// How far along the line it lies, m.
    pub s: f64,
    /// Its position, m.
    pub x: [f64; 2],
    /// Its cell.
    pub cell: usize,
    /// Its parent coordinates there.
    pub xi: [f64; 2],
}

impl Line {
    /// Locates the samples and starts `path` with its header.
    ///
    /// # Errors
    /// A sample lies outside the mesh, or the file cannot be created.
    pub fn create(path: &Path, mesh: &Mesh, samples: &Samples, schedule: Schedule) -> Result<Self, Error> {
        let at = samples.locate(mesh).map_err(|outside| Error::input(outside.to_string(), Outside::REMEDY))?;
        let names: Vec<String> = samples.fields.iter().flat_map(|field| field.components()).collect();
        let columns: Vec<&str> = ["t", "s", "x", "y"].into_iter().chain(names.iter().map(String::as_str)).collect();
        let table = Table::create(path, &columns)?;
        Ok(Self { schedule, table, samples: samples.clone(), at, spots: vec![] })
    }
}

/// A sample that lies outside of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("sample {} of {count} of the line, at ({}, {}), lies outside of the mesh", .sample + 1, .x[0], .x[1])]
pub struct Outside {
    /// Its number, from 0.
    pub sample: usize,
    /// The number of samples.
    pub count: usize,
    /// The position of the sample.
    pub x: [f64; 2],
}

impl Outside {
    /// How to correct it.
    pub const REMEDY: &str = "choose `from` and `to` inside of the body in its initial configuration";
}

impl Samples {
    /// Checks that the whole line lies in the mesh.
    ///
    /// # Errors
    /// The first sample outside the mesh.
    pub fn check(&self, mesh: &Mesh) -> Result<(), Outside> {
        self.locate(mesh).map(|_| ())
    }

    /// Finds the cells of all samples.
    ///
    /// # Errors
    /// The first sample outside the mesh.
    pub fn locate(&self, mesh: &Mesh) -> Result<Vec<Sample>, Outside> {
        let locator = Locator::new(mesh);
        let [from, to] = self.ends;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let sample = |i: usize| {
            let share = i as f64 / (self.count - 1) as f64;
            let x = [0, 1].map(|k| if i + 1 == self.count { to[k] } else { from[k] + share * (to[k] - from[k]) });
            let (cell, xi) = locator.find(x).ok_or(Outside { sample: i, count: self.count, x })?;
            Ok(Sample { s: share * length, x, cell, xi })
        };
        (0..self.count).map(sample).collect()
    }
}

impl Observer for Line {
    fn schedule(&mut self) -> &mut Schedule {
        &mut self.schedule
    }

    fn observe(&mut self, view: &View) -> Result<(), Error> {
        if self.spots.is_empty() {
            self.spots = self.at.iter().map(|at| Spot::new(view.scheme, at.cell, at.xi)).collect();
        }
        for (sample, spot) in self.at.iter().zip(&self.spots) {
            let mut row = vec![view.state.time, sample.s, sample.x[0], sample.x[1]];
            spot.push(&self.samples.fields, view.scheme, view.state, &mut row);
            self.table.push(&row)?;
        }
        self.table.flush()
    }

    fn save(&mut self, to: &mut Words) -> Result<(), Error> {
        self.table.save(to)
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        self.table.restore(from)
    }

    fn regrid(&mut self, grid: &NewGrid) -> Result<(), Error> {
        let at = self.samples.locate(grid.mesh);
        self.at = at.map_err(|outside| Error::input(outside.to_string(), Outside::REMEDY))?;
        self.spots.clear();
        Ok(())
    }
}
