//! One debugging session: the requests of the editor, and the messages of the program.

mod inspect;
mod pointer;
mod replay;
mod seen;

use super::Event;
use super::breakpoints::Breakpoints;
use super::evaluate::{Input, evaluate};
use super::executable::Executable;
use super::launch::{self, Launch};
use super::leftovers;
use super::process::{News, Process};
use super::program::{FileKey, Key, Programs};
use super::protocol::{Outgoing, Request, capabilities};
use super::state::State;
use super::variables::Shown;
use arl_project::cache::Kind;
use arl_project::options::RunOptions;
use arl_project::program::prepare;
use arl_terminal::failure::Failure;
use replay::Point;
use serde_json::{Value, json};
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, Sender};

/// An answer to the editor.
type Answer = Result<Value, String>;

/// One session.
pub(super) struct Session {
    out: Outgoing,
    sender: Sender<Event>,
    events: Receiver<Event>,
    /// Events that came while another one was awaited.
    waiting: VecDeque<Event>,
    breakpoints: Breakpoints,
    /// What else the program halts at: `alarms`, `events`.
    kinds: Vec<String>,
    /// Ends before its executable is removed.
    process: Option<Process>,
    launched: Option<Launched>,
    /// The number of the run, from 1.
    run: u64,
    /// The names of the channels, and the programs that they begin with.
    channels: Vec<(String, Key)>,
    halt: Option<Halt>,
    shown: Shown,
    replay: replay::Record,
    /// The lines that the editor may set the program pointer to, by their numbers.
    targets: pointer::Targets,
    /// Whether a search backwards is under way: breakpoints are counted, but not reported.
    searches: bool,
    /// Whether the next halt is the one at the beginning.
    enters: bool,
    over: bool,
}

/// A program that is ready to run.
struct Launched {
    launch: Launch,
    options: RunOptions,
    programs: Programs,
    executable: Executable,
    state: State,
}

/// Where the programs are halted.
#[derive(Clone, PartialEq, Debug)]
struct Halt {
    why: String,
    channel: usize,
    point: Point,
    text: String,
}

impl Session {
    pub(super) fn new(sender: Sender<Event>, events: Receiver<Event>) -> Self {
        Self {
            out: Outgoing::default(),
            sender,
            events,
            waiting: VecDeque::new(),
            breakpoints: Breakpoints::default(),
            kinds: vec!["alarms".into()],
            launched: None,
            process: None,
            run: 0,
            channels: Vec::new(),
            halt: None,
            shown: Shown::default(),
            replay: replay::Record::default(),
            targets: pointer::Targets::default(),
            searches: false,
            enters: false,
            over: false,
        }
    }

    /// Serves until the editor is gone, or has said `disconnect`; returns whether it is gone.
    pub(super) fn serve(mut self) -> bool {
        while !self.over {
            let event = match self.waiting.pop_front() {
                Some(event) => event,
                None => match self.events.recv() {
                    Ok(event) => event,
                    Err(_) => return true,
                },
            };
            match event {
                Event::Gone => return true,
                Event::Request(request) => {
                    let answer = self.answer(&request);
                    let done = answer.is_ok();
                    self.out.answer(&request, answer);
                    self.follow(&request, done);
                }
                // News of an earlier run no longer counts.
                Event::Process(run, news) if run == self.run => self.receive(news),
                Event::Process(..) => {}
            }
        }
        false
    }

    fn answer(&mut self, request: &Request) -> Answer {
        let arguments = &request.arguments;
        match request.command.as_str() {
            "initialize" => Ok(capabilities()),
            "launch" => self.launch(arguments),
            "configurationDone" => self.start_run(),
            "setBreakpoints" => self.set_breakpoints(arguments),
            "setFunctionBreakpoints" => self.set_function_breakpoints(arguments),
            "setExceptionBreakpoints" => self.set_kinds(arguments),
            "breakpointLocations" => Ok(self.breakpoint_locations(arguments)),
            "threads" => Ok(self.threads()),
            "stackTrace" => self.stack_trace(arguments),
            "scopes" => self.scopes(arguments),
            "variables" => self.variables(arguments),
            "setVariable" => self.set_variable(arguments),
            "setExpression" => self.set_expression(arguments),
            "evaluate" => self.evaluate(arguments),
            "exceptionInfo" => self.exception_info(),
            "continue" => self.go("go", &[]).map(|()| json!({"allThreadsContinued": true})),
            "next" => self.step("over", arguments),
            "stepIn" => self.step("into", arguments),
            "stepOut" => self.step("out", arguments),
            "arl/nextMotion" => self.step("motion", arguments),
            "gotoTargets" => self.goto_targets(arguments),
            "goto" => self.set_pointer(arguments),
            "pause" => self.ask("pause", &[]).map(|_| Value::Null),
            "stepBack" => self.step_back(),
            "reverseContinue" => self.reverse_continue(),
            "restart" => self.restart(),
            "terminate" | "disconnect" => {
                self.process = None;
                Ok(Value::Null)
            }
            other => Err(format!("there is no request `{other}`")),
        }
    }

    /// Does what follows the answer to a request, which was done or refused.
    fn follow(&mut self, request: &Request, done: bool) {
        match request.command.as_str() {
            "launch" if self.launched.is_some() => self.out.event("initialized", json!({})),
            "terminate" => {
                self.run += 1;
                self.out.event("terminated", json!({}));
            }
            "disconnect" => self.over = true,
            "goto" if !done => {}
            "stepBack" | "reverseContinue" | "restart" | "goto" => self.say_halt(),
            _ => {}
        }
    }

    fn launch(&mut self, arguments: &Value) -> Answer {
        let launch: Launch = serde_json::from_value(arguments.clone()).map_err(|error| error.to_string())?;
        for key in launch::unknown(arguments) {
            self.out.output("console", &format!("warning: the launch configuration has an unknown key `{key}`\n"));
        }
        if launch.program.as_os_str().is_empty() {
            return Err("the launch configuration has no `program`".into());
        }
        let main = launch.main();
        let options = launch.options()?.of_program(&main).map_err(|failure| failure.to_string())?;
        let programs = Programs::check(&main, &options, &|text| self.out.output("stderr", text))?;
        let ready = prepare(Kind::Watched, &main, &options).map_err(|failure| match failure {
            Failure::Usage(text) | Failure::Other(text) => text,
            Failure::Shown => "the program has errors".into(),
        })?;
        for breakpoint in self.breakpoints.find_places(&programs) {
            self.out.event("breakpoint", json!({"reason": "changed", "breakpoint": breakpoint}));
        }
        leftovers::sweep();
        let executable = Executable::of(&ready)?;
        let folder = main.parent().unwrap_or_else(|| "".as_ref());
        let state = State::new(options.state_dir.as_deref(), options.script_dir.as_deref().unwrap_or(folder));
        self.launched = Some(Launched { launch, options, programs, executable, state });
        Ok(Value::Null)
    }

    /// Runs the program from its beginning.
    fn start_run(&mut self) -> Answer {
        self.breakpoints.go_back_to(0);
        self.begin()?;
        let launched = self.launched.as_ref().ok_or("nothing was launched")?;
        self.enters = launched.launch.stop_on_entry;
        let (word, values): (_, &[&str]) = if launched.launch.stop_on_entry { ("into", &["0"]) } else { ("go", &[]) };
        self.go(word, values)?;
        Ok(Value::Null)
    }

    /// Starts the program, which then waits before its first cycle.
    fn begin(&mut self) -> Result<(), String> {
        let launched = self.launched.as_ref().ok_or("nothing was launched")?;
        let mut command = launched.executable.command()?;
        self.process = None;
        let options = RunOptions { state_dir: Some(launched.state.begin()?.to_path_buf()), ..launched.options.clone() };
        command.args(options.arguments());
        if let Some(folder) = &launched.launch.cwd {
            command.current_dir(folder);
        }
        self.run += 1;
        (self.halt, self.shown) = (None, Shown::default());
        self.replay.begin();
        self.process = Some(Process::start(command, self.run, &self.sender)?);
        let ready = self.wait_for("ready")?;
        let name = |channel: &Value| channel.get("name").and_then(Value::as_str).unwrap_or_default().to_owned();
        let channels = ready.get("channels").and_then(Value::as_array).cloned().unwrap_or_default();
        self.channels = channels.iter().map(|channel| (name(channel), Key::of(channel))).collect();
        if launched_without_debugging(self.launched.as_ref()) {
            return Ok(());
        }
        self.send_breakpoints()?;
        self.send_kinds()
    }

    /// Waits for an event of the program; other events are kept for later.
    fn wait_for(&mut self, event: &str) -> Answer {
        loop {
            match self.events.recv().map_err(|_| "the program is gone")? {
                Event::Process(run, News::Message(value)) if run == self.run => {
                    if value.get("event").and_then(Value::as_str) == Some(event) {
                        return Ok(value);
                    }
                    self.waiting.push_back(Event::Process(run, News::Message(value)));
                }
                Event::Process(run, News::Ended(code)) if run == self.run => {
                    self.waiting.push_back(Event::Process(run, News::Ended(code)));
                    return Err("the program has ended".into());
                }
                Event::Process(run, _) if run != self.run => {}
                other if ends_session(&other) => {
                    self.waiting.push_back(other);
                    self.process = None;
                    return Err("the session ends".into());
                }
                other => self.waiting.push_back(other),
            }
        }
    }

    fn ask(&mut self, word: &str, values: &[&str]) -> Answer {
        self.process.as_mut().ok_or("no program runs")?.ask(word, values)
    }

    /// Lets the program continue.
    fn go(&mut self, word: &str, values: &[&str]) -> Result<(), String> {
        self.ask(word, values)?;
        self.halt = None;
        self.shown = Shown::default();
        Ok(())
    }

    fn step(&mut self, word: &str, arguments: &Value) -> Answer {
        let channel = self.channel_of(arguments)?;
        self.go(word, &[&channel.to_string()]).map(|()| Value::Null)
    }

    fn set_breakpoints(&mut self, arguments: &Value) -> Answer {
        let path =
            arguments.pointer("/source/path").and_then(Value::as_str).ok_or("the source has no path")?.to_owned();
        let wanted = arguments.get("breakpoints").and_then(Value::as_array).cloned().unwrap_or_default();
        let programs = self.launched.as_ref().map(|launched| &launched.programs);
        let answers = self.breakpoints.set_lines(&path, &wanted, programs);
        self.send_breakpoints()?;
        Ok(json!({"breakpoints": answers}))
    }

    fn set_function_breakpoints(&mut self, arguments: &Value) -> Answer {
        let wanted = arguments.get("breakpoints").and_then(Value::as_array).cloned().unwrap_or_default();
        let programs = self.launched.as_ref().map(|launched| &launched.programs);
        let answers = self.breakpoints.set_functions(&wanted, programs);
        self.send_breakpoints()?;
        Ok(json!({"breakpoints": answers}))
    }

    fn set_kinds(&mut self, arguments: &Value) -> Answer {
        let filters = arguments.get("filters").and_then(Value::as_array).cloned().unwrap_or_default();
        self.kinds = filters.iter().filter_map(Value::as_str).map(str::to_owned).collect();
        self.send_kinds()?;
        Ok(Value::Null)
    }

    fn send_kinds(&mut self) -> Result<(), String> {
        let kinds = self.kinds.clone();
        let kinds: Vec<&str> = kinds.iter().map(String::as_str).collect();
        if self.process.is_some() { self.ask("kinds", &kinds).map(|_| ()) } else { Ok(()) }
    }

    fn send_breakpoints(&mut self) -> Result<(), String> {
        let (Some(launched), true) = (&self.launched, self.process.is_some()) else { return Ok(()) };
        for (FileKey { program, file }, lines) in self.breakpoints.lines(&launched.programs) {
            let lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
            let place = [program.folder.as_str(), &program.main, &file];
            let values: Vec<&str> = place.into_iter().chain(lines.iter().map(String::as_str)).collect();
            self.ask("breakpoints", &values)?;
        }
        Ok(())
    }

    fn breakpoint_locations(&self, arguments: &Value) -> Value {
        let path = arguments.pointer("/source/path").and_then(Value::as_str).unwrap_or_default();
        let line = |key: &str| arguments.get(key).and_then(Value::as_u64).map(|line| line as u32);
        let first = line("line").unwrap_or(1);
        let last = line("endLine").unwrap_or(first);
        let functions = self.launched.as_ref().map(|launched| launched.programs.functions(path.as_ref()));
        let lines = functions.iter().flatten().flat_map(|lines| lines.range(first..=last.max(first)));
        let all: std::collections::BTreeSet<u32> = lines.copied().collect();
        json!({"breakpoints": all.into_iter().map(|line| json!({"line": line})).collect::<Vec<_>>()})
    }

    fn threads(&self) -> Value {
        let thread = |(at, (name, program)): (usize, &(String, Key))| json!({"id": at + 1, "name": format!("{name}: {}", program.main)});
        let all: Vec<Value> = self.channels.iter().enumerate().map(thread).collect();
        let none = || vec![json!({"id": 1, "name": "channel 1"})];
        json!({"threads": if all.is_empty() { none() } else { all }})
    }

    fn restart(&mut self) -> Answer {
        self.replay.forget();
        self.halt = None;
        self.start_run()
    }

    fn exception_info(&self) -> Answer {
        let halt = self.halt.as_ref().filter(|halt| halt.why == "alarm").ok_or("no alarm has come up")?;
        Ok(json!({"exceptionId": "alarm", "description": halt.text, "breakMode": "always"}))
    }

    /// Handles news of the running program.
    fn receive(&mut self, news: News) {
        match news {
            News::Output(category, text) => {
                if self.replay.is_new(category) {
                    self.out.output(category, &text);
                }
            }
            News::Ended(code) => {
                let code = code.or_else(|| self.process.as_mut().and_then(Process::exit_code));
                self.process = None;
                self.halt = None;
                self.out.event("exited", json!({"exitCode": code.unwrap_or(-1)}));
                self.out.event("terminated", json!({}));
            }
            News::Message(value) => match value.get("event").and_then(Value::as_str) {
                Some("stopped") if self.arrive(&value) => self.say_halt(),
                Some("motion") => self.tell_motion(&value),
                _ => {}
            },
        }
    }

    /// Notes where the program is halted; returns false where it continues, since a breakpoint's condition does not
    /// hold.
    fn arrive(&mut self, value: &Value) -> bool {
        let text = |key: &str| value.get(key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let number = |key: &str| value.get(key).and_then(Value::as_u64).unwrap_or_default();
        self.shown = Shown::default();
        let mut halt = Halt {
            why: text("why"),
            channel: number("channel") as usize,
            point: Point { statement: number("statement"), cycle: value.get("cycle").and_then(Value::as_u64) },
            text: text("text"),
        };
        if std::mem::take(&mut self.enters) && halt.why == "step" {
            halt.why = "entry".into();
        }
        self.halt = Some(halt.clone());
        if halt.why == "breakpoint" && !self.is_wanted(halt.channel) {
            let also = text("also");
            if also.is_empty() {
                // A program that is gone reports that by itself.
                let _ = self.go("again", &[]);
                return false;
            }
            halt.why = also;
            self.halt = Some(halt);
        }
        true
    }

    /// Whether one of the breakpoints at a channel's place should halt the program; their messages are shown.
    fn is_wanted(&mut self, channel: usize) -> bool {
        let Ok(Some(frame)) = self.top_frame(channel) else { return true };
        let place = FileKey { program: frame.program.clone(), file: frame.file.clone() };
        let statement = self.halt.as_ref().map_or(0, |halt| halt.point.statement);
        let found: Vec<(i64, Option<String>)> = self
            .breakpoints
            .at(&place, frame.line)
            .iter()
            .map(|breakpoint| (breakpoint.id, breakpoint.condition.clone()))
            .collect();
        let number = self.shown.frame(frame.clone());
        let mut wanted = false;
        for (id, condition) in found {
            if let Some(condition) = condition {
                match self.truth(&condition, number) {
                    Ok(true) => {}
                    Ok(false) => continue,
                    Err(why) => {
                        self.out
                            .output("console", &format!("the condition `{condition}` cannot be evaluated: {why}\n"));
                    }
                }
            }
            let mut here = self.breakpoints.at(&place, frame.line).into_iter();
            let Some(breakpoint) = here.find(|breakpoint| breakpoint.id == id) else { continue };
            if !breakpoint.hit(statement) {
                continue;
            }
            match breakpoint.message.clone() {
                Some(_) if self.searches => {}
                Some(message) => {
                    let text = self.filled(&message, number);
                    self.out.output("console", &(text + "\n"));
                }
                None => wanted = true,
            }
        }
        wanted
    }

    fn truth(&mut self, condition: &str, frame: usize) -> Result<bool, String> {
        match evaluate(condition, &mut self.source(frame)?)? {
            Input::Value(value) => value.truth(),
            Input::Assignment(..) => Err("this is an assignment; `==` compares".into()),
        }
    }

    /// A message with the values of the expressions in braces.
    fn filled(&mut self, message: &str, frame: usize) -> String {
        let (mut out, mut rest) = (String::new(), message);
        while let Some((before, behind)) = rest.split_once('{') {
            let Some((inside, after)) = behind.split_once('}') else { break };
            out += before;
            let value = self.source(frame).and_then(|mut source| evaluate(inside, &mut source));
            out += &match value {
                Ok(Input::Value(super::evaluate::Value::Text(text))) => text,
                Ok(Input::Value(value)) => value.literal().text(),
                Ok(Input::Assignment(..)) => "an assignment".into(),
                Err(why) => format!("<{why}>"),
            };
            rest = after;
        }
        out + rest
    }

    /// Reports to the editor where the program is halted.
    fn say_halt(&mut self) {
        let Some(halt) = &self.halt else { return };
        let (reason, description) = match halt.why.as_str() {
            "alarm" => ("exception", "Paused at an alarm"),
            "event" => ("event", "Paused at the action of an event"),
            "pause" => ("pause", "Paused"),
            "standstill" => ("pause", "Paused: nothing can change any more"),
            "goto" => ("goto", "Paused: the program pointer was set"),
            "entry" => ("entry", "Paused at the beginning"),
            "breakpoint" => ("breakpoint", "Paused at a breakpoint"),
            _ => ("step", "Paused"),
        };
        let mut body = json!({
            "reason": reason, "description": description, "threadId": halt.channel + 1, "allThreadsStopped": true,
        });
        if !halt.text.is_empty() {
            body["text"] = json!(halt.text);
        }
        self.out.event("stopped", body);
    }

    /// Reports which motion the robot of a channel executes.
    fn tell_motion(&self, value: &Value) {
        let channel = value.get("channel").and_then(Value::as_u64).unwrap_or_default() as usize;
        let file = value.get("file").and_then(Value::as_str).unwrap_or_default();
        let launched = self.launched.as_ref().filter(|_| !file.is_empty());
        let path = launched.and_then(|launched| launched.programs.path(&Key::of(value), file));
        self.out.event(
            "arl/motionPointer",
            json!({"channel": channel + 1, "file": path, "line": value.get("line"), "motion": value.get("motion")}),
        );
    }
}

/// Whether the program is no longer needed.
fn ends_session(event: &Event) -> bool {
    match event {
        Event::Gone => true,
        Event::Request(request) => matches!(request.command.as_str(), "disconnect" | "terminate"),
        Event::Process(..) => false,
    }
}

/// Whether the editor runs the program without debugging it: nothing halts it then.
fn launched_without_debugging(launched: Option<&Launched>) -> bool {
    launched.is_some_and(|launched| launched.launch.no_debug)
}
