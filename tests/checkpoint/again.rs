//! `dgmpm run --resume`: the same command begins a run, goes on with it, and is content with one that is done.

use crate::common::{Bench, assert_same};
use dgmpm::parts::io::checkpoint;
use std::fs;

#[test]
fn the_same_command_begins_goes_on_and_ends() {
    let bench = Bench::new();
    let command = "run case.toml --out r --resume --threads 2";
    bench.run("run case.toml --out whole");
    bench.run(command);
    assert_same("begun", &bench.path("whole"), &bench.path("r"));
    let newest = checkpoint::list(&bench.path("r/checkpoints")).unwrap();
    // Stopped before its end.
    fs::remove_file(&newest[1].1).unwrap();
    fs::remove_file(bench.path("r/summary.json")).unwrap();
    let said = bench.run(command);
    assert!(said.contains(&format!("resumed at step {}", newest[0].0)), "{said}");
    assert_same("went on", &bench.path("whole"), &bench.path("r"));
    let said = bench.run(command);
    assert!(said.contains("r has this run, done at 1.2"), "{said}");
    assert_same("done", &bench.path("whole"), &bench.path("r"));
    let said = bench.run(&format!("{command} --set time.end=6e-5"));
    assert!(said.contains("later than the end 6.0") && said.contains("nothing is done"), "{said}");
    // Killed behind the checkpoint of the end, and before the last rows.
    let ledger = bench.path("r/ledger.csv");
    let rows = fs::read_to_string(&ledger).unwrap();
    let last = rows.trim_end().rfind('\n').unwrap() + 1;
    for command in [command, "resume r"] {
        fs::write(&ledger, &rows[..last]).unwrap();
        fs::remove_file(bench.path("r/summary.json")).unwrap();
        bench.run(command);
        assert_same("the end", &bench.path("whole"), &bench.path("r"));
    }
    // Killed before the first checkpoint: there is nothing to go on from.
    fs::remove_dir_all(bench.path("r/checkpoints")).unwrap();
    fs::remove_file(bench.path("r/summary.json")).unwrap();
    bench.run(command);
    assert_same("begun again", &bench.path("whole"), &bench.path("r"));
    let said = bench.run(&format!("{command} --set time.end=1.3e-4"));
    assert!(said.contains("resumed at step"), "{said}");
    bench.run("verify r --steps 3");
}

#[test]
fn a_run_of_another_scene_or_mesh_stays_as_it_is() {
    let bench = Bench::new();
    bench.run("mesh rectangle --size 1,0.5 --cells 4,2 --out body.h5");
    let scene = crate::common::SCENE
        .replace("mesh.rectangle = { size = [1.0, 0.5], cells = [4, 2] }", "mesh.file = \"body.h5\"");
    fs::write(bench.path("case.toml"), scene).unwrap();
    let command = "run case.toml --out r --resume";
    bench.run(command);
    let before = crate::common::results(&bench.path("r"));
    for (set, words) in [
        ("--set material.0.density=2700", "r has a run of another scene: `materials.0.law"),
        ("--set mesh={rectangle={size=[1.0,0.5],cells=[4,2]}}", "r has a run of another scene: `mesh"),
        ("--set cloud.layout=\"random\"", "r has a run of another scene: `cloud"),
    ] {
        let message = bench.fail(2, &format!("{command} {set}"));
        assert!(message.contains(words), "{set}: {message}");
    }
    bench.run("mesh rectangle --size 1,0.5 --cells 2,4 --out body.h5 --force");
    let message = bench.fail(2, command);
    assert!(message.contains("not what the run in r began with: its mesh.h5 differs"), "{message}");
    assert!(crate::common::results(&bench.path("r")) == before, "nothing was changed");
    let message = bench.fail(2, "run case.toml --out r");
    assert!(message.contains("holds results of an earlier run"), "{message}");
    let changed = fs::read_to_string(bench.path("r/scene.toml")).unwrap().replace("small impact", "mine");
    fs::write(bench.path("r/scene.toml"), changed).unwrap();
    let message = bench.fail(2, "run r/scene.toml --out s");
    assert!(message.contains("remove the last line, which has the hash, or give --trust"), "{message}");
    bench.run("run r/scene.toml --out s --trust --set regrid=[] --set output=[] --set quantity=[]");
}
