//! The groups that a scene names against those that exist.

use super::Scene;
use crate::error::Result;
use crate::names;

impl Scene {
    /// Checks that every group of the scene exists in the mesh, and that the mesh has no group of cells without
    /// a material and no group of boundary edges without a condition.
    ///
    /// # Errors
    /// A group without its match, with the names that exist.
    pub fn check_groups(&self, cell_groups: &[String], edge_groups: &[String]) -> Result<()> {
        self.check_all(cell_groups, edge_groups, &[])
    }

    /// As [`Scene::check_groups`]; the groups `inside` need no condition.
    pub(crate) fn check_all(&self, cell_groups: &[String], edge_groups: &[String], inside: &[&str]) -> Result<()> {
        let materials: Vec<Option<&str>> = self.materials.iter().map(|material| material.group.as_deref()).collect();
        let sources = self.sources.iter().map(|source| source.group.as_deref());
        let mut boundaries: Vec<Option<&str>> =
            self.boundaries.iter().map(|boundary| Some(boundary.group.as_str())).collect();
        self.check_exist("material", "cells", materials.iter().copied(), cell_groups)?;
        self.check_exist("source", "cells", sources, cell_groups)?;
        self.check_exist("boundary", "boundary edges", boundaries.iter().copied(), edge_groups)?;
        for (i, boundary) in self.boundaries.iter().enumerate() {
            let Some((key, partner)) = boundary.partner() else { continue };
            self.check_exists(&format!("boundary.{i}.{key}"), "boundary edges", partner, edge_groups)?;
            boundaries.push(Some(partner));
        }
        self.check_sources(cell_groups)?;
        if !materials.contains(&None) {
            let remedy = "every cell needs a material: add one, or leave out `group` of the only one";
            self.check_covered("material", &materials, cell_groups, remedy)?;
        }
        boundaries.extend(inside.iter().copied().map(Some));
        self.check_covered("boundary", &boundaries, edge_groups, "for a boundary without load say kind = \"free\"")
    }

    /// A source on a group acts on the cells of a material.
    fn check_sources(&self, cell_groups: &[String]) -> Result<()> {
        let material_of = |group: &Option<String>| self.materials.iter().any(|m| m.group == *group);
        let lost = |group: &Option<String>| group.is_some() && cell_groups.len() > 1 && !material_of(group);
        match self.sources.iter().enumerate().find(|(_, source)| lost(&source.group)) {
            Some((i, source)) => Err(self.error(
                &format!("source.{i}.group"),
                format!("the group \"{}\" has no [[material]] of its own", source.group.as_deref().unwrap_or_default()),
                "a source acts on the cells of a material: give the group one, or leave out `group`",
            )),
            None => Ok(()),
        }
    }

    fn check_exist<'a>(
        &self,
        table: &str,
        of: &str,
        named: impl Iterator<Item = Option<&'a str>>,
        existing: &[String],
    ) -> Result<()> {
        for (i, group) in named.enumerate() {
            group.map_or(Ok(()), |group| self.check_exists(&format!("{table}.{i}.group"), of, group, existing))?;
        }
        Ok(())
    }

    fn check_exists(&self, key: &str, of: &str, group: &str, existing: &[String]) -> Result<()> {
        let known: Vec<&str> = existing.iter().map(String::as_str).collect();
        let remedy = match known[..] {
            _ if known.contains(&group) => return Ok(()),
            [] => format!("the mesh has no named group of {of}: name one there (a physical group of Gmsh)"),
            _ => format!("{}its groups of {of} are {}", names::did_you_mean(group, &known), known.join(", ")),
        };
        Err(self.error(key, format!("the mesh has no group \"{group}\""), remedy))
    }

    fn check_covered(&self, table: &str, named: &[Option<&str>], existing: &[String], remedy: &str) -> Result<()> {
        let bare: Vec<&str> =
            existing.iter().map(String::as_str).filter(|group| !named.contains(&Some(group))).collect();
        match bare[..] {
            [] => Ok(()),
            [one] => Err(self.error(table, format!("the group {one} of the mesh has no [[{table}]]"), remedy)),
            _ => Err(self.error(
                table,
                format!("the groups {} of the mesh have no [[{table}]]", bare.join(", ")),
                remedy,
            )),
        }
    }
}
