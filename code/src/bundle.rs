//! Programs as bytes: what one process makes, and another one runs.

use crate::code::Code;
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
        // Writing to memory does not fail.
        let content = postcard::to_stdvec(self).unwrap_or_default();
        bytes.extend(XxHash3_64::oneshot(&content).to_le_bytes());
        bytes.extend(content);
        bytes
    }

    /// The bundle that was written as these bytes.
    ///
    /// # Errors
    /// The bytes are something else, of another version, cut off or altered.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, BundleError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(BundleError::NotCode)?;
        let (length, rest) = rest.split_first().ok_or(BundleError::Damaged)?;
        let (version, rest) = rest.split_at_checked(usize::from(*length)).ok_or(BundleError::Damaged)?;
        if version != VERSION.as_bytes() {
            return Err(BundleError::OtherVersion(String::from_utf8_lossy(version).into_owned()));
        }
        let (hash, content) = rest.split_first_chunk().ok_or(BundleError::Damaged)?;
        if XxHash3_64::oneshot(content) != u64::from_le_bytes(*hash) {
            return Err(BundleError::Damaged);
        }
        postcard::from_bytes(content).map_err(|_| BundleError::Damaged)
    }
}
