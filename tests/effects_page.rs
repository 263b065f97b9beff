//! `docs/effects.md` is what the registry and the stored costs say. `DGMPM_UPDATE=1` writes it anew.

use std::path::Path;

#[test]
fn the_page_of_effects_is_generated_from_the_registry_and_the_stored_costs() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/effects.md");
    let page = dgmpm::parts::effects::page();
    if std::env::var_os("DGMPM_UPDATE").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    let same = page.lines().zip(written.lines()).take_while(|(new, old)| new == old).count();
    let what = "differs from the registry: run DGMPM_UPDATE=1 cargo test --release --test effects_page";
    assert!(page == written, "docs/effects.md, line {}, {what}", same + 1);
}
