//! Words of other robot languages, of Python and of C, and what ARL has in their place.

/// Types that other languages name differently, and their names in ARL.
const TYPES: &[(&str, &str)] = &[
    ("boolean", "bool"),
    ("char", "string"),
    ("dint", "int"),
    ("dword", "uint"),
    ("e6axis", "joint"),
    ("e6pos", "pose"),
    ("float", "double"),
    ("integer", "int"),
    ("jointtarget", "joint"),
    ("logical", "bool"),
    ("long", "int"),
    ("lreal", "double"),
    ("num", "double"),
    ("real", "double"),
    ("robtarget", "pose"),
    ("short", "int"),
    ("speeddata", "speed"),
    ("str", "string"),
    ("text", "string"),
    ("tooldata", "tool"),
    ("unsigned", "uint"),
    ("wobjdata", "wobj"),
    ("zonedata", "slip"),
];

/// What ARL has in place of `try` and its relatives.
const NO_EXCEPTIONS: &str = "no exceptions: a mistake ends the program with an alarm; check the value first, with `if`";

/// What ARL has in place of the timers of a PLC.
const NO_TIMER_BLOCKS: &str = "no timer blocks: `waittime 0.5` waits (in s), `pulsedo(1, true, 0.5)` pulses an output, \
a `clock` with `clkstart` and `clkread` measures";

/// Instructions, functions and words of control structures of other languages, and what ARL has in their place.
const WORDS: &[(&str, &str)] = &[
    ("arcend", "`setdo` for the output of the welding machine"),
    ("arcoff", "`setdo` for the output of the welding machine"),
    ("arcon", "`setdo` for the output of the welding machine"),
    ("arcstart", "`setdo` for the output of the welding machine"),
    ("atoi", "`toint(text, dec)`"),
    ("begin", "no word for the beginning of a block: the line that opens it is enough"),
    ("calcjointt", "`getjoint(p1, $FLANGE, $WORLD)`"),
    ("calcrobt", "`getpose(j1, $FLANGE, $WORLD)`"),
    ("catch", NO_EXCEPTIONS),
    ("chr", "`tostr`"),
    ("circ", "`cir m:p1,p:p2`"),
    ("cjointt", "`cjoint()`"),
    ("connect", "`interrupt` to call a function when a condition becomes true"),
    ("crobt", "`cpose()`"),
    ("ctd", "`n--` to count"),
    ("ctu", "`n++` to count"),
    ("date", "`cdate()`"),
    ("decl", "declarations without such a word: `int n = 3`"),
    ("def", "`func void name()` ... `endfunc`"),
    ("deffct", "`func int name()` ... `endfunc`"),
    ("delay", "`waittime 0.5` (in s)"),
    ("dim", "declarations without such a word: `int n = 3`"),
    ("do", "`repeat` ... `until(condition)`, which ends when the condition is true"),
    ("echo", "`print`"),
    ("elif", "`elseif(condition)`"),
    ("elsif", "`elseif(condition)`"),
    ("endtry", NO_EXCEPTIONS),
    ("enum", "no user-defined enumerations: use constants, `const int RED = 0`"),
    ("except", NO_EXCEPTIONS),
    ("f_trig", "`interrupt`, which calls a function when a condition becomes true"),
    ("finally", NO_EXCEPTIONS),
    ("fold", "comments (`// text`) for this"),
    ("from", "`import \"file\"`, and then `file::name`"),
    ("function", "`func int name()` ... `endfunc`"),
    ("get_actual_joint_positions", "`cjoint()`"),
    ("get_actual_tcp_pose", "`cpose()`"),
    ("get_analog_in", "`getai(1)`"),
    ("get_configurable_digital_in", "`getdi(1)`"),
    ("get_digital_in", "`getdi(1)`"),
    ("get_forward_kin", "`getpose(j1, $FLANGE, $WORLD)`"),
    ("get_inverse_kin", "`getjoint(p1, $FLANGE, $WORLD)`"),
    ("get_standard_analog_in", "`getai(1)`"),
    ("get_standard_digital_in", "`getdi(1)`"),
    ("global", "global variables outside of all functions: no word is needed to use them"),
    ("halt", "`pause`, and `exit` to end the program"),
    ("idelete", "`delint`"),
    ("idisable", "`disableint`"),
    ("ienable", "`enableint`"),
    ("incr", "`n++`"),
    ("input", "`getdi(1)`"),
    ("len", "`strlen` for texts; arrays have the size that they were declared with"),
    ("length", "`strlen`"),
    ("let", "declarations with a type: `int n = 3`"),
    ("lin_rel", "`lin offset(p1, 10, 0, 0, 0, 0, 0)`, where `p1` is the previous target, and `reltool` along the tool"),
    ("linear", "`lin`"),
    ("local", "declarations without such a word: `int n = 3`"),
    ("module", "a file for each module; `import` reads it"),
    ("movc", "`cir m:p1,p:p2`"),
    ("moveabsj", "`movej`"),
    ("movec", "`cir m:p1,p:p2`"),
    ("movecirc", "`cir m:p1,p:p2`"),
    ("movel", "`lin`"),
    ("movelin", "`lin`"),
    ("movep", "`lin` with a blending zone: `lin p1,vl:100mm/s,sl:10mm`"),
    ("moveptp", "`ptp`"),
    ("movl", "`lin`"),
    ("movp", "`ptp`"),
    ("movs", "`spl`"),
    ("numtostr", "`tostr(n)`"),
    ("offs", "`offset(p1, dx:10, dy:0, dz:0, rz:0, ry:0, rx:0)`"),
    ("on_error", NO_EXCEPTIONS),
    ("output", "`setdo(1, true)`"),
    ("pass", "blocks that may be empty: leave it out"),
    ("pers", "declarations without such a word: `int n = 3`"),
    ("persistent", "`$I`, `$D` and `$P` with `savesv` for what is kept between runs"),
    ("popup", "`print`, and `pause` to wait for the operator"),
    ("pose_inv", "`poseinv`"),
    ("pose_trans", "`reltool`, which moves a pose along its own axes"),
    ("printf", "`print`"),
    ("println", "`print`"),
    ("proc", "`func void name()` ... `endfunc`"),
    ("procedure", "`func void name()` ... `endfunc`"),
    ("ptp_rel", "`movej` to a joint that is calculated from the previous target"),
    ("pulse", "`pulsedo(1, true, 0.5)`"),
    ("r_trig", "`interrupt`, which calls a function when a condition becomes true"),
    ("raise", "`assert(condition)` to end the program with an alarm"),
    ("random", "`rand`"),
    ("readnum", "`toint(gettextstr(\"file.txt\", 1), dec)`"),
    ("readstr", "`gettextstr(\"file.txt\", 1)`"),
    ("reset", "`setdo(1, false)`"),
    ("resume", "`startmove`"),
    ("retain", "`$I`, `$D` and `$P` with `savesv` for what is kept between runs"),
    ("retry", NO_EXCEPTIONS),
    ("round", "`floor(x + 0.5)`"),
    ("scirc", "`cir m:p1,p:p2`"),
    ("select", "`switch(n)` ... `endswitch`"),
    ("set", "`setdo(1, true)`"),
    ("set_analog_out", "`setao(1, 5)`"),
    ("set_configurable_digital_out", "`setdo(1, true)`"),
    ("set_digital_out", "`setdo(1, true)`"),
    ("set_standard_analog_out", "`setao(1, 5)`"),
    ("set_standard_digital_out", "`setdo(1, true)`"),
    ("set_tcp", "the tool with the motion: `lin p1,t:gripper`"),
    ("setai", "`setao(1, 5)`"),
    ("setgo", "`setdo(1, 8, value)`, which writes the outputs 1 to 8"),
    ("signal", "names for signals in the cell file; programs give the number: `getdi(1)`"),
    ("sleep", "`waittime 0.5` (in s)"),
    ("slin", "`lin`"),
    ("spline", "`spl`"),
    ("sptp", "`ptp`"),
    ("static", "global variables, which keep their values while the program runs; `$I` with `savesv` between runs"),
    ("stop", "`pause`, and `exit` to end the program"),
    ("stopweave", "`endweave`"),
    ("strtoint", "`toint(text, dec)`"),
    ("strtoval", "`toint(text, dec)`, and `scan` for several numbers"),
    ("struct", "no user-defined structures: use separate variables, or arrays"),
    ("sub", "`func void name()` ... `endfunc`"),
    ("sync", "no word for this: instructions wait as long as they need to"),
    ("test", "`switch(n)` ... `endswitch`"),
    ("testdi", "`getdi(1)`"),
    ("textmsg", "`print`"),
    ("thread", "`interrupt`, or a channel of its own in the cell file"),
    ("throw", "`assert(condition)` to end the program with an alarm"),
    ("time", "`ctime()`"),
    ("tof", NO_TIMER_BLOCKS),
    ("ton", NO_TIMER_BLOCKS),
    ("tostring", "`tostr`"),
    ("tp", "`pulsedo(1, true, 0.5)` for a pulse at an output"),
    ("tperase", "no screen to clear: `print` writes below what is there"),
    ("tpreadnum", "`scan`"),
    ("tpwrite", "`print`"),
    ("trap", "`func void name()`, which an `interrupt` calls"),
    ("try", NO_EXCEPTIONS),
    ("trynext", NO_EXCEPTIONS),
    ("valtostr", "`tostr(n)`"),
    ("var", "declarations with a type and no other word: `int n = 3`"),
    ("wait", "`waittime 0.5` for a time in s, `waituntil getdi(1)` for a condition"),
    ("waitdi", "`waituntil getdi(1)`"),
    ("waitdo", "`waituntil getdo(1)`"),
    ("waitfor", "`waituntil getdi(1)`"),
    ("weave", "`startweave` with a `weavedata`, and `endweave`"),
    ("weaveend", "`endweave`"),
    ("weaveoff", "`endweave`"),
    ("weaveon", "`startweave` with a `weavedata`"),
    ("weavestart", "`startweave` with a `weavedata`"),
];

/// System variables of other languages.
const SYSTEM: &[(&str, &str)] = &[
    ("anin", "`getai(1)`"),
    ("anout", "`setao(1, 5)`"),
    ("apo", "`sl:10mm` or `sp:20%` with the motion, or `$DFSLIP`"),
    ("apo.cdis", "`sl:10mm` with the motion"),
    ("axis_act", "`cjoint()`"),
    ("in", "`getdi(1)`"),
    ("out", "`setdo(1, true)` to write, `getdo(1)` to read"),
    ("ov_pro", "`velset`"),
    ("pos_act", "`cpose()`"),
    ("timer", "`clkstart`, `clkread` with a `clock`"),
    ("tool", "`t:` with the motion, or `$DFTOOL`"),
    ("vel", "`vl:250mm/s` with the motion, or `$DFSPEED`"),
    ("vel_axis", "`vp:50%` with the motion, or `$DFSPEED`"),
];

/// What other languages give a motion besides its target.
const ARGUMENTS: &[(&str, &str)] = &[
    ("c_dis", "a blending zone as an argument: `lin p1,sl:10mm`"),
    ("c_ori", "a blending zone as an argument: `lin p1,sl:10mm`"),
    ("c_ptp", "a blending zone as an argument: `movej j1,sp:20%`"),
    ("c_spl", "a blending zone as an argument: `lin p1,sl:10mm`"),
    ("c_vel", "a blending zone as an argument: `lin p1,sl:10mm`"),
    ("fine", "`sl:-1` for a motion that stops at its target"),
    ("nil", "no such value: leave it out"),
    ("none", "no such value: leave it out"),
    ("null", "no such value: leave it out"),
    ("off", "`false`"),
    ("on", "`true`"),
    ("tool0", "`$FLANGE` for the flange without a tool, `$tool0` for tool 0 of the controller"),
    ("vmax", "`vp:100%`"),
    ("wobj0", "`$WORLD` for the world, `$wobj0` for workpiece frame 0 of the controller"),
];

/// Labels of other languages' motions, and the ARL labels with the same meaning.
const LABELS: &[(&str, &[&str])] = &[
    ("base", &["w"]),
    ("blend", &["sl", "sp"]),
    ("frame", &["w"]),
    ("joint", &["j"]),
    ("pos", &["p"]),
    ("pose", &["p"]),
    ("r", &["sl"]),
    ("radius", &["sl"]),
    ("speed", &["vl", "vp"]),
    ("target", &["p", "j"]),
    ("time", &["dura"]),
    ("tool", &["t"]),
    ("uframe", &["w"]),
    ("vel", &["vl", "vp"]),
    ("velocity", &["vl", "vp"]),
    ("via", &["m"]),
    ("wobj", &["w"]),
    ("zone", &["sl", "sp"]),
];

/// Operators that other languages write in letters.
const OPERATORS: &[(&str, &str)] = &[
    ("and", "&&"),
    ("b_and", "&"),
    ("b_exor", "^"),
    ("b_not", "~"),
    ("b_or", "|"),
    ("div", "/"),
    ("exor", "^"),
    ("mod", "%"),
    ("not", "!"),
    ("or", "||"),
    ("xor", "^"),
];

fn find(table: &[(&'static str, &'static str)], word: &str) -> Option<&'static str> {
    table.iter().find(|(other, _)| other.eq_ignore_ascii_case(word)).map(|(_, ours)| *ours)
}

/// The type that another language calls `word`.
///
/// ```
/// assert_eq!(arl_lang::elsewhere::type_of("robtarget"), Some("pose"));
/// ```
pub fn type_of(word: &str) -> Option<&'static str> {
    find(TYPES, word)
}

/// What ARL has in place of an instruction, function or control word of another language: the text continues "ARL has".
///
/// ```
/// assert_eq!(arl_lang::elsewhere::word("MoveL"), Some("`lin`"));
/// assert_eq!(arl_lang::elsewhere::word("movej"), None);
/// ```
pub fn word(word: &str) -> Option<&'static str> {
    find(WORDS, word)
}

/// What ARL has in place of another language's system variable, named without its `$`.
pub fn system(name: &str) -> Option<&'static str> {
    find(SYSTEM, name)
}

/// What ARL has in place of a value that other languages have: `fine`, `C_DIS`, `tool0` after a motion.
pub fn argument_word(name: &str) -> Option<&'static str> {
    find(ARGUMENTS, name)
}

/// Like `argument_word`, and also covers names that a program may well define itself: `v100`, `z10`, `di1`.
pub fn argument(name: &str) -> Option<&'static str> {
    let numbered = |first: char| {
        let digits = name.strip_prefix([first, first.to_ascii_uppercase()]);
        digits.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit()))
    };
    argument_word(name)
        .or_else(|| numbered('v').then_some("a speed as an argument with its unit: `vl:100mm/s`, `vp:20%`"))
        .or_else(|| numbered('z').then_some("a blending zone as an argument: `sl:10mm`"))
        .or_else(|| signal(name))
}

/// `di1` and `do2` of other languages, where signals have such names.
fn signal(name: &str) -> Option<&'static str> {
    const SIGNALS: [(&str, &str); 4] = [
        ("di", "`getdi(1)` for an input"),
        ("do", "`setdo(1, true)` to write an output, `getdo(1)` to read it"),
        ("ai", "`getai(1)` for an analog input"),
        ("ao", "`setao(1, 5)` to write an analog output"),
    ];
    let (kind, digits) = name.split_at_checked(2)?;
    let (_, ours) = SIGNALS.iter().find(|(other, _)| other.eq_ignore_ascii_case(kind))?;
    digits.bytes().all(|digit| digit.is_ascii_digit()).then_some(ours)
}

/// The ARL labels for a motion label of another language; not every motion has all of them.
pub fn labels(label: &str) -> &'static [&'static str] {
    LABELS.iter().find(|(other, _)| other.eq_ignore_ascii_case(label)).map_or(&[], |(_, ours)| ours)
}

/// How ARL writes an operator that other languages write in letters.
pub fn operator(word: &str) -> Option<&'static str> {
    find(OPERATORS, word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_in_order_without_doubles() {
        for table in [TYPES, WORDS, SYSTEM, ARGUMENTS, OPERATORS] {
            assert!(table.is_sorted_by(|one, other| one.0 < other.0), "{table:?}");
        }
        assert!(LABELS.is_sorted_by(|one, other| one.0 < other.0));
    }

    #[test]
    fn no_word_of_arl_is_called_one_of_others() {
        for (word, _) in WORDS.iter().chain(ARGUMENTS).chain(OPERATORS).filter(|(word, _)| *word != "connect") {
            assert!(!crate::is_reserved(word), "{word}");
            assert!(crate::catalog::functions(word).is_empty(), "{word}");
            assert!(crate::catalog::instructions(word).is_empty(), "{word}");
        }
        for (name, _) in SYSTEM {
            assert!(crate::catalog::system_variable(name).is_none(), "${name}");
        }
    }
}
