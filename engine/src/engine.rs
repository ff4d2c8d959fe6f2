//! The program that the controller runs.

use crate::frame::State;
use crate::handles::Handle;
use crate::intern::intern;
use crate::teach::{Global, constant};
use arl_code::{Code, Space};
use arl_rt::emit::{Beside, BoxFuture, Cell, Cx, DataFile, DataVar, Family, File, Rc, Str, Teach};
use std::cell::RefCell;
use std::fmt;

/// A program that is run from its code.
pub struct Engine {
    pub(crate) code: Code,
    /// The files.
    pub(crate) files: Vec<File>,
    /// The words of the global variables.
    pub(crate) words: Rc<[Cell<u64>]>,
    /// The strings of the global variables.
    pub(crate) texts: Rc<[RefCell<Str>]>,
    /// The global clocks and connections.
    pub(crate) handles: Vec<Rc<Handle>>,
    /// The constant strings.
    pub(crate) constants: Vec<Str>,
    variables: Vec<Named>,
    /// States that are not in use: the condition of an event takes one in each cycle.
    states: RefCell<Vec<State>>,
}

/// A global variable by its name.
struct Named {
    name: &'static str,
    file: u16,
    /// The sizes of an array of several dimensions.
    sizes: &'static [usize],
    slot: Box<dyn Teach>,
    teachable: bool,
}

impl Engine {
    /// A program that is ready to run.
    pub fn new(code: Code) -> Self {
        let words: Rc<[Cell<u64>]> = (0..code.globals.words).map(|_| Cell::new(0)).collect();
        let texts: Rc<[RefCell<Str>]> = (0..code.globals.texts).map(|_| RefCell::default()).collect();
        let variables = code.variables.iter().filter_map(|variable| {
            let slot: Box<dyn Teach> = match (&variable.value, variable.place.space) {
                (Some(value), _) => constant(value, &variable.ty, code.family),
                (None, Space::Global) if !matches!(variable.ty.base, arl_lang::catalog::Base::Handle(_)) => {
                    Box::new(Global {
                        words: Rc::clone(&words),
                        texts: Rc::clone(&texts),
                        place: variable.place,
                        ty: variable.ty.clone(),
                        family: code.family,
                    })
                }
                _ => return None,
            };
            let sizes: &'static [usize] = match &*variable.ty.sizes {
                sizes @ [_, _, ..] => sizes.to_vec().leak(),
                _ => &[],
            };
            let (name, teachable) = (intern(&variable.name), variable.teachable);
            Some(Named { name, file: variable.file, sizes, slot, teachable })
        });
        Self {
            files: code.files.iter().map(|name| File::new(intern(name))).collect(),
            handles: code.handles.iter().map(|kind| Rc::new(Handle::new(*kind))).collect(),
            constants: code.texts.iter().map(|text| Str::literal(intern(text))).collect(),
            variables: variables.collect(),
            states: RefCell::default(),
            words,
            texts,
            code,
        }
    }

    /// The file of a function.
    pub(crate) fn file_of(&self, function: usize) -> File {
        let file = self.code.functions.get(function).map_or(0, |function| usize::from(function.file));
        self.files.get(file).or(self.files.first()).copied().unwrap_or(File::new(""))
    }

    /// A state that is not in use.
    pub(crate) fn take_state(&self) -> State {
        self.states.borrow_mut().pop().unwrap_or_default()
    }

    /// Gives back a state.
    pub(crate) fn give_back(&self, state: State) {
        self.states.borrow_mut().push(state);
    }

    /// The variables of each file that `wanted` holds for.
    fn files_of(&self, wanted: impl Fn(&Named) -> bool) -> Vec<DataFile<'_>> {
        let mut files: Vec<DataFile<'_>> = Vec::new();
        for (number, file) in self.files.iter().enumerate() {
            let own = self.variables.iter().filter(|named| usize::from(named.file) == number && wanted(named));
            let vars: Vec<DataVar<'_>> =
                own.map(|named| DataVar { name: named.name, sizes: named.sizes, slot: &*named.slot }).collect();
            if !vars.is_empty() {
                files.push(DataFile { file: file.name(), vars });
            }
        }
        files
    }
}

impl arl_rt::Program for Engine {
    fn file(&self) -> File {
        self.files.first().copied().unwrap_or(File::new(""))
    }

    fn family(&self) -> Family {
        match self.code.family {
            arl_lang::catalog::Family::SixAxis => Family::SixAxis,
            arl_lang::catalog::Family::Scara => Family::Scara,
        }
    }

    fn init<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            for function in &self.code.first_values {
                self.run_function(cx, *function as usize).await?;
            }
            Ok(())
        })
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(self.run_function(cx, self.code.main as usize))
    }

    fn data(&self) -> Vec<DataFile<'_>> {
        self.files_of(|named| named.teachable)
    }

    fn variables(&self) -> Vec<DataFile<'_>> {
        self.files_of(|_| true)
    }

    fn beside(&self) -> Beside {
        Beside { connections: self.code.connects, modbus_tcp: self.code.serves_modbus }
    }
}

impl fmt::Debug for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Engine").field("files", &self.code.files).finish_non_exhaustive()
    }
}
