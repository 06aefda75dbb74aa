//! Tables of wavelengths and values: CSV files, or lists in the manifest.

use super::node::{Content, Node};
use super::plain::FilePath;
use super::reader::{Read, Reader, Reported};
use super::record::{Kind, Shape};
use crate::error::{Place, table_lines};
use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

/// Largest text file that is read, bytes.
pub(crate) const LARGEST_TEXT: u64 = 4 << 20;

/// Most rows of a table.
const MOST_ROWS: usize = 100_000;

/// Wavelengths in nm, rising, each with its value.
pub type Rows = Arc<[(f64, f64)]>;

/// The text of a file that is not too large, or why there is none.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    let mut bytes = Vec::new();
    if path.metadata().is_ok_and(|about| !about.is_file() && !about.is_dir()) {
        return Err("this is not a file".to_owned());
    }
    let read = File::open(path).and_then(|file| file.take(LARGEST_TEXT + 1).read_to_end(&mut bytes));
    read.map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::IsADirectory => "this is a folder".to_owned(),
        _ => format!("it cannot be read: {error}"),
    })?;
    if bytes.len() as u64 > LARGEST_TEXT {
        return Err("it is larger than 4 MiB".to_owned());
    }
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err("it is UTF-16: save it as UTF-8".to_owned());
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.split(|b| *b == b'\n').count();
        format!("it is not UTF-8 text (line {line})")
    })
}

/// A path to a CSV file, or a list of pairs.
pub(crate) struct Table;

impl Kind for Table {
    type Value = Rows;
    fn shape() -> Shape {
        let pair = || Shape::List(|| Shape::Number("a wavelength in nm, then a value"));
        Shape::Either(vec![FilePath::shape(), Shape::List(pair)])
    }
    fn read(node: &Node, reader: &mut Reader<'_>) -> Read<Rows> {
        let rows = match &node.content {
            Content::List(items) => {
                let rows: Vec<_> = items.iter().map(|item| pair(item, reader)).collect();
                rows.into_iter().collect::<Read<Vec<_>>>()?
            }
            _ => csv(node, reader)?,
        };
        check(&node.place, &rows, reader)?;
        Ok(rows.iter().map(|row| row.numbers).collect())
    }
}

/// A row and where it stands.
struct Row {
    place: Place,
    numbers: (f64, f64),
}

fn pair(item: &Node, reader: &mut Reader<'_>) -> Read<Row> {
    let numbers: Option<Vec<f64>> = match &item.content {
        Content::List(pair) => pair.iter().map(|number| number.text()?.parse().ok()).collect(),
        _ => None,
    };
    match numbers.as_deref() {
        Some(&[wavelength, value]) => Ok(Row { place: item.place.clone(), numbers: (wavelength, value) }),
        _ => Err(reader.fault(&item.place, "a row is a wavelength in nm and a value", "[550, 0.8]")),
    }
}

fn csv(node: &Node, reader: &mut Reader<'_>) -> Read<Vec<Row>> {
    let path = FilePath::read(node, reader)?;
    let text: Arc<str> = match read_text(&path) {
        Ok(text) => text.into(),
        Err(why) => {
            reader.report.inputs.depend(&path);
            let what = format!("the table `{}`: {why}", path.display());
            return Err(reader.fault(&node.place, what, "paths are relative to the manifest's folder"));
        }
    };
    reader.report.inputs.add(&path, text.as_bytes());
    let (mut rows, mut sound) = (Vec::new(), true);
    let path: Arc<Path> = path.into();
    for (from, kept) in table_lines(&text) {
        let place = || Place::Text { path: path.clone(), text: text.clone(), span: from..from + kept.len() };
        let numbers: Option<Vec<f64>> = kept.split(',').map(|cell| cell.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[wavelength, value]) => rows.push(Row { place: place(), numbers: (wavelength, value) }),
            // A first line without any digit names the columns.
            _ if rows.is_empty() && sound && !kept.starts_with(|c: char| c.is_ascii_digit()) => {}
            _ => {
                sound = false;
                reader.fault(&place(), "a row is a wavelength in nm and a value", "550, 0.8");
            }
        }
        if !sound && reader.report.faults.len() > 100 {
            break;
        }
        if rows.len() > MOST_ROWS {
            let what = format!("the table `{}` has more than {MOST_ROWS} rows", path.display());
            return Err(reader.fault(&node.place, what, "leave out what lies between"));
        }
    }
    if sound { Ok(rows) } else { Err(Reported) }
}

fn check(place: &Place, rows: &[Row], reader: &mut Reader<'_>) -> Read<()> {
    let mut sound = Ok(());
    for row in rows {
        let (wavelength, value) = row.numbers;
        if !(wavelength > 0.0 && wavelength <= 1e12 && (0.0..=1e30).contains(&value)) {
            let what = "a wavelength is above zero, a value zero or more, and both are finite";
            sound = Err(reader.fault(&row.place, what, "550, 0.8"));
        }
    }
    sound?;
    for pair in rows.windows(2) {
        if let [before, row] = pair
            && row.numbers.0 <= before.numbers.0
        {
            let what =
                format!("wavelengths must rise: {} nm comes after {} nm", row.numbers.0, before.numbers.0);
            return Err(reader.fault(&row.place, what, "sort the rows by wavelength, each once"));
        }
    }
    if rows.len() < 2 {
        let what = "a table has at least two rows";
        return Err(reader.fault(place, what, "one value at all wavelengths is `constant: 0.8`"));
    }
    Ok(())
}
