//! The groups that a scene names against those of a mesh, and the edges that they have there.

use crate::error::Result;
use crate::mesh::Mesh;
use crate::mesh::parts::EdgeCount;
use crate::scene::{Boundary, Scene};

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

    /// A condition acts on boundary edges. On a group of others it would do nothing, and nobody would be told.
    fn check_conditions(&self, mesh: &Mesh, counts: &[EdgeCount]) -> Result<()> {
        let named = |(i, boundary): (usize, &Boundary)| {
            let own = (format!("boundary.{i}.group"), boundary.group.clone());
            let partner = boundary.partner().map(|(key, group)| (format!("boundary.{i}.{key}"), group.to_owned()));
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
}
