//! What is exported is read back, bit for bit, by meshio, meshlane, VTK (pyvista), h5py and DOLFINx.

mod io_samples;
mod python;

use std::path::Path;

use dgmpm::parts::io::grid::Field;
use dgmpm::parts::io::unstructured::{Of, Tags};
use dgmpm::parts::io::{
    cloud_file, gmsh, hash, mesh_file, nodal, pvd, read_tagged, seal, snapshot, vtu, write_mesh, xdmf,
};

const TIMES: [f64; 3] = [0.0, 1e-4 / 3.0, 3e-4];

/// Values as raw little-endian numbers, which need no reader that could be wrong.
fn write_raw(folder: &Path, name: &str, values: &[f64]) {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join(name).with_extension("f64"), bytes).unwrap();
}

fn write_fields(folder: &Path, fields: &[Field]) {
    for field in fields {
        write_raw(folder, &field.name, &field.values);
    }
}

/// One folder per degree, with what `export` writes and the raw values beside it.
fn write_degree(folder: &Path, degree: usize) {
    let mesh = io_samples::mesh();
    let mut series = xdmf::Series::create(&folder.join("series.xdmf"), &io_samples::grid(&mesh, degree, 0.0)).unwrap();
    let (mut grids, mut points) = (Vec::new(), Vec::new());
    for (k, &time) in TIMES.iter().enumerate() {
        let grid = io_samples::grid(&mesh, degree, time);
        let cloud = io_samples::points(&mesh, time);
        grids.push((time, folder.join(format!("grid/grid_{k:06}.vtu"))));
        points.push((time, folder.join(format!("points/points_{k:06}.vtu"))));
        vtu::write_grid(&grids[k].1, &grid).unwrap();
        vtu::write_points(&points[k].1, &cloud).unwrap();
        series.push(time, &grid.point_fields, &grid.cell_fields).unwrap();
        let raw = folder.join(format!("raw/{k}"));
        write_raw(&raw.join("grid"), "points", grid.points.as_flattened());
        write_fields(&raw.join("grid/point"), &grid.point_fields);
        write_fields(&raw.join("grid/cell"), &grid.cell_fields);
        write_raw(&raw.join("points"), "points", cloud.points.as_flattened());
        write_fields(&raw.join("points/point"), &cloud.fields);
    }
    series.finish().unwrap();
    pvd::write_series(&folder.join("grid.pvd"), &grids).unwrap();
    pvd::write_series(&folder.join("points.pvd"), &points).unwrap();
}

fn write_all(folder: &Path) {
    for degree in 0..=3 {
        write_degree(&folder.join(format!("degree{degree}")), degree);
    }
    let mesh = io_samples::mesh();
    let cloud = io_samples::cloud(&mesh);
    xdmf::write_mesh(&folder.join("mesh.xdmf"), &mesh).unwrap();
    xdmf::write_boundary(&folder.join("boundary.xdmf"), &mesh).unwrap();
    let pipeline = folder.join("pipeline");
    mesh_file::write_mesh(&pipeline.join("mesh.h5"), &mesh).unwrap();
    cloud_file::write_cloud(&pipeline.join("cloud.h5"), &cloud, &mesh).unwrap();
    let state = io_samples::snapshot(2);
    state.write(&snapshot::path(&pipeline.join("snapshots"), state.step)).unwrap();
    write_raw(&pipeline, "u", &state.u);
    write_raw(&pipeline, "xi", cloud.xi.as_flattened());
    write_raw(&pipeline, "nodes", mesh.nodes.as_flattened());
}

#[test]
fn other_programs_read_the_files() {
    let Some(python) = python::python() else { return };
    let folder = tempfile::tempdir().unwrap();
    write_all(folder.path());
    python::run(&python, "tests/python/test_readers.py", [folder.path()]);
    python::run_dolfinx("tests/python/dolfinx_mesh.py", [folder.path()]);
}

/// The mesh of Gmsh that goes through other programs: two materials, three groups of edges, one of them inside.
fn of_gmsh() -> std::path::PathBuf {
    python::root().join("tests/data/gmsh/two_surfaces_41_binary.msh")
}

/// Names for the numbers of Gmsh, or for those of this program.
fn tags(first: [i64; 2], facets: Option<&Path>) -> Tags {
    let cells =
        ["steel", "soft"].into_iter().zip(first[0]..).map(|(name, number)| (Of::Cells, number, name.to_owned()));
    let edges = ["loaded", "free", "interface"].into_iter().zip(first[1]..);
    let names = cells.chain(edges.map(|(name, number)| (Of::Edges, number, name.to_owned()))).collect();
    Tags { data: None, facets: facets.map(Path::to_owned), names }
}

/// The fields that the script gives the nodes, bit for bit; some writers make three numbers of two.
fn has_fields(path: &Path, mesh: &dgmpm::Mesh) {
    let nodal = nodal::read(path, None).unwrap();
    assert_eq!(nodal.mesh.nodes, mesh.nodes, "{}", path.display());
    for (name, [a, b]) in [("velocity", [2.0, -1.0]), ("displacement", [0.5, 0.25])] {
        let data = nodal.data.iter().find(|data| data.name == name).unwrap_or_else(|| panic!("{}", path.display()));
        for (row, x) in data.values.chunks(data.components).zip(&mesh.nodes) {
            assert_eq!(row, &[a * x[0], b * x[1], 0.0][..data.components], "{}: {name}", path.display());
        }
    }
}

#[test]
fn a_mesh_of_gmsh_is_the_same_after_each_mode_of_meshio_meshlane_and_vtk() {
    let Some(python) = python::python() else { return };
    let folder = tempfile::tempdir().unwrap();
    python::run(&python, "tests/python/mesh_files.py", [of_gmsh().as_path(), folder.path()]);
    // The files are ours: HDF5 of another program is read only where it is trusted.
    seal::trust();
    let mesh = gmsh::read(&of_gmsh()).unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(folder.path()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if !name.ends_with(".vtu") && !name.ends_with(".xdmf") || name.ends_with("facets.xdmf") {
            continue;
        }
        let of_cells = name.strip_suffix("cells.xdmf");
        let facets = of_cells.map(|library| folder.path().join(format!("{library}facets.xdmf")));
        let found = read_tagged(&path, &tags([20, 10], facets.as_deref())).unwrap();
        count += 1;
        if name.ends_with("_text.vtu") {
            // 12 digits.
            let near = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs() < 2e-11 && (a[1] - b[1]).abs() < 2e-11;
            assert!(found.nodes.iter().zip(&mesh.nodes).all(near), "{name}");
            assert_eq!((found.cell_group, found.edges.len()), (mesh.cell_group.clone(), mesh.edges.len()), "{name}");
            continue;
        }
        assert_eq!(hash::of_places(&found), hash::of_places(&mesh), "{name}");
        if facets.is_none() {
            has_fields(&path, &mesh);
        }
        if name.starts_with("vtk_") {
            let own = read_tagged(&path, &Tags::default()).unwrap();
            assert_eq!(
                (&own.groups, &own.edge_groups),
                (&mesh.groups, &mesh.edge_groups),
                "{name}: names of its field data"
            );
        }
    }
    // 7 .vtu and 3 meshes as XDMF of meshio and of meshlane; 4 + 3 * 3 * 4 files of VTK.
    assert_eq!(count, 2 * 10 + 40);
}

#[test]
fn a_mesh_of_gmsh_is_the_same_after_dolfinx_has_read_and_written_it() {
    let folder = tempfile::tempdir().unwrap();
    let (path, mesh) = (folder.path().join("in.xdmf"), gmsh::read(&of_gmsh()).unwrap());
    write_mesh(&path, &mesh).unwrap();
    if !python::run_dolfinx("tests/python/dolfinx_round.py", [path.as_path(), folder.path()]) {
        return;
    }
    seal::trust();
    let facets = folder.path().join("facets.xdmf");
    // DOLFINx orders nodes and cells anew and keeps numbers of groups, not names: the geometry and the groups are compared.
    for (name, facets) in [("all.xdmf", None), ("mesh.xdmf", Some(facets.as_path()))] {
        let found = read_tagged(&folder.path().join(name), &tags([1, 1], facets)).unwrap();
        assert_eq!(hash::of_places(&found), hash::of_places(&mesh), "{name}");
    }
    // Its text has 16 digits: the last bit may differ.
    let text = read_tagged(&folder.path().join("text.xdmf"), &tags([1, 1], None)).unwrap();
    let area = |mesh: &dgmpm::Mesh| dgmpm::parts::mesh::quality::Quality::of(mesh).area;
    assert!((area(&text) - area(&mesh)).abs() < 1e-14);
    assert_eq!((text.edges.len(), &text.edge_groups), (mesh.edges.len(), &mesh.edge_groups));
}

#[test]
fn fields_that_dolfinx_writes_come_in_at_each_of_their_times() {
    let folder = tempfile::tempdir().unwrap();
    if !python::run_dolfinx("tests/python/dolfinx_fields.py", [folder.path()]) {
        return;
    }
    seal::trust();
    for (asked, time) in [(Some(0.0), 0.0), (Some(0.5), 0.5), (None, 0.5)] {
        let nodal = nodal::read(&folder.path().join("fields.xdmf"), asked).unwrap();
        assert_eq!((nodal.mesh.cells.len(), nodal.mesh.nodes.len()), (15, 24));
        // What the script interpolates, to rounding.
        let wanted = |[x, y]: [f64; 2]| {
            [
                ("v", [10.0 * time + 3.0 * x - 2.0 * y, 5.0 * x + y, 0.0]),
                ("u", [1e-2 * x - 3e-3 * y, time * 4e-2 * y, 0.0]),
            ]
        };
        for (node, x) in nodal.mesh.nodes.iter().enumerate() {
            for (name, row) in wanted(*x) {
                let data = nodal.data.iter().find(|data| data.name == name).unwrap();
                assert_eq!(data.components, 3);
                let near = |(a, b): (&f64, f64)| (a - b).abs() < 1e-14 * 10.0;
                assert!(data.values[3 * node..3 * node + 3].iter().zip(row).all(near), "{asked:?}: {name} at {x:?}");
            }
        }
    }
}
