//! Clocks and connections.

use arl_code::HandleKind;
use arl_rt::emit::{Clock, Cx, Fault, Iodev, MelsecDev, ModbusDev, Rc, Shown, Socket};
use std::cell::RefCell;
use std::rc::Weak;

/// A clock or a connection.
pub(crate) struct Handle {
    object: Object,
    /// The array that begins here, as a debugger sees it.
    pub(crate) shown: RefCell<Option<Rc<ShownHandles>>>,
}

enum Object {
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
                let object = match kind {
                    $(HandleKind::$kind => Object::$kind($kind::default()),)*
                };
                Self { object, shown: RefCell::default() }
            }

            fn inner(&self) -> &dyn Shown {
                match &self.object {
                    $(Object::$kind(handle) => handle,)*
                }
            }

            $(
                /// The handle as what it is.
                ///
                /// # Errors
                /// It is something else: the code is damaged.
                pub(crate) fn $name(&self) -> Result<&$kind, Fault> {
                    match &self.object {
                        Object::$kind(handle) => Ok(handle),
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

impl Shown for Handle {
    fn type_name(&self) -> String {
        self.inner().type_name()
    }

    fn shown(&self, cx: &Cx) -> String {
        self.inner().shown(cx)
    }
}

/// A variable of clocks or connections as a debugger shows it. It keeps none of them.
pub(crate) struct ShownHandles {
    all: Vec<Weak<Handle>>,
    is_array: bool,
}

impl ShownHandles {
    pub(crate) fn new<'a>(all: impl Iterator<Item = &'a Rc<Handle>>, is_array: bool) -> Self {
        Self { all: all.map(Rc::downgrade).collect(), is_array }
    }

    fn there(&self) -> impl Iterator<Item = Rc<Handle>> + '_ {
        self.all.iter().filter_map(Weak::upgrade)
    }
}

impl Shown for ShownHandles {
    fn type_name(&self) -> String {
        let one = self.there().next().map(|handle| Shown::type_name(&*handle)).unwrap_or_default();
        if self.is_array { format!("{one}[{}]", self.all.len()) } else { one }
    }

    fn shown(&self, cx: &Cx) -> String {
        let all: Vec<String> = self.there().map(|handle| Shown::shown(&*handle, cx)).collect();
        let all = all.join("; ");
        if self.is_array { format!("{{{all}}}") } else { all }
    }
}

/// The code refers to something that is not there.
#[cold]
pub(crate) fn damaged() -> Fault {
    Fault::Other { number: 20099, text: "the code of the program is damaged".into() }
}
