//! Faults as text for a terminal: what is wrong, the line where it stands, what to type instead.

use crate::error::{Fault, Place};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::borrow::Cow;
use std::ops::Range;

/// Faults shown in full; the rest are counted.
const SHOWN: usize = 100;
/// Longest line that is shown whole, bytes.
const LONGEST_LINE: usize = 300;
/// Bytes that are shown of a longer line before and after what is meant, and of that.
const CONTEXT: usize = 60;
/// Where flags are.
const COMMAND: &str = "the command line";

/// The faults (or warnings) one after the other, each ended by a blank line; colours by ANSI escapes.
pub fn render(faults: &[Fault], warnings: bool, color: bool) -> String {
    let renderer = if color { Renderer::styled() } else { Renderer::plain() };
    let mut text = String::new();
    for fault in faults.iter().take(SHOWN) {
        text.push_str(&one(fault, warnings, &renderer));
        text.push_str("\n\n");
    }
    if faults.len() > SHOWN {
        text.push_str(&format!("and {} more\n\n", faults.len() - SHOWN));
    }
    text
}

fn one(fault: &Fault, warning: bool, renderer: &Renderer) -> String {
    let level = if warning { Level::WARNING } else { Level::ERROR };
    let mut group: Group<'_> = Group::with_title(level.primary_title(visible(&fault.what)));
    group = located(group, &fault.place, AnnotationKind::Primary, "");
    for (place, what) in &fault.also {
        group = located(group, place, AnnotationKind::Context, what);
    }
    let hint = visible(&fault.hint);
    if !hint.is_empty() {
        group = group.element(Level::HELP.message(hint));
    }
    // Where a line is cut or an argument is shown, its place stands above it already.
    let shown = renderer.render(&[group]);
    shown.lines().filter(|line| bare(line).trim() != ":::").collect::<Vec<_>>().join("\n")
}

/// A line without colours.
fn bare(line: &str) -> String {
    let mut parts = line.split('\u{1b}');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once('m').map_or("", |(_, after)| after))
}

/// Adds a place, with its line and a mark below what is meant.
fn located<'a>(group: Group<'a>, place: &'a Place, kind: AnnotationKind, label: &str) -> Group<'a> {
    let (text, span, path) = match place {
        Place::Text { path, text, span } => (text, span, visible(&path.display().to_string())),
        Place::Argument { text, span } => (text, span, COMMAND.to_owned()),
        Place::Command => return group.element(Origin::path(COMMAND)),
        place => return group.element(Origin::path(visible(&place.to_string()))),
    };
    let line = Line::of(text, span);
    let mut mark = kind.span(line.marked);
    if !label.is_empty() {
        mark = mark.label(visible(label));
    }
    let snippet = Snippet::source(line.text).line_start(line.number).annotation(mark);
    match (place, line.whole) {
        (Place::Text { .. }, true) => group.element(snippet.path(path)),
        (Place::Text { .. }, false) => {
            group.element(Origin::path(path).line(line.number).char_column(line.column)).element(snippet)
        }
        _ => group.element(Origin::path(path)).element(snippet.line_numbering(false)),
    }
}

/// The line in which a span begins.
struct Line<'t> {
    number: usize,
    /// Where the span begins, in characters from 1.
    column: usize,
    /// The line, or what stands around the span if it is too long to be shown.
    text: Cow<'t, str>,
    /// What of the span is in it, bytes.
    marked: Range<usize>,
    /// Whether it is the whole line.
    whole: bool,
}

impl<'t> Line<'t> {
    fn of(text: &'t str, span: &Range<usize>) -> Self {
        // A byte order mark is no character of the first line.
        let mark = text.len() - text.trim_start_matches('\u{feff}').len();
        let start = span.start.clamp(mark, text.len().max(mark));
        let before = text.get(mark..start).unwrap_or_default();
        let number = before.matches('\n').count() + 1;
        let from = mark + before.rfind('\n').map_or(0, |newline| newline + 1);
        let rest = text.get(from..).unwrap_or_default();
        let line = rest.split(['\n', '\r']).next().unwrap_or_default();
        let begin = (start - from).min(line.len());
        let end = span.end.saturating_sub(from).clamp(begin, line.len());
        let column = line.get(..begin).unwrap_or_default().chars().count() + 1;
        if line.len() <= LONGEST_LINE {
            return Self { number, column, text: line.into(), marked: begin..end, whole: true };
        }
        let (text, marked) = around(line, begin, end.min(begin + CONTEXT));
        Self { number, column, text: text.into(), marked, whole: false }
    }
}

/// A stretch of a line with what is around it, and where it is in that.
fn around(line: &str, begin: usize, end: usize) -> (String, Range<usize>) {
    let boundary = |mut at: usize| {
        while !line.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let (begin, end) = (boundary(begin), boundary(end));
    let (from, to) = (boundary(begin.saturating_sub(CONTEXT)), boundary((end + CONTEXT).min(line.len())));
    let part = |range: Range<usize>| line.get(range).unwrap_or_default();
    let before = if from > 0 { "…" } else { "" }.to_owned() + part(from..begin);
    let marked = before.len()..before.len() + part(begin..end).len();
    let after = part(end..to).to_owned() + if to < line.len() { "…" } else { "" };
    (before + part(begin..end) + &after, marked)
}

/// Text without control characters, which could do things to a terminal.
fn visible(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}
