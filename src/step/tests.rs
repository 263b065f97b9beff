use super::*;
use crate::boundary::{Free, Wall};
use crate::cloud::Cloud;
use crate::material::NeoHookean;
use crate::mesh::{Link, Mesh};
use crate::operators::{Needs, Sampling};

fn square(n: usize, size: f64) -> (Mesh, Vec<[Link; 4]>) {
    let mut m = Mesh::default();
    for j in 0..=n {
        for i in 0..=n {
            m.nodes.push([size * i as f64 / n as f64, size * j as f64 / n as f64]);
        }
    }
    let mut links = vec![];
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            m.cells.push([a, a + 1, a + n + 2, a + n + 1]);
            m.cell_group.push(0);
            m.original.push((j * n + i) as u64);
            let c = j * n + i;
            let cell = |ok: bool, cell: isize, face: usize, g: usize| {
                if ok {
                    Link::Cell { cell: (c as isize + cell) as usize, face, flip: false }
                } else {
                    Link::Boundary(g)
                }
            };
            links.push([
                cell(i > 0, -1, 1, 0),
                cell(i + 1 < n, 1, 0, 1),
                cell(j > 0, -(n as isize), 3, 2),
                cell(j + 1 < n, n as isize, 2, 3),
            ]);
        }
    }
    (m, links)
}

fn lattice(cells: usize, at: &[f64]) -> Cloud {
    let mut c = Cloud { first: vec![0], xi: vec![] };
    for _ in 0..cells {
        for x in at {
            for y in at {
                c.xi.push([*x, *y]);
            }
        }
        c.first.push(c.xi.len());
    }
    c
}

#[test]
fn scratch_impact() {
    let n: usize = std::env::var("N").ok().and_then(|x| x.parse().ok()).unwrap_or(30);
    let degree: usize = std::env::var("S").ok().and_then(|x| x.parse().ok()).unwrap_or(2);
    let method = std::env::var("M").unwrap_or("mpm".into());
    let (mesh, links) = square(n, 3.0);
    let at: Vec<f64> = match degree {
        1 => vec![0.25, 0.75],
        2 => vec![0.25, 0.5, 0.75],
        k => (0..=k).map(|i| (i as f64 + 0.5) / (k + 1) as f64).collect(),
    };
    let cloud = lattice(n * n, &at);
    let sampling = match &method[..] {
        "rk" => None,
        "fem" => Some(Sampling::Nodes),
        _ => Some(Sampling::Cloud(&cloud)),
    };
    let operators =
        Operators::build(&mesh, &links, &vec![0; n * n], &Needs { degree, sampling, curl_free: true }).unwrap();
    let method = match &method[..] {
        "rk" => Method::RungeKutta(Tableau::of_degree(degree)),
        _ => Method::Ader { time: TimeBasis::new(degree), sweeps: degree + 1 },
    };
    let scheme = Scheme {
        operators,
        laws: vec![Law::NeoHookean(NeoHookean::new(2e11, 0.3, 7800.0))],
        method,
        flux: Flux::Rusanov,
        boundaries: vec![
            Box::new(Wall { speed: None }),
            Box::new(Free),
            Box::new(Wall { speed: None }),
            Box::new(Free),
        ],
        sources: vec![],
        curl_rate: Some(3.0 * degree as f64),
        kernel: Kernel::widest(),
    };
    let nn = scheme.operators.nodes();
    let mut cells = vec![0.0; n * n * 6 * nn];
    for c in 0..n * n {
        for a in 0..nn {
            cells[(c * 6) * nn + a] = 1.0;
            cells[(c * 6 + 3) * nn + a] = 1.0;
            cells[(c * 6 + 4) * nn + a] = -200.0 * 7800.0;
        }
    }
    let mut state = State::pack(&scheme.operators.blocks, nn, 6, &cells);
    let mut work = Work::new(&scheme, &state);
    let mut survey = Survey::default();
    scheme.survey(&state, &work, &mut survey).unwrap();
    let e0 = scheme.totals(&state).energy();
    let start = std::time::Instant::now();
    let end = 1.77e-3;
    let mut last = e0;
    while state.time < end * (1.0 - 1e-12) {
        let h = 3.0 / n as f64;
        let dt = (0.4 * h / ((2 * degree + 1) as f64 * survey.fastest)).min(end - state.time);
        scheme.step(&state, dt, &survey, &mut work);
        std::mem::swap(&mut state, &mut work.next);
        if let Err(loss) = scheme.survey(&state, &work, &mut survey) {
            panic!("{loss:?} at {} step {}", state.time, state.step);
        }
        if state.step % 200 == 0 {
            let t = scheme.totals(&state);
            println!(
                "{} {:.4e} E/E0 {:.6} minj {:.4} c {:.1} curl {:.3e}",
                state.step,
                state.time,
                t.energy() / e0,
                survey.min_j,
                survey.fastest,
                t.max_curl
            );
            assert!(t.energy() <= last);
            last = t.energy();
        }
    }
    let t = scheme.totals(&state);
    println!(
        "steps {} E/E0 {:.6} wall {:.2}s momentum {:?}",
        state.step,
        t.energy() / e0,
        start.elapsed().as_secs_f64(),
        t.momentum
    );
    let ph = work.take_phases();
    for (n, s) in phase::NAMES.iter().zip(ph.seconds) {
        println!("{n:24} {s:.3}");
    }
    let flat = state.unpack(&scheme.operators.blocks, nn);
    // bottom line
    let basis = &scheme.operators.line.basis;
    let mut lo = [f64::MAX; 2];
    let mut hi = [f64::MIN; 2];
    for s in 0..300 {
        let x = s as f64 * 3.0 / 299.0;
        let h = 3.0 / n as f64;
        let c = ((x / h) as usize).min(n - 1);
        let phi = basis.values_2d([x / h - c as f64, 0.0]);
        let val = |k: usize| -> f64 { (0..nn).map(|a| phi[a] * flat[(c * 6 + k) * nn + a]).sum() };
        let f = [val(0), val(1), val(2), val(3)];
        let p = scheme.laws[0].stress(f);
        let s = crate::material::cauchy(f, p, 0.0)[0] / 1e9;
        let v = val(4) / 7800.0;
        lo = [lo[0].min(s), lo[1].min(v)];
        hi = [hi[0].max(s), hi[1].max(v)];
    }
    println!("sigma {:.3} {:.3}  v {:.2} {:.2}", lo[0], hi[0], lo[1], hi[1]);
}
