//! All integration tests, in one program.
#![expect(clippy::unwrap_used, reason = "a test that fails may panic")]

mod manifest;
