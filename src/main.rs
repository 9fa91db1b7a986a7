//! The command line `crosscap`.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    command::run()
}
