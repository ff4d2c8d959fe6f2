//! What the keys do.

use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use super::model::PendantModel;
use arl_wire::Inside;

/// The request of a key.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Wish {
    /// An order for the program, in the words of a scenario.
    Order(String),
    /// Stop the robot and leave.
    Leave,
}

/// The keys that are orders, and how the screen shows them.
pub(super) const ORDERS: [(char, &str, &str); 7] = [
    ('s', "start", "pendant = \"start\""),
    ('p', "pause", "pendant = \"pause\""),
    ('n', "step", "pendant = \"step\""),
    ('r', "reset", "pendant = \"reset\""),
    ('c', "clear", "pendant = \"clear\""),
    ('o', "servo on", "pendant = \"servo_on\""),
    ('f', "servo off", "pendant = \"servo_off\""),
];

/// By how much a key changes the override, in %.
const OVERRIDE_STEP: f64 = 10.0;

/// By how many lines variables are scrolled at once.
const PAGE: isize = 8;

/// Does what a key asks of the screen, and returns what it asks of the program.
pub(super) fn press(key: KeyEvent, model: &mut PendantModel) -> Option<Wish> {
    if key.kind == KeyEventKind::Release {
        return None;
    }
    if key.code == KeyCode::Char('c') && key.modifiers.contains(KeyModifiers::CONTROL) {
        return Some(Wish::Leave);
    }
    match model.typed.take() {
        Some(typed) => edit(key.code, typed, model),
        None => command(key.code, model),
    }
}

/// The order that was typed. The key `i` begins it with `di.`, which a name of the cell may follow, too.
fn order_of(typed: String) -> String {
    match typed.strip_prefix("di.") {
        Some(name) if name.starts_with(|first: char| first.is_alphabetic() || first == '_') => name.to_owned(),
        _ => typed,
    }
}

/// Handles a key while an order is being typed.
fn edit(key: KeyCode, mut typed: String, model: &mut PendantModel) -> Option<Wish> {
    match key {
        KeyCode::Enter if typed.trim().is_empty() => return None,
        KeyCode::Enter => return Some(Wish::Order(order_of(typed))),
        KeyCode::Esc => return None,
        KeyCode::Backspace => drop(typed.pop()),
        KeyCode::Char(letter) => typed.push(letter),
        _ => {}
    }
    model.typed = Some(typed);
    None
}

fn command(key: KeyCode, model: &mut PendantModel) -> Option<Wish> {
    let now = model.speed_override();
    match key {
        KeyCode::Char('q') => Some(Wish::Leave),
        KeyCode::Char('+' | '=') => {
            Some(change_override((now / OVERRIDE_STEP).floor() * OVERRIDE_STEP + OVERRIDE_STEP, model))
        }
        KeyCode::Char('-') => {
            Some(change_override((now / OVERRIDE_STEP).ceil() * OVERRIDE_STEP - OVERRIDE_STEP, model))
        }
        KeyCode::Char('i') => {
            model.typed = Some("di.".into());
            None
        }
        KeyCode::Char(':') => {
            model.typed = Some(String::new());
            None
        }
        KeyCode::Tab => {
            model.show_next();
            model.inside.is_some().then(|| look_inside(model))
        }
        KeyCode::Char('v') if model.inside.is_some() => {
            model.inside = None;
            Some(Wish::Order("inside = 0".into()))
        }
        KeyCode::Char('v') => Some(look_inside(model)),
        KeyCode::Down => scroll(model, 1),
        KeyCode::Up => scroll(model, -1),
        KeyCode::PageDown => scroll(model, PAGE),
        KeyCode::PageUp => scroll(model, -PAGE),
        KeyCode::Char(letter) => {
            let order = ORDERS.iter().find(|(key, ..)| *key == letter);
            order.map(|(.., order)| Wish::Order((*order).to_owned()))
        }
        _ => None,
    }
}

/// Asks what is inside the program of the channel that is shown.
fn look_inside(model: &mut PendantModel) -> Wish {
    (model.inside, model.scrolled) = (Some(Inside::default()), 0);
    Wish::Order(format!("inside = {}", model.shown + 1))
}

/// Scrolls the variables, as far as there are any.
fn scroll(model: &mut PendantModel, by: isize) -> Option<Wish> {
    let last = model.inside.as_ref().map_or(0, |inside| inside.variable_lines().saturating_sub(1));
    model.scrolled = model.scrolled.saturating_add_signed(by).min(last);
    None
}

fn change_override(percent: f64, model: &mut PendantModel) -> Wish {
    let percent = percent.clamp(0.0, 100.0);
    model.ask_for_override(percent);
    Wish::Order(format!("override = {percent}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_wire::{Line, State};

    fn type_in(model: &mut PendantModel, text: &str) -> Option<Wish> {
        let key = |letter| match letter {
            '\n' => KeyCode::Enter,
            '\x08' => KeyCode::Backspace,
            '\x1b' => KeyCode::Esc,
            letter => KeyCode::Char(letter),
        };
        text.chars().map(|letter| press(key(letter).into(), model)).last().flatten()
    }

    #[test]
    fn keys_are_orders() {
        let mut model = PendantModel::default();
        assert_eq!(type_in(&mut model, "p"), Some(Wish::Order("pendant = \"pause\"".into())));
        assert_eq!(type_in(&mut model, "q"), Some(Wish::Leave));
        assert_eq!(type_in(&mut model, "z"), None);
    }

    #[test]
    fn the_override_goes_in_tens() {
        let mut model = PendantModel::default();
        for (now, key, then) in
            [(100.0, "-", 90.0), (95.0, "-", 90.0), (95.0, "+", 100.0), (100.0, "+", 100.0), (5.0, "-", 0.0)]
        {
            model.state.speed_override = now;
            model.asked_override = None;
            assert_eq!(type_in(&mut model, key), Some(Wish::Order(format!("override = {then}"))), "{now} {key}");
        }
    }

    #[test]
    fn no_press_is_lost_between_two_states() {
        let mut model = PendantModel::default();
        model.state.speed_override = 100.0;
        assert_eq!(type_in(&mut model, "---"), Some(Wish::Order("override = 70".into())));
        assert_eq!(type_in(&mut model, "+"), Some(Wish::Order("override = 80".into())));
        // States that were still on their way do not change it, however many there are.
        let state = |time: f64, speed_override: f64| State { time, speed_override, ..State::default() };
        (1..60).for_each(|step| model.receive(Line::State(state(f64::from(step) * 0.004, 100.0))));
        assert_eq!(type_in(&mut model, "+"), Some(Wish::Order("override = 90".into())));
        model.receive(Line::State(state(0.25, 90.0)));
        assert_eq!(model.asked_override, None);
        // A refused request is forgotten.
        type_in(&mut model, "-");
        model.receive(Line::State(state(0.6, 90.0)));
        assert_eq!(type_in(&mut model, "-"), Some(Wish::Order("override = 80".into())));
    }

    #[test]
    fn variables_come_and_go_with_a_key_and_follow_the_channel() {
        let mut model = PendantModel::default();
        model.state.channels = vec![Default::default(), Default::default()];
        assert_eq!(type_in(&mut model, "v"), Some(Wish::Order("inside = 1".into())));
        press(KeyCode::PageDown.into(), &mut model);
        assert_eq!(model.scrolled, 0, "there is nothing to scroll yet");
        let variables = vec![arl_wire::Variable::default(); 10];
        model.inside = Some(Inside { variables, ..Inside::default() });
        (0..3).for_each(|_| _ = press(KeyCode::PageDown.into(), &mut model));
        press(KeyCode::Up.into(), &mut model);
        assert_eq!(model.scrolled, 8);
        assert_eq!(press(KeyCode::Tab.into(), &mut model), Some(Wish::Order("inside = 2".into())));
        assert_eq!(model.scrolled, 0);
        assert_eq!(type_in(&mut model, "v"), Some(Wish::Order("inside = 0".into())));
        assert_eq!(press(KeyCode::Tab.into(), &mut model), None);
    }

    #[test]
    fn inputs_are_typed() {
        let mut model = PendantModel::default();
        assert_eq!(type_in(&mut model, "i5 = tr\x08rue\n"), Some(Wish::Order("di.5 = true".into())));
        assert_eq!(model.typed, None);
        assert_eq!(type_in(&mut model, ":ai.2 = 4.2\n"), Some(Wish::Order("ai.2 = 4.2".into())));
        assert_eq!(type_in(&mut model, "idoor = true\n"), Some(Wish::Order("door = true".into())));
        assert_eq!(type_in(&mut model, "i5\x1b"), None);
        assert_eq!(model.typed, None);
        // While something is typed, letters are letters.
        assert_eq!(type_in(&mut model, ":q"), None);
        assert_eq!(model.typed.as_deref(), Some("q"));
    }
}
