//! The tables of loads of a scene: read from their files, and stored beside the scene of a run folder.

use crate::error::Result;
use crate::io::{LoadTable, seal};
use crate::registry::grids::copy_text;
use crate::registry::{Chosen, Form, Value, Values};
use crate::run::Folder;
use crate::scene::Scene;
use std::path::Path;

impl Scene {
    /// The values of the condition of a number, the tables of loads that it names read.
    ///
    /// # Errors
    /// A file that is not there or is no such table, with its line; a table that ends before the run.
    pub(super) fn values_of_boundary(&self, number: usize) -> Result<Values> {
        let chosen: &Chosen<_> = &self.boundaries[number].condition;
        let mut values = chosen.values.clone();
        for (parameter, file) in chosen.files() {
            let Form::LoadTable(columns) = parameter.form else { continue };
            let key = format!("boundary.{number}.{}", parameter.name);
            let table = LoadTable::read(&self.existing(&key, Path::new(file))?, columns, parameter.unit)?;
            if table.end() < self.end {
                let what = format!("the table ends at t = {} s, before the run does at {} s", table.end(), self.end);
                return Err(self.error(&key, what, "add a row at the end of the run, with 0 where the load is over"));
            }
            values.set(parameter.name, Value::Loads(table));
        }
        Ok(values)
    }

    /// Reads all tables of loads, so that a bad one is said before anything is built.
    ///
    /// # Errors
    /// As [`Scene::values_of_boundary`].
    pub(super) fn check_loads(&self) -> Result<()> {
        (0..self.boundaries.len()).try_for_each(|number| self.values_of_boundary(number).map(drop))
    }

    /// Copies the tables of loads to where the text of the run looks for them.
    ///
    /// # Errors
    /// Files that cannot be read or written.
    pub(super) fn store_loads(&self, folder: &Folder) -> Result<()> {
        for (number, boundary) in self.boundaries.iter().enumerate() {
            for (parameter, file) in boundary.condition.files() {
                let name = Self::stored_loads(number, parameter.name);
                copy_text(&self.resolve(Path::new(file)), &folder.root.join(name), seal::TOML)?;
            }
        }
        Ok(())
    }
}
