//! What a shell, `man` and an editor know of the program, made from the same words as `--help` and the reference.

use super::Cli;
use crate::error::Error;
use crate::output::write_whole;
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// A folder for all pages, one for each command, instead of the first to the standard output
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(super) struct SchemaArgs {
    /// A file to write it to, instead of the standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Prints or writes the JSON Schema of manifests.
pub(super) fn schema(args: &SchemaArgs) -> Result<(), Error> {
    let schema = crate::manifest::schema();
    match &args.out {
        Some(path) => write_whole(path, |file| file.write_all(schema.as_bytes())),
        None => super::print(&schema),
    }
}

/// Prints what a shell completes by.
pub(super) fn completions(args: &CompletionsArgs) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "terrell", &mut script);
    super::print(&String::from_utf8_lossy(&script))
}

/// Prints or writes the pages of the manual.
pub(super) fn man(args: &ManArgs) -> Result<(), Error> {
    let mut command = Cli::command();
    command.build();
    let Some(folder) = &args.out else { return super::print(&String::from_utf8_lossy(&page(&command))) };
    let subcommands = command.get_subcommands().filter(|command| command.get_name() != "help");
    for command in subcommands.chain([&command]) {
        let name = command.get_display_name().unwrap_or_else(|| command.get_name());
        write_whole(&folder.join(format!("{name}.1")), |file| file.write_all(&page(command)))?;
    }
    Ok(())
}

fn page(command: &clap::Command) -> Vec<u8> {
    let mut page = Vec::new();
    // Into memory nothing fails.
    let _ = clap_mangen::Man::new(command.clone()).render(&mut page);
    page
}
