//! What tells the code of one build from that of another: while this software is developed, its version does not.

use arl_lang::catalog::{Base, Family, all_entries, system_variables, type_names};

/// What says how code is written: operations, tables and their bytes.
const WRITTEN: u64 = {
    let files: [&[u8]; 6] = [
        include_bytes!("bundle.rs"),
        include_bytes!("code.rs"),
        include_bytes!("layout.rs"),
        include_bytes!("numbers.rs"),
        include_bytes!("op.rs"),
        include_bytes!("place.rs"),
    ];
    let (mut hash, mut file) = (0xcbf2_9ce4_8422_2325, 0);
    while file < files.len() {
        hash = hashed(hash, files[file]);
        file += 1;
    }
    hash
};

/// FNV-1a: goes on with a hash. Ends of lines are alike on all systems.
const fn hashed(mut hash: u64, bytes: &[u8]) -> u64 {
    let mut at = 0;
    while at < bytes.len() {
        if bytes[at] != b'\r' {
            hash = (hash ^ bytes[at] as u64).wrapping_mul(0x0100_0000_01b3);
        }
        at += 1;
    }
    hash
}

/// A number that differs where code means something else: its form, and the built-ins, system variables and types that
/// it names by numbers, with the components of structures.
pub(crate) fn format() -> u64 {
    let entries = all_entries().iter();
    let built_ins =
        entries.flat_map(|entry| [entry.path].into_iter().chain(entry.params.iter().map(|param| param.name)));
    let variables = system_variables().map(|variable| variable.name);
    let components = type_names().flat_map(|(name, base)| {
        let own = match base {
            Base::Struct(id) => [Family::SixAxis, Family::Scara].map(|family| id.def(family).components).concat(),
            _ => Vec::new(),
        };
        std::iter::once(name).chain(own.into_iter().map(|component| component.name))
    });
    let names = built_ins.chain(variables).chain(components);
    // The end of a name counts, too.
    names.fold(WRITTEN, |hash, name| hashed(hashed(hash, name.as_bytes()), b"\n"))
}
