//! Python for tests: `$DGMPM_PYTHON`, else `.venv/bin/python`; DOLFINx under `$DGMPM_DOLFINX_PYTHON`, else
//! `/usr/bin/python3`. Without them a test prints a line that says so, or fails where `DGMPM_REQUIRE_PYTHON=1`
//! (for DOLFINx: where `DGMPM_DOLFINX_PYTHON` names one).

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{LazyLock, Mutex};

/// The project's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A Python with the packages of `tools/requirements.txt`; `None` (and a line) where the test is to be skipped.
pub fn python() -> Option<PathBuf> {
    let here = root().join(".venv/bin/python");
    let named = std::env::var_os("DGMPM_PYTHON").map(PathBuf::from);
    let found = named.or_else(|| here.exists().then_some(here));
    if found.is_none() {
        let why = "no Python: set DGMPM_PYTHON, or make .venv by `make setup`";
        assert!(std::env::var("DGMPM_REQUIRE_PYTHON").as_deref() != Ok("1"), "{why}");
        println!("SKIP: {why}");
    }
    found
}

/// Runs a script under a Python with DOLFINx, as [`run`]; without one it prints a line and is false. One at a time: DOLFINx compiles
/// into a cache that all of its processes share.
pub fn run_dolfinx<I: AsRef<OsStr>>(script: &str, arguments: impl IntoIterator<Item = I>) -> bool {
    static ONE: Mutex<()> = Mutex::new(());
    let Some(python) = dolfinx() else { return false };
    let _alone = ONE.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    run(&python, script, arguments);
    true
}

/// A Python with DOLFINx, if there is one.
fn dolfinx() -> Option<PathBuf> {
    static FOUND: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
        let named = std::env::var_os("DGMPM_DOLFINX_PYTHON");
        let python = PathBuf::from(named.clone().unwrap_or_else(|| "/usr/bin/python3".into()));
        let probe = Command::new(&python).args(["-c", "import dolfinx, h5py"]).output();
        let there = probe.is_ok_and(|probe| probe.status.success());
        assert!(there || named.is_none(), "DGMPM_DOLFINX_PYTHON: `{}` has no DOLFINx or no h5py", python.display());
        there.then_some(python)
    });
    if FOUND.is_none() {
        println!("SKIP: no DOLFINx: install python3-dolfinx-real and python3-h5py, or set DGMPM_DOLFINX_PYTHON");
    }
    FOUND.clone()
}

/// Runs a script of the project, shows what it prints, and returns that; it must succeed.
pub fn run<I: AsRef<OsStr>>(python: &Path, script: &str, arguments: impl IntoIterator<Item = I>) -> String {
    let output = Command::new(python).arg(root().join(script)).args(arguments).current_dir(root()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    println!("{text}");
    assert!(output.status.success(), "{script} failed:\n{text}\n{}", String::from_utf8_lossy(&output.stderr));
    text
}
