//! Readers of foreign files under random changes of good ones: a result or an error, and never a panic. `fuzz/` has targets that
//! look for longer.

use dgmpm::parts::expression::Expression;
use dgmpm::parts::io::unstructured::Tags;
use dgmpm::parts::io::{LoadTable, gmsh, parse, points, vtu};
use proptest::prelude::*;
use std::path::Path;

fn good(name: &str) -> Vec<u8> {
    std::fs::read(super::corpus().join(name)).unwrap()
}

/// A good file in which some places have other bytes, and a part is left out.
fn changed(file: &[u8], places: &[(prop::sample::Index, u8)], cut: &[prop::sample::Index; 2]) -> Vec<u8> {
    let mut bytes = file.to_vec();
    places.iter().for_each(|(at, byte)| bytes[at.index(file.len())] = *byte);
    let [from, to] = cut.map(|cut| cut.index(file.len()));
    if from < to && to - from < 40 {
        bytes.drain(from..to);
    }
    bytes
}

proptest! {
    // Each case reads six files of a kilobyte: .2 s in all.
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_change_of_a_file_makes_a_reader_panic(
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in any::<[prop::sample::Index; 2]>(),
    ) {
        if let Ok((points, fields)) = vtu::points(&changed(&good("good.vtu"), &places, &cut)) {
            prop_assert!(fields.iter().all(|f| f.values.len() == points.len() * f.kind.components()));
        }
        let _ = gmsh::parse(&changed(&good("two_bodies_mesh.msh"), &places, &cut)).map(|mesh| mesh.check());
        for name in ["good_mesh.vtu", "good_mesh.xdmf"] {
            let mesh = parse(&changed(&good(name), &places, &cut), Path::new(name), &Tags::default());
            prop_assert!(mesh.is_err() || mesh.is_ok_and(|mesh| mesh.check().is_ok()));
        }
        let rows = changed(b"x,y,velocity_1,velocity_2,a\n0.5,0.25,1,2,3\n0.1,0.2,1e3,-2,3\n", &places, &cut);
        let text = String::from_utf8_lossy(&rows);
        let _ = points::of_rows(&text, Path::new("points.csv"));
        let _ = LoadTable::parse(&text, Path::new("load.csv"), 2, "Pa").map(|table| table.at(0.5, 1));
    }

    #[test]
    fn no_text_makes_an_expression_panic(text in "[-0-9.exyt()+*/^<>=, a-z]{0,60}") {
        if let Ok(expression) = Expression::compile(&text) {
            expression.eval([0.5, f64::NAN], 1e300);
        }
    }
}
