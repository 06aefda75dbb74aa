//! Time and memory told beforehand. (How right they are is measured by tools/cost.)

use crate::support::manifested;
use terrell::plan::cost::estimate;

const FILM: &str = include_str!("survive/film.yaml");

#[test]
fn time_grows_with_pixels_samples_and_pictures() {
    let all = |change: (&str, &str)| {
        let (_, scene, plan) = manifested(&FILM.replace(change.0, change.1));
        estimate(&scene, &plan).all
    };
    // Ten times as much each; the machine may be busy with something else.
    let base = all(("samples: 4", "samples: 4"));
    for change in [("samples: 4", "samples: 64"), ("64 48", "256 192"), ("count: 12", "count: 192")] {
        let times = all(change) / base;
        assert!((4.0..64.0).contains(&times), "{change:?}: {times}");
    }
}

#[test]
fn film_of_one_picture_over_and_over_costs_little_more_than_the_picture() {
    let still = FILM.replace("velocity: 0.6 0 0 c, ", "");
    let cost = |count: &str| {
        let (_, scene, plan) = manifested(&still.replace("count: 12", count));
        assert!(plan.still);
        estimate(&scene, &plan).all
    };
    assert!(cost("count: 48") < 8.0 * cost("count: 2"));
}

#[cfg(target_os = "linux")]
#[test]
fn memory_grows_with_the_size_of_the_picture() {
    let memory = |size: &str| {
        let (_, scene, plan) = manifested(&FILM.replace("64 48", size));
        estimate(&scene, &plan).memory.unwrap()
    };
    let more = memory("3840 2160") - memory("64 48");
    // Three pictures of three numbers in 32 bits at least.
    assert!(more > 8e6 * 36.0, "{more}");
}
