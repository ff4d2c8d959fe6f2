//! The layout of the screen, and how it is drawn.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

use super::inside;
use super::keys;
use super::model::{PendantModel, Weight};
use arl_wire::{Axis, Channel, Runs, State};

pub(super) const QUIET: Style = Style::new().fg(Color::DarkGray);
pub(super) const STRONG: Style = Style::new().add_modifier(Modifier::BOLD);

/// How the screen is divided.
#[derive(Clone, Copy)]
struct Form {
    /// The width of the column of axes, TCP and io.
    side: u16,
    /// How many characters show where an axis is in its range.
    bar: usize,
    /// How many signals are in a row.
    signals: usize,
    /// Columns and decimals of a number.
    number: (usize, usize),
}

/// A screen with room.
const WIDE: Form = Form { side: 50, bar: 15, signals: 32, number: (10, 3) };
/// A screen of 80 columns: the text of the program has most of it.
const NARROW: Form = Form { side: 31, bar: 0, signals: 16, number: (8, 2) };
/// The least number of columns of a screen with room.
const ROOM: u16 = 110;

/// Draws the whole screen again.
pub(super) fn draw(frame: &mut Frame<'_>, model: &PendantModel) {
    let form = if frame.area().width >= ROOM { WIDE } else { NARROW };
    let feet = foot_lines(model, frame.area().width);
    let foot = Constraint::Length(feet.len() as u16);
    let rows = [Constraint::Length(1), Constraint::Min(8), Constraint::Percentage(25), foot];
    let [title, middle, log, foot] = Layout::vertical(rows).areas(frame.area());
    let [source, side] = Layout::horizontal([Constraint::Min(20), Constraint::Length(form.side)]).areas(middle);
    let (channel, runs) = shown(model);
    frame.render_widget(title_line(model, &channel), title);
    draw_source(frame, source, model, &channel);
    match &model.inside {
        Some(inside) => inside::draw(frame, side, inside, model.scrolled),
        None => draw_robot_and_io(frame, side, model, &channel, &runs, form),
    }
    draw_log(frame, log, model);
    frame.render_widget(Paragraph::new(feet), foot);
}

fn draw_robot_and_io(
    frame: &mut Frame<'_>,
    area: Rect,
    model: &PendantModel,
    channel: &Channel,
    runs: &Runs,
    form: Form,
) {
    let height = runs.axes.len() as u16 + 4;
    let [axes, io] = Layout::vertical([Constraint::Length(height), Constraint::Min(0)]).areas(area);
    frame.render_widget(Paragraph::new(axis_lines(runs, channel, form)).block(titled(&robot_title(runs))), axes);
    frame.render_widget(Paragraph::new(io_lines(model, form)).block(titled("io")), io);
}

/// The channel that is shown.
fn shown(model: &PendantModel) -> (Channel, Runs) {
    let channel = model.state.channels.get(model.shown).cloned().unwrap_or_default();
    let runs = model.hello.channels.get(model.shown).cloned().unwrap_or_default();
    (channel, runs)
}

pub(super) fn titled(title: &str) -> Block<'static> {
    Block::bordered().title(format!(" {title} ")).border_style(QUIET)
}

fn title_line(model: &PendantModel, channel: &Channel) -> Line<'static> {
    let state = &model.state;
    let word = match channel.state.as_str() {
        "" => "starting",
        _ if model.leaving => "leaving",
        word => word,
    };
    let number = match state.channels.len() {
        0 | 1 => String::new(),
        count => format!("  channel {} of {count}", model.shown + 1),
    };
    let right = format!("  {}  override {:.0} %  {:.1} s{number}", state.mode, state.speed_override, state.time);
    Line::from(vec![Span::styled(format!(" {word} "), state_style(word)), Span::raw(right)])
}

/// Each state of a program has a colour of its own.
fn state_style(word: &str) -> Style {
    let color = match word {
        "running" => Color::Green,
        "alarm" => Color::Red,
        "ended" | "stopped" => Color::Gray,
        _ => Color::Yellow,
    };
    Style::new().fg(Color::Black).bg(color).add_modifier(Modifier::BOLD)
}

fn draw_source(frame: &mut Frame<'_>, area: Rect, model: &PendantModel, channel: &Channel) {
    let block = titled(&channel.file);
    let inner = block.inner(area);
    let lines = model.sources.around(&channel.file, channel.line, usize::from(inner.height));
    let moving = |number| number == channel.motion_line && channel.motion_file == channel.file;
    let line = |(number, text): (usize, &str)| {
        let mark = match (number == channel.line, moving(number)) {
            (true, true) => "▶●",
            (true, false) => "▶ ",
            (false, true) => " ●",
            (false, false) => "  ",
        };
        let style = if number == channel.line { STRONG.bg(Color::DarkGray) } else { Style::new() };
        Line::from(vec![Span::raw(mark), Span::styled(format!("{number:5}  "), QUIET), Span::raw(text.to_owned())])
            .style(style)
    };
    let shown: Vec<Line<'_>> = lines.into_iter().map(line).collect();
    frame.render_widget(Paragraph::new(shown).block(block), area);
}

fn robot_title(runs: &Runs) -> String {
    runs.robot.clone().unwrap_or_else(|| "no robot".into())
}

fn axis_lines(runs: &Runs, channel: &Channel, form: Form) -> Vec<Line<'static>> {
    let axis = |(axis, at): (&Axis, &f64)| {
        let mut spans = vec![Span::raw(format!("{:<4}{} {:<4}", axis.name, decimals(*at, form), axis.unit))];
        if form.bar > 0 {
            let place = ((at - axis.min) / (axis.max - axis.min)).clamp(0.0, 1.0);
            let place = (place * (form.bar - 1) as f64).round() as usize;
            let bar: String = (0..form.bar).map(|cell| if cell == place { '█' } else { '─' }).collect();
            spans.push(Span::styled(format!("{:>7.0} ", axis.min), QUIET));
            spans.push(Span::raw(bar));
            spans.push(Span::styled(format!(" {:<.0}", axis.max), QUIET));
        }
        Line::from(spans)
    };
    let mut lines: Vec<Line<'static>> = runs.axes.iter().zip(&channel.axes).map(axis).collect();
    if let [x, y, z, a, b, c] = channel.tcp[..] {
        let [x, y, z, a, b, c] = [x, y, z, a, b, c].map(|value| decimals(value, form));
        lines.push(Line::raw(format!("TCP{x}{y}{z}{}", if form.bar > 0 { " mm" } else { "" })));
        lines.push(Line::raw(format!("   {a}{b}{c}{}", if form.bar > 0 { " deg" } else { "" })));
    }
    lines
}

/// A number in its columns, without a minus before zero.
fn decimals(value: f64, form: Form) -> String {
    let (width, decimals) = form.number;
    let value = if value.abs() < 0.5 * libm::exp10(-(decimals as f64)) { 0.0 } else { value };
    format!("{value:width$.decimals$}")
}

/// The signals that have names, then all signals in rows.
fn io_lines(model: &PendantModel, form: Form) -> Vec<Line<'static>> {
    let state = &model.state;
    let mut lines: Vec<Line<'static>> =
        model.hello.names.iter().map(|(signal, name)| named_signal(signal, name, state)).collect();
    for (name, levels) in [("DI", &state.di), ("DO", &state.dout)] {
        let rows = levels.as_bytes().chunks(form.signals).enumerate();
        lines.extend(rows.map(|(row, levels)| signals(name, row * form.signals + 1, levels)));
    }
    for (name, values) in [("AI", &state.ai), ("AO", &state.ao)] {
        if !values.is_empty() {
            let values: Vec<String> = values.iter().map(|value| format!("{value:.2}")).collect();
            lines.push(Line::raw(format!("{name}  {}", values.join(" "))));
        }
    }
    lines
}

/// A signal that has a name: its level, its name, and where it is.
fn named_signal(signal: &str, name: &str, state: &State) -> Line<'static> {
    let (kind, channel) = signal.split_once('.').unwrap_or((signal, "1"));
    let at = channel.parse::<usize>().unwrap_or(1).saturating_sub(1);
    let digital = |levels: &str| levels.as_bytes().get(at).map(|level| level_mark(*level));
    let analog = |values: &[f64]| values.get(at).map(|value| Span::raw(format!("{value:.2}")));
    let level = match kind {
        "di" => digital(&state.di),
        "do" => digital(&state.dout),
        "ai" => analog(&state.ai),
        "ao" => analog(&state.ao),
        _ => None,
    };
    let level = level.unwrap_or_else(|| Span::styled("?", QUIET));
    Line::from(vec![level, Span::raw(format!(" {name}")), Span::styled(format!("  {signal}"), QUIET)])
}

fn level_mark(level: u8) -> Span<'static> {
    match level {
        b'1' => Span::styled("■", Style::new().fg(Color::Green)),
        _ => Span::styled("·", QUIET),
    }
}

/// A row of signals from a channel on, in groups of eight, those that are on in full.
fn signals(name: &str, first: usize, levels: &[u8]) -> Line<'static> {
    let mut spans = vec![Span::raw(format!("{name} {first:>3} "))];
    for (at, level) in levels.iter().enumerate() {
        if at > 0 && at % 8 == 0 {
            spans.push(Span::raw(" "));
        }
        spans.push(level_mark(*level));
    }
    Line::from(spans)
}

fn draw_log(frame: &mut Frame<'_>, area: Rect, model: &PendantModel) {
    let block = titled("messages");
    let height = usize::from(block.inner(area).height);
    let first = model.log.len().saturating_sub(height);
    let line = |(weight, text): &(Weight, String)| Line::styled(text.clone(), weight_style(*weight));
    let lines: Vec<Line<'_>> = model.log.iter().skip(first).map(line).collect();
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn weight_style(weight: Weight) -> Style {
    match weight {
        Weight::Message => Style::new(),
        Weight::Warning => Style::new().fg(Color::Yellow),
        Weight::Alarm => Style::new().fg(Color::Red),
    }
}

/// The keys, or what is being typed, in as many lines as they need.
fn foot_lines(model: &PendantModel, width: u16) -> Vec<Line<'static>> {
    if let Some(typed) = &model.typed {
        let example = model.hello.names.iter().find(|(signal, _)| signal.starts_with("di."));
        let example = example.map_or("di.5", |(_, name)| name);
        let example = if typed.starts_with("di.") { example.trim_start_matches("di.") } else { example };
        return vec![Line::from(vec![
            Span::styled("set ", STRONG),
            Span::raw(format!("{typed}▏")),
            Span::styled(format!("  like {example} = true, override = 50; Enter sends it, Esc cancels"), QUIET),
        ])];
    }
    let orders = keys::ORDERS.iter().map(|(key, name, _)| (key.to_string(), *name));
    let others =
        [("+-", "override"), ("i", "input"), (":", "order"), ("v", "variables"), ("Tab", "channel"), ("q", "quit")];
    let all = orders.chain(others.into_iter().map(|(key, name)| (key.to_owned(), name)));
    let mut lines = vec![Line::default()];
    for (key, name) in all {
        let spans = [Span::styled(key, STRONG), Span::styled(format!(" {name}  "), QUIET)];
        let room = lines.last().map_or(0, Line::width) + spans.iter().map(Span::width).sum::<usize>();
        if room > usize::from(width) + 2 {
            lines.push(Line::default());
        }
        if let Some(line) = lines.last_mut() {
            line.spans.extend(spans);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    use super::super::sources::Sources;
    use super::*;
    use arl_wire::{Inside, Line};

    const HELLO: &str = r#"{"hello":{"channels":[{"program":"pick.arl","robot":"kr10-r1420","axes":[
        {"name":"j1","unit":"deg","min":-170,"max":170},{"name":"j2","unit":"deg","min":-190,"max":45}]}]}}"#;
    const STATE: &str = r#"{"state":{"time":12.34,"mode":"AUTO","override":80,"channels":[{"state":"running","file":"pick.arl",
        "line":3,"motion_file":"pick.arl","motion_line":2,"axes":[-0.0001,-190],"tcp":[1,2.5,3,4,5,6]}],
        "di":"010000000","do":"1","ai":[4.25],"ao":[]}}"#;

    fn screen(lines: &[&str], change: impl FnOnce(&mut PendantModel)) -> String {
        screen_of(120, lines, change)
    }

    fn screen_of(width: u16, lines: &[&str], change: impl FnOnce(&mut PendantModel)) -> String {
        let mut model = PendantModel::new(Sources::of("pick.arl", "func void main()\nmovej p1\nlin p2\nendfunc"));
        for line in lines {
            model.receive(serde_json::from_str::<Line>(line).unwrap());
        }
        change(&mut model);
        let mut terminal = Terminal::new(TestBackend::new(width, 24)).unwrap();
        terminal.draw(|frame| draw(frame, &model)).unwrap();
        terminal.backend().to_string()
    }

    #[test]
    fn everything_is_on_the_screen() {
        let message = r#"{"message":{"time":1.5,"hmi":true,"console":false,"text":"part 1\n"}}"#;
        let alarm =
            r#"{"alarm":{"number":20003,"text":"alarm 20003: out of reach (pick.arl:3)","file":"pick.arl","line":3}}"#;
        let screen = screen(&[HELLO, STATE, message, alarm], |_| {});
        for words in [
            " running   AUTO  override 80 %  12.3 s",
            " ●    2  movej p1",
            "▶     3  lin p2",
            "kr10-r1420",
            "j1       0.000 deg    -170 ───────█─────── 170",
            "j2    -190.000 deg    -190 █────────────── 45",
            "TCP     1.000     2.500     3.000 mm",
            "DI   1 ·■······ ·",
            "DO   1 ■",
            "AI  4.25",
            "    1.500  part 1",
            "alarm 20003: out of reach (pick.arl:3)",
            "s start  p pause  n step",
        ] {
            assert!(screen.contains(words), "{words}\n{screen}");
        }
    }

    #[test]
    fn eighty_columns_are_enough() {
        let hello = HELLO.replace("]}]}}", r#"]}],"names":{"di.2":"part_present","ai.1":"height"}}}"#);
        let screen = screen_of(80, &[&hello, STATE], |model| {
            model.sources =
                Sources::of("pick.arl", "func void main()\nmovej p1\nlin a_long_target_name,vl:250\nendfunc");
        });
        for words in [
            "lin a_long_target_name,vl:250",
            "j2   -190.00 deg",
            "TCP    1.00    2.50    3.00",
            "■ part_present  di.2",
            "4.25 height  ai.1",
            "DO   1 ■",
            "s start  p pause  n step",
            "q quit",
        ] {
            assert!(screen.contains(words), "{words}\n{screen}");
        }
    }

    #[test]
    fn calls_and_variables_take_the_place_of_axes_and_io() {
        let inside = r#"{"inside":{"channel":1,"frames":[{"name":"grip","file":"pick.arl","line":3},
            {"name":"main","file":"pick.arl","line":2}],"variables":[{"name":"depth","value":"12.5"}],
            "handles":[{"name":"watch","value":"0.250 s, runs"}],
            "files":[{"file":"pick.arl","variables":[{"name":"placed","value":"4"}]}]}}"#;
        let shown = screen_of(80, &[HELLO, STATE], |model| {
            model.inside = Some(Inside::default());
            model.receive(serde_json::from_str(inside).unwrap());
        });
        for words in ["grip  pick.arl:3", "main  pick.arl:2", "depth 12.5", "watch 0.250 s, runs", "placed 4"] {
            assert!(shown.contains(words), "{words}\n{shown}");
        }
        assert!(!shown.contains("j1 "), "{shown}");
        let late = screen(&[HELLO, STATE, inside], |_| {});
        assert!(late.contains("j1 "), "what comes late does not open it again: {late}");
    }

    #[test]
    fn before_the_first_word_it_starts() {
        let screen = screen(&[], |_| {});
        assert!(screen.contains(" starting "), "{screen}");
        assert!(screen.contains("no robot"), "{screen}");
    }

    #[test]
    fn what_is_typed_takes_the_place_of_the_keys() {
        let screen = screen(&[HELLO, STATE], |model| model.typed = Some("di.5 = tr".into()));
        assert!(screen.contains("set di.5 = tr▏"), "{screen}");
        assert!(!screen.contains("s start"), "{screen}");
    }

    #[test]
    fn a_small_terminal_is_no_reason_to_panic() {
        let mut model = PendantModel::default();
        model.receive(serde_json::from_str(HELLO).unwrap());
        model.receive(serde_json::from_str(STATE).unwrap());
        for (width, height) in [(1, 1), (10, 3), (47, 9)] {
            let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
            terminal.draw(|frame| draw(frame, &model)).unwrap();
        }
    }
}
