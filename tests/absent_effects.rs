//! What a scene does not ask for holds no bytes and takes no time: a counting allocator stands in this program. `make proof` compares the
//! instructions of programs with and without an effect.

mod scenes;

use dgmpm::parts::state::Received;
use dgmpm::parts::step::{Held, Motion, Part, phase::PARTS};
use scenes::Body;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Counts the bytes that each thread asks for.
struct Counting;

thread_local! {
    static BYTES: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is passed on to the system's allocator; counting touches no memory of it.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        BYTES.set(BYTES.get() + layout.size());
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn bytes<T>(make: impl FnOnce() -> T) -> (usize, T) {
    let before = BYTES.get();
    let made = make();
    (BYTES.get() - before, made)
}

/// An elastic body that asks for nothing.
fn plain() -> Body {
    Body::square(8).velocity(["10*sin(pi*x)", "0"]).method("ader-dgmpm").degree(2).end(1.0)
}

#[test]
fn an_elastic_scene_without_effects_holds_nothing_for_them_and_has_no_clock_of_theirs() {
    let problem = plain().side("left", "wall", "").problem(&["curl.control=off"]);
    let mut motion = Motion::new(&problem.scheme, problem.state).unwrap();
    motion.advance(&problem.scheme, 1e-6).unwrap();
    assert_eq!(motion.work.held(), Held::default());
    let state = &motion.state;
    assert!(state.internal.is_empty() && state.boundary.is_empty() && state.received.is_empty());
    assert!(state.creep.is_empty() && motion.work.next.creep.is_empty());
    assert!(
        problem.scheme.sources.is_empty() && problem.scheme.corrections.is_empty() && problem.scheme.curl.is_none()
    );
    let parts = motion.work.take_phases().parts;
    // Of the parts of phases only the wall, which the scene has.
    assert!(parts.len() == PARTS && parts[0] > 0.0 && parts[1..].iter().all(|seconds| *seconds == 0.0), "{parts:?}");
}

#[test]
fn springs_hold_what_their_faces_have_crept_and_have_a_clock() {
    let problem = plain().problem(&["scheme.springs=true"]);
    let mut motion = Motion::new(&problem.scheme, problem.state).unwrap();
    motion.advance(&problem.scheme, 1e-6).unwrap();
    // Blocks of 8 of the 64 cells, four faces of three points, two numbers each.
    let creep: usize = 8 * 4 * 3 * 2;
    let threads = rayon::current_num_threads();
    assert_eq!((motion.state.creep.len(), motion.work.held().springs), (creep, (2 * creep + threads * creep / 8) * 64));
    let parts = motion.work.take_phases().parts;
    assert!(parts[Part::Springs as usize] > 0.0, "{parts:?}");
}

#[test]
fn the_meter_of_forces_allocates_its_bytes_where_it_is_asked_for_and_none_elsewhere() {
    let problem = plain().problem(&[]);
    let scheme = &problem.scheme;
    let make = |with: bool| {
        let state = problem.state.clone();
        bytes(|| {
            let motion = Motion::unsurveyed(scheme, state);
            if with { motion.with_forces(scheme) } else { motion }
        })
    };
    // The first makes what is there once, such as records of the threads.
    drop(make(true));
    let ((without, bare), (with, metered)) = (make(false), make(true));
    let own = metered.work.held().forces + scheme.boundaries.len() * size_of::<Received>();
    assert_eq!((with - without, bare.work.held()), (own, Held::default()));
    assert!(own > 0);
}

#[test]
fn a_program_without_an_effect_refuses_scenes_that_ask_for_it() {
    use dgmpm::parts::built::refuse;
    assert!(refuse(&[(true, true, "a source"), (false, false, "forces")]).is_ok());
    let message = refuse(&[(true, true, "a source"), (false, true, "forces")]).unwrap_err().to_string();
    assert!(message.contains("asks for forces") && message.contains("built without"), "{message}");
}
