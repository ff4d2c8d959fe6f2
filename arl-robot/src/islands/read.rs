//! Reads islands from the tables of the cell file.

use std::collections::HashSet;
use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

use super::{Analog, Bit, Island, Lost, Points, Rest, Scale, Table};
use crate::channels::{AnalogType, Channels};
use crate::settings::{Section, SettingsError, Source, Value, number, table};

const ISLAND: &[&str] =
    &["name", "address", "port", "unit", "poll", "timeout", "lost", "inputs", "end", "di", "do", "ai", "ao"];

/// The keys of an entry of `di`, `do`, `ai` or `ao`: the tables that it may name, and further keys.
struct Direction {
    key: &'static str,
    name: &'static str,
    tables: &'static [Table],
    known: &'static [&'static str],
}

const DI: Direction = Direction {
    key: "di",
    name: "`di` of [[island]]",
    tables: &Table::ALL,
    known: &["channel", "count", "bit", "coil", "discrete_input", "holding_register", "input_register"],
};
const DO: Direction = Direction {
    key: "do",
    name: "`do` of [[island]]",
    tables: &[Table::Coil, Table::HoldingRegister],
    known: &["channel", "count", "bit", "coil", "holding_register"],
};
const AI: Direction = Direction {
    key: "ai",
    name: "`ai` of [[island]]",
    tables: &[Table::HoldingRegister, Table::InputRegister],
    known: &["channel", "count", "raw", "holding_register", "input_register"],
};
const AO: Direction = Direction {
    key: "ao",
    name: "`ao` of [[island]]",
    tables: &[Table::HoldingRegister],
    known: &["channel", "count", "raw", "holding_register"],
};

/// The most coils or registers of a table.
const ADDRESSES: u32 = 1 << 16;

impl Island {
    /// The islands of a cell file with these channels.
    ///
    /// # Errors
    /// The values are not islands, or they have channels that the cell does not have.
    pub fn read_all(
        source: Source<'_>,
        islands: Option<&Value<'_>>,
        channels: &Channels,
    ) -> Result<Vec<Island>, SettingsError> {
        let Some(found) = islands else { return Ok(Vec::new()) };
        let tables = found.get_ref().as_array().ok_or_else(|| {
            source.error(found.span(), "`island` of the cell file: expected tables that begin with [[island]]")
        })?;
        let mut taken = Taken::default();
        tables.iter().map(|value| island(source, value, channels, &mut taken)).collect()
    }
}

/// Names and signals that must be unique.
#[derive(Default)]
struct Taken {
    names: HashSet<String>,
    /// The input channels of all islands.
    inputs: HashSet<(&'static str, usize)>,
    /// The places that this island's outputs write: table, address, bit; a whole register counts with all its bits.
    written: HashSet<(Table, u16, u8)>,
}

fn island(
    source: Source<'_>,
    value: &Value<'_>,
    channels: &Channels,
    taken: &mut Taken,
) -> Result<Island, SettingsError> {
    let section = table(source, value, "[[island]]", ISLAND)?;
    let whole = |message: String| source.error(value.span(), message);
    let address = address(&section)?.ok_or_else(|| whole(format!("[[island]] lacks `address`: {ADDRESS}")))?;
    let port = section.count("port", "a TCP port", u16::MAX.into())?.unwrap_or(502);
    if port == 0 {
        return Err(whole("`port` of [[island]]: expected a TCP port from 1 to 65535, found 0".into()));
    }
    let address = SocketAddr::new(address, port as u16);
    let name = section.text("name", "a name for messages")?.map_or_else(|| address.to_string(), str::to_owned);
    if name.trim().is_empty() || !taken.names.insert(name.clone()) {
        let place = section.find("name").map_or_else(|| value.span(), toml::Spanned::span);
        let message = format!("there is another island with the name \"{name}\": expected a unique name");
        return Err(source.error(place, message));
    }
    let unit = section.count("unit", "a unit number", 255)?.unwrap_or(1) as u8;
    let poll = section.number("poll", "ms from one exchange to the next", 1.0, 10_000.0)?.unwrap_or(10.0);
    let timeout = section.number("timeout", "ms that an answer may take", 10.0, 10_000.0)?.unwrap_or(500.0);
    let lost = section.word("lost", &[("alarm", Lost::Alarm), ("warning", Lost::Warning)])?;
    let inputs = section.word("inputs", RESTS)?.unwrap_or(Rest::Zero);
    let end = section.word("end", RESTS)?.unwrap_or(Rest::Zero);
    taken.written.clear();
    let points = Points {
        di: bits(&section, &DI, channels.di, taken)?,
        dout: bits(&section, &DO, channels.dout, taken)?,
        ai: analogs(&section, &AI, &channels.ai, taken)?,
        ao: analogs(&section, &AO, &channels.ao, taken)?,
    };
    if points == Points::default() {
        let message = "[[island]] has no channels: expected `di`, `do`, `ai` or `ao`, like \
                       `di = [{ channel = 1, count = 8, discrete_input = 0 }]`";
        return Err(whole(message.into()));
    }
    let (poll, timeout) = (Duration::from_secs_f64(poll / 1e3), Duration::from_secs_f64(timeout / 1e3));
    Ok(Island { name, address, unit, poll, timeout, lost: lost.unwrap_or(Lost::Alarm), inputs, end, points })
}

const RESTS: &[(&str, Rest)] = &[("zero", Rest::Zero), ("hold", Rest::Hold)];

const ADDRESS: &str = "the IP address of the island, like \"192.168.0.20\"";

fn address(section: &Section<'_>) -> Result<Option<IpAddr>, SettingsError> {
    let Some(value) = section.find("address") else { return Ok(None) };
    let address = value.get_ref().as_str().and_then(|text| text.parse().ok());
    address.map(Some).ok_or_else(|| section.wrong("address", value, ADDRESS))
}

/// The entries under a direction's key.
fn entries<'a>(
    section: &Section<'a>,
    direction: &'static Direction,
) -> Result<Vec<(&'a Value<'a>, Section<'a>)>, SettingsError> {
    let Some(value) = section.find(direction.key) else { return Ok(Vec::new()) };
    let what = "a list of tables, like [{ channel = 1, count = 8, coil = 0 }]";
    let list = value.get_ref().as_array().ok_or_else(|| section.wrong(direction.key, value, what))?;
    list.iter().map(|value| Ok((value, table(section.source, value, direction.name, direction.known)?))).collect()
}

/// The first channel and address of an entry, and its number of channels.
struct Stretch {
    channel: usize,
    count: u32,
    table: Table,
    address: u32,
}

fn stretch(
    value: &Value<'_>,
    entry: &Section<'_>,
    direction: &Direction,
    channels: u32,
) -> Result<Stretch, SettingsError> {
    let (name, kind) = (direction.name, direction.key.to_ascii_uppercase());
    let wrong = |message: String| entry.source.error(value.span(), message);
    let channel = entry.count("channel", "the first channel, a number", 10_000)?;
    let channel = channel.ok_or_else(|| wrong(format!("{name} lacks `channel`: the first channel, from 1")))?;
    let count = entry.count("count", "how many channels", 10_000)?.unwrap_or(1);
    if count == 0 {
        return Err(wrong(format!("{name}: `count` is 0: expected 1 or more")));
    }
    let last = channel + count - 1;
    if channel == 0 || last > channels {
        let message = match channels {
            0 => format!("{name}: {kind} {channel} to {last} do not exist: this cell has no {kind}"),
            _ => format!("{name}: {kind} {channel} to {last} do not exist: the cell has {kind} 1 to {channels}"),
        };
        return Err(wrong(message));
    }
    let mut named = direction.tables.iter().filter(|table| entry.find(table.key()).is_some());
    let (Some(&table), None) = (named.next(), named.next()) else {
        let known: Vec<String> = direction.tables.iter().map(|table| format!("`{}`", table.key())).collect();
        return Err(wrong(format!("{name} needs one of {}: the address on the wire, from 0", known.join(", "))));
    };
    let address = entry.count(table.key(), "an address on the wire", ADDRESSES - 1)?.unwrap_or(0);
    Ok(Stretch { channel: channel as usize - 1, count, table, address })
}

/// An address, if the table has it.
fn at(entry: &Section<'_>, value: &Value<'_>, table: Table, address: u32) -> Result<u16, SettingsError> {
    u16::try_from(address).map_err(|_| {
        let message = format!("the {}s end at address {}: there is no {address}", table.singular(), ADDRESSES - 1);
        entry.source.error(value.span(), message)
    })
}

fn bits(
    section: &Section<'_>,
    direction: &'static Direction,
    channels: u32,
    taken: &mut Taken,
) -> Result<Vec<Bit>, SettingsError> {
    let mut all = Vec::new();
    for (value, entry) in entries(section, direction)? {
        let Stretch { channel, count, table, address } = stretch(value, &entry, direction, channels)?;
        let first = entry.count("bit", "the first bit of the register", 15)?;
        if first.is_some() && table.has_bits() {
            let message = format!("`bit` of {}: a {} has one bit only", direction.name, table.singular());
            return Err(entry.source.error(value.span(), message));
        }
        for step in 0..count {
            let (offset, bit) = if table.has_bits() {
                (step, 0)
            } else {
                let bits = first.unwrap_or(0) + step;
                (bits / 16, bits % 16)
            };
            let point = Bit {
                channel: channel + step as usize,
                table,
                address: at(&entry, value, table, address + offset)?,
                bit: bit as u8,
            };
            claim(&entry, value, direction, point.channel, &[(table, point.address, point.bit)], taken)?;
            all.push(point);
        }
    }
    Ok(all)
}

fn analogs(
    section: &Section<'_>,
    direction: &'static Direction,
    types: &[AnalogType],
    taken: &mut Taken,
) -> Result<Vec<Analog>, SettingsError> {
    let mut all = Vec::new();
    for (value, entry) in entries(section, direction)? {
        let Stretch { channel, count, table, address } = stretch(value, &entry, direction, types.len() as u32)?;
        let raw = raw(&entry)?;
        for step in 0..count {
            let channel = channel + step as usize;
            let ty = types.get(channel).copied().unwrap_or(AnalogType::Volt);
            let address = at(&entry, value, table, address + step)?;
            let places: Vec<_> = (0..16).map(|bit| (table, address, bit)).collect();
            claim(&entry, value, direction, channel, &places, taken)?;
            all.push(Analog { channel, table, address, scale: Scale::new(ty, raw) });
        }
    }
    Ok(all)
}

/// Checks that an input has one source, and that no two outputs write the same place.
fn claim(
    entry: &Section<'_>,
    value: &Value<'_>,
    direction: &Direction,
    channel: usize,
    places: &[(Table, u16, u8)],
    taken: &mut Taken,
) -> Result<(), SettingsError> {
    let kind = direction.key.to_ascii_uppercase();
    if matches!(direction.key, "di" | "ai") {
        if !taken.inputs.insert((direction.key, channel)) {
            let message = format!("{kind} {} has two sources: expected one", channel + 1);
            return Err(entry.source.error(value.span(), message));
        }
        return Ok(());
    }
    for place in places {
        if !taken.written.insert(*place) {
            let (table, address, _) = place;
            let message = format!("two outputs write `{}` {address} of the island: expected one", table.key());
            return Err(entry.source.error(value.span(), message));
        }
    }
    Ok(())
}

/// The registers at the least and the greatest value of a channel.
fn raw(entry: &Section<'_>) -> Result<Option<(i32, i32)>, SettingsError> {
    const WHAT: &str = "the register values for the lowest and the highest value of the channel, like [0, 27648]: two numbers \
                        from -32768 to 32767, or from 0 to 65535";
    let Some(value) = entry.find("raw") else { return Ok(None) };
    let ends = value.get_ref().as_array().and_then(|ends| match &ends[..] {
        [low, high] => number(low.get_ref()).zip(number(high.get_ref())),
        _ => None,
    });
    let fits = |low: f64, high: f64| {
        let (least, greatest) = (low.min(high), low.max(high));
        let whole = low.fract() == 0.0 && high.fract() == 0.0 && least < greatest;
        whole && (least >= -32768.0 && greatest <= 32767.0 || least >= 0.0 && greatest <= 65535.0)
    };
    match ends {
        Some((low, high)) if fits(low, high) => Ok(Some((low as i32, high as i32))),
        _ => Err(entry.wrong("raw", value, WHAT)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Outline;

    fn one(text: &str) -> Island {
        let outline = Outline::of_cell("cell.toml", text).unwrap();
        outline.islands.into_iter().next().unwrap()
    }

    #[test]
    fn an_island_has_sensible_values() {
        let island = one("[[island]]\naddress = \"10.0.0.7\"\ndi = [{ channel = 3, coil = 16 }]\n");
        assert_eq!((island.name.as_str(), island.unit), ("10.0.0.7:502", 1));
        assert_eq!((island.poll.as_millis(), island.timeout.as_millis()), (10, 500));
        assert_eq!((island.lost, island.inputs, island.end), (Lost::Alarm, Rest::Zero, Rest::Zero));
        assert_eq!(island.points.di, [Bit { channel: 2, table: Table::Coil, address: 16, bit: 0 }]);
    }

    #[test]
    fn everything_is_read() {
        let text = "[io]\nai = [\"V\", \"mA\"]\n[[island]]\nname = \"press\"\naddress = \"::1\"\nport = 1502\nunit = 9\n\
                    poll = 2.5\ntimeout = 100\nlost = \"warning\"\ninputs = \"hold\"\nend = \"hold\"\n\
                    di = [{ channel = 1, count = 2, discrete_input = 5 }, { channel = 9, count = 18, input_register = 3, bit = 15 }]\n\
                    do = [{ channel = 64, coil = 0 }]\nai = [{ channel = 1, count = 2, input_register = 40 }]\n\
                    ao = [{ channel = 8, holding_register = 7, raw = [0, 65535] }]\n";
        let island = one(text);
        assert_eq!((island.name.as_str(), island.address.to_string()), ("press", "[::1]:1502".into()));
        assert_eq!((island.unit, island.poll.as_micros(), island.timeout.as_millis()), (9, 2500, 100));
        assert_eq!((island.lost, island.inputs, island.end), (Lost::Warning, Rest::Hold, Rest::Hold));
        let places: Vec<_> = island.points.di.iter().map(|bit| (bit.channel, bit.address, bit.bit)).collect();
        assert_eq!(places[..4], [(0, 5, 0), (1, 6, 0), (8, 3, 15), (9, 4, 0)]);
        assert_eq!(places.last(), Some(&(25, 5, 0)));
        assert_eq!(island.points.ai[1].scale.value(0), 4.0, "mA begin at 4");
        assert_eq!((island.points.ao[0].channel, island.points.ao[0].scale.register(10.0)), (7, 65535));
    }

    #[test]
    fn registers_stand_for_values() {
        let volt = Scale::new(AnalogType::Volt, None);
        assert_eq!((volt.value(32767), volt.value(0), volt.value(0x8001)), (10.0, 0.0, -10.0));
        assert_eq!((volt.register(10.0), volt.register(-10.0), volt.register(0.0)), (32767, 0x8001, 0));
        let current = Scale::new(AnalogType::Milliampere, Some((0, 27648)));
        assert_eq!((current.value(27648), current.value(13824)), (20.0, 12.0));
        assert!(current.value(0xfff0) < 4.0, "below its range a signed register goes below 0");
        let back = Scale::new(AnalogType::Volt, Some((60000, 0)));
        assert_eq!((back.value(60000), back.value(0), back.register(-10.0)), (-10.0, 10.0, 60000));
        assert_eq!((volt.register(f64::NAN), volt.register(99.0)), (0, 32767));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        const HEAD: &str = "[[island]]\naddress = \"10.0.0.7\"\n";
        for (text, line, words) in [
            ("island = 3", 1, "tables that begin with [[island]]"),
            ("[[island]]\nname = \"a\"", 1, "lacks `address`"),
            ("[[island]]\naddress = \"valves\"", 2, "the IP address of the island"),
            (HEAD, 1, "has no channels"),
            (&format!("{HEAD}adress = 3"), 3, "did you mean `address`?"),
            (&format!("{HEAD}port = 0"), 1, "a TCP port from 1 to 65535"),
            (&format!("{HEAD}port = 70000"), 3, "a TCP port from 0 to 65535"),
            (&format!("{HEAD}unit = 256"), 3, "a unit number from 0 to 255"),
            (&format!("{HEAD}poll = 0"), 3, "ms from one exchange to the next from 1 to 10000"),
            (&format!("{HEAD}timeout = 5"), 3, "from 10 to 10000"),
            (&format!("{HEAD}lost = \"ignore\""), 3, "expected \"alarm\" or \"warning\""),
            (&format!("{HEAD}inputs = true"), 3, "expected \"zero\" or \"hold\", found true"),
            (&format!("{HEAD}di = 8"), 3, "expected a list of tables"),
            (&format!("{HEAD}di = [8]"), 3, "expected the table `di` of [[island]]"),
            (&format!("{HEAD}di = [{{ coil = 0 }}]"), 3, "lacks `channel`"),
            (&format!("{HEAD}di = [{{ channel = 0, coil = 0 }}]"), 3, "DI 0 to 0 do not exist"),
            (&format!("{HEAD}di = [{{ channel = 60, count = 8, coil = 0 }}]"), 3, "the cell has DI 1 to 64"),
            (&format!("[io]\nai = 0\n{HEAD}ai = [{{ channel = 1, input_register = 0 }}]"), 5, "this cell has no AI"),
            (
                &format!("{HEAD}di = [{{ channel = 1 }}]"),
                3,
                "needs one of `coil`, `discrete_input`, `holding_register`",
            ),
            (&format!("{HEAD}di = [{{ channel = 1, coil = 0, discrete_input = 0 }}]"), 3, "needs one of"),
            (&format!("{HEAD}do = [{{ channel = 1, discrete_input = 0 }}]"), 3, "has no key `discrete_input`"),
            (&format!("{HEAD}ao = [{{ channel = 1, input_register = 0 }}]"), 3, "has no key `input_register`"),
            (&format!("{HEAD}di = [{{ channel = 1, coil = 0, bit = 3 }}]"), 3, "a coil has one bit only"),
            (&format!("{HEAD}di = [{{ channel = 1, coil = 65536 }}]"), 3, "an address on the wire from 0 to 65535"),
            (&format!("{HEAD}di = [{{ channel = 1, count = 2, coil = 65535 }}]"), 3, "there is no 65536"),
            (&format!("{HEAD}di = [{{ channel = 1, count = 0, coil = 1 }}]"), 3, "expected 1 or more"),
            (
                &format!("{HEAD}di = [{{ channel = 1, coil = 1 }}, {{ channel = 1, coil = 2 }}]"),
                3,
                "DI 1 has two sources",
            ),
            (
                &format!("{HEAD}do = [{{ channel = 1, coil = 1 }}, {{ channel = 2, coil = 1 }}]"),
                3,
                "two outputs write `coil` 1",
            ),
            (
                &format!(
                    "{HEAD}do = [{{ channel = 1, holding_register = 1 }}]\nao = [{{ channel = 1, holding_register = 1 }}]"
                ),
                4,
                "two outputs write `holding_register` 1",
            ),
            (&format!("{HEAD}ai = [{{ channel = 1, input_register = 1, raw = [0, 0] }}]"), 3, "like [0, 27648]"),
            (&format!("{HEAD}ai = [{{ channel = 1, input_register = 1, raw = [-1, 40000] }}]"), 3, "from 0 to 65535"),
            (
                &format!("{HEAD}di = [{{ channel = 1, coil = 1 }}]\n{HEAD}di = [{{ channel = 2, coil = 1 }}]"),
                4,
                "another island with the name \"10.0.0.7:502\"",
            ),
        ] {
            let error = Outline::of_cell("cell.toml", text).unwrap_err();
            assert_eq!(error.line, line, "{text}: {error}");
            assert!(error.message.contains(words), "{text}: {error}");
        }
    }
}
