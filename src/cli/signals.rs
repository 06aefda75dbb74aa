//! Ctrl-C, and a request to end (TERM): what is in the making is brought to an end first, where anything is.

use crate::stop::Stop;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, Ordering::SeqCst};
use std::sync::{Arc, LazyLock};

/// The exit code, as shells have it for Ctrl-C.
const STOPPED: i32 = 130;

struct Signals {
    // A signal has come.
    stop: Arc<AtomicBool>,
    // The next one ends the process at once.
    at_once: Arc<AtomicBool>,
}

static SIGNALS: LazyLock<Signals> = LazyLock::new(|| Signals {
    stop: Arc::new(AtomicBool::new(false)),
    at_once: Arc::new(AtomicBool::new(true)),
});

/// From now on signals are ours. Those that are to be ignored (jobs in the background of a script) still are.
pub(super) fn take() {
    for signal in [SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal)) {
        // In this order: the first one ends the process if that is how things stand, and then the second will.
        let taken = flag::register_conditional_shutdown(signal, STOPPED, SIGNALS.at_once.clone())
            .and_then(|_| flag::register(signal, SIGNALS.at_once.clone()))
            .and_then(|_| flag::register(signal, SIGNALS.stop.clone()));
        if taken.is_err() {
            return; // Then they do what they always do.
        }
    }
}

/// Does what looks whether it is to stop: the first signal asks for that, and only the second ends the process.
pub(super) fn gently<T>(work: impl FnOnce(&Stop) -> T) -> T {
    SIGNALS.at_once.store(false, SeqCst);
    let done = work(&Stop::when(SIGNALS.stop.clone()));
    SIGNALS.at_once.store(true, SeqCst);
    done
}

/// Whether whoever started this process wants a signal to be ignored, as far as that can be told.
fn is_ignored(signal: i32) -> bool {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return false };
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}
