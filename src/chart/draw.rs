//! The chart as numbers and as a drawing.

use super::{JUST_NOTICEABLE, Measured, Method, front};
use std::fmt::Write;

/// The measurements as rows of numbers between commas, under a row of names.
pub fn csv(measured: &[Measured]) -> String {
    let on_front = front(measured, |one| one.deviation.shown.p99);
    let mut text = "series,step,samples,wavelengths,depth,texture_filter,seconds,relative_rmse_xyz,\
                    mean_ciede2000,p99_ciede2000,estimated_p99,default,pareto\n"
        .to_owned();
    for (number, one) in measured.iter().enumerate() {
        let setting = &one.setting;
        let estimate = one.estimate.map_or(String::new(), |estimate| format!("{:.4}", estimate.p99));
        let wavelengths = match setting.method {
            Method::Tolerance(_) => String::new(),
            _ => setting.sampling.wavelengths.to_string(),
        };
        text += &format!(
            "{},\"{}\",{:.2},{wavelengths},{},{},{:.6},{:.6e},{:.5},{:.5},{estimate},{},{}\n",
            setting.series,
            setting.label,
            one.samples,
            setting.depth,
            if setting.footprints { "on" } else { "off" },
            one.seconds,
            one.deviation.rmse,
            one.deviation.shown.mean,
            one.deviation.shown.p99,
            setting.default,
            on_front.contains(&number),
        );
    }
    text
}

const WIDTH: f64 = 960.0;
const PANEL: f64 = 300.0;
const LEFT: f64 = 90.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 70.0;
const GAP: f64 = 46.0;

/// Colours that are told apart also by those who see fewer of them (Okabe and Ito, 2008).
const COLORS: [(&str, &str); 7] = [
    ("as the manifest has it", "#000000"),
    ("samples", "#0072b2"),
    ("wavelengths", "#d55e00"),
    ("depth", "#009e73"),
    ("texture filter", "#cc79a7"),
    ("everything on", "#8a6d00"),
    ("tolerance", "#56b4e9"),
];

fn color(series: &str) -> &'static str {
    COLORS.iter().find(|(name, _)| *name == series).map_or("#666666", |(_, color)| color)
}

/// A logarithmic axis.
struct Axis {
    first: i32,
    last: i32,
    from: f64,
    to: f64,
}

impl Axis {
    /// Over whole powers of ten that hold all values above zero.
    fn over(values: impl Iterator<Item = f64> + Clone, from: f64, to: f64) -> Self {
        let logs = values.filter(|value| *value > 0.0 && value.is_finite()).map(libm::log10);
        let (lo, hi) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        let (lo, hi) = if lo <= hi { (lo, hi) } else { (0.0, 0.0) };
        let first = lo.floor() as i32;
        Self { first, last: (hi.ceil() as i32).max(first + 1), from, to }
    }

    /// What is zero stands on the lower end.
    fn place(&self, value: f64) -> f64 {
        let log = if value > 0.0 { libm::log10(value) } else { f64::from(self.first) };
        let part = (log - f64::from(self.first)) / f64::from(self.last - self.first);
        self.from + (self.to - self.from) * part.clamp(0.0, 1.0)
    }

    fn tick(power: i32) -> String {
        if (-3..=3).contains(&power) {
            format!("{}", libm::pow(10.0, f64::from(power)))
        } else {
            format!("1e{power}")
        }
    }
}

/// The measurements as a drawing: time across, three kinds of error down, each with its Pareto front.
pub fn svg(title: &str, measured: &[Measured]) -> String {
    type Error = fn(&Measured) -> f64;
    let panels: [(&str, Error, bool); 3] = [
        ("CIEDE2000, 99 in 100 pixels below", |one| one.deviation.shown.p99, true),
        ("CIEDE2000, mean", |one| one.deviation.shown.mean, true),
        ("relative RMSE of linear XYZ", |one| one.deviation.rmse, false),
    ];
    let height = TOP + 3.0 * (PANEL + GAP) + 20.0;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <text x=\"{LEFT}\" y=\"24\" font-size=\"16\">{}</text>\n",
        escaped(title)
    );
    let mut x = LEFT;
    for (name, color) in
        COLORS.iter().filter(|(name, _)| measured.iter().any(|one| one.setting.series == *name))
    {
        let _ = writeln!(text, "<circle cx=\"{}\" cy=\"44\" r=\"4.5\" fill=\"{color}\"/>", x + 5.0);
        let _ = writeln!(text, "<text x=\"{}\" y=\"48\">{name}</text>", x + 14.0);
        x += 30.0 + 6.6 * name.len() as f64;
    }
    let across = Axis::over(measured.iter().map(|one| one.seconds), LEFT, WIDTH - RIGHT);
    for (number, (name, error, noticeable)) in panels.into_iter().enumerate() {
        let top = TOP + number as f64 * (PANEL + GAP);
        let floor = if noticeable { Some(JUST_NOTICEABLE) } else { None };
        let values = measured.iter().map(error).chain(floor);
        let down = Axis::over(values, top + PANEL, top);
        grid(&mut text, &across, &down, (top, name));
        if noticeable {
            let y = down.place(JUST_NOTICEABLE);
            let _ = writeln!(
                text,
                "<path d=\"M{LEFT} {y:.1}H{:.1}\" stroke=\"#b00\" stroke-dasharray=\"6 4\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" fill=\"#b00\" text-anchor=\"end\">just noticeable</text>",
                WIDTH - RIGHT,
                WIDTH - RIGHT - 4.0,
                y - 5.0
            );
        }
        points(&mut text, measured, (&across, &down), error);
    }
    text + "</svg>\n"
}

fn grid(text: &mut String, across: &Axis, down: &Axis, (top, name): (f64, &str)) {
    for power in across.first..=across.last {
        let x = across.place(libm::pow(10.0, f64::from(power)));
        let _ = writeln!(
            text,
            "<path d=\"M{x:.1} {top:.1}v{PANEL}\" stroke=\"#ddd\"/>\
             <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{} s</text>",
            top + PANEL + 16.0,
            Axis::tick(power)
        );
    }
    for power in down.first..=down.last {
        let y = down.place(libm::pow(10.0, f64::from(power)));
        let _ = writeln!(
            text,
            "<path d=\"M{LEFT} {y:.1}H{:.1}\" stroke=\"#ddd\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            WIDTH - RIGHT,
            LEFT - 8.0,
            y + 4.0,
            Axis::tick(power)
        );
    }
    let y = top + 0.5 * PANEL;
    let _ = writeln!(
        text,
        "<text x=\"20\" y=\"{y:.1}\" transform=\"rotate(-90 20 {y:.1})\" text-anchor=\"middle\">{name}</text>"
    );
}

fn points(
    text: &mut String,
    measured: &[Measured],
    (across, down): (&Axis, &Axis),
    error: fn(&Measured) -> f64,
) {
    let place = |one: &Measured| (across.place(one.seconds), down.place(error(one)));
    let mut path = String::new();
    for number in front(measured, error) {
        let (x, y) = place(&measured[number]);
        path += &if path.is_empty() { format!("M{x:.1} {y:.1}") } else { format!("H{x:.1}V{y:.1}") };
    }
    let _ = writeln!(text, "<path d=\"{path}\" fill=\"none\" stroke=\"#999\" stroke-width=\"1.5\"/>");
    let mut taken: Vec<(f64, f64, f64)> =
        measured.iter().map(place).map(|(x, y)| (x - 5.0, x + 5.0, y)).collect();
    for one in measured {
        let (x, y) = place(one);
        let color = color(one.setting.series);
        let radius = if one.setting.default { 7.0 } else { 4.5 };
        let _ = writeln!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{color}\"/>");
        let label = if one.setting.default { "default" } else { one.setting.label.as_str() };
        let wide = 6.8 * label.len() as f64;
        // Where nothing else stands.
        let sides = [
            (6.0, -8.0),
            (7.0, 17.0),
            (-6.0 - wide, -8.0),
            (-7.0 - wide, 17.0),
            (9.0, 4.0),
            (-9.0 - wide, 4.0),
            (6.0, -21.0),
            (7.0, 30.0),
        ];
        let free = sides.into_iter().find(|(dx, dy)| {
            let (a, b, v) = (x + dx, x + dx + wide, y + dy - 4.0);
            b < WIDTH && taken.iter().all(|(c, d, w)| b < *c || a > *d || (v - w).abs() > 11.0)
        });
        if let Some((dx, dy)) = free.filter(|_| !label.is_empty()) {
            taken.push((x + dx, x + dx + wide, y + dy - 4.0));
            let _ = writeln!(
                text,
                "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{color}\">{}</text>",
                x + dx,
                y + dy,
                escaped(label)
            );
        }
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
