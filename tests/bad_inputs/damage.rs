//! A byte that is changed in any stored file is an error that names the file, never another result.

use super::Bench;
use dgmpm::parts::io::snapshot::{self, Snapshot};
use dgmpm::parts::io::{LoadTable, cloud_file, gmsh, mesh_file, operators_file, points, seal, store::Store};
use dgmpm::{Result, Scene};
use std::path::Path;

/// Places in each kind of file.
const PLACES: usize = 50;

/// Reads a file and gives what is in it, as text.
type Read = fn(&Path) -> Result<String>;

fn shown<T: std::fmt::Debug>(value: T) -> String {
    format!("{value:?}")
}

fn store(path: &Path) -> Result<String> {
    Store::read(path, operators_file::FORMAT).map(shown)
}

fn cloud(path: &Path) -> Result<String> {
    let mesh = mesh_file::read_mesh(&path.with_file_name("mesh_whole.h5"))?;
    cloud_file::read_with(path, &mesh).map(shown)
}

fn geometry(path: &Path) -> Result<String> {
    gmsh::program::look(path).map_err(|(what, remedy)| dgmpm::Error::input(what, remedy))?;
    // Gmsh does not see comments.
    let text = std::fs::read_to_string(path).unwrap();
    Ok(text.lines().filter(|line| !line.starts_with("//")).collect())
}

#[test]
fn a_changed_byte_in_any_stored_file_is_an_error_that_names_it() {
    let bench = Bench::new();
    let load = "t,p\n0,1\n1,2\n";
    std::fs::write(bench.path("load.csv"), load).unwrap();
    let boundary = "boundary.1={group=\"right\",kind=\"pressure\",file=\"load.csv\"}";
    let output = "output=[{kind=\"fields\",at=[1e-4]}]";
    bench.good(&["run", "good.toml", "--set", boundary, "--set", output, "--out", "r"]);
    bench.good(&["export", "r"]);
    let run = bench.path("r");
    std::fs::copy(run.join("mesh.h5"), run.join("mesh_whole.h5")).unwrap();
    std::fs::write(run.join("regrid_0.geo"), seal::text("Point(1) = {0, 0, 0, 1};\n", seal::GEO)).unwrap();
    let (_, last) = snapshot::list(&run.join("snapshots")).unwrap().pop().unwrap();
    std::fs::copy(&last, run.join("snapshot.h5")).unwrap();
    let points_file = std::fs::read_dir(run.join("export")).unwrap().map(|entry| entry.unwrap().path());
    let points_file = points_file.filter(|path| path.extension().is_some_and(|e| e == "vtu"));
    let points_file = points_file.max().unwrap();
    std::fs::copy(points_file, run.join("points.vtu")).unwrap();
    let kinds: [(&str, Read); 8] = [
        ("mesh.h5", |path| mesh_file::read_mesh(path).map(shown)),
        ("cloud.h5", cloud),
        ("operators.h5", store),
        ("snapshot.h5", |path| Snapshot::read(path).map(shown)),
        ("scene.toml", |path| Scene::load(path, &[]).map(|scene| serde_json::to_string(&scene).unwrap())),
        ("points.vtu", |path| points::read_with_fields(path).map(shown)),
        ("boundary_1_file.csv", |path| LoadTable::read(path, 1, "Pa").map(shown)),
        ("regrid_0.geo", geometry),
    ];
    for (name, read) in kinds {
        let path = run.join(name);
        let whole = std::fs::read(&path).unwrap();
        let before = read(&path).unwrap_or_else(|why| panic!("{name}: {why}"));
        let (mut refused, mut state) = (0, 1_u64);
        for _ in 0..PLACES {
            // Knuth's generator of 64 bits.
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let (place, bit) = ((state >> 20) as usize % whole.len(), (state >> 11) % 8);
            let mut bytes = whole.clone();
            bytes[place] ^= 1 << bit;
            std::fs::write(&path, &bytes).unwrap();
            match read(&path) {
                Err(why) => {
                    refused += 1;
                    assert!(why.to_string().contains(name) && why.exit_code() == 2, "{name}, byte {place}: {why}");
                }
                // In the comment of a text, that makes it no seal.
                Ok(after) => assert_eq!(after, before, "{name}, byte {place}, bit {bit}"),
            }
        }
        std::fs::write(&path, &whole).unwrap();
        // The last line of the shortest text, a table of 13 bytes, has 13 bytes of a mark that can be lost, and 64 digits.
        let least = if name.ends_with(".h5") { PLACES } else { PLACES / 2 };
        assert!(refused >= least, "{name}: {refused} of {PLACES}");
    }
}
