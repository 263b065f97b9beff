//! `docs/scene.md` is what the tables of scenes and the registry say. `DGMPM_UPDATE=1` writes it anew.

use std::path::Path;

#[test]
fn the_page_of_scenes_is_generated_from_the_registry() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md");
    let page = dgmpm::parts::scene::reference();
    if std::env::var_os("DGMPM_UPDATE").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    let same = page.lines().zip(written.lines()).take_while(|(new, old)| new == old).count();
    let what = "differs from the registry: run DGMPM_UPDATE=1 cargo test --release --test scene_page";
    assert!(page == written, "docs/scene.md, line {}, {what}", same + 1);
}
