//! The command line `crosscap`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(crosscap::command::run(std::env::args_os()))
}
