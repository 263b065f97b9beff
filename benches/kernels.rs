//! Single kernels on eight cells, `cargo bench`: laws, wave speeds, fluxes, whole steps of a mesh in the cache; and the
//! location of a million points.
//! (Seconds of the phases inside of a step are what `dgmpm bench` prints.)

use dgmpm::parts::bench::{Domain, Setup};
use dgmpm::parts::cloud::{Locator, Pattern, from_points};
use dgmpm::parts::lane::{F8, Kernel, Lanes, Work, load_array, store_array};
use dgmpm::parts::material::{LinearElastic, Material, NeoHookean, Past, virgin};
use dgmpm::parts::mesh::map;
use dgmpm::parts::problem::Problem;
use dgmpm::parts::riemann::{Acoustic, AcousticCurl, Medium, Riemann, Rusanov, Trace};
use dgmpm::parts::step::Motion;
use dgmpm::registry::Method;
use divan::{Bencher, black_box, counter::ItemsCount};

/// Points of eight cells that one call treats: the fields of a block of degree 3 fit the first cache.
const POINTS: usize = 16;

fn main() {
    // One thread, this one: divan's benches run here, and nothing is handed over.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
    pool.expect("no threads have been started before");
    divan::main();
}

/// Deformation gradients near 1.
fn deformations() -> Vec<F8> {
    (0..4 * POINTS).map(|k| F8::splat(if k % 4 == 0 || k % 4 == 3 { 0.95 } else { 0.02 * (k % 5) as f64 })).collect()
}

struct Stress<'a, M>(&'a M, &'a [F8], &'a mut [F8]);
impl<M: Material> Work for Stress<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for (f, out) in self.1.as_chunks::<4>().0.iter().zip(self.2.as_chunks_mut::<4>().0) {
            store_array(self.0.stress(load_array::<L, 4>(f), &mut Past::now(virgin::<L, M>())), out);
        }
    }
}

struct Speeds<'a, M>(&'a M, &'a [F8], &'a mut [F8]);
impl<M: Material> Work for Speeds<'_, M> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for (f, out) in self.1.as_chunks::<4>().0.iter().zip(self.2.as_chunks_mut::<4>().0) {
            store_array(self.0.largest_squares(load_array::<L, 4>(f), &virgin::<L, M>()), out);
        }
    }
}

struct Fluxes<'a, R>(&'a R, &'a [F8], &'a mut [F8]);
impl<R: Riemann> Work for Fluxes<'_, R> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let n = [L::splat(0.6), L::splat(0.8)];
        let speeds = [L::splat(5875.0), L::splat(3140.0)];
        let medium = Medium::new(7800.0, 2e11 / 2.6, 2).splat::<L>();
        for (f, out) in self.1.as_chunks::<4>().0.iter().zip(self.2.as_chunks_mut::<6>().0) {
            let f = load_array::<L, 4>(f);
            let minus = Trace { f, v: [f[1], f[2]], t: [f[0], f[3]], c: speeds };
            let plus = Trace { f, v: [f[2], f[1]], t: [f[3], f[0]], c: speeds };
            store_array(self.0.flux(&minus, &plus, n, &medium), out);
        }
    }
}

#[divan::bench]
fn stress_neo_hookean(bencher: Bencher) {
    let (law, f) = (NeoHookean::new(2e11, 0.3, 7800.0), deformations());
    bencher.counter(ItemsCount::new(8 * POINTS)).with_inputs(|| f.clone()).bench_local_refs(|out| {
        Kernel::widest().run(Stress(&law, black_box(&f), out));
    });
}

#[divan::bench]
fn stress_linear_elastic(bencher: Bencher) {
    let (law, f) = (LinearElastic::new(2e11, 0.3, 7800.0), deformations());
    bencher.counter(ItemsCount::new(8 * POINTS)).with_inputs(|| f.clone()).bench_local_refs(|out| {
        Kernel::widest().run(Stress(&law, black_box(&f), out));
    });
}

#[divan::bench]
fn largest_speeds_neo_hookean(bencher: Bencher) {
    let (law, f) = (NeoHookean::new(2e11, 0.3, 7800.0), deformations());
    bencher.counter(ItemsCount::new(8 * POINTS)).with_inputs(|| f.clone()).bench_local_refs(|out| {
        Kernel::widest().run(Speeds(&law, black_box(&f), out));
    });
}

/// One flux on all points.
fn flux<R: Riemann>(bencher: Bencher, riemann: &R) {
    let f = deformations();
    let out = || vec![F8::ZERO; 6 * POINTS];
    bencher.counter(ItemsCount::new(8 * POINTS)).with_inputs(out).bench_local_refs(|out| {
        Kernel::widest().run(Fluxes(riemann, black_box(&f), out));
    });
}

#[divan::bench]
fn flux_rusanov(bencher: Bencher) {
    flux(bencher, &Rusanov);
}

#[divan::bench]
fn flux_acoustic(bencher: Bencher) {
    flux(bencher, &Acoustic);
}

#[divan::bench]
fn flux_acoustic_curl(bencher: Bencher) {
    flux(bencher, &AcousticCurl);
}

/// A step and its survey of 8 x 8 cells: 8 blocks, all in the cache.
fn step(bencher: Bencher, method: Method, layout: Option<&str>, degree: usize) {
    let layout = layout.map(str::to_owned);
    let (domain, law, kernel) = (Domain::Cells([8, 8]), "neo-hookean".to_owned(), Kernel::widest());
    let setup = Setup { method, degree, domain, layout, law, kernel, sets: vec![] };
    let subject = setup.build().expect("the wave on a lattice is a valid problem");
    let (Problem { scheme, state: start, settings, .. }, h) = (subject.problem, subject.h);
    let mut motion = Motion::new(&scheme, start).expect("the wave is healthy");
    let dt = settings.courant * h / motion.survey.fastest;
    bencher.counter(ItemsCount::new(64_usize)).bench_local(|| motion.attempt(&scheme, dt).is_ok());
}

#[divan::bench(args = [1, 2, 3, 4])]
fn step_rk_dgfem(bencher: Bencher, degree: usize) {
    step(bencher, Method::RkDgfem, None, degree);
}

#[divan::bench(args = [1, 2, 3, 4])]
fn step_ader_dgmpm_lattice(bencher: Bencher, degree: usize) {
    step(bencher, Method::AderDgmpm, Some("midpoints"), degree);
}

#[divan::bench(args = [1, 2, 3, 4])]
fn step_ader_dgmpm_any_cloud(bencher: Bencher, degree: usize) {
    step(bencher, Method::AderDgmpm, Some("jitter"), degree);
}

/// The plate with a hole, every cell in 8 x 8, and 1e6 points in it: along rows as a lattice, or in random order.
fn locate(bencher: Bencher, rows: bool) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/plate_hole.msh");
    let mesh = dgmpm::parts::io::gmsh::read(&path).expect("the mesh of an example is valid").refined(8);
    let member = vec![true; mesh.cells.len()];
    let area: f64 = (0..mesh.cells.len()).map(|cell| map::area(&mesh.corners(cell))).sum();
    let cloud = Pattern::Rotated { angle: 30.0, spacing: (area / 1e6).sqrt() }.seed(&mesh, &member);
    let of_cell =
        |cell: usize| cloud.of(cell).iter().map(|&xi| map::position(&mesh.corners(cell), xi)).collect::<Vec<_>>();
    let mut points: Vec<[f64; 2]> = (0..mesh.cells.len()).flat_map(of_cell).collect();
    if rows {
        let row = |x: &[f64; 2]| ((x[1] / (area / 1e6).sqrt()) as i64, (x[0] * 1e9) as i64);
        points.sort_by_key(row);
    } else {
        // A multiplier of the golden ratio spreads neighbours far apart.
        points.sort_by_key(|x| x[0].to_bits().wrapping_add(x[1].to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    }
    println!("{} points in {} cells", points.len(), mesh.cells.len());
    let outside = |why: dgmpm::parts::cloud::Outside| panic!("{why}");
    bencher
        .counter(ItemsCount::new(points.len()))
        .bench_local(|| from_points(&mesh, &Locator::new(&mesh), black_box(&points)).unwrap_or_else(outside));
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn locate_rows_of_points(bencher: Bencher) {
    locate(bencher, true);
}

#[divan::bench(sample_count = 3, sample_size = 1)]
fn locate_points_in_any_order(bencher: Bencher) {
    locate(bencher, false);
}
