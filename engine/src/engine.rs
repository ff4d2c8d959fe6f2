//! The program that the controller runs.

use crate::frame::State;
use crate::handles::{Handle, ShownHandles};
use crate::intern::{intern, intern_sizes};
use crate::teach::{Variable, constant};
use arl_code::{Code, Space, ValueType, start_words};
use arl_rt::emit::{Beside, BoxFuture, Cell, Cx, DataFile, DataVar, Family, File, Rc, ShownHandle, Str, Teach};
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

/// A program that is run from its code.
pub struct Engine {
    pub(crate) code: Arc<Code>,
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
    named_handles: Vec<NamedHandle>,
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

/// The sizes of an array of several dimensions.
pub(crate) fn shown_sizes(ty: &ValueType) -> &'static [usize] {
    match &*ty.sizes {
        sizes @ [_, _, ..] => intern_sizes(sizes),
        _ => &[],
    }
}

/// A global clock or connection by its name.
struct NamedHandle {
    name: &'static str,
    file: &'static str,
    sizes: &'static [usize],
    slot: ShownHandles,
}

/// The words of all global variables before their first values.
fn start_values(code: &Code) -> Rc<[Cell<u64>]> {
    let mut words = vec![0; code.globals.words as usize];
    for variable in code.variables.iter().filter(|variable| variable.place.space == Space::Global) {
        let mut one = Vec::new();
        start_words(variable.ty.base, code.family, &mut one);
        let own = words.iter_mut().skip(variable.place.word as usize).take(one.len() * variable.ty.count());
        own.zip(one.iter().cycle()).for_each(|(word, start)| *word = *start);
    }
    words.into_iter().map(Cell::new).collect()
}

/// A variable, if it is a clock or a connection.
fn named_handle(variable: &arl_code::Variable, code: &Code, handles: &[Rc<Handle>]) -> Option<NamedHandle> {
    let is_handle = matches!(variable.ty.base, arl_lang::catalog::Base::Handle(_));
    let own = handles.iter().skip(variable.place.handle as usize).take(variable.ty.count());
    let file = code.files.get(usize::from(variable.file))?;
    is_handle.then(|| NamedHandle {
        name: intern(&variable.name),
        file: intern(file),
        sizes: shown_sizes(&variable.ty),
        slot: ShownHandles::new(own, variable.ty.is_array()),
    })
}

impl Engine {
    /// A program that is ready to run; several of one code share it.
    pub fn new(code: impl Into<Arc<Code>>) -> Self {
        let code: Arc<Code> = code.into();
        let words = start_values(&code);
        let texts: Rc<[RefCell<Str>]> = (0..code.globals.texts).map(|_| RefCell::default()).collect();
        let variables = code.variables.iter().filter_map(|variable| {
            let slot: Box<dyn Teach> = match (&variable.value, variable.place.space) {
                (Some(value), _) => constant(value, &variable.ty, code.family),
                (None, Space::Global) if !matches!(variable.ty.base, arl_lang::catalog::Base::Handle(_)) => {
                    Box::new(Variable {
                        words: Rc::clone(&words),
                        texts: Rc::clone(&texts),
                        place: variable.place,
                        ty: variable.ty.clone(),
                        family: code.family,
                    })
                }
                _ => return None,
            };
            let sizes = shown_sizes(&variable.ty);
            let (name, teachable) = (intern(&variable.name), variable.teachable);
            Some(Named { name, file: variable.file, sizes, slot, teachable })
        });
        let handles: Vec<Rc<Handle>> = code.handles.iter().map(|kind| Rc::new(Handle::new(*kind))).collect();
        Self {
            files: code.files.iter().map(|name| File::new(intern(name))).collect(),
            named_handles: code
                .variables
                .iter()
                .filter_map(|variable| named_handle(variable, &code, &handles))
                .collect(),
            handles,
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
    pub(crate) fn give_back(&self, mut state: State) {
        state.end();
        self.states.borrow_mut().push(state);
    }

    /// The variables of each file that `wanted` holds for; files without any are left out unless they have others.
    fn files_of(&self, wanted: impl Fn(&Named) -> bool, has_others: impl Fn(&str) -> bool) -> Vec<DataFile<'_>> {
        let mut files: Vec<DataFile<'_>> = Vec::new();
        for (number, file) in self.files.iter().enumerate() {
            let own = self.variables.iter().filter(|named| usize::from(named.file) == number && wanted(named));
            let vars: Vec<DataVar<'_>> =
                own.map(|named| DataVar { name: named.name, sizes: named.sizes, slot: &*named.slot }).collect();
            if !vars.is_empty() || has_others(file.name()) {
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
        self.files_of(|named| named.teachable, |_| false)
    }

    fn variables(&self) -> Vec<DataFile<'_>> {
        self.files_of(|_| true, |file| self.named_handles.iter().any(|handle| handle.file == file))
    }

    fn handles(&self) -> Vec<ShownHandle<'_>> {
        let shown = self.named_handles.iter().map(|NamedHandle { name, file, sizes, slot }| ShownHandle {
            file,
            name,
            sizes,
            slot,
        });
        shown.collect()
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
