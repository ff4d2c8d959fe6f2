//! Compiles the kernels.

use std::path::{Path, PathBuf};

struct Disk;
impl arl2rs::Sources for Disk {
    fn read(&self, path: &Path) -> Result<Vec<u8>, arl2rs::SourceError> {
        std::fs::read(path).map_err(|_| arl2rs::SourceError::Missing)
    }
}

fn main() {
    let out = PathBuf::from(std::env::var_os("OUT_DIR").unwrap());
    for name in ["sieve", "matrix", "collatz", "crc", "sort", "text", "fixed", "structures", "fib", "queens", "machine"]
    {
        let file = PathBuf::from(format!("kernels/{name}.arl"));
        let checked = arl2rs::check(&file, &Disk, &Default::default());
        for d in &checked.diagnostics {
            println!(
                "cargo::warning={}:{} {} {:?}",
                file.display(),
                checked.files.line(d.primary.at),
                d.message,
                d.help
            );
        }
        if let Some(program) = &checked.program {
            std::fs::write(out.join(format!("{name}.rs")), arl2rs::emit::emit(program, &Default::default())).unwrap();
        }
    }
    println!("cargo::rerun-if-changed=kernels");
}
