//! MPI as an engine that carries messages between ranks.
//!
//! A rank that waits looks at its messages again and again, lets other processes run in between, and looks at the clock: MPI itself would
//! wait for ever for a rank that has stopped. What cannot go on ends all ranks by MPI_Abort.

use crate::partition::Partition;
use dgmpm::{BlockGraph, Exchange};
use ferrompi::{Communicator, Request, Scope};
use std::io::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// Exit code of a job that lost a rank, or that MPI does not serve.
pub const LOST: u8 = 7;
/// Exit code of a rank that panicked, as Rust has it.
const PANICKED: i32 = 101;
/// The longest piece of a message to all, in numbers: MPI counts with 31 bits.
const PIECE: usize = 1 << 30;
/// A rank that has waited for so long looks less often: somebody writes a file.
const LONG: Duration = Duration::from_secs(2);
/// How often it looks then, and in [`Exchange::wait`].
const PAUSE: Duration = Duration::from_millis(2);
/// All ranks lose patience at the same time; each one waits so much longer than the one before it, so that one of them has the word
/// (MPI_Abort takes a second, as ranks do not die of SIGTERM).
const TURN: Duration = Duration::from_millis(1500);
/// The last turn.
const TURNS: u32 = 4;
/// What starts the ranks needs so long to hand a line on.
const HEARD: Duration = Duration::from_millis(100);
/// Between two looks no more than this counts as waiting.
const BLINK: Duration = Duration::from_millis(100);

/// A rank of MPI.
pub struct Engine {
    world: Communicator,
    rank: usize,
    ranks: usize,
    patience: Duration,
    partition: Partition,
    /// The only thread that may call MPI.
    thread: ThreadId,
    meter: Meter,
}

impl std::fmt::Debug for Engine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "rank {} of {} by MPI", self.rank, self.ranks)
    }
}

/// Says a line on standard error, which all ranks share: in one piece, and so that it is through before the job may end.
fn say(line: &str) {
    // Nobody may read along.
    let _ = std::io::stderr().write_all(format!("{line}\n").as_bytes());
    thread::sleep(HEARD);
}

/// Ends all ranks of `world` where this process panics, on whatever thread: nobody could unwind the others.
pub fn end_all_on_panic(world: Communicator) {
    let rank = world.rank();
    std::panic::set_hook(Box::new(move |what| {
        say(&format!("error: rank {rank}: {what}"));
        world.abort(PANICKED);
    }));
}

/// What a rank has sent, and how long it has waited.
#[derive(Debug, Default)]
struct Meter {
    /// Swaps, messages in them, and numbers in these.
    swaps: AtomicU64,
    messages: AtomicU64,
    numbers: AtomicU64,
    /// Gathers, and numbers that this rank gave to all.
    gathers: AtomicU64,
    given: AtomicU64,
    /// Nanoseconds in both.
    waited: [AtomicU64; 2],
}

impl Meter {
    fn add(to: &AtomicU64, number: usize) {
        to.fetch_add(number as u64, Ordering::Relaxed);
    }
}

/// One message under way, and who sends it.
type Pending<'s> = (Option<usize>, Request<'s>);

impl Engine {
    /// This process among all that MPI has started, with so much patience with the others.
    pub fn new(world: Communicator, patience: Duration, partition: Partition) -> Self {
        let of = |number: i32| usize::try_from(number).unwrap_or(0);
        let (rank, ranks) = (of(world.rank()), of(world.size()).max(1));
        let (thread, meter) = (thread::current().id(), Meter::default());
        Self { world, rank, ranks, patience, partition, thread, meter }
    }

    /// Whether it is rank 0.
    pub fn is_first(&self) -> bool {
        self.rank == 0
    }

    /// A number of each rank, known to all.
    pub fn numbers_of_all(&self, own: f64) -> Vec<f64> {
        let mut all = vec![0.0; self.ranks];
        all[self.rank] = own;
        self.gather(&mut all, &(0..=self.ranks).collect::<Vec<_>>());
        all
    }

    /// The first rank that has another number than rank 0.
    pub fn first_that_differs(&self, own: f64) -> Option<usize> {
        let all = self.numbers_of_all(own);
        all.iter().position(|number| *number != all[0])
    }

    /// Prints what this rank has sent.
    pub fn report(&self) {
        let Meter { swaps, messages, numbers, gathers, given, waited } = &self.meter;
        let of = |number: &AtomicU64| number.load(Ordering::Relaxed);
        let [swapping, gathering] = [0, 1].map(|k| of(&waited[k]) as f64 / 1e9);
        say(&format!(
            "rank {}: {} swaps, {} messages of {} numbers, {swapping:.3} s; {} gathers, {} numbers given, {gathering:.3} s",
            self.rank,
            of(swaps),
            of(messages),
            of(numbers),
            of(gathers),
            of(given)
        ));
    }

    /// Does something that begins messages, and waits for their end; `patience` of none waits for ever, and looks seldom.
    fn carry<'env>(
        &self,
        patience: Option<Duration>,
        begin: impl for<'s> FnOnce(&'s Scope<'s, 'env>) -> ferrompi::Result<Vec<Pending<'s>>>,
    ) {
        if thread::current().id() != self.thread {
            self.end_all("messages go from the first thread of a rank only: this is a fault of dgmpm");
        }
        let carried = ferrompi::scope(|scope| {
            let mut pending = begin(scope)?;
            self.wait_for(&mut pending, patience)
        });
        if let Err(why) = carried {
            self.end_all(&format!("MPI has failed: {why}"));
        }
    }

    fn wait_for(&self, pending: &mut [Pending], patience: Option<Duration>) -> ferrompi::Result<()> {
        let (mut waited, mut last) = (Duration::ZERO, Instant::now());
        loop {
            let mut open = None;
            for (from, request) in &mut *pending {
                if request.test()?.is_none() {
                    open = Some(*from);
                }
            }
            let Some(from) = open else { return Ok(()) };
            // A rank that was stopped itself has not waited meanwhile.
            waited += last.elapsed().min(BLINK);
            last = Instant::now();
            let turn = TURN * TURNS.min(u32::try_from(self.rank).unwrap_or(TURNS));
            if patience.is_some_and(|patience| waited.saturating_sub(turn) > patience) {
                let name = from.map_or_else(|| "another rank".to_owned(), |from| format!("rank {from}"));
                let seconds = self.patience.as_secs_f64();
                self.end_all(&format!("{name} has not answered for {seconds} s; --patience gives it more time"));
            }
            if patience.is_none() || waited > LONG { thread::sleep(PAUSE) } else { thread::yield_now() }
        }
    }

    /// Says why, and ends all ranks.
    fn end_all(&self, why: &str) -> ! {
        say(&format!("error: rank {}: {why}", self.rank));
        self.world.abort(i32::from(LOST))
    }

    /// The piece of this rank, and the pieces of all in `all`, whose first number has the number `start`.
    fn gather_piece(&self, all: &mut [f64], start: usize, first: &[usize]) {
        let end = start + all.len();
        let ends: Vec<usize> = first.iter().map(|first| first.clamp(&start, &end) - start).collect();
        // All fit into 31 bits, see `PIECE`.
        let lengths: Vec<i32> = ends.windows(2).map(|ends| (ends[1] - ends[0]) as i32).collect();
        let places: Vec<i32> = ends[..self.ranks].iter().map(|place| *place as i32).collect();
        let own = all[ends[self.rank]..ends[self.rank + 1]].to_vec();
        let even = lengths.iter().all(|length| *length == lengths[0]);
        self.carry(Some(self.patience), |scope| {
            let request = match even {
                true => self.world.iallgather(scope, &own, all)?,
                false => self.world.iallgatherv(scope, &own, all, &lengths, &places)?,
            };
            Ok(vec![(None, request)])
        });
    }
}

impl Exchange for Engine {
    fn rank(&self) -> usize {
        self.rank
    }

    fn ranks(&self) -> usize {
        self.ranks
    }

    fn swap(&self, send: &[Vec<f64>], receive: &mut [Vec<f64>], meanwhile: &mut (dyn FnMut() + Send)) {
        let full = |letters: &[Vec<f64>]| letters.iter().any(|letter| !letter.is_empty());
        if !full(send) && !full(receive) {
            return meanwhile();
        }
        let mut clock = Instant::now();
        self.carry(Some(self.patience), |scope| {
            let mut pending = Vec::new();
            for (from, letter) in receive.iter_mut().enumerate().filter(|(_, letter)| !letter.is_empty()) {
                pending.push((Some(from), self.world.irecv(scope, letter, from as i32, TAG)?));
            }
            for (to, letter) in send.iter().enumerate().filter(|(_, letter)| !letter.is_empty()) {
                pending.push((Some(to), self.world.isend(scope, letter, to as i32, TAG)?));
                Meter::add(&self.meter.messages, 1);
                Meter::add(&self.meter.numbers, letter.len());
            }
            meanwhile();
            clock = Instant::now();
            Ok(pending)
        });
        Meter::add(&self.meter.swaps, 1);
        Meter::add(&self.meter.waited[0], clock.elapsed().as_nanos() as usize);
    }

    fn gather(&self, all: &mut [f64], first: &[usize]) {
        let clock = Instant::now();
        let mut start = 0;
        for piece in all.chunks_mut(PIECE) {
            self.gather_piece(piece, start, first);
            start += piece.len();
        }
        Meter::add(&self.meter.gathers, 1);
        Meter::add(&self.meter.given, first[self.rank + 1] - first[self.rank]);
        Meter::add(&self.meter.waited[1], clock.elapsed().as_nanos() as usize);
    }

    fn parts(&self, graph: &BlockGraph) -> Option<Vec<usize>> {
        self.partition.parts(graph, self.ranks)
    }

    fn wait(&self) {
        self.carry(None, |scope| Ok(vec![(None, self.world.ibarrier(scope)?)]));
    }
}

/// Of messages between two ranks, which come in the order in which they are sent.
const TAG: i32 = 1;
