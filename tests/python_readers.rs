//! What is exported is read back, bit for bit, by meshio, VTK (pyvista), h5py and DOLFINx.

mod io_samples;
mod python;

use std::path::Path;

use dgmpm::parts::io::grid::Field;
use dgmpm::parts::io::{cloud_file, mesh_file, pvd, snapshot, vtu, xdmf};

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
