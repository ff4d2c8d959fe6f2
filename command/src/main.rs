//! The `arl2rs` command.

fn main() -> std::process::ExitCode {
    arl2rs_cli::main()
}
