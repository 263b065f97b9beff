//! Quadrilaterals of order 2: their curved edges come in, go out and come back. The geometry is that of `tests/data/gmsh/make.py`: a
//! quarter of an annulus of radii 1 and 2 m, 2 x 2 cells.

use super::{data, read};
use dgmpm::parts::io::grid::{Groups, HighOrderGrid};
use dgmpm::parts::io::{gmsh, hash, mesh_file, parse, read_mesh, vtu, write_mesh, xdmf};
use dgmpm::parts::mesh::{Mesh, links, map};
use std::f64::consts::PI;
use std::path::Path;

/// The places at s = 0, .25, .5, 1 of the edges of a group.
fn places(mesh: &Mesh, name: &str) -> Vec<[f64; 2]> {
    let group = mesh.edge_groups.iter().position(|own| own == name).unwrap();
    let edges = mesh.edges.iter().filter(|edge| edge.group == group);
    edges
        .flat_map(|edge| {
            [0.0, 0.25, 0.5, 1.0].map(|s| {
                let end = (edge.face % 2) as f64;
                map::position(&mesh.map(edge.cell), if edge.face < 2 { [end, s] } else { [s, end] })
            })
        })
        .collect()
}

#[test]
fn the_arcs_of_a_mesh_of_order_2_are_curved_in_each_format_and_kind_of_element() {
    let [binary, text, eight] = ["annulus_22.msh", "annulus_41.msh", "annulus_8.msh"].map(read);
    for mesh in [&binary, &text, &eight] {
        assert_eq!((mesh.cells.len(), mesh.nodes.len(), mesh.curved_cells()), (4, 9, 4));
        links(mesh).unwrap();
        for (name, radius) in [("inner", 1.0), ("outer", 2.0)] {
            for x in places(mesh, name) {
                // Ends and middles lie on the circle; between them a parabola over 45 degrees is 5.4e-4 of the radius inside.
                assert!((x[0].hypot(x[1]) - radius).abs() < 6e-4 * radius, "{name}: {x:?}");
            }
        }
        let area: f64 = (0..4).map(|cell| map::area(&mesh.map(cell))).sum();
        // Parabolas over 45 degrees: 1.84e-3 m^2 too little, .08 %. The polygon has 10 % too little.
        assert!((area - 0.75 * PI).abs() < 2e-3, "{area}");
    }
    for (a, b) in binary.bulges.as_flattened().as_flattened().iter().zip(text.bulges.as_flattened().as_flattened()) {
        // Text has 16 digits.
        assert!((a - b).abs() < 1e-15, "{a} {b}");
    }
    assert_eq!((&binary.cells, &binary.edges), (&text.cells, &text.edges));
}

#[test]
fn a_mesh_of_order_2_with_straight_edges_is_that_of_order_1_to_the_bit() {
    let mesh = read("order_2.msh");
    assert!(mesh.bulges.is_empty());
    let (text, straight) = (gmsh::to_text(&mesh), read("order_2.msh"));
    assert!(!text.contains("\n2 1 10 "), "{text}");
    assert_eq!(hash::of_mesh(&mesh), hash::of_mesh(&straight));
}

/// Curved and distorted: nothing of it is symmetric.
fn twisted() -> Mesh {
    let mut mesh = read("annulus_41.msh");
    for (k, bulge) in mesh.bulges.iter_mut().enumerate() {
        bulge[4] = [0.01 * (k as f64 + 1.0) / 3.0, -0.007];
    }
    // As a file gives it: middles that come back to the bit.
    gmsh::parse(gmsh::to_text(&mesh).as_bytes()).unwrap()
}

#[test]
fn a_curved_mesh_comes_back_from_each_of_the_files_of_this_program() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), twisted());
    let path = |name: &str| folder.path().join(name);
    assert_eq!(mesh.curved_cells(), 4);
    assert_eq!(gmsh::parse(gmsh::to_text(&mesh).as_bytes()).unwrap(), mesh);
    mesh_file::write_mesh(&path("mesh.h5"), &mesh).unwrap();
    assert_eq!(mesh_file::read_mesh(&path("mesh.h5")).unwrap(), mesh);
    let places = hash::of_places(&mesh);
    assert_ne!(places, hash::of_places(&Mesh { bulges: vec![], ..mesh.clone() }));
    write_mesh(&path("tags.xdmf"), &mesh).unwrap();
    assert_eq!(hash::of_places(&read_mesh(&path("tags.xdmf")).unwrap()), places);
    xdmf::write_mesh(&path("own.xdmf"), &mesh).unwrap();
    xdmf::write_boundary(&path("boundary.xdmf"), &mesh).unwrap();
    assert_eq!(hash::of_places(&read_mesh(&path("own.xdmf")).unwrap()), places);
    for degree in 0..=6 {
        let grid = HighOrderGrid { groups: Some(Groups::of(&mesh)), ..HighOrderGrid::of_mesh(&mesh, degree) };
        vtu::write_grid(&path("grid.vtu"), &grid).unwrap();
        assert_eq!(hash::of_places(&read_mesh(&path("grid.vtu")).unwrap()), places, "degree {degree}");
    }
}

#[test]
fn cells_of_8_and_9_nodes_of_other_programs_are_curved() {
    // A unit square whose lower edge goes down by .1.
    let points = "0 0 0 1 0 0 1 1 0 0 1 0 .5 -.1 0 1 .5 0 .5 1 0 0 .5 0 .5 .45 0";
    for (kind, nodes) in [(23, 8), (28, 9), (70, 9)] {
        let list = (0..nodes).map(|k| k.to_string()).collect::<Vec<_>>().join(" ");
        let array = |kind: &str, name: &str, text: &str| {
            format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
        };
        let text = format!(
            "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\
             <UnstructuredGrid><Piece NumberOfPoints=\"9\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" \
             NumberOfComponents=\"3\" format=\"ascii\">{points}</DataArray></Points><Cells>{}{}{}</Cells></Piece>\
             </UnstructuredGrid></VTKFile>",
            array("Int64", "connectivity", &list),
            array("Int64", "offsets", &nodes.to_string()),
            array("UInt8", "types", &kind.to_string()),
        );
        let mesh = parse(text.as_bytes(), Path::new("mesh.vtu"), &Default::default()).unwrap();
        // 1 and 2/3 of chord times bulge.
        let area = map::area(&mesh.map(0));
        assert!((area - (1.0 + 0.2 / 3.0)).abs() < 1e-15, "{kind}: {area}");
    }
}

#[test]
fn a_curved_cell_that_folds_is_refused_with_its_number() {
    let text = std::fs::read_to_string(data("annulus_41.msh")).unwrap();
    // The middle of an inner arc, moved beyond the outer one.
    let middle = (PI / 8.0).cos();
    let is_middle = |line: &&str| {
        line.split(' ').next().and_then(|x| x.parse::<f64>().ok()).is_some_and(|x| (x - middle).abs() < 1e-6)
    };
    let line = text.lines().find(is_middle).unwrap();
    let why = gmsh::parse(text.replace(line, "3 3 0").as_bytes()).unwrap_err().to_string();
    assert!(why.contains("are curved so far that it folds at"), "{why}");
}
