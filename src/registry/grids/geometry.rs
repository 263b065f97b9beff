//! A geometry that Gmsh meshes.

use super::{Present, Rule, Values};
use crate::error::Result;
use crate::io::gmsh;
use crate::mesh::Mesh;

pub(super) fn make(of: &Values, rule: &dyn Rule, _: usize, present: &Present) -> Result<Mesh> {
    let time = present.view.state.time;
    let size = of.expression("size").map(|size| move |x: [f64; 2]| size.eval(x, time));
    let size = size.as_ref().map(|size| size as &dyn Fn([f64; 2]) -> f64);
    let made = gmsh::program::mesh(&rule.resolve(of.text("geo")), size, present.view.mesh);
    made.map_err(|(what, remedy)| rule.wrong("geo", what, remedy))
}

pub(super) fn check(of: &Values, rule: &dyn Rule, _: &Mesh) -> Result<()> {
    if !gmsh::program::is_installed() {
        let remedy = "install Gmsh (https://gmsh.info, or `pip install gmsh`), or give `mesh`";
        return Err(rule.wrong("geo", "there is no `gmsh` on the path".to_owned(), remedy));
    }
    let path = of.text("geo");
    if !rule.resolve(path).is_file() {
        return Err(rule.wrong("geo", format!("there is no file {path}"), "the path is relative to the scene"));
    }
    gmsh::program::look(&rule.resolve(path)).map_err(|(what, remedy)| rule.wrong("geo", what, remedy))
}
