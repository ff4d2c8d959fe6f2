//! Pseudo terminals: serial lines that can be unplugged.

use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

use crate::watch::soon;

/// A name of a serial line that stays while what is plugged in there changes.
pub(crate) struct Outlet(PathBuf);

impl Outlet {
    pub(crate) fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("line-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        Self(std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name))
    }

    /// The name as the text of a program.
    pub(crate) fn name(&self) -> arl_rt::emit::Str {
        self.0.to_str().unwrap().into()
    }

    /// Plugs in a new line: its other end.
    pub(crate) fn plug(&self) -> Plug {
        let end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
        grantpt(&end).unwrap();
        unlockpt(&end).unwrap();
        let path = ptsname(&end, Vec::new()).unwrap();
        let _ = std::fs::remove_file(&self.0);
        std::os::unix::fs::symlink(path.to_str().unwrap(), &self.0).unwrap();
        rustix::io::ioctl_fionbio(&end, true).unwrap();
        Plug(File::from(end))
    }
}

impl Drop for Outlet {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

/// The other end of a line, which is unplugged when it is dropped.
pub(crate) struct Plug(File);

/// How long a line may take no more: the program does not read it.
const FULL: Duration = Duration::from_millis(300);

impl Plug {
    /// Waits until somebody has this end open and sends something.
    pub(crate) fn hears(&mut self) -> Vec<u8> {
        let mut piece = [0; 4096];
        soon("nobody sends", || self.0.read(&mut piece).ok().map(|count| piece[..count].to_vec()))
    }
}

impl Plug {
    /// What has come by now.
    pub(crate) fn comes(&mut self) -> Vec<u8> {
        let (mut all, mut piece) = (Vec::new(), [0; 4096]);
        while let Ok(count @ 1..) = self.0.read(&mut piece) {
            all.extend_from_slice(&piece[..count]);
        }
        all
    }
}

impl Read for Plug {
    /// Waits until something comes; nothing when the other end was closed.
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        soon("nothing comes", || match self.0.read(buffer) {
            Err(error) if error.kind() == ErrorKind::WouldBlock => None,
            Err(_) => Some(Ok(0)),
            result => Some(result),
        })
    }
}

impl Write for Plug {
    /// Waits until there is room, but not for ever: nobody tells that the other end was closed.
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let start = Instant::now();
        loop {
            match self.0.write(bytes) {
                Err(error) if error.kind() == ErrorKind::WouldBlock && start.elapsed() < FULL => {
                    std::thread::sleep(Duration::from_micros(200));
                }
                result => return result,
            }
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.0.flush()
    }
}
