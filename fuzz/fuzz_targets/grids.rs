//! Meshes of other programs, VTU and XDMF: no bytes make the readers panic; a mesh that they give is one.
#![no_main]

use dgmpm::parts::io::parse;
use dgmpm::parts::io::unstructured::Tags;
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    // The path has no folder that is there: no HDF5 file beside it can be read.
    let path = Path::new("/nowhere/mesh.xdmf");
    for tags in [Tags::default(), Tags { data: Some("group".to_owned()), ..Tags::default() }] {
        let Ok(mesh) = parse(bytes, path, &tags) else { continue };
        assert_eq!(mesh.check(), Ok(()));
        let _ = dgmpm::links(&mesh);
    }
});
