//! Frames, scopes, variables and expressions of a halted program.

use super::seen::{ReportedVariable, Seen, reported, variable};
use super::{Answer, Session};
use crate::dap::evaluate::{Input, NamedPlace, Root, Source, Value as Found, Variable, evaluate, part_type, place};
use crate::dap::literal::{Literal, Part};
use crate::dap::program::{Key, constants};
use crate::dap::variables::{Container, Frame, Target};
use serde_json::{Value, json};

impl Session {
    pub(super) fn top_frame(&mut self, channel: usize) -> Result<Option<Frame>, String> {
        Ok(self.frames(channel)?.into_iter().next())
    }

    /// The frames of a channel, the one that was entered last first.
    pub(super) fn frames(&mut self, channel: usize) -> Result<Vec<Frame>, String> {
        let answer = self.ask("stack", &[&channel.to_string()])?;
        let frames = answer.get("frames").and_then(Value::as_array).cloned().unwrap_or_default();
        let text = |value: &Value, key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let number = |value: &Value, key: &str| value.get(key).and_then(Value::as_u64).unwrap_or_default();
        let program = Key::of(&answer);
        let frame = |value: &Value| Frame {
            channel,
            program: program.clone(),
            id: number(value, "id"),
            name: text(value, "name"),
            file: text(value, "file"),
            line: number(value, "line") as u32,
            is_action: value.get("event").and_then(Value::as_bool).unwrap_or_default(),
        };
        Ok(frames.iter().map(frame).collect())
    }

    /// The channel of the thread that a request is about; the first one if it names none.
    pub(super) fn channel_of(&self, arguments: &Value) -> Result<usize, String> {
        let thread = arguments.get("threadId").and_then(Value::as_u64).unwrap_or(1);
        let channel = usize::try_from(thread).ok().and_then(|thread| thread.checked_sub(1));
        let channel = channel.filter(|channel| *channel < self.channels.len().max(1));
        channel.ok_or_else(|| format!("there is no thread {thread}"))
    }

    pub(super) fn stack_trace(&mut self, arguments: &Value) -> Answer {
        let channel = self.channel_of(arguments)?;
        let frames = self.frames(channel)?;
        let (first, all) = (arguments.get("startFrame").and_then(Value::as_u64).unwrap_or(0) as usize, frames.len());
        let levels = arguments.get("levels").and_then(Value::as_u64).filter(|levels| *levels > 0);
        let mut shown = Vec::new();
        for frame in frames.into_iter().skip(first).take(levels.map_or(usize::MAX, |levels| levels as usize)) {
            let launched = self.launched.as_ref();
            let path = launched.and_then(|launched| launched.programs.path(&frame.program, &frame.file));
            let (name, file, line) = (frame.name.clone(), frame.file.clone(), frame.line);
            let id = self.shown.frame(frame);
            shown.push(json!({
                "id": id, "name": name, "line": line, "column": 1, "source": {"name": file, "path": path},
            }));
        }
        Ok(json!({"stackFrames": shown, "totalFrames": all}))
    }

    pub(super) fn scopes(&mut self, arguments: &Value) -> Answer {
        let frame = arguments.get("frameId").and_then(Value::as_u64).unwrap_or_default() as usize;
        self.shown.frame_of(frame).ok_or("there is no such frame")?;
        let scopes = [
            ("Locals", Container::Locals(frame), false),
            ("Globals", Container::Globals(frame), false),
            ("System variables", Container::System(frame), true),
            ("Signals", Container::Signals, true),
            ("Robot", Container::Robot(frame), true),
        ];
        let mut shown = Vec::new();
        for (name, container, expensive) in scopes {
            let mut scope = json!({
                "name": name, "variablesReference": self.shown.container(container), "expensive": expensive,
            });
            if name == "Locals" {
                scope["presentationHint"] = json!("locals");
            }
            shown.push(scope);
        }
        Ok(json!({"scopes": shown}))
    }

    pub(super) fn variables(&mut self, arguments: &Value) -> Answer {
        let number = arguments.get("variablesReference").and_then(Value::as_u64).unwrap_or_default() as usize;
        let container = self.shown.container_of(number).cloned().ok_or("the value is no longer available")?;
        let shown = match &container {
            Container::Locals(frame) => {
                let Seen { locals, handles, .. } = self.source(*frame)?;
                let mut shown = Vec::new();
                for (name, variable) in locals {
                    shown.push(self.shown.value(&name, *frame, Target::Local(name.clone()), &variable, Vec::new()));
                }
                shown.extend(handles.iter().map(ReportedVariable::shown));
                shown
            }
            Container::Globals(frame) => self.global_variables(*frame)?,
            Container::File(frame, file) => {
                let mut shown = Vec::new();
                let (variables, handles) = self.source(*frame)?.of_file(file)?;
                for (name, variable) in variables {
                    let target = Target::Global(file.clone(), name.clone());
                    shown.push(self.shown.value(&name, *frame, target, &variable, Vec::new()));
                }
                shown.extend(handles.iter().map(ReportedVariable::shown));
                shown
            }
            Container::System(frame) => {
                let mut shown = Vec::new();
                for (name, variable) in self.source(*frame)?.all_system()? {
                    let target = Target::System(name.trim_start_matches('$').to_owned());
                    shown.push(self.shown.value(&name, *frame, target, &variable, Vec::new()));
                }
                shown
            }
            Container::Signals => {
                [("di", "Inputs"), ("do", "Outputs"), ("ai", "Analog inputs"), ("ao", "Analog outputs")]
                    .map(|(kind, name)| {
                        let reference = self.shown.container(Container::Kind(kind));
                        json!({"name": kind, "value": name, "variablesReference": reference})
                    })
                    .to_vec()
            }
            Container::Kind(kind) => self.signals_of(kind)?,
            Container::Robot(frame) => self.robot(*frame)?,
            Container::Value { frame, .. } => {
                let mut seen = self.source(*frame)?;
                let family = seen.family();
                let now = seen.now(container.clone());
                self.shown.parts(&now, family)
            }
        };
        let (start, count) =
            (arguments.get("start").and_then(Value::as_u64), arguments.get("count").and_then(Value::as_u64));
        let count = count.filter(|count| *count > 0).map_or(usize::MAX, |count| count as usize);
        let shown: Vec<Value> = shown.into_iter().skip(start.unwrap_or(0) as usize).take(count).collect();
        Ok(json!({"variables": shown}))
    }

    /// The files of a program that have global variables.
    fn global_variables(&mut self, frame: usize) -> Result<Vec<Value>, String> {
        let files = self.source(frame)?.files()?;
        let mut shown = Vec::new();
        for file in files {
            let reference = self.shown.container(Container::File(frame, file.clone()));
            shown.push(json!({"name": file, "value": "", "variablesReference": reference}));
        }
        Ok(shown)
    }

    fn signals_of(&mut self, kind: &str) -> Result<Vec<Value>, String> {
        let answer = self.ask("signals", &[])?;
        let one = |at: usize, value: String, ty: &str| {
            let function = format!("get{kind}({})", at + 1);
            json!({"name": (at + 1).to_string(), "value": value, "type": ty, "variablesReference": 0, "evaluateName": function})
        };
        Ok(match answer.get(kind) {
            Some(Value::String(levels)) => {
                levels.chars().enumerate().map(|(at, level)| one(at, (level == '1').to_string(), "bool")).collect()
            }
            Some(Value::Array(values)) => {
                values.iter().enumerate().map(|(at, value)| one(at, value.to_string(), "double")).collect()
            }
            _ => Vec::new(),
        })
    }

    fn robot(&mut self, frame: usize) -> Result<Vec<Value>, String> {
        let channel = self.shown.frame_of(frame).map_or(0, |frame| frame.channel);
        let answer = self.ask("robot", &[&channel.to_string()])?;
        let plain = |name: &str, value: String| json!({"name": name, "value": value, "variablesReference": 0});
        let axes = answer.get("axes").and_then(Value::as_array).cloned().unwrap_or_default();
        let mut shown: Vec<Value> = axes
            .iter()
            .map(|axis| {
                let text = |key: &str| axis.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
                let value = axis.get("value").and_then(Value::as_f64).unwrap_or_default();
                plain(&text("name"), format!("{value:.3} {}", text("unit")))
            })
            .collect();
        let tcp = answer.get("tcp").and_then(Value::as_array).cloned().unwrap_or_default();
        let units = [("x", "mm"), ("y", "mm"), ("z", "mm"), ("a", "deg"), ("b", "deg"), ("c", "deg")];
        for ((name, unit), value) in units.iter().zip(&tcp) {
            shown.push(plain(name, format!("{:.3} {unit}", value.as_f64().unwrap_or_default())));
        }
        let text = |key: &str| answer.get(key).map(|value| value.to_string().replace('"', "")).unwrap_or_default();
        if text("motion") != "0" {
            shown.push(plain("motion", format!("number {} ({}:{})", text("motion"), text("file"), text("line"))));
        }
        Ok(shown)
    }

    /// What expressions can refer to from a frame.
    pub(super) fn source(&mut self, frame: usize) -> Result<Seen<'_>, String> {
        let frame = match (frame, self.shown.frame_of(frame)) {
            (_, Some(frame)) => frame.clone(),
            (1.., None) => return Err("the frame is no longer there".into()),
            (0, None) => {
                let channel = self.halt.as_ref().map_or(0, |halt| halt.channel);
                self.top_frame(channel)?.ok_or("no function runs")?
            }
        };
        let launched = self.launched.as_ref().ok_or("nothing was launched")?;
        let process = self.process.as_mut().ok_or("no program runs")?;
        let program = launched.programs.program(&frame.program).ok_or("the program is not known")?;
        let answer = process.ask("variables", &[&frame.channel.to_string(), &frame.id.to_string()])?;
        let mut locals: Vec<(String, Variable)> = reported(&answer, "variables").into_iter().map(variable).collect();
        let handles = reported(&answer, "handles");
        let func = launched.programs.function(&frame.program, &frame.file, &frame.name);
        for (name, ty, value) in func.map(constants).unwrap_or_default() {
            // A constant of another block does not hide a variable.
            if !locals.iter().any(|(known, _)| *known == name) {
                locals.push((name, Variable { ty, value: Literal::parse(&value) }));
            }
        }
        let module = frame.file.clone();
        Ok(Seen { process, program, frame, locals, handles, module })
    }

    pub(super) fn evaluate(&mut self, arguments: &Value) -> Answer {
        let text = arguments.get("expression").and_then(Value::as_str).unwrap_or_default().to_owned();
        let frame = arguments.get("frameId").and_then(Value::as_u64).unwrap_or_default() as usize;
        let is_console = arguments.get("context").and_then(Value::as_str).is_none_or(|context| context == "repl");
        let input = evaluate(&text, &mut self.source(frame)?)?;
        let (value, target) = match input {
            // What an editor evaluates again and again, or where the user only points at something, changes nothing.
            Input::Assignment(..) if !is_console => {
                return Err("this is an assignment; `==` compares. Variables are set in the debug console".into());
            }
            Input::Assignment(place, value) => {
                let value = self.assign(frame, &place, value.literal())?;
                (value, None)
            }
            Input::Value(value) => (value, place(&text, &mut self.source(frame)?).ok()),
        };
        let target =
            target.filter(|place| place.path.is_empty()).and_then(|place| self.target(frame, &place.root).ok());
        let variable = Variable { ty: value.ty().to_owned(), value: value.literal() };
        let shown = self.shown.value("", frame, target.unwrap_or(Target::Nothing), &variable, Vec::new());
        Ok(json!({
            "result": shown.get("value"), "type": shown.get("type"),
            "variablesReference": shown.get("variablesReference"), "indexedVariables": shown.get("indexedVariables"),
        }))
    }

    pub(super) fn set_variable(&mut self, arguments: &Value) -> Answer {
        let text = |key: &str| arguments.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let number = arguments.get("variablesReference").and_then(Value::as_u64).unwrap_or_default() as usize;
        let container = self.shown.container_of(number).cloned().ok_or("the value is no longer available")?;
        let (name, value) = (text("name"), text("value"));
        let (frame, expression) = match &container {
            Container::Locals(frame) => (*frame, name),
            Container::System(frame) => (*frame, name),
            Container::File(frame, file) => {
                let target = Target::Global(file.clone(), name);
                return self.set_target(*frame, &target, &[], &value);
            }
            Container::Kind(kind) => {
                let answer = self.edit("set-signal", &[kind, &name, value.trim()])?;
                return Ok(json!({"value": answer.get("value")}));
            }
            Container::Value { frame, target, path, .. } => {
                let part = match name.strip_prefix('[').and_then(|name| name.strip_suffix(']')) {
                    Some(at) => Part::At(at.parse().map_err(|_| "this is not an index")?),
                    None => Part::Named(name),
                };
                let path = [path.as_slice(), &[part]].concat();
                return self.set_target(*frame, target, &path, &value);
            }
            Container::Globals(_) | Container::Signals | Container::Robot(_) => {
                return Err(format!("{name} cannot be set"));
            }
        };
        self.set_expression(&json!({"frameId": frame, "expression": expression, "value": value}))
    }

    pub(super) fn set_expression(&mut self, arguments: &Value) -> Answer {
        let text = |key: &str| arguments.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let frame = arguments.get("frameId").and_then(Value::as_u64).unwrap_or_default() as usize;
        let place = place(&text("expression"), &mut self.source(frame)?)?;
        let target = self.target(frame, &place.root)?;
        self.set_target(frame, &target, &place.path, &text("value"))
    }

    fn set_target(&mut self, frame: usize, target: &Target, path: &[Part], value: &str) -> Answer {
        let value = match evaluate(value, &mut self.source(frame)?)? {
            Input::Value(value) => value.literal(),
            Input::Assignment(..) => return Err("expected a value, found an assignment".into()),
        };
        let value = self.put(frame, target, path, value)?;
        let shown = self.shown.value("", frame, target.clone(), &value, path.to_vec());
        Ok(json!({
            "value": shown.get("value"), "type": shown.get("type"), "variablesReference": shown.get("variablesReference"),
        }))
    }

    /// The variable that an expression names.
    fn target(&mut self, frame: usize, root: &Root) -> Result<Target, String> {
        let seen = self.source(frame)?;
        let locals: Vec<String> = seen.locals.iter().map(|(name, _)| name.clone()).collect();
        let file_of = |module: Option<&str>, name: &str| seen.file_of(module, name);
        Target::of(root, &locals, file_of).ok_or_else(|| "there is no such variable".to_owned())
    }

    fn assign(&mut self, frame: usize, place: &NamedPlace, value: Literal) -> Result<Found, String> {
        let target = self.target(frame, &place.root)?;
        let value = self.put(frame, &target, &place.path, value)?;
        Ok(Found::of(&value.ty, &value.value))
    }

    /// Sets a part of a variable; returns the part as it is then.
    fn put(&mut self, frame: usize, target: &Target, path: &[Part], value: Literal) -> Result<Variable, String> {
        let mut seen = self.source(frame)?;
        let (channel, id) = (seen.frame.channel.to_string(), seen.frame.id.to_string());
        let whole = seen.whole(target)?;
        let family = seen.family();
        let text = whole.value.with(path, value).ok_or("there is no such part")?.text();
        match target {
            Target::Local(name) => self.edit("set", &[&channel, &id, name, &text])?,
            Target::Global(file, name) => self.edit("set-global", &[&channel, file, name, &text])?,
            Target::System(name) => self.edit("set-system", &[&channel, name, &text])?,
            Target::Nothing => return Err("this cannot be set".into()),
        };
        let whole = self.source(frame)?.whole(target)?;
        let mut ty = whole.ty;
        for part in path {
            ty = part_type(&ty, part, family)?;
        }
        let value = whole.value.part(path).cloned().unwrap_or(Literal::Plain("9e9".into()));
        Ok(Variable { ty, value })
    }

    /// Changes something of the halted program, and remembers it for stepping back.
    pub(super) fn edit(&mut self, word: &str, values: &[&str]) -> Answer {
        let point = self.halt.as_ref().map(|halt| halt.point);
        let answer = self.change(word, values)?;
        if let Some(point) = point {
            self.replay.edited(point, word, values);
        }
        Ok(answer)
    }

    /// Changes something of the halted program. If its pointer is set, the program goes there and halts.
    pub(super) fn change(&mut self, word: &str, values: &[&str]) -> Answer {
        let answer = self.ask(word, values)?;
        if answer.get("arrives").and_then(Value::as_bool) == Some(true) {
            let stopped = self.wait_for("stopped")?;
            self.arrive(&stopped);
        }
        Ok(answer)
    }
}
