//! The groups that a scene names against those of the mesh.

use super::{Condition, Scene};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::mesh::parts::EdgeCount;
use crate::scene::suggest;

impl Scene {
    /// Checks the groups of a mesh: as [`Scene::check_groups`], where groups with edges inside of the body, or with none at
    /// all, need no condition and can have none.
    ///
    /// # Errors
    /// A group of the scene or of the mesh that has no match; a condition on a group with inner edges, with counts.
    pub fn check_mesh(&self, mesh: &Mesh) -> Result<()> {
        let counts = mesh.edge_counts();
        let is_inside = |name: &&String| {
            let group = mesh.edge_groups.iter().position(|group| group == *name);
            group.is_some_and(|group| counts[group].inner > 0 || counts[group].boundary == 0)
        };
        let inside: Vec<&str> = mesh.edge_groups.iter().filter(is_inside).map(String::as_str).collect();
        self.check_all(&mesh.groups, &mesh.edge_groups, &inside)?;
        self.check_conditions(mesh, &counts)
    }

    /// Checks that every group of the scene exists in the mesh, and that the mesh has no group of cells without
    /// a material and no group of boundary edges without a condition.
    ///
    /// # Errors
    /// A group without its match, with the names that exist.
    pub fn check_groups(&self, cell_groups: &[String], edge_groups: &[String]) -> Result<()> {
        self.check_all(cell_groups, edge_groups, &[])
    }

    /// A condition acts on boundary edges. On a group of others it would do nothing, and nobody would be told.
    fn check_conditions(&self, mesh: &Mesh, counts: &[EdgeCount]) -> Result<()> {
        let named = |(i, boundary): (usize, &super::Boundary)| {
            let own = (format!("boundary.{i}.group"), boundary.group.clone());
            let partner = match &boundary.condition {
                Condition::Periodic { partner } => Some((format!("boundary.{i}.partner"), partner.clone())),
                _ => None,
            };
            [Some(own), partner]
        };
        for (key, name) in self.boundaries.iter().enumerate().flat_map(named).flatten() {
            // `check_all` has refused groups that the mesh lacks.
            let Some(group) = mesh.edge_groups.iter().position(|group| *group == name) else { continue };
            let EdgeCount { inner, boundary } = counts[group];
            if inner > 0 {
                let what = format!(
                    "the group \"{name}\" has {inner} edge(s) inside of the body and {boundary} boundary edge(s): \
                     conditions do not act on edges inside"
                );
                let remedy = "put the boundary edges alone into a group; a group of edges inside needs no [[boundary]], and \
                              where a gap is meant the two sides need nodes of their own (in Gmsh `Plugin(Crack)`)";
                return Err(self.error(&key, what, remedy));
            }
            if boundary == 0 {
                let what = format!("the group \"{name}\" of the mesh has no edge");
                return Err(self.error(&key, what, "remove the condition, or give a mesh whose group has edges"));
            }
        }
        Ok(())
    }

    /// As [`Scene::check_groups`]; the groups `inside` need no condition.
    fn check_all(&self, cell_groups: &[String], edge_groups: &[String], inside: &[&str]) -> Result<()> {
        let materials: Vec<Option<&str>> = self.materials.iter().map(|material| material.group.as_deref()).collect();
        let sources = self.sources.iter().map(|source| source.group.as_deref());
        let mut boundaries: Vec<Option<&str>> =
            self.boundaries.iter().map(|boundary| Some(boundary.group.as_str())).collect();
        self.check_exist("material", "cells", materials.iter().copied(), cell_groups)?;
        self.check_exist("source", "cells", sources, cell_groups)?;
        self.check_exist("boundary", "boundary edges", boundaries.iter().copied(), edge_groups)?;
        for (i, boundary) in self.boundaries.iter().enumerate() {
            let Condition::Periodic { partner } = &boundary.condition else { continue };
            self.check_exists(&format!("boundary.{i}.partner"), "boundary edges", partner, edge_groups)?;
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
            _ => format!("{}its groups of {of} are {}", suggest::did_you_mean(group, &known), known.join(", ")),
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
