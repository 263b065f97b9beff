//! The Gmsh reader: no bytes make it panic; a mesh that it gives is one, and comes back from the text that is written of it.
#![no_main]

use dgmpm::parts::io::gmsh;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(mesh) = gmsh::parse(bytes) else { return };
    assert_eq!(mesh.check(), Ok(()));
    let _ = dgmpm::links(&mesh);
    let again = gmsh::parse(gmsh::to_text(&mesh).as_bytes());
    // Names of groups may hold what Gmsh cannot write, such as an end of line.
    if let Ok(again) = again {
        assert_eq!(again.cells.len(), mesh.cells.len());
    }
});
