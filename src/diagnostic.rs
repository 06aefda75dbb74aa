//! Faults as text for a terminal: what is wrong, the line where it stands, what to type instead.

use crate::error::{Fault, Place};
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use std::ops::Range;

/// Faults shown in full; the rest are counted.
const SHOWN: usize = 100;
/// Longest line that is shown, bytes.
const LONGEST_LINE: usize = 1000;

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
    let (what, hint) = (visible(&fault.what), visible(&fault.hint));
    let group = level.primary_title(what);
    let mut group: Group<'_> = match &fault.place {
        Place::Text { path, text, span } => {
            let path = visible(&path.display().to_string());
            let (number, line, within) = line(text, span);
            if line.len() > LONGEST_LINE {
                group.element(Origin::path(format!("{path}:{number}")))
            } else {
                let snippet = Snippet::source(line).line_start(number).path(path);
                group.element(snippet.annotation(AnnotationKind::Primary.span(within)))
            }
        }
        Place::Command => group.element(Origin::path("the command line")),
        place => group.element(Origin::path(visible(&place.to_string()))),
    };
    if !hint.is_empty() {
        group = group.element(Level::HELP.message(hint));
    }
    renderer.render(&[group])
}

/// The number and text of the line in which a span begins, and what of the span is in that line.
fn line<'t>(text: &'t str, span: &Range<usize>) -> (usize, &'t str, Range<usize>) {
    let start = span.start.min(text.len());
    let before = text.get(..start).unwrap_or_default();
    let number = before.matches('\n').count() + 1;
    let from = before.rfind('\n').map_or(0, |newline| newline + 1);
    let rest = text.get(from..).unwrap_or_default();
    let line = rest.split(['\n', '\r']).next().unwrap_or_default();
    let begin = (start - from).min(line.len());
    let end = span.end.saturating_sub(from).clamp(begin, line.len());
    (number, line, begin..end)
}

/// Text without control characters, which could do things to a terminal.
fn visible(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}
