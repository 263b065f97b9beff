//! Damaged checkpoints, other scenes, corrupted bytes.

use crate::common::{Bench, assert_same, copy, flip};
use dgmpm::parts::io::checkpoint;
use std::fs;
use std::path::PathBuf;

/// A run that is done, without its last checkpoint.
fn stopped(bench: &Bench, name: &str) -> Vec<PathBuf> {
    bench.run(&format!("run case.toml --out {name}"));
    checkpoint::list(&bench.path(name).join("checkpoints")).unwrap().into_iter().map(|(_, path)| path).collect()
}

#[test]
fn a_damaged_checkpoint_gives_way_to_the_one_before() {
    let bench = Bench::new();
    let kept = stopped(&bench, "r");
    copy(&bench.path("r"), &bench.path("whole"));
    flip(&kept[1], 0.4);
    let said = bench.run("resume r");
    assert!(said.contains("warning: ") && said.contains("the file is damaged"), "{said}");
    assert_same("older", &bench.path("whole"), &bench.path("r"));
    for path in checkpoint::list(&bench.path("r/checkpoints")).unwrap() {
        fs::write(path.1, "").unwrap();
    }
    let message = bench.fail(2, "resume r");
    assert!(message.contains("r holds no whole checkpoint"), "{message}");
}

#[test]
fn another_scene_is_refused_with_the_key_that_differs() {
    let bench = Bench::new();
    let kept = stopped(&bench, "r");
    fs::remove_file(&kept[1]).unwrap();
    for (set, words) in [
        ("material.0.young=1e11", "materials.0.law"),
        ("scheme.safety=0.5", "scheme.step.safety"),
        ("output.1.every_steps=2", "outputs.1.when"),
        ("boundary.3.kind=clamped", "boundaries.3.condition"),
    ] {
        let message = bench.fail(2, &format!("resume r --set {set}"));
        assert!(message.contains("the checkpoint is of another scene: `") && message.contains(words), "{message}");
    }
    let message = bench.fail(2, "resume case.toml");
    assert!(message.contains("is not the folder of a run"), "{message}");
    fs::write(bench.path("r/ledger.csv"), "step,t\n").unwrap();
    let message = bench.fail(2, "resume r");
    assert!(message.contains("ledger.csv has lost or changed rows"), "{message}");
}

#[test]
fn a_flipped_byte_in_a_stored_file_is_found_or_does_no_harm() {
    let bench = Bench::new();
    let kept = stopped(&bench, "whole");
    fs::remove_file(&kept[1]).unwrap();
    let last = kept[0].file_name().unwrap().to_str().unwrap().to_owned();
    // `make faults` does two hundred.
    let files = ["mesh.h5", "cloud.h5", "operators.h5", "scene.toml", "ledger.csv", &format!("checkpoints/{last}")];
    for (number, file) in files.into_iter().flat_map(|file| [file; 2]).enumerate() {
        let share = (0.137 + 0.391 * number as f64).fract();
        copy(&bench.path("whole"), &bench.path("r"));
        flip(&bench.path("r").join(file), share);
        let output = bench.output("resume r");
        let errors = String::from_utf8_lossy(&output.stderr);
        match output.status.code() {
            Some(0) => {
                // A flipped byte of a comment or a title stays in the scene.
                fs::copy(bench.path("whole").join(file), bench.path("r").join(file)).unwrap();
                let mut lists = ["whole", "r"].map(|run| crate::common::results(&bench.path(run)));
                lists.iter_mut().for_each(|list| drop(list.remove("summary.json")));
                assert!(lists[0] == lists[1], "{file} at {share}: a wrong result");
            }
            Some(2) => assert!(errors.contains("error: "), "{file}: {errors}"),
            other => panic!("{file} at {share}: {other:?} {errors}"),
        }
        fs::remove_dir_all(bench.path("r")).unwrap();
    }
}
