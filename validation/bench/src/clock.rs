//! The clock: processor time of the thread that asks. What other programs take of a busy machine
//! does not count, neither for a run of microseconds nor for one of half a second, which no quiet
//! moment holds.

use std::time::Duration;

/// A stopwatch that reads the time since its start.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    began: Duration,
}

impl Stopwatch {
    /// Starts the clock.
    #[must_use]
    pub fn start() -> Self {
        Self { began: now() }
    }

    /// Nanoseconds since the start.
    #[must_use]
    pub fn nanoseconds(&self) -> f64 {
        now().saturating_sub(self.began).as_secs_f64() * 1e9
    }
}

#[cfg(any(target_os = "linux", target_os = "macos"))]
fn now() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// The wall time, where a thread's own time cannot be asked for: best-of batches then hide less.
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn now() -> Duration {
    use std::sync::OnceLock;
    use std::time::Instant;
    static ORIGIN: OnceLock<Instant> = OnceLock::new();
    ORIGIN.get_or_init(Instant::now).elapsed()
}
