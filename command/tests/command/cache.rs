//! What the cache holds, and how it is compiled. cargo is a script here, which makes a program of one line: so each
//! test has a cache of its own, and nothing takes long.
#![cfg(unix)]

use super::{Answer, Folder};
use std::fs::{OpenOptions, Permissions};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Stdio;

const PRINTS: &str = "func void main()\n    print 1\nendfunc\n";

/// cargo: makes a library and a program where there are none, and says so.
const CARGO: &str = r#"#!/bin/sh
env > "$LOG/environment"; pwd > "$LOG/folder"; echo "$@" > "$LOG/words"
for word; do
    case "$before" in --target-dir) target=$word;; --manifest-path) manifest=$word;; esac
    before=$word
done
name=$(sed -n 's/^name = "\(.*\)"/\1/p' "$manifest")
deps=$target/debug/deps; mkdir -p "$deps"
made() { # a file and what it holds
    if [ -e "$1" ]; then fresh=true; else fresh=false; printf "$2" > "$1"; chmod +x "$1"; echo "$1" >> "$LOG/made"; fi
}
artifact() { # of which manifest, what it is, its name, its file, its executable
    printf '{"reason":"compiler-artifact","manifest_path":"%s","fresh":%s,' "$1" $fresh
    printf '"target":{"name":"%s","kind":["%s"]},"filenames":["%s"],"executable":%s}\n' "$3" "$2" "$4" "$5"
}
made "$deps/libarl_rt-1.rlib" 'the runtime\n'
artifact /runtime/Cargo.toml lib arl_rt "$deps/libarl_rt-1.rlib" null
made "$deps/$name-1" '#!/bin/sh\necho ran\n'
ln -f "$deps/$name-1" "$target/debug/$name"
artifact "$manifest" bin "$name" "$target/debug/$name" "\"$target/debug/$name\""
"#;

/// A folder with a program and a cache of its own.
struct Cached(Folder);

impl Cached {
    fn new(name: &str) -> Self {
        let folder = Folder::new(name).with("a.arl", PRINTS).with("cargo", CARGO);
        let cargo = folder.path.join("cargo");
        std::fs::set_permissions(cargo, Permissions::from_mode(0o755)).expect("the script");
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path.join(name)
    }

    fn command(&self, words: &[&str]) -> std::process::Command {
        let mut command = self.0.command(words);
        command.env("CARGO", self.path("cargo")).env("ARL2RS_CACHE", self.path("cache")).env("LOG", &self.0.path);
        command
    }

    fn arl2rs(&self, words: &[&str]) -> Answer {
        Answer::of(self.command(words).output().expect("the command starts"))
    }

    /// The files of the cache whose paths have all these words.
    fn files(&self, words: &[&str]) -> Vec<PathBuf> {
        let mut found = Vec::new();
        below(&self.path("cache"), &mut found);
        found.retain(|path| words.iter().all(|word| path.to_string_lossy().contains(word)));
        found
    }

    #[track_caller]
    fn file(&self, words: &[&str]) -> PathBuf {
        let found = self.files(words);
        assert_eq!(found.len(), 1, "{words:?}: {found:?}");
        found[0].clone()
    }
}

fn below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.path().is_dir() {
            below(&entry.path(), found);
        } else {
            found.push(entry.path());
        }
    }
}

/// The ways in which a file goes bad: nothing is left, something is left, a bit has flipped.
fn damaged(bytes: &[u8]) -> [Vec<u8>; 3] {
    let mut flipped = bytes.to_vec();
    flipped[bytes.len() / 2] ^= 4;
    [Vec::new(), bytes[..bytes.len() / 2].to_vec(), flipped]
}

/// Writes into a file as it is, all of its names included.
fn overwrite(path: &Path, bytes: &[u8]) {
    use std::io::Write;
    let mut file = OpenOptions::new().write(true).truncate(true).open(path).expect("the file");
    file.write_all(bytes).expect("written");
}

#[test]
fn a_program_that_is_damaged_is_compiled_anew() {
    let cached = Cached::new("damaged");
    cached.arl2rs(&["run", "a.arl", "--engine", "native"]).is(0, "ran\n");
    let again = cached.arl2rs(&["run", "a.arl", "--engine", "native"]);
    again.is(0, "ran\n");
    assert_eq!(again.err, "", "an unchanged program starts without a word");
    for words in [["programs", "/a-"], ["programs", "/stamp"]] {
        let file = cached.file(&words);
        let whole = std::fs::read(&file).expect("the file");
        for (at, bytes) in damaged(&whole).into_iter().enumerate() {
            overwrite(&file, &bytes);
            let answer = cached.arl2rs(&["run", "a.arl", "--engine", "native"]);
            answer.is(0, "ran\n");
            // An empty file was no stamp.
            let reports_damage = answer.err.contains("is damaged: the program is compiled anew");
            assert!(reports_damage || (words[1] == "/stamp" && at == 0), "{words:?}: {}", answer.err);
            assert_eq!(cached.arl2rs(&["run", "a.arl", "--engine", "native"]).err, "", "{words:?}");
        }
    }
    // What is said of a program is kept, too.
    cached.0.write("a.arl", "func void main()\n    int unused = 1\nendfunc\n");
    cached.arl2rs(&["run", "a.arl", "--engine", "native"]).is(0, "ran\n").says("ARL0902");
    overwrite(&cached.file(&["programs", "/said"]), b"error: nonsense");
    let answer = cached.arl2rs(&["run", "a.arl", "--engine", "native"]);
    answer.is(0, "ran\n").says("said is damaged").says("ARL0902");
    assert!(!answer.err.contains("nonsense"), "{}", answer.err);
}

#[test]
fn what_cargo_made_and_is_damaged_is_made_anew() {
    let cached = Cached::new("made");
    cached.arl2rs(&["run", "a.arl", "--engine", "native"]).is(0, "ran\n");
    for (words, name) in [(["deps", "libarl_rt"], "libarl_rt-1.rlib"), (["deps", "/arl-a-"], "arl-a-")] {
        let file = cached.file(&words);
        let whole = std::fs::read(&file).expect("the file");
        for bytes in damaged(&whole) {
            overwrite(&file, &bytes);
            // cargo is asked again where the program is gone.
            std::fs::remove_file(cached.file(&["programs", "/a-"])).expect("removed");
            let answer = cached.arl2rs(&["run", "a.arl", "--engine", "native"]);
            answer.is(0, "ran\n").says(name).says("is damaged: it is compiled anew");
            assert_eq!(std::fs::read(&file).ok().as_ref(), Some(&whole));
            std::fs::remove_file(cached.file(&["programs", "/a-"])).expect("removed");
            let answer = cached.arl2rs(&["run", "a.arl", "--engine", "native"]);
            answer.is(0, "ran\n");
            assert_eq!(answer.err, "");
        }
    }
    // A lock file that cannot be read is that of the runtime again.
    std::fs::write(cached.file(&["programs", "Cargo.lock"]), "[[package").expect("written");
    std::fs::remove_file(cached.file(&["programs", "/a-"])).expect("removed");
    cached.arl2rs(&["run", "a.arl", "--engine", "native"]).is(0, "ran\n");
    let lock = std::fs::read_to_string(cached.file(&["programs", "Cargo.lock"])).expect("a text");
    assert!(lock.contains("name = \"arl-rt\""), "{lock}");
}

#[test]
fn builds_depend_on_nothing_around_them() {
    let cached = Cached::new("around");
    // cargo would obey these from the folder of the program up.
    for above in [".cargo", "cache/.cargo", "cache/programs/.cargo"] {
        cached.0.write(&format!("{above}/config.toml"), "[build]\nrustc-wrapper = \"/bin/false\"\n");
    }
    let own = [
        ("RUSTFLAGS", "-C overflow-checks=on"),
        ("CARGO_ENCODED_RUSTFLAGS", "-Coverflow-checks=on"),
        ("CARGO_BUILD_RUSTFLAGS", "-C overflow-checks=on"),
        ("CARGO_BUILD_TARGET", "wasm32-unknown-unknown"),
        ("CARGO_TARGET_DIR", "/nowhere"),
        ("CARGO_PROFILE_DEV_PANIC", "abort"),
        ("CARGO_INCREMENTAL", "0"),
        ("CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER", "/bin/false"),
        ("RUSTC_WRAPPER", "/bin/false"),
        ("RUSTC_WORKSPACE_WRAPPER", "/bin/false"),
    ];
    let around = [
        ("CARGO_HOME", "/home/me/.cargo"),
        ("CARGO_HTTP_PROXY", "http://proxy"),
        ("CARGO_REGISTRIES_MINE_INDEX", "https://mine"),
        ("CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER", "clang"),
    ];
    let mut command = cached.command(&["run", "a.arl", "--engine", "native"]);
    command.envs(own).envs(around).stdin(Stdio::null());
    Answer::of(command.output().expect("the command starts")).is(0, "ran\n");
    assert_eq!(cached.0.read("folder"), "/\n", "cargo looks for settings from where it is up to the root");
    let environment = cached.0.read("environment");
    let value = |name: &str| environment.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix('='));
    for (name, _) in own {
        assert!(value(name).is_none_or(str::is_empty), "{name}: {:?}", value(name));
    }
    for (name, given) in around {
        assert_eq!(value(name), Some(given), "{name}");
    }
    // These go before the settings of a user's.
    assert_eq!(["CARGO_ENCODED_RUSTFLAGS", "RUSTC_WRAPPER"].map(value), [Some(""); 2]);
    assert!(cached.0.read("words").contains("--config profile.dev.panic=\"unwind\""));
}

#[test]
fn without_a_terminal_a_message_says_what_takes_long() {
    let cached = Cached::new("told");
    cached.0.write("b.arl", PRINTS);
    let first = cached.arl2rs(&["run", "a.arl", "--engine", "native"]);
    first.is(0, "ran\n").says("compiling the runtime, once for all programs: this takes a minute or two\n");
    first.says("compiled in ");
    assert_eq!(cached.arl2rs(&["run", "b.arl", "--engine", "native"]).err, "", "the runtime is there");
}

#[test]
fn a_cache_that_cannot_be_written_is_reported() {
    let cached = Cached::new("unwritable");
    // A file in a folder's place: also for a user who may write everything.
    cached.0.write("cache/programs", "");
    cached.arl2rs(&["run", "a.arl", "--engine", "native"]).is(1, "").says("cannot make the folder");
    let mut command = cached.command(&["run", "a.arl", "--engine", "native"]);
    command.env("ARL2RS_CACHE", "/proc/nowhere");
    Answer::of(command.output().expect("the command starts")).is(1, "").says("/proc/nowhere");
}

#[test]
fn clean_leaves_alone_what_is_not_of_the_cache() {
    let cached = Cached::new("not_ours");
    cached.arl2rs(&["run", "a.arl", "--engine", "native"]).is(0, "ran\n");
    cached.0.write("mine/kept.txt", "kept");
    cached.0.write("cache/programs/own/kept.txt", "kept");
    cached.0.write("cache/results/kept.txt", "kept");
    symlink(cached.path("mine"), cached.path("cache/programs/link")).expect("a link");
    let cleaned = cached.arl2rs(&["clean"]);
    assert!(cleaned.out.starts_with("removed 1 program and 1 compiled runtime"), "{}", cleaned.out);
    assert_eq!(cleaned.err, "");
    for file in ["mine/kept.txt", "cache/programs/own/kept.txt", "cache/results/kept.txt"] {
        assert_eq!(cached.0.read(file), "kept");
    }
    let mine = std::fs::read_dir(cached.path("mine")).expect("the folder").count();
    assert_eq!(mine, 1, "nothing is left in a folder that a link leads to");
}
