//! Explains what keeps cargo from compiling, and what to do about it.

/// Something that is missing in the environment of the compiler.
#[derive(Debug)]
struct KnownProblem {
    /// Messages of cargo, rustup or rustc, any of which indicates the problem.
    signs: &'static [&'static str],
    /// The problem.
    is: &'static str,
    /// The remedy.
    help: &'static str,
}

/// The known problems; the first one that matches is reported.
const KNOWN: [KnownProblem; 6] = [
    KnownProblem {
        signs: &["No space left on device", "os error 28", "os error 112"],
        is: "the disk is full",
        help: "free some space; `arl2rs clean` removes what was compiled",
    },
    KnownProblem {
        signs: &["linker `", "error: linking with"],
        is: "compiling needs a linker, which is missing or does not work",
        help: "install one: `apt install gcc` or `dnf install gcc` on Linux, `xcode-select --install` on macOS, Build Tools for \
               Visual Studio on Windows",
    },
    KnownProblem {
        signs: &["requires rustc", "is not supported by the following package", "feature `edition"],
        is: "the installed Rust is too old",
        help: concat!("arl2rs needs Rust ", env!("CARGO_PKG_RUST_VERSION"), " or newer: `rustup update`"),
    },
    KnownProblem {
        signs: &[
            "rustup could not choose",
            "no default toolchain",
            "is not installed for the toolchain",
            "could not execute process `rustc",
        ],
        is: "Rust is not installed completely",
        help: "`rustup default stable` installs what is missing; see https://www.rust-lang.org/tools/install",
    },
    KnownProblem {
        signs: &[
            "Could not resolve host",
            "Couldn't resolve host",
            "Could not connect",
            "Couldn't connect",
            "failed to download",
            "failed to fetch",
            "failed to get `",
            "nable to update registry",
            "no matching package named",
            "--offline was specified",
            "spurious network error",
        ],
        is: "a package that the runtime needs is missing, and cargo cannot download it",
        help: "the first program needs the network once, for packages from https://crates.io; behind a proxy, set HTTPS_PROXY",
    },
    KnownProblem {
        signs: &["Permission denied", "Read-only file system", "os error 13", "os error 30"],
        is: "a file or folder cannot be written",
        help: "set ARL2RS_CACHE to a folder that can be written",
    },
];

/// The problem and its remedy, followed by the output of cargo; `None` for any other problem.
pub(crate) fn of(output: &str) -> Option<String> {
    let fits = |problem: &&KnownProblem| problem.signs.iter().any(|sign| output.contains(sign));
    let KnownProblem { is, help, .. } = KNOWN.iter().find(fits)?;
    Some(format!("{is}\n{}\nhelp: {help}", output.trim_end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cargo_says() {
        for (output, expected) in [
            ("error: failed to get `nalgebra` as a dependency of package `arl-robot`", "needs the network once"),
            (
                "warning: spurious network error (3 tries remaining): [6] Could not resolve hostname",
                "needs the network once",
            ),
            ("error: linker `cc` not found\n  |\n  = note: No such file or directory (os error 2)", "apt install gcc"),
            (
                "error: rustc 1.80.0 is not supported by the following packages:\n  arl-rt@0.1.0 requires rustc 1.89",
                "rustup update",
            ),
            ("error: rustup could not choose a version of cargo to run", "rustup default stable"),
            ("error: could not write output: No space left on device (os error 28)", "arl2rs clean"),
        ] {
            let explanation = of(output).unwrap_or_default();
            assert!(explanation.contains(expected) && explanation.contains(output), "{output}: {explanation}");
        }
        assert_eq!(of("error[E0308]: mismatched types"), None);
    }
}
