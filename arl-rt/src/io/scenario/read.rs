//! Reads scenarios and orders from TOML, and reports errors in them.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Action, AxisName, Cause, Effect, Event, Pendant, RobotEffect};
use crate::cycle::channel_id::MOST_FOREGROUND;
use crate::io::Digital;
use arl_motion::Override;
use arl_robot::cell::{Names, Signal, SignalKind};
use arl_robot::settings::{Section, SettingsError, Source, Value, hint, kind, number, table};

/// The keys of an event; an order has all but the first three.
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

/// The keys of digital channels.
const SIGNALS: [(&str, Digital); 3] =
    [("di", Digital::Di), ("internal", Digital::InternalIn), ("internal_do", Digital::InternalOut)];

/// What an event may change.
const CHANGES: &str = "`di.N`, `ai.N`, `internal.N`, `internal_do.N`, `pendant`, `override`, `force`, `torque.jN`, `jog.jN` \
                       or `hand.jN`";

/// The pendant actions that a scenario may use.
const WORDS: [(&str, Pendant); 8] = [
    ("start", Pendant::Start),
    ("pause", Pendant::Pause),
    ("step", Pendant::Step),
    ("reset", Pendant::Reset),
    ("clear", Pendant::Clear),
    ("servo_on", Pendant::ServoOn),
    ("servo_off", Pendant::ServoOff),
    ("emergency_stop", Pendant::EmergencyStop),
];

/// The keys of a `follow` table.
const FOLLOW: &[&str] = &["signal", "of", "after"];

/// The cell's names of signals, and the keys of an event including these names.
struct Words<'a> {
    names: &'a Names,
    event: Vec<&'a str>,
}

impl<'a> Words<'a> {
    fn new(names: &'a Names) -> Self {
        Self { names, event: EVENT.iter().copied().chain(names.iter().map(|(_, name)| name)).collect() }
    }

    /// The signal with this name or notation, such as `di.5`.
    fn signal(&self, text: &str) -> Option<Signal> {
        self.names.signal(text).or_else(|| Signal::parse(text))
    }
}

/// The actions of an order.
pub(super) fn order(text: &str, names: &Names) -> Result<Vec<Action>, SettingsError> {
    let source = Source { file: "order", text };
    let root = source.parse().map_err(|error| {
        // A user who types an order need not know the file format.
        let text =
            format!("this is not an order, such as `di.5 = true`, `ai.2 = 4.2` or `override = 50`: {}", error.message);
        SettingsError { message: text.replace(": this is not TOML", ""), ..error }
    })?;
    let words = Words::new(names);
    let known = words.event.get(3..).unwrap_or_default();
    let actions = actions(source, &Section::new(source, "an order", root.get_ref(), known)?, &words)?;
    if actions.is_empty() {
        return Err(SettingsError::of_file("order", format!("this order changes nothing: expected {CHANGES}")));
    }
    Ok(actions)
}

/// The events of a scenario.
pub(super) fn scenario(file: &str, text: &str, names: &Names) -> Result<Vec<Event>, SettingsError> {
    let words = Words::new(names);
    // Parsing a long text as a whole takes many times its size in memory, so it is read table by table. Only the whole
    // shows where mistakes are, and whether the parts together would mean something else.
    match by_tables(file, text, &words) {
        Some(events) => Ok(events),
        None => events(Source { file, text }, 1, &words, &mut Followers::new()),
    }
}

/// The events, if nothing precedes the first table, no string has several lines, and there is no mistake.
fn by_tables(file: &str, text: &str, words: &Words<'_>) -> Option<Vec<Event>> {
    if text.contains("\"\"\"") || text.contains("'''") {
        return None;
    }
    let mut tables = tables_of(text);
    let before = Source { file, text: tables.next()? };
    if !before.parse().ok()?.get_ref().is_empty() {
        return None;
    }
    let mut line = 1 + count_lines(before.text);
    let (mut found, mut followers) = (Vec::new(), Followers::new());
    for text in tables {
        found.extend(events(Source { file, text }, line, words, &mut followers).ok()?);
        line += count_lines(text);
    }
    Some(found)
}

fn count_lines(text: &str) -> u32 {
    text.bytes().filter(|byte| *byte == b'\n').count() as u32
}

/// Splits a text into parts: the text before the first line that begins a table, then each table.
fn tables_of(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    let mut is_first = true;
    std::iter::from_fn(move || {
        let text = rest?;
        // The line that begins a table belongs to it, not to the next one.
        let own = if std::mem::take(&mut is_first) { 0 } else { text.find('\n').map_or(text.len(), |end| end + 1) };
        let begins = |line: &str| TABLES.iter().any(|table| line.trim_start().starts_with(table));
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

/// The first lines of tables.
const TABLES: [&str; 2] = ["[[event]]", "[[follow]]"];

/// The inputs that follow other signals, with the lines of their tables.
type Followers = Vec<((Digital, i32), u32)>;

/// The events of a text that begins at this line of its file; followers become events, too.
fn events(
    source: Source<'_>,
    first_line: u32,
    words: &Words<'_>,
    followers: &mut Followers,
) -> Result<Vec<Event>, SettingsError> {
    let root = source.parse()?;
    let top = Section::new(source, "the io scenario", root.get_ref(), &["event", "follow"])?;
    let line = |value: &Value<'_>| first_line + source.line(value.span().start) - 1;
    let mut all = Vec::new();
    for value in array(&top, "event", "tables that begin with [[event]]")? {
        all.push(event(source, value, line(value), words)?);
    }
    for value in array(&top, "follow", "tables that begin with [[follow]]")? {
        all.extend(follow(source, value, line(value), words, followers)?);
    }
    // Of two events at the same time the one further down in the file comes last.
    all.sort_by_key(|event| event.line);
    Ok(all)
}

/// The items of a list of tables; empty if it is missing.
fn array<'a>(top: &Section<'a>, key: &str, what: &str) -> Result<&'a [Value<'a>], SettingsError> {
    let Some(found) = top.find(key) else { return Ok(&[]) };
    found.get_ref().as_array().map(|array| &array[..]).ok_or_else(|| top.wrong(key, found, what))
}

/// The events that make an input follow the level of another signal, after a delay.
fn follow(
    source: Source<'_>,
    value: &Value<'_>,
    line: u32,
    words: &Words<'_>,
    followers: &mut Followers,
) -> Result<[Event; 3], SettingsError> {
    const SIGNAL: &str = "an input, like \"di.2\"";
    const OF: &str = "a digital signal, like \"do.2\", or \"!do.2\" for its opposite";
    let section = table(source, value, "[[follow]]", FOLLOW)?;
    let after = section.number("after", "seconds", 0.0, 1e9)?.unwrap_or(0.0);
    let asked = |key, what: &str| match section.text(key, what)? {
        Some(text) => Ok(text),
        None => Err(source.error(value.span(), format!("[[follow]] lacks `{key}`: {what}"))),
    };
    let wrong = |key: &str, what: &str| match section.find(key) {
        Some(value) => section.wrong(key, value, what),
        None => source.error(value.span(), format!("[[follow]] lacks `{key}`")),
    };
    let input = words.signal(asked("signal", SIGNAL)?).and_then(|signal| digital_input(signal.kind, signal.channel));
    let (what, channel) = input.ok_or_else(|| wrong("signal", SIGNAL))?;
    let of = asked("of", OF)?;
    let (name, same) = of.strip_prefix('!').map_or((of, true), |name| (name, false));
    let (output, followed) = words.signal(name).and_then(digital_edge).ok_or_else(|| wrong("of", OF))?;
    if what == Digital::Di && !output && channel as usize == followed + 1 {
        return Err(wrong("of", "a signal other than the one that follows"));
    }
    if let Some((_, before)) = followers.iter().find(|(known, _)| *known == (what, channel)) {
        return Err(wrong(
            "signal",
            &format!("an input that follows no signal yet (line {before} makes it follow one)"),
        ));
    }
    followers.push(((what, channel), line));
    let event = |cause, after, level| {
        let actions = vec![Action::Digital(what, channel, level)];
        Event { cause, after, actions, line }
    };
    let edge = |level| Cause::Edge { output, channel: followed, level };
    // Before the program starts, all outputs are off.
    Ok([event(Cause::At(0.0), 0.0, !same), event(edge(true), after, same), event(edge(false), after, !same)])
}

/// The input that a scenario sets.
fn digital_input(kind: SignalKind, channel: u32) -> Option<(Digital, i32)> {
    let what = match kind {
        SignalKind::DigitalInput => Digital::Di,
        SignalKind::InternalInput => Digital::InternalIn,
        SignalKind::InternalOutput => Digital::InternalOut,
        SignalKind::DigitalOutput | SignalKind::AnalogInput | SignalKind::AnalogOutput => return None,
    };
    Some((what, i32::try_from(channel).ok()?))
}

/// The signal of an edge: whether it is an output, and its channel, from 0.
fn digital_edge(signal: Signal) -> Option<(bool, usize)> {
    let output = match signal.kind {
        SignalKind::DigitalOutput => true,
        SignalKind::DigitalInput => false,
        _ => return None,
    };
    Some((output, signal.channel as usize - 1))
}

/// The event that a table describes.
fn event(source: Source<'_>, value: &Value<'_>, line: u32, words: &Words<'_>) -> Result<Event, SettingsError> {
    let event = table(source, value, "[[event]]", &words.event)?;
    let after = event.number("after", "seconds", 0.0, 1e9)?;
    let cause = match (event.number("at", "seconds", 0.0, 1e9)?, event.text("when", "\"do.3\" or \"!do.3\"")?) {
        (Some(at), None) => Cause::At(at),
        (None, Some(_)) => edge(&event, words)?,
        (at, _) => {
            let found = if at.is_some() { "both `at` and `when`" } else { "neither `at` nor `when`" };
            let message = format!("[[event]] has {found}: one of them must say when it happens");
            return Err(source.error(value.span(), message));
        }
    };
    if let (Cause::At(_), Some((_, span, _))) = (cause, event.entries().into_iter().find(|(key, ..)| *key == "after")) {
        return Err(source.error(span, "`after` counts from `when`; with `at`, add the seconds there"));
    }
    let actions = actions(source, &event, words)?;
    if actions.is_empty() {
        return Err(source.error(value.span(), format!("[[event]] changes nothing: expected {CHANGES}")));
    }
    Ok(Event { cause, after: after.unwrap_or(0.0), actions, line })
}

/// The axes that a torque can act on; below, those that can be moved.
const OWN_AXES: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6"];
const ALL_AXES: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
/// The largest force or torque, in N and Nm, and the largest distance of an axis, in deg or mm.
const MOST: f64 = 1e6;
/// The unit of the distance by which an axis is moved.
const LENGTH: &str = "deg, or mm of a linear axis";

/// The actions of an event.
fn actions(source: Source<'_>, event: &Section<'_>, words: &Words<'_>) -> Result<Vec<Action>, SettingsError> {
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
            "ai" => analogs(source, value, &mut actions)?,
            "pendant" => actions.push(Action::Effect(Effect::Pendant(pendant(event, source, value)?))),
            "override" => {
                let percent = event.number(key, "percent", 0.0, 100.0)?.unwrap_or(100.0);
                let speed = Override::from_percent(percent).map_err(|error| source.error(0..0, error.to_string()))?;
                actions.push(Action::Effect(Effect::Pendant(Pendant::Override(speed))));
            }
            "force" => actions.push(Action::Effect(Effect::Robot(channel, force(event, value)?))),
            "torque" => {
                for (key, torque) in axes(source, key, "a torque in Nm", value, OWN_AXES)? {
                    if let AxisName::Own(axis) = axis_name(key) {
                        actions.push(Action::Effect(Effect::Robot(channel, RobotEffect::Torque(axis, torque))));
                    }
                }
            }
            "jog" | "hand" => {
                let robot_effect = if key == "jog" { RobotEffect::Jog } else { RobotEffect::Hand };
                let moved = axes(source, key, LENGTH, value, ALL_AXES)?.into_iter();
                actions.extend(
                    moved.map(|(key, by)| Action::Effect(Effect::Robot(channel, robot_effect(axis_name(key), by)))),
                );
            }
            _ => {
                if let Some((_, what)) = SIGNALS.iter().find(|(name, _)| *name == key) {
                    signals(source, key, *what, value, &mut actions)?;
                } else if let Some(signal) = words.names.signal(key) {
                    actions.push(named(source, key, signal, value)?);
                }
            }
        }
    }
    Ok(actions)
}

/// The action on a signal that has a name in the cell.
fn named(source: Source<'_>, name: &str, signal: Signal, value: &Value<'_>) -> Result<Action, SettingsError> {
    let found = || kind(value.get_ref());
    let wrong = |text: String| source.error(value.span(), text);
    if signal.kind == SignalKind::AnalogInput {
        let level = number(value.get_ref());
        let channel = i32::try_from(signal.channel).unwrap_or(i32::MAX);
        let level =
            level.ok_or_else(|| wrong(format!("`{name}` is {signal}: expected a number, found {}", found())))?;
        return Ok(Action::Analog(channel, level));
    }
    let Some((what, channel)) = digital_input(signal.kind, signal.channel) else {
        return Err(wrong(format!("`{name}` is {signal}, an output: a scenario sets inputs")));
    };
    let level = value.get_ref().as_bool();
    let level =
        level.ok_or_else(|| wrong(format!("`{name}` is {signal}: expected true or false, found {}", found())))?;
    Ok(Action::Digital(what, channel, level))
}

/// The cause in `when`.
fn edge(event: &Section<'_>, words: &Words<'_>) -> Result<Cause, SettingsError> {
    const WHAT: &str = "\"do.3\" (goes on) or \"!do.3\" (goes off), or di, or \"pwm.1\" (changes)";
    let word = event.text("when", WHAT)?.unwrap_or_default();
    let (name, level) = word.strip_prefix('!').map_or((word, true), |name| (name, false));
    if let Some((output, channel)) = words.signal(name).and_then(digital_edge) {
        return Ok(Cause::Edge { output, channel, level });
    }
    match name.strip_prefix("pwm.").and_then(|channel| channel.parse::<usize>().ok()) {
        Some(channel @ 1..) if level => Ok(Cause::Pwm(channel - 1)),
        _ => match event.find("when") {
            Some(value) => Err(event.wrong("when", value, WHAT)),
            None => Ok(Cause::At(0.0)),
        },
    }
}

/// The channels under a key like `di` or `ai`, with their values.
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

/// Reads the digital channels of a key.
fn signals(
    source: Source<'_>,
    key: &str,
    what: Digital,
    value: &Value<'_>,
    actions: &mut Vec<Action>,
) -> Result<(), SettingsError> {
    for (channel, value) in channels(source, key, value)? {
        let level = value.get_ref().as_bool().ok_or_else(|| {
            let found = kind(value.get_ref());
            source.error(value.span(), format!("`{key}.{channel}`: expected true or false, found {found}"))
        })?;
        actions.push(Action::Digital(what, channel, level));
    }
    Ok(())
}

/// Reads the values of analog inputs.
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

/// Reads a force on the TCP.
fn force(event: &Section<'_>, value: &Value<'_>) -> Result<RobotEffect, SettingsError> {
    let wrong = || event.wrong("force", value, "three components in N, like [0, 0, 80], none above 1e6");
    let components = value.get_ref().as_array().ok_or_else(wrong)?;
    let components: Option<Vec<f64>> = components.iter().map(|component| number(component.get_ref())).collect();
    let force = components.and_then(|components| <[f64; 3]>::try_from(components).ok());
    let force = force.filter(|force| force.iter().all(|component| component.abs() <= MOST));
    force.map(RobotEffect::Force).ok_or_else(wrong)
}

/// Reads the axes of a key, with their numbers.
fn axes<'a>(
    source: Source<'a>,
    name: &'a str,
    what: &str,
    value: &'a Value<'a>,
    known: &'static [&'static str],
) -> Result<Vec<(&'a str, f64)>, SettingsError> {
    let axes = table(source, value, name, known)?;
    let read = |(key, span, value): (&'a str, std::ops::Range<usize>, &'a Value<'a>)| {
        let number = number(value.get_ref()).filter(|number| number.abs() <= MOST);
        let number = number.ok_or_else(|| {
            let found = kind(value.get_ref());
            source.error(span, format!("`{name}.{key}`: expected {what}, from -{MOST} to {MOST}, found {found}"))
        });
        Ok((key, number?))
    };
    axes.entries().into_iter().map(read).collect()
}

/// The axis with one of the names above.
fn axis_name(key: &str) -> AxisName {
    let number = |digits: &str| digits.parse::<usize>().unwrap_or(1).saturating_sub(1);
    match key.strip_prefix("ej") {
        Some(digits) => AxisName::External(number(digits)),
        None => AxisName::Own(number(key.trim_start_matches('j'))),
    }
}

fn pendant(event: &Section<'_>, source: Source<'_>, value: &Value<'_>) -> Result<Pendant, SettingsError> {
    let word = event.text("pendant", "a button of the teach pendant")?.unwrap_or_default();
    match WORDS.iter().find(|(known, _)| known.eq_ignore_ascii_case(word)) {
        Some((_, pendant)) => Ok(*pendant),
        None => {
            let known = WORDS.map(|(known, _)| known);
            Err(source.error(value.span(), format!("the pendant has no button \"{word}\"; {}", hint(word, &known))))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::cell::Cell;

    #[test]
    fn no_signal_is_called_as_a_word_of_scenarios() {
        let tables = TABLES.map(|table| table.trim_matches(['[', ']']));
        for word in EVENT.iter().copied().chain(FOLLOW.iter().copied()).chain(tables) {
            let error = Cell::parse("cell.toml", &format!("[names]\n\"di.1\" = \"{word}\"\n")).unwrap_err();
            assert!(error.message.contains("is a keyword of scenarios"), "{error}");
        }
    }
}
