//! Any text is a program or gets diagnostics; what is accepted becomes Rust that can be read.
#![no_main]

use std::path::Path;

use arl2rs::compile::compile_program;
use arl2rs::emit::EmitOptions;
use arl2rs::{CheckOptions, SourceError, Sources};
use libfuzzer_sys::fuzz_target;

struct Main<'a>(&'a [u8]);

impl Sources for Main<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        if path == Path::new("main.arl") { Ok(self.0.to_vec()) } else { Err(SourceError::Missing) }
    }
}

fuzz_target!(|text: &[u8]| {
    let compiled = compile_program(Path::new("main.arl"), &Main(text), &CheckOptions::default(), &EmitOptions::default());
    let Ok(compiled) = compiled else { panic!("the compiler panicked") };
    assert_eq!(compiled.rust.is_none(), compiled.errors().next().is_some());
    if let Some(rust) = compiled.rust {
        assert!(!rust.contains("compile_error!"), "{rust}");
    }
});
