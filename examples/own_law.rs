//! A law of your own: compressible Mooney-Rivlin, added to the registry, named by a scene, run and exported.
//!
//! `cargo run --release --example own_law` writes runs/own_law; open its export/grid.pvd in ParaView.

use dgmpm::registry::{ANY, Entry, Form, LAWS, POSITIVE, Parameter};
use dgmpm::{Export, Folder, Lane, Law, Material, Past, Problem, Result, Scene, tensor};

/// W = c1 (J^(-2/3) I1 - 3) + c2 (J^(-4/3) I2 - 3) + kappa/2 (J - 1)^2 in plane strain: with i = F:F, I1 = i + 1 and I2 = i + J^2.
#[derive(Debug, Clone, Copy)]
struct MooneyRivlin {
    c1: f64,
    c2: f64,
    kappa: f64,
    density: f64,
}

impl MooneyRivlin {
    /// J, i = F:F, dW/di, dW/dJ, d2W/didJ, d2W/dJ2.
    #[inline(always)]
    fn terms<L: Lane>(&self, f: [L; 4]) -> [L; 6] {
        let number = L::splat;
        let (j, i) = (tensor::det(f), f[0] * f[0] + f[1] * f[1] + f[2] * f[2] + f[3] * f[3]);
        let root = j.inverse_cube_root();
        let (inverse, a) = (root * root * root, number(self.c1) * root * root);
        let b = number(self.c2) * root * root * root * root;
        let (one, two) = (i + number(1.0), i + j * j);
        let third = number(1.0 / 3.0) * inverse;
        let slope = number(-2.0) * third * (a * one + number(2.0) * b * two) + number(2.0) * b * j;
        let curvature = third * third * (number(10.0) * a * one + number(28.0) * b * two) - number(10.0 / 3.0) * b;
        let kappa = number(self.kappa);
        let mixed = number(-2.0) * third * (a + number(2.0) * b);
        [j, i, a + b, slope + kappa * (j - number(1.0)), mixed, curvature + kappa]
    }
}

impl Material for MooneyRivlin {
    type History<L: Lane> = [L; 0];

    fn density(&self) -> f64 {
        self.density
    }

    fn shear_modulus(&self) -> f64 {
        2.0 * (self.c1 + self.c2)
    }

    /// P = 2 dW/di F + dW/dJ cof F.
    #[inline(always)]
    fn stress<L: Lane>(&self, f: [L; 4], _: &mut Past<[L; 0]>) -> [L; 4] {
        let ([_, _, by_i, by_j, _, _], g) = (self.terms(f), tensor::cofactor(f));
        let a = L::splat(2.0) * by_i;
        [a * f[0] + by_j * g[0], a * f[1] + by_j * g[1], a * f[2] + by_j * g[2], a * f[3] + by_j * g[3]]
    }

    #[inline(always)]
    fn stress33<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        // The derivative by F33 at F33 = 1: of I1 it is 2, of I2 it is 2 i, of J it is J; dW/dJ has 2 c2 J^(-1/3) of I2 at fixed F33.
        let [j, i, _, by_j, _, _] = self.terms(f);
        let root = j.inverse_cube_root();
        let b = L::splat(self.c2) * root * root * root * root;
        let two = L::splat(2.0);
        two * L::splat(self.c1) * root * root + two * b * i + j * (by_j - two * b * j)
    }

    #[inline(always)]
    fn energy<L: Lane>(&self, f: [L; 4], _: &Past<[L; 0]>) -> L {
        let [j, i, ..] = self.terms(f);
        let (root, one) = (j.inverse_cube_root(), L::splat(1.0));
        let (square, change) = (root * root, j - one);
        L::splat(self.c1) * (square * (i + one) - L::splat(3.0))
            + L::splat(self.c2) * (square * square * (i + j * j) - L::splat(3.0))
            + L::splat(0.5 * self.kappa) * change * change
    }

    /// B = 2 dW/di 1 + 2 d2W/didJ (FN gN + gN FN) + d2W/dJ2 gN gN, g = cof F.
    #[inline(always)]
    fn acoustic<L: Lane>(&self, f: [L; 4], n: [L; 2]) -> [L; 3] {
        let [_, _, by_i, _, mixed, curvature] = self.terms(f);
        let (fn_, gn, two) = (tensor::times(f, n), tensor::times(tensor::cofactor(f), n), L::splat(2.0));
        let entry = |i: usize, k: usize| two * mixed * (fn_[i] * gn[k] + gn[i] * fn_[k]) + curvature * gn[i] * gn[k];
        [two * by_i + entry(0, 0), entry(0, 1), two * by_i + entry(1, 1)]
    }
}

const SCENE: &str = r#"
[mesh]
rectangle = { size = [0.1, 0.1], cells = [20, 20] }
[[material]]
law = "mooney-rivlin"
c1 = 3e5
c2 = 1e5
kappa = 2e7
density = 1100.0
[initial]
velocity = ["-20", "0"]
[[boundary]]
group = "left"
kind = "wall"
[[boundary]]
group = "right"
kind = "free"
[[boundary]]
group = "top"
kind = "free"
[[boundary]]
group = "bottom"
kind = "symmetry"
[scheme]
method = "ader-dgmpm"
degree = 2
[time]
end = 2e-3
[[output]]
kind = "fields"
every = 2e-4
"#;

const fn modulus(name: &'static str, about: &'static str) -> Parameter {
    Parameter::required(name, about, "Pa", Form::Number(POSITIVE))
}

const PARAMETERS: &[Parameter] = &[
    modulus("c1", "half of the shear modulus that comes with I1"),
    modulus("c2", "half of the shear modulus that comes with I2"),
    modulus("kappa", "bulk modulus"),
    Parameter::required("density", "rho0, in the initial configuration", "kg/m^3", Form::Number(POSITIVE)),
];

fn main() -> Result<()> {
    LAWS.add(Entry {
        name: "mooney-rivlin",
        about: "compressible Mooney-Rivlin, finite strain, in plane strain",
        parameters: PARAMETERS,
        check: ANY,
        build: |of| {
            let [c1, c2, kappa, density] = ["c1", "c2", "kappa", "density"].map(|name| of.number(name));
            Law::new(MooneyRivlin { c1, c2, kappa, density })
        },
    })?;
    let folder = Folder::new("runs/own_law".as_ref());
    let report = Problem::new(&Scene::parse(SCENE, "own_law.toml".as_ref(), &[])?)?.run_in(&folder)?;
    Export::new(&folder)?.vtu()?;
    println!(
        "{} steps, energy {:.4} of the start, pictures in runs/own_law/export",
        report.steps,
        report.energy_ratio()
    );
    Ok(())
}
