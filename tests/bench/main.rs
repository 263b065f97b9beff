//! `dgmpm bench`: its one line, its table, its refusals. Rates are not tested: machines are noisy.

mod flops;

use assert_cmd::Command;

const UNSTRUCTURED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/square_unstructured.msh");
const HOLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/plate_hole.msh");

/// Standard output, or the exit code and the message.
fn dgmpm(arguments: &[&str]) -> Result<String, (i32, String)> {
    let output = Command::cargo_bin("dgmpm").unwrap().args(arguments).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match output.status.code() {
        Some(0) => Ok(text(&output.stdout)),
        code => Err((code.unwrap_or(-1), text(&output.stderr))),
    }
}

fn bench(arguments: &[&str]) -> Result<String, (i32, String)> {
    dgmpm(&[&["bench"], arguments].concat())
}

/// The words of the one line.
fn words(arguments: &[&str]) -> Vec<String> {
    let text = bench(&[arguments, &["--oneline"]].concat()).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    text.split_whitespace().map(str::to_owned).collect()
}

fn error(words: &[String]) -> f64 {
    words[6].strip_prefix("L2err=").unwrap().parse().unwrap()
}

#[test]
fn one_line_has_method_degree_dofs_steps_cpu_rate_and_error() {
    let line = words(&["--method", "rk-dgfem", "--degree", "3", "--cells", "16,4", "--steps", "5"]);
    assert_eq!(line[..4], ["rk-dgfem", "3", "6144", "5"]);
    let cpu: f64 = line[4].parse().unwrap();
    let rate: f64 = line[5].strip_prefix("DoF-updates/s/core=").unwrap().parse().unwrap();
    // Four stages of RK4; the line has four digits of the rate and microseconds of the time.
    assert!((rate * cpu / (6144.0 * 4.0 * 5.0) - 1.0).abs() < 1e-2, "{line:?}");
    assert_eq!(line.len(), 7);
}

#[test]
fn methods_and_kernels_find_the_same_wave() {
    let of = |more: &[&str]| error(&words(&[&["--degree", "2", "--cells", "16,2"], more].concat()));
    let portable = of(&["--method", "ader-dgfem", "--kernel", "portable"]);
    let widest = of(&["--method", "ader-dgfem"]);
    let points = of(&["--method", "ader-dgmpm", "--layout", "gauss"]);
    // Fused or not: the error, 1e-2 of the wave, has rounding of 1e-16 times some hundred steps.
    assert!((portable / widest - 1.0).abs() < 1e-9 && (points / widest - 1.0).abs() < 1e-9);
    assert!(widest < 0.05, "{widest}");
}

#[test]
fn an_unstructured_mesh_is_measured_as_squares_are() {
    let line = words(&["--method", "rk-dgfem", "--degree", "1", "--mesh", UNSTRUCTURED]);
    let squares = words(&["--method", "rk-dgfem", "--degree", "1", "--cells", "32,32"]);
    // About as many cells as 32 x 32, of sizes that differ: the same error to a factor.
    let ratio = error(&line) / error(&squares);
    assert!((0.3..5.0).contains(&ratio), "{line:?} {squares:?}");
    let (code, message) = bench(&["--mesh", HOLE]).unwrap_err();
    assert!(code == 2 && message.contains("plate_hole.msh") && message.contains("rectangle"), "{message}");
}

#[test]
fn the_table_sets_rates_against_the_peaks() {
    let text = bench(&["--method", "ader-dgmpm", "--degree", "1", "--cells", "16,16", "--threads", "2"]).unwrap();
    for word in ["DoF-updates/s/core", "cell-steps/s/core", "particle-steps/s/core", "FMA peak", "triad", "L2 error"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    let predictor = text.lines().find(|line| line.contains("predictor")).unwrap();
    assert!(predictor.contains('%'), "{predictor}");
}

#[test]
fn what_cannot_be_measured_is_refused_with_its_remedy() {
    let cases: [(&[&str], &str); 11] = [
        (&["--kernel", "sse"], "portable"),
        (&["--method", "rk"], "rk-dgfem"),
        (&["--law", "hooke"], "linear-elastic"),
        (&["--layout", "midpoint"], "midpoints"),
        (&["--degree", "7"], "6"),
        (&["--cells", "0,3"], "NX,NY"),
        (&["--cells", "3"], "NX,NY"),
        (&["--threads", "0"], "from 1"),
        (&["--steps", "0"], "from 1"),
        (&["--seconds", "-1"], "above 0"),
        (&["--cells", "100000,100000"], "fewer --cells"),
    ];
    for (arguments, word) in cases {
        let (code, message) = bench(arguments).unwrap_err();
        assert!(code == 2 && message.contains(word), "{arguments:?}: {code} {message}");
    }
}

#[test]
fn run_names_its_kernel_too() {
    let folder = tempfile::tempdir().unwrap();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/manufactured.toml");
    let out = folder.path().join("run").to_string_lossy().into_owned();
    let run = |kernel: &str| {
        let sets = ["--set", "time.end=1e-3", "--set", "mesh.rectangle.cells=[4, 4]", "--force"];
        dgmpm(&[&["run", scene, "--out", &out, "--kernel", kernel], &sets[..]].concat())
    };
    for (name, kernel) in dgmpm::parts::lane::Kernel::NAMES {
        match run(name) {
            Ok(_) => assert!(kernel.is_available(), "{name}"),
            Err((code, message)) => assert!(code == 2 && !kernel.is_available() && message.contains(name), "{message}"),
        }
    }
}
