//! The manual page and the completion of shells, made from the command line's description.

use std::io;

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use super::args::{Args, NUMBER};

/// Name of the program.
const NAME: &str = "stickslip";

/// The lines with which clap_mangen defines the apostrophe.
const APOSTROPHE: [&str; 2] = [r".ie \n(.g .ds Aq \(aq", ".el .ds Aq '"];

/// The manual page: all commands with their options.
pub fn manual() -> String {
    let mut command = Args::command()
        .version(NUMBER)
        .long_version(NUMBER)
        .disable_help_subcommand(true);
    command.build();
    let mut page = Vec::new();
    // writing to memory cannot fail
    let _ = write(&command, &mut page);
    let page = String::from_utf8_lossy(&page);
    // every part begins with the definition of the apostrophe, which one page needs once
    let is_definition = |line: &&str| APOSTROPHE.contains(line);
    let lines = page.lines().filter(|line| !is_definition(line));
    let lines = APOSTROPHE.into_iter().chain(lines);
    lines.map(|line| format!("{}\n", line.trim_end())).collect()
}

fn write(command: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    let man = Man::new(command.clone());
    man.render_title(page)?;
    man.render_name_section(page)?;
    man.render_synopsis_section(page)?;
    man.render_description_section(page)?;
    man.render_options_section(page)?;
    page.extend(b".SH COMMANDS\n");
    write_commands(command, page)?;
    man.render_extra_section(page)?;
    man.render_version_section(page)
}

/// The commands below a command, each under a heading of its own.
fn write_commands(command: &Command, page: &mut Vec<u8>) -> io::Result<()> {
    for command in command.get_subcommands() {
        if command.has_subcommands() {
            write_commands(command, page)?;
            continue;
        }
        let man = Man::new(command.clone());
        let mut sections = Vec::new();
        man.render_description_section(&mut sections)?;
        man.render_synopsis_section(&mut sections)?;
        man.render_options_section(&mut sections)?;
        let name = command.get_bin_name().unwrap_or_else(|| command.get_name());
        page.extend(format!(".SS \"{name}\"\n").bytes());
        for line in String::from_utf8_lossy(&sections).lines() {
            let line = if line.starts_with(".SH") { ".PP" } else { line };
            page.extend(format!("{line}\n").bytes());
        }
    }
    Ok(())
}

/// Script with which a shell completes the words of the program.
pub(super) fn completion(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), NAME, &mut script);
    String::from_utf8_lossy(&script).into_owned()
}
