//! Expands an invocation to Rust.

use crate::input::{Form, as_text, attribute};
use crate::leaf::{Leaf, leaves};
use crate::report::{self, Place};
use crate::stub;
use crate::text::Text;
use arl_lang::catalog::{Base, Family, Struct};
use arl2rs::compile::{Bug, check_program, events_use_globals, guard, has_variables, spliced_types};
use arl2rs::diagnostics::{Diagnostic, FileId, Files, Label};
use arl2rs::hir::{Local, LocalId, Program, Type};
use arl2rs::render::{Position, plain_block};
use arl2rs::sources::FileSystem;
use arl2rs::{CheckOptions, Checked, SourceError, Sources, SplicedValue, check_statements, check_text};
use proc_macro::{Literal, Span, TokenTree};
use proc_macro2::{Ident, TokenStream};
use quote::{quote, quote_spanned};
use std::path::{Path, PathBuf};

/// The name of the module made from a program in Rust source.
const MODULE: &str = "program";

/// The name of the function made from statements.
const FRAGMENT: &str = "fragment";
/// The error for statements: variables of the modules that they use belong to the statements and are dropped after they
/// have run.
const GLOBALS_IN_EVENTS: &str = "the condition or the action of an interrupt, timer or trigger uses a global variable of a module; statements in Rust \
    have such variables only as long as they run, but the event goes on\n\
    help: use local variables, or declare the event in a program: arl! { .. } with functions, or arl_file!(\"..\")";

/// Expands `arl!`.
pub(crate) fn arl(input: proc_macro::TokenStream) -> TokenStream {
    match Form::of(input) {
        Form::Program(tokens) => program_in_tokens(&tokens),
        Form::ProgramText(literal) => program_in_literal(&literal),
        Form::Statements { context, statements } => statements_in_tokens(&context.into(), &statements),
        Form::StatementsText { context, text } => statements_in_literal(&context.into(), &text),
    }
}

/// Expands `arl_file!`.
pub(crate) fn arl_file(input: proc_macro::TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = input.into_iter().collect();
    let family = match tokens.as_slice() {
        [_] => Ok(Family::default()),
        [_, TokenTree::Punct(comma), TokenTree::Ident(word)] if comma.as_char() == ',' => family(word),
        _ => Err(usage(Span::call_site())),
    };
    let literal = tokens.first().and_then(as_text).ok_or_else(|| usage(Span::call_site()));
    match (literal, family) {
        (Ok(literal), Ok(family)) => program_in_file(&literal, family),
        (Err(error), _) | (_, Err(error)) => {
            let stub = stub::program();
            quote!(#error #stub)
        }
    }
}

fn usage(span: Span) -> TokenStream {
    report::error("expected arl_file!(\"pick.arl\") or arl_file!(\"pick.arl\", scara)", Place::one(span))
}

fn family(word: &proc_macro::Ident) -> Result<Family, TokenStream> {
    match word.to_string().as_str() {
        "six_axis" => Ok(Family::SixAxis),
        "scara" => Ok(Family::Scara),
        _ => Err(report::error("expected `six_axis` or `scara`", Place::one(word.span()))),
    }
}

/// The Rust file of the invocation.
struct Here {
    /// Its name as shown in messages.
    shown: String,
    /// Its folder, if known.
    folder: Option<PathBuf>,
}

impl Here {
    fn new() -> Self {
        let span = Span::call_site();
        let folder = span.local_file().and_then(|file| file.parent().map(Path::to_path_buf));
        Self { shown: span.file(), folder }
    }

    /// The files with the names that messages show: the text itself is in the Rust file.
    fn files(&self, checked: &Checked) -> Files {
        let mut files = Files::default();
        for (id, file) in checked.files.iter() {
            let name = if id == FileId(0) { self.shown.clone() } else { file.name.clone() };
            files.add(name, file.text.clone());
        }
        files
    }

    /// Makes rustc read the files beside the Rust file again when they change.
    fn watched(&self, checked: &Checked) -> TokenStream {
        let folder = self.folder.iter();
        let read = folder.flat_map(|folder| checked.read.iter().map(|path| folder.join(path)));
        // The Rust file itself is watched anyway.
        watched(read.filter(|path| path.file_name() != Some(self.name().as_os_str())))
    }

    /// The name of the text among the files beside it.
    fn name(&self) -> PathBuf {
        Path::new(&self.shown).file_name().map_or_else(|| PathBuf::from("program.rs"), PathBuf::from)
    }
}

/// The files that ARL text in a Rust file names: they lie beside the Rust file. The text itself has no data file.
struct Beside<'a>(&'a Here);

impl Sources for Beside<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        let data = self.0.name().with_extension("");
        let data = format!("{}_data.arl", data.display());
        match &self.0.folder {
            Some(folder) if path != Path::new(&data) => FileSystem.read(&folder.join(path)),
            _ => Err(SourceError::Missing),
        }
    }
}

/// ARL text that can be mapped back to its tokens.
struct Spanned {
    text: Text,
    leaves: Vec<Leaf<Span>>,
    family: Family,
}

impl Spanned {
    /// `Ok(None)` if the text is not known.
    fn of(tokens: &[TokenTree]) -> Result<Option<Self>, TokenStream> {
        let leaves = leaves(tokens.iter().cloned().collect());
        let call = Span::call_site();
        let source = call.source_text();
        let start = (call.line(), call.column());
        let Some(mut text) = Text::of(&leaves, source.as_deref().map(|source| (source, start))) else {
            return Ok(None);
        };
        let mut robot = Family::default();
        if let Some((count, word)) = attribute(tokens) {
            robot = family(&word)?;
            text.blank(0..count);
        }
        Ok(Some(Self { text, leaves, family: robot }))
    }

    fn place(&self, start: u32, end: u32) -> Place {
        let span = |at: usize| self.leaves.get(at).map_or_else(Span::call_site, |leaf| leaf.span);
        match self.text.leaves(start as usize, end as usize) {
            Some((first, last)) => Place { first: span(first), last: span(last) },
            None => Place::one(Span::call_site()),
        }
    }

    /// All diagnostics, on their tokens.
    fn shown(&self, checked: &Checked, here: &Here) -> TokenStream {
        let show = |diagnostic: &Diagnostic| {
            let at = diagnostic.primary.at;
            if at.file != FileId(0) {
                let text = plain_block(diagnostic, &checked.files);
                return report::shown(diagnostic, &text, Place::one(Span::call_site()));
            }
            let text = report::words(diagnostic, |label| line(label, &checked.files, here));
            report::shown(diagnostic, &text, self.place(at.span.start, at.span.end))
        };
        checked.diagnostics.iter().map(show).collect()
    }
}

/// `src/main.rs:12`
fn line(label: &Label, files: &Files, here: &Here) -> String {
    let name = match label.at.file {
        FileId(0) => here.shown.as_str(),
        file => files.get(file).map_or("?", |file| file.name.as_str()),
    };
    format!("{name}:{}", Position::of(label.at, files).line)
}

fn options(family: Family) -> CheckOptions {
    CheckOptions { family, library: true, ..CheckOptions::default() }
}

fn bug(bug: &Bug) -> TokenStream {
    report::error(&bug.to_string(), Place::one(Span::call_site()))
}

fn program_in_tokens(tokens: &[TokenTree]) -> TokenStream {
    let here = Here::new();
    let spanned = match Spanned::of(tokens) {
        Ok(Some(spanned)) => spanned,
        Ok(None) => return stub::program(),
        Err(error) => return error,
    };
    let checked = guard(|| check_text(&here.name(), &spanned.text.text, &Beside(&here), &options(spanned.family)));
    match checked {
        Ok(mut checked) => {
            let (shown, watched) = (spanned.shown(&checked, &here), here.watched(&checked));
            let items = checked.program.as_mut().map_or_else(stub::program, |program| items(program, &here));
            quote!(#shown #watched #items)
        }
        Err(error) => bug(&error),
    }
}

/// The items of a program whose text is in the Rust file.
fn items(program: &mut Program, here: &Here) -> TokenStream {
    if let Some(module) = program.modules.first_mut() {
        module.name = MODULE.into();
        module.file = here.shown.clone();
    }
    program.name = MODULE.into();
    match guard(|| arl2rs::emit::emit_tokens(program)) {
        Ok(tokens) => tokens,
        Err(error) => bug(&error),
    }
}

/// The text of a string literal, laid out on the lines of the Rust file.
fn literal_text(literal: &Literal) -> Option<String> {
    let tokens: TokenStream = proc_macro::TokenStream::from(TokenTree::Literal(literal.clone())).into();
    let text = syn::parse2::<syn::LitStr>(tokens).ok()?.value();
    let span = literal.span();
    let quotes = literal.to_string().find('"').map_or(0, |at| at + 1);
    Some("\n".repeat(span.line().saturating_sub(1)) + &" ".repeat(span.column().saturating_sub(1) + quotes) + &text)
}

/// The diagnostics of a literal or a file: on the literal, with the position in words.
fn shown_in_words(checked: &Checked, files: &Files, span: Span) -> TokenStream {
    let show = |diagnostic: &Diagnostic| report::shown(diagnostic, &plain_block(diagnostic, files), Place::one(span));
    checked.diagnostics.iter().map(show).collect()
}

fn program_in_literal(literal: &Literal) -> TokenStream {
    let here = Here::new();
    let Some(text) = literal_text(literal) else { return stub::program() };
    match guard(|| check_text(&here.name(), &text, &Beside(&here), &options(Family::default()))) {
        Ok(mut checked) => {
            let shown = shown_in_words(&checked, &here.files(&checked), literal.span());
            let watched = here.watched(&checked);
            let items = checked.program.as_mut().map_or_else(stub::program, |program| items(program, &here));
            quote!(#shown #watched #items)
        }
        Err(error) => bug(&error),
    }
}

fn program_in_file(literal: &Literal, family: Family) -> TokenStream {
    let here = Here::new();
    let tokens: TokenStream = proc_macro::TokenStream::from(TokenTree::Literal(literal.clone())).into();
    let path = syn::parse2::<syn::LitStr>(tokens).map(|text| text.value()).unwrap_or_default();
    let Some(folder) = &here.folder else { return stub::program() };
    let main = folder.join(path);
    let options = CheckOptions { family, ..CheckOptions::default() };
    match check_program(&main, &FileSystem, &options) {
        Ok(compiled) => {
            let shown = shown_in_words(&compiled.checked, &compiled.shown_files(), literal.span());
            let items = compiled.checked.program.as_ref().map(|program| guard(|| arl2rs::emit::emit_tokens(program)));
            let items = match items {
                Some(Ok(tokens)) => tokens,
                Some(Err(error)) => bug(&error),
                None => stub::program(),
            };
            let watched = watched(compiled.read());
            quote!(#shown #watched #items)
        }
        Err(error) => bug(&error),
    }
}

/// Makes rustc read files again when they change.
fn watched(read: impl Iterator<Item = PathBuf>) -> TokenStream {
    let there = read.filter_map(|path| std::path::absolute(path).ok()).filter(|path| path.is_file());
    there
        .map(|path| {
            let path = path.display().to_string();
            quote!(
                const _: &[u8] = ::core::include_bytes!(#path);
            )
        })
        .collect()
}

/// A Rust expression in ARL statements.
type Spliced = TokenStream;

fn statements_in_tokens(context: &TokenStream, tokens: &[TokenTree]) -> TokenStream {
    let here = Here::new();
    let spanned = match Spanned::of(tokens) {
        Ok(Some(spanned)) => spanned,
        Ok(None) if tokens.is_empty() => return statements(context, "", &here, Family::default(), |_| None, |_| None),
        Ok(None) => return stub::statements(context),
        Err(error) => return error,
    };
    let splice = |value: &SplicedValue| {
        let leaves = spanned.text.within(value.rust.start as usize, value.rust.end as usize);
        trees(tokens.iter().cloned().collect(), leaves)
    };
    let shown = |checked: &Checked| Some(spanned.shown(checked, &here));
    statements(context, &spanned.text.text, &here, spanned.family, splice, shown)
}

fn statements_in_literal(context: &TokenStream, literal: &Literal) -> TokenStream {
    let here = Here::new();
    let Some(text) = literal_text(literal) else { return stub::statements(context) };
    let splice = |value: &SplicedValue| {
        let tokens: TokenStream = value.rust.text(&text).parse().ok()?;
        Some(respan(tokens, literal.span().into()))
    };
    let shown = |checked: &Checked| Some(shown_in_words(checked, &here.files(checked), literal.span()));
    statements(context, &text, &here, Family::default(), splice, shown)
}

fn respan(tokens: TokenStream, span: proc_macro2::Span) -> TokenStream {
    tokens
        .into_iter()
        .map(|mut token| {
            if let proc_macro2::TokenTree::Group(group) = &token {
                token = proc_macro2::Group::new(group.delimiter(), respan(group.stream(), span)).into();
            }
            token.set_span(span);
            token
        })
        .collect()
}

/// The token trees whose leaves lie in a range of leaves; `None` if a group would be cut.
fn trees(tokens: proc_macro::TokenStream, wanted: std::ops::Range<usize>) -> Option<TokenStream> {
    let mut found = proc_macro::TokenStream::new();
    let mut at = 0;
    collect(tokens, &wanted, &mut at, &mut found);
    (!found.is_empty()).then(|| found.into())
}

fn collect(
    tokens: proc_macro::TokenStream,
    wanted: &std::ops::Range<usize>,
    at: &mut usize,
    found: &mut proc_macro::TokenStream,
) {
    for token in tokens {
        let count = leaves(token.clone().into()).len();
        if *at >= wanted.start && *at + count <= wanted.end {
            found.extend([token]);
            *at += count;
            continue;
        }
        match token {
            TokenTree::Group(group) => {
                let delimited = usize::from(group.delimiter() != proc_macro::Delimiter::None);
                *at += delimited;
                collect(group.stream(), wanted, at, found);
                *at += delimited;
            }
            _ => *at += count,
        }
    }
}

/// The future made from statements.
fn statements(
    context: &TokenStream,
    text: &str,
    here: &Here,
    family: Family,
    splice: impl Fn(&SplicedValue) -> Option<Spliced>,
    shown: impl Fn(&Checked) -> Option<TokenStream>,
) -> TokenStream {
    let checked = guard(|| check_statements(&here.name(), text, &Beside(here), &options(family)));
    let (mut checked, splices) = match checked {
        Ok(checked) => checked,
        Err(error) => {
            let (error, stub) = (bug(&error), stub::statements(context));
            return quote!({ #error; #stub });
        }
    };
    let messages = shown(&checked).unwrap_or_default();
    let watched = here.watched(&checked);
    let Some(program) = &mut checked.program else {
        let stub = stub::statements(context);
        return quote!({ #messages #watched #stub });
    };
    if events_use_globals(program, FRAGMENT) {
        let (error, stub) =
            (report::error(GLOBALS_IN_EVENTS, Place::one(Span::call_site())), stub::statements(context));
        return quote!({ #messages #watched #error; #stub });
    }
    let types = spliced_types(program, splices.len());
    let names: Vec<Ident> = (0..splices.len()).map(splice_name).collect();
    let values = splices.iter().zip(&types).map(|(value, ty)| match ty {
        Some(_) => converted(splice(value)),
        None => splice(value).unwrap_or_default(),
    });
    let values: Vec<TokenStream> = values.collect();
    let Some((call, items)) = function(program, here, &types) else { return stub::statements(context) };
    quote! {
        {
            #messages
            #watched
            mod arl_statements {
                #items
            }
            let _cx: &::arl_rt::Cx = #context;
            #(let #names = #values;)*
            async move {
                #call
                ::core::result::Result::Ok::<(), ::arl_rt::emit::Stop>(())
            }
        }
    }
}

fn splice_name(number: usize) -> Ident {
    Ident::new(&format!("splice_{number}"), proc_macro2::Span::call_site())
}

/// The value converted to the type that its place requires; errors show at the value.
fn converted(value: Option<Spliced>) -> TokenStream {
    let value = value.unwrap_or_else(|| report::error("expected a Rust value", Place::one(Span::call_site())));
    let span = value.clone().into_iter().next().map_or_else(proc_macro2::Span::call_site, |token| token.span());
    quote_spanned!(span=> ::core::convert::Into::into(#value))
}

/// Adds a parameter for each spliced value to the function of the statements; returns its call and its items.
fn function(program: &mut Program, here: &Here, types: &[Option<Type>]) -> Option<(TokenStream, TokenStream)> {
    let func = program.funcs.iter_mut().find(|func| func.name == FRAGMENT)?;
    let mut names = Vec::new();
    for (at, ty) in types.iter().enumerate().filter_map(|(at, ty)| Some((at, (*ty)?))) {
        let id = LocalId(func.locals.len() as u32);
        let (name, span) = (splice_name(at).to_string(), func.span);
        func.locals.push(Local {
            name,
            ty,
            constant: false,
            value: None,
            mutated: false,
            read: true,
            shared: false,
            span,
        });
        func.params.push(id);
        names.push(splice_name(at));
    }
    let effects = func.effects;
    let items = spliced_in(items(program, here), types);
    let cx = effects.context.then(|| quote!(_cx,));
    let variables = has_variables(program).then(|| {
        quote! {
            let globals = arl_statements::Globals::new();
            globals.init(_cx).await?;
        }
    });
    let g = effects.globals.then(|| quote!(&globals,));
    let wait = effects.waits.then(|| quote!(.await));
    let fail = effects.fails.then(|| quote!(?));
    let module = Ident::new(MODULE, proc_macro2::Span::call_site());
    Some((quote!(#variables arl_statements::#module::fragment(#cx #g #(#names),*) #wait #fail;), items))
}

/// The emitter knows the parameters only by name: it considers them unused, and each use the last one. A value that is
/// not `Copy` is cloned where it is used, since a loop may use it again.
fn spliced_in(items: TokenStream, types: &[Option<Type>]) -> TokenStream {
    let mut out = TokenStream::new();
    for token in items {
        match token {
            proc_macro2::TokenTree::Group(group) => {
                let mut inner = proc_macro2::Group::new(group.delimiter(), spliced_in(group.stream(), types));
                inner.set_span(group.span());
                out.extend([proc_macro2::TokenTree::Group(inner)]);
            }
            proc_macro2::TokenTree::Ident(ident) => {
                let name = ident.to_string();
                let number =
                    name.trim_start_matches('_').strip_prefix("splice_").and_then(|number| number.parse().ok());
                let ty = number.and_then(|number: usize| Some((splice_name(number), (*types.get(number)?)?)));
                match ty {
                    Some((parameter, _)) if name.starts_with('_') => out.extend(quote!(#parameter)),
                    Some((value, ty)) if !is_copy(ty) => out.extend(quote!(#value.clone())),
                    Some((value, _)) => out.extend(quote!(#value)),
                    None => out.extend([proc_macro2::TokenTree::Ident(ident)]),
                }
            }
            other => out.extend([other]),
        }
    }
    out
}

fn is_copy(ty: Type) -> bool {
    !ty.is_array() && !matches!(ty.base, Base::String | Base::Struct(Struct::Wobj))
}
