//! The groups that a scene names against those of a mesh, and the edges that they have there.

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::parts::EdgeCount;
use crate::scene::{Boundary, Scene};

impl Scene {
    /// The mesh cut along the edges inside of the body that bear a condition, its groups checked.
    ///
    /// # Errors
    /// As [`Scene::check_mesh`]; a cut that cannot open; a cell that is inverted, collapsed or not finite, whoever made the mesh.
    pub fn cut_mesh(&self, mesh: Mesh) -> Result<Mesh> {
        mesh.check().map_err(|why| Error::from(why).or_at(self.place("mesh")))?;
        let of_scene = |name: &String| {
            let own = self.boundaries.iter().filter(|boundary| !boundary.is_joined());
            own.flat_map(Boundary::groups).any(|group| group == name)
        };
        let groups: Vec<usize> = (0..mesh.edge_groups.len()).filter(|&k| of_scene(&mesh.edge_groups[k])).collect();
        let mesh = mesh.split(&groups)?;
        self.check_mesh(&mesh)?;
        Ok(mesh)
    }

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

    /// A condition acts on boundary edges, and the mesh is cut where they are inside ([`Scene::cut_mesh`]). Groups whose faces are
    /// joined are at the edge of the body: inside they would do nothing, and nobody would be told.
    fn check_conditions(&self, mesh: &Mesh, counts: &[EdgeCount]) -> Result<()> {
        let named = |(i, boundary): (usize, &Boundary)| {
            let own = (format!("boundary.{i}.group"), boundary.group.clone());
            let partner = boundary.partner().map(|(key, group)| (format!("boundary.{i}.{key}"), group.to_owned()));
            [Some(own), partner]
        };
        let joined: Vec<&str> = self.boundaries.iter().filter(|b| b.is_joined()).flat_map(Boundary::groups).collect();
        for (key, name) in self.boundaries.iter().enumerate().flat_map(named).flatten() {
            // `check_all` has refused groups that the mesh lacks.
            let Some(group) = mesh.edge_groups.iter().position(|group| *group == name) else { continue };
            let EdgeCount { inner, boundary } = counts[group];
            if inner > 0 && joined.contains(&name.as_str()) {
                let what = format!(
                    "the group \"{name}\" has {inner} edge(s) inside of the body and {boundary} boundary edge(s): \
                     a body does not go on periodically from edges inside"
                );
                let remedy = "put the boundary edges alone into a group; a group of edges inside needs no [[boundary]]";
                return Err(self.error(&key, what, remedy));
            }
            if boundary + inner == 0 {
                let what = format!("the group \"{name}\" of the mesh has no edge");
                return Err(self.error(&key, what, "remove the condition, or give a mesh whose group has edges"));
            }
        }
        Ok(())
    }
}
