//! `savesv` and `init`: system variables are saved, and set to what was saved.

use crate::builtins::storing;
use crate::context::cx::Cx;
use crate::context::{system, wiring};
use crate::fault::Fault;
use crate::values::Str;

/// `savesv`: saves a system variable, so that its value is there again at the next start. It is stored beside the
/// cycle, and the program goes on when it is; robots go on meanwhile.
///
/// # Errors
/// There is no such variable, it is none of those that are saved, or it cannot be written.
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

/// `init`: sets the variables of chapter 10.2 to their defaults, and those of chapter 10.1 to what was saved last.
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
