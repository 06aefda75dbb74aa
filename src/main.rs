//! Renders what a camera would really see when things move near the speed of light.

use std::process::ExitCode;

fn main() -> ExitCode {
    terrell::cli::run()
}
