//! Clocks and connections.

use arl_code::HandleKind;
use arl_rt::emit::{Clock, Fault, Iodev, MelsecDev, ModbusDev, Socket};

/// A clock or a connection.
pub(crate) enum Handle {
    Clock(Clock),
    Socket(Socket),
    Iodev(Iodev),
    ModbusDev(ModbusDev),
    MelsecDev(MelsecDev),
}

macro_rules! handles {
    ($($name:ident $kind:ident;)*) => {
        impl Handle {
            /// A new one.
            pub(crate) fn new(kind: HandleKind) -> Self {
                match kind {
                    $(HandleKind::$kind => Self::$kind($kind::default()),)*
                }
            }

            $(
                /// The handle as what it is.
                ///
                /// # Errors
                /// It is something else: the code is damaged.
                pub(crate) fn $name(&self) -> Result<&$kind, Fault> {
                    match self {
                        Self::$kind(handle) => Ok(handle),
                        _ => Err(damaged()),
                    }
                }
            )*
        }
    };
}

handles! {
    clock Clock;
    socket Socket;
    iodev Iodev;
    modbus_dev ModbusDev;
    melsec_dev MelsecDev;
}

/// The code refers to something that is not there.
#[cold]
pub(crate) fn damaged() -> Fault {
    Fault::Other { number: 20099, text: "the code of the program is damaged".into() }
}
