//! The exact solution of a scene, and whether the materials of a mesh stand where it has them.

use crate::error::Result;
use crate::exact::Exact;
use crate::mesh::{Mesh, map};
use crate::scene::Scene;
use std::sync::Arc;

impl Scene {
    /// The exact solution that the scene names.
    pub fn build_exact(&self) -> Option<Arc<dyn Exact>> {
        let solution = &self.exact.as_ref()?.solution;
        (solution.build().make)(&solution.values, &self.laws())
    }

    /// Whether the materials stand in the mesh where the exact solution has them: the first `[[material]]` is its first.
    ///
    /// # Errors
    /// The first cell that is of another material.
    pub fn check_exact_materials(&self, mesh: &Mesh) -> Result<()> {
        let solution = if self.materials.len() > 1 { self.build_exact() } else { None };
        let Some(solution) = solution else { return Ok(()) };
        for (cell, material) in self.material_of_cells(mesh).into_iter().enumerate() {
            let map = mesh.map(cell);
            // Just inside of the corners: on an edge both materials are right.
            let inside = [[0.01, 0.01], [0.99, 0.01], [0.99, 0.99], [0.01, 0.99]].map(|xi| map::position(&map, xi));
            if let Some([x, y]) = inside.into_iter().find(|x| solution.material(*x) != material) {
                let number = mesh.number(cell);
                let what =
                    format!("cell {number} at ({x:.6}, {y:.6}) is not of the material that the solution has there");
                let remedy =
                    "let the cells of the first [[material]] end at the interface, where those of the second begin";
                return Err(self.error("exact.kind", what, remedy));
            }
        }
        Ok(())
    }
}
