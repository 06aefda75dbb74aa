//! The laws written down.

use super::{BOOK, Law, chart};
use std::fmt::Write;
use std::path::Path;

/// Rounded up: to 1, 2 or 5 times a power of ten, below 1e-9 to a power of ten. The table then stays as it is where only
/// the rounding of numbers changes.
fn rounded(error: f64) -> String {
    if error == 0.0 || !error.is_finite() {
        return error.to_string();
    }
    let power = libm::floor(libm::log10(error)) as i32;
    let steps: &[f64] = if error < 1e-9 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let fits = |step: &&f64| format!("{step}e{power}").parse::<f64>().unwrap() >= error;
    match steps.iter().find(fits) {
        Some(step) => format!("{step}e{power}"),
        None => format!("1e{}", power + 1),
    }
}

fn row(law: &Law) -> String {
    let (error, bound) = (rounded(*law.error), law.bound);
    // A bar would end the cell.
    let form = law.form.replace('|', "\\|");
    format!("| {} | {} | {form} | {} | {error} | {bound:e} |\n", law.sentence(), law.number, law.source)
}

const HEAD: &str = "\
# The laws that the program is held to

Written by `TERRELL_UPDATE=1 cargo test --release --test tests -- laws`; do not edit. `cargo test` fails if it is stale.

Each law is measured over a sweep of speeds, directions and places, off every axis, against its closed form worked out in
the test. The error is the largest of the sweep: a part of the value for powers and frequencies, radians for angles, metres
for places, unless the law says otherwise; it is rounded up to 1, 2 or 5 times a power of ten (below 1e-9 to a power of
ten). The name of a law is that of its test. V is the number of the requirement that it answers: 1 aberration, 2 Doppler
effect, 3 radiance and colour, 4 the outline of a sphere, 5 Terrell's rotation, 6 rods and apparent speed, 7 places seen,
8 lines, planes and dice, 9 worldlines, 10 mirrors, 11 media, 12 lamps, 13 shadows, 14 Wigner's rotation, 15 what changes nothing.

β: speed in c; γ: Lorentz factor; D: frequency seen over frequency sent; θ: from the motion to the source, primed as the
moving observer sees it; n: the way of the light, or an index; k: its wave vector; τ: proper time. c = 1.
";

fn table() -> String {
    let mut text = String::from(HEAD);
    for chapter in BOOK {
        write!(text, "\n## {}\n\n", chapter.title).unwrap();
        text.push_str(
            "| law | V | closed form | source | error | bound |\n| --- | --- | --- | --- | --- | --- |\n",
        );
        chapter.laws.iter().for_each(|law| text.push_str(&row(law)));
    }
    text + &chart::table()
}

#[test]
fn table_of_laws_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/LAWS.md");
    let now = table();
    if std::env::var_os("TERRELL_UPDATE").is_some() {
        std::fs::write(&path, &now).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = written.lines().zip(now.lines()).find(|(a, b)| a != b);
    assert!(
        written == now,
        "tests/LAWS.md is stale: run TERRELL_UPDATE=1 cargo test --release --test tests -- laws\n{differs:?}"
    );
}

#[test]
fn errors_are_rounded_up() {
    for (error, text) in [
        (0.0, "0"),
        (1e-3, "1e-3"),
        (1.1e-3, "2e-3"),
        (2e-3, "2e-3"),
        (2.1e-3, "5e-3"),
        (5.1e-3, "1e-2"),
        (3e-13, "1e-12"),
        (1e-12, "1e-12"),
    ] {
        assert_eq!(rounded(error), text);
    }
}
