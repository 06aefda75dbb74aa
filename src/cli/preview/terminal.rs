//! Pictures in the terminal: by its own graphics (kitty, iTerm2, sixel), or as half blocks.

use super::{Picture, Screen};
use crate::error::Error;
use image::{DynamicImage, RgbImage};
use ratatui::backend::CrosstermBackend;
use ratatui::layout::{Rect, Size};
use ratatui::text::Line;
use ratatui::{Terminal, TerminalOptions, Viewport};
use ratatui_image::picker::cap_parser::QueryStdioOptions;
use ratatui_image::picker::{Picker, ProtocolType};
use ratatui_image::{Image, Resize};
use std::io::{self, IsTerminal, Stdout, Write};
use std::path::Path;
use std::time::Duration;

/// Rows of the terminal that are left for what stood there before.
const LEFT: u16 = 3;

/// How long the terminal has to answer.
const PATIENCE: Duration = Duration::from_millis(500);

/// A stretch of the terminal.
pub(super) struct Shown {
    picker: Picker,
    // Columns and rows of the whole terminal.
    size: (u16, u16),
    // Where pictures are drawn, from the first of them until something else is said; and its rows.
    canvas: Option<(Terminal<CrosstermBackend<Stdout>>, u16)>,
}

impl Shown {
    /// Asks the terminal what it can show; or why there is none.
    pub(super) fn new() -> Result<Self, String> {
        if !io::stdout().is_terminal() {
            return Err("the output is no terminal".to_owned());
        }
        let size =
            crossterm::terminal::size().map_err(|error| format!("the terminal has no size: {error}"))?;
        let picker = ask().unwrap_or_else(Picker::halfblocks);
        Ok(Self { picker, size, canvas: None })
    }

    fn rows(&self) -> u16 {
        self.size.1.saturating_sub(LEFT).max(1)
    }

    fn draw(&mut self, picture: &Picture, line: &str) -> io::Result<()> {
        let room = Size::new(self.size.0, self.rows());
        let image = fitted(&self.picker, picture, room).map_err(io::Error::other)?;
        let rows = image.size().height + 1;
        if self.canvas.as_ref().is_some_and(|(_, other)| *other != rows) {
            self.leave();
        }
        let (canvas, _) = match &mut self.canvas {
            Some(canvas) => canvas,
            none => none.insert((lowest(rows, self.size)?, rows)),
        };
        canvas.draw(|drawn| {
            let area = drawn.area();
            drawn.render_widget(Image::new(&image), Rect { height: area.height - 1, ..area });
            drawn.render_widget(Line::raw(line), Rect { y: area.bottom() - 1, height: 1, ..area });
        })?;
        // Whatever happens next, it is there.
        canvas.show_cursor()
    }

    /// Goes on below the picture.
    fn leave(&mut self) {
        if let Some((mut canvas, _)) = self.canvas.take() {
            let area = canvas.get_frame().area();
            let _ = canvas.set_cursor_position((0, area.bottom().saturating_sub(1)));
            let _ = super::super::print("\n");
        }
    }
}

/// Asks the terminal which graphics it has; none if it does not answer.
fn ask() -> Option<Picker> {
    if !io::stdin().is_terminal() {
        return None;
    }
    // If no answer comes, who waits for it leaves the terminal without an echo: so it is put back by us.
    let raw = crossterm::terminal::enable_raw_mode().is_ok();
    let options = QueryStdioOptions { timeout: PATIENCE, ..QueryStdioOptions::default() };
    let picker = Picker::from_query_stdio_with_options(options).ok();
    if raw {
        let _ = crossterm::terminal::disable_raw_mode();
    }
    picker
}

/// So many rows at the lower end of the terminal; what is there goes up. (Where the cursor is would have to be asked, and not
/// every terminal answers.)
fn lowest(rows: u16, size: (u16, u16)) -> io::Result<Terminal<CrosstermBackend<Stdout>>> {
    let mut out = io::stdout();
    let rows = rows.min(size.1);
    crossterm::queue!(out, crossterm::cursor::MoveTo(0, size.1.saturating_sub(1)))?;
    out.write_all("\n".repeat(usize::from(rows)).as_bytes())?;
    out.flush()?;
    let viewport = Viewport::Fixed(Rect::new(0, size.1 - rows, size.0, rows));
    Terminal::with_options(CrosstermBackend::new(out), TerminalOptions { viewport })
}

/// A picture as the terminal takes it, as large as there is room.
fn fitted(
    picker: &Picker,
    picture: &Picture,
    room: Size,
) -> Result<ratatui_image::protocol::Protocol, String> {
    let image = RgbImage::from_raw(picture.width, picture.height, picture.rgb.clone());
    let image = image.ok_or("the picture has another size")?;
    picker
        .new_protocol(DynamicImage::from(image), room, Resize::Scale(None))
        .map_err(|error| error.to_string())
}

impl Screen for Shown {
    fn room(&self) -> (u32, u32) {
        let cell = match self.picker.protocol_type() {
            ProtocolType::Halfblocks => (1, 2),
            _ => (self.picker.font_size().width, self.picker.font_size().height),
        };
        (
            u32::from(self.size.0) * u32::from(cell.0).max(1),
            u32::from(self.rows().saturating_sub(1).max(1)) * u32::from(cell.1).max(1),
        )
    }

    fn show(&mut self, picture: &Picture, line: &str) -> Result<(), Error> {
        self.draw(picture, line)
            .map_err(|source| Error::machine(Path::new("the terminal"), "showing the preview", source))
    }

    fn say(&mut self, text: &str) {
        self.leave();
        crate::cli::say(text);
    }

    fn attend(&mut self) -> bool {
        std::thread::sleep(Duration::from_millis(10));
        true
    }

    fn stays(&self) -> bool {
        false
    }
}

impl Drop for Shown {
    fn drop(&mut self) {
        self.leave();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::buffer::Buffer;
    use ratatui::widgets::Widget;

    /// Left red, right blue, as drawn in 8 by 2 cells.
    fn drawn(protocol: ProtocolType) -> Buffer {
        let mut picker = Picker::halfblocks();
        picker.set_protocol_type(protocol);
        let row = [[255, 0, 0]; 4].into_iter().chain([[0, 0, 255]; 4]);
        let picture =
            Picture { width: 8, height: 4, rgb: (0..4).flat_map(|_| row.clone()).flatten().collect() };
        let area = Rect::new(0, 0, 8, 2);
        let mut cells = Buffer::empty(area);
        Image::new(&fitted(&picker, &picture, area.as_size()).unwrap()).render(area, &mut cells);
        cells
    }

    #[test]
    fn terminal_without_graphics_gets_half_blocks_of_the_picture_s_colours() {
        let cells = drawn(ProtocolType::Halfblocks);
        assert_eq!(cells[(0, 0)].bg, ratatui::style::Color::Rgb(255, 0, 0));
        assert_eq!(cells[(7, 1)].bg, ratatui::style::Color::Rgb(0, 0, 255));
    }

    #[test]
    fn terminals_with_graphics_get_what_they_understand() {
        for (protocol, begins) in [
            (ProtocolType::Kitty, "\u{1b}_G"),
            (ProtocolType::Iterm2, "\u{1b}]1337;File="),
            (ProtocolType::Sixel, "\u{1b}P"),
        ] {
            let cells = drawn(protocol);
            assert!(cells[(0, 0)].symbol().contains(begins), "{protocol:?}: {:?}", cells[(0, 0)].symbol());
        }
    }
}
