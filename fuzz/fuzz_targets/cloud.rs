//! Points of foreign files: VTU and rows; tables of loads.
#![no_main]

use dgmpm::parts::io::{LoadTable, points, vtu};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    if let Ok((points, fields)) = vtu::points(bytes) {
        assert!(fields.iter().all(|field| field.values.len() == points.len() * field.kind.components()));
    }
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok((points, fields)) = points::of_rows(text, Path::new("points.csv")) {
        assert!(fields.iter().all(|field| field.values.len() == points.len() * field.kind.components()));
    }
    if let Ok(table) = LoadTable::parse(text, Path::new("load.csv"), 1, "Pa") {
        table.at(0.5, 0);
    }
});
