//! What stands below the flags in `--help`: what to type.

pub(super) const EXAMPLES: &str = "\
Examples:
  terrell render manifests/flyby.yaml
  terrell render manifests/flyby.yaml --exposure 40 --size 1920x1080 --samples 16 --out out/large
  terrell render manifests/flyby.yaml --exposure 40 --tolerance 1 --out out/settled
  terrell chart manifests/flyby.yaml
  terrell render manifests/flyby.yaml --set observer.velocity=\"0 0 0.5 c\" --out out/moving
  terrell check manifests/flyby.yaml
  terrell new assets/monkey.glb --flyby
  terrell inspect assets/monkey.glb";

pub(super) const RENDER: &str = "\
Examples:
  terrell render manifests/flyby.yaml
  terrell render manifests/flyby.yaml --from 40 --to 50
  terrell render manifests/flyby.yaml --exposure 40 --size 1920x1080 --samples 16 --out out/large
  terrell render manifests/flyby.yaml --exposure 40 --tolerance 1 --out out/settled
  terrell render manifests/flyby.yaml --set observer.velocity=\"0 0 0.5 c\" --out out/moving
  terrell render manifests/prism.yaml manifests/tumbler.yaml --scale 0.25
  terrell render manifests/flyby.yaml --preview
  terrell render manifests/flyby.yaml --exposure 40 --preview=terminal --watch

A film that was stopped is continued by the same command. If the manifest, a file that it reads or the program has
changed since, nothing is rendered: --restart renders all anew, --out FOLDER leaves what is there as it is.";

pub(super) const CHECK: &str = "\
Examples:
  terrell check manifests/flyby.yaml
  terrell check manifests/flyby.yaml --set bodies.0.velocity=\"0.99 0 0 c\"";

pub(super) const CHART: &str = "\
Examples:
  terrell chart manifests/flyby.yaml
  terrell chart manifests/flyby.yaml --exposure 40 --runs 3 --out out/chart";

pub(super) const INSPECT: &str = "\
Examples:
  terrell inspect assets/monkey.glb";

pub(super) const NEW: &str = "\
Examples:
  terrell new assets/monkey.glb --flyby
  terrell new assets/dice.glb --turntable -o out/dice.yaml --force

It chooses distances, speed, light and exposure so that the first picture is good, and says what each line means.";

pub(super) const SHEET: &str = "\
Examples:
  terrell sheet assets/monkey.png --columns 2 --out out/sheet.png

Folders are those that `terrell render` has written: `terrell sheet out/gallery/* --columns 6 --width 240`.";

pub(super) const SCHEMA: &str = "\
Examples:
  terrell schema --out manifests/terrell.schema.json

An editor with a YAML language server uses it where a manifest begins with
  # yaml-language-server: $schema=terrell.schema.json";

pub(super) const COMPLETIONS: &str = "\
Examples:
  terrell completions bash > ~/.local/share/bash-completion/completions/terrell
  terrell completions zsh > ~/.zfunc/_terrell
  terrell completions fish > ~/.config/fish/completions/terrell.fish";

pub(super) const MAN: &str = "\
Examples:
  terrell man --out ~/.local/share/man/man1
  terrell man";

#[cfg(test)]
mod tests {
    use crate::cli::Cli;
    use clap::{CommandFactory, Parser};
    use std::path::Path;

    /// Words as a shell parts them, up to where the output goes.
    fn words(line: &str) -> Vec<String> {
        let (mut words, mut quoted) = (vec![String::new()], false);
        for letter in line.chars() {
            match letter {
                '"' => quoted = !quoted,
                ' ' if !quoted => words.push(String::new()),
                _ => words.last_mut().unwrap().push(letter),
            }
        }
        words.into_iter().take_while(|word| word != ">").collect()
    }

    #[test]
    fn examples_in_all_help_texts_can_be_typed() {
        let mut command = Cli::command();
        command.build();
        let mut typed = 0;
        let commands = command.get_subcommands().filter(|command| command.get_name() != "help");
        for command in commands.chain([&command]) {
            let help = command.get_after_help().unwrap_or_else(|| panic!("{} has none", command.get_name()));
            for line in help.to_string().lines().filter_map(|line| line.strip_prefix("  terrell ")) {
                let words = words(&format!("terrell {line}"));
                Cli::try_parse_from(&words).unwrap_or_else(|error| panic!("{line}: {error}"));
                let files =
                    words.iter().filter(|word| word.starts_with("manifests/") || word.starts_with("assets/"));
                for file in files {
                    assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(file).exists(), "{file}");
                }
                typed += 1;
            }
        }
        assert!(typed > 15, "{typed}");
    }
}
