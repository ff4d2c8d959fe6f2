//! Neovim's own client, without a screen: a mistake, its fix, a completion, a rename, the layout.
//!
//! Skipped with a word where there is no Neovim, unless `ARL_PEERS=required`.

use super::Folder;
use std::process::{Command, Stdio};

const PROGRAM: &str = "joint home = {0, -90, 90, 0, 90, 0}\nfunc void main()\n    waitime 1\nendfunc\n";

#[test]
fn a_program_is_typed_in_neovim() {
    let there = Command::new("nvim").arg("--version").stdout(Stdio::null()).status().is_ok();
    if !there {
        assert!(std::env::var("ARL_PEERS").as_deref() != Ok("required"), "Neovim is not installed");
        eprintln!("skipped: Neovim is not installed");
        return;
    }
    let folder = Folder::new("neovim").with("main.arl", PROGRAM);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/server/neovim.lua");
    let output = Command::new("nvim")
        .args(["--headless", "--clean", "-n", "-c", &format!("luafile {script}")])
        .env("ARL2RS", env!("CARGO_BIN_EXE_arl2rs"))
        .env("ARL_FILE", folder.path.join("main.arl"))
        .output()
        .expect("Neovim starts");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let expected = "mistake ARL0211 2\nline     waittime 1\noffered home\nhover '''arl\nline     movej rest,vp:50%\n\
        line     movej rest, vp:50%\n";
    assert_eq!(printed.replace("\r", ""), expected, "{}", String::from_utf8_lossy(&output.stderr));
}
