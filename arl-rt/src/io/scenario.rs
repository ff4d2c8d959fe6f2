//! The io scenario: what the world around the robot does, and when.
//!
//! ```toml
//! [[event]]
//! at = 2.0            # seconds of controller time
//! di.5 = true
//!
//! [[event]]
//! when = "do.3"       # each time the output goes on; "!do.3": off; di.N too
//! after = 0.5         # seconds later
//! ai.2 = 4.2
//! internal.1 = true   # what getintdi reads
//! internal_do.1 = true   # what getintdo reads
//! pendant = "start"
//! override = 50       # %
//! force = [0, 0, 80]  # N, what pushes the TCP, in the world; until another event says otherwise
//! torque.j3 = -20     # Nm (N of a linear axis), what turns an axis
//! jog.j1 = 5          # deg (mm): somebody jogs an axis (j1.., ej1..) by so much, while the program is paused
//! hand.j1 = 5         # deg (mm): somebody moves an axis by hand, while the servo is off
//! channel = 2         # whose robot is pushed, jogged or moved; without it that of channel 1
//! ```

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::bits::Bits;
use super::image::PWM_CHANNELS;
use super::{Channels, Digital, Image, Pwm};
use crate::cycle::channel_id::MOST_FOREGROUND;
use arl_robot::cell::Rate;
use arl_robot::regular_file;
use arl_robot::robot::Robot;
use arl_robot::settings::{Section, SettingsError, Source, Value, hint, kind, number, table};

const EVENT: &[&str] = &[
    "at",
    "when",
    "after",
    "di",
    "ai",
    "internal",
    "internal_do",
    "pendant",
    "override",
    "force",
    "torque",
    "jog",
    "hand",
    "channel",
];

/// What an event may change.
const CHANGES: &str = "`di.N`, `ai.N`, `internal.N`, `internal_do.N`, `pendant`, `override`, `force`, `torque.jN`, `jog.jN` \
                       or `hand.jN`";

/// A word of the teach pendant.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Pendant {
    /// The start button: a paused program goes on, the robot back on its path first.
    Start,
    /// The pause button: the robot stops on its path at once, and the program with it.
    Pause,
    /// Goes on for one instruction that moves, waits or touches the outside; from then on step by step, until start.
    Step,
    /// Ends a program that is paused; one that has ended begins again.
    Reset,
    /// Acknowledges an alarm.
    Clear,
    /// Switches the motors on.
    ServoOn,
    /// Stops the robot on its path and switches the motors off.
    ServoOff,
    /// The speed override in %.
    Override(f64),
}

/// The words that a scenario may use.
const WORDS: [(&str, Pendant); 7] = [
    ("start", Pendant::Start),
    ("pause", Pendant::Pause),
    ("step", Pendant::Step),
    ("reset", Pendant::Reset),
    ("clear", Pendant::Clear),
    ("servo_on", Pendant::ServoOn),
    ("servo_off", Pendant::ServoOff),
];

/// What an event does besides setting inputs.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Effect {
    /// Somebody uses the pendant.
    Pendant(Pendant),
    /// Somebody touches the robot of a foreground channel, counted from 1.
    Robot(u8, RobotEffect),
}

/// What is done to a robot.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum RobotEffect {
    /// A force pushes the TCP: in the world, N.
    Force([f64; 3]),
    /// A torque (Nm; N of a linear axis) turns an axis, counted from 0.
    Torque(usize, f64),
    /// Somebody jogs an axis by so many deg (mm).
    Jog(AxisName, f64),
    /// Somebody moves an axis by hand, by so many deg (mm).
    Hand(AxisName, f64),
}

/// An axis by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum AxisName {
    /// One of the robot's own, counted from 0: `j1`.
    Own(usize),
    /// An external one, counted from 0: `ej1`.
    External(usize),
}

impl AxisName {
    /// Its place among all axes of a robot, counted from 0, where that has it.
    pub(crate) fn place(self, robot: &Robot) -> Option<usize> {
        let own = robot.own_axes().len();
        match self {
            AxisName::Own(axis) => Some(axis).filter(|axis| *axis < own),
            AxisName::External(axis) => Some(own + axis).filter(|axis| *axis < robot.axes.len()),
        }
    }

    fn of(key: &str) -> Self {
        let number = |digits: &str| digits.parse::<usize>().unwrap_or(1).saturating_sub(1);
        match key.strip_prefix("ej") {
            Some(digits) => AxisName::External(number(digits)),
            None => AxisName::Own(number(key.trim_start_matches('j'))),
        }
    }
}

impl fmt::Display for AxisName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AxisName::Own(axis) => write!(f, "j{}", axis + 1),
            AxisName::External(axis) => write!(f, "ej{}", axis + 1),
        }
    }
}

/// What an event does.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Action {
    Digital(Digital, i32, bool),
    Analog(i32, f64),
    Effect(Effect),
}

impl Action {
    /// Whether the channel or axis exists, and the masses that it needs.
    fn check(&self, image: &Image, robots: &[&Robot]) -> Result<(), String> {
        let found = match *self {
            Action::Digital(what, channel, _) => image.digital(what, channel).map(drop),
            Action::Analog(channel, value) => image.check_ai(channel, value),
            Action::Effect(Effect::Pendant(_)) => return Ok(()),
            Action::Effect(Effect::Robot(channel, robot_effect)) => return moves(robots, channel, robot_effect),
        };
        found.map_err(|fault| format!("sets an input to what it cannot have: {fault}"))
    }

    /// Does what was checked; hands everything but inputs to `do_it`.
    fn play(&self, image: &mut Image, do_it: &mut impl FnMut(Effect)) {
        let _ = match *self {
            Action::Digital(what, channel, level) => image.set_digital(what, channel, level),
            Action::Analog(channel, value) => image.set_ai(channel, value),
            Action::Effect(effect) => {
                do_it(effect);
                Ok(())
            }
        };
    }
}

/// What somebody outside does now: the part of an event that is not its cause.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Order {
    actions: Vec<Action>,
}

impl Order {
    /// Reads lines like `di.5 = true` or `pendant = "pause"`.
    pub(crate) fn parse(text: &str) -> Result<Self, SettingsError> {
        let source = Source { file: "order", text };
        let root = source.parse()?;
        let known = &EVENT[3..];
        let actions = actions(source, &Section::new(source, "an order", root.get_ref(), known)?)?;
        if actions.is_empty() {
            return Err(SettingsError::of_file("order", format!("an order changes nothing: expected {CHANGES}")));
        }
        Ok(Self { actions })
    }

    /// Sets inputs; hands everything else to `do_it`. Nothing of an order is done that cannot be done in full.
    pub(crate) fn carry_out(
        &self,
        image: &mut Image,
        robots: &[&Robot],
        mut do_it: impl FnMut(Effect),
    ) -> Result<(), String> {
        for action in &self.actions {
            action.check(image, robots).map_err(|problem| format!("the order {problem}"))?;
        }
        self.actions.iter().for_each(|action| action.play(image, &mut do_it));
        Ok(())
    }
}

/// What sets an event off.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Cause {
    /// A point in time, in s.
    At(f64),
    /// An edge of a signal: input or output, channel from 0, level after the edge.
    Edge { output: bool, channel: usize, level: bool },
    /// Another frequency or duty cycle of a PWM output, from 0.
    Pwm(usize),
}

#[derive(Clone, PartialEq, Debug)]
struct Event {
    cause: Cause,
    /// Seconds from the cause to the event; an edge has its effect in the next cycle at the earliest.
    after: f64,
    actions: Vec<Action>,
}

/// What the world around the robot does, and when.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Scenario {
    events: Vec<Event>,
}

impl Scenario {
    /// Reads a scenario file.
    ///
    /// # Errors
    /// The file cannot be read, or what it says is not a scenario.
    pub fn load(path: &Path) -> Result<Scenario, SettingsError> {
        let name = path.display().to_string();
        let text = regular_file::read_text(path)
            .map_err(|error| SettingsError::of_file(&name, format!("cannot read the io scenario: {error}")))?;
        Scenario::parse(&name, &text)
    }

    /// The scenario that `text` describes; `file` names the text in errors.
    ///
    /// # Errors
    /// The text is not TOML, or not a scenario: with line, column and what was expected.
    pub fn parse(file: &str, text: &str) -> Result<Scenario, SettingsError> {
        // As a whole, a long text takes many times its size, so it is read table by table. Only the whole tells where mistakes
        // are, and whether the parts would mean something else together.
        match Self::by_tables(file, text) {
            Some(scenario) => Ok(scenario),
            None => Ok(Scenario { events: events(Source { file, text })? }),
        }
    }

    /// The scenario, where nothing stands in front of the first table, no text has several lines, and there is no mistake.
    fn by_tables(file: &str, text: &str) -> Option<Scenario> {
        if text.contains("\"\"\"") || text.contains("'''") {
            return None;
        }
        let mut tables = tables_of(text);
        let before = Source { file, text: tables.next()? };
        if !before.parse().ok()?.get_ref().is_empty() {
            return None;
        }
        let mut scenario = Scenario::default();
        for text in tables {
            scenario.events.extend(events(Source { file, text }).ok()?);
        }
        Some(scenario)
    }

    /// Whether all channels and axes that the scenario names exist, and the masses that it needs; `robots` are those of the
    /// foreground channels.
    pub(crate) fn check(&self, channels: &Channels, robots: &[&Robot]) -> Result<(), String> {
        let image = Image::new(channels);
        for event in &self.events {
            if let Cause::Edge { output, channel, level: _ } = event.cause {
                let (name, count) = if output { ("do", channels.dout) } else { ("di", channels.di) };
                if channel >= count as usize {
                    return Err(format!("the scenario waits for {name}.{}, but there are {count}", channel + 1));
                }
            }
            if let Cause::Pwm(channel) = event.cause
                && channel >= PWM_CHANNELS
            {
                return Err(format!("the scenario waits for pwm.{}, but there are {PWM_CHANNELS}", channel + 1));
            }
            for action in &event.actions {
                action.check(&image, robots).map_err(|problem| format!("the scenario {problem}"))?;
            }
        }
        Ok(())
    }
}

/// A text in parts: what is in front of the first line that begins a table of `event`, then table by table.
fn tables_of(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    let mut is_first = true;
    std::iter::from_fn(move || {
        let text = rest?;
        // The line that begins a table is its own, not the next one's.
        let own = if std::mem::take(&mut is_first) { 0 } else { text.find('\n').map_or(text.len(), |end| end + 1) };
        let begins = |line: &str| line.trim_start().starts_with("[[event]]");
        let mut at = own;
        let lines = text.get(own..).unwrap_or_default().split_inclusive('\n');
        for line in lines {
            if begins(line) {
                let (table, more) = text.split_at_checked(at)?;
                rest = Some(more);
                return Some(table);
            }
            at += line.len();
        }
        rest = None;
        Some(text)
    })
}

/// The events of a text.
fn events(source: Source<'_>) -> Result<Vec<Event>, SettingsError> {
    let root = source.parse()?;
    let top = Section::new(source, "the io scenario", root.get_ref(), &["event"])?;
    let Some(events) = top.find("event") else { return Ok(Vec::new()) };
    let array =
        events.get_ref().as_array().ok_or_else(|| top.wrong("event", events, "tables that begin with [[event]]"))?;
    array.iter().map(|value| event(source, value)).collect()
}

/// Whether something can be done to the robot of a channel.
fn moves(robots: &[&Robot], channel: u8, robot_effect: RobotEffect) -> Result<(), String> {
    let Some(robot) = robots.get(usize::from(channel).wrapping_sub(1)) else {
        let count = robots.len();
        return Err(format!("is about the robot of channel {channel}, but there are {count} channels with a robot"));
    };
    let own = robot.own_axes().len();
    match robot_effect {
        RobotEffect::Jog(axis, _) | RobotEffect::Hand(axis, _) if axis.place(robot).is_none() => {
            let external = match robot.external_axes().len() {
                0 => String::new(),
                count => format!(" and ej1 to ej{count}"),
            };
            Err(format!("moves {axis}, but robot {} has j1 to j{own}{external}", robot.name))
        }
        RobotEffect::Jog(..) | RobotEffect::Hand(..) => Ok(()),
        RobotEffect::Torque(axis, _) if axis >= own => {
            Err(format!("turns j{}, but robot {} has j1 to j{own}", axis + 1, robot.name))
        }
        RobotEffect::Force(_) | RobotEffect::Torque(..) if robot.links.is_empty() => {
            Err(format!("pushes the robot, but the file of robot {} has no [[link]]", robot.name))
        }
        RobotEffect::Force(_) | RobotEffect::Torque(..) => Ok(()),
    }
}

fn event(source: Source<'_>, value: &Value<'_>) -> Result<Event, SettingsError> {
    let event = table(source, value, "[[event]]", EVENT)?;
    let after = event.number("after", "seconds", 0.0, 1e9)?;
    let cause = match (event.number("at", "seconds", 0.0, 1e9)?, event.text("when", "\"do.3\" or \"!do.3\"")?) {
        (Some(at), None) => Cause::At(at),
        (None, Some(_)) => edge(&event)?,
        (at, _) => {
            let found = if at.is_some() { "both `at` and `when`" } else { "neither `at` nor `when`" };
            let message = format!("[[event]] has {found}: one of them says when it happens");
            return Err(source.error(value.span(), message));
        }
    };
    if let (Cause::At(_), Some((_, span, _))) = (cause, event.entries().into_iter().find(|(key, ..)| *key == "after")) {
        return Err(source.error(span, "`after` counts from `when`; with `at`, add the seconds there"));
    }
    let actions = actions(source, &event)?;
    if actions.is_empty() {
        return Err(source.error(value.span(), format!("[[event]] changes nothing: expected {CHANGES}")));
    }
    Ok(Event { cause, after: after.unwrap_or(0.0), actions })
}

/// By how much an axis is moved.
const OWN_AXES: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6"];
const ALL_AXES: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
const LENGTH: &str = "deg, or mm of a linear axis";

/// What an event changes.
fn actions(source: Source<'_>, event: &Section<'_>) -> Result<Vec<Action>, SettingsError> {
    let mut actions = Vec::new();
    let most = MOST_FOREGROUND as u32;
    let channel = match event.count("channel", "a channel with a robot", most)? {
        Some(0) => {
            return Err(event.find("channel").map_or_else(
                || source.error(0..0, "channel"),
                |value| event.wrong("channel", value, &format!("a channel with a robot from 1 to {most}")),
            ));
        }
        channel => channel.unwrap_or(1) as u8,
    };
    for (key, _, value) in event.entries() {
        match key {
            "di" => signals(
                source,
                key,
                value,
                |channel, level| Action::Digital(Digital::Di, channel, level),
                &mut actions,
            )?,
            "internal" => signals(
                source,
                key,
                value,
                |channel, level| Action::Digital(Digital::InternalIn, channel, level),
                &mut actions,
            )?,
            "internal_do" => signals(
                source,
                key,
                value,
                |channel, level| Action::Digital(Digital::InternalOut, channel, level),
                &mut actions,
            )?,
            "ai" => analogs(source, value, &mut actions)?,
            "pendant" => actions.push(Action::Effect(Effect::Pendant(pendant(event, source, value)?))),
            "override" => {
                let percent = event.number(key, "percent", 0.0, 100.0)?.unwrap_or(100.0);
                actions.push(Action::Effect(Effect::Pendant(Pendant::Override(percent))));
            }
            "force" => actions.push(Action::Effect(Effect::Robot(channel, force(event, value)?))),
            "torque" => {
                for (key, torque) in axes(source, (key, "a torque in Nm"), value, OWN_AXES)? {
                    if let AxisName::Own(axis) = AxisName::of(key) {
                        actions.push(Action::Effect(Effect::Robot(channel, RobotEffect::Torque(axis, torque))));
                    }
                }
            }
            "jog" | "hand" => {
                let robot_effect = if key == "jog" { RobotEffect::Jog } else { RobotEffect::Hand };
                let moved = axes(source, (key, LENGTH), value, ALL_AXES)?.into_iter();
                actions.extend(
                    moved.map(|(key, by)| Action::Effect(Effect::Robot(channel, robot_effect(AxisName::of(key), by)))),
                );
            }
            _ => {}
        }
    }
    Ok(actions)
}

fn edge(event: &Section<'_>) -> Result<Cause, SettingsError> {
    const WHAT: &str = "\"do.3\" (goes on) or \"!do.3\" (goes off), or di, or \"pwm.1\" (is set to something else)";
    let word = event.text("when", WHAT)?.unwrap_or_default();
    let (name, level) = word.strip_prefix('!').map_or((word, true), |name| (name, false));
    let parts = name.split_once('.').and_then(|(kind, channel)| Some((kind, channel.parse::<usize>().ok()?)));
    match parts {
        Some((kind @ ("do" | "di"), channel @ 1..)) => {
            Ok(Cause::Edge { output: kind == "do", channel: channel - 1, level })
        }
        Some(("pwm", channel @ 1..)) if level => Ok(Cause::Pwm(channel - 1)),
        _ => match event.find("when") {
            Some(value) => Err(event.wrong("when", value, WHAT)),
            None => Ok(Cause::At(0.0)),
        },
    }
}

/// The channels under `di` or `ai`, with their values.
fn channels<'a>(
    source: Source<'a>,
    key: &str,
    value: &'a Value<'a>,
) -> Result<Vec<(i32, &'a Value<'a>)>, SettingsError> {
    let DeValue::Table(table) = value.get_ref() else {
        let message = format!("expected a channel, like `{key}.5 = ...`, found {}", kind(value.get_ref()));
        return Err(source.error(value.span(), message));
    };
    let mut channels: Vec<_> = DeTable::iter(table).collect();
    channels.sort_by_key(|(channel, _)| channel.span().start);
    let read = |(channel, value): (&'a Spanned<_>, &'a Value<'a>)| {
        let word: &str = AsRef::as_ref(channel.get_ref() as &std::borrow::Cow<'_, str>);
        match word.parse::<i32>() {
            Ok(number @ 1..) => Ok((number, value)),
            _ => Err(source.error(channel.span(), format!("expected a channel number from 1, found `{key}.{word}`"))),
        }
    };
    channels.into_iter().map(read).collect()
}

fn signals(
    source: Source<'_>,
    key: &str,
    value: &Value<'_>,
    action: fn(i32, bool) -> Action,
    actions: &mut Vec<Action>,
) -> Result<(), SettingsError> {
    for (channel, value) in channels(source, key, value)? {
        let level = value.get_ref().as_bool().ok_or_else(|| {
            let found = kind(value.get_ref());
            source.error(value.span(), format!("`{key}.{channel}`: expected true or false, found {found}"))
        })?;
        actions.push(action(channel, level));
    }
    Ok(())
}

fn analogs(source: Source<'_>, value: &Value<'_>, actions: &mut Vec<Action>) -> Result<(), SettingsError> {
    for (channel, value) in channels(source, "ai", value)? {
        let level = number(value.get_ref()).ok_or_else(|| {
            let found = kind(value.get_ref());
            source.error(value.span(), format!("`ai.{channel}`: expected a number, found {found}"))
        })?;
        actions.push(Action::Analog(channel, level));
    }
    Ok(())
}

/// A force on the TCP.
fn force(event: &Section<'_>, value: &Value<'_>) -> Result<RobotEffect, SettingsError> {
    let wrong = || event.wrong("force", value, "three components in N, like [0, 0, 80]");
    let components = value.get_ref().as_array().ok_or_else(wrong)?;
    let components: Option<Vec<f64>> = components.iter().map(|component| number(component.get_ref())).collect();
    let force = components.and_then(|components| <[f64; 3]>::try_from(components).ok());
    force.map(RobotEffect::Force).ok_or_else(wrong)
}

/// What is done to axes.
fn axes<'a>(
    source: Source<'a>,
    (name, what): (&'a str, &str),
    value: &'a Value<'a>,
    known: &'static [&'static str],
) -> Result<Vec<(&'a str, f64)>, SettingsError> {
    let axes = table(source, value, name, known)?;
    let read = |(key, span, value): (&'a str, std::ops::Range<usize>, &'a Value<'a>)| {
        let number = number(value.get_ref()).ok_or_else(|| {
            let found = kind(value.get_ref());
            source.error(span, format!("`{name}.{key}`: expected {what}, found {found}"))
        });
        Ok((key, number?))
    };
    axes.entries().into_iter().map(read).collect()
}

fn pendant(event: &Section<'_>, source: Source<'_>, value: &Value<'_>) -> Result<Pendant, SettingsError> {
    let word = event.text("pendant", "a word of the teach pendant")?.unwrap_or_default();
    match WORDS.iter().find(|(known, _)| known.eq_ignore_ascii_case(word)) {
        Some((_, pendant)) => Ok(*pendant),
        None => {
            let known = WORDS.map(|(known, _)| known);
            Err(source.error(value.span(), format!("the pendant has no word \"{word}\"; {}", hint(word, &known))))
        }
    }
}

/// A scenario while it plays.
#[derive(Debug)]
pub(crate) struct Playing {
    events: Vec<Event>,
    /// The places of those events that wait for an edge.
    watching: Vec<usize>,
    resets: bool,
    rate: Rate,
    due: Due,
    before_in: Bits,
    before_out: Bits,
    before_pwm: [Pwm; PWM_CHANNELS],
}

impl Playing {
    pub(crate) fn new(scenario: Scenario, image: &Image, rate: Rate) -> Self {
        let events = scenario.events;
        let (mut due, mut watching) = (Due::with_room(events.len() * 4 + 16), Vec::new());
        for (at, event) in events.iter().enumerate() {
            match event.cause {
                Cause::At(time) => due.add(rate.cycles(time), at),
                Cause::Edge { .. } | Cause::Pwm(_) => watching.push(at),
            }
        }
        let reset = Action::Effect(Effect::Pendant(Pendant::Reset));
        let resets = events.iter().any(|event| event.actions.contains(&reset));
        let (before_in, before_out) = (image.inputs().clone(), image.outputs().clone());
        Self { events, watching, resets, rate, due, before_in, before_out, before_pwm: image.pwms() }
    }

    /// How many effects a cycle may have at most, if no event comes twice in it.
    pub(crate) fn max_effects(&self) -> usize {
        let actions = self.events.iter().flat_map(|event| &event.actions);
        actions.filter(|action| matches!(action, Action::Effect(_))).count()
    }

    /// Sets what is due at the start of `cycle`; hands everything but inputs to `do_it`.
    pub(crate) fn play(&mut self, cycle: u64, image: &mut Image, mut do_it: impl FnMut(Effect)) {
        if self.events.is_empty() {
            return;
        }
        self.find_edges(cycle, image);
        while let Some(at) = self.due.take(cycle) {
            for action in self.events.get(at).map(|event| event.actions.as_slice()).unwrap_or_default() {
                action.play(image, &mut do_it);
            }
        }
    }

    /// Whether somebody at the pendant makes programs begin again that have ended.
    pub(crate) fn resets(&self) -> bool {
        self.resets
    }

    /// Whether an event is on its way, or will be in the next cycle by what has changed in this one.
    pub(crate) fn goes_on(&self, image: &Image) -> bool {
        !self.due.is_empty() || self.watched().any(|(_, event)| self.has_edge(event, image))
    }

    /// The events that wait for an edge, with their places.
    fn watched(&self) -> impl Iterator<Item = (usize, &Event)> {
        self.watching.iter().filter_map(|at| Some((*at, self.events.get(*at)?)))
    }

    /// Whether an event is set off by what has changed since the last cycle.
    fn has_edge(&self, event: &Event, image: &Image) -> bool {
        match event.cause {
            Cause::At(_) => false,
            Cause::Edge { output, channel, level } => {
                let (before, now) =
                    if output { (&self.before_out, image.outputs()) } else { (&self.before_in, image.inputs()) };
                before.get(channel) != level && now.get(channel) == level
            }
            Cause::Pwm(channel) => self.before_pwm.get(channel) != image.pwms().get(channel),
        }
    }

    fn find_edges(&mut self, cycle: u64, image: &Image) {
        let mut due = std::mem::take(&mut self.due);
        for (at, event) in self.watched().filter(|(_, event)| self.has_edge(event, image)) {
            // The outside has seen the edge at the end of the cycle before.
            due.add(cycle.saturating_sub(1) + self.rate.cycles(event.after), at);
        }
        self.due = due;
        self.before_pwm = image.pwms();
        self.before_in.copy_from(image.inputs());
        self.before_out.copy_from(image.outputs());
    }
}

/// Events on their way: the earliest comes first, and those of one cycle in the order in which they were set off.
#[derive(Default, Debug)]
struct Due {
    /// Cycle, how many were set off before, and the event.
    waiting: BinaryHeap<Reverse<(u64, u64, usize)>>,
    added: u64,
}

impl Due {
    fn with_room(room: usize) -> Self {
        Self { waiting: BinaryHeap::with_capacity(room), added: 0 }
    }

    fn add(&mut self, cycle: u64, event: usize) {
        self.waiting.push(Reverse((cycle, self.added, event)));
        self.added += 1;
    }

    /// The next event that is due in a cycle or was due before.
    fn take(&mut self, cycle: u64) -> Option<usize> {
        let Reverse((when, ..)) = self.waiting.peek()?;
        if *when > cycle {
            return None;
        }
        self.waiting.pop().map(|Reverse((_, _, event))| event)
    }

    fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn play(text: &str, cycles: u64, mut each: impl FnMut(u64, &mut Image)) -> Vec<Effect> {
        let scenario = Scenario::parse("io.toml", text).unwrap();
        scenario.check(&Channels::default(), &[&Robot::builtin("kr10-r1420").unwrap()]).unwrap();
        let mut image = Image::new(&Channels::default());
        let mut playing = Playing::new(scenario, &image, Rate::default());
        let mut effects = Vec::new();
        for cycle in 0..cycles {
            playing.play(cycle, &mut image, |effect| effects.push(effect));
            each(cycle, &mut image);
        }
        effects
    }

    #[test]
    fn events_come_at_their_time() {
        let text = "[[event]]\nat = 0.005\ndi.5 = true\nai.2 = 4.5\n[[event]]\nat = 0.002\ndi.5 = false\ndi.6 = true\n";
        let mut seen = Vec::new();
        play(text, 8, |_, image| {
            seen.push((image.digitals(Digital::Di, 5, 6).unwrap(), image.ai(2).unwrap()));
        });
        assert_eq!(seen, [(0, 0.0), (0, 0.0), (2, 0.0), (2, 0.0), (2, 0.0), (3, 4.5), (3, 4.5), (3, 4.5)]);
    }

    #[test]
    fn edges_set_off_events_every_time() {
        let text =
            "[[event]]\nwhen = \"do.3\"\nafter = 0.002\ndi.1 = true\n[[event]]\nwhen = \"!do.3\"\ndi.1 = false\n";
        let mut seen = Vec::new();
        play(text, 12, |cycle, image| {
            if cycle.is_multiple_of(4) {
                image.set_digital(Digital::Do, 3, cycle % 8 == 0).unwrap();
            }
            seen.push(image.digital(Digital::Di, 1).unwrap());
        });
        let on = [2, 3, 4, 10, 11];
        let expected: Vec<bool> = (0..12).map(|cycle| on.contains(&cycle)).collect();
        assert_eq!(seen, expected);
    }

    #[test]
    fn the_pendant_speaks() {
        let text = "[[event]]\nat = 0\npendant = \"start\"\noverride = 50\n";
        assert_eq!(play(text, 1, |_, _| {}), [Pendant::Start, Pendant::Override(50.0)].map(Effect::Pendant));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("[[event]]\nat = 1\ndi.5 = 1", 3, "`di.5`: expected true or false, found the number 1"),
            ("[[event]]\nat = 1\ndo.5 = true", 3, "did you mean `di`?"),
            ("[[event]]\nat = 1\ndi.x = true", 3, "a channel number from 1"),
            ("[[event]]\ndi.5 = true", 1, "neither `at` nor `when`"),
            ("[[event]]\nat = 1\nwhen = \"do.1\"\ndi.5 = true", 1, "both `at` and `when`"),
            ("[[event]]\nat = 1\nafter = 1\ndi.5 = true", 3, "counts from `when`"),
            ("[[event]]\nat = 1", 1, "changes nothing"),
            ("[[event]]\nwhen = \"do3\"\ndi.5 = true", 2, "expected \"do.3\""),
            ("[[event]]\nwhen = \"!pwm.1\"\ndi.5 = true", 2, "\"pwm.1\" (is set to something else)"),
            ("[[event]]\nat = -1\ndi.5 = true", 2, "expected seconds"),
            ("[[event]]\nat = 1\npendant = \"strat\"", 3, "did you mean `start`?"),
            ("[[event]]\nat = 1\npendant = \"servo\"", 3, "the pendant has no word"),
            ("[[event]]\nat = 1\njog.j1 = true", 3, "`jog.j1`: expected deg"),
            ("[[event]]\nat = 1\noverride = 101", 3, "expected percent from 0 to 100"),
            ("[[event]]\nat = 1\nforce = [1, 2]", 3, "three components in N"),
            ("[[event]]\nat = 1\nforce = 80", 3, "three components in N"),
            ("[[event]]\nat = 1\ntorque.j7 = 80", 3, "did you mean `j1`?"),
            ("[[event]]\nat = 1\ntorque.j3 = \"much\"", 3, "`torque.j3`: expected a torque in Nm"),
            ("[[event]]\nat = 1\ntorque = 3", 3, "expected the table torque"),
            ("[[events]]\nat = 1", 1, "did you mean `event`?"),
            ("event = 3", 1, "[[event]]"),
            ("[[event]\n", 1, "not TOML"),
        ] {
            let error = Scenario::parse("io.toml", text).unwrap_err();
            assert_eq!(error.line, line, "{text}: {error}");
            assert!(error.message.contains(words), "{text}: {error}");
        }
    }

    #[test]
    fn forces_and_torques_are_told_in_order() {
        let text = "[[event]]\nat = 0\ntorque.j3 = -20.5\nforce = [1, 2.5, -3]\ntorque.j1 = 7\n";
        let effects =
            [RobotEffect::Torque(2, -20.5), RobotEffect::Torque(0, 7.0), RobotEffect::Force([1.0, 2.5, -3.0])];
        assert_eq!(play(text, 1, |_, _| {}), effects.map(|robot_effect| Effect::Robot(1, robot_effect)));
    }

    #[test]
    fn events_name_the_channel_of_their_robot() {
        let scenario = Scenario::parse("io.toml", "[[event]]\nat = 1\nchannel = 2\ntorque.j5 = 1").unwrap();
        let (six, four) = (Robot::builtin("kr10-r1420").unwrap(), Robot::builtin("hsr065").unwrap());
        let check = |robots: &[&Robot]| scenario.check(&Channels::default(), robots);
        assert_eq!(check(&[&four, &six]), Ok(()));
        assert!(check(&[&six, &four]).unwrap_err().contains("robot hsr065 has j1 to j4"));
        assert!(check(&[&six]).unwrap_err().contains("channel 2, but there are 1 channels"));
        for channel in [0, 7] {
            let text = format!("[[event]]\nat = 1\nchannel = {channel}\ntorque.j5 = 1");
            let error = Scenario::parse("io.toml", &text).unwrap_err();
            assert!(error.line == 3 && error.message.contains("a channel with a robot from"), "{error}");
        }
    }

    #[test]
    fn a_scenario_goes_on_until_nothing_is_on_its_way() {
        let text =
            "[[event]]\nat = 0.002\ndi.1 = true\n[[event]]\nwhen = \"di.1\"\nafter = 0.003\npendant = \"reset\"\n";
        let scenario = Scenario::parse("io.toml", text).unwrap();
        let mut image = Image::new(&Channels::default());
        let mut playing = Playing::new(scenario, &image, Rate::default());
        assert!(playing.resets());
        let on_its_way: Vec<bool> = (0..8)
            .map(|cycle| {
                playing.play(cycle, &mut image, |_| {});
                playing.goes_on(&image)
            })
            .collect();
        // In cycle 2 the input goes on, in 3 that is seen, and 3 ms behind cycle 2 the button is pressed.
        assert_eq!(on_its_way, [true, true, true, true, true, false, false, false]);
    }

    #[test]
    fn axes_and_masses_must_exist() {
        let scenario = Scenario::parse("io.toml", "[[event]]\nat = 1\ntorque.j5 = 1").unwrap();
        let scara = Robot::builtin("hsr065").unwrap();
        let error = scenario.check(&Channels::default(), &[&scara]).unwrap_err();
        assert!(error.contains("turns j5, but robot hsr065 has j1 to j4"), "{error}");
        let robot = Robot { links: Vec::new(), ..Robot::builtin("kr10-r1420").unwrap() };
        let error = scenario.check(&Channels::default(), &[&robot]).unwrap_err();
        assert!(error.contains("has no [[link]]"), "{error}");
    }

    #[test]
    fn channels_must_exist() {
        for (text, words) in [
            ("[[event]]\nat = 1\ndi.65 = true", "DI 65 does not exist"),
            ("[[event]]\nat = 1\nai.9 = 1", "AI 9 does not exist"),
            ("[[event]]\nwhen = \"do.65\"\ndi.1 = true", "do.65, but there are 64"),
            ("[[event]]\nwhen = \"pwm.4\"\ndi.1 = true", "pwm.4, but there are 3"),
        ] {
            let scenario = Scenario::parse("io.toml", text).unwrap();
            let error = scenario.check(&Channels::default(), &[&Robot::builtin("kr10-r1420").unwrap()]).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
