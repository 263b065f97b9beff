//! A step allocates nothing: a counting allocator stands in this program, and a scheme that has done its first steps takes
//! more with boundaries of every kind, data that depends on time and a source.

mod scenes;

use dgmpm::parts::problem::Problem;
use dgmpm::parts::step::{Motion, Scheme};
use scenes::Body;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

/// Counts what is asked of the system: in all threads that are watched, and in each for itself.
struct Counting;

static ALL: AtomicUsize = AtomicUsize::new(0);
thread_local! {
    static OWN: Cell<usize> = const { Cell::new(0) };
    /// The threads of a pool. What runs the tests is not: it prints, and so allocates, whenever one of them ends.
    static WATCHED: Cell<bool> = const { Cell::new(false) };
}

fn count() {
    if WATCHED.get() {
        ALL.fetch_add(1, Ordering::Relaxed);
    }
    OWN.set(OWN.get() + 1);
}

// SAFETY: every call is passed on to the system's allocator; counting touches no memory of it.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(block, layout, size) }
    }
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Walls, traction and velocity that depend on place and time, absorbing edges, a source and the displacement.
fn body() -> Body {
    Body::square(24)
        .velocity(["30*sin(pi*x)", "-10*sin(pi*y)"])
        .side("left", "wall", r#"speed = "5*sin(1e4*t)*(1 + y)""#)
        .side("right", "traction", r#"value = ["1e8*sin(2e4*t)", "x*y"]"#)
        .side("bottom", "velocity", r#"value = ["x*t", "max(0, -t)"]"#)
        .side("top", "absorbing", "")
        .table("[source]", "kind = \"body-force\"\nvalue = [\"100*sin(x + 1e3*t)\", \"-9.81\"]")
        .method("rk-dgfem")
        .degree(2)
        .end(1.0)
        .table("[output]", "kind = \"fields\"\nevery = 1.0\nfields = [\"displacement\"]")
}

struct Run {
    scheme: Scheme,
    motion: Motion,
    dt: f64,
}

impl Run {
    /// A scheme that has done some steps on the threads of the current pool.
    fn warm(sets: &[&str]) -> Self {
        let Problem { scheme, state, settings, .. } = body().problem(sets);
        assert!(state.has_displacement() && !scheme.sources.is_empty());
        let motion = Motion::new(&scheme, state).unwrap();
        let dt = 0.5 * settings.courant / 24.0 / motion.survey.fastest;
        let mut run = Self { scheme, motion, dt };
        (0..3).for_each(|_| run.step());
        run
    }

    fn step(&mut self) {
        self.motion.advance(&self.scheme, self.dt).unwrap();
    }
}

const PLASTIC: [&str; 3] = ["material.0.law=j2", "material.0.yield_stress=1e8", "material.0.hardening=1e10"];

const CASES: [(&str, &[&str]); 7] = [
    ("RK S2", &["scheme.method=rk-dgfem"]),
    ("ADER-DGMPM S2, lattice", &["scheme.method=ader-dgmpm", "cloud.layout=midpoints"]),
    ("ADER-DGMPM S2, jitter", &["scheme.method=ader-dgmpm", "cloud.layout=jitter"]),
    ("RK S2, J2", &["scheme.method=rk-dgfem", PLASTIC[0], PLASTIC[1], PLASTIC[2]]),
    ("ADER-DGMPM S2, J2", &["scheme.method=ader-dgmpm", PLASTIC[0], PLASTIC[1], PLASTIC[2]]),
    ("ADER-DGMPM S2, all cells limited", &["scheme.method=ader-dgmpm", "limiter={kind=\"moment\",threshold=0}"]),
    ("RK S2, sensor and vertex limiter", &["scheme.method=rk-dgfem", "limiter={kind=\"vertex\"}"]),
];

/// Calls of the allocator by the one thread of a pool during `steps` steps.
fn on_one_thread(sets: &[&str], steps: usize) -> usize {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        let mut run = Run::warm(sets);
        let before = OWN.get();
        (0..steps).for_each(|_| run.step());
        assert!(run.motion.state.u.iter().flat_map(|u| u.0).all(f64::is_finite));
        OWN.get() - before
    })
}

/// Tests run side by side in this program: one at a time, so that the count of all watched threads is that of one test.
static TURN: Mutex<()> = Mutex::new(());

fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Steals between two threads take no memory either: rayon's jobs live on the stack, its queues grow once.
#[test]
fn steps_on_two_threads_allocate_nothing_but_a_queue_that_grows() {
    let _turn = turn();
    for (name, sets) in CASES {
        let watch = |_| WATCHED.set(true);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).start_handler(watch).build().unwrap();
        let seen = pool.install(|| {
            let mut run = Run::warm(sets);
            let before = ALL.load(Ordering::Relaxed);
            (0..200).for_each(|_| run.step());
            ALL.load(Ordering::Relaxed) - before
        });
        // Measured: 0. A thread that sleeps through the warm steps may take its first records of the queues' garbage
        // collector later, a handful a thread; 200 steps that allocated would need 200 at least.
        assert!(seen < 16, "{name}: {seen} allocations in 200 steps");
    }
}

#[test]
fn step_and_survey_of_a_warm_scheme_allocate_nothing_on_one_thread() {
    let _turn = turn();
    for (name, sets) in CASES {
        assert_eq!(on_one_thread(sets, 20), 0, "{name}");
    }
}

#[test]
fn the_counter_sees_what_the_first_step_and_a_vector_allocate() {
    let _turn = turn();
    let before = OWN.get();
    drop(std::hint::black_box(vec![1.0; 100]));
    assert_eq!(OWN.get() - before, 1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let seen = pool.install(|| {
        let before = OWN.get();
        let _run = Run::warm(&[]);
        OWN.get() - before
    });
    assert!(seen > 100, "{seen}: building a scheme allocates");
}
