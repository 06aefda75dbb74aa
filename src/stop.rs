//! Work that can be asked to stop: everything long looks here from time to time.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// What may ask for a stop. Whoever sees it set leaves what is unfinished and keeps what is finished.
#[derive(Debug, Clone, Default)]
pub struct Stop(Vec<Arc<AtomicBool>>);

impl Stop {
    /// Nothing asks.
    pub fn never() -> Self {
        Self::default()
    }

    /// Whoever sets this flag asks.
    pub fn when(flag: Arc<AtomicBool>) -> Self {
        Self(vec![flag])
    }

    /// Whoever sets this flag asks, too.
    #[must_use]
    pub fn or(mut self, flag: Arc<AtomicBool>) -> Self {
        self.0.push(flag);
        self
    }

    /// Whether a stop has been asked for.
    pub fn is_set(&self) -> bool {
        self.0.iter().any(|flag| flag.load(Relaxed))
    }
}
