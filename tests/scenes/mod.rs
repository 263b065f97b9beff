//! Scenes of tests: a free body of steel, of which a test says only what differs.
#![allow(dead_code)] // each test file uses its part

use dgmpm::parts::problem::Problem;
use dgmpm::parts::scene::Scene;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// E (Pa), nu and rho0 (kg/m^3) of steel.
pub const STEEL: [f64; 3] = [2e11, 0.3, 7800.0];
/// Velocities that look like noise, of 5 mm/s.
pub const NOISE: [&str; 2] = ["5e-3*sin(43758.5*sin(17*x+53*y+0.3))", "5e-3*sin(43758.5*sin(31*x+47*y+0.7))"];
/// The groups of the sides of a rectangle.
pub const SIDES: [&str; 4] = ["left", "right", "bottom", "top"];

/// A scene under construction.
#[derive(Clone, Default)]
pub struct Body {
    mesh: String,
    materials: Vec<String>,
    /// Group and condition of each boundary.
    sides: Vec<[String; 2]>,
    initial: String,
    /// Keys and values of the table `[scheme]`.
    scheme: Vec<[String; 2]>,
    time: String,
    more: String,
}

impl Body {
    /// A free rectangle, m, of so many cells.
    pub fn rectangle(size: [f64; 2], cells: [usize; 2]) -> Self {
        let mesh = format!("rectangle = {{ size = {size:?}, cells = {cells:?} }}");
        Self { mesh, ..Self::default() }.sides("free")
    }

    /// A free unit square of n x n cells.
    pub fn square(n: usize) -> Self {
        Self::rectangle([1.0; 2], [n; 2])
    }

    /// A body on a mesh file, without conditions.
    pub fn of_file(path: &Path) -> Self {
        Self::default().mesh_file(path)
    }

    /// The smooth nonlinear motion of a square of n x n cells between frictionless walls, by RK-DGFEM S2 to .15 ms.
    pub fn smooth_box(n: usize) -> Self {
        let velocity = ["300*sin(pi*x)*cos(pi*y)", "-150*cos(pi*x)*sin(pi*y)"];
        Self::square(n).sides("wall").velocity(velocity).method("rk-dgfem").degree(2).end(1.5e-4)
    }

    /// On a mesh file instead.
    pub fn mesh_file(self, path: &Path) -> Self {
        Self { mesh: format!("file = {path:?}"), ..self }
    }

    /// One more material by E, nu and rho0; `more`: further lines of its table. Without any it is neo-Hookean steel.
    pub fn material(mut self, law: &str, [young, poisson, density]: [f64; 3], more: &str) -> Self {
        let numbers = format!("young = {young:e}\npoisson = {poisson}\ndensity = {density}");
        self.materials.push(format!("law = \"{law}\"\n{numbers}\n{more}"));
        self
    }

    /// The kind of condition at all four sides of a rectangle.
    pub fn sides(self, kind: &str) -> Self {
        SIDES.iter().fold(self, |body, side| body.side(side, kind, ""))
    }

    /// The condition of a group; `more`: further lines of its table.
    pub fn side(mut self, group: &str, kind: &str, more: &str) -> Self {
        set(&mut self.sides, group, format!("kind = \"{kind}\"\n{more}"));
        self
    }

    /// The initial velocity, m/s, instead of what was said of the start.
    pub fn velocity(self, components: [&str; 2]) -> Self {
        self.initial(&format!("velocity = {components:?}"))
    }

    /// The table `[initial]`.
    pub fn initial(self, lines: &str) -> Self {
        Self { initial: lines.to_owned(), ..self }
    }

    /// The method.
    pub fn method(self, name: &str) -> Self {
        self.scheme("method", &format!("\"{name}\""))
    }

    /// N = N_T.
    pub fn degree(self, degree: usize) -> Self {
        self.scheme("degree", &degree.to_string())
    }

    /// A key of the table `[scheme]`.
    pub fn scheme(mut self, key: &str, value: &str) -> Self {
        set(&mut self.scheme, key, value.to_owned());
        self
    }

    /// The end, s.
    pub fn end(self, end: f64) -> Self {
        self.time(&format!("end = {end:e}"))
    }

    /// The table `[time]`.
    pub fn time(self, lines: &str) -> Self {
        Self { time: lines.to_owned(), ..self }
    }

    /// A ledger with a row each so many steps.
    pub fn ledger(self, every_steps: usize) -> Self {
        self.table("[output]", &format!("kind = \"ledger\"\nevery_steps = {every_steps}"))
    }

    /// One more table: `head` is such as `curl`, or `[output]` for one of several.
    pub fn table(mut self, head: &str, lines: &str) -> Self {
        writeln!(self.more, "[{head}]\n{lines}").unwrap();
        self
    }

    /// The text.
    pub fn text(&self) -> String {
        let mut text = format!("[mesh]\n{}\n", self.mesh);
        let steel = Self::default().material("neo-hookean", STEEL, "").materials;
        let materials = if self.materials.is_empty() { &steel } else { &self.materials };
        materials.iter().for_each(|material| writeln!(text, "[[material]]\n{material}").unwrap());
        writeln!(text, "[initial]\n{}", self.initial).unwrap();
        let sides = self.sides.iter();
        sides.for_each(|[group, condition]| writeln!(text, "[[boundary]]\ngroup = \"{group}\"\n{condition}").unwrap());
        let scheme: String = self.scheme.iter().map(|[key, value]| format!("{key} = {value}\n")).collect();
        write!(text, "[scheme]\n{scheme}[time]\n{}\n{}", self.time, self.more).unwrap();
        text
    }

    /// Writes it as `<name>.toml` into a folder, which is made.
    pub fn write(&self, folder: &Path, name: &str) -> PathBuf {
        std::fs::create_dir_all(folder).unwrap();
        let path = folder.join(format!("{name}.toml"));
        std::fs::write(&path, self.text()).unwrap();
        path
    }

    /// The scene with overrides.
    pub fn scene(&self, sets: &[&str]) -> Scene {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        Scene::parse(&self.text(), Path::new("test.toml"), &sets).unwrap()
    }

    /// The problem of the scene with overrides.
    pub fn problem(&self, sets: &[&str]) -> Problem {
        Problem::new(&self.scene(sets)).unwrap()
    }
}

/// Gives a key a value, the last one said.
fn set(pairs: &mut Vec<[String; 2]>, key: &str, value: String) {
    match pairs.iter_mut().find(|[known, _]| known == key) {
        Some([_, old]) => *old = value,
        None => pairs.push([key.to_owned(), value]),
    }
}

/// The folder of the scenes of a test file.
pub fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}
