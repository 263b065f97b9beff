//! Scenes: a text is a scene or an error with a place. An override is one too.
#![no_main]

use dgmpm::Scene;
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|text: &str| {
    // The part behind a zero byte is an override.
    let (text, set) = text.split_once('\0').map_or((text, None), |(text, set)| (text, Some(set.to_owned())));
    let sets: Vec<String> = set.into_iter().collect();
    match Scene::parse(text, Path::new("case.toml"), &sets) {
        Ok(scene) => drop(scene.portable_toml(true, true)),
        Err(why) => assert_eq!(why.exit_code(), 2, "{why}"),
    }
});
