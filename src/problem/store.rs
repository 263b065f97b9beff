//! Operators from stored matrices where these belong to the same input, else built and stored.

use super::body::Body;
use crate::error::{Error, Result};
use crate::io::operators_file::{self, Parts};
use crate::io::own;
use crate::operators::{Blocks, Line, Operators, Stored};
use crate::scene::Scene;
use std::collections::VecDeque;
use std::path::Path;

/// Where stored matrices may be found, and where new ones go.
#[derive(Debug, Clone, Copy)]
pub struct Store<'a> {
    /// Files to look into, in this order.
    pub look: &'a [&'a Path],
    /// The file that new ones are written to; none: they are not stored.
    pub write: Option<&'a Path>,
}

impl Store<'_> {
    /// The operators, and in words where their matrices come from.
    ///
    /// # Errors
    /// A cell whose points cannot carry the degree; a file that cannot be written.
    pub fn operators(&self, scene: &Scene, body: &Body) -> Result<(Operators, String)> {
        let places = body.places(scene);
        let needs = scene.needs(&places);
        let links = scene.links(&body.mesh)?;
        let (line, parts) = (Line::new(needs.degree), Parts { material: &body.material, links: &links });
        let key = operators_file::key(&body.mesh, &scene.periodic_groups(&body.mesh), &body.material, &needs);
        let mut notes = Vec::new();
        for path in self.look.iter().filter(|path| path.exists()) {
            // A damaged file is built again: it only holds what follows from the input.
            match operators_file::read(path, &key, parts, &needs) {
                Ok(Some((blocks, stored))) => {
                    let from = format!("matrices reused from {}", path.display());
                    return Ok((Operators::assemble(&body.mesh, line, blocks, &needs, stored).with_key(key), from));
                }
                Ok(None) => notes.push(format!("{} belongs to other mesh, cloud, degree or method", path.display())),
                Err(_) => notes.push(format!("{} is damaged", path.display())),
            }
        }
        if self.write.is_some_and(own::is_foreign) {
            let what = format!("{}, and dgmpm has not made it in this folder", notes.join("; "));
            return Err(Error::input(what, "give another folder by --out, or move the file"));
        }
        let blocks = Blocks::new(&body.material, &links);
        let stored = Stored::build(&body.mesh, &blocks, &line, &needs)?;
        if let Some(path) = self.write {
            operators_file::write(path, &key, &blocks, &stored, &body.certificates)?;
            notes.push(format!("matrices written to {}", path.display()));
        }
        Ok((Operators::assemble(&body.mesh, line, blocks, &needs, stored).with_key(key), notes.join("; ")))
    }
}

/// Grids whose matrices are kept in memory, so that grids that alternate are built once.
const KEPT: usize = 4;

/// Matrices of the last grids of a run, by the key of their input, the latest last.
#[derive(Default)]
pub struct Recent(VecDeque<(String, Stored)>);

impl Recent {
    /// The operators of a body, their matrices from memory where they have been built before.
    ///
    /// # Errors
    /// A cell whose points cannot carry the degree; a boundary that is not wholly tagged.
    pub fn operators(&mut self, scene: &Scene, body: &Body) -> Result<Operators> {
        let links = scene.links(&body.mesh)?;
        let places = body.places(scene);
        let needs = scene.needs(&places);
        let (line, blocks) = (Line::new(needs.degree), Blocks::new(&body.material, &links));
        let key = operators_file::key(&body.mesh, &scene.periodic_groups(&body.mesh), &body.material, &needs);
        let known = self.0.iter().position(|(known, _)| *known == key).and_then(|k| self.0.remove(k));
        let stored = match known {
            Some((_, stored)) => stored,
            None => Stored::build(&body.mesh, &blocks, &line, &needs)?,
        };
        self.0.push_back((key.clone(), stored.clone()));
        if self.0.len() > KEPT {
            self.0.pop_front();
        }
        Ok(Operators::assemble(&body.mesh, line, blocks, &needs, stored).with_key(key))
    }
}
