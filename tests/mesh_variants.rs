//! MSH files that Gmsh writes on request: parametric nodes, all elements without their groups, many views behind the mesh.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use dgmpm::parts::io::gmsh;
use dgmpm::parts::mesh::{links, quality::Quality};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/gmsh").join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(data(name)).unwrap()
}

#[test]
fn parametric_nodes_of_msh_2_2_are_nodes_in_text_and_binary() {
    let [ascii, binary] =
        ["parametric_22.msh", "parametric_22_binary.msh"].map(|name| gmsh::read(&data(name)).unwrap());
    // As Gmsh counted them: a unit square of 3 x 3 cells.
    assert_eq!((ascii.nodes.len(), ascii.cells.len(), ascii.edges.len()), (16, 9, 12));
    assert_eq!(ascii.edge_groups, ["bottom", "right", "top", "left"]);
    // Nodes of Gmsh are off by 1e-12.
    assert!((Quality::of(&ascii).area - 1.0).abs() < 1e-11);
    links(&ascii).unwrap();
    assert_eq!((&binary.cells, &binary.edges), (&ascii.cells, &ascii.edges));
    for (a, b) in ascii.nodes.iter().zip(&binary.nodes) {
        // Text has 16 digits, binary all 53 bits.
        assert!((a[0] - b[0]).abs() < 1e-15 && (a[1] - b[1]).abs() < 1e-15, "{a:?} {b:?}");
    }
    // The same file with plain nodes is the same mesh to the bit.
    let mut plain = String::new();
    let mut inside = false;
    for line in text("parametric_22.msh").replace("ParametricNodes", "Nodes").lines() {
        inside = line == "$Nodes" || inside && line != "$EndNodes";
        let words: Vec<&str> = line.split(' ').collect();
        let kept = if inside { words.len().min(4) } else { words.len() };
        writeln!(plain, "{}", words[..kept].join(" ")).unwrap();
    }
    assert_eq!(gmsh::parse(plain.as_bytes()).unwrap(), ascii);
}

#[test]
fn parametric_nodes_of_msh_4_1_are_nodes() {
    let plain = text("two_surfaces_41_ascii.msh");
    let (mut parametric, mut inside, mut parameters) = (String::new(), false, 0);
    for line in plain.lines() {
        inside = line == "$Nodes" || inside && line != "$EndNodes";
        let words: Vec<&str> = line.split_whitespace().collect();
        match (inside, &words[..]) {
            // Four numbers begin a block, and are first of all those of the section.
            (true, [dimension, tag, "0", count]) => {
                parameters = dimension.parse().unwrap();
                writeln!(parametric, "{dimension} {tag} 1 {count}").unwrap();
            }
            (true, [_, _, _]) => writeln!(parametric, "{line}{}", " 0.5".repeat(parameters)).unwrap(),
            _ => writeln!(parametric, "{line}").unwrap(),
        }
    }
    // All of the 45 nodes but the corners of the geometry.
    assert!(parametric.matches(" 0.5\n").count() > 35, "{parametric}");
    assert_eq!(gmsh::parse(parametric.as_bytes()).unwrap(), gmsh::parse(plain.as_bytes()).unwrap());
}

#[test]
fn parametric_nodes_that_are_cut_or_wrong_are_refused_with_their_place() {
    let good = text("parametric_22.msh");
    for (old, new, words) in [
        ("1 0 0 0 0 1\n", "1 0 0 0 4 1\n", "a dimension from 0 to 3"),
        ("1 0 0 0 0 1\n", "1 0 0 0\n", "expected"),
        (" 1 1 0.333333333332501\n", " 1 1\n", ""),
        ("$ParametricNodes\n16\n", "$ParametricNodes\n1600\n", "nodes that the rest of the file can hold"),
    ] {
        assert!(good.contains(old), "{old}");
        let why = gmsh::parse(good.replacen(old, new, 1).as_bytes()).unwrap_err();
        assert!(matches!(why, gmsh::Error::Syntax { .. }) && why.to_string().contains(words), "{old}: {why}");
    }
    let bytes = std::fs::read(data("parametric_22_binary.msh")).unwrap();
    let nodes = bytes.windows(16).position(|w| w == b"$ParametricNodes").unwrap();
    for cut in [nodes + 21, nodes + 60, nodes + 400] {
        assert!(gmsh::parse(&bytes[..cut]).is_err(), "{cut}");
    }
}

#[test]
fn a_file_whose_elements_have_lost_their_groups_says_which_option_keeps_them() {
    // Gmsh with Mesh.SaveAll = 1 and MSH 2.2: names, and the tag 0 everywhere.
    for (name, count) in [("save_all_22.msh", 21), ("no_group_22.msh", 24)] {
        let error = gmsh::read(&data(name)).unwrap_err();
        let said = error.to_string();
        assert_eq!(error.exit_code(), 2);
        assert!(said.contains(&format!("all its {count} lines and quadrilaterals have the physical tag 0")), "{said}");
        assert!(said.contains("`Mesh.SaveAll = 0;`") && said.contains("MSH 4.1"), "{said}");
        assert!(!said.contains("Physical Surface"), "{said}");
    }
    // A curve alone is lost the same way; without any name nothing is lost.
    let curve = text("save_all_22.msh").replace("2\n1 1 \"a\"\n2 2 \"body\"\n", "1\n1 1 \"a\"\n");
    assert!(matches!(gmsh::parse(curve.as_bytes()), Err(gmsh::Error::NoTags { names, .. }) if names == ["`a`"]));
    let (head, rest) = curve.split_once("$PhysicalNames").unwrap();
    let nameless = format!("{head}{}", rest.split_once("$EndPhysicalNames\n").unwrap().1);
    assert_eq!(gmsh::parse(nameless.as_bytes()).unwrap().groups, ["body"]);
}

#[test]
fn many_sections_that_are_not_read_cost_their_length_and_no_more() {
    let mesh = text("two_surfaces_22_ascii.msh");
    let view = format!("$NodeData\n1\n\"u\"\n1\n0.0\n3\n0\n1\n100\n{}$EndNodeData\n", "7 0.125\n".repeat(100));
    let long = mesh.clone() + &view.repeat(4000);
    let clock = Instant::now();
    assert_eq!(gmsh::parse(long.as_bytes()).unwrap(), gmsh::parse(mesh.as_bytes()).unwrap());
    // 3.5 MB take some .02 s, unoptimised .3 s. A look at all lines before each section goes over 7 GB.
    assert!(clock.elapsed().as_secs_f64() < 2.0, "{:?}", clock.elapsed());
}
