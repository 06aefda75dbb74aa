//! `terrell render --preview`: one exposure, shown from coarse to fine. No files are written.

mod expose;
mod terminal;
#[cfg(feature = "window")]
mod window;

use super::{RenderArgs, signals, watch};
use crate::error::{Error, Place};
use crate::stop::Stop;
use clap::ValueEnum;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

/// Where a preview is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Where {
    /// In a window if there can be one, otherwise in the terminal
    Anywhere,
    /// In a window, or not at all
    Window,
    /// In the terminal, or not at all
    Terminal,
}

/// What can be looked at, sRGB.
struct Picture {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

/// Where pictures are shown.
trait Screen {
    /// The most pixels across and down that it can show.
    fn room(&self) -> (u32, u32);

    /// Shows a picture with a line about it.
    fn show(&mut self, picture: &Picture, line: &str) -> Result<(), Error>;

    /// Says something that is no picture.
    fn say(&mut self, text: &str);

    /// Waits for a moment; false if the user has closed it.
    fn attend(&mut self) -> bool;

    /// Whether it stays until it is closed.
    fn stays(&self) -> bool;
}

/// A window or the terminal; a fault if there is none.
fn screen(place: Where, size: (u32, u32), exposure: usize) -> Result<Box<dyn Screen>, Error> {
    let mut why = Vec::new();
    if place != Where::Terminal {
        match open_window(size) {
            Ok(screen) => return Ok(screen),
            Err(reason) => why.push(reason),
        }
    }
    if place != Where::Window {
        match terminal::Shown::new() {
            Ok(shown) => return Ok(Box::new(shown)),
            Err(reason) => why.push(reason),
        }
    }
    let hint = format!("--exposure {exposure} --scale 0.25 --out FOLDER writes a small picture instead");
    Err(Error::fault(Place::Command, format!("a preview cannot be shown: {}", why.join(", and ")), hint))
}

#[cfg(feature = "window")]
fn open_window(size: (u32, u32)) -> Result<Box<dyn Screen>, String> {
    window::Shown::new(size).map(|shown| Box::new(shown) as Box<dyn Screen>)
}

#[cfg(not(feature = "window"))]
fn open_window(_size: (u32, u32)) -> Result<Box<dyn Screen>, String> {
    Err("this build has no windows".to_owned())
}

/// What the one who works tells the one who shows.
enum News {
    // A picture of this size is to come, of this exposure: how much of it can be shown?
    Size { size: (u32, u32), exposure: usize, answer: Sender<(u32, u32)> },
    Picture(Picture, String),
    Text(String),
    Ended(Result<(), Error>),
}

/// Shows a preview of a manifest; with `--watch` another one whenever something of it is saved.
pub(super) fn run(path: &Path, changes: &[(String, String)], args: &RenderArgs) -> Result<(), Error> {
    let place = args.seeing.preview.unwrap_or(Where::Anywhere);
    let closed = Arc::new(AtomicBool::new(false));
    let (news, inbox) = channel();
    signals::gently(|signal| {
        let stop = signal.clone().or(closed.clone());
        // Windows want the thread that the process began with, so the work is done beside it.
        let shown = std::thread::scope(|scope| {
            scope.spawn(|| {
                let pool = super::pool(args.threads);
                let ended =
                    pool.and_then(|pool| pool.install(|| worked(path, changes, args, (&news, &stop))));
                let _ = news.send(News::Ended(ended));
            });
            let shown = show(place, &inbox, signal);
            closed.store(true, Relaxed);
            shown
        });
        if signal.is_set() {
            return Err(Error::Stopped { there: "a preview leaves no files".to_owned() });
        }
        shown
    })
}

/// The work: once, or whenever something is saved.
fn worked(
    path: &Path,
    changes: &[(String, String)],
    args: &RenderArgs,
    (news, stop): (&Sender<News>, &Stop),
) -> Result<(), Error> {
    let say = |text: &str| {
        let _ = news.send(News::Text(text.to_owned()));
    };
    if !args.seeing.watch {
        return expose::once(path, changes, args, (news, stop, &mut |_, _| {}));
    }
    watch::rounds(path, stop, &say, |stop, files| expose::once(path, changes, args, (news, stop, files)))
}

/// Shows what comes until there is no more, or the user has enough.
fn show(place: Where, inbox: &Receiver<News>, signal: &Stop) -> Result<(), Error> {
    let mut screen: Option<Box<dyn Screen>> = None;
    loop {
        let news = if screen.is_some() {
            inbox.try_recv()
        } else {
            inbox.recv_timeout(std::time::Duration::from_millis(20)).map_err(|_| TryRecvError::Empty)
        };
        match (news, &mut screen) {
            (Ok(News::Size { size, exposure, answer }), shown) => {
                let screen = match shown {
                    Some(screen) => screen,
                    None => shown.insert(self::screen(place, size, exposure)?),
                };
                let _ = answer.send(screen.room());
                continue;
            }
            (Ok(News::Picture(picture, line)), Some(screen)) => {
                screen.show(&picture, &line)?;
                continue;
            }
            (Ok(News::Text(text)), Some(screen)) => screen.say(&text),
            (Ok(News::Text(text)), None) => crate::cli::say(&text),
            (Ok(News::Ended(Ok(()))), Some(screen)) if screen.stays() => {}
            (Ok(News::Ended(ended)), _) => return ended,
            (Ok(News::Picture(..)) | Err(_), _) => {}
        }
        if signal.is_set() || screen.as_mut().is_some_and(|screen| !screen.attend()) {
            return Ok(());
        }
    }
}
