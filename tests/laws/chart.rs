//! The colours of the Macbeth chart by as many wavelengths as the program samples, against the whole integral.

use crate::support::{Body, Eye, Lantern, Stage, built, ciede2000, lab, speed, square, v};
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write;
use std::sync::LazyLock;
use terrell::color::{LUMENS_PER_WATT, matching};
use terrell::lamp::Beam;
use terrell::spectrum::{Illuminant, Reflectance, Source, Spectrum, Table, Wavelengths};
use terrell::surface::{Paint, Scatter, Surface};

const SPEEDS: [f64; 5] = [-0.3, -0.1, 0.0, 0.1, 0.3];
/// Numbers of wavelengths, and the largest ΔE that is allowed of each, at rest and in motion.
const BOUNDS: [(usize, f64, f64); 4] = [(8, 4.0, 9.0), (16, 0.5, 2.5), (32, 0.2, 0.7), (64, 0.12, 0.2)];

/// Names and reflectances of the patches.
static PATCHES: LazyLock<Vec<(String, Table)>> = LazyLock::new(|| {
    let mut lines = include_str!("../spectrum/macbeth.csv").lines().filter(|line| !line.starts_with('#'));
    let names = lines.next().unwrap().split(',').skip(1);
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect();
    let patch = |column: usize| Table::new(rows.iter().map(|row| (row[0], row[column + 1]))).unwrap();
    names.enumerate().map(|(column, name)| (name.to_owned(), patch(column))).collect()
});

fn light(illuminant: Illuminant) -> Source {
    Source::new(&Spectrum::Illuminant(illuminant), 1.0)
}

/// XYZ of a radiance by steps of 0.1 nm: what an endless number of wavelengths would give.
fn whole(radiance: impl Fn(f64) -> f64) -> DVec3 {
    let step = 0.1;
    (0..=4700).map(|i| 360.0 + step * f64::from(i)).map(|nm| matching(nm) * radiance(nm)).sum::<DVec3>()
        * (LUMENS_PER_WATT * step)
}

/// Where a patch hangs; all face +z.
fn place(number: usize) -> DVec3 {
    v((number % 6) as f64, -((number / 6) as f64), 0.0)
}

/// The chart in the light of a sun at rest beside it, as tracing shows each patch to who comes straight up to it at β.
fn seen<const N: usize>(illuminant: Illuminant, beta: f64) -> Vec<DVec3> {
    let patches = PATCHES.iter().enumerate().map(|(number, (_, table))| {
        let paint = Paint::Even(Reflectance::Table(table.clone()));
        Body::new(&built(square()), Surface::new(Scatter::Diffuse(paint))).sized(0.4).at(0.0, place(number))
    });
    let sun = Lantern::at(0.0, DVec3::ZERO, light(illuminant)).with(Beam::Sun { axis: DVec3::NEG_Z });
    let scene = Stage::of(patches).lit_by([sun]).scene();
    let wavelengths = Wavelengths::<N>::new();
    let look = |number: usize| {
        let eye = Eye::at(0.0, place(number) + v(0.01, 0.02, 5.0)).moving(speed(beta, DVec3::NEG_Z));
        wavelengths.xyz(&scene.lit().seen(&eye.sight(DVec3::NEG_Z), &wavelengths).radiance)
    };
    (0..PATCHES.len()).map(look).collect()
}

/// The same by the law: L(λ) = D⁵ ρ(Dλ) E(Dλ)/π.
fn exact(illuminant: Illuminant, beta: f64) -> Vec<DVec3> {
    let (doppler, light) = (((1.0 + beta) / (1.0 - beta)).sqrt(), light(illuminant));
    let radiance =
        |table: &Table, nm: f64| doppler.powi(5) / PI * table.at(nm * doppler) * light.at(nm * doppler);
    PATCHES.iter().map(|(_, table)| whole(|nm| radiance(table, nm))).collect()
}

/// ΔE of each patch for the numbers of wavelengths, beside the white of the perfect diffuser at rest in the same light.
fn differences(illuminant: Illuminant, beta: f64) -> [Vec<f64>; 4] {
    let source = light(illuminant);
    let white = whole(|nm| source.at(nm) / PI);
    let exact = exact(illuminant, beta);
    let counts = [
        seen::<8>(illuminant, beta),
        seen::<16>(illuminant, beta),
        seen::<32>(illuminant, beta),
        seen::<64>(illuminant, beta),
    ];
    counts.map(|seen| {
        seen.iter()
            .zip(&exact)
            .map(|(seen, exact)| ciede2000(lab(*seen, white), lab(*exact, white)))
            .collect()
    })
}

/// Light, β, and for each number of wavelengths the largest and the mean ΔE.
type Row = (Illuminant, f64, [(f64, f64); 4]);

static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let row = |illuminant: Illuminant, beta: f64| {
        let parts = differences(illuminant, beta).map(|of| {
            let sum: f64 = of.iter().sum();
            (of.iter().copied().fold(0.0, f64::max), sum / of.len() as f64)
        });
        (illuminant, beta, parts)
    };
    [Illuminant::D65, Illuminant::A].into_iter().flat_map(|of| SPEEDS.map(|beta| row(of, beta))).collect()
});

const HEAD: &str = "
## Colour by the number of wavelengths

CIEDE2000 between what tracing shows with 8, 16, 32 and 64 wavelengths and the whole integral (0.1 nm), over the 24 patches
of the Macbeth chart (spectra of Ohta 1997, 5 nm, linear in between, the ends held): the largest difference, and the mean.
Chart and lamp rest beside each other, the observer comes up at β (recedes where β is negative). White and exposure are
those of the perfect diffuser at rest in the same light, also where the chart in motion is brighter or darker than it: so
only the sum over wavelengths counts. What approaches is up to ten times as bright as that white, and ΔE says little
there: it was made for colours of surfaces.

| light | β | 8: max, mean | 16: max, mean | 32: max, mean | 64: max, mean |
| --- | --- | --- | --- | --- | --- |
";

/// For the book of laws.
pub(super) fn table() -> String {
    let up = |value: f64| libm::ceil(value * 100.0) / 100.0;
    let mut text = String::from(HEAD);
    for (illuminant, beta, parts) in ROWS.iter() {
        let cells = parts.map(|(most, mean)| format!("{:.2}, {:.2}", up(most), up(mean))).join(" | ");
        writeln!(text, "| {illuminant:?} | {beta} | {cells} |").unwrap();
    }
    text.push_str("\nBounds:");
    for (count, rest, motion) in BOUNDS {
        write!(text, " {count} wavelengths at rest {rest}, in motion {motion};").unwrap();
    }
    text.push_str(" the mean below half of them.\n");
    text
}

#[test]
fn colours_of_the_chart_are_within_their_bounds() {
    for (illuminant, beta, parts) in ROWS.iter() {
        for ((count, rest, motion), (most, mean)) in BOUNDS.iter().zip(parts) {
            let bound = if *beta == 0.0 { *rest } else { *motion };
            assert!(
                *most <= bound && *mean <= 0.5 * bound,
                "{illuminant:?}, β = {beta}, {count}: {most}, {mean}"
            );
        }
    }
}

#[test]
fn chart_has_its_24_patches_and_its_greys_are_grey() {
    assert_eq!(PATCHES.len(), 24);
    let daylight = light(Illuminant::D65);
    let white = whole(|nm| daylight.at(nm));
    let labs: Vec<DVec3> =
        PATCHES.iter().map(|(_, table)| lab(whole(|nm| daylight.at(nm) * table.at(nm)), white)).collect();
    // From white to black, Munsell value 9.5 to 2: L* is near ten times that.
    for (lab, value) in labs[18..].iter().zip([9.5, 8.0, 6.5, 5.0, 3.5, 2.0]) {
        assert!((lab.x - 10.0 * value).abs() < 3.0 && lab.y.hypot(lab.z) < 3.0, "{lab}");
    }
}
