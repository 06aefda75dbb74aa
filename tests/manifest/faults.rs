//! Faults: where they are, what is said, how they are shown.

use super::faults;
use std::path::{Path, PathBuf};
use terrell::diagnostic::render;
use terrell::error::{Fault, Place, Report};
use terrell::manifest;

/// The manifests of a folder, in order.
fn manifests(folder: &str) -> Vec<PathBuf> {
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = paths.filter(|path| path.extension().is_some_and(|x| x == "yaml")).collect();
    paths.sort();
    assert!(!paths.is_empty());
    paths
}

/// Each manifest that must fail has the whole of what is said about it beside it.
/// `TERRELL_UPDATE=1` writes what is said now; read the difference before keeping it.
#[test]
fn bad_manifests_are_refused_with_place_fault_and_hint() {
    let mut wrong = Vec::new();
    for path in manifests("tests/manifests/bad") {
        let mut report = Report::default();
        assert!(manifest::load(&path, &mut report).is_none(), "{} was accepted", path.display());
        assert!(report.faults.iter().all(|fault| !fault.hint.is_empty()), "{}: no hint", path.display());
        let lines: Vec<_> = report.faults.iter().map(|fault| format!("{fault}\n")).collect();
        let said = lines.concat().replace("tests/manifests/bad/", "");
        let expected = path.with_extension("expected");
        if std::env::var_os("TERRELL_UPDATE").is_some() {
            std::fs::write(&expected, &said).unwrap();
        }
        if said.is_empty() || std::fs::read_to_string(&expected).ok().as_ref() != Some(&said) {
            wrong.push(format!("{}:\n{said}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "not as expected:\n{}", wrong.join("\n"));
}

#[test]
fn all_faults_are_reported_at_once_in_the_order_of_the_text() {
    let mut report = Report::default();
    manifest::load(Path::new("tests/manifests/bad/everything_at_once.yaml"), &mut report);
    let lines: Vec<_> = report.faults.iter().map(|fault| fault.place.line_column().unwrap().0).collect();
    assert_eq!(lines, [1, 5, 6, 7, 9, 11, 14, 15, 16]);
}

/// The text under the span of each fault.
fn underlined(report: &Report) -> Vec<&str> {
    let under = |fault: &'_ Fault| match &fault.place {
        Place::Text { text, span, .. } => text.get(span.clone()).map(str::len).map(|_| span.clone()),
        _ => None,
    };
    let Some(Place::Text { text, .. }) = report.faults.first().map(|fault| &fault.place) else {
        return Vec::new();
    };
    report.faults.iter().map(|fault| &text[under(fault).unwrap()]).collect()
}

#[test]
fn spans_cover_what_is_wrong_and_nothing_else() {
    let text = "# é 😀\nasets: { a: b }\nobserver:\n  at: 0 0 5   # no unit\n  up: \"0 0 0\"\n  velocity: &v { gama: 2, \
                along: [0, 0, 1] } # slow\n  rotation:\n    - 30 deg about 0 1\n    - &q 3\npicture: { size: '3' , \
                white:\n  2 cd }\nfilm:\n  rate:   0\noutput: { exr: x }\n";
    let report = faults(text);
    assert_eq!(
        underlined(&report),
        [
            "asets",
            "0 0 5",
            "\"0 0 0\"",
            "gama",
            "[0, 0, 1]",
            "30 deg about 0 1",
            "3",
            "'3'",
            "2 cd",
            "0",
            "{ exr: x }",
            "x"
        ]
    );
    let places: Vec<_> = report.faults.iter().map(|fault| fault.place.line_column().unwrap()).collect();
    assert_eq!(places.first(), Some(&(2, 1)));
    assert_eq!(places.get(3), Some(&(6, 18)));
    assert_eq!(places.last(), Some(&(14, 16)));
}

#[test]
fn missing_keys_are_faults_of_the_map_they_are_missing_from() {
    let report = faults("observer: {}\nbodies:\n  - at: 0 0 1 m\n    scale: 2\n\n# the end\noutput: out\n");
    assert_eq!(underlined(&report), ["at: 0 0 1 m\n    scale: 2"]);
}

#[test]
fn misspelt_keys_are_not_missed_a_second_time() {
    let report = faults("observr: {}\nlights: [{ lmap: {} }]\noutput: out\n");
    assert_eq!(underlined(&report), ["observr", "lmap"]);
}

#[test]
fn faults_of_aliases_are_where_the_text_is() {
    let report = faults("spectra: { a: &a { line: 3 }, b: *a }\nobserver: {}\noutput: out\n");
    assert_eq!(underlined(&report), ["3", "3"]);
}

#[test]
fn faults_on_the_command_line_name_the_path_of_keys() {
    let text = "observer: {}\noutput: out\n";
    let said = |key: &str, value: &str| {
        let mut report = Report::default();
        let overrides = [(key.to_owned(), value.to_owned())];
        assert!(manifest::parse_with(Path::new("m.yaml"), text, &overrides, &mut report).is_none());
        let marked = |fault: &Fault| match &fault.place {
            Place::Argument { text, span } => format!("{}[{}]", &text[..span.start], &text[span.clone()]),
            place => panic!("{place:?}"),
        };
        let said = |fault: &Fault| format!("{} {}", marked(fault), fault.what);
        report.faults.iter().map(said).collect::<Vec<_>>().join("; ")
    };
    assert_eq!(
        said("observer.velocity", "0 0 2 c"),
        "--set observer.velocity=[0 0 2 c] `0 0 2 c` is 2 c, not below the speed of light"
    );
    assert_eq!(
        said("observer.velocty", "0 0 0 c"),
        "--set [observer.velocty] `velocty` is not a key of the observer"
    );
    assert_eq!(
        said("output.exr", "on"),
        "--set [output.exr] there is the text `out` here, which has no `exr`"
    );
    assert_eq!(said("observer..at", "1"), "--set [observer..at] the path has an empty key");
    assert_eq!(
        said("observer.at", "{"),
        "--set observer.at={[] this is not YAML: while parsing a node, did not find expected node content"
    );
    assert_eq!(said("observer.at", ""), "--set [observer.at] `observer.at` has no value");
    assert_eq!(
        said("observer", "{ up: 0 1, view: x }"),
        "--set observer={ up: 0 1, [view] `view` is not a key of the observer; --set observer={ up: [0 1] a direction is 3 \
         numbers; here are 2"
    );
}

#[test]
fn files_that_cannot_be_read_are_faults() {
    let folder = tempfile::tempdir().unwrap();
    let said = |bytes: Option<&[u8]>| {
        let path = folder.path().join("m.yaml");
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).unwrap();
        }
        let mut report = Report::default();
        assert!(manifest::load(&path, &mut report).is_none());
        report.faults.into_iter().map(|fault| fault.what).collect::<Vec<_>>().join("; ")
    };
    assert_eq!(said(None), "there is no such file");
    assert_eq!(said(Some(b"a: b\nc: \xff\n")), "it is not UTF-8 text (line 2)");
    assert_eq!(said(Some(b"\xff\xfea\0:\0")), "it is UTF-16: save it as UTF-8");
    assert_eq!(said(Some(&vec![b'#'; (4 << 20) + 1])), "it is larger than 4 MiB");
}

#[test]
fn shown_faults_have_their_line_a_mark_and_a_hint() {
    let report = faults("observer:\n  at: 0 2 -9.5  # high\noutput: out\n");
    let expected = "\
error: a place needs a unit
 --> m.yaml:2:7
  |
2 |   at: 0 2 -9.5  # high
  |       ^^^^^^^^
  |
  = help: at: 0 2 -9.5 m

";
    assert_eq!(render(&report.faults, false, false), expected);
    assert!(render(&report.faults, true, false).starts_with("warning: a place needs a unit\n"));
    assert!(render(&report.faults, false, true).contains("\u{1b}["));
}

#[test]
fn shown_faults_of_other_places_name_them() {
    let faults = [
        Fault::new(Place::element("a.glb", "nodes[3].mesh"), "no such mesh", ""),
        Fault::new(Place::file("a.obj"), "empty", "export it again"),
        Fault::new(Place::Command, "no command", ""),
    ];
    let expected = "\
error: no such mesh
--> a.glb: nodes[3].mesh

error: empty
--> a.obj
 = help: export it again

error: no command
--> the command line

";
    assert_eq!(render(&faults, false, false), expected);
}

#[test]
fn shown_faults_send_no_escapes_of_the_users_to_the_terminal() {
    let shown = render(&faults("observer: {}\noutput: out\n\"\\e[2J\": 1\n").faults, false, false);
    assert!(shown.contains("is not a key"));
    assert!(!shown.contains('\u{1b}'), "{shown:?}");
    let shown = render(&faults("observer: {} # \u{1b}[31m\n").faults, false, false);
    assert!(shown.contains("observer: {} # "), "{shown:?}");
    assert!(!shown.contains('\u{1b}'), "{shown:?}");
    let fault = Fault::new(Place::element("\u{1b}[1m", "\u{7}"), "a\nb", "c\r\u{9b}d");
    let shown = render(&[fault], false, false);
    assert_eq!(shown.matches('\u{fffd}').count(), 5, "{shown:?}");
}

#[test]
fn shown_faults_are_no_more_than_can_be_read() {
    let mut text = "observer: {}\noutput: out\n".to_owned();
    (0..5000).for_each(|i| text.push_str(&format!("key{i}: 1\n")));
    let report = faults(&text);
    assert_eq!(report.faults.len(), 1000);
    let shown = render(&report.faults, false, false);
    assert_eq!(shown.matches("error:").count(), 100);
    assert!(shown.ends_with("and 900 more\n\n"));
}

#[test]
fn shown_faults_in_endless_lines_show_what_is_around_them() {
    let (before, after) = ("é".repeat(900), " ".repeat(5000));
    let text = format!("observer: {{ x: \"{before}\", up: 0 1 0, at: 3, {after}}}\noutput: out\n");
    let report = faults(&text);
    let shown = render(&report.faults, false, false);
    assert!(shown.contains("m.yaml:1:935"), "{shown}");
    let (line, marks) = {
        let at = shown.lines().position(|line| line.contains("at: 3")).unwrap();
        (shown.lines().nth(at).unwrap(), shown.lines().nth(at + 1).unwrap())
    };
    let column = |line: &str, of: &str| line[..line.find(of).unwrap()].chars().count();
    assert_eq!(column(line, "3,"), column(marks, "^"), "{shown}");
    assert!(line.contains('…') && line.chars().count() < 200, "{shown}");
}

#[test]
fn shown_faults_do_not_count_a_byte_order_mark() {
    let report = faults("\u{feff}observer: { at: 3 }\noutput: out\n");
    assert_eq!(report.faults[0].place.line_column(), Some((1, 17)));
    let shown = render(&report.faults, false, false);
    assert!(shown.contains("m.yaml:1:17\n") && !shown.contains('\u{feff}'), "{shown}");
    assert!(shown.contains("1 | observer: { at: 3 }\n  |                 ^\n"), "{shown}");
}

#[test]
fn shown_faults_on_the_command_line_have_their_argument_and_a_mark() {
    let mut report = Report::default();
    let overrides = [("observer.at".to_owned(), "0 1 5".to_owned())];
    manifest::parse_with(Path::new("m.yaml"), "observer: {}\noutput: out\n", &overrides, &mut report);
    let expected = "\
error: a place needs a unit
--> the command line
 |
 | --set observer.at=0 1 5
 |                   ^^^^^
 |
 = help: at: 0 1 5 m

";
    assert_eq!(render(&report.faults, false, false), expected);
}

#[test]
fn shown_faults_have_the_other_place_that_has_to_do_with_them() {
    let report = faults("observer: { at: 0 0 0 m,\n  at: 0 0 1 m }\noutput: out\n");
    let shown = render(&report.faults, false, false);
    assert!(shown.contains("2 |   at: 0 0 1 m }\n  |   ^^\n"), "{shown}");
    assert!(shown.contains("1 | observer: { at: 0 0 0 m,\n  |             -- the first\n"), "{shown}");
}
