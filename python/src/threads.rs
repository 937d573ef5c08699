//! The threads that share work, in a process that was forked too: it inherits rayon's pool without
//! the threads, and whoever waits for them waits for ever.

use pyo3::prelude::Python;
use rayon::ThreadPoolBuilder;
use std::process;
use std::sync::OnceLock;

/// The process that has imported the package.
static IMPORTED_BY: OnceLock<u32> = OnceLock::new();

thread_local! {
    /// Whether this thread is a pool of its own, which needs no other thread.
    static IS_ALONE: bool = ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build()
        .map(std::mem::forget)
        .is_ok();
}

/// Remembers the process by which the package is imported.
pub(crate) fn remember_process() {
    IMPORTED_BY.get_or_init(process::id);
}

fn is_forked() -> bool {
    IMPORTED_BY.get().is_some_and(|it| *it != process::id())
}

/// Does work on this thread, which in a forked process shares it with no other.
pub(crate) fn on_this_thread<T>(work: impl FnOnce() -> T) -> T {
    if is_forked() {
        IS_ALONE.with(|_| ());
    }
    work()
}

/// Does work without Python's lock on this thread.
pub(crate) fn without_lock<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    py.detach(|| on_this_thread(work))
}

/// Does work on all threads: in a forked process on those of a new pool.
pub(crate) fn on_all_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if !is_forked() {
        return work();
    }
    match ThreadPoolBuilder::new().build() {
        Ok(pool) => pool.install(work),
        Err(_) => on_this_thread(work),
    }
}
