//! What a state was made on: mesh, points and laws of a scheme in a few texts, so that a state of another body is refused.

use super::hash::Digest;
use crate::cloud::Cloud;
use crate::mesh::Mesh;
use crate::mesh::map::CellMap;
use crate::step::{Law, Scheme};

/// The attributes of a fingerprint.
const KEYS: [&str; 4] = ["mesh_hash", "points_hash", "densities", "laws_hash"];
/// Points that are the Gauss nodes of their cells, as of RK-DGFEM.
const NODES: &str = "nodes";
/// Strains at which a law is asked: small, and such that laws with a yield stress flow.
const STRAINS: [f64; 3] = [1e-4, 0.03, 0.3];

/// Mesh, points and laws of a scheme; texts are empty where nothing is known, as of files of earlier versions.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Fingerprint {
    /// Hash of the corners of all cells in the order of the mesh, and of the number of their material.
    pub mesh: String,
    /// Hash of the places where the laws are evaluated, or `nodes`.
    pub points: String,
    /// rho0 of each law in kg/m^3, in words.
    pub densities: String,
    /// Hash of what the laws say.
    pub laws: String,
}

impl Fingerprint {
    /// That of a scheme.
    pub fn of(scheme: &Scheme) -> Self {
        let (blocks, geometry) = (&scheme.operators.blocks, &scheme.operators.geometry);
        let cells = blocks.slot.iter();
        let cells = cells.map(|&(block, lane)| (blocks.material[block], geometry.map_of(block, lane)));
        Self::of_parts(cells, &scheme.laws, points(&scheme.operators.line.nodes(), &scheme.places()))
    }

    /// That of a scheme which would be made of a mesh with the law of each cell, of laws, and of the places where these are evaluated;
    /// `nodes` are the Gauss nodes of a cell.
    pub fn of_body(mesh: &Mesh, material: &[usize], laws: &[Law], nodes: &[[f64; 2]], places: &Cloud) -> Self {
        let cells = material.iter().enumerate().map(|(cell, &law)| (law, mesh.map(cell)));
        Self::of_parts(cells, laws, points(nodes, places))
    }

    fn of_parts(cells: impl Iterator<Item = (usize, CellMap)>, laws: &[Law], points: String) -> Self {
        let mut mesh = Digest::new();
        for (law, CellMap { corners, bulge }) in cells {
            mesh.count(law).reals(corners.as_flattened().iter().copied());
            if let Some(bulge) = bulge {
                mesh.reals(bulge.as_flattened().iter().copied());
            }
        }
        let mut all = Digest::new();
        laws.iter().for_each(|law| of_law(law, &mut all));
        let densities: Vec<String> = laws.iter().map(|law| law.density().to_string()).collect();
        Self { mesh: mesh.finish(), points, densities: densities.join(", "), laws: all.finish() }
    }

    /// What is known, under its names.
    pub fn attributes(&self) -> Vec<(&'static str, String)> {
        let texts = [&self.mesh, &self.points, &self.densities, &self.laws].map(Clone::clone);
        KEYS.into_iter().zip(texts).filter(|(_, text)| !text.is_empty()).collect()
    }

    /// By the attributes of a file, empty where it has none of a name.
    pub fn by(attribute: impl Fn(&str) -> String) -> Self {
        let [mesh, points, densities, laws] = KEYS.map(attribute);
        Self { mesh, points, densities, laws }
    }

    /// What of a state with this fingerprint differs from what `run` has, and what would be right; none where it fits.
    pub fn misfit(&self, run: &Self) -> Option<(String, &'static str)> {
        let differs = |own: &String, other: &String| !own.is_empty() && own != other;
        if differs(&self.mesh, &run.mesh) {
            return Some((
                "another mesh".to_owned(),
                "give the mesh of that run, or bring the state over by `dgmpm regrid`",
            ));
        }
        if differs(&self.densities, &run.densities) {
            let what = format!("other densities: {} instead of {} kg/m^3", self.densities, run.densities);
            return Some((what, "give the materials of that run"));
        }
        if differs(&self.laws, &run.laws) {
            return Some(("other laws, or other parameters of them".to_owned(), "give the materials of that run"));
        }
        // Values at the nodes can be gone on with by a method without points, or with points on the nodes.
        let on_nodes = [&self.points, &run.points].into_iter().any(|points| points == NODES);
        if differs(&self.points, &run.points) && !on_nodes {
            let remedy = "give the cloud of that run ([cloud] of its scene, or its cloud.h5)";
            return Some(("other material points".to_owned(), remedy));
        }
        None
    }
}

fn points(nodes: &[[f64; 2]], places: &Cloud) -> String {
    match (0..places.first.len() - 1).all(|cell| *places.of(cell) == *nodes) {
        true => NODES.to_owned(),
        false => super::hash::of_cloud(places),
    }
}

/// What a law says of virgin material at some deformations: the same numbers for the same parameters.
fn of_law(law: &Law, digest: &mut Digest) {
    digest.count(law.history_len()).reals([law.shear_modulus()].into_iter());
    for e in STRAINS {
        let response = law.response_after([1.0 - e, 0.4 * e, 0.2 * e, 1.0 + 0.1 * e], &law.virgin(), 1e-6);
        let all = response.piola.into_iter().chain([response.piola33, response.energy, response.dissipated]);
        let all: Vec<f64> = all.map(|x| if x.is_nan() { f64::NAN } else { x }).collect();
        digest.reals(all.into_iter());
    }
}
