//! Addresses of files in the form of the protocol.

use arl2rs::check::clean;
use gen_lsp_types::Uri;
use std::path::{Path, PathBuf};

const FILE: &str = "file://";

/// The path of a file's address. An address of another kind (a buffer that was never saved) stands for itself.
pub(super) fn path_of(uri: &Uri) -> PathBuf {
    let Some(rest) = uri.0.strip_prefix(FILE) else { return PathBuf::from(&uri.0) };
    // There may be a host between the slashes, which is this machine.
    let path = rest.find('/').and_then(|at| rest.get(at..)).unwrap_or(rest);
    let path = decoded(path);
    let drive = path.strip_prefix('/').filter(|rest| rest.as_bytes().get(1) == Some(&b':'));
    clean(Path::new(drive.unwrap_or(&path)))
}

/// The address of a file.
pub(super) fn uri_of(path: &Path) -> Uri {
    let text = path.to_string_lossy();
    if !path.is_absolute() && text.contains(':') {
        return Uri(text.into_owned());
    }
    let text = text.replace('\\', "/");
    let root = if text.starts_with('/') { "" } else { "/" };
    Uri(format!("{FILE}{root}{}", encoded(&text)))
}

/// The address of a file in the folder of another one, whose address is known.
pub(super) fn beside(uri: &Uri, other: &Path, path: &Path) -> Option<Uri> {
    let (folder, name) = uri.0.rsplit_once('/')?;
    // What follows the name in an address may contain a slash.
    let is_name = other.file_name().is_some_and(|other| decoded(name) == other.to_string_lossy());
    is_name.then_some(Uri(format!("{folder}/{}", encoded(&path.file_name()?.to_string_lossy()))))
}

fn encoded(text: &str) -> String {
    let mut encoded = String::new();
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'-' | b'_' | b'.' | b'~' => {
                encoded.push(char::from(byte))
            }
            _ => encoded.push_str(&format!("%{byte:02X}")),
        }
    }
    encoded
}

/// The text with its `%41` resolved.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, behind)) = rest.split_first() {
        let code = behind.get(..2).filter(|_| *first == b'%');
        let code = code.and_then(|code| std::str::from_utf8(code).ok());
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(code) => {
                bytes.push(code);
                rest = behind.get(2..).unwrap_or_default();
            }
            None => {
                bytes.push(*first);
                rest = behind;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_come_back() {
        for path in ["/home/a b/p\u{e4}ck #1.arl", "/x/100%.arl"] {
            assert_eq!(path_of(&uri_of(Path::new(path))), Path::new(path));
        }
        assert_eq!(path_of(&Uri("file:///c%3A/cell/a.arl".into())), Path::new("c:/cell/a.arl"));
        assert_eq!(path_of(&Uri("file://localhost/a.arl".into())), Path::new("/a.arl"));
    }

    #[test]
    fn buffers_without_a_file_keep_their_address() {
        let uri = Uri("untitled:Untitled-1".into());
        assert_eq!(uri_of(&path_of(&uri)), uri);
    }
}
