//! Pictures whose pixels share their samples with their neighbours.

use crate::support::{close, manifested, near};
use terrell::chart::Deviation;
use terrell::exposure::{Sampling, expose_converged, expose_settled};
use terrell::film::{Development, Reconstruction};

const FILTERS: [Reconstruction; 3] = [Reconstruction::Box, Reconstruction::Tent, Reconstruction::Gaussian];

/// A plate that shines before darkness, one corner of which is seen from straight in front, a third and a fifth of a pixel from the
/// corner of four pixels: at 1 m of 2 m across and 20 pixels, a pixel is 0.1 m wide.
const PLATE: &str = "
light_speed: 1 m/s
assets: { plate: { box: { size: 2 2 0.001 m } } }
bodies:
  - { asset: plate, at: 1.033333333333333333 -1.02 -1.0005 m, material: { emission: { luminance: 50 cd/m2 } } }
observer: { at: 0 0 0 m, direction: 0 0 -1, field_of_view: 90 deg }
exposures: { at: 0 s }
picture: { size: 20 20, white: 100 cd/m2 }
output: out
";

/// The weight of a filter up to so far from the centre.
fn up_to(filter: Reconstruction, end: f64) -> f64 {
    let (steps, width) = (40_000, (end + 2.0) / 40_000.0);
    (0..steps).map(|i| filter.density(-2.0 + (f64::from(i) + 0.5) * width) * width).sum()
}

#[test]
fn corner_of_a_plate_has_the_filters_weight_on_it() {
    let (_, scene, plan) = manifested(PLATE);
    let view = scene.observer.view(0.0, 20, 20);
    for filter in FILTERS {
        for (samples, bound) in [(64, 0.02), (1024, 0.002)] {
            let sampling = Sampling { samples, reconstruction: filter, ..plan.sampling };
            let picture = expose_converged(&scene.lit(), &view, &sampling);
            for (number, xyz) in picture.xyz.iter().enumerate() {
                // The plate is to the right of 10 + 1/3 and below 10 + 1/5 pixels.
                let (column, row) = ((number % 20) as f64 + 0.5, (number / 20) as f64 + 0.5);
                let weight = (1.0 - up_to(filter, 10.0 + 1.0 / 3.0 - column))
                    * (1.0 - up_to(filter, 10.0 + 1.0 / 5.0 - row));
                near(f64::from(xyz[1]) / 50.0, weight, bound);
            }
        }
    }
}

/// However few the samples, and at the picture's border, too.
#[test]
fn even_light_stays_even() {
    const SKY: &str = "
light_speed: 1 m/s
surroundings: { uniform: { luminance: 20 cd/m2 } }
observer: { at: 0 0 6 m, direction: 0 0 -1, field_of_view: 40 deg }
exposures: { at: 0 s }
picture: { size: 9 7, white: 100 cd/m2 }
output: out
";
    let (_, scene, plan) = manifested(SKY);
    let view = scene.observer.view(0.0, 9, 7);
    for filter in FILTERS {
        for samples in [4, 8, 32] {
            let sampling = Sampling { samples, reconstruction: filter, ..plan.sampling };
            for xyz in expose_converged(&scene.lit(), &view, &sampling).xyz {
                close(f64::from(xyz[1]), 20.0, 1e-6);
            }
        }
    }
}

#[test]
fn smallest_pictures_settle() {
    let (_, scene, plan) = manifested(PLATE);
    let development = Development::new(100.0, 1.0);
    for (width, height) in [(1, 1), (3, 5), (5, 2)] {
        let view = scene.observer.view(0.0, width, height);
        for filter in FILTERS {
            let sampling = Sampling { width, height, samples: 1024, reconstruction: filter, ..plan.sampling };
            let settled = expose_settled(&scene.lit(), &view, &sampling, &development, 1.0);
            let converged = expose_converged(&scene.lit(), &view, &sampling);
            let off = Deviation::between(&settled.negative, &converged, &development).shown;
            assert!(off.p99 <= 1.0 && settled.error.p99 <= 1.0, "{width} x {height}, {filter:?}: {off:?}");
        }
    }
}
