//! A scene of which the plan leaves out everything, and for each part of the plan the same scene with something that needs it and
//! that nobody sees: a ball behind the camera, or a light too faint for any picture.

/// A textureless head in daylight on a floor, at rest, and a small ball behind the camera.
const PLAIN: &str = "
light_speed: 1 m/s
assets: { monkey: ../assets/monkey.glb, floor: { plane: {} }, ball: { sphere: { radius: 1 mm } } }
bodies:
  - { asset: monkey, at: 0 1.05 0 m, material: { diffuse: 0.6 } }
  - { asset: floor, material: { diffuse: 0.5 } }
  - { asset: ball, at: 0 9 30 m, BALL }
LAMPS
ambient: AMBIENT
SKY
observer: { at: 0 1.4 5 m, look_at: monkey, field_of_view: 50 deg }
exposures: EXPOSURES
picture: { size: SIZE, samples: 4, white: 100 cd/m2 }
film: { video: off }
output: out
";

/// A part of the plan with two manifests of the same picture, one that needs it and one that does not.
pub(crate) struct Needless {
    /// The part's name in the plan.
    pub(crate) part: &'static str,
    /// What is there that nobody sees.
    pub(crate) what: &'static str,
    /// The manifest without it.
    pub(crate) plain: String,
    /// The manifest with it.
    pub(crate) with: String,
    /// By how much the pictures may differ, a part of their mean.
    pub(crate) tolerance: f64,
}

const GREY: &str = "material: { diffuse: 0.6 }";
const LAMP: &str = "lights:\n  - lamp: { intensity: 400 cd }\n    at: 3 5 4 m";
const FILL: &str = "{ luminance: 3 cd/m2 }";

/// Every part of the plan, the pictures `width` by `height`.
pub(crate) fn all((width, height): (u32, u32)) -> Vec<Needless> {
    let text = |ball: &str, lamps: &str, ambient: &str, sky: &str, exposures: usize| {
        let count = format!("{{ from: 0 s, to: 1 s, count: {exposures} }}");
        let changes = [
            ("BALL", ball),
            ("LAMPS", lamps),
            ("AMBIENT", ambient),
            ("SKY", sky),
            ("EXPOSURES", &count),
            ("SIZE", &format!("{width} {height}")),
        ];
        changes.iter().fold(PLAIN.to_owned(), |text, (name, value)| text.replace(name, value))
    };
    let ball = |part, what, ball: &str, exposures, tolerance| Needless {
        part,
        what,
        plain: text(GREY, LAMP, FILL, "", exposures),
        with: text(ball, LAMP, FILL, "", exposures),
        tolerance,
    };
    let blinking = "material: { blinking: { period: 2 s, on: { diffuse: 0.6 }, off: { diffuse: 0.1 } } }";
    let checker = "material: { diffuse: { checker: { even: 0.8, odd: 0.1 } } }";
    let sodium = "material: { emission: { luminance: 10 cd/m2, spectrum: { line: 589 nm } } }";
    vec![
        ball("rest frames", "a ball that moves", "velocity: 0.5 0 0 c, material: { diffuse: 0.6 }", 1, 1e-6),
        ball("exposures", "a ball that blinks", blinking, 8, 0.0),
        Needless {
            part: "shadows",
            what: "a lamp too faint to be seen",
            plain: text(GREY, "", FILL, "", 1),
            with: text(GREY, &LAMP.replace("400 cd", "1e-9 cd"), FILL, "", 1),
            tolerance: 1e-6,
        },
        ball("shadows", "a thin ball of glass", "material: { glass: { index: 1.5, thin: on } }", 1, 0.0),
        ball("recursion", "a ball that mirrors", "material: { mirror: 0.8 }", 1, 0.0),
        ball("spectra", "a ball of gold", "material: { metal: gold, roughness: 0.9 }", 1, 1e-6),
        ball("lines", "a ball that shines yellow", sodium, 1, 1e-6),
        Needless {
            part: "dispersion",
            what: "a ball of glass that parts colours",
            plain: text("material: { glass: 1.5 }", LAMP, FILL, "", 1),
            with: text("material: { glass: SF11 }", LAMP, FILL, "", 1),
            tolerance: 1e-6,
        },
        ball("footprints", "a checkered ball", checker, 1, 0.0),
        Needless {
            part: "surroundings",
            what: "a sky too faint to be seen",
            plain: text(GREY, LAMP, FILL, "", 1),
            with: text(GREY, LAMP, FILL, "surroundings: { uniform: { luminance: 1e-9 cd/m2 } }", 1),
            tolerance: 1e-6,
        },
    ]
}
