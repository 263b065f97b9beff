//! The files of the pipeline: what is written comes back bit for bit; what is damaged gives one message.

mod io_samples;

use std::fs;
use std::path::Path;

use dgmpm::Error;
use dgmpm::parts::cloud::Cloud;
use dgmpm::parts::io::csv::Table;
use dgmpm::parts::io::grid::{Field, HighOrderGrid, Kind, lagrange_quad_lattice, lagrange_quad_nodes};
use dgmpm::parts::io::hdf5::Values;
use dgmpm::parts::io::seal::{self, Seal};
use dgmpm::parts::io::snapshot::{self, Snapshot};
use dgmpm::parts::io::store::{ArrayRef, Format, Store, write_arrays};
use dgmpm::parts::io::{cloud_file, hash, mesh_file, pvd, vtu, xdmf};
use dgmpm::parts::mesh::Mesh;
use dgmpm::parts::operators::{Certificate, Class};
use proptest::prelude::*;

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}

/// The message of bad input, after checks that hold for every such message.
fn message<T: std::fmt::Debug>(result: Result<T, Error>, path: &Path) -> String {
    let error = result.expect_err("a file that cannot be used");
    assert_eq!(error.exit_code(), 2, "{error}");
    let text = error.to_string();
    assert!(text.contains(&path.display().to_string()), "the file is not named: {text}");
    assert!(text.lines().count() == 2, "a message and its remedy: {text}");
    text
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn mesh_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new/mesh.h5");
    let mut mesh = io_samples::mesh();
    mesh.groups.push(String::new());
    mesh_file::write_mesh(&path, &mesh).unwrap();
    assert_eq!(mesh_file::read_mesh(&path).unwrap(), mesh);
    // Its lists come back, too; but nobody can compute on no cells.
    mesh_file::write_mesh(&path, &Mesh::default()).unwrap();
    assert!(message(mesh_file::read_mesh(&path), &path).contains("the mesh has no cells"));
    assert_eq!(names_in(path.parent().unwrap()), ["mesh.h5"]);
}

#[test]
fn cloud_comes_back_for_its_mesh_only() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.h5");
    let mut mesh = io_samples::mesh();
    let cloud = io_samples::cloud(&mesh);
    cloud_file::write_cloud(&path, &cloud, &mesh).unwrap();
    assert_eq!(cloud_file::read_with(&path, &mesh).unwrap().0, cloud);
    mesh.nodes[0][0] = -f64::EPSILON;
    assert!(message(cloud_file::read_with(&path, &mesh), &path).contains("another mesh"));
}

#[test]
fn what_is_known_of_points_and_cells_comes_back_with_their_cloud() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.h5");
    let mesh = io_samples::mesh();
    let cloud = io_samples::cloud(&mesh);
    let cell = |c: usize| Certificate {
        class: Class::NAMES[c % 4].1,
        points: c,
        rank: c / 2,
        condition: if c == 1 { f64::INFINITY } else { 1.5 },
        lebesgue: 1.0 / (c + 1) as f64,
        inside: 2.0,
        h: 0.1,
        dt: 1e-7,
    };
    let more = cloud_file::Extras {
        virtual_points: (0..cloud.len()).map(|p| p % 3 == 0).collect(),
        fields: vec![
            Field::new("deformation", Kind::Tensor, io_samples::noise(9 * cloud.len(), 1)),
            Field::new("plastic_strain", Kind::Scalar, io_samples::noise(cloud.len(), 2)),
            Field::new("velocity", Kind::Vector, io_samples::noise(3 * cloud.len(), 3)),
        ],
        certificates: (0..mesh.cells.len()).map(cell).collect(),
    };
    cloud_file::write_with(&path, &cloud, &mesh, &more).unwrap();
    assert_eq!(cloud_file::read_with(&path, &mesh).unwrap(), (cloud.clone(), more.clone()));
    let short = cloud_file::Extras { virtual_points: vec![true], ..more };
    assert_eq!(cloud_file::write_with(&path, &cloud, &mesh, &short).unwrap_err().exit_code(), 5);
}

#[test]
fn snapshots_come_back_with_all_bits() {
    let folder = tempfile::tempdir().unwrap();
    for degree in 0..=6 {
        let mut state = io_samples::snapshot(degree);
        state.step = 10usize.pow(degree as u32);
        if degree % 2 == 1 {
            (state.displacement, state.internal) = (Vec::new(), Vec::new());
        }
        let path = snapshot::path(folder.path(), state.step);
        state.write(&path).unwrap();
        let read = Snapshot::read(&path).unwrap();
        assert_eq!((read.step, read.degree, read.time.to_bits()), (state.step, degree, state.time.to_bits()));
        assert_eq!(bits(&read.u), bits(&state.u));
        assert_eq!(bits(&read.displacement), bits(&state.displacement));
        assert_eq!(bits(&read.internal), bits(&state.internal));
    }
    fs::write(folder.path().join("notes.h5"), "").unwrap();
    let steps: Vec<usize> = snapshot::list(folder.path()).unwrap().into_iter().map(|(step, _)| step).collect();
    assert_eq!(steps, [1, 10, 100, 1000, 10000, 100000, 1000000]);
}

#[test]
fn the_same_content_gives_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["a.h5", "b.h5"].map(|n| folder.path().join(n));
    for path in &paths {
        io_samples::snapshot(3).write(path).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(1100));
    }
    assert!(fs::read(&paths[0]).unwrap() == fs::read(&paths[1]).unwrap());
}

#[test]
fn smooth_states_are_packed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("000001.h5");
    let u = vec![1.0; 6 * 9 * 900];
    let bytes = 8 * u.len() as u64;
    Snapshot { degree: 2, u, ..Snapshot::default() }.write(&path).unwrap();
    assert!(fs::metadata(&path).unwrap().len() < bytes / 10);
    assert_eq!(Snapshot::read(&path).unwrap().cells(), 900);
}

const THINGS: Format = Format { name: "dgmpm things", version: 2, remedy: "make it again" };

#[test]
fn stores_hold_arrays_of_every_kind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("things.h5");
    let texts = vec!["é".to_owned(), String::new()];
    let arrays = [
        ("big", vec![100, 40, 3], ArrayRef::F64(&io_samples::noise(12000, 3))),
        ("one", vec![], ArrayRef::F64(&[-0.0])),
        ("signed", vec![2, 1], ArrayRef::I64(&[i64::MIN, 7])),
        ("unsigned", vec![1], ArrayRef::U64(&[u64::MAX])),
        ("index", vec![3], ArrayRef::Index(&[2, 0, 1])),
        ("none", vec![0, 4], ArrayRef::Index(&[])),
        ("texts", vec![2], ArrayRef::Text(&texts)),
    ];
    write_arrays(&path, THINGS, &[("key", "abc".into())], &arrays).unwrap();
    let mut store = Store::read(&path, THINGS).unwrap();
    assert_eq!(store.attribute("key").unwrap(), "abc");
    assert_eq!(store.shape("big").unwrap(), [100, 40, 3]);
    assert_eq!(store.take("signed").unwrap(), (vec![2, 1], Values::I64(vec![i64::MIN, 7])));
    assert_eq!(store.real("one").unwrap().to_bits(), (-0.0f64).to_bits());
    assert_eq!(store.unsigned("unsigned", &[]).unwrap(), [u64::MAX]);
    assert_eq!(store.indices("index", &[]).unwrap(), [2, 0, 1]);
    assert!(store.indices("none", &[4]).unwrap().is_empty());
    assert_eq!(store.texts("texts").unwrap(), texts);
    assert!(message(store.reals("big", &[3]), &path).contains("shape"));
    assert!(message(store.reals("absent", &[]), &path).contains("missing"));
    assert!(message(store.attribute("absent"), &path).contains("missing"));
    let older = Format { version: 1, ..THINGS };
    assert!(message(Store::read(&path, older), &path).contains("version is 2"));
}

#[test]
fn other_files_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let mesh = io_samples::mesh();
    cloud_file::write_cloud(&at("cloud.h5"), &io_samples::cloud(&mesh), &mesh).unwrap();
    let text = message(mesh_file::read_mesh(&at("cloud.h5")), &at("cloud.h5"));
    assert!(text.contains("this is a `dgmpm cloud` file, not a `dgmpm mesh` file"), "{text}");
    fs::write(at("text.h5"), "no HDF5 at all").unwrap();
    fs::write(at("empty.h5"), "").unwrap();
    for name in ["text.h5", "empty.h5", "absent.h5", "."] {
        message(mesh_file::read_mesh(&at(name)), &at(name));
        message(cloud_file::read_with(&at(name), &mesh), &at(name));
        message(Snapshot::read(&at(name)), &at(name));
    }
}

/// Writes `mesh.h5` by hand, as another program might, after a change.
fn mesh_with(path: &Path, change: impl FnOnce(&mut Mesh)) -> Result<Mesh, Error> {
    let mut mesh = io_samples::mesh();
    change(&mut mesh);
    mesh_file::write_mesh(path, &mesh)?;
    mesh_file::read_mesh(path)
}

#[test]
fn indices_out_of_range_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    type Change = fn(&mut Mesh);
    let cases: [(Change, &str); 8] = [
        (|m| m.cells[5][2] = 20, "cell 5 refers to nodes"),
        (|m| m.cell_group[3] = 2, "cell 3 is of group 2"),
        (|m| m.edges[7].face = 4, "boundary edge 7"),
        (|m| m.edges[1].group = 4, "boundary edge 1"),
        (|m| m.edges[0].cell = 12, "boundary edge 0"),
        (|m| m.nodes[9][1] = f64::NAN, "node 9"),
        (|m| m.original.truncate(11), "11 of `original`"),
        (|m| m.cell_group.push(0), "13 values of `cell_group`"),
    ];
    for (change, what) in cases {
        let text = message(mesh_with(&path, change), &path);
        assert!(text.contains(what), "{text}");
    }
}

#[test]
fn a_file_is_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cloud.h5");
    let mesh = io_samples::mesh();
    cloud_file::write_cloud(&path, &io_samples::cloud(&mesh), &mesh).unwrap();
    let before = fs::read(&path).unwrap();
    let wrong = [
        Cloud::default(),
        Cloud { first: vec![0, 1], xi: vec![[0.5, 0.5]] },
        Cloud { first: vec![0; 13], xi: vec![[0.5, 0.5]] },
        Cloud { first: [vec![0; 12], vec![1]].concat(), xi: vec![[0.5, 1.5]] },
    ];
    for cloud in wrong {
        assert_eq!(cloud_file::write_cloud(&path, &cloud, &mesh).unwrap_err().exit_code(), 5);
    }
    let arrays = [("fits", vec![1], ArrayRef::F64(&[1.0])), ("does not", vec![3], ArrayRef::F64(&[1.0]))];
    assert_eq!(write_arrays(&path, cloud_file::FORMAT, &[], &arrays).unwrap_err().exit_code(), 5);
    assert!(fs::read(&path).unwrap() == before);
    assert_eq!(names_in(folder.path()), ["cloud.h5"]);
    for target in [path.join("below/a/file.h5"), folder.path().to_owned()] {
        assert_eq!(mesh_file::write_mesh(&target, &mesh).unwrap_err().exit_code(), 5);
    }
}

#[test]
fn no_damaged_byte_goes_unseen() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    let mesh = io_samples::mesh();
    mesh_file::write_mesh(&path, &mesh).unwrap();
    let whole = fs::read(&path).unwrap();
    for at in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[at] ^= 1 << (at % 8);
        fs::write(&path, damaged).unwrap();
        match mesh_file::read_mesh(&path) {
            Ok(read) => assert_eq!(read, mesh, "byte {at}"),
            damage => {
                let message = message(damage, &path);
                // A byte of the seal's own mark: it is none any more.
                assert!(message.contains("damaged") || message.contains("has no seal"), "byte {at}: {message}");
            }
        }
    }
}

#[test]
fn a_file_that_another_program_has_changed_has_no_seal_and_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.h5");
    let mesh = io_samples::mesh();
    mesh_file::write_mesh(&path, &mesh).unwrap();
    assert_eq!(seal::check(&path).unwrap(), Seal::Whole);
    let sealed = fs::metadata(&path).unwrap().len();
    hdf5_metno::File::open_rw(&path).unwrap().close().unwrap();
    assert_eq!(seal::check(&path).unwrap(), Seal::None, "HDF5 cuts the seal off where it may write");
    assert!(fs::metadata(&path).unwrap().len() < sealed);
    // With `--trust` it is read: tests/bad_inputs/links.rs.
    assert!(message(mesh_file::read_mesh(&path), &path).contains("has no seal"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn truncated_files_give_a_message(kept in 0.0..1.0f64, which in 0usize..3) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file.h5");
        let mesh = io_samples::mesh();
        let cloud = io_samples::cloud(&mesh);
        match which {
            0 => mesh_file::write_mesh(&path, &mesh).unwrap(),
            1 => cloud_file::write_cloud(&path, &cloud, &mesh).unwrap(),
            _ => io_samples::snapshot(2).write(&path).unwrap(),
        }
        let whole = fs::read(&path).unwrap();
        let length = (kept * whole.len() as f64) as usize;
        fs::write(&path, &whole[..length]).unwrap();
        let read = match which {
            0 => mesh_file::read_mesh(&path).map(|read| assert_eq!(read, mesh)),
            1 => cloud_file::read_with(&path, &mesh).map(|read| assert_eq!(read.0, cloud)),
            _ => Snapshot::read(&path).map(|read| assert_eq!(bits(&read.u), bits(&io_samples::snapshot(2).u))),
        };
        // Without its end it has no seal.
        if length < whole.len() {
            message(read, &path);
        } else {
            read.unwrap();
        }
    }

    #[test]
    fn snapshots_of_any_numbers_come_back(u in proptest::collection::vec(any::<u64>(), 1..200), time in any::<f64>()) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file.h5");
        let u: Vec<f64> = u.iter().cycle().take(6 * 4 * u.len()).map(|&b| f64::from_bits(b)).collect();
        let state = Snapshot { time, degree: 1, u, ..Snapshot::default() };
        state.write(&path).unwrap();
        let read = Snapshot::read(&path).unwrap();
        prop_assert_eq!(bits(&read.u), bits(&state.u));
        prop_assert_eq!(read.time.to_bits(), time.to_bits());
    }
}

#[test]
fn fingerprints_see_every_part() {
    let mesh = io_samples::mesh();
    let changes: [fn(&mut Mesh); 7] = [
        |m| m.nodes[0][0] = -0.0,
        |m| m.cells[0].rotate_left(1),
        |m| m.cell_group[0] = 1,
        |m| m.groups[0].push('x'),
        |m| m.edges[0].face = 3,
        |m| m.edge_groups.swap(0, 1),
        |m| m.original[0] += 1,
    ];
    let mut all = vec![hash::of_mesh(&mesh)];
    for change in changes {
        let mut other = mesh.clone();
        change(&mut other);
        all.push(hash::of_mesh(&other));
    }
    let cloud = io_samples::cloud(&mesh);
    let mut other = cloud.clone();
    other.first[1] = 1;
    all.extend([hash::of_cloud(&cloud), hash::of_cloud(&other)]);
    assert!(all.iter().all(|h| h.len() == 64));
    assert!((1..all.len()).all(|k| !all[..k].contains(&all[k])), "two contents with one fingerprint");
}

/// (i, j) of each node as `vtkHigherOrderQuadrilateral.PointIndexFromIJK` of VTK 9.7 gives them.
const VTK_ORDER: [&str; 6] = [
    "00 10 11 01",
    "00 20 22 02 10 21 12 01 11",
    "00 30 33 03 10 20 31 32 13 23 01 02 11 21 12 22",
    "00 40 44 04 10 20 30 41 42 43 14 24 34 01 02 03 11 21 31 12 22 32 13 23 33",
    "00 50 55 05 10 20 30 40 51 52 53 54 15 25 35 45 01 02 03 04 11 21 31 41 12 22 32 42 13 23 33 43 14 24 34 44",
    "00 60 66 06 10 20 30 40 50 61 62 63 64 65 16 26 36 46 56 01 02 03 04 05 \
     11 21 31 41 51 12 22 32 42 52 13 23 33 43 53 14 24 34 44 54 15 25 35 45 55",
];

#[test]
fn nodes_have_the_order_of_vtk() {
    for (k, order) in VTK_ORDER.iter().enumerate() {
        let digits = |pair: &str| [0, 1].map(|at| usize::from(pair.as_bytes()[at] - b'0'));
        let order: Vec<[usize; 2]> = order.split_whitespace().map(digits).collect();
        assert_eq!(lagrange_quad_lattice(k + 1), order);
        let n = (k + 1) as f64;
        let expected: Vec<[f64; 2]> = order.iter().map(|ij| ij.map(|i| i as f64 / n)).collect();
        assert_eq!(lagrange_quad_nodes(k + 1), expected);
    }
    assert_eq!(lagrange_quad_nodes(0), lagrange_quad_nodes(1));
}

#[test]
fn fields_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("grid.vtu");
    let mut grid = HighOrderGrid::of_mesh(&io_samples::mesh(), 2);
    let count = grid.points.len();
    let mut refused = |fields: Vec<Field>| {
        grid.point_fields = fields;
        vtu::write_grid(&path, &grid).unwrap_err().to_string()
    };
    let scalar = |name: &str, count| Field::new(name, Kind::Scalar, vec![0.0; count]);
    assert!(refused(vec![scalar("a", count - 1)]).contains("`a` has 107 values instead of 108"));
    assert!(refused(vec![scalar("a", count), scalar("a", count)]).contains("two fields"));
    assert!(refused(vec![scalar("a/b", count)]).contains("name"));
    assert_eq!(names_in(folder.path()).len(), 0);
}

#[test]
fn xdmf_never_replaces_a_file_of_the_pipeline() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = io_samples::mesh();
    let (store, xml) = (folder.path().join("mesh.h5"), folder.path().join("mesh.xdmf"));
    mesh_file::write_mesh(&store, &mesh).unwrap();
    let error = xdmf::write_mesh(&xml, &mesh).unwrap_err();
    assert!(error.exit_code() == 5 && error.to_string().contains("another name"), "{error}");
    assert_eq!(mesh_file::read_mesh(&store).unwrap(), mesh);
    fs::remove_file(&store).unwrap();
    xdmf::write_mesh(&xml, &mesh).unwrap();
    xdmf::write_mesh(&xml, &mesh).unwrap();
    assert_eq!(names_in(folder.path()), ["mesh.h5", "mesh.xdmf"]);
    assert_eq!(xdmf::write_mesh(&folder.path().join("mesh.h5"), &mesh).unwrap_err().exit_code(), 5);
}

#[test]
fn an_unfinished_series_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let grid = io_samples::grid(&io_samples::mesh(), 2, 0.0);
    let path = folder.path().join("series.xdmf");
    let mut series = xdmf::Series::create(&path, &grid).unwrap();
    series.push(0.0, &grid.point_fields, &[]).unwrap();
    assert_eq!(series.push(1.0, &grid.cell_fields, &[]).unwrap_err().exit_code(), 2);
    drop(series);
    assert_eq!(names_in(folder.path()).len(), 0);
    xdmf::Series::create(&path, &grid).unwrap().finish().unwrap();
    assert_eq!(names_in(folder.path()), ["series.h5", "series.xdmf"]);
}

#[test]
fn series_name_their_files_relative_to_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a & b.pvd");
    let files = [(0.0, folder.path().join("grid/x \"1\".vtu")), (1.77e-3, "/elsewhere/y.vtu".into())];
    pvd::write_series(&path, &files).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(r#"timestep="0e0""#) && text.contains(r#"file="grid/x &quot;1&quot;.vtu""#), "{text}");
    assert!(text.contains(r#"timestep="1.77e-3""#) && text.contains(r#"file="/elsewhere/y.vtu""#), "{text}");
}

#[test]
fn tables_keep_every_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines/bottom.csv");
    let values = io_samples::awkward(9);
    let columns: Vec<String> = (0..9).map(|k| format!("c{k}")).collect();
    let mut table = Table::create(&path, &columns.iter().map(String::as_str).collect::<Vec<_>>()).unwrap();
    table.push(&values).unwrap();
    assert_eq!(table.push(&[1.0]).unwrap_err().exit_code(), 5);
    table.flush().unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("c0,c1,c2,c3,c4,c5,c6,c7,c8"));
    let row: Vec<f64> = lines.next().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    assert_eq!(bits(&row), bits(&values));
    assert_eq!(lines.next(), None);
}
