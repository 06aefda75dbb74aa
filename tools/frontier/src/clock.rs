//! Time that the processor has spent, so that what else runs on the machine counts as little as can be.

use std::time::Instant;

/// Seconds of processor time of all threads so far; none where the system does not say (elsewhere than on Linux).
fn spent() -> Option<f64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let of = |task: std::fs::DirEntry| {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse::<f64>().ok()
    };
    let nanoseconds: f64 = tasks.flatten().filter_map(of).sum();
    (nanoseconds > 0.0).then_some(nanoseconds * 1e-9)
}

/// What `of` gives, and the processor time of all threads that it took, seconds.
pub fn timed<T>(of: impl FnOnce() -> T) -> (T, f64) {
    let (start, before) = (Instant::now(), spent());
    let value = of();
    let wall = start.elapsed().as_secs_f64() * rayon::current_num_threads() as f64;
    (value, spent().zip(before).map_or(wall, |(after, before)| after - before))
}
