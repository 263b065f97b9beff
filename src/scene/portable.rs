//! The text of a scene for its run folder, so that the folder can be moved and run again.

use super::points::keys;
use super::{Mesh, Scene};
use crate::registry::Value;
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, value};

impl Scene {
    /// The text as run, in which the mesh is the file `mesh.h5` beside it if it came from a file, and so the cloud
    /// `cloud.h5`. `mesh` and `cloud` say that other files than those of the scene were given.
    pub fn portable_toml(&self, mesh: bool, cloud: bool) -> String {
        // The text has been parsed before.
        let Ok(mut document) = self.to_toml().parse::<DocumentMut>() else { return self.to_toml() };
        if mesh || matches!(self.mesh, Mesh::File(_)) {
            in_table(&mut document, "mesh", |table| {
                table.remove("rectangle");
                super::mesh::KEYS.iter().for_each(|key| drop(table.remove(key)));
                put(table, "file", "mesh.h5");
            });
        }
        if cloud || self.cloud.layout.build().is_file() {
            in_table(&mut document, "cloud", |table| {
                keys().filter(|key| *key != "layout").for_each(|key| drop(table.remove(key)));
                put(table, "layout", "file");
                put(table, "path", "cloud.h5");
            });
            remove_points_of_materials(&mut document);
        }
        if self.initial.snapshot.is_some() {
            in_table(&mut document, "initial", |table| put(table, "snapshot", "initial.h5"));
        }
        if self.initial.fields.is_some() {
            in_table(&mut document, "initial", |table| {
                super::fields::NAMES.iter().for_each(|key| drop(table.remove(key)));
                put(table, "fields", "initial.vtu");
            });
        }
        for (number, boundary) in self.boundaries.iter().enumerate() {
            let entry = document.get_mut("boundary").and_then(|list| list.get_mut(number));
            let Some(table) = entry.and_then(Item::as_table_like_mut) else { continue };
            boundary.condition.files().for_each(|(key, _)| put(table, key.name, &Self::stored_loads(number, key.name)));
        }
        for (rule, regrid) in self.regrids.iter().enumerate() {
            let entry = document.get_mut("regrid").and_then(|list| list.get_mut(rule));
            let Some(table) = entry.and_then(Item::as_table_like_mut) else { continue };
            let (key, Some(stored)) = (regrid.grid.name(), regrid.grid.build().files) else { continue };
            let names = (0..regrid.grid.values.texts(key).len()).map(|k| (stored.name)(rule, k));
            match regrid.grid.values.get(key) {
                Some(Value::Texts(_)) => drop(table.insert(key, value(names.collect::<Array>()))),
                _ => names.for_each(|name| put(table, key, &name)),
            }
        }
        document.to_string()
    }

    /// The same with the title of the scene where the file has none: the default is the name of the file, which is another one in the folder
    /// of a run, so that a run that goes on from there would change its title.
    pub fn folder_toml(&self, mesh: bool, cloud: bool) -> String {
        let text = self.portable_toml(mesh, cloud);
        match text.parse::<DocumentMut>() {
            Ok(mut document) if !document.contains_key("title") => {
                document.insert("title", value(&self.title));
                document.to_string()
            }
            _ => text,
        }
    }

    /// The file of a run folder that has the table of loads of a condition.
    pub(crate) fn stored_loads(number: usize, key: &str) -> String {
        format!("boundary_{number}_{key}.csv")
    }

    /// The text of a run that goes on from a snapshot, on the mesh and cloud beside it.
    pub fn portable_from(&self, snapshot: &str) -> String {
        let Ok(mut document) = self.portable_toml(true, true).parse::<DocumentMut>() else { return self.to_toml() };
        in_table(&mut document, "initial", |table| {
            let others = ["velocity", "deformation", "fields"];
            others.iter().chain(&super::fields::NAMES).for_each(|key| drop(table.remove(key)));
            put(table, "snapshot", snapshot);
        });
        document.to_string()
    }
}

/// Changes the table of a name, made where it is missing.
fn in_table(document: &mut DocumentMut, name: &str, change: impl FnOnce(&mut dyn toml_edit::TableLike)) {
    let item = document.entry(name).or_insert(Item::Table(Table::new()));
    if !item.is_table_like() {
        *item = Item::Table(Table::new());
    }
    if let Some(table) = item.as_table_like_mut() {
        change(table);
    }
}

/// Gives a key a text, keeping the comments around the old value.
fn put(table: &mut dyn toml_edit::TableLike, key: &str, text: &str) {
    let mut new = value(text);
    if let (Some(new), Some(old)) = (new.as_value_mut(), table.get(key).and_then(Item::as_value)) {
        *new.decor_mut() = old.decor().clone();
    }
    table.insert(key, new);
}

/// The points of all materials come from the file.
fn remove_points_of_materials(document: &mut DocumentMut) {
    let Some(materials) = document.get_mut("material") else { return };
    if let Some(tables) = materials.as_array_of_tables_mut() {
        tables.iter_mut().for_each(|table| keys().for_each(|key| drop(table.remove(key))));
    } else if let Some(list) = materials.as_array_mut() {
        let tables = list.iter_mut().filter_map(|entry| entry.as_inline_table_mut());
        tables.for_each(|table: &mut InlineTable| keys().for_each(|key| drop(table.remove(key))));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const SCENE: &str = r#"[mesh]
rectangle = { size = [1, 1], cells = [2, 2] }
[[material]]
law = "neo-hookean"   # of the paper
layout = "jitter"
seed = 3
young = 1
poisson = 0
density = 1
[[boundary]]
group = "left"
kind = "free"
[[boundary]]
group = "right"
kind = "free"
[[boundary]]
group = "bottom"
kind = "free"
[[boundary]]
group = "top"
kind = "free"
[scheme]
method = "rk-dgfem"
degree = 1
[time]
end = 1
"#;

    fn parse(text: &str) -> Scene {
        Scene::parse(text, Path::new("a/case.toml"), &[]).unwrap()
    }

    #[test]
    fn a_scene_without_files_stays_as_it_is() {
        let scene = parse(SCENE);
        assert_eq!(scene.portable_toml(false, false), scene.to_toml());
    }

    #[test]
    fn the_text_for_a_folder_has_the_title_that_the_scene_takes_from_its_file() {
        let scene = parse(SCENE);
        let text = scene.folder_toml(false, false);
        let there = Scene::parse(&text, Path::new("run/scene.toml"), &[]).unwrap();
        assert_eq!((&there.title[..], &scene.title[..]), ("case", "case"));
        assert_eq!(there.folder_toml(false, false), text);
        // Comments and all else stay.
        assert_eq!(text.replacen("title = \"case\"\n", "", 1), scene.to_toml());
    }

    #[test]
    fn files_take_the_place_of_what_they_replace() {
        let text = parse(SCENE).portable_toml(true, true);
        let scene = parse(&text);
        assert_eq!(scene.mesh_path(), Some("a/mesh.h5".into()));
        assert_eq!(scene.cloud_path(), Some("a/cloud.h5".into()));
        assert!(text.contains("# of the paper") && !text.contains("jitter"), "{text}");
    }

    #[test]
    fn a_scene_with_files_finds_them_beside_it() {
        let file = SCENE.replace("rectangle = { size = [1, 1], cells = [2, 2] }", "file = \"../far/a.msh\" # the mesh");
        let file = file.replace("layout = \"jitter\"\nseed = 3\n", "");
        let text =
            parse(&format!("{file}[cloud]\nlayout = \"file\"\npath = \"/far/b.csv\"\n")).portable_toml(false, false);
        let scene = parse(&text);
        assert_eq!(scene.mesh_path(), Some("a/mesh.h5".into()));
        assert_eq!(scene.cloud_path(), Some("a/cloud.h5".into()));
        assert!(text.contains("file = \"mesh.h5\" # the mesh"), "{text}");
    }
}
