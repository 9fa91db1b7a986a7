//! The command line: commands, one a file, and what they share.
//!
//! A part of the library, so that what else is built on it brings the same command line: the Python package
//! does. Its items are no public interface.

mod bytes;
mod check;
mod choice;
mod compare;
mod compare_plot;
mod compare_table;
mod completions;
pub mod convert;
mod cost;
mod demo;
mod dimension;
pub mod estimators;
mod failure;
pub mod findings;
mod input;
pub mod layout;
mod limited;
mod needs;
mod number;
mod observed;
pub mod origin;
pub mod outcome;
mod output;
pub mod overlay;
mod paper;
mod parameters;
pub mod picture;
mod points;
pub mod reconstruct;
mod refused;
mod repeat;
mod sample;
mod spaces;
mod terminal;
mod view;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};
use cost::Cost;
use failure::Failure;
use std::ffi::OsString;

const EXIT_CODES: &str = "Exit codes:
  0  done; for a reconstruction or a check: the mesh is verified
  1  no verified mesh: the reason, the place and the parameter to change are printed
  2  bad usage, bad input, or a file that cannot be written

Examples:
  crosscap demo
  crosscap sample two-spheres -o points.npy
  crosscap reconstruct points.npy -o mesh.npz
  crosscap check mesh.npz --points points.npy
  crosscap view mesh.npz -o mesh.html

`crosscap COMMAND --help` tells more about a command, with examples.";

/// Triangulated surfaces that may cross themselves, from points in R^N.
///
/// A cloud of points goes in, a triangulated surface comes out, with its Betti numbers, its pieces and a verdict. A
/// surface may cross itself along double curves, and may have a boundary (whose points are given).
///
/// Method: S. Martin and J.-P. Watson, Non-manifold surface reconstruction from high-dimensional point cloud data,
/// Computational Geometry 44 (2011).
#[derive(Debug, Parser)]
#[command(name = "crosscap", version, after_long_help = EXIT_CODES)]
#[command(arg_required_else_help = true, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Demo(demo::Demo),
    Sample(sample::Sample),
    Reconstruct(Box<reconstruct::Reconstruct>),
    Check(check::Check),
    Dimension(dimension::Dimension),
    Compare(compare::Compare),
    View(view::View),
    Convert(convert::Convert),
    Paper(paper::Paper),
    Completions(completions::Completions),
}

/// Runs a command line, the name of the program first, and returns the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(message) => {
            // A reader that has gone away (a closed pipe) is no reason to complain.
            let _ = message.print();
            return match message.kind() {
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => 0,
                _ => Failure::USAGE,
            };
        }
    };
    let cost = Cost::start();
    let result = match cli.command {
        Command::Demo(command) => command.run(),
        Command::Sample(command) => command.run(),
        Command::Reconstruct(command) => command.run(),
        Command::Check(command) => command.run(),
        Command::Dimension(command) => command.run(),
        Command::Compare(command) => command.run(),
        Command::View(command) => command.run(),
        Command::Convert(command) => command.run(),
        Command::Paper(command) => command.run(),
        Command::Completions(command) => command.run(Cli::command()),
    };
    let code = match result {
        Ok(()) => 0,
        Err(failure) => {
            terminal::complain(&failure);
            failure.code()
        }
    };
    if cost.is_worth_telling() {
        terminal::complain(cost);
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_definition_of_the_arguments_is_consistent() {
        Cli::command().debug_assert();
    }
}
