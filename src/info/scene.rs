//! A scene: what it asks for.

use super::Info;
use crate::error::Result;
use crate::scene::{Mesh, Scene};
use std::path::Path;

/// What a scene asks for.
///
/// # Errors
/// A text that is no scene, with the place of its first fault.
pub(super) fn info(path: &Path) -> Result<Info> {
    let scene = Scene::load(path, &[])?;
    let mesh = match &scene.mesh {
        Mesh::File(file) => file.display().to_string(),
        Mesh::Rectangle { size, cells } => {
            format!("rectangle of {} m x {} m, {} x {} cells", size[0], size[1], cells[0], cells[1])
        }
    };
    let on = |group: &Option<String>| group.clone().unwrap_or_else(|| "all cells".to_owned());
    let materials: Vec<String> =
        scene.materials.iter().map(|material| format!("{} on {}", material.law.name(), on(&material.group))).collect();
    let boundaries: Vec<String> = scene
        .boundaries
        .iter()
        .map(|boundary| format!("{} on {}", boundary.condition.name(), boundary.group))
        .collect();
    let sources: Vec<&str> = scene.sources.iter().map(|source| source.source.name()).collect();
    let outputs: Vec<String> = scene.outputs.iter().map(|output| output.name.clone()).collect();
    let quantities: Vec<String> = scene.quantities.iter().map(|quantity| quantity.name.clone()).collect();
    let scheme = &scene.scheme;
    Ok(Info::new("scene")
        .with("title", scene.title.clone())
        .with("mesh", mesh)
        .with("materials", materials)
        .with("boundaries", boundaries)
        .with("sources", sources)
        .with("method", serde_json::json!(scheme.method))
        .with("degree", scheme.degree)
        .with("time_degree", scheme.time_degree)
        .with("flux", scheme.flux.name())
        .with("limiter", scene.limiter.name())
        .with("start_s", scene.start)
        .with("end_s", scene.end)
        .with("outputs", outputs)
        .with("quantities", quantities))
}
