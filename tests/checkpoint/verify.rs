//! `dgmpm verify`: damage in each kind of file, other bits, and where results say that they come from.

use crate::common::{Bench, copy, flip};
use dgmpm::parts::io::snapshot::{self, Snapshot};
use dgmpm::parts::io::{checkpoint, own};
use std::collections::BTreeMap;
use std::fs;

/// A run with all kinds of files in `r`.
fn whole() -> Bench {
    let bench = Bench::new();
    let table = "t,p\n0,0\n1,0\n";
    fs::write(bench.path("loads.csv"), table).unwrap();
    bench
        .run("run case.toml --out r --threads 1 --set boundary.3={group=\"top\",kind=\"pressure\",file=\"loads.csv\"}");
    bench.run("export r");
    bench
}

#[test]
fn the_first_steps_of_a_whole_run_have_the_same_bits_and_its_files_say_where_they_come_from() {
    let bench = whole();
    let said = bench.run("verify r --threads 2");
    assert!(said.contains("steps done again") && said.contains("the same bits in "), "{said}");
    // The ledger that every run has, of each tenth step.
    bench.run("run case.toml --out plain --set output=[] --set quantity=[]");
    let said = bench.run("verify plain");
    assert!(said.contains("11 steps done again") && said.contains(" 2 rows (1 of the start) of tables"), "{said}");
    let said = bench.run("verify plain --steps 3");
    assert!(said.contains("\n3 steps done again") || said.starts_with("3 steps done again"), "{said}");
    let said = bench.run("verify r --steps 1000");
    assert!(said.contains("0 files") && !said.contains(" 0 rows") && !said.contains(" 0 snapshots"), "{said}");
    let summary: serde_json::Value = serde_json::from_slice(&fs::read(bench.path("r/summary.json")).unwrap()).unwrap();
    let from = &summary["provenance"];
    for key in ["program", "commit", "kernel", "scene_hash", "operators_hash", "mesh_hash", "points_hash", "laws_hash"]
    {
        assert!(from[key].as_str().is_some_and(|text| !text.is_empty()), "{key}: {from}");
    }
    assert_eq!(summary["threads"], 1);
    let (_, first) = snapshot::list(&bench.path("r/snapshots")).unwrap().remove(0);
    let first = Snapshot::read(&first).unwrap().provenance;
    assert_eq!(from["scene_hash"], first.scene);
    assert_eq!(from["kernel"], first.kernel);
    for file in ["grid_000000.vtu", "points_000000.vtu"] {
        assert!(fs::read_to_string(bench.path("r/export").join(file)).unwrap().contains(&first.line()), "{file}");
    }
}

#[test]
fn a_flipped_byte_a_missing_file_and_a_torn_row_are_found_in_each_kind_of_file() {
    let bench = whole();
    let mut kinds = BTreeMap::new();
    for name in own::read(&bench.path("r")).into_iter().filter(|name| bench.path("r").join(name).exists()) {
        let letters: String = name.chars().filter(|c| !c.is_ascii_digit()).collect();
        kinds.insert(letters, name);
    }
    let wanted = ["scene.toml", "mesh.h", "cloud.h", "operators.h", "ledger.csv", "regrid.csv", "summary.json"];
    assert!(wanted.iter().all(|kind| kinds.contains_key(*kind)), "{kinds:?}");
    assert!(kinds.len() >= 20, "{kinds:?}");
    for (number, name) in kinds.values().enumerate() {
        let path = bench.path("r").join(name);
        let bytes = fs::read(&path).unwrap();
        flip(&path, (0.137 + 0.391 * number as f64).fract());
        let message = bench.fail(6, "verify r --steps 0");
        assert!(message.contains("r is not whole") && message.contains(&format!("\n  {name} ")), "{message}");
        fs::write(&path, bytes).unwrap();
    }
    fs::rename(bench.path("r/tracks/walls.csv"), bench.path("walls.csv")).unwrap();
    let message = bench.fail(6, "verify r --steps 0");
    assert!(message.contains("tracks/walls.csv is missing"), "{message}");
    fs::rename(bench.path("walls.csv"), bench.path("r/tracks/walls.csv")).unwrap();
    bench.run("verify r --steps 0");
    // A list of an earlier version has names alone.
    let list = fs::read_to_string(bench.path("r/.dgmpm")).unwrap();
    let names: String = list.lines().map(|line| line.split('\t').next().unwrap().to_owned() + "\n").collect();
    fs::write(bench.path("r/.dgmpm"), names).unwrap();
    bench.run("verify r --steps 0");
    fs::write(bench.path("r/.dgmpm"), list).unwrap();
    // A table of a run that was killed has no hash yet; its rows are looked at.
    let ledger = bench.path("r/ledger.csv");
    own::begin(&ledger).unwrap();
    assert!(bench.run("verify r --steps 0").contains("1 file\n"));
    fs::write(&ledger, fs::read_to_string(&ledger).unwrap() + "7e0,1e").unwrap();
    let message = bench.fail(6, "verify r --steps 0");
    assert!(message.contains("ledger.csv has a row that is not whole"), "{message}");
}

#[test]
fn a_whole_file_under_the_name_of_another_is_found_with_and_without_the_hashes_of_the_list() {
    let bench = Bench::new();
    bench.run("run case.toml --out r");
    bench.run("run case.toml --out s --set material.0.density=7900 --set scheme.degree=1");
    let list = fs::read_to_string(bench.path("r/.dgmpm")).unwrap();
    let names: String = list.lines().map(|line| line.split('\t').next().unwrap().to_owned() + "\n").collect();
    let snapshots = snapshot::list(&bench.path("r/snapshots")).unwrap();
    let [one, two] =
        [1, 2].map(|k: usize| format!("snapshots/{}", snapshots[k].1.file_name().unwrap().to_str().unwrap()));
    let checkpoints = checkpoint::list(&bench.path("r/checkpoints")).unwrap();
    let kept = |k: usize| format!("checkpoints/{}", checkpoints[k].1.file_name().unwrap().to_str().unwrap());
    let cases = [
        (format!("r/{one}"), two.clone(), "is of another step"),
        (format!("r/{}", kept(0)), kept(1), "is of another step"),
        ("r/mesh.h5".to_owned(), "cloud.h5".to_owned(), "is a file of another kind"),
        ("r/cloud.h5".to_owned(), "operators.h5".to_owned(), "is a file of another kind"),
        (format!("r/{one}"), kept(0), "is a file of another kind"),
        ("s/operators.h5".to_owned(), "operators.h5".to_owned(), "is not of this run"),
        ("s/summary.json".to_owned(), "summary.json".to_owned(), "is not of this run"),
        ("s/snapshots/000000.h5".to_owned(), "snapshots/000000.h5".to_owned(), "is not of this run"),
    ];
    for (from, to, words) in cases {
        let path = bench.path("r").join(&to);
        let bytes = fs::read(&path).unwrap();
        fs::copy(bench.path(&from), &path).unwrap();
        let message = bench.fail(6, "verify r --steps 0");
        assert!(message.contains(&format!("\n  {to} ")), "{from} as {to}: {message}");
        // A list of names alone: what files say of themselves has to do.
        fs::write(bench.path("r/.dgmpm"), &names).unwrap();
        let message = bench.fail(6, "verify r --steps 0");
        assert!(message.contains(&format!("\n  {to} {words}")), "{from} as {to}: {message}");
        fs::write(bench.path("r/.dgmpm"), &list).unwrap();
        fs::write(&path, bytes).unwrap();
    }
    bench.run("verify r --steps 0");
    fs::remove_file(bench.path("r").join(kept(1))).unwrap();
    let message = bench.fail(6, "verify r --steps 0");
    assert!(message.contains(&format!("{} is missing", kept(1))), "{message}");
}

/// The list of the folder is no help here: its line is gone, too.
#[test]
fn a_snapshot_that_the_run_has_made_and_that_is_gone_with_its_line_is_named() {
    let bench = Bench::new();
    bench.run("run case.toml --out r");
    let snapshots = snapshot::list(&bench.path("r/snapshots")).unwrap();
    // One of the first steps, which verify does again.
    let (step, path) = &snapshots[1];
    let name = format!("snapshots/{}", path.file_name().unwrap().to_str().unwrap());
    let list = fs::read_to_string(bench.path("r/.dgmpm")).unwrap();
    let kept: String = list.split_inclusive('\n').filter(|line| !line.starts_with(&name)).collect();
    fs::write(bench.path("r/.dgmpm"), kept).unwrap();
    fs::remove_file(path).unwrap();
    let message = bench.fail(6, &format!("verify r --steps {}", step + 1));
    assert!(message.contains(&format!("the snapshot of step {step} is missing")), "{message}");
}

#[test]
fn a_run_that_was_extended_after_few_steps_is_repeated_as_it_was() {
    let bench = Bench::new();
    bench.run("run case.toml --out r --set time.end=9e-6 --set regrid=[] --set quantity=[]");
    let first = snapshot::list(&bench.path("r/snapshots")).unwrap().pop().unwrap().0;
    bench.run("resume r --set time.end=2.1e-5");
    bench.run("resume r --set time.end=5e-5");
    let said = bench.run("verify r --steps 1000");
    assert!(!said.contains("note:"), "all of it: {said}");
    assert!(first < 10, "the first end lies before what is repeated: {first}");
    // The record of its ends is in the checkpoints of a run that was killed, too.
    let summary = fs::read_to_string(bench.path("r/summary.json")).unwrap();
    fs::remove_file(bench.path("r/summary.json")).unwrap();
    own::begin(&bench.path("r/summary.json")).unwrap();
    bench.run("verify r");
    assert!(summary.contains("\"ends\""), "{summary}");
    let message = bench.fail(2, "resume r --set time.end=2e-5");
    assert!(message.contains("beyond the end 2e-5 s that is asked for"), "{message}");
}

#[test]
fn other_bits_and_folders_that_are_no_run_are_told() {
    let bench = Bench::new();
    bench.run("run case.toml --out r");
    copy(&bench.path("r"), &bench.path("other"));
    let ledger = bench.path("other/ledger.csv");
    let text = fs::read_to_string(&ledger).unwrap();
    // The last digit of the kinetic energy after some steps, in a ledger that is whole by its hash.
    let row = text.lines().nth(4).unwrap();
    let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
    cells[3] = format!("{:e}", f64::from_bits(cells[3].parse::<f64>().unwrap().to_bits() ^ 1));
    let text = text.replace(row, &cells.join(","));
    fs::write(&ledger, &text).unwrap();
    own::finish(&ledger, &blake3::hash(text.as_bytes())).unwrap();
    let message = bench.fail(6, "verify other --steps 10");
    assert!(message.contains("other bits") && message.contains("ledger.csv differs from line 5 on"), "{message}");
    let message = bench.fail(2, "verify case.toml");
    assert!(message.contains("is not the folder of a run"), "{message}");
    fs::remove_file(bench.path("other/.dgmpm")).unwrap();
    let message = bench.fail(2, "verify other");
    assert!(message.contains("it holds no .dgmpm"), "{message}");
    let message = bench.fail(2, "run case.toml --out other --force");
    assert!(
        message.contains("as runs of earlier versions") && message.contains("remove this one yourself"),
        "{message}"
    );
}

/// The figure of docs/reliability.md: `cargo test --release --test checkpoint -- --ignored --nocapture seal_costs`.
#[test]
#[ignore = "a measurement"]
fn what_the_seal_costs_beside_reading_a_snapshot_of_a_million_unknowns() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("000000.h5");
    let cells = 1_000_000 / 54;
    let u = (0..54 * cells).map(|k| 1.0 + 1e-3 * (k as f64 * 1e-3).sin()).collect();
    Snapshot { degree: 2, u, ..Snapshot::default() }.write(&path).unwrap();
    let best = |run: &dyn Fn()| {
        let seconds = (0..20).map(|_| {
            let start = std::time::Instant::now();
            run();
            start.elapsed().as_secs_f64()
        });
        seconds.fold(f64::INFINITY, f64::min)
    };
    let seal = best(&|| assert_eq!(dgmpm::parts::io::seal::check(&path).unwrap(), dgmpm::parts::io::seal::Seal::Whole));
    let read = best(&|| drop(Snapshot::read(&path).unwrap()));
    let bytes = fs::metadata(&path).unwrap().len();
    println!("{bytes} bytes: seal {:.1} ms of {:.1} ms", 1e3 * seal, 1e3 * read);
    assert!(seal < 0.3 * read, "the seal is small beside reading");
}
