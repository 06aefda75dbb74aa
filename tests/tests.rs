//! All integration tests in one binary, one module per law or requirement.
mod import;
