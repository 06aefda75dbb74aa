//! The second chart: where methods fail.

use crate::case::{Answer, Case, Truth, Way, in_f32, in_f64};
use crate::double::Double;
use crate::shine;
use crate::svg::{Panel, Series, Sheet};
use crate::thin;
use glam::{DQuat, DVec3};
use std::error::Error;
use std::path::Path;
use terrell::spacetime::{Circle, Course, Event, Velocity, Worldline};

/// The greatest γ that manifests and observers may have.
pub const GREATEST_GAMMA: f64 = 1e8;

const OURS: &str = "#0a1a5c";
const COLORS: [&str; 5] = ["#d00000", "#e69138", "#00a0a0", "#8e44ad", "#6fbf69"];

/// A unit vector to seventeen digits, along no axis.
const AXIS: DVec3 = DVec3::new(0.48, 0.6, 0.64);
const ACROSS: DVec3 = DVec3::new(0.8, 0.0, -0.6);

pub fn series(name: &str, code: &str, ours: bool, number: usize, points: Vec<(f64, f64)>) -> Series {
    let color = if ours { OURS } else { COLORS[number % COLORS.len()] };
    Series { name: name.into(), code: code.into(), color, dashed: false, points }
}

/// Powers of ten with two steps between.
pub fn decades(from: i32, to: i32) -> Vec<f64> {
    (3 * from..=3 * to).map(|i| libm::pow(10.0, f64::from(i) / 3.0)).collect()
}

/// A name, a code, and what is given for each stress.
pub type Curve<'a, T> = (&'a str, &'a str, &'a dyn Fn(f64) -> T);

/// A method that answers cases.
type Answers<'a> = (&'a str, &'a str, &'a dyn Fn(&Case, &Truth) -> Option<Answer>);

const CASES: [Answers<'static>; 6] = [
    ("ours", "ours", &|case, truth| case.ours(truth)),
    ("γ = 1/√(1 - β²), f64", "γβ64", &|case, truth| Some(in_f64(case, truth, Way::FromBeta))),
    ("γ = 1/√(1 - β²), f32", "γβ32", &|case, truth| Some(in_f32(case, truth, Way::FromBeta))),
    ("f32, γβ kept", "f32", &|case, truth| Some(in_f32(case, truth, Way::Careful))),
    ("unit directions, event taken back, f64", "T", &|case, truth| Some(in_f64(case, truth, Way::ByTime))),
    ("each event boosted alone, f64", "alone", &|case, truth| Some(in_f64(case, truth, Way::EventsAlone))),
];

/// The worst error of one of the answers over several cases at each stress.
fn of_cases(stress: &[f64], which: usize, cases: impl Fn(f64) -> Vec<Case>, take: &[usize]) -> Vec<Series> {
    let line = |(i, number): (usize, &usize)| {
        let (name, code, answer) = CASES[*number];
        let worst = |x: &f64| {
            let errors = cases(*x).into_iter().map(|case| {
                let truth = case.truth();
                truth.errors(answer(&case, &truth))[which]
            });
            // NaN is as wrong as can be.
            (*x, errors.fold(0.0, |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) }))
        };
        series(name, code, i == 0, i.wrapping_sub(1), stress.iter().map(worst).collect())
    };
    take.iter().enumerate().map(line).collect()
}

/// A body that comes nearly straight at the eye (`side` 1), or goes straight away (-1).
fn at_speed(gamma: f64, side: f64) -> Vec<Case> {
    let u = Velocity::from_gamma(gamma, AXIS).proper() * -side;
    let case = |tilt: f64| {
        let n = (AXIS + ACROSS * tilt).normalize();
        // A little off its middle, as seen from its own near distance.
        let nearness = (gamma - side * u.length() * (n.dot(AXIS))).clamp(1e-9, 1.0);
        let origin = (-10.0, n * 10.0 + ACROSS.cross(AXIS) * (0.05 * nearness));
        Case { u, origin, eye: (0.0, DVec3::ZERO), n }
    };
    [0.0, 0.5 / gamma, 3.0 / gamma, 0.1].map(case).into()
}

/// Everything far from where coordinates begin, in space and in time.
fn far_away(distance: f64) -> Vec<Case> {
    let shift = distance.floor();
    let eye = (shift + 0.5, DVec3::new(shift, 0.75 - shift, shift + 0.25));
    let n = AXIS;
    let origin = (eye.0 - 10.0, eye.1 + n * 10.0 + DVec3::new(0.25, 0.5, -0.125));
    vec![Case { u: DVec3::new(1.0, -1.0, 1.0), origin, eye, n }]
}

/// A body of which is said where it was long ago.
fn long_ago(ago: f64) -> Vec<Case> {
    let u = DVec3::new(1.0, -1.0, 1.0);
    let was = |t: f64| AXIS * 10.0 + DVec3::new(0.25, 0.5, -0.125) - u / 2.0 * t;
    vec![Case { u, origin: (-ago.floor() - 10.0, was(ago.floor())), eye: (0.0, DVec3::ZERO), n: AXIS }]
}

pub fn panel(
    title: &str,
    x_label: &str,
    y_label: &str,
    x: (f64, f64),
    y: (f64, f64),
    series: Vec<Series>,
) -> Panel {
    Panel {
        title: title.into(),
        x_label: x_label.into(),
        y_label: y_label.into(),
        x,
        y,
        series,
        limit: None,
        guide: None,
    }
}

impl Panel {
    pub fn guaranteed(mut self, to: f64, words: &str) -> Self {
        self.limit = Some((to, words.into()));
        self
    }
}

fn speed_panels() -> Vec<Panel> {
    let gammas = decades(0, 8);
    let label = "γ of the body";
    let relative = "relative error";
    let (x, y) = ((1.0, 1e8), (1e-17, 10.0));
    let words = "ours: γ up to 1e8";
    let going = |gamma| at_speed(gamma, -1.0);
    let coming = |gamma| at_speed(gamma, 1.0);
    let panel = |title, lines| panel(title, label, relative, x, y, lines).guaranteed(GREATEST_GAMMA, words);
    vec![
        panel("Doppler factor, going away", of_cases(&gammas, 0, going, &[0, 1, 2, 3])),
        panel("Doppler factor, coming", of_cases(&gammas, 0, coming, &[0, 1, 2, 3])),
        panel("How far it is (which body is in front)", of_cases(&gammas, 1, coming, &[0, 1, 3, 4])),
    ]
}

fn distance_panels() -> Vec<Panel> {
    let far = decades(0, 9);
    let (x, y) = ((1.0, 1e9), (1e-17, 1e3));
    let metres = "error of the place on the body, m";
    vec![
        panel(
            "Everything far from the origin, γ = 2",
            "place and time of all, m",
            metres,
            x,
            y,
            of_cases(&far, 2, far_away, &[0, 3, 4, 5]),
        )
        .guaranteed(1e9, "ours: all of it"),
        panel(
            "A body said by where it was long ago, γ = 2",
            "how long ago, m",
            metres,
            x,
            y,
            of_cases(&far, 2, long_ago, &[0, 3, 4, 5]),
        )
        .guaranteed(1e9, "ours: 1e-6 m at 1e9 m"),
    ]
}

/// β after a rocket's proper time, step by step (Runge and Kutta's rule).
fn stepped(tau: f64) -> f64 {
    let steps = 1000;
    let h = tau / f64::from(steps);
    let rate = |beta: f64| 1.0 - beta * beta;
    (0..steps).fold(0.0, |b: f64, _| {
        let k1 = rate(b);
        let k2 = rate(b + 0.5 * h * k1);
        let k3 = rate(b + 0.5 * h * k2);
        let k4 = rate(b + h * k3);
        b + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    })
}

fn rocket_panel() -> Panel {
    let rocket = |tau: f64| {
        let course = Course::Rocket { acceleration: DVec3::NEG_Z };
        Worldline::new(Event::ORIGIN, Velocity::REST, DQuat::IDENTITY, course).at(tau)
    };
    // With a = 1/m the light from straight ahead has, at rest, e^-τ of the frequency that is seen.
    let ahead = |tau: f64| rocket(tau).sight_ray(DVec3::NEG_Z).k.t;
    let behind = |tau: f64| {
        let event = rocket(tau).event;
        -event.x.z + 1.0 - event.t
    };
    let slow = |beta: f64| ((1.0 - beta) / (1.0 + beta)).sqrt();
    let methods: [Curve<'_, f64>; 5] = [
        ("ours: frequency of light from ahead", "ours", &ahead),
        ("ours: lead on the light of the horizon", "lead", &behind),
        ("from β = tanh aτ, f64", "β", &|tau| slow(libm::tanh(tau))),
        ("from β = tanh aτ, f32", "β32", &|tau| {
            let beta = libm::tanhf(tau as f32);
            f64::from(((1.0 - beta) / (1.0 + beta)).sqrt())
        }),
        ("β stepped, 1000 steps of 4th order", "RK4", &|tau| slow(stepped(tau))),
    ];
    let stress = decades(0, 8);
    let line = |(i, (name, code, of)): (usize, &Curve<'_, f64>)| {
        let error = |gamma: &f64| {
            let tau = libm::acosh(*gamma);
            let truth = libm::exp(-tau);
            let off = ((of(tau) - truth) / truth).abs();
            (*gamma, if off.is_nan() { f64::INFINITY } else { off })
        };
        let mut line = series(name, code, i == 0, i.wrapping_sub(1), stress.iter().map(error).collect());
        if i == 1 {
            (line.color, line.dashed) = (OURS, true);
        }
        line
    };
    let lines = methods.iter().enumerate().map(line).collect();
    panel(
        "A rocket near its horizon",
        "γ of the rocket, cosh aτ",
        "relative error",
        (1.0, 1e8),
        (1e-17, 10.0),
        lines,
    )
    .guaranteed(GREATEST_GAMMA, "ours: γ up to 1e8")
}

/// Where an observer at 0.9999 c is after so many turns.
fn orbit_panel() -> Panel {
    let proper_speed = 0.9999 / ((1.0 - 0.9999) * 1.9999_f64).sqrt();
    let circle = Circle { centre: DVec3::ZERO, radius: DVec3::X, quarter: DVec3::Y };
    let tau = |turns: f64| turns * std::f64::consts::TAU / proper_speed;
    let truth = |turns: f64| {
        let turned = (Double::from(proper_speed) * tau(turns).into() / Double::TAU).fract();
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * turned.f64());
        DVec3::new(cos, sin, 0.0)
    };
    let ours = |turns: f64| {
        let course = Course::Orbit { circle, proper_speed };
        Worldline::new(Event::ORIGIN, Velocity::REST, DQuat::IDENTITY, course).at(tau(turns)).event.x
    };
    let single = |turns: f64| {
        let (sin, cos) = libm::sincosf(proper_speed as f32 * tau(turns) as f32);
        DVec3::new(f64::from(cos), f64::from(sin), 0.0)
    };
    let stepped = |turns: f64| {
        let steps = (360.0 * turns).ceil().max(1.0);
        let (sin, cos) = libm::sincos(proper_speed * tau(turns) / steps);
        (0..steps as u64).fold(DVec3::X, |x, _| DVec3::new(cos * x.x - sin * x.y, sin * x.x + cos * x.y, 0.0))
    };
    // Half a step at the old velocity and half at the new one.
    let leapt = |turns: f64| {
        let steps = (360.0 * turns).ceil().max(1.0);
        let h = proper_speed * tau(turns) / steps;
        let (mut x, mut v) = (DVec3::X, DVec3::Y);
        for _ in 0..steps as u64 {
            v -= x * (0.5 * h);
            x += v * h;
            v -= x * (0.5 * h);
        }
        x
    };
    let methods: [(f64, Curve<'_, DVec3>); 4] = [
        (1e9, ("ours", "ours", &ours)),
        (1e9, ("f32, closed form", "f32", &single)),
        (1e5, ("turned by a degree 360 times a turn, f64", "turned", &stepped)),
        (1e5, ("leapfrog, 360 steps a turn, f64", "leap", &leapt)),
    ];
    let stress = decades(0, 9);
    let line = |(i, (most, (name, code, of))): (usize, &(f64, Curve<'_, DVec3>))| {
        let stress = stress.iter().filter(|turns| *turns <= most);
        let points = stress.map(|turns| (*turns, (of(*turns) - truth(*turns)).length())).collect();
        series(name, code, i == 0, i.wrapping_sub(1), points)
    };
    let lines = methods.iter().enumerate().map(line).collect();
    panel("An orbit at 0.9999 c", "turns", "error of the place, radii", (1.0, 1e9), (1e-17, 10.0), lines)
        .guaranteed(1e9, "ours: 1e-6 at 1e9 turns")
}

fn size_panel() -> Panel {
    let sizes = decades(-3, 6);
    let line = |(i, method): (usize, &thin::Method)| {
        let points = sizes.iter().map(|size| (*size, thin::wrong(*size, *method))).collect();
        series(method.name(), method.code(), i == 0, i.wrapping_sub(1), points)
    };
    let lines = thin::METHODS.iter().enumerate().map(line).collect();
    panel(
        "Shadows on a body that shares the scene, γ = 2",
        "size of the body, m",
        "shadow rays decided wrongly",
        (1e-3, 1e6),
        (1e-4, 1.0),
        lines,
    )
    .guaranteed(1e6, "ours: none")
}

/// Measures and writes `edges.svg` and `edges.csv`.
pub fn run(folder: &Path) -> Result<(), Box<dyn Error>> {
    println!("edges");
    let mut panels = speed_panels();
    panels.extend(distance_panels());
    panels.extend([size_panel(), shine::light_panel(), rocket_panel(), orbit_panel()]);
    let mut table = "chart,method,stress,error\n".to_owned();
    for panel in &panels {
        for series in &panel.series {
            for (x, y) in &series.points {
                table += &format!("\"{}\",\"{}\",{x:.4e},{y:.3e}\n", panel.title, series.name);
            }
        }
    }
    let subtitle = "Errors against closed forms and arithmetic of 32 digits, on logarithmic axes; what is off the scale is drawn at its edge. The worst of several rays at each point.\nThe green line: up to where ours is guaranteed.";
    let sheet = Sheet {
        title: "Where methods fail".into(),
        subtitle: subtitle.into(),
        columns: 3,
        panels,
        shared_legend: false,
    };
    std::fs::write(folder.join("edges.svg"), sheet.svg())?;
    std::fs::write(folder.join("edges.csv"), table)?;
    Ok(())
}
