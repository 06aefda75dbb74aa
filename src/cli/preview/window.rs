//! Pictures in a window.

use super::{Picture, Screen};
use crate::error::Error;
use minifb::{Key, ScaleMode, Window, WindowOptions};
use std::io;
use std::path::Path;

/// The largest window that is opened. (It can be made larger by hand; the picture is larger anyway, if it is to be.)
const LARGEST: (u32, u32) = (1600, 900);

/// How often the system is asked what has happened, times a second.
const RATE: usize = 30;

/// A window.
pub(super) struct Shown {
    window: Window,
    // As it was shown last: one number for red, green and blue.
    pixels: Vec<u32>,
    size: (usize, usize),
}

impl Shown {
    /// A window for a picture of this size; or why there is none.
    pub(super) fn new((width, height): (u32, u32)) -> Result<Self, String> {
        let part = f64::min(
            f64::from(LARGEST.0) / f64::from(width.max(1)),
            f64::from(LARGEST.1) / f64::from(height.max(1)),
        );
        let side = |pixels: u32| (f64::from(pixels) * part.min(1.0)).round().max(64.0) as usize;
        let options = WindowOptions {
            resize: true,
            scale_mode: ScaleMode::AspectRatioStretch,
            ..WindowOptions::default()
        };
        let opened = Window::new("terrell", side(width), side(height), options);
        let mut window = opened.map_err(|error| format!("there is no window ({error})"))?;
        window.set_target_fps(RATE);
        Ok(Self { window, pixels: vec![0], size: (1, 1) })
    }

    fn update(&mut self) -> Result<(), Error> {
        let (width, height) = self.size;
        self.window.update_with_buffer(&self.pixels, width, height).map_err(|error| {
            Error::machine(
                Path::new("the window"),
                "showing the preview",
                io::Error::other(error.to_string()),
            )
        })
    }
}

impl Screen for Shown {
    fn room(&self) -> (u32, u32) {
        (u32::MAX, u32::MAX)
    }

    fn show(&mut self, picture: &Picture, line: &str) -> Result<(), Error> {
        let one = |rgb: &[u8]| rgb.iter().fold(0, |number, channel| number << 8 | u32::from(*channel));
        self.pixels = picture.rgb.chunks_exact(3).map(one).collect();
        self.size = (picture.width as usize, picture.height as usize);
        self.window.set_title(line);
        self.update()
    }

    fn say(&mut self, text: &str) {
        crate::cli::say(text);
    }

    fn attend(&mut self) -> bool {
        let done = [Key::Escape, Key::Q].into_iter().any(|key| self.window.is_key_down(key));
        self.window.is_open() && !done && self.update().is_ok()
    }

    fn stays(&self) -> bool {
        true
    }
}
