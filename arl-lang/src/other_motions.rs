//! Motions in URScript and KRL, and their ARL equivalents.

use std::fmt::Write;

/// The number of the last tool and of the last workpiece: `$tool31`, `$wobj31`.
const LAST: u32 = 31;

/// A motion of another language.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct OtherMotion {
    /// The language.
    pub language: &'static str,
    /// The equivalent in ARL.
    pub ours: String,
}

/// Recognises a statement as a motion of another language.
///
/// ```
/// use arl_lang::other_motions::other_motion;
/// assert_eq!(other_motion("movel(p1, a=1.2, v=0.25)").unwrap().ours, "lin p1,vl:250mm/s");
/// assert_eq!(other_motion("PTP HOME Vel=100 % DEFAULT").unwrap().ours, "ptp HOME,vp:100%");
/// assert_eq!(other_motion("lin p1,vl:250mm/s"), None);
/// ```
pub fn other_motion(statement: &str) -> Option<OtherMotion> {
    let urscript = || urscript(statement).map(|ours| OtherMotion { language: "URScript", ours });
    krl(statement).map(|ours| OtherMotion { language: "KRL", ours }).or_else(urscript)
}

/// `movel(p, a=1.2, v=0.25)`: metres and radians, labels with `=`, parentheses around all of it.
fn urscript(statement: &str) -> Option<String> {
    let (name, rest) = statement.split_once('(')?;
    let inside = rest.get(..rest.rfind(')')?)?;
    let arguments = split(inside);
    let mut plain = Vec::new();
    let mut named = Vec::new();
    for argument in arguments {
        match argument.split_once('=') {
            Some((label, value)) if is_one_of(&["a", "v", "t", "r"], label) => named.push((label.trim(), value.trim())),
            _ => plain.push(argument.trim()),
        }
    }
    let lists = plain.iter().any(|argument| argument.starts_with('[') || argument.starts_with("p["));
    if named.is_empty() && !lists {
        return None;
    }
    let value = |label: &str| named.iter().find(|(name, _)| name.eq_ignore_ascii_case(label)).map(|found| found.1);
    let speed = value("v").and_then(|speed| scaled(speed, "mm/s")).unwrap_or_else(|| "250mm/s".into());
    let speed = format!("vl:{speed}");
    let zone = value("r").and_then(|radius| scaled(radius, "mm")).map(|zone| format!(",sl:{zone}")).unwrap_or_default();
    let target = |at: usize| plain.get(at).and_then(|target| target_name(target));
    let name = name.trim();
    let line = if is_one_of(&["movej"], name) {
        let joints = plain.first().and_then(|list| degrees(list)).map(|axes| format!("j:{{{axes}}}"));
        let (motion, example) = match plain.first() {
            Some(pose) if pose.starts_with("p[") => ("ptp", "p1"),
            _ => ("movej", "j1"),
        };
        format!("{motion} {},vp:20%{zone}", joints.or(target(0)).unwrap_or_else(|| example.into()))
    } else if is_one_of(&["movel"], name) {
        format!("lin {},{speed}{zone}", target(0).unwrap_or_else(|| "p1".into()))
    } else if is_one_of(&["movep"], name) {
        let zone = if zone.is_empty() { ",sl:10mm" } else { &zone };
        format!("lin {},{speed}{zone}", target(0).unwrap_or_else(|| "p1".into()))
    } else if is_one_of(&["movec"], name) {
        let (via, to) = (target(0).unwrap_or_else(|| "p1".into()), target(1).unwrap_or_else(|| "p2".into()));
        format!("cir m:{via},p:{to},{speed}{zone}")
    } else {
        return None;
    };
    Some(line)
}

/// `LIN P1 CONT Vel=0.25 m/s CPDAT1 Tool[1] Base[0]`: an inline form.
fn krl(statement: &str) -> Option<String> {
    let mut words = statement.split_whitespace();
    let motion = words.next()?;
    let is_line = is_one_of(&["lin", "slin"], motion);
    if !is_line && !is_one_of(&["ptp", "sptp"], motion) {
        return None;
    }
    let target = words.next().filter(|target| is_name(target))?;
    let (before, after) = split_at_word(statement, "vel=").or_else(|| split_at_word(statement, "vel ="))?;
    let number: String = after.trim_start().chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    let number: f64 = number.parse().ok().filter(|number: &f64| number.is_finite())?;
    let blends = before.split_whitespace().any(|word| word.eq_ignore_ascii_case("cont"));
    let mut line = match (is_line, blends) {
        (true, false) => format!("lin {target},vl:{}mm/s", millimetres(number)?),
        (true, true) => format!("lin {target},vl:{}mm/s,sl:10mm", millimetres(number)?),
        (false, false) => format!("ptp {target},vp:{number}%"),
        (false, true) => format!("ptp {target},vp:{number}%,sp:20%"),
    };
    for (word, label, list, none) in [("tool[", "t", "tool", "FLANGE"), ("base[", "w", "wobj", "WORLD")] {
        let number = split_at_word(after, word).map(|(_, rest)| rest);
        let digits: String = number.unwrap_or("").chars().take_while(char::is_ascii_digit).collect();
        let _ = match digits.parse::<u32>() {
            Ok(0) => write!(line, ",{label}:${none}"),
            Ok(number @ 1..=LAST) => write!(line, ",{label}:${list}{number}"),
            _ => Ok(()),
        };
    }
    Some(line)
}

/// The text before and after a word, in any case.
fn split_at_word<'a>(text: &'a str, word: &str) -> Option<(&'a str, &'a str)> {
    let at = text.to_ascii_lowercase().find(word)?;
    Some((text.get(..at)?, text.get(at + word.len()..)?))
}

fn is_one_of(words: &[&str], word: &str) -> bool {
    words.iter().any(|known| known.eq_ignore_ascii_case(word.trim()))
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Splits the arguments between parentheses; commas inside brackets belong to lists.
fn split(inside: &str) -> Vec<&str> {
    let mut depth = 0_i32;
    let outside = |c: char| {
        depth += match c {
            '(' | '[' | '{' => 1,
            ')' | ']' | '}' => -1,
            _ => 0,
        };
        c == ',' && depth == 0
    };
    inside.split(outside).collect()
}

fn target_name(target: &str) -> Option<String> {
    is_name(target).then(|| target.to_owned())
}

/// `[0, -1.57, 1.57, 0, 1.57, 0]` in deg, to a hundredth.
fn degrees(list: &str) -> Option<String> {
    let inside = list.strip_prefix('[')?.strip_suffix(']')?;
    let angle = |value: &str| value.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let axes: Option<Vec<f64>> = inside.split(',').map(angle).collect();
    let axes = axes?.into_iter().map(|axis| ((axis.to_degrees() * 100.0).round() / 100.0 + 0.0).to_string());
    Some(axes.collect::<Vec<_>>().join(","))
}

/// A value in metres (and seconds), with the unit that ARL has; what is not a number is left to be computed. `None`
/// where it is not above 0.
fn scaled(value: &str, unit: &str) -> Option<String> {
    match value.parse::<f64>() {
        Ok(number) => millimetres(number).map(|number| format!("{number}{unit}")),
        _ if is_name(value) => Some(format!("{value}*1000")),
        _ => Some(format!("({value})*1000")),
    }
}

/// Metres in mm, to a thousandth; `None` where nothing above 0 is left.
fn millimetres(metres: f64) -> Option<f64> {
    let number = (metres * 1e6).round() / 1e3;
    (number.is_finite() && number > 0.0).then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_of_others() {
        for (theirs, ours) in [
            ("movej([0,-1.57,1.57,0,1.57,0], a=1.4, v=1.05)", "movej j:{0,-89.95,89.95,0,89.95,0},vp:20%"),
            ("movej(home, v=1.05, r=0.02)", "movej home,vp:20%,sl:20mm"),
            ("movej(p[0.1,0.2,0.3,0,3.14,0], v=1.05)", "ptp p1,vp:20%"),
            ("movel(p, v=speed, r=zone)", "lin p,vl:speed*1000,sl:zone*1000"),
            ("movel(p, v=2*slow, r=0)", "lin p,vl:(2*slow)*1000"),
            ("movel(p[0.1,0.2,0.3,0,3.14,0], v=0.1, r=0.005)", "lin p1,vl:100mm/s,sl:5mm"),
            ("movep(p, a=1.2, v=0.25)", "lin p,vl:250mm/s,sl:10mm"),
            ("movec(via, to, v=0.25)", "cir m:via,p:to,vl:250mm/s"),
            ("LIN P1 CONT Vel=0.25 m/s CPDAT1 Tool[1]:Gripper Base[0]", "lin P1,vl:250mm/s,sl:10mm,t:$tool1,w:$WORLD"),
            ("PTP P3 CONT Vel = 50 % PDAT3", "ptp P3,vp:50%,sp:20%"),
            ("LIN P2 Vel=1 m/s CPDAT2 Tool[0] Base[12]", "lin P2,vl:1000mm/s,t:$FLANGE,w:$wobj12"),
            ("LIN P2 Vel=1 m/s CPDAT2 Tool[40] Base[31]", "lin P2,vl:1000mm/s,w:$wobj31"),
            ("movel(p, v=1e-9)", "lin p,vl:250mm/s"),
            ("movel(p, v=inf)", "lin p,vl:250mm/s"),
        ] {
            assert_eq!(other_motion(theirs).map(|found| found.ours).as_deref(), Some(ours), "{theirs}");
        }
        for arl in
            ["ptp p1,vp:50%", "lin p", "movej(j1)", "movel(p, q)", "setdo(1, a=2)", "print vel=3", "movej j1,(v=2)"]
        {
            assert_eq!(other_motion(arl), None, "{arl}");
        }
    }
}
