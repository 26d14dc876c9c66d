//! Runs numbered jobs on threads, and watches that none hangs.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A job that takes longer hangs, for all that anyone waiting for a compiler can tell.
const LIMIT: Duration = Duration::from_secs(2);
/// When a job is given up, and the process with it: a thread can't be stopped.
const GIVEN_UP: Duration = Duration::from_secs(30);

/// What became of all jobs.
pub struct Report<T> {
    /// The results, in the order of the jobs; none where a job failed.
    pub results: Vec<Option<T>>,
    /// The jobs that failed, in order, with why.
    pub failures: Vec<(u64, String)>,
    /// The job that took longest, and how long.
    pub slowest: (u64, Duration),
}

/// A job's number, what it took, and what came of it.
type Done<T> = (u64, Duration, Result<T, String>);

/// Runs the jobs `0..count` on so many threads. A panic of a job, or its taking longer than two
/// seconds, is its failure. One that does not end at all ends the process, with its number said.
pub fn run<T: Send>(count: u64, threads: usize, job: impl Fn(u64) -> Result<T, String> + Sync) -> Report<T> {
    let next = AtomicU64::new(0);
    let at_work: Vec<Mutex<Option<(u64, Instant)>>> = (0..threads).map(|_| Mutex::new(None)).collect();
    let done: Mutex<Vec<Done<T>>> = Mutex::new(Vec::new());
    std::panic::set_hook(Box::new(|_| {}));
    std::thread::scope(|scope| {
        let workers: Vec<_> = at_work
            .iter()
            .map(|slot| {
                scope.spawn(|| {
                    loop {
                        let number = next.fetch_add(1, Ordering::Relaxed);
                        if number >= count {
                            break;
                        }
                        let start = Instant::now();
                        *lock(slot) = Some((number, start));
                        let result = guarded(|| job(number));
                        *lock(slot) = None;
                        lock(&done).push((number, start.elapsed(), result));
                    }
                })
            })
            .collect();
        while !workers.iter().all(|worker| worker.is_finished()) {
            std::thread::sleep(Duration::from_millis(20));
            at_work.iter().for_each(watch);
        }
    });
    let _ = std::panic::take_hook();
    report(done.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A job's result; a panic is an error with its words.
fn guarded<T>(job: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(job)).unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words = words.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("panics: {}", words.unwrap_or("without words")))
    })
}

/// Ends the process when a job does not end.
fn watch(slot: &Mutex<Option<(u64, Instant)>>) {
    if let Some((number, start)) = *lock(slot)
        && start.elapsed() > GIVEN_UP
    {
        eprintln!("job {number} has not ended after {} s", GIVEN_UP.as_secs());
        std::process::exit(1);
    }
}

fn report<T>(mut done: Vec<Done<T>>) -> Report<T> {
    done.sort_by_key(|(number, ..)| *number);
    let mut report = Report { results: Vec::new(), failures: Vec::new(), slowest: (0, Duration::ZERO) };
    for (number, taken, result) in done {
        if taken > report.slowest.1 {
            report.slowest = (number, taken);
        }
        let result = match result {
            Ok(_) if taken > LIMIT => Err(format!("takes {:.1} s", taken.as_secs_f64())),
            other => other,
        };
        report.results.push(match result {
            Ok(value) => Some(value),
            Err(why) => {
                report.failures.push((number, why));
                None
            }
        });
    }
    report
}
