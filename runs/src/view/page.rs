//! The files of the page, as they are served.

/// A file: its path, its type and its bytes.
type File = (&'static str, &'static str, &'static [u8]);

const SCRIPT: &str = "text/javascript; charset=utf-8";

macro_rules! page {
    ($($path:literal: $kind:expr),* $(,)?) => {
        &[$(($path, $kind, include_bytes!(concat!("../../page/", $path)))),*]
    };
}

/// All files. A test ensures that no script requests another one.
const FILES: &[File] = page! {
    "index.html": "text/html; charset=utf-8",
    "page.css": "text/css; charset=utf-8",
    "three.js": SCRIPT,
    "main.js": SCRIPT,
    "run.js": SCRIPT,
    "samples.js": SCRIPT,
    "scene.js": SCRIPT,
    "robot.js": SCRIPT,
    "path.js": SCRIPT,
    "tracks.js": SCRIPT,
    "rows.js": SCRIPT,
    "source.js": SCRIPT,
    "teach.js": SCRIPT,
    "teach/dragged_robot.js": SCRIPT,
    "teach/edits.js": SCRIPT,
    "teach/jog.js": SCRIPT,
    "teach/point_list.js": SCRIPT,
    "teach/point_marks.js": SCRIPT,
    "teach/pose_form.js": SCRIPT,
    "teach/reach_map.js": SCRIPT,
    "teach/server.js": SCRIPT,
    "panels.js": SCRIPT,
    "colors.js": SCRIPT,
    "live.js": SCRIPT,
    "dom.js": SCRIPT,
};

/// The file at a path of the server.
pub(super) fn file(path: &str) -> Option<(&'static str, &'static [u8])> {
    let name = path.strip_prefix('/')?;
    let name = if name.is_empty() { "index.html" } else { name };
    FILES.iter().find(|(known, _, _)| *known == name).map(|(_, kind, bytes)| (*kind, *bytes))
}

/// How many files there are.
#[cfg(test)]
pub(super) fn count() -> usize {
    FILES.len()
}
