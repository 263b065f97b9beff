//! Several ranks that step a body together write the files of one alone, to the byte. Here ranks are threads of one program.

use crate::common::{Bench, assert_same};
use dgmpm::parts::problem::{Problem, Setup};
use dgmpm::parts::run::Folder;
use dgmpm::parts::scene::Scene;
use dgmpm::{Error, Exchange, Kernel};
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

/// Where ranks lay down what they send: by rank from and to.
#[derive(Debug, Default)]
struct Table {
    letters: Vec<Vec<Vec<f64>>>,
    /// How many have come to the meeting under way, and how many meetings there were.
    here: usize,
    meetings: usize,
}

#[derive(Debug)]
struct Hall {
    table: Mutex<Table>,
    met: Condvar,
}

impl Hall {
    /// Waits for all ranks. A rank that does not come in a minute has failed: the others say so and do not wait for ever.
    fn meet(&self, ranks: usize) {
        let mut table = self.table.lock().unwrap();
        table.here += 1;
        let meeting = table.meetings;
        if table.here == ranks {
            (table.here, table.meetings) = (0, meeting + 1);
            return self.met.notify_all();
        }
        while table.meetings == meeting {
            let (next, late) = self.met.wait_timeout(table, Duration::from_secs(60)).unwrap();
            assert!(!late.timed_out(), "a rank does not come");
            table = next;
        }
    }
}

#[derive(Debug)]
struct Thread {
    rank: usize,
    ranks: usize,
    hall: Arc<Hall>,
}

impl Exchange for Thread {
    fn rank(&self) -> usize {
        self.rank
    }
    fn ranks(&self) -> usize {
        self.ranks
    }
    fn swap(&self, send: &[Vec<f64>], receive: &mut [Vec<f64>], meanwhile: &mut (dyn FnMut() + Send)) {
        meanwhile();
        self.hall.table.lock().unwrap().letters[self.rank] = send.to_vec();
        self.hall.meet(self.ranks);
        for (from, receive) in receive.iter_mut().enumerate() {
            let sent = &self.hall.table.lock().unwrap().letters[from][self.rank];
            assert_eq!(sent.len(), receive.len(), "from {from} to {}", self.rank);
            receive.copy_from_slice(sent);
        }
        self.hall.meet(self.ranks);
    }
    fn gather(&self, all: &mut [f64], first: &[usize]) {
        self.hall.table.lock().unwrap().letters[self.rank] = vec![all[first[self.rank]..first[self.rank + 1]].to_vec()];
        self.hall.meet(self.ranks);
        for from in 0..self.ranks {
            all[first[from]..first[from + 1]].copy_from_slice(&self.hall.table.lock().unwrap().letters[from][0]);
        }
        self.hall.meet(self.ranks);
    }
}

/// The ways of so many threads to each other.
fn threads(ranks: usize) -> Vec<Arc<Thread>> {
    let table = Table { letters: vec![vec![vec![]; ranks]; ranks], ..Table::default() };
    let hall = Arc::new(Hall { table: Mutex::new(table), met: Condvar::new() });
    (0..ranks).map(|rank| Arc::new(Thread { rank, ranks, hall: hall.clone() })).collect()
}

/// Runs a scene alone and on so many ranks, the first of which has the files of the first run, and the others none.
fn compare(name: &str, scene: &Path, sets: &[&str], ranks: usize) {
    let out = tempfile::tempdir().unwrap();
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let scene = Scene::load(scene, &sets).unwrap();
    let folder = |name: &str| Folder::new(&out.path().join(name));
    let alone = folder("alone");
    Problem::new(&scene).unwrap().run_in(&alone).unwrap_or_else(|why| panic!("{name}: {why}"));
    std::thread::scope(|scope| {
        for (rank, exchange) in threads(ranks).into_iter().enumerate() {
            let (scene, folder) = (&scene, folder(&rank.to_string()));
            scope.spawn(move || {
                let mut problem = Setup::of(scene).exchange(exchange).build().unwrap();
                problem.run_in(&folder).unwrap_or_else(|why| panic!("{name}, rank {rank}: {why}"));
            });
        }
    });
    assert_same(&format!("{name}, {ranks} ranks"), &alone.root, &out.path().join("0"));
    for rank in 1..ranks {
        assert!(!out.path().join(rank.to_string()).exists(), "{name}: rank {rank} has written");
    }
}

/// What each of two ranks comes to that run problems which differ.
fn outcomes(of: impl Fn(usize, Setup<'_>) -> dgmpm::Result<Problem> + Sync, folders: [&Path; 2]) -> Vec<Error> {
    let bench = Bench::new();
    let scene = Scene::load(&bench.path("case.toml"), &[QUIET, CELLS].map(str::to_owned)).unwrap();
    let (scene, of) = (&scene, &of);
    std::thread::scope(|scope| {
        let run = |(rank, exchange): (usize, Arc<Thread>)| {
            scope.spawn(move || {
                let mut problem = of(rank, Setup::of(scene).exchange(exchange)).unwrap();
                problem.run_in(&Folder::new(folders[rank])).unwrap_err()
            })
        };
        let all: Vec<_> = threads(2).into_iter().enumerate().map(run).collect();
        all.into_iter().map(|rank| rank.join().unwrap()).collect()
    })
}

#[test]
fn ranks_that_would_not_step_the_same_problem_alike_are_refused_by_all() {
    let out = tempfile::tempdir().unwrap();
    let path = out.path().join("run");
    let widest = Kernel::widest();
    let other =
        Kernel::NAMES.iter().map(|(_, kernel)| *kernel).find(|kernel| *kernel != widest && kernel.is_available());
    // The portable path is always there.
    let other = other.unwrap();
    let errors = outcomes(|rank, setup| setup.kernel([widest, other][rank]).build(), [&path; 2]);
    for error in errors {
        assert!(error.exit_code() == 2 && error.to_string().contains("rank 1 would step by"), "{error}");
    }
    let moved = |rank, setup: Setup| {
        let mut problem = setup.build()?;
        problem.state.u[0].0[0] += rank as f64 * 1e-9;
        Ok(problem)
    };
    for error in outcomes(moved, [&path; 2]) {
        assert!(error.to_string().starts_with("rank 1 has another scene, mesh, cloud or start"), "{error}");
    }
}

#[test]
fn a_file_that_the_first_rank_cannot_write_ends_all_ranks() {
    let out = tempfile::tempdir().unwrap();
    let errors = outcomes(|_, setup| setup.build(), [Path::new("/proc/run"), &out.path().join("none")]);
    assert!(matches!(&errors[0], Error::Output { .. }), "{}", errors[0]);
    assert!(matches!(&errors[1], Error::OtherRank { rank: 0, code: 5 }), "{}", errors[1]);
    assert!(!out.path().join("none").exists());
}

const QUIET: &str = "checkpoint={every_minutes=60}";
/// Nine blocks.
const CELLS: &str = "mesh.rectangle.cells=[12,6]";
const ELASTIC: &str = "material=[{law=\"neo-hookean\",young=2e11,poisson=0.3,density=7800}]";

#[test]
fn any_number_of_ranks_has_the_bits_of_one() {
    let bench = Bench::new();
    let case = bench.path("case.toml");
    compare("J2, regrid", &case, &[QUIET, CELLS], 3);
    // Ranks know the whole state only where somebody looks at it.
    let wall = "boundary.0={group=\"left\",kind=\"wall\"}";
    let common = [QUIET, CELLS, wall, "regrid=[]"];
    let jitter = "cloud={layout=\"jitter\",seed=1,amount=0.2}";
    compare("jitter", &case, &[&common[..], &[ELASTIC, jitter]].concat(), 4);
    compare("springs, regrid", &case, &[QUIET, CELLS, ELASTIC, "scheme.springs=true"], 3);
    let fem = ["scheme.method=rk-dgfem", "scheme.degree=3"];
    compare("Runge-Kutta, springs", &case, &[&common[..], &[ELASTIC, "scheme.springs=true"], &fem].concat(), 2);
    compare("Runge-Kutta", &case, &[&common[..], &[ELASTIC], &fem].concat(), 3);
    let at_nodes = ["scheme.method=ader-dgfem", "scheme.degree=1"];
    compare("ADER-DGFEM, J2", &case, &[&common[..], &at_nodes].concat(), 2);
    bench.of_mixed_body();
    compare("half J2, half jitter", &bench.path("mixed.toml"), &[QUIET], 3);
}

#[test]
fn ranks_have_the_bits_of_one_where_a_step_looks_at_the_whole_body() {
    let bench = Bench::new();
    let case = bench.path("case.toml");
    let (fem, fast) = ("scheme.method=rk-dgfem", "initial.velocity=[\"-1500\",\"0\"]");
    let limiter = "limiter={kind=\"moment\"}";
    compare("limiter", &case, &[QUIET, CELLS, ELASTIC, fem, limiter, fast, "regrid=[]"], 2);
    bench.of_two_bodies();
    compare("contact", &bench.path("parts.toml"), &["scheme.angular_momentum=true"], 2);
}

#[test]
fn a_rank_without_a_block_follows() {
    let bench = Bench::new();
    compare("two cells", &bench.path("case.toml"), &[QUIET, "mesh.rectangle.cells=[2,1]", ELASTIC, "regrid=[]"], 3);
}
