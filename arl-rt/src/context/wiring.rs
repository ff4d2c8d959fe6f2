//! The system variables that `[external]` of the cell file sets: how a PLC is wired to the controller (manual, chapter
//! 9).

use crate::context::system::Common;
use arl_robot::cell::Wiring;

/// Sets a system variable.
type Set = fn(&Common, &[i32]);

macro_rules! variables {
    ($($field:ident)*) => {
        &[$((stringify!($field), |system, values| {
            values.first().into_iter().for_each(|value| system.$field.set(*value));
        })),*]
    };
}

/// The variables with one value.
const VARIABLES: &[(&str, Set)] = variables! {
    ext_ctl_act_di servo_on_di servo_off_di start_prog_di pause_prog_di reset_prog_di clear_alarm_di
    pgno_type pgno_length pgno_fbit_di pgno_parity_di pgno_valid_di
    ext_ctl_act_conf_do servo_on_do pgno_req_do at_t1_do at_t2_do at_aut_do pgno_ack_fbit_do chan_state_do
};

/// The variable with five values.
const AT_HOME: (&str, Set) = ("at_home_do", |system, values| {
    system.at_home_do.update(|channels| channels.iter_mut().zip(values).for_each(|(place, value)| *place = *value));
});

fn all() -> impl Iterator<Item = &'static (&'static str, Set)> {
    VARIABLES.iter().chain(std::iter::once(&AT_HOME))
}

/// Sets the system variables that the cell wires; the others keep their values.
pub(crate) fn apply(wiring: &Wiring, system: &Common) {
    for (name, values) in wiring.given() {
        if let Some((_, set)) = all().find(|(known, _)| *known == name) {
            set(system, values);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::cell::Cell;

    #[test]
    fn what_is_wired_is_set() {
        let text = "[external]\nstart_prog_di = 4\npgno_type = 1\npgno_length = 12\npgno_parity_di = -30\n\
                    at_home_do = [5, 0, 7]\nchan_state_do = 20\n";
        let wiring = Cell::parse("cell.toml", text).unwrap().external;
        let system = Common::new();
        system.pause_prog_di.set(9);
        apply(&wiring, &system);
        assert_eq!((system.start_prog_di.get(), system.pause_prog_di.get()), (4, 9));
        assert_eq!((system.pgno_type.get(), system.pgno_length.get(), system.pgno_parity_di.get()), (1, 12, -30));
        assert_eq!(system.at_home_do.with(|channels| channels.to_vec()), [5, 0, 7, 0, 0]);
        assert!(wiring.enabled && !Cell::parse("cell.toml", "[external]\nenabled = false").unwrap().external.enabled);
    }

    #[test]
    fn all_that_can_be_wired_is_set() {
        for variable in arl_lang::catalog::system_variables().filter(|variable| variable.section.starts_with("9.1")) {
            let name = variable.name.to_ascii_lowercase();
            assert!(all().any(|(known, _)| *known == name), "{name}");
        }
    }
}
