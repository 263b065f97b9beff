//! What differs between the scene of a checkpoint and the one that a run is resumed with, and the hash of what may not.

use crate::io::hash::Digest;
use crate::scene::Scene;
use serde_json::Value;

/// Keys that may change when a run is resumed, as they do not change what was computed so far.
const FREE: [&str; 4] = ["title", "end", "watch", "checkpoint"];

/// The first key that differs and may not, with both values; none where there is none.
pub(super) fn difference(old: &Scene, new: &Scene) -> Option<String> {
    first("", &fixed(old), &fixed(new))
}

/// All that a scene says and may not change.
fn fixed(scene: &Scene) -> Value {
    match serde_json::to_value(scene) {
        Ok(Value::Object(mut all)) => {
            FREE.iter().for_each(|key| drop(all.remove(*key)));
            Value::Object(all)
        }
        other => other.unwrap_or(Value::Null),
    }
}

/// The scene as the folder of a run has it, with mesh and points in files: what it says is the same wherever these came from.
pub(super) fn in_folder(scene: &Scene) -> Option<Scene> {
    Scene::parse(&scene.portable_toml(true, true), scene.path(), &[]).ok()
}

/// The hash of what a scene says, but for mesh and points, which have hashes of their own, and for keys that may change when a run is
/// resumed. Empty for a scene that has no text to be parsed again.
pub(super) fn hash(scene: &Scene) -> String {
    in_folder(scene).map_or_else(String::new, |scene| Digest::new().text(&fixed(&scene).to_string()).finish())
}

fn first(key: &str, old: &Value, new: &Value) -> Option<String> {
    let below = |name: &str| if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") };
    match (old, new) {
        (Value::Object(old), Value::Object(new)) => {
            let names = old.keys().chain(new.keys().filter(|name| !old.contains_key(*name)));
            names.into_iter().find_map(|name| {
                let [old, new] = [old, new].map(|all| all.get(name).unwrap_or(&Value::Null));
                first(&below(name), old, new)
            })
        }
        (Value::Array(old), Value::Array(new)) => (0..old.len().max(new.len())).find_map(|k| {
            let [old, new] = [old, new].map(|all| all.get(k).unwrap_or(&Value::Null));
            first(&below(&k.to_string()), old, new)
        }),
        _ => (old != new).then(|| format!("`{key}` was {}, and is {}", words(old), words(new))),
    }
}

fn words(value: &Value) -> String {
    match value {
        Value::Null => "absent".to_owned(),
        other => other.to_string().chars().take(80).collect(),
    }
}
