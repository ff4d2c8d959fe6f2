//! `savesv` and `init`: save system variables and restore the saved values.

use crate::builtins::storing;
use crate::context::cx::Cx;
use crate::context::{system, wiring};
use crate::fault::Fault;
use crate::values::Str;

/// `savesv`: saves a system variable, so that its value is restored at the next start. It is stored outside the cycle,
/// and the program continues once that is done; robots continue meanwhile.
///
/// # Errors
/// The variable does not exist, is not one of those that are saved, or cannot be written.
pub async fn savesv(cx: &Cx, svname: &Str) -> Result<(), Fault> {
    let text = svname.to_text();
    let name = text.strip_prefix('$').unwrap_or(&text);
    let saved = {
        let kept = cx.system().kept();
        let name = arl_lang::catalog::system_variable(name).map_or(name, |known| known.name);
        let Some(variable) = kept.iter().find(|kept| kept.name.eq_ignore_ascii_case(name)) else {
            let names: Vec<&str> = kept.iter().map(|kept| kept.name).collect();
            let problem = format!(
                "\"{text}\" is not a system variable that is saved; {}",
                arl_robot::settings::hint(name, &names)
            );
            return Err(Fault::Domain { function: "savesv", problem: problem.into() });
        };
        let shared = cx.shared();
        variable.save(&mut shared.state.borrow_mut(), &shared.disk)
    };
    let saved = storing::saved(saved, cx).await;
    saved.map_err(|error| Fault::Domain { function: "savesv", problem: error.to_string().into() })
}

/// `init`: sets the variables of chapter 10.2 to their defaults, and those of chapter 10.1 to the values saved last.
pub fn init(cx: &Cx) {
    let (channel_state, system) = (cx.channel_state(), cx.system());
    let current = system.cjoint.get();
    channel_state.reset_system();
    system.cjoint.set(current);
    system::restore(system, &cx.shared().state.borrow());
    if let Some(base) = channel_state.base {
        system.stand_on(base);
    }
    wiring::apply(&cx.shared().wiring, system);
}
