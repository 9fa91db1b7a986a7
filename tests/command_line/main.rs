//! The built program, run as a user runs it.

mod bad_input;
mod checks;
mod columns;
mod comparison;
mod demonstration;
mod dimension;
mod memory;
mod molecules;
mod pictures;
mod reconstruction;
mod room;
mod samples;
mod usage;
