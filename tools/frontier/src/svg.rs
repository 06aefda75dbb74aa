//! Charts with logarithmic axes, several on a sheet, as SVG.

/// A line of points.
#[derive(Clone)]
pub struct Series {
    pub name: String,
    /// Written at its end; nothing for none.
    pub code: String,
    pub color: &'static str,
    pub dashed: bool,
    pub points: Vec<(f64, f64)>,
}

pub struct Panel {
    pub title: String,
    pub x_label: String,
    pub y_label: String,
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub series: Vec<Series>,
    /// A place on the x axis, and what it is.
    pub limit: Option<(f64, String)>,
    /// A value, and what it is.
    pub guide: Option<(f64, String)>,
}

pub struct Sheet {
    pub title: String,
    pub subtitle: String,
    pub columns: usize,
    pub panels: Vec<Panel>,
    /// Whether all panels share the legend of the first; else each has its own.
    pub shared_legend: bool,
}

const WIDTH: f64 = 410.0;
const HEIGHT: f64 = 312.0;
/// Around the plot of a panel: left, top, right, bottom.
const LEFT: f64 = 58.0;
const TOP: f64 = 46.0;
const RIGHT: f64 = 56.0;
const BOTTOM: f64 = 46.0;
const HEAD: f64 = 64.0;
const ROW: f64 = 15.0;

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn text(x: f64, y: f64, size: f64, anchor: &str, color: &str, words: &str) -> String {
    let words = escaped(words);
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{color}\">{words}</text>\n"
    )
}

fn line((x1, y1): (f64, f64), (x2, y2): (f64, f64), style: &str) -> String {
    format!("<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" {style}/>\n")
}

fn superscript(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32('⁰' as u32 + c as u32 - '0' as u32).unwrap_or(c),
    };
    power.to_string().chars().map(digit).collect()
}

fn tick(power: i32) -> String {
    match power {
        -2..=3 => format!("{}", 10.0_f64.powi(power)),
        _ => format!("10{}", superscript(power)),
    }
}

impl Panel {
    fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let part = |v: f64, (lo, hi): (f64, f64)| {
            let v = if v.is_finite() { v.clamp(lo, hi) } else { hi };
            libm::log10(v / lo) / libm::log10(hi / lo)
        };
        let across = LEFT + part(x, self.x) * (WIDTH - LEFT - RIGHT);
        (across, HEIGHT - BOTTOM - part(y, self.y) * (HEIGHT - TOP - BOTTOM))
    }

    fn axes(&self) -> String {
        let mut out = text(LEFT, TOP - 22.0, 13.0, "start", "#111", &self.title);
        let grid = "stroke=\"#e2e2e2\" stroke-width=\"1\"";
        let powers = |(lo, hi): (f64, f64)| libm::log10(lo).ceil() as i32..=libm::log10(hi).floor() as i32;
        let (across, up) = (powers(self.x), powers(self.y));
        let step = ((up.end() - up.start()) / 8 + 1) as usize;
        let wide = ((across.end() - across.start()) / 9 + 1) as usize;
        for power in across.step_by(wide) {
            let (x, y) = self.place((10.0_f64.powi(power), self.y.0));
            out += &line((x, TOP), (x, y), grid);
            out += &text(x, y + 14.0, 10.0, "middle", "#444", &tick(power));
        }
        for power in up.step_by(step) {
            let (x, y) = self.place((self.x.0, 10.0_f64.powi(power)));
            out += &line((x, y), (WIDTH - RIGHT, y), grid);
            out += &text(x - 5.0, y + 3.5, 10.0, "end", "#444", &tick(power));
        }
        let (w, h) = (WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM);
        out += &format!(
            "<rect x=\"{LEFT}\" y=\"{TOP}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#888\"/>\n"
        );
        out += &text(LEFT + 0.5 * w, HEIGHT - 12.0, 11.0, "middle", "#222", &self.x_label);
        let (x, y) = (14.0, TOP + 0.5 * h);
        out += &format!(
            "<g transform=\"rotate(-90 {x} {y})\">{}</g>\n",
            text(x, y, 11.0, "middle", "#222", &self.y_label)
        );
        out
    }

    fn marks(&self) -> String {
        let mut out = String::new();
        if let Some((value, words)) = &self.guide {
            let (_, y) = self.place((self.x.0, *value));
            out += &line((LEFT, y), (WIDTH - RIGHT, y), "stroke=\"#999\" stroke-dasharray=\"2 3\"");
            out += &text(WIDTH - RIGHT - 3.0, y - 3.0, 9.0, "end", "#777", words);
        }
        if let Some((value, words)) = &self.limit {
            let (x, _) = self.place((*value, self.y.0));
            out += &line(
                (x, TOP),
                (x, HEIGHT - BOTTOM),
                "stroke=\"#1a7f37\" stroke-width=\"1.5\" stroke-dasharray=\"6 3\"",
            );
            out += &text(x.max(LEFT + 40.0), TOP - 6.0, 9.5, "end", "#1a7f37", words);
        }
        out
    }

    fn lines(&self) -> String {
        let mut out = String::new();
        let mut labels: Vec<(f64, f64, &str, &str)> = Vec::new();
        // Ours come first in a panel and are drawn last.
        for series in self.series.iter().rev() {
            let at: Vec<(f64, f64)> = series.points.iter().map(|point| self.place(*point)).collect();
            let path: Vec<String> = at.iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
            let dash = if series.dashed { " stroke-dasharray=\"4 3\"" } else { "" };
            let color = series.color;
            out += &format!(
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"1.6\"{dash}/>\n",
                path.join(" ")
            );
            let fill = if series.dashed { "#fff" } else { color };
            for (x, y) in &at {
                out += &format!(
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.4\" fill=\"{fill}\" stroke=\"{color}\"/>\n"
                );
            }
            if let (Some((x, y)), false) = (at.last(), series.code.is_empty()) {
                labels.push((*x, *y, &series.code, color));
            }
        }
        labels.sort_by(|a, b| a.1.total_cmp(&b.1));
        out + &spread(&labels)
    }
}

/// Labels of points that lie close together.
struct Group<'a> {
    x: f64,
    y: f64,
    words: Vec<(&'a str, &'a str)>,
}

/// Labels right of their points: one for those that lie together, moved down or up until none lies on another.
fn spread(labels: &[(f64, f64, &str, &str)]) -> String {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for (x, y, words, color) in labels {
        match groups.iter_mut().find(|group| (group.x - x).abs() < 45.0 && (group.y - y).abs() < 9.0) {
            Some(group) => {
                group.x = group.x.max(*x);
                group.words.push((words, color));
            }
            None => groups.push(Group { x: *x, y: *y, words: vec![(words, color)] }),
        }
    }
    // Left, top, right and bottom of what is written.
    let mut taken: Vec<[f64; 4]> = Vec::new();
    let mut out = String::new();
    for Group { x, y, words } in &groups {
        let left = x + 6.0;
        let lines = wrapped(words, ((WIDTH - left) / 5.2).max(1.0) as usize);
        let letters =
            |line: &[(&str, &str)]| line.iter().map(|(words, _)| words.chars().count() + 1).sum::<usize>();
        let right = left + 5.2 * lines.iter().map(|line| letters(line)).max().unwrap_or(0) as f64;
        let height = 9.5 * lines.len() as f64;
        let free = |top: f64| {
            let clear = |[l, t, r, b]: &[f64; 4]| top + height <= *t || top >= *b || left > *r || right < *l;
            top + height < HEIGHT - BOTTOM + 6.0 && top > TOP - 6.0 && taken.iter().all(clear)
        };
        let middle = y - 0.5 * height;
        let mut tried = (0..160).map(|i| middle + if i % 2 == 0 { 0.5 } else { -0.5 } * f64::from(i));
        let top = tried.find(|top| free(*top)).unwrap_or(middle);
        taken.push([left, top, right, top + height]);
        if (top - middle).abs() > 5.0 {
            out += &line((x + 2.0, *y), (left, top + 0.5 * height), "stroke=\"#999\" stroke-width=\"0.6\"");
        }
        for (i, line) in lines.iter().enumerate() {
            let span =
                |(words, color): &(&str, &str)| format!("<tspan fill=\"{color}\">{}</tspan>", escaped(words));
            let spans: Vec<String> = line.iter().map(span).collect();
            let base = top + 9.5 * i as f64 + 8.0;
            out += &format!(
                "<text x=\"{left:.1}\" y=\"{base:.1}\" font-size=\"9.5\">{}</text>\n",
                spans.join(" ")
            );
        }
    }
    out
}

/// Words in lines of no more than so many letters, where they allow it.
fn wrapped<'a>(words: &[(&'a str, &'a str)], most: usize) -> Vec<Vec<(&'a str, &'a str)>> {
    let mut lines: Vec<Vec<(&str, &str)>> = vec![Vec::new()];
    let mut letters = 0;
    for word in words {
        let length = word.0.chars().count() + 1;
        if letters + length > most && letters > 0 {
            lines.push(Vec::new());
            letters = 0;
        }
        letters += length;
        if let Some(line) = lines.last_mut() {
            line.push(*word);
        }
    }
    lines
}

fn legend_entry(x: f64, y: f64, series: &Series) -> String {
    let dash = if series.dashed { " stroke-dasharray=\"4 3\"" } else { "" };
    let color = series.color;
    let fill = if series.dashed { "#fff" } else { color };
    let mut out =
        line((x, y - 4.0), (x + 22.0, y - 4.0), &format!("stroke=\"{color}\" stroke-width=\"1.6\"{dash}"));
    out += &format!(
        "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2.4\" fill=\"{fill}\" stroke=\"{color}\"/>\n",
        x + 11.0,
        y - 4.0
    );
    let known = series.code.is_empty() || series.code == series.name;
    let code = if known { String::new() } else { format!("{}: ", series.code) };
    out + &text(x + 28.0, y, 11.0, "start", "#222", &format!("{code}{}", series.name))
}

impl Sheet {
    pub fn svg(&self) -> String {
        let own = if self.shared_legend {
            0
        } else {
            self.panels.iter().map(|p| p.series.len()).max().unwrap_or(0)
        };
        let cell = HEIGHT + own as f64 * ROW + if own > 0 { 14.0 } else { 0.0 };
        let rows = self.panels.len().div_ceil(self.columns);
        let shared = if self.shared_legend { self.panels.first().map_or(0, |p| p.series.len()) } else { 0 };
        let legend_rows = shared.div_ceil(self.columns);
        let width = WIDTH * self.columns as f64 + 10.0;
        let height = HEAD + cell * rows as f64 + legend_rows as f64 * ROW + 24.0;
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        );
        out += &text(16.0, 26.0, 18.0, "start", "#111", &self.title);
        for (i, words) in self.subtitle.lines().enumerate() {
            out += &text(16.0, 43.0 + 14.0 * i as f64, 11.5, "start", "#444", words);
        }
        for (number, panel) in self.panels.iter().enumerate() {
            let (column, row) = (number % self.columns, number / self.columns);
            let (x, y) = (WIDTH * column as f64, HEAD + cell * row as f64);
            out += &format!(
                "<g transform=\"translate({x} {y})\">\n{}{}{}",
                panel.axes(),
                panel.marks(),
                panel.lines()
            );
            if own > 0 {
                for (i, series) in panel.series.iter().enumerate() {
                    out += &legend_entry(LEFT, HEIGHT + 8.0 + ROW * i as f64, series);
                }
            }
            out += "</g>\n";
        }
        if let (true, Some(first)) = (self.shared_legend, self.panels.first()) {
            for (i, series) in first.series.iter().enumerate() {
                let (column, row) = (i / legend_rows, i % legend_rows);
                let x = 24.0 + WIDTH * column as f64;
                out += &legend_entry(x, HEAD + cell * rows as f64 + 12.0 + ROW * row as f64, series);
            }
        }
        out + "</svg>\n"
    }
}
