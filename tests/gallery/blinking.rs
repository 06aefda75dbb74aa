//! The stripes of the lamp that blinks.

use super::Exhibit;
use crate::support::{close, edge, light_to, near, v};
use terrell::spacetime::Event;

const BETA: f64 = 0.9;
/// From lighting up to lighting up by the lamp's own clock, metres.
const PERIOD: f64 = 2.0;

/// Where light begins and ends on the line of the floor below the lamp's way, at the lab's time zero, when the lamp is at z = 0.
fn ends(exhibit: &Exhibit, from: f64, to: f64, steps: u32) -> Vec<f64> {
    let lit = |z: f64| {
        let place = v(0.0, 0.0, z);
        exhibit.shows_lamplight(&light_to(place + v(0.2, 4.0, 0.1), Event::new(0.0, place)))
    };
    let at = |step: u32| from + (to - from) * f64::from(step) / f64::from(steps);
    let (mut found, mut last) = (Vec::new(), lit(from));
    for step in 1..=steps {
        let now = lit(at(step));
        if now != last {
            found.push(edge(at(step - 1), at(step), |z| lit(z) == last));
        }
        last = now;
    }
    found
}

/// The lamp lights up, or goes out, whenever half a period of its own has gone: at `tₖ = -γ k P/2` at `(0, 3, -β tₖ)`. At time zero
/// that light is on the floor line where
///
/// ~~~text
/// (z + β tₖ)² + 3² = tₖ²
/// ~~~
///
/// and far ahead its fronts are `γP(1 - β)` apart, far behind `γP(1 + β)`: a period over the Doppler factor there.
#[test]
fn stripes_of_the_blinking_lamp_are_a_period_apart_over_the_doppler_factor() {
    let exhibit = Exhibit::of("blinking");
    let gamma = 1.0 / ((1.0 - BETA) * (1.0 + BETA)).sqrt();
    let spacing = |ends: &[f64], way: f64| {
        for end in ends {
            // The number of the front that is nearest, and where it is.
            let ago = |k: f64| 0.5 * gamma * PERIOD * k;
            let front = |k: f64| BETA * ago(k) + way * (ago(k) * ago(k) - 9.0).sqrt();
            let k = (end / (0.5 * gamma * PERIOD * (BETA + way))).round();
            near(*end, front(k), 1e-9 * end.abs());
        }
        2.0 * (ends[ends.len() - 1] - ends[0]) / (ends.len() - 1) as f64
    };
    // Ahead is -z.
    let ahead = spacing(&ends(&exhibit, -110.0, -100.0, 400), -1.0);
    let behind = spacing(&ends(&exhibit, 2000.0, 2100.0, 400), 1.0);
    let doppler = ((1.0 + BETA) / (1.0 - BETA)).sqrt();
    close(ahead, PERIOD / doppler, 1e-3);
    close(behind, PERIOD * doppler, 1e-5);
    close(behind / ahead, 19.0, 1e-3);
}
