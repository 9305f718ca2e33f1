//! Threads for one call, which are joined at its end, so that a fork never inherits any.

use std::sync::Mutex;
use std::thread::Builder;

use crate::base::error::Result;
use crate::base::watch::Watch;

/// Runs `work` on each task with up to `workers` threads; returns the results in the order of the
/// tasks. A panic in a task is a panic here.
pub fn map<T: Send, R: Send>(
    workers: usize,
    tasks: Vec<T>,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    let threads = workers.min(tasks.len());
    if threads <= 1 {
        return tasks.into_iter().map(work).collect();
    }
    let mut results: Vec<Option<R>> = tasks.iter().map(|_| None).collect();
    let queue = Mutex::new(tasks.into_iter().zip(&mut results));
    let run = || {
        loop {
            // The lock guards only taking a task, so a panic in a task does not poison it.
            let next = queue.lock().ok().and_then(|mut queue| queue.next());
            let Some((task, result)) = next else { break };
            *result = Some(work(task));
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            // If the system refuses another thread, the existing ones do all the work.
            if Builder::new().spawn_scoped(scope, run).is_err() {
                break;
            }
        }
        run();
    });
    drop(queue);
    results.into_iter().flatten().collect()
}

/// The same with a check for interruption before each task.
pub fn map_watched<T: Send, R: Send>(
    workers: usize,
    tasks: Vec<T>,
    watch: &Watch,
    work: impl Fn(T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let ends = map(workers, tasks, |task| {
        watch.check()?;
        work(task)
    });
    ends.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::base::error::Error;

    #[test]
    fn an_interruption_ends_it_between_two_tasks() {
        for workers in [1, 3] {
            let (asked, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
            let stop = || asked.fetch_add(1, Ordering::Relaxed) >= 5;
            let ended = map_watched(workers, vec![(); 100], &Watch::new(&stop), |()| {
                done.fetch_add(1, Ordering::Relaxed);
                Ok(())
            });
            assert_eq!((ended, done.into_inner()), (Err(Error::Interrupted), 5));
        }
    }

    #[test]
    fn results_keep_the_order_of_tasks() {
        for workers in [1, 2, 3, 64] {
            let squares = map(workers, (0..100).collect(), |i: u64| i * i);
            assert_eq!(squares, (0..100).map(|i| i * i).collect::<Vec<_>>());
        }
    }

    #[test]
    #[should_panic]
    fn a_panic_of_a_task_is_not_lost() {
        map(2, vec![1, 0, 1], |i: u32| 1 / i);
    }
}
