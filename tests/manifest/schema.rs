//! The JSON Schema that editors read, by a validator of its own.

use boon::{Compiler, SchemaIndex, Schemas};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn top(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

#[test]
fn schema_is_current() {
    crate::support::is_current("manifests/terrell.schema.json", &terrell::manifest::schema(), "schema");
}

/// The schema, ready to be asked; `at`: a part of it.
struct Validator {
    schemas: Schemas,
    compiler: Compiler,
}

impl Validator {
    fn new() -> Self {
        let schema: Value = serde_json::from_str(&terrell::manifest::schema()).unwrap();
        let mut compiler = Compiler::new();
        compiler.add_resource("terrell.json", schema).unwrap();
        Self { schemas: Schemas::new(), compiler }
    }

    fn part(&mut self, at: &str) -> SchemaIndex {
        self.compiler.compile(&format!("terrell.json#{at}"), &mut self.schemas).unwrap()
    }

    fn wrong(&self, part: SchemaIndex, value: &Value) -> Option<String> {
        self.schemas.validate(value, part).err().map(|error| format!("{error:#}"))
    }
}

fn yaml(text: &str) -> Value {
    serde_yaml::from_str(text).unwrap()
}

fn manifests(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(top(folder)).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    files.sort();
    files
}

#[test]
fn committed_manifests_are_valid_by_the_schema() {
    let mut validator = Validator::new();
    let root = validator.part("");
    let folders = ["manifests", "manifests/gallery", "tools/mitsuba", "tools/frontier"];
    let files: Vec<PathBuf> = folders.into_iter().flat_map(manifests).collect();
    assert!(files.len() >= 35, "{files:?}");
    for file in files {
        let wrong = validator.wrong(root, &yaml(&std::fs::read_to_string(&file).unwrap()));
        assert!(wrong.is_none(), "{}: {}", file.display(), wrong.unwrap());
    }
}

#[test]
fn examples_of_all_keys_are_valid_by_the_schema() {
    let schema: Value = serde_json::from_str(&terrell::manifest::schema()).unwrap();
    let mut validator = Validator::new();
    let mut examples = 0;
    for (record, definition) in schema["$defs"].as_object().unwrap() {
        for (key, value) in definition["properties"].as_object().unwrap() {
            let part = validator.part(&format!("/$defs/{record}/properties/{key}"));
            assert!(!value["description"].as_str().unwrap().is_empty());
            for example in value["examples"].as_array().unwrap() {
                let wrong = validator.wrong(part, example);
                assert!(wrong.is_none(), "{record}.{key}: {}", wrong.unwrap());
                examples += 1;
            }
        }
    }
    assert!(examples > 100, "{examples}");
}

#[test]
fn keys_and_words_that_are_none_are_not_valid_by_the_schema() {
    let mut validator = Validator::new();
    let root = validator.part("");
    let good = std::fs::read_to_string(top("manifests/flyby.yaml")).unwrap();
    assert!(validator.wrong(root, &yaml(&good)).is_none());
    for (from, to) in [
        ("velocity:", "velocty:"),
        ("observer:", "observed:"),
        ("intensity:", "intense:"),
        ("rate: 24", "rate: fast"),
        ("bodies:", "bodies: {}\nothers:"),
        ("output:", "effects: { doppler: no }\noutput:"),
    ] {
        assert!(good.contains(from), "{from}");
        let bad = yaml(&good.replacen(from, to, 1));
        assert!(validator.wrong(root, &bad).is_some(), "{to} was not found");
    }
}
