//! Meshes of other programs: VTU and XDMF files, what names their groups, and exports of this program that go back in.

use dgmpm::parts::io::grid::{Groups, HighOrderGrid};
use dgmpm::parts::io::unstructured::{Of, Tags};
use dgmpm::parts::io::{hash, parse, read_mesh, read_tagged, vtu, write_mesh, xdmf};
use dgmpm::parts::mesh::{Mesh, links, rectangle};
use std::path::Path;

use super::{data, read};

/// A VTU file as text: two squares on [0, 2] x [0, 1] as `quads` says, with more arrays of cells and of the grid.
fn vtu_of(cells: &str, types: &str, offsets: &str, data: &str, more: &str) -> String {
    let count = types.split_whitespace().count();
    let array = |kind: &str, name: &str, text: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
    };
    let points = "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0 9 9 0</DataArray>";
    format!(
        "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><UnstructuredGrid>{more}\
         <Piece NumberOfPoints=\"7\" NumberOfCells=\"{count}\"><Points>{points}</Points><Cells>{}{}{}</Cells><CellData>{data}</CellData>\
         </Piece></UnstructuredGrid></VTKFile>",
        array("Int64", "connectivity", cells),
        array("Int64", "offsets", offsets),
        array("UInt8", "types", types),
    )
}

fn whole(name: &str, text: &str) -> String {
    format!("<DataArray type=\"Int32\" Name=\"{name}\" format=\"ascii\">{text}</DataArray>")
}

fn of_text(text: &str, tags: &Tags) -> Result<Mesh, String> {
    parse(text.as_bytes(), Path::new("mesh.vtu"), tags).map_err(|why| {
        assert_eq!(why.exit_code(), 2);
        why.to_string()
    })
}

fn named(data: &str) -> Tags {
    Tags { data: Some(data.to_owned()), ..Tags::default() }
}

/// Two quadrilaterals.
const TWO: [&str; 3] = ["0 1 4 3 1 2 5 4", "9 9", "4 8"];

fn two(data: &str) -> String {
    vtu_of(TWO[0], TWO[1], TWO[2], data, "")
}

#[test]
fn quadrilaterals_and_pixels_are_cells_and_nodes_without_a_cell_are_left_out() {
    let tags = Tags::default();
    let mesh = of_text(&two(""), &tags).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.cells.len(), &mesh.groups[0][..]), (6, 2, "body"));
    assert_eq!((&mesh.edge_groups[..], mesh.edges.len()), (&["boundary".to_owned()][..], 6));
    links(&mesh).unwrap();
    // Row by row; one the other way round; as polygon; as Lagrange quadrilateral of degree 1; a vertex beside them.
    for (cells, types, offsets) in [
        ("0 1 3 4 1 2 4 5", "8 8", "4 8"),
        ("3 4 1 0 1 2 5 4", "9 7", "4 8"),
        ("0 1 4 3 1 2 5 4", "70 9", "4 8"),
        ("6 0 1 4 3 1 2 5 4", "1 9 9", "1 5 9"),
    ] {
        let other = of_text(&vtu_of(cells, types, offsets, "", ""), &tags).unwrap();
        assert_eq!(hash::of_places(&other), hash::of_places(&mesh), "{types}");
    }
    // Numbers of cells are those that ParaView shows.
    let other = of_text(&vtu_of("6 0 1 4 3 1 2 5 4", "1 9 9", "1 5 9", "", ""), &tags).unwrap();
    assert_eq!(other.original, [1, 2]);
}

#[test]
fn groups_have_the_names_of_the_file_those_that_are_asked_for_or_their_numbers() {
    // Two cells, a line of one piece, a polyline of two; 0 is no group for meshio's numbers of Gmsh.
    let cells = ("0 1 4 3 1 2 5 4 0 3 0 1 2 3 4", "9 9 3 4 3", "4 8 10 13 15");
    let names = "<FieldData><DataArray type=\"Int64\" Name=\"steel &amp; co\" NumberOfTuples=\"2\" format=\"ascii\">7 2</DataArray>\
                 <DataArray type=\"String\" Name=\"text\" NumberOfTuples=\"1\" format=\"ascii\">65 0</DataArray></FieldData>";
    let data = whole("gmsh:physical", "7 8 1 2 0") + &whole("gmsh:geometrical", "1 1 2 3 4");
    let text = vtu_of(cells.0, cells.1, cells.2, &data, names);
    let mesh = of_text(&text, &Tags::default()).unwrap();
    assert_eq!(mesh.groups, ["steel & co", "8"]);
    assert_eq!(mesh.edge_groups, ["1", "2", "boundary"]);
    assert_eq!((mesh.cell_group.clone(), mesh.edges.len()), (vec![0, 1], 6));
    let lengths = [0, 1, 2].map(|group| mesh.edges.iter().filter(|edge| edge.group == group).count());
    assert_eq!(lengths, [1, 2, 3]);
    let names =
        vec![(Of::Cells, 8, "soft".to_owned()), (Of::Edges, 1, "left".to_owned()), (Of::Edges, 2, "bottom".to_owned())];
    let mesh = of_text(&text, &Tags { names, ..Tags::default() }).unwrap();
    assert_eq!((&mesh.groups[1][..], &mesh.edge_groups[..2]), ("soft", &["left".to_owned(), "bottom".to_owned()][..]));
    let names = vec![(Of::Cells, 9, "hard".to_owned())];
    let why = of_text(&text, &Tags { names, ..Tags::default() }).unwrap_err();
    assert!(why.contains("no cells have the number 9") && why.contains("have the numbers 7, 8"), "{why}");
}

#[test]
fn data_name_groups_where_they_are_asked_for_are_usual_or_are_alone() {
    let groups = |data: &str, tags: &Tags| of_text(&two(data), tags).map(|mesh| mesh.groups);
    let (a, b) = (whole("a", "3 4"), whole("b", "5 6"));
    let real = "<DataArray type=\"Float64\" Name=\"c\" format=\"ascii\">1 2</DataArray>";
    let none = Tags::default();
    assert_eq!(groups(&a, &none).unwrap(), ["3", "4"]);
    // Data that programs add, and real numbers, name nothing by themselves.
    assert_eq!(groups(&(whole("vtkOriginalCellIds", "0 1") + real), &none).unwrap(), ["body"]);
    assert_eq!(groups(&format!("{a}{b}{}", whole("cell_tags", "1 1")), &none).unwrap(), ["1"]);
    assert_eq!(groups(&(a.clone() + &b), &named("b")).unwrap(), ["5", "6"]);
    assert_eq!(groups(real, &named("c")).unwrap(), ["1", "2"]);
    assert_eq!(groups(&(a.clone() + &b), &named("none")).unwrap(), ["body"]);
    for (data, tags, what) in [
        (
            a.clone() + &b,
            none.clone(),
            "several of its data could name the groups of cells: a, b\n  say which, such as groups = \"a\"",
        ),
        (a.clone(), named("A1"), "no data at its cells are named \"A1\"\n  its data at cells are a"),
        (String::new(), named("a"), "leave out `groups`"),
        (real.replace("1 2", "1 2.5"), named("c"), "`c` has the value 2.5: groups have whole numbers"),
        (whole("a", "1 2 3"), none.clone(), "array `a`: it has 3 numbers, and its points need 2"),
    ] {
        let why = groups(&data, &tags).unwrap_err();
        assert!(why.starts_with("mesh.vtu: ") && why.contains(what), "{why}");
    }
}

#[test]
fn what_is_no_mesh_of_plane_quadrilaterals_is_named_by_its_cell() {
    for (cells, types, offsets, what) in [
        ("0 1 4 3 1 2 5", "9 5", "4 7", "1 cell(s) are triangles, the first is cell 1 (from 0)"),
        ("0 1 4 3 1 2 5", "9 7", "4 7", "1 cell(s) are triangles, the first is cell 1 (from 0)"),
        ("0 1 2 3 4 5 6 0", "12", "8", "1 cell(s) are hexahedra"),
        ("0 1 2 4 3 5", "30", "6", "1 cell(s) are quadrilaterals of order 2 (with neither 8 nor 9 nodes)"),
        ("0 1 2 3 4 5 6 0 1 2 3 4 5 6 0 1", "70", "16", "quadrilaterals of order 3 (16 nodes)"),
        ("0 1 4 3", "99", "4", "cell 0 (from 0) is of the VTK type 99, which is not known"),
        ("0 1 4 3", "3", "4", "no grid of it has points and quadrilaterals"),
        ("0 1 4 8", "9", "4", "names node 8, which the file does not have"),
        ("0 1 4 -1", "9", "4", "array `connectivity` has what is no number of a point"),
        ("0 1 4 3 1 2 5 4", "9 9", "8 4", "array `offsets` does not count up"),
        ("0 1 4 3", "9", "18446744073709551615", "array `offsets` does not count up"),
        ("0 1 4 3 1 4 3 0", "9 9", "4 8", "elements 0 and 1 are the same"),
        ("0 4 1 3", "9", "4", "is not convex"),
    ] {
        let why = of_text(&vtu_of(cells, types, offsets, "", ""), &Tags::default()).unwrap_err();
        assert!(
            why.starts_with("mesh.vtu: ") && why.contains(what) && why.lines().count() == 2,
            "{types} {offsets}: {why}"
        );
    }
    let deep = two("").replace("1 1 0 2 1 0", "1 1 0 2 1 0.5");
    assert!(of_text(&deep, &Tags::default()).unwrap_err().contains("has z = 0.5"));
    let stray = vtu_of("0 1 4 3 0 4", "9 3", "4 6", &whole("cell_tags", "1 2"), "");
    let why = of_text(&stray, &Tags::default()).unwrap_err();
    assert!(
        why.contains("1 line(s) of the group `2` are no edge of a quadrilateral, the first is cell 1 (from 0)"),
        "{why}"
    );
}

#[test]
fn edges_of_bodies_that_are_not_joined_are_not_put_into_the_boundary() {
    // The second square has points of its own in the places of the first: most likely they should be one.
    let apart = two("").replace("9 9 0<", "1 0 0<").replace("1 2 5 4<", "6 2 5 4<");
    let mesh = of_text(&apart, &Tags::default()).unwrap();
    assert!(mesh.edges.is_empty());
    assert!(links(&mesh).unwrap_err().to_string().contains("nodes"), "{}", links(&mesh).unwrap_err());
}

/// A mesh with two materials, an inner group, and numbers of cells of its own.
fn two_surfaces() -> Mesh {
    read("two_surfaces_41_binary.msh").with_common_axes()
}

/// The same nodes, cells and groups to the bit, in the same order; only the corners that cells begin with may be others.
fn is_same(found: &Mesh, mesh: &Mesh) {
    assert_eq!((&found.nodes, &found.groups, &found.edge_groups), (&mesh.nodes, &mesh.groups, &mesh.edge_groups));
    let sorted = |mesh: &Mesh| {
        mesh.cells
            .iter()
            .map(|cell| {
                let mut cell = *cell;
                cell.sort_unstable();
                cell
            })
            .collect::<Vec<_>>()
    };
    assert_eq!((sorted(found), &found.cell_group), (sorted(mesh), &mesh.cell_group));
    assert_eq!(hash::of_places(found), hash::of_places(mesh));
}

#[test]
fn a_mesh_for_dolfinx_comes_back_as_it_was() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), two_surfaces());
    let path = folder.path().join("mesh.xdmf");
    write_mesh(&path, &mesh).unwrap();
    let back = read_mesh(&path).unwrap();
    is_same(&back, &mesh);
    // Numbers of cells are those in the file.
    assert_eq!(back.original, (0..32).collect::<Vec<u64>>());
    // By its HDF5 file, too: that is what a user may click on.
    assert_eq!(read_mesh(&folder.path().join("mesh.h5")).unwrap(), back);
    // Numbers as names stay numbers.
    let numbered = Mesh { groups: vec!["20".into(), "7".into()], ..mesh };
    write_mesh(&path, &numbered).unwrap();
    let tags = Tags { names: vec![(Of::Cells, 20, "steel".into()), (Of::Cells, 7, "soft".into())], ..Tags::default() };
    assert_eq!(read_tagged(&path, &tags).unwrap().groups, ["soft", "steel"]);
}

#[test]
fn the_mesh_of_an_export_comes_back_with_its_names() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), two_surfaces());
    let path = |name: &str| folder.path().join(name);
    xdmf::write_mesh(&path("mesh.xdmf"), &mesh).unwrap();
    xdmf::write_boundary(&path("boundary.xdmf"), &mesh).unwrap();
    let back = read_mesh(&path("mesh.xdmf")).unwrap();
    is_same(&back, &mesh);
    // The boundary in another place, by its name.
    std::fs::create_dir(path("b")).unwrap();
    for name in ["boundary.xdmf", "boundary.h5"] {
        std::fs::rename(path(name), path("b").join(name)).unwrap();
    }
    assert!(read_mesh(&path("mesh.xdmf")).unwrap_err().to_string().contains("boundary.xdmf"));
    let tags = Tags { facets: Some(path("b/boundary.xdmf")), ..Tags::default() };
    assert_eq!(read_tagged(&path("mesh.xdmf"), &tags).unwrap(), back);
}

#[test]
fn a_grid_with_fields_comes_back_as_the_mesh_of_the_start() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), two_surfaces());
    let path = folder.path().join("grid.vtu");
    for degree in 0..=6 {
        let mut grid = HighOrderGrid::of_mesh(&mesh, degree);
        let scalar = |name: &str, value: &dyn Fn(usize) -> f64| {
            use dgmpm::parts::io::grid::{Field, Kind};
            Field::new(name, Kind::Scalar, (0..mesh.cells.len()).map(value).collect())
        };
        grid.cell_fields =
            vec![scalar("cell", &|c| mesh.original[c] as f64), scalar("group", &|c| mesh.cell_group[c] as f64)];
        grid.groups = Some(Groups::of(&mesh));
        vtu::write_grid(&path, &grid).unwrap();
        let back = read_mesh(&path).unwrap();
        assert_eq!(hash::of_places(&back), hash::of_places(&mesh), "degree {degree}");
        assert_eq!(
            (&back.original, &back.groups, &back.edge_groups),
            (&mesh.original, &mesh.groups, &mesh.edge_groups)
        );
        links(&back).unwrap();
    }
}

#[test]
fn the_fingerprint_of_places_sees_geometry_and_groups_and_no_order() {
    let mesh = two_surfaces();
    let of = |change: &dyn Fn(&mut Mesh)| {
        let mut other = mesh.clone();
        change(&mut other);
        hash::of_places(&other) == hash::of_places(&mesh)
    };
    assert!(of(&|mesh| mesh.original.reverse()));
    assert!(of(&|mesh| mesh.edges.reverse()));
    // A cell without an edge of a group begins with another corner.
    let inner = (0..mesh.cells.len()).find(|&cell| mesh.edges.iter().all(|edge| edge.cell != cell)).unwrap();
    assert!(of(&|mesh| mesh.cells[inner].rotate_left(1)));
    assert!(of(&|mesh| (mesh.groups, mesh.cell_group) =
        (vec!["soft".into(), "steel".into()], mesh.cell_group.iter().map(|g| 1 - g).collect())));
    assert!(!of(&|mesh| mesh.nodes[3][0] = mesh.nodes[3][0].next_up()));
    assert!(!of(&|mesh| mesh.groups.swap(0, 1)));
    assert!(!of(&|mesh| mesh.edge_groups.swap(0, 1)));
    assert!(!of(&|mesh| mesh.edges.truncate(5)));
}

#[test]
fn an_unknown_file_is_answered_by_the_formats_that_can_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("some.mesh");
    for (text, what) in [
        ("", "the file is empty"),
        ("# vtk DataFile Version 3.0\nx", "a VTK file of the legacy format"),
        ("<html><body>", "an XML file with the root `html`"),
        ("cl__1 = 1;\nPoint(1) = {0, 0, 0};", "no mesh of a format that is known"),
        ("<VTKFile type=\"PolyData\"></VTKFile>", "not an unstructured grid but `PolyData`"),
        ("<Xdmf/>", "it has no `Domain`"),
        ("<Xdmf><Domain/></Xdmf>", "no grid of it has points and quadrilaterals"),
    ] {
        std::fs::write(&path, text).unwrap();
        let why = read_mesh(&path).unwrap_err().to_string();
        assert!(why.contains("some.mesh: ") && why.contains(what) && why.lines().count() == 2, "{why}");
        assert!(
            ["Xdmf", "VTKFile"].iter().any(|word| text.contains(word))
                || why.contains(".msh") && why.contains(".vtu") && why.contains(".xdmf"),
            "{why}"
        );
    }
    // 4 TiB, more than there is memory: sparse, so that the disk has room.
    let file = std::fs::File::create(&path).unwrap();
    std::io::Write::write_all(&mut &file, b"<VTKFile type=\"UnstructuredGrid\">").unwrap();
    file.set_len(1 << 42).unwrap();
    let why = read_mesh(&path).unwrap_err().to_string();
    assert!(why.contains("it has 4398046511104 bytes") && why.contains("are the most that are read"), "{why}");
}

#[test]
fn names_for_groups_are_refused_where_the_file_has_them() {
    let why = read_tagged(&data("two_surfaces_41_ascii.msh"), &named("a")).unwrap_err().to_string();
    assert!(why.contains("have their names in it") && why.contains("leave out groups, facets and names"), "{why}");
}

#[test]
fn an_export_of_a_rectangle_has_no_group_too_many() {
    let (folder, mesh) = (tempfile::tempdir().unwrap(), rectangle([3.0, 1.0], [3, 1]).unwrap());
    let path = folder.path().join("mesh.xdmf");
    write_mesh(&path, &mesh).unwrap();
    assert_eq!(read_mesh(&path).unwrap().edge_groups, ["left", "right", "bottom", "top"]);
}

/// A scene on the file `m.vtu` beside it, of two cells with the data `cell_tags`.
fn scene(mesh: &str, folder: &Path) -> Result<dgmpm::Scene, String> {
    std::fs::write(folder.join("m.vtu"), two(&(whole("cell_tags", "1 2") + &whole("other", "3 3")))).unwrap();
    let text = format!(
        "[mesh]\n{mesh}\n[[material]]\ngroup = \"steel\"\nlaw = \"neo-hookean\"\nyoung = 1\npoisson = 0\ndensity = 1\n\
         [[material]]\ngroup = \"2\"\nlaw = \"neo-hookean\"\nyoung = 1\npoisson = 0\ndensity = 1\n\
         [[boundary]]\ngroup = \"boundary\"\nkind = \"free\"\n\
         [scheme]\nmethod = \"ader-dgfem\"\ndegree = 1\n[time]\nend = 1\n"
    );
    std::fs::write(folder.join("case.toml"), text).unwrap();
    dgmpm::Scene::load(&folder.join("case.toml"), &[]).map_err(|why| why.to_string())
}

#[test]
fn a_scene_names_the_groups_of_its_mesh_and_the_folder_of_its_run_has_the_names() {
    let folder = tempfile::tempdir().unwrap();
    let named = "file = \"m.vtu\"\nnames = [{ cells = 1, name = \"steel\" }]";
    let found = scene(named, folder.path()).unwrap();
    assert_eq!(found.build_mesh().unwrap().groups, ["steel", "2"]);
    let text = found.portable_toml(false, false);
    assert!(text.contains("file = \"mesh.h5\"") && !text.contains("names"), "{text}");
    // Other data have another number.
    let other = scene(&format!("{named}\ngroups = \"other\""), folder.path()).unwrap();
    assert!(other.build_mesh().unwrap_err().to_string().contains("no cells have the number 1"));
    let bare = scene("file = \"m.vtu\"", folder.path()).unwrap().build_mesh().unwrap_err().to_string();
    assert!(bare.contains("the mesh has no group \"steel\"") && bare.contains("are 1, 2"), "{bare}");
    for (mesh, what) in [
        (
            "rectangle = { size = [1, 1], cells = [1, 1] }\ngroups = \"a\"",
            "case.toml:3:10: `groups` is for a mesh from a file",
        ),
        (
            "file = \"m.vtu\"\nnames = [{ name = \"steel\" }]",
            "the name \"steel\" needs the number of a group of cells, or",
        ),
        ("file = \"m.vtu\"\nnames = [{ cells = 1, edges = 1, name = \"steel\" }]", "needs the number"),
        ("file = \"m.vtu\"\nnames = [{ cells = -1, name = \"steel\" }]", "case.toml:3:20: "),
    ] {
        let why = scene(mesh, folder.path()).unwrap_err();
        assert!(why.contains(what), "{why}");
    }
    let missing = scene(&format!("{named}\nfacets = \"f.xdmf\""), folder.path()).unwrap().build_mesh().unwrap_err();
    assert!(missing.to_string().contains("there is no file") && missing.to_string().contains("f.xdmf"), "{missing}");
}
