//! The first chart: speed against error on one scene.

use crate::clock::timed;
use crate::error::{Errors, Judge};
use crate::moved::{Cloths, Cut, Moved};
use crate::panorama::Panorama;
use crate::rays;
use crate::rgb::{self, ByHue, Gaussians};
use crate::shade::{Eye, Found};
use crate::single::Single;
use crate::stage::{HEIGHT, Stage, Traffic, WIDTH, exposed};
use crate::svg::{Panel, Series, Sheet};
use glam::{DVec2, DVec3};
use std::error::Error;
use std::path::Path;
use terrell::exposure::{Sampling, expose};
use terrell::film::Reconstruction;
use terrell::scene::Scene;
use terrell::spacetime::{Poincare, SightRay, Velocity};

type Picture = Vec<DVec3>;
type Paints<'a> = Box<dyn Fn(u32) -> Picture + 'a>;

/// Samples per pixel of each point of a line.
const SAMPLES: [u32; 3] = [1, 4, 16];
/// Times each is measured.
const RUNS: usize = 3;
/// What takes longer is measured once.
const LONG_MS: f64 = 1500.0;
/// Of the reference.
const MANY: u32 = 128;

/// A method on one scene.
struct Method<'a> {
    code: String,
    name: String,
    color: &'static str,
    dashed: bool,
    paint: Paints<'a>,
    /// Pixels whose centre shows another body, percent; NaN where it is not known.
    wrong: f64,
    triangles: usize,
}

/// One measured point.
struct Point {
    samples: u32,
    ms: f64,
    errors: Errors,
}

/// The program's own picture.
pub fn ours(scene: &Scene, stage: &Stage, wavelengths: u32, samples: u32) -> Picture {
    let reconstruction = Reconstruction::default();
    let sampling = Sampling { width: WIDTH, height: HEIGHT, samples, reconstruction, wavelengths };
    let negative = expose(scene, &stage.view, &sampling);
    negative.xyz.iter().map(|xyz| DVec3::from(xyz.map(f64::from))).collect()
}

/// A picture of what a method meets, in our light.
pub fn lit<'a>(
    eye: &'a Eye<'a>,
    samples: u32,
    meet: impl Fn(&SightRay) -> Option<Found<'a>> + Sync,
) -> Picture {
    exposed(&eye.stage.view, samples, |ray, cone| eye.xyz(ray, cone, meet(ray).as_ref()))
}

/// A picture of our geometry in another light.
pub fn colored(eye: &Eye<'_>, samples: u32, of: impl Fn([f64; 3], f64) -> DVec3 + Sync) -> Picture {
    exposed(&eye.stage.view, samples, |ray, cone| match rays::by_s(eye.stage, ray) {
        Some(found) => of(found.rgb(cone), found.k.t),
        None => eye.sky(ray),
    })
}

/// Pixels, percent, whose centre shows another body than ours.
fn wrong<'a>(stage: &'a Stage, meet: impl Fn(&SightRay) -> Option<Found<'a>>) -> f64 {
    let all = WIDTH * HEIGHT;
    let differs = |i: &u32| {
        let ray = stage.view.ray(DVec2::new(f64::from(i % WIDTH) + 0.5, f64::from(i / WIDTH) + 0.5));
        meet(&ray).map(|found| found.body) != rays::by_s(stage, &ray).map(|found| found.body)
    };
    100.0 * (0..all).filter(differs).count() as f64 / f64::from(all)
}

/// The scene with γ taken from a β that was stored in so many digits.
pub fn from_beta(scene: &Scene, gamma_beta: impl Fn(DVec3) -> DVec3) -> Scene {
    let mut scene = scene.clone();
    for rest in &mut scene.world.frames {
        let beta = rest.rest_from_lab.boost().velocity().beta();
        rest.rest_from_lab =
            Poincare::to_moving(Velocity::from_proper(gamma_beta(beta)), rest.rest_from_lab.origin());
    }
    scene
}

pub fn proper64(beta: DVec3) -> DVec3 {
    beta / (1.0 - beta.length_squared()).sqrt()
}

pub fn proper32(beta: DVec3) -> DVec3 {
    let beta = beta.as_vec3();
    (beta / (1.0 - beta.length_squared()).sqrt()).as_dvec3()
}

fn method<'a>(code: &str, name: &str, color: &'static str, dashed: bool, paint: Paints<'a>) -> Method<'a> {
    Method { code: code.into(), name: name.into(), color, dashed, paint, wrong: f64::NAN, triangles: 0 }
}

const OURS: [(u32, &str); 4] = [(8, "#9db7ff"), (16, "#3b6ef5"), (32, "#1f3fb0"), (64, "#0a1a5c")];
const MOVED: [(u32, &str); 4] = [(0, "#f6b26b"), (1, "#e69138"), (2, "#b45f06"), (3, "#7a3f00")];
const PANORAMAS: [(usize, &str); 4] =
    [(512, "#a8d5a2"), (1024, "#6fbf69"), (2048, "#3a8f3a"), (4096, "#1d5c22")];

fn our_methods<'a>(stage: &'a Stage, eye: &'a Eye<'a>) -> Vec<Method<'a>> {
    let mut methods: Vec<Method<'a>> = OURS
        .iter()
        .map(|(n, color)| {
            let paint = move |samples| ours(&stage.scene, stage, *n, samples);
            method(&format!("{n}"), &format!("ours, {n} wavelengths"), color, false, Box::new(paint))
        })
        .collect();
    let paint = move |samples| lit(eye, samples, |ray| rays::by_s(stage, ray));
    methods.push(method("16*", "ours as the rivals run, 16 wavelengths", "#3b6ef5", true, Box::new(paint)));
    methods
}

fn precision_methods<'a>(stage: &'a Stage, eye: &'a Eye<'a>, single: &'a Single<'a>) -> Vec<Method<'a>> {
    let by_time = move |samples| lit(eye, samples, |ray| rays::by_time(stage, ray));
    let f32s = move |samples| lit(eye, samples, |ray| single.meet(ray));
    let (in64, in32) = (from_beta(&stage.scene, proper64), from_beta(&stage.scene, proper32));
    let g64 = move |samples| ours(&in64, stage, 16, samples);
    let g32 = move |samples| ours(&in32, stage, 16, samples);
    let mut methods = vec![
        method("T", "unit directions, compared by time", "#00a0a0", true, Box::new(by_time)),
        method("f32", "f32 throughout", "#d00000", true, Box::new(f32s)),
        method("γ64", "γ from β, f64", "#888888", true, Box::new(g64)),
        method("γ32", "γ from β, f32", "#444444", true, Box::new(g32)),
    ];
    methods[0].wrong = wrong(stage, |ray| rays::by_time(stage, ray));
    methods[1].wrong = wrong(stage, |ray| single.meet(ray));
    methods
}

fn moved_method<'a>(
    eye: &'a Eye<'a>,
    cloths: &'a Cloths,
    code: &str,
    name: &str,
    color: &'static str,
) -> Method<'a> {
    let stage = eye.stage;
    let paint = move |samples| {
        let moved = Moved::new(stage, cloths);
        exposed(&stage.view, samples, |ray, cone| eye.xyz(ray, cone, moved.meet(ray).as_ref()))
    };
    let moved = Moved::new(stage, cloths);
    let of = |ray: &SightRay| moved.meet(ray).map(|found| found.body);
    let all = WIDTH * HEIGHT;
    let differs = |i: &u32| {
        let ray = stage.view.ray(DVec2::new(f64::from(i % WIDTH) + 0.5, f64::from(i / WIDTH) + 0.5));
        of(&ray) != rays::by_s(stage, &ray).map(|found| found.body)
    };
    let wrong = 100.0 * (0..all).filter(differs).count() as f64 / f64::from(all);
    let triangles = moved.triangles();
    Method { wrong, triangles, ..method(code, name, color, false, Box::new(paint)) }
}

fn color_methods<'a>(eye: &'a Eye<'a>, judge: &Judge) -> Vec<Method<'a>> {
    let mut hues: Vec<(f64, ByHue)> = (0..=5)
        .map(|power| {
            let hue = ByHue::new(eye, power);
            (judge.errors(&colored(eye, 1, |rgb, omega| hue.xyz(rgb, omega))).mean, hue)
        })
        .collect();
    hues.sort_by(|a, b| a.0.total_cmp(&b.0));
    let hue = hues.swap_remove(0).1;
    let narrow = Gaussians::new(eye, rgb::NARROW, &[]);
    let wide = Gaussians::new(eye, rgb::WIDE, &rgb::UNSEEN);
    vec![
        method(
            "hue",
            "RGB, hue shifted, best power of D",
            "#8e44ad",
            false,
            Box::new(move |samples| colored(eye, samples, |rgb, omega| hue.xyz(rgb, omega))),
        ),
        method(
            "3G",
            "RGB as three narrow Gaussians",
            "#e056a0",
            false,
            Box::new(move |samples| colored(eye, samples, |rgb, omega| narrow.xyz(rgb, omega))),
        ),
        method(
            "7G",
            "three wide Gaussians, UV and IR known",
            "#a0306a",
            false,
            Box::new(move |samples| colored(eye, samples, |rgb, omega| wide.xyz(rgb, omega))),
        ),
    ]
}

fn panorama_methods<'a>(eye: &'a Eye<'a>) -> Vec<Method<'a>> {
    PANORAMAS
        .iter()
        .map(|(width, color)| {
            let paint = move |samples| {
                let panorama = Panorama::new(eye, *width, samples);
                exposed(&eye.stage.view, samples, |ray, cone| panorama.xyz(ray, cone))
            };
            let code = format!("P{}", if *width < 1000 { "½".into() } else { (width / 1024).to_string() });
            method(&code, &format!("panorama, {width} wide"), color, false, Box::new(paint))
        })
        .collect()
}

/// Times (the median) and errors, all methods in turn, several times.
fn measured(methods: &[Method<'_>], judge: &Judge) -> Vec<Vec<Point>> {
    let mut times = vec![[const { Vec::new() }; SAMPLES.len()]; methods.len()];
    let mut errors = vec![[Errors::default(); SAMPLES.len()]; methods.len()];
    for run in 0..RUNS {
        for (m, method) in methods.iter().enumerate() {
            for (s, samples) in SAMPLES.iter().enumerate() {
                if run > 0 && times[m][s][0] > LONG_MS {
                    continue;
                }
                let (picture, seconds) = timed(|| (method.paint)(*samples));
                times[m][s].push(1e3 * seconds);
                if run == 0 {
                    errors[m][s] = judge.errors(&picture);
                }
            }
        }
    }
    let median = |times: &mut Vec<f64>| -> f64 {
        times.sort_unstable_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let points = |(times, errors): (&mut [Vec<f64>; 3], &[Errors; 3])| {
        let point = |s: usize, times: &mut [Vec<f64>; 3]| Point {
            samples: SAMPLES[s],
            ms: median(&mut times[s]),
            errors: errors[s],
        };
        (0..SAMPLES.len()).map(|s| point(s, times)).collect()
    };
    times.iter_mut().zip(&errors).map(points).collect()
}

fn panel(title: String, methods: &[Method<'_>], points: &[Vec<Point>]) -> Panel {
    let series = methods.iter().zip(points).map(|(method, points)| Series {
        name: method.name.clone(),
        code: method.code.clone(),
        color: method.color,
        dashed: method.dashed,
        points: points.iter().map(|point| (point.ms, point.errors.mean)).collect(),
    });
    Panel {
        title,
        x_label: "processor time for one picture, ms".into(),
        y_label: "mean ΔE2000".into(),
        x: (5.0, 5_000.0),
        y: (0.1, 30.0),
        series: series.collect(),
        limit: None,
        guide: Some((1.0, "just seen".into())),
    }
}

fn row(scene: &str, beta: f64, method: &Method<'_>, point: &Point) -> String {
    let Point { samples, ms, errors } = point;
    let known = |value: f64| if value.is_nan() { String::new() } else { format!("{value:.3}") };
    let triangles = if method.triangles > 0 { method.triangles.to_string() } else { String::new() };
    format!(
        "{scene},{beta},{},\"{}\",{samples},{ms:.1},{:.3e},{:.4},{:.3},{},{triangles}\n",
        method.code,
        method.name,
        errors.rmse,
        errors.mean,
        errors.p99,
        known(method.wrong)
    )
}

/// One scene: its panel, and its rows of the table.
fn scene(beta: f64, traffic: Traffic) -> Result<(Panel, String), Box<dyn Error>> {
    let stage = Stage::new(beta, traffic)?;
    let eye = Eye::new(&stage);
    let judge = Judge::new(ours(&stage.scene, &stage, 64, MANY));
    let single = Single::new(&stage);
    let mut cloths: Vec<(Cloths, String, String, &'static str)> = MOVED
        .iter()
        .map(|(level, color)| {
            let name = format!("vertices moved, cut {level} times");
            (Cloths::new(&stage, Cut::Levels(*level)), format!("M{level}"), name, *color)
        })
        .collect();
    let fine = Cloths::new(&stage, Cut::Bent(0.25));
    cloths.push((fine, "Ma".into(), "vertices moved, cut where bent by ¼ pixel".into(), "#ff6a00"));
    let mut methods = our_methods(&stage, &eye);
    for (cloths, code, name, color) in &cloths {
        methods.push(moved_method(&eye, cloths, code, name, color));
    }
    methods.extend(panorama_methods(&eye));
    methods.extend(color_methods(&eye, &judge));
    methods.extend(precision_methods(&stage, &eye, &single));
    let points = measured(&methods, &judge);
    let (word, title) = match traffic {
        Traffic::Crossing => ("two velocities", format!("β = {beta}, two velocities")),
        Traffic::Convoy => ("one velocity", format!("β = {beta}, one velocity")),
    };
    let rows = methods.iter().zip(&points).flat_map(|(m, ps)| ps.iter().map(move |p| row(word, beta, m, p)));
    Ok((panel(title, &methods, &points), rows.collect()))
}

/// Measures and writes `frontier.svg` and `frontier.csv`.
pub fn run(folder: &Path) -> Result<(), Box<dyn Error>> {
    let mut table =
        "scene,beta,code,method,samples,ms,rmse_xyz,mean_de2000,p99_de2000,wrong_body_percent,triangles\n"
            .to_owned();
    let mut panels = Vec::new();
    let crossing = [0.1, 0.5, 0.9, 0.99, 0.999, 0.9999].map(|beta| (beta, Traffic::Crossing));
    for (beta, traffic) in crossing.into_iter().chain([(0.9, Traffic::Convoy), (0.99, Traffic::Convoy)]) {
        println!("β = {beta}, {traffic:?}");
        let (panel, rows) = scene(beta, traffic)?;
        panels.push(panel);
        table += &rows;
    }
    let subtitle = format!(
        "A small body at 3 m, a die at 30 m, a gate at 300 m and a floor, {WIDTH} x {HEIGHT} pixels. Each line: 1, 4 and 16 samples a pixel. Times are medians of {RUNS} runs, of all threads together; files and trees at rest excluded, moving vertices,\ntheir tree and panoramas included. Errors are those of the developed pictures, against ours at 64 wavelengths and {MANY} samples. Lower left is better."
    );
    let sheet =
        Sheet { title: "Speed against error".into(), subtitle, columns: 4, panels, shared_legend: true };
    std::fs::write(folder.join("frontier.svg"), sheet.svg())?;
    std::fs::write(folder.join("frontier.csv"), table)?;
    Ok(())
}
