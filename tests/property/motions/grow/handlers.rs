//! What stops the program's motion when an input goes on, moves in between, and goes on.

use super::{Grower, between, names, shifted};
use crate::motions::plan::Mode;
use std::fmt::Write as _;

/// How many handlers a program with handlers has.
pub(crate) const HANDLERS: usize = 3;

impl Grower<'_> {
    /// The functions, and the lines that declare them.
    pub(super) fn handlers(&mut self, mode: Mode) -> (String, String) {
        let (mut functions, mut declarations) = (String::new(), String::new());
        for input in 1..=HANDLERS {
            let (parameters, arguments, body) = self.handler(mode);
            writeln!(functions, "func void stop{input}({parameters})\n{body}endfunc").unwrap();
            writeln!(declarations, "  interrupt 1,when:getdi({input}),do:stop{input}({arguments})").unwrap();
        }
        (functions, declarations)
    }

    /// Its parameters, what is given for them, and its statements.
    fn handler(&mut self, mode: Mode) -> (String, String, String) {
        let taught = 1 + self.random.below(3);
        let setting = self.random.below(self.settings);
        let (tool, wobj) = names(setting);
        let mut body = String::from(if self.random.chance(40) { "  stopmove fast\n" } else { "  stopmove\n" });
        if self.random.chance(30) {
            body.push_str("  waittime 0.2\n");
        }
        let (mut axes, mut line) = (self.random.chance(40), self.random.chance(50));
        if self.random.chance(25) {
            (axes, line) = (false, false);
        }
        if axes {
            let percent = between(self.random, 15.0, 80.0).round();
            let [before, argument] = self.robot.tool_of_movej(&tool);
            writeln!(body, "{before}  movej j{taught},vp:{percent},sl:-1{argument}").unwrap();
        }
        if line {
            let speed = between(self.random, 80.0, if mode == Mode::Manual { 400.0 } else { 900.0 }).round();
            let goal = shifted(setting, &self.shift(), &self.external());
            writeln!(body, "  lin p:{goal},vl:{speed},sl:-1,t:{tool},w:{wobj}").unwrap();
        }
        let start = *self.random.pick(&["", " 0", " false", " 1", " true", " 2", " 3"]);
        writeln!(body, "  startmove{start}").unwrap();

        let (mut parameters, mut arguments) = (Vec::new(), Vec::new());
        let mut pass = |kind: &str, name: String| {
            parameters.push(format!("{kind} {name}"));
            arguments.push(name);
        };
        if axes {
            pass("joint", format!("j{taught}"));
        }
        if line {
            pass("pose", format!("p{setting}_0"));
        }
        if (axes || line) && setting > 0 {
            pass("tool", tool);
            if line {
                pass("wobj", wobj);
            }
        }
        (parameters.join(","), arguments.join(","), body)
    }
}
