//! Serial lines of the computer: their settings, and how they are opened.

use std::fmt;
use std::io;

use crate::values::{Parity, Stopbits};

/// A serial line and the format of its characters. There is no flow control.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct LineSettings {
    /// The path of the device.
    pub(crate) device: String,
    /// Bits per second.
    pub(crate) baud: u32,
    /// Bits per character, 5 to 8.
    pub(crate) bits: u8,
    pub(crate) stop: Stopbits,
    pub(crate) parity: Parity,
}

impl fmt::Display for LineSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.device)
    }
}

#[cfg(all(unix, feature = "serial"))]
mod tty {
    use std::fs::{File, TryLockError};
    use std::io::{self, ErrorKind, Read, Write};
    use std::os::fd::{AsFd, AsRawFd};

    use mio::unix::SourceFd;
    use mio::{Interest, Poll};
    use rustix::fs::{Mode, OFlags};
    use rustix::termios::{self, ControlModes, OptionalActions, QueueSelector, Termios};

    use super::LineSettings;
    use crate::communication::stream::{PolledStream, STREAM};
    use crate::values::{Parity, Stopbits};

    /// An open serial line that reports when it is ready instead of waiting.
    #[derive(Debug)]
    pub(crate) struct Line(File);

    impl LineSettings {
        /// Opens the line for this process alone, and discards what it still held.
        ///
        /// # Errors
        /// There is no such device, it is not a serial line, another program has it open, or it does not support these
        /// settings.
        pub(crate) fn open(&self) -> io::Result<Line> {
            let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
            let file = File::from(rustix::fs::open(self.device.as_str(), flags, Mode::empty())?);
            let mut settings = termios::tcgetattr(&file)?;
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => {
                    return Err(io::Error::new(ErrorKind::ResourceBusy, "another program has it open"));
                }
                Err(TryLockError::Error(error)) => return Err(error),
                Ok(()) => {}
            }
            termios::ioctl_tiocexcl(&file)?;
            settings.make_raw();
            self.put_into(&mut settings)?;
            // At once, after discarding what waits: output that a line does not take would be waited for, without end.
            termios::tcflush(&file, QueueSelector::IOFlush)?;
            termios::tcsetattr(&file, OptionalActions::Now, &settings)?;
            // A device silently ignores settings that it does not support. A pseudo terminal has neither bits nor
            // parity.
            let set = termios::tcgetattr(&file)?;
            if set.input_speed() != self.baud {
                let text = format!("it does not support {} bit/s", self.baud);
                return Err(io::Error::new(ErrorKind::Unsupported, text));
            }
            termios::tcflush(&file, QueueSelector::IOFlush)?;
            Ok(Line(file))
        }

        fn put_into(&self, settings: &mut Termios) -> io::Result<()> {
            let bits = match self.bits {
                5 => ControlModes::CS5,
                6 => ControlModes::CS6,
                7 => ControlModes::CS7,
                _ => ControlModes::CS8,
            };
            let modes = &mut settings.control_modes;
            modes.remove(ControlModes::CSIZE | ControlModes::CSTOPB | ControlModes::PARENB | ControlModes::PARODD);
            modes.remove(ControlModes::CRTSCTS);
            modes.insert(bits | ControlModes::CREAD | ControlModes::CLOCAL);
            modes.set(ControlModes::CSTOPB, self.stop == Stopbits::Two);
            modes.set(ControlModes::PARENB, self.parity != Parity::None);
            modes.set(ControlModes::PARODD, self.parity == Parity::Odd);
            Ok(settings.set_speed(self.baud)?)
        }
    }

    impl Line {
        /// Registers the line with the poll, which then reports when it is ready.
        pub(crate) fn register(self, poll: &Poll) -> io::Result<Self> {
            let descriptor = self.0.as_fd().as_raw_fd();
            poll.registry().register(&mut SourceFd(&descriptor), STREAM, Interest::READABLE | Interest::WRITABLE)?;
            Ok(self)
        }
    }

    impl Read for Line {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.0.read(buffer)
        }
    }

    impl Write for Line {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            self.0.flush()
        }
    }

    impl PolledStream for Line {
        /// The system sends the bytes that it has taken, also after the line is closed.
        fn finish(&mut self) -> bool {
            false
        }
    }
}

/// Opens a line for the thread of a connection.
#[cfg(all(unix, feature = "serial"))]
pub(super) fn open(poll: &mio::Poll, settings: &LineSettings) -> io::Result<Option<tty::Line>> {
    settings.open()?.register(poll).map(Some)
}

/// Serial lines are not supported here.
#[cfg(not(all(unix, feature = "serial")))]
pub(super) fn open(_: &mio::Poll, _: &LineSettings) -> io::Result<Option<mio::net::TcpStream>> {
    let text = if cfg!(unix) {
        "arl-rt was built without its feature `serial`"
    } else {
        "serial lines are not supported on this system yet"
    };
    Err(io::Error::new(io::ErrorKind::Unsupported, text))
}
