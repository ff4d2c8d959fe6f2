//! Programs as bytes: what one process makes, and another one runs.

use crate::code::Code;
use crate::format::format;
use crate::verify::is_sound;
use serde::{Deserialize, Serialize};
use std::fmt;
use twox_hash::XxHash3_64;

/// A program and those that its cell names.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Bundle {
    /// The folder of the main file, where data files are looked for.
    pub folder: String,
    /// The first program.
    pub main: Code,
    /// The other programs.
    pub others: Vec<BundledProgram>,
}

/// A program in addition to the first one.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct BundledProgram {
    /// Its file, by the name in the cell file.
    pub file: String,
    /// The folder of its data files, relative to that of the first one.
    pub folder: String,
    /// The program.
    pub code: Code,
}

/// The first bytes of a bundle.
const MAGIC: &[u8; 8] = b"ARLCODE\n";
/// The version of the bytes: of another one nothing is read.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Why bytes are no bundle.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum BundleError {
    /// They are something else.
    NotCode,
    /// Another version of this software wrote them.
    OtherVersion(String),
    /// Another build of the same version wrote them, which may mean something else by them.
    OtherBuild,
    /// They are cut off or altered.
    Damaged,
}

impl fmt::Display for BundleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotCode => write!(f, "this is not the code of a program"),
            Self::OtherVersion(version) => {
                write!(f, "arl2rs {version} wrote this code, and this is arl2rs {VERSION}: make it again")
            }
            Self::OtherBuild => write!(f, "another build of arl2rs {VERSION} wrote this code: make it again"),
            Self::Damaged => write!(f, "this code is damaged: make it again"),
        }
    }
}

impl std::error::Error for BundleError {}

impl Bundle {
    /// The bundle as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.push(VERSION.len() as u8);
        bytes.extend(VERSION.as_bytes());
        bytes.extend(format().to_le_bytes());
        // Writing to memory does not fail.
        let content = postcard::to_stdvec(self).unwrap_or_default();
        bytes.extend(XxHash3_64::oneshot(&content).to_le_bytes());
        bytes.extend(content);
        bytes
    }

    /// The bundle that was written as these bytes.
    ///
    /// # Errors
    /// The bytes are something else, of another version or build, cut off or altered.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BundleError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(BundleError::NotCode)?;
        let (length, rest) = rest.split_first().ok_or(BundleError::Damaged)?;
        let (version, rest) = rest.split_at_checked(usize::from(*length)).ok_or(BundleError::Damaged)?;
        if version != VERSION.as_bytes() {
            return Err(BundleError::OtherVersion(String::from_utf8_lossy(version).into_owned()));
        }
        let (own, rest) = rest.split_first_chunk().ok_or(BundleError::Damaged)?;
        if u64::from_le_bytes(*own) != format() {
            return Err(BundleError::OtherBuild);
        }
        let (hash, content) = rest.split_first_chunk().ok_or(BundleError::Damaged)?;
        if XxHash3_64::oneshot(content) != u64::from_le_bytes(*hash) {
            return Err(BundleError::Damaged);
        }
        let bundle: Self = postcard::from_bytes(content).map_err(|_| BundleError::Damaged)?;
        let is_whole = is_sound(&bundle.main) && bundle.others.iter().all(|other| is_sound(&other.code));
        if is_whole { Ok(bundle) } else { Err(BundleError::Damaged) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Extent;
    use crate::{Function, Op};
    use arl_lang::catalog::Family;

    fn bundle(ops: Vec<Op>) -> Bundle {
        let main = Function { name: "main".into(), file: 0, start: 0, frame: Extent::default(), boxes: 0 };
        let code = Code {
            family: Family::Scara,
            files: vec!["a.arl".into()],
            ops,
            functions: vec![main],
            main: 0,
            first_values: Vec::new(),
            calls: Vec::new(),
            sites: Vec::new(),
            events: Vec::new(),
            transfers: Vec::new(),
            boxes: Vec::new(),
            entries: Vec::new(),
            types: Vec::new(),
            words: vec![1.5_f64.to_bits()],
            texts: vec!["text".into()],
            globals: Extent::default(),
            handles: Vec::new(),
            variables: Vec::new(),
            watched: false,
            locals: Vec::new(),
            connects: false,
            serves_modbus: false,
        };
        Bundle { folder: "/robot".into(), main: code, others: Vec::new() }
    }

    #[test]
    fn a_bundle_is_read_as_it_was_written() {
        let bundle = bundle(vec![Op::Word { to: 3, at: 0 }, Op::Return]);
        assert_eq!(Bundle::from_bytes(&bundle.to_bytes()), Ok(bundle));
    }

    #[test]
    fn bytes_that_are_cut_off_or_altered_are_refused() {
        let bytes = bundle(vec![Op::Word { to: 3, at: 0 }, Op::Return]).to_bytes();
        for length in 0..bytes.len() {
            assert!(Bundle::from_bytes(&bytes[..length]).is_err(), "{length} bytes");
        }
        for at in 0..bytes.len() {
            let mut altered = bytes.clone();
            altered[at] ^= 4;
            assert!(Bundle::from_bytes(&altered).is_err(), "byte {at}");
        }
    }

    #[test]
    fn bytes_of_another_version_say_which() {
        let mut bytes = bundle(vec![Op::Return]).to_bytes();
        bytes[MAGIC.len() + 1] = b'9';
        let error = Bundle::from_bytes(&bytes).unwrap_err();
        assert_eq!(error, BundleError::OtherVersion(format!("9{}", &VERSION[1..])));
        assert_eq!(Bundle::from_bytes(b"func void main()"), Err(BundleError::NotCode));
    }

    #[test]
    fn bytes_of_another_build_are_refused() {
        let mut bytes = bundle(vec![Op::Return]).to_bytes();
        bytes[MAGIC.len() + 1 + VERSION.len()] ^= 1;
        assert_eq!(Bundle::from_bytes(&bytes), Err(BundleError::OtherBuild));
    }

    #[test]
    fn numbers_beyond_the_tables_are_refused() {
        let refused = [
            Op::Word { to: 0, at: 1 },
            Op::Jump { to: 2 },
            Op::Load { to: 0, at: 0 },
            Op::CopyConstants { to: 0, from: 0, count: 1 },
            Op::LoadGlobal { to: 0, at: 0 },
            Op::Text { to: 0, at: 0 },
            Op::Call { call: 0 },
            Op::BuiltIn { site: 0 },
            Op::DivSmall { to: 0, left: 0, value: 0 },
        ];
        for op in refused {
            let bytes = bundle(vec![op, Op::Return]).to_bytes();
            assert_eq!(Bundle::from_bytes(&bytes), Err(BundleError::Damaged), "{op:?}");
        }
    }
}
