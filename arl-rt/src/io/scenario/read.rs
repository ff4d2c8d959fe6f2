//! Reads scenarios and orders: what their TOML may say, and what is wrong with it.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Action, AxisName, Cause, Effect, Event, Pendant, RobotEffect};
use crate::cycle::channel_id::MOST_FOREGROUND;
use crate::io::Digital;
use arl_robot::settings::{Section, SettingsError, Source, Value, hint, kind, number, table};

/// The keys of an event; an order has those behind the first three.
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

/// The keys with channels that are on or off.
const SIGNALS: [(&str, Digital); 3] =
    [("di", Digital::Di), ("internal", Digital::InternalIn), ("internal_do", Digital::InternalOut)];

/// What an event may change.
const CHANGES: &str = "`di.N`, `ai.N`, `internal.N`, `internal_do.N`, `pendant`, `override`, `force`, `torque.jN`, `jog.jN` \
                       or `hand.jN`";

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

/// The actions of an order.
pub(super) fn order(text: &str) -> Result<Vec<Action>, SettingsError> {
    let source = Source { file: "order", text };
    let root = source.parse()?;
    let actions = actions(source, &Section::new(source, "an order", root.get_ref(), &EVENT[3..])?)?;
    if actions.is_empty() {
        return Err(SettingsError::of_file("order", format!("an order changes nothing: expected {CHANGES}")));
    }
    Ok(actions)
}

/// The events of a scenario.
pub(super) fn scenario(file: &str, text: &str) -> Result<Vec<Event>, SettingsError> {
    // As a whole, a long text takes many times its size, so it is read table by table. Only the whole tells where mistakes
    // are, and whether the parts would mean something else together.
    match by_tables(file, text) {
        Some(events) => Ok(events),
        None => events(Source { file, text }),
    }
}

/// The events, where nothing stands in front of the first table, no text has several lines, and there is no mistake.
fn by_tables(file: &str, text: &str) -> Option<Vec<Event>> {
    if text.contains("\"\"\"") || text.contains("'''") {
        return None;
    }
    let mut tables = tables_of(text);
    let before = Source { file, text: tables.next()? };
    if !before.parse().ok()?.get_ref().is_empty() {
        return None;
    }
    let mut found = Vec::new();
    for text in tables {
        found.extend(events(Source { file, text }).ok()?);
    }
    Some(found)
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

/// The event that a table describes.
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

/// The axes that a torque can turn, and those that can be moved.
const OWN_AXES: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6"];
const ALL_AXES: &[&str] = &["j1", "j2", "j3", "j4", "j5", "j6", "ej1", "ej2", "ej3", "ej4", "ej5", "ej6"];
/// By how much an axis is moved.
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
            "ai" => analogs(source, value, &mut actions)?,
            "pendant" => actions.push(Action::Effect(Effect::Pendant(pendant(event, source, value)?))),
            "override" => {
                let percent = event.number(key, "percent", 0.0, 100.0)?.unwrap_or(100.0);
                actions.push(Action::Effect(Effect::Pendant(Pendant::Override(percent))));
            }
            "force" => actions.push(Action::Effect(Effect::Robot(channel, force(event, value)?))),
            "torque" => {
                for (key, torque) in axes(source, (key, "a torque in Nm"), value, OWN_AXES)? {
                    if let AxisName::Own(axis) = axis_name(key) {
                        actions.push(Action::Effect(Effect::Robot(channel, RobotEffect::Torque(axis, torque))));
                    }
                }
            }
            "jog" | "hand" => {
                let robot_effect = if key == "jog" { RobotEffect::Jog } else { RobotEffect::Hand };
                let moved = axes(source, (key, LENGTH), value, ALL_AXES)?.into_iter();
                actions.extend(
                    moved.map(|(key, by)| Action::Effect(Effect::Robot(channel, robot_effect(axis_name(key), by)))),
                );
            }
            _ => {
                if let Some((_, what)) = SIGNALS.iter().find(|(name, _)| *name == key) {
                    signals(source, (key, *what), value, &mut actions)?;
                }
            }
        }
    }
    Ok(actions)
}

/// What `when` waits for.
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

/// The channels of a key that are on or off.
fn signals(
    source: Source<'_>,
    (key, what): (&str, Digital),
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

/// The levels of analog inputs.
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

/// The axis of one of the names above.
fn axis_name(key: &str) -> AxisName {
    let number = |digits: &str| digits.parse::<usize>().unwrap_or(1).saturating_sub(1);
    match key.strip_prefix("ej") {
        Some(digits) => AxisName::External(number(digits)),
        None => AxisName::Own(number(key.trim_start_matches('j'))),
    }
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
