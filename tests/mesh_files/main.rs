//! MSH files from Gmsh itself: each format gives the same mesh, each bad file is refused with its reason, and no
//! sequence of bytes makes the reader panic. The geometry of the good one is `tests/data/gmsh/two_surfaces.geo`.

mod curved;
mod others;

use std::path::{Path, PathBuf};

use dgmpm::parts::io::gmsh;
use dgmpm::parts::mesh::quality::Quality;
use dgmpm::parts::mesh::{Error as MeshError, Link, Mesh, links, map, rectangle};
use proptest::prelude::*;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/gmsh").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(data(name)).unwrap()
}

fn read(name: &str) -> Mesh {
    gmsh::read(&data(name)).unwrap()
}

/// The message for a file that must be refused with exit code 2, with the file's name in it.
fn refusal(name: &str) -> String {
    let error = gmsh::read(&data(name)).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    let text = error.to_string();
    assert!(text.contains(name), "{text}");
    text
}

/// The length of the edges of a boundary group.
fn length(mesh: &Mesh, name: &str) -> f64 {
    let group = mesh.edge_groups.iter().position(|g| g == name).unwrap();
    let edges = mesh.edges.iter().filter(|e| e.group == group);
    edges
        .map(|e| {
            let [a, b] = mesh.face_nodes(e.cell, e.face).map(|n| mesh.nodes[n]);
            (a[0] - b[0]).hypot(a[1] - b[1])
        })
        .sum()
}

const FORMATS: [&str; 4] = ["22_ascii", "22_binary", "41_ascii", "41_binary"];

#[test]
fn all_four_formats_give_the_same_mesh() {
    let [first, others @ ..] = FORMATS.map(|format| read(&format!("two_surfaces_{format}.msh")));
    for (mesh, format) in others.iter().zip(&FORMATS[1..]) {
        assert_eq!(mesh.cells, first.cells, "{format}");
        assert_eq!((&mesh.groups, &mesh.cell_group), (&first.groups, &first.cell_group), "{format}");
        assert_eq!((&mesh.edge_groups, &mesh.edges), (&first.edge_groups, &first.edges), "{format}");
        assert_eq!(mesh.original, first.original, "{format}");
        for (a, b) in mesh.nodes.iter().zip(&first.nodes) {
            // Text has 16 digits, binary all 53 bits.
            assert!((a[0] - b[0]).abs() < 1e-15 && (a[1] - b[1]).abs() < 1e-15, "{format}: {a:?} {b:?}");
        }
    }
    let mut binary =
        FORMATS.into_iter().filter(|f| f.ends_with("binary")).map(|f| read(&format!("two_surfaces_{f}.msh")));
    assert_eq!(binary.next(), binary.next());
}

#[test]
fn the_two_surfaces_have_the_areas_and_lengths_of_their_geometry() {
    let mesh = read("two_surfaces_41_ascii.msh");
    // Counted by Gmsh when it wrote the file.
    assert_eq!((mesh.cells.len(), mesh.nodes.len(), mesh.edges.len()), (32, 45, 28));
    assert_eq!(mesh.groups, ["steel", "soft"]);
    assert_eq!(mesh.edge_groups, ["loaded", "free", "interface"]);
    let area = |group: usize| -> f64 {
        (0..mesh.cells.len()).filter(|&c| mesh.cell_group[c] == group).map(|c| map::area(&mesh.map(c))).sum()
    };
    // Polygons: 1.1 and .9 m^2, up to the 16 digits of the file.
    assert!((area(0) - 1.1).abs() < 1e-14 && (area(1) - 0.9).abs() < 1e-14);
    assert!((length(&mesh, "loaded") - 1.0).abs() < 1e-14 && (length(&mesh, "free") - 5.0).abs() < 1e-14);
    assert!((length(&mesh, "interface") - 1.04f64.sqrt()).abs() < 1e-14);
    let links = links(&mesh).unwrap();
    let boundary = links.iter().flatten().filter(|link| matches!(link, Link::Boundary(_))).count();
    // The 4 edges of the interface are tagged and yet no boundary.
    assert_eq!(boundary, 24);
}

#[test]
fn the_meshes_that_are_shipped_are_good() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    let sides = ["left", "right", "bottom", "top"];
    // Cells as Gmsh counted them; areas of the squares and the bar up to the rounding of sums of 1000 cells (1e-15 each), of
    // the plate up to the chords of its hole.
    let hole = 4.0 - std::f64::consts::PI * 0.09;
    let shipped = [
        ("square_impact", 900, 9.0, 1e-12, 0.999_999_999, &sides[..]),
        ("bar", 120, 0.3, 1e-13, 0.999_999_999, &sides[..]),
        ("square_unstructured", 1340, 9.0, 1e-12, 0.6, &sides[..]),
        ("plate_hole", 988, hole, 2e-3, 0.5, &["left", "right", "bottom", "top", "hole"][..]),
    ];
    for (name, cells, area, rounding, quality, groups) in shipped {
        let mesh = gmsh::read(&folder.join(name).with_extension("msh")).unwrap();
        assert_eq!(mesh.cells.len(), cells, "{name}");
        assert_eq!(mesh.edge_groups, groups, "{name}");
        assert_eq!(mesh.groups, ["body"], "{name}");
        let found = Quality::of(&mesh);
        assert!((found.area - area).abs() < rounding && found.scaled_jacobian.0 > quality, "{name}: {found}");
        links(&mesh).unwrap();
    }
}

#[test]
fn the_shipped_square_is_the_rectangle_of_the_scene() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/square_impact.msh");
    let (square, own) = (gmsh::read(&path).unwrap(), rectangle([3.0, 3.0], [30, 30]).unwrap());
    let sorted = |mesh: &Mesh| {
        let middle = |c| map::position(&mesh.map(c), [0.5, 0.5]).map(|x| (x * 1e9).round() as i64);
        let mut middles: Vec<_> = (0..mesh.cells.len()).map(middle).collect();
        middles.sort_unstable();
        middles
    };
    assert_eq!(sorted(&square), sorted(&own));
    for side in &own.edge_groups {
        assert!((length(&square, side) - 3.0).abs() < 1e-13, "{side}");
    }
}

#[test]
fn written_meshes_read_back_to_the_same_bits() {
    let mut quoted = rectangle([0.3, 0.7], [5, 3]).unwrap();
    quoted.groups[0] = "a \"hard\" one".to_owned();
    quoted.nodes.iter_mut().flatten().for_each(|x| *x = (*x + 1e-7) / 3.0);
    for mesh in [quoted, read("two_surfaces_41_binary.msh"), read("clockwise.msh")] {
        let text = gmsh::to_text(&mesh);
        assert_eq!(gmsh::parse(text.as_bytes()).unwrap(), mesh);
    }
}

#[test]
fn a_mesh_that_cannot_be_written_is_an_output_error() {
    // A file is no folder.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml/a.msh");
    let error = gmsh::write(&rectangle([1.0, 1.0], [1, 1]).unwrap(), &path).unwrap_err();
    assert_eq!(error.exit_code(), 5);
}

#[test]
fn clockwise_cells_are_turned() {
    let mesh = read("clockwise.msh");
    assert!((0..4).all(|c| map::area(&mesh.map(c)) > 0.0));
    assert!((length(&mesh, "edge") - 4.0).abs() < 1e-11, "transfinite nodes of Gmsh are off by 1e-12");
    assert!(links(&mesh).is_ok());
}

#[test]
fn partitioned_meshes_are_read_as_one() {
    for name in ["partitioned_22.msh", "partitioned_41.msh"] {
        let mesh = read(name);
        assert_eq!((mesh.cells.len(), mesh.groups.as_slice()), (16, &["body".to_owned()][..]), "{name}");
        assert_eq!((mesh.edges.len(), mesh.edge_groups.as_slice()), (16, &["edge".to_owned()][..]), "{name}");
        links(&mesh).unwrap();
    }
}

#[test]
fn without_any_physical_surface_all_cells_are_body() {
    let mesh = read("no_surface_group.msh");
    assert_eq!((mesh.groups.as_slice(), mesh.cells.len()), (&["body".to_owned()][..], 4));
}

#[test]
fn names_go_to_the_last_quote() {
    let text = String::from_utf8(bytes("two_surfaces_22_ascii.msh")).unwrap();
    let text = text.replace("2 20 \"steel\"", "2 20 \"5\" plate, \"hard\" \" ");
    assert_eq!(gmsh::parse(text.as_bytes()).unwrap().groups[0], "5\" plate, \"hard\" ");
}

#[test]
fn groups_without_a_name_are_named_by_their_tag() {
    let text = String::from_utf8(bytes("two_surfaces_41_ascii.msh")).unwrap();
    let text = text.replace("2 20 \"steel\"", "2 20 \"\"");
    assert_eq!(gmsh::parse(text.as_bytes()).unwrap().groups, ["20", "soft"]);
}

#[test]
fn other_elements_are_refused_with_the_option_that_mends_them() {
    let text = refusal("triangles.msh");
    assert!(text.contains("8 element(s) are triangles, the first is element 9"), "{text}");
    assert!(text.contains("Recombine Surface") && text.contains("Mesh.RecombineAll = 1"), "{text}");
    let text = refusal("order_3.msh");
    assert!(text.contains("4 element(s) are quadrilaterals of order 3 (16 nodes)"), "{text}");
    assert!(text.contains("Mesh.ElementOrder = 1") && text.contains("= 2;"), "{text}");
    let text = refusal("solid.msh");
    assert!(text.contains("4 element(s) are hexahedra") && text.contains("gmsh -2"), "{text}");
}

#[test]
fn other_versions_and_other_files_are_refused() {
    // Gmsh writes 4.0 as 4.
    assert!(refusal("version_40.msh").contains("MSH version 4 is not read"));
    assert!(refusal("version_10.msh").contains("MSH version 1.0 is not read"));
    assert!(refusal("two_surfaces.geo").contains("not an MSH file"));
    assert!(refusal("there_is_none.msh").contains("cannot be read"));
    assert_eq!(gmsh::parse(b""), Err(gmsh::Error::NotMsh));
    let big = gmsh::parse(b"$MeshFormat\n4.1 1 8\n\0\0\0\x01\n$EndMeshFormat\n");
    assert_eq!(big, Err(gmsh::Error::Binary("from a big-endian machine")));
}

#[test]
fn nodes_outside_of_the_plane_are_refused() {
    let text = refusal("out_of_plane.msh");
    assert!(text.contains("has z = 1") && text.contains("plane z = 0"), "{text}");
}

#[test]
fn two_groups_of_one_surface_are_refused_with_both_names() {
    for name in ["two_groups_22.msh", "two_groups_41.msh"] {
        let text = refusal(name);
        assert!(text.contains("belongs to several physical groups: `body`, `steel`"), "{text}");
    }
}

#[test]
fn quads_outside_of_the_physical_surfaces_are_counted() {
    // Saved with Mesh.SaveAll = 1; in MSH 2.2 no tag is left then, see `mesh_variants.rs`.
    let text = refusal("no_group_41.msh");
    assert!(text.contains("4 quadrilateral(s) belong to no physical surface, the first is element"), "{text}");
    let mixed = String::from_utf8(bytes("two_surfaces_22_ascii.msh")).unwrap().replace(" 3 2 20 ", " 3 2 0 ");
    assert!(matches!(gmsh::parse(mixed.as_bytes()), Err(gmsh::Error::NoGroup { .. })));
}

#[test]
fn inverted_cells_are_refused_by_number_and_place() {
    let text = refusal("inverted.msh");
    assert!(text.contains("cell 9 is not convex") && text.contains("(-0.2, -0.2)"), "{text}");
}

#[test]
fn faults_of_the_topology_are_found_in_files_of_gmsh() {
    let untagged = links(&read("untagged_edge.msh")).unwrap_err();
    assert!(matches!(untagged, MeshError::Untagged { count: 2, .. }), "{untagged}");
    let unmerged = links(&read("unmerged.msh")).unwrap_err();
    assert!(matches!(unmerged, MeshError::Duplicate { count: 3, .. }), "{unmerged}");
    let hanging = links(&read("hanging_node.msh")).unwrap_err();
    assert!(matches!(hanging, MeshError::Hanging { cell: 10, edge: [[1.0, 0.0], [1.0, 1.0]], .. }), "{hanging}");
    for error in [untagged, unmerged, hanging] {
        assert_eq!(dgmpm::Error::from(error).exit_code(), 2);
    }
}

#[test]
fn syntax_errors_of_text_name_line_and_column_and_those_of_binary_the_byte() {
    let text = String::from_utf8(bytes("clockwise.msh")).unwrap();
    let line = 1 + text.lines().position(|line| line.starts_with("$Elements")).unwrap();
    let broken = text.replace("$Elements\n5 12", "$Elements\n5 twelve");
    let at = gmsh::At::Line(line + 1, 3);
    assert!(matches!(gmsh::parse(broken.as_bytes()), Err(gmsh::Error::Syntax { at: found, .. }) if found == at));
    let message = gmsh::parse(broken.as_bytes()).unwrap_err().in_file(Path::new("a.msh")).to_string();
    assert!(message.starts_with(&format!("a.msh:{}:3: ", line + 1)) && message.contains("`twelve"), "{message}");

    let binary = bytes("two_surfaces_41_binary.msh");
    let cut = gmsh::parse(&binary[..4000]).unwrap_err();
    // The count of the block that is cut stands before the cut; no block of this file is longer than 20 quads of 40 bytes.
    assert!(matches!(cut, gmsh::Error::Syntax { at: gmsh::At::Byte(3200..=4000), .. }), "{cut}");
    assert!(cut.in_file(Path::new("a.msh")).to_string().starts_with("a.msh: byte "));
}

#[test]
fn a_count_beyond_the_file_is_refused_before_memory_is_asked_for() {
    let text = String::from_utf8(bytes("two_surfaces_22_ascii.msh")).unwrap();
    for count in ["18446744073709551615", "1000000000000", "5000"] {
        let text = text.replace("$Nodes\n45\n", &format!("$Nodes\n{count}\n"));
        let error = gmsh::parse(text.as_bytes()).unwrap_err().to_string();
        assert!(error.contains("the rest of the file can hold") && error.contains(count), "{error}");
    }
}

#[test]
fn damage_that_keeps_the_syntax_is_named() {
    let text = String::from_utf8(bytes("two_surfaces_22_ascii.msh")).unwrap();
    let parse = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        gmsh::parse(text.replace(from, to).as_bytes()).unwrap_err()
    };
    assert_eq!(parse("\n2 1 0 0\n", "\n1 1 0 0\n"), gmsh::Error::RepeatedNode(1));
    assert_eq!(parse("\n1 1 2 11 1 1 7\n", "\n1 1 2 11 1 1 9\n"), {
        gmsh::Error::Stray { name: "free".to_owned(), count: 1, first: 1 }
    });
    assert!(matches!(parse("\n3 2 0 0\n", "\n3 nan 0 0\n"), gmsh::Error::Mesh(MeshError::NotFinite { .. })));
    assert!(matches!(parse("\n3 2 0 0\n", "\n99 2 0 0\n"), gmsh::Error::UnknownNode { node: 3, .. }));
    let nodes = text.find("$Nodes").unwrap()..text.find("$Elements").unwrap();
    assert_eq!(parse(&text[nodes], ""), gmsh::Error::Missing("Nodes"));
    assert_eq!(parse(&text[text.find("$Elements").unwrap()..], ""), gmsh::Error::Missing("Elements"));
}

#[test]
fn every_cut_of_every_format_is_refused_or_whole() {
    for format in FORMATS {
        let whole = bytes(&format!("two_surfaces_{format}.msh"));
        for end in 0..whole.len() - 1 {
            assert!(gmsh::parse(&whole[..end]).is_err(), "{format} cut at {end}");
        }
    }
}

/// Numbers that break readers: as text, and as bytes of C ints and sizes.
const ODD: [&str; 12] =
    ["-1", "0", "1", "2", "3", "15", "36", "2147483648", "-2147483648", "18446744073709551615", "nan", "1e400"];

#[derive(Debug, Clone)]
enum Damage {
    Byte(usize, u8),
    Int(usize, i32),
    Size(usize, u64),
    Word(usize, usize),
    Cut(usize, usize),
    Repeat(usize, usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    let size = prop_oneof![Just(u64::MAX), Just(1 << 40), Just(1 << 31), 0..100u64];
    prop_oneof![
        (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Damage::Byte(at, byte)),
        (any::<usize>(), prop_oneof![any::<i32>(), -2..40i32]).prop_map(|(at, int)| Damage::Int(at, int)),
        (any::<usize>(), size).prop_map(|(at, size)| Damage::Size(at, size)),
        (any::<usize>(), 0..ODD.len()).prop_map(|(at, odd)| Damage::Word(at, odd)),
        (any::<usize>(), 0..200usize).prop_map(|(at, length)| Damage::Cut(at, length)),
        (any::<usize>(), 0..200usize).prop_map(|(at, length)| Damage::Repeat(at, length)),
    ]
}

fn apply(damage: &Damage, bytes: &mut Vec<u8>) {
    let n = bytes.len().max(1);
    let mut put = |at: usize, new: &[u8]| {
        for (byte, new) in bytes.iter_mut().skip(at % n).zip(new) {
            *byte = *new;
        }
    };
    match *damage {
        Damage::Byte(at, byte) => put(at, &[byte]),
        Damage::Int(at, int) => put(at, &int.to_le_bytes()),
        Damage::Size(at, size) => put(at, &size.to_le_bytes()),
        Damage::Word(at, odd) => {
            let blank = |b: &u8| b.is_ascii_whitespace();
            let start = bytes.iter().skip(at % n).position(blank).map_or(bytes.len(), |k| at % n + k + 1);
            let start = start.min(bytes.len());
            let end = bytes[start..].iter().position(blank).map_or(bytes.len(), |k| start + k);
            bytes.splice(start..end, ODD[odd].bytes());
        }
        Damage::Cut(at, length) => {
            let (start, end) = (at % n, (at % n + length).min(bytes.len()));
            bytes.drain(start.min(end)..end);
        }
        Damage::Repeat(at, length) => {
            let (start, end) = (at % n, (at % n + length).min(bytes.len()));
            let part = bytes[start.min(end)..end].to_vec();
            bytes.splice(end..end, part);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_damage_to_a_file_makes_the_reader_panic(
        file in prop::sample::select(vec![
            "two_surfaces_22_ascii.msh", "two_surfaces_22_binary.msh", "two_surfaces_41_ascii.msh",
            "two_surfaces_41_binary.msh", "parametric_22_binary.msh", "partitioned_41.msh", "solid.msh", "triangles.msh", "order_2.msh", "order_3.msh", "annulus_22.msh", "annulus_41.msh",
        ]),
        damages in prop::collection::vec(damage(), 1..6),
    ) {
        let mut bytes = bytes(file);
        damages.iter().for_each(|damage| apply(damage, &mut bytes));
        if let Ok(mesh) = gmsh::parse(&bytes) {
            // Whatever is accepted is a mesh that everything below can work on.
            let _ = links(&mesh);
            prop_assert!(Quality::of(&mesh).scaled_jacobian.0 > 0.0);
            let again = gmsh::parse(gmsh::to_text(&mesh).as_bytes());
            prop_assert!(again.is_ok(), "{:?}", again);
        }
    }

    #[test]
    fn no_bytes_behind_a_header_make_the_reader_panic(
        head in prop::sample::select(vec![
            &b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n"[..],
            b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Entities\n",
            b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Nodes\n",
            b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Elements\n",
            b"$MeshFormat\n2.2 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Elements\n7\n",
            b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n",
        ]),
        tail in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        prop_assert!(gmsh::parse(&[head, &tail[..]].concat()).is_err());
    }
}
