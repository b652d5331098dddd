//! The `stickslip` program.

use std::process::ExitCode;

use stickslip::cli::Allocator;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

fn main() -> ExitCode {
    stickslip::cli::main(std::env::args_os()).into()
}
