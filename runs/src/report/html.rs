//! A report as a page that is complete in itself.

use std::fmt::Write;

use super::summary::{OfChannel, OfLine, Summary, TimedText};

const HEAD: &str = "<!doctype html>
<html lang=\"en\">
<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>Report of a run</title>
<style>
:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 70em; margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2em .9em; text-align: right; border-bottom: 1px solid #8884; }
th { font-weight: 500; opacity: .7; }
th:first-child, td:first-child, td.text { text-align: left; }
td.bar { min-width: 12em; padding: 0; }
td.bar i { display: inline-block; height: .9em; vertical-align: middle; background: #e0812b; }
td.bar i + i { background: #4d94d0; }
.alarm { color: #d33b33; }
</style>
";

/// The page.
pub(super) fn page(summary: &Summary) -> String {
    let mut out = HEAD.to_owned();
    let _ = writeln!(out, "<h1>{:.3} s</h1>", summary.time);
    for alarm in &summary.alarms {
        let _ = writeln!(out, "<p class=\"alarm\">After {:.3} s: {}</p>", alarm.time, escaped(&alarm.text));
    }
    summary.channels.iter().for_each(|channel| add_channel(&mut out, channel));
    add_signals(&mut out, summary);
    add_contacts(&mut out, summary);
    add_texts(&mut out, "Warnings", &summary.warnings);
    add_texts(&mut out, "Messages", &summary.messages);
    out.push_str("</html>\n");
    out
}

fn add_channel(out: &mut String, channel: &OfChannel) {
    let OfChannel { program, robot, state, moving, standing, motions, way, .. } = channel;
    let robot = if robot.is_empty() { "in the background".to_owned() } else { format!("on {}", escaped(robot)) };
    let _ = writeln!(out, "<h2>{} {robot}: {}</h2>", escaped(program), escaped(state));
    let metres = way / 1000.0;
    let _ = writeln!(
        out,
        "<p>{moving:.3} s moving, {standing:.3} s at rest; {motions} motions, {metres:.3} m. \
         <small>In the bars: moving, then standing. Way: the path of the TCP, with zones and weave. Closest limit: the limit in the robot \
         file that the set-points used most of; tcp: along its path, not across it.</small></p>"
    );
    out.push_str(
        "<table><tr><th>line<th>motion<th>runs<th>moving s<th>standing s<th class=\"bar\"><th>way mm<th>blend<th>closest limit</tr>\n",
    );
    let most = channel.lines.iter().map(OfLine::time).fold(0.0, f64::max);
    for line in &channel.lines {
        let part = |time: f64| if most > 0.0 { 100.0 * time / most } else { 0.0 };
        let blend = line.blend.as_ref().map(|blend| {
            let why = if blend.why.is_empty() { String::new() } else { format!(": {}", blend.why) };
            format!("{:.1} of {:.1} {}{why}", blend.used, blend.asked, blend.unit)
        });
        let closest =
            line.closest.as_ref().map(|limit| format!("{} {} {} %", limit.of, limit.rate, percent(limit.percent)));
        let runs = if line.motions > 0 { line.motions.to_string() } else { String::new() };
        let distance = if line.motions > 0 { format!("{:.1}", line.way) } else { String::new() };
        let _ = writeln!(
            out,
            "<tr><td>{}:{}<td class=\"text\">{}<td>{runs}<td>{:.3}<td>{:.3}<td class=\"bar text\"><i style=\"width:{:.1}%\"></i>\
             <i style=\"width:{:.1}%\"></i><td>{distance}<td class=\"text\">{}<td class=\"text\">{}</tr>",
            escaped(&line.file),
            line.line,
            escaped(&line.kinds.join(", ")),
            line.moving,
            line.standing,
            part(line.moving),
            part(line.standing),
            escaped(&blend.unwrap_or_default()),
            escaped(&closest.unwrap_or_default()),
        );
    }
    out.push_str("</table>\n");
}

/// Above 100 %, tenths matter: up to 101 % is within the limits.
fn percent(percent: f64) -> String {
    if percent < 100.05 { format!("{percent:.0}") } else { format!("{percent:.1}") }
}

fn add_signals(out: &mut String, summary: &Summary) {
    if summary.signals.is_empty() {
        return;
    }
    out.push_str("<h2>Signals</h2>\n<table><tr><th>signal<th>name<th>changes<th>on s</tr>\n");
    for signal in &summary.signals {
        let (name, changes, on) = (escaped(&signal.name), signal.changes, signal.on);
        let _ =
            writeln!(out, "<tr><td>{}<td class=\"text\">{name}<td>{changes}<td>{on:.3}</tr>", escaped(&signal.signal));
    }
    out.push_str("</table>\n");
}

fn add_contacts(out: &mut String, summary: &Summary) {
    if summary.contacts.is_empty() {
        return;
    }
    out.push_str("<h2>Contacts</h2>\n<table><tr><th>line<th>after s<th>of<th>and<th>distance mm</tr>\n");
    for contact in &summary.contacts {
        let place = if contact.line > 0 { format!("{}:{}", contact.file, contact.line) } else { "-".to_owned() };
        let _ = writeln!(
            out,
            "<tr><td>{}<td>{:.3}<td class=\"text\">{}<td class=\"text\">{}<td>{:.1}</tr>",
            escaped(&place),
            contact.time,
            escaped(&contact.one),
            escaped(&contact.other),
            contact.distance
        );
    }
    out.push_str("</table>\n");
}

fn add_texts(out: &mut String, title: &str, texts: &[TimedText]) {
    if texts.is_empty() {
        return;
    }
    let _ = writeln!(out, "<h2>{title}</h2>\n<table><tr><th>after s<th></tr>");
    for TimedText { time, text } in texts {
        let _ = writeln!(out, "<tr><td>{time:.3}<td class=\"text\">{}</tr>", escaped(text));
    }
    out.push_str("</table>\n");
}

/// Escapes the characters that HTML does not take as they are.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
