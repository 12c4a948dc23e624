//! Work on all processors whose results are taken in order; what waits to be taken is bounded by its bytes.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

/// Bytes of results that may wait to be taken, the one that is being taken among them. While more wait, nothing further is begun: at
/// most one result of each thread goes beyond.
pub(super) const MOST_WAITING: usize = 64 << 20;

/// What a result takes beside its bytes.
const OVERHEAD: usize = 256;

/// Works on the items, with so many threads, and hands the results over in order until `take` has enough; the flag of what then still
/// runs is raised. The work tells the bytes of its result as well.
///
/// Items are begun in order, and whoever has begun ends without waiting. So the result that is to be taken next is there, or on its way,
/// or nothing waits and it can be begun: however large the results are, the work goes on.
pub(super) fn in_order<I: Sync, R: Send>(
    items: &[I],
    threads: usize,
    work: impl Fn(usize, &I, &AtomicBool) -> (R, usize) + Sync,
    mut take: impl FnMut(usize, R) -> ControlFlow<()>,
) {
    let (queue, work) = (&Queue::new(), &work);
    thread::scope(|scope| {
        // Also where `take` panics: the threads do not wait for it then.
        let _end = End(queue);
        for _ in 0..threads.min(items.len()) {
            scope.spawn(move || {
                // A thread that panics ends the others; its panic goes on at the end of the scope.
                let end = End(queue);
                while let Some((index, item)) = queue.begin(items) {
                    queue.put(index, work(index, item, &queue.interrupt));
                }
                std::mem::forget(end);
            });
        }
        for index in 0..items.len() {
            let Some((result, bytes)) = queue.get(index) else { break };
            if take(index, result).is_break() {
                break;
            }
            queue.taken(bytes);
        }
    });
}

/// What the threads have in common.
struct Queue<R> {
    state: Mutex<State<R>>,
    /// Notified when the state has changed.
    changed: Condvar,
    /// The flag of the work; raised when no result is taken any more.
    interrupt: AtomicBool,
}

struct State<R> {
    /// The item that is begun next.
    next: usize,
    results: BTreeMap<usize, (R, usize)>,
    /// The bytes of the results, and of the one that is being taken.
    waiting: usize,
}

impl<R> Queue<R> {
    fn new() -> Self {
        let state = State { next: 0, results: BTreeMap::new(), waiting: 0 };
        Self { state: Mutex::new(state), changed: Condvar::new(), interrupt: AtomicBool::new(false) }
    }

    /// The next item, once there is room for its result; none after the last, or after the end.
    fn begin<'a, I>(&self, items: &'a [I]) -> Option<(usize, &'a I)> {
        let mut state = self.wait_while(|state| state.waiting > MOST_WAITING);
        let index = state.next;
        let item = items.get(index).filter(|_| !self.has_ended())?;
        state.next += 1;
        Some((index, item))
    }

    fn put(&self, index: usize, result: (R, usize)) {
        let mut state = self.lock();
        state.waiting += result.1 + OVERHEAD;
        state.results.insert(index, result);
        self.changed.notify_all();
    }

    /// The result of an item, once it is there; none after the end.
    fn get(&self, index: usize) -> Option<(R, usize)> {
        self.wait_while(|state| !state.results.contains_key(&index)).results.remove(&index)
    }

    /// A result of so many bytes waits no longer.
    fn taken(&self, bytes: usize) {
        self.lock().waiting -= bytes + OVERHEAD;
        self.changed.notify_all();
    }

    fn has_ended(&self) -> bool {
        self.interrupt.load(Ordering::Relaxed)
    }

    /// The state; a thread that panicked did so at its work, and left it sound.
    fn lock(&self) -> MutexGuard<'_, State<R>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state, once the condition holds no more, or after the end.
    fn wait_while(&self, condition: impl Fn(&State<R>) -> bool) -> MutexGuard<'_, State<R>> {
        let waiting = |state: &mut State<R>| !self.has_ended() && condition(state);
        self.changed.wait_while(self.lock(), waiting).unwrap_or_else(PoisonError::into_inner)
    }
}

/// Ends all waiting when it is dropped.
struct End<'a, R>(&'a Queue<R>);

impl<R> Drop for End<'_, R> {
    fn drop(&mut self) {
        // Under the lock, so that nobody is between looking at the flag and waiting.
        let _state = self.0.state.lock();
        self.0.interrupt.store(true, Ordering::Relaxed);
        self.0.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    use std::thread::sleep;
    use std::time::Duration;

    use super::{MOST_WAITING, OVERHEAD, in_order};

    #[test]
    fn results_are_taken_in_order_however_large_they_are() {
        for bytes in [0, MOST_WAITING / 10, MOST_WAITING - OVERHEAD, MOST_WAITING, 3 * MOST_WAITING] {
            for threads in [1, 2, 7, 300] {
                let items: Vec<_> = (0..200).collect();
                // The first of every ten takes longest.
                let work = |index: usize, item: &usize, _: &_| {
                    sleep(Duration::from_micros(if index.is_multiple_of(10) { 500 } else { 0 }));
                    (index + item, bytes)
                };
                let mut taken = Vec::new();
                in_order(&items, threads, work, |index, result| {
                    taken.push((index, result));
                    ControlFlow::Continue(())
                });
                assert!(taken.into_iter().eq((0..200).map(|index| (index, 2 * index))), "{bytes} {threads}");
            }
        }
    }

    #[test]
    fn what_waits_is_bounded_whatever_the_number_of_threads() {
        for threads in [1, 2, 16] {
            let begun = AtomicUsize::new(0);
            let work = |_: usize, (): &(), _: &_| {
                begun.fetch_add(1, Ordering::Relaxed);
                ((), MOST_WAITING / 10)
            };
            let mut most = 0;
            in_order(&[(); 100], threads, work, |index, ()| {
                sleep(Duration::from_millis(1));
                most = most.max(begun.load(Ordering::Relaxed) - index);
                ControlFlow::Continue(())
            });
            assert!((2..=10 + threads).contains(&most), "{most} with {threads} threads");
        }
    }

    #[test]
    fn whoever_has_enough_ends_the_work() {
        let work = |index: usize, (): &(), interrupt: &AtomicBool| {
            while index > 5 && !interrupt.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(1));
            }
            ((), MOST_WAITING)
        };
        let mut taken = 0;
        in_order(&[(); 100], 3, work, |index, ()| {
            taken += 1;
            if index == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(taken, 6);
    }

    #[test]
    fn a_panic_goes_on_and_leaves_nobody_waiting() {
        let at_work = AssertUnwindSafe(|| {
            let work = |index: usize, (): &(), _: &_| if index == 7 { panic!("at work") } else { ((), MOST_WAITING) };
            in_order(&[(); 100], 3, work, |_, ()| ControlFlow::Continue(()));
        });
        assert!(catch_unwind(at_work).is_err());
        let taking =
            AssertUnwindSafe(|| in_order(&[(); 100], 3, |_, (): &(), _| ((), MOST_WAITING), |_, ()| panic!("taking")));
        assert!(catch_unwind(taking).is_err());
    }
}
