//! Threads for one call: started for it and gone with it, so that a fork finds none.

use std::sync::Mutex;
use std::thread::Builder;

/// Does `work` on each task with up to `workers` threads; the results come in the tasks' order.
/// A panic in a task is a panic here.
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
            // The lock guards only the taking, so that no panic of a task poisons it.
            let next = queue.lock().ok().and_then(|mut queue| queue.next());
            let Some((task, result)) = next else { break };
            *result = Some(work(task));
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            // Where the system gives no more threads, those that there are do it all.
            if Builder::new().spawn_scoped(scope, run).is_err() {
                break;
            }
        }
        run();
    });
    drop(queue);
    results.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

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
