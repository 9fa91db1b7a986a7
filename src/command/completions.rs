//! `crosscap completions`: what a shell, or a reader of manuals, wants to know of the arguments.

use super::failure::Failure;
use super::terminal::say;
use clap::{Args, Command, ValueEnum};
use clap_complete::Shell;

const EXAMPLES: &str = "Examples:
  crosscap completions bash > ~/.local/share/bash-completion/completions/crosscap
  crosscap completions zsh > ~/.zfunc/_crosscap
  crosscap completions fish > ~/.config/fish/completions/crosscap.fish
  crosscap completions man > crosscap.1
  crosscap completions man reconstruct > crosscap-reconstruct.1";

/// Who is to be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Reader {
    Bash,
    Elvish,
    Fish,
    Powershell,
    Zsh,
    /// A page of the manual, in roff
    Man,
}

/// Print completions for a shell, or a page of the manual
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
pub struct Completions {
    /// The shell, or man
    #[arg(value_name = "SHELL", value_enum)]
    reader: Reader,

    /// The command that the page of the manual is about [default: the program as a whole]
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

impl Completions {
    /// Runs the command; `program` is the definition of all arguments.
    pub fn run(&self, mut program: Command) -> Result<(), Failure> {
        let shell = match self.reader {
            Reader::Bash => Shell::Bash,
            Reader::Elvish => Shell::Elvish,
            Reader::Fish => Shell::Fish,
            Reader::Powershell => Shell::PowerShell,
            Reader::Zsh => Shell::Zsh,
            Reader::Man => return self.page(program),
        };
        if self.command.is_some() {
            return Err(Failure::usage(
                "COMMAND goes with man: completions are for all commands together",
            ));
        }
        let mut text = Vec::new();
        clap_complete::generate(shell, &mut program, "crosscap", &mut text);
        say(String::from_utf8_lossy(&text).trim_end())
    }

    fn page(&self, mut program: Command) -> Result<(), Failure> {
        program.build();
        let command = match &self.command {
            None => program,
            Some(name) => {
                let found = program.find_subcommand(name).cloned();
                let names: Vec<&str> = program.get_subcommands().map(Command::get_name).collect();
                found.ok_or_else(|| {
                    Failure::usage(format!(
                        "found command {name:?}, expected one of {}",
                        names.join(", ")
                    ))
                })?
            }
        };
        let mut text = Vec::new();
        clap_mangen::Man::new(command)
            .render(&mut text)
            .map_err(|error| Failure::usage(format!("the page cannot be written: {error}")))?;
        say(String::from_utf8_lossy(&text).trim_end())
    }
}
