//! Writes `src/adapters.rs` and `src/system.rs` from the catalog: `cargo run -p arl-engine --example renew_adapters`.

#[path = "../generate/mod.rs"]
mod generate;

fn main() -> std::io::Result<()> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    std::fs::write(folder.join("adapters.rs"), generate::adapters())?;
    std::fs::write(folder.join("system.rs"), generate::system())
}
