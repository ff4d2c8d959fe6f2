//! The program pointer, set to another line.

use crate::client::{Client, Folder};
use crate::reason_and_top;
use serde_json::{Value, json};
use std::fmt::Write;

impl Client {
    /// Sets the pointer to a line of the program; the reason of the halt, and the functions that run then.
    fn go_to(&mut self, folder: &Folder, line: u32) -> (String, Vec<String>) {
        let target = self.target(folder, line);
        self.ask("goto", json!({"threadId": 1, "targetId": target}));
        self.halt()
    }

    fn target(&mut self, folder: &Folder, line: u32) -> Value {
        let source = json!({"path": folder.path("main.arl")});
        let targets = self.ask("gotoTargets", json!({"source": source, "line": line}))["targets"].clone();
        targets[0]["id"].clone()
    }

    /// Why a line is not offered.
    fn is_not_offered(&mut self, folder: &Folder, line: u32) -> String {
        self.refused("gotoTargets", json!({"source": {"path": folder.path("main.arl")}, "line": line}))
    }

    fn may_not_go_to(&mut self, folder: &Folder, line: u32) -> String {
        let target = self.target(folder, line);
        self.refused("goto", json!({"threadId": 1, "targetId": target}))
    }
}

const BRANCHES: &str = "\
int total = 0
func int add(int a, int b)
    int sum = a + b
    return sum
endfunc
func void main()
    int seen = 1
    const int ROUNDS = 3
    clock watch
    for(int i = 0; i < ROUNDS; i++)
        if(i == 1)
            total = add(total, i)
        elseif(i == 2)
            seen = 2
        else
            seen = 3
        endif
        switch(i)
            case 1:
                seen = 10
            case 2:
                seen = 20
            default:
                seen = 30
        endswitch
    endfor
    while(total < 5)
        int inner = 7
        total = total + inner
    endwhile
    repeat
        total--
    until(total < 2)
    waituntil getdi(1)
    loop
        waittime 1
        if(getdi(2))
            break
        endif
        total = 0
    endloop
    print \"done \", seen
endfunc
";

#[test]
fn the_pointer_goes_where_it_is_set_to() {
    let folder = Folder::new("pointer").with("main.arl", BRANCHES);
    let mut client = Client::running(&folder, json!({}), &[11]);
    assert_eq!(reason_and_top(client.halt()), "breakpoint: main 11");
    client.set_breakpoints(&folder, "main.arl", json!([]));
    // Into a branch whose condition does not hold, and on from there.
    assert_eq!(client.go_to(&folder, 14), ("goto".into(), vec!["main 14".into()]));
    assert_eq!(client.value("seen"), "1", "what there is stays");
    assert_eq!(reason_and_top(client.go("next")), "step: main 18");
    assert_eq!((client.value("seen"), client.value("i")), ("2".into(), "0".into()));
    // Into another arm of a switch, and back to a condition, which is looked at.
    assert_eq!(reason_and_top(client.go_to(&folder, 22)), "goto: main 22");
    assert_eq!(reason_and_top(client.go("next")), "step: main 10");
    assert_eq!(client.value("seen"), "20");
    assert_eq!(reason_and_top(client.go_to(&folder, 13)), "goto: main 13");
    assert_eq!(reason_and_top(client.go("next")), "step: main 16");
    // Into a loop that has not begun, over a declaration: its variable has its start value.
    assert_eq!(reason_and_top(client.go_to(&folder, 29)), "goto: main 29");
    client.value("total = 1");
    assert_eq!(client.value("inner"), "0");
    client.value("inner = 2");
    assert_eq!(reason_and_top(client.go("next")), "step: main 27");
    assert_eq!(client.value("total"), "3");
    assert_eq!(reason_and_top(client.go("next")), "step: main 28");
    assert_eq!(reason_and_top(client.go("next")), "step: main 29");
    assert_eq!(client.value("inner"), "7");
    // Within the block the variable is the same one.
    assert_eq!(reason_and_top(client.go_to(&folder, 29)), "goto: main 29");
    assert_eq!(reason_and_top(client.go("next")), "step: main 27");
    assert_eq!(client.value("total"), "10");
    // To an `until`, and to the start of the `for`, which begins anew.
    assert_eq!(reason_and_top(client.go_to(&folder, 33)), "goto: main 33");
    assert_eq!(reason_and_top(client.go("next")), "step: main 32");
    assert_eq!(reason_and_top(client.go_to(&folder, 10)), "goto: main 10");
    assert_eq!(reason_and_top(client.go("next")), "step: main 11");
    assert_eq!(client.value("i"), "0");
    // Out of the loop, behind the wait.
    assert_eq!(reason_and_top(client.go_to(&folder, 42)), "goto: main 42");
    assert_eq!(client.run_out(&folder), ("done 20\n".into(), json!(0)));
}

#[test]
fn a_program_that_waits_goes_on_elsewhere() {
    let folder = Folder::new("pointer_waits").with("main.arl", BRANCHES);
    let mut client = Client::running(&folder, json!({}), &[]);
    // Nothing sets the input: the run would end there.
    assert_eq!(reason_and_top(client.halt()), "pause: main 34");
    assert_eq!(reason_and_top(client.go_to(&folder, 36)), "goto: main 36");
    // In the middle of a wait, as a rule between two cycles; seldom where the statements of a round begin.
    loop {
        client.ask("continue", json!({"threadId": 1}));
        if reason_and_top(client.go("pause")) == "pause: main 36" {
            break;
        }
    }
    assert_eq!(reason_and_top(client.go_to(&folder, 40)), "goto: main 40");
    assert_eq!(reason_and_top(client.go("next")), "step: main 35");
    assert_eq!(reason_and_top(client.go("next")), "step: main 36");
    assert_eq!(reason_and_top(client.go("stepBack")), "step: main 35");
    assert_eq!(reason_and_top(client.go_to(&folder, 42)), "goto: main 42");
    assert_eq!(client.run_out(&folder), ("done 20\n".into(), json!(0)));
}

#[test]
fn setting_it_is_undone_in_the_cycle_in_which_it_was_done() {
    let folder = Folder::new("pointer_undone").with(
        "main.arl",
        "func void main()\n    movej j:{0, -90, 90, 0, 90, 0}, vp:50%\n    movej j:{90, -90, 90, 0, 90, 0}, vp:1%\n    \
         waituntil getdi(1)\n    print \"set\"\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[4]);
    client.halt();
    client.ask("continue", json!({"threadId": 1}));
    std::thread::sleep(std::time::Duration::from_millis(20));
    assert_eq!(reason_and_top(client.go("pause")), "pause: main 4");
    let (_, at) = client.scope("Robot");
    assert_ne!(at[0], "j1 = 0.000 deg");
    assert_eq!(reason_and_top(client.go_to(&folder, 5)), "goto: main 5");
    assert_eq!(client.go("stepBack"), ("step".into(), vec!["main 4".into()]));
    assert_eq!(client.scope("Robot").1, at, "the same cycle");
    assert_eq!(reason_and_top(client.go_to(&folder, 5)), "goto: main 5");
    // The motions that were planned are executed.
    assert_eq!(client.run_out(&folder), ("set\n".into(), json!(0)));
}

const CALLS: &str = "\
int seen = 0
func int twice(int a)
    int b = a
    b = b + a
    return b
endfunc
func void opened(int gate)
    seen = seen + gate
endfunc
func void main()
    interrupt \"gate\", when:getdi(5), do:opened(7)
    int k = twice(4)
    waittime 1
    print k, \" \", seen
    k = 1 / (k - k)
    print \"behind\"
endfunc
";

#[test]
fn it_stays_in_the_functions_that_run() {
    let folder =
        Folder::new("pointer_calls").with("main.arl", CALLS).with("io.toml", "[[event]]\nat = 0.6\ndi.5 = true\n");
    let mut client = Client::running(&folder, json!({"io": "io.toml"}), &[4, 8]);
    assert_eq!(client.halt(), ("breakpoint".into(), vec!["twice 4".into(), "main 12".into()]));
    assert!(client.is_not_offered(&folder, 8).contains("line 8 is not in a function that runs"));
    // Back to its first statement, then out of it, over the declaration that has called it.
    assert_eq!(client.go_to(&folder, 3), ("goto".into(), vec!["twice 3".into(), "main 12".into()]));
    assert_eq!(reason_and_top(client.go("next")), "breakpoint: twice 4");
    assert_eq!(client.go_to(&folder, 13), ("goto".into(), vec!["main 13".into()]));
    let (reason, stack) = client.go("continue");
    assert_eq!((reason.as_str(), stack.len()), ("breakpoint", 3), "{stack:?}");
    assert!(client.may_not_go_to(&folder, 14).contains("the interrupt \"gate\" runs"));
    assert_eq!(reason_and_top(client.go("continue")), "exception: main 15");
    assert!(client.may_not_go_to(&folder, 16).contains("the program ends with this alarm"));
    assert_eq!(client.run_out(&folder), ("0 7\n".into(), json!(3)));
}

/// A program with everything that statements are put into: parts, tables, and the states of functions with `goto`.
fn everything() -> String {
    let mut text = "\
int seen = 0
pose p1 = {x 900, y 0, z 900, a 0, b 90, c 0}
func int jumps(int n)
    int k = n
again:
    k = k + 1
    if(k < 3)
        goto again
    elseif(k == 9)
        seen = 1
    else
        while(k < 6)
            k = k + 1
            if(k == 5)
inner:
                seen = seen + 1
            endif
            for(int i = 0; i < 2; i++)
                seen = seen + i
                if(i > 5)
                    goto inner
                endif
            endfor
        endwhile
    endif
    switch(k)
        case 6:
            k = 7
        case 7:
other:
            k = 8
        default:
            goto again
    endswitch
    repeat
        k = k - 1
        if(k == 2)
            goto other
        endif
        if(k == 3)
            break
        endif
    until(k < 4)
    return k
endfunc
func void main()
    int n = jumps(0)
    movej j:{60, -90, 90, 0, 90, 0}, vp:50%
    loop
"
    .to_owned();
    for at in 0..12 {
        let _ = writeln!(text, "        setdo({}, true)", at + 1);
    }
    for at in 0..40 {
        let _ = writeln!(text, "        waittime 0.0{at}\n        int v{at} = n + {at}\n        if(v{at} < n)");
        let _ = writeln!(text, "            break\n        endif");
    }
    text + "        n = jumps(n)\n    endloop\n    print n\nendfunc\n"
}

#[test]
fn it_goes_to_every_line() {
    let text = everything();
    let folder = Folder::new("pointer_everywhere").with("main.arl", &text);
    let line_of = |what: &str| text.lines().position(|line| line == what).expect("the line") as u32 + 1;
    let end = line_of("func void main()");
    let mut client = Client::running(&folder, json!({}), &[4]);
    assert_eq!(reason_and_top(client.halt()), "breakpoint: jumps 4");
    client.set_breakpoints(&folder, "main.arl", json!([]));
    let source = json!({"path": folder.path("main.arl")});
    let all = client.ask("breakpointLocations", json!({"source": source, "line": 1, "endLine": 999}));
    let lines: Vec<u32> =
        all["breakpoints"].as_array().unwrap().iter().map(|it| it["line"].as_u64().unwrap() as u32).collect();
    assert!(lines.len() > 150, "{lines:?}");
    let (inside, outside): (Vec<u32>, Vec<u32>) = lines.into_iter().partition(|line| *line < end);
    // Each runs once it is gone to: a variable says so.
    for line in &inside {
        assert_eq!(reason_and_top(client.go_to(&folder, *line)), format!("goto: jumps {line}"));
        client.value("k = 4");
        assert_eq!(reason_and_top(client.go("next")).split(' ').next(), Some("step:"), "line {line}");
        let depth = client.stack(&json!(1)).len();
        if depth < 2 {
            // It has returned: into it once more.
            client.go_to(&folder, line_of("    int n = jumps(0)"));
            client.go("stepIn");
        }
    }
    client.go("stepOut");
    for line in &outside {
        assert_eq!(reason_and_top(client.go_to(&folder, *line)), format!("goto: main {line}"));
        if text.lines().nth(*line as usize - 1).is_some_and(|text| text.contains("print")) {
            break;
        }
        assert_eq!(reason_and_top(client.go("next")).split(' ').next(), Some("step:"), "line {line}");
    }
    assert_eq!(client.run_out(&folder).1, json!(0));
}

/// A program whose pointer is set while events come: a timer in each cycle, and an interrupt whose condition calls.
const EVENTS: &str = "\
int ticks = 0
func bool odd(int n)
    int rest = n % 2
    return rest == 1
endfunc
func void tick()
    ticks = ticks + 1
endfunc
func void main()
    timer \"t\", interval:0.001, rmode:true, do:tick()
    interrupt 1, when:odd(ticks), do:tick()
    movej j:{60, -90, 90, 0, 90, 0}, vp:50%
    waittime 5
    print \"a\"
    waittime 5
    print \"b\"
endfunc
";

#[test]
fn events_go_on_while_it_is_set() {
    for clock in ["virtual", "real"] {
        let folder = Folder::new(&format!("pointer_events_{clock}")).with("main.arl", EVENTS);
        let mut client = Client::running(&folder, json!({"clock": clock}), &[12]);
        assert_eq!(reason_and_top(client.halt()), "breakpoint: main 12");
        client.set_breakpoints(&folder, "main.arl", json!([]));
        // Where a motion begins it halts between two cycles, while the program waits.
        assert_eq!(client.go("arl/nextMotion"), ("step".into(), vec!["main 13".into()]), "{clock}");
        assert_eq!(reason_and_top(client.go_to(&folder, 15)), "goto: main 15", "{clock}");
        assert_eq!(reason_and_top(client.go_to(&folder, 16)), "goto: main 16", "{clock}");
        assert_eq!(client.run_out(&folder), ("b\n".into(), json!(0)), "{clock}: {}", client.other_output);
    }
}

#[test]
fn what_hangs_on_a_condition_of_its_line_still_does() {
    let folder = Folder::new("pointer_compact").with(
        "main.arl",
        "func void main()\n    int n = 0\n    if(n > 5) n = 99\n    if(n > 5) goto over\n    print n\nover:\n    repeat\n        \
         n = n + 1\n        break\n    until(n > 3)\n    print \"end\"\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[3]);
    client.halt();
    client.set_breakpoints(&folder, "main.arl", json!([]));
    assert_eq!(reason_and_top(client.go_to(&folder, 3)), "goto: main 3");
    assert_eq!(reason_and_top(client.go("next")), "step: main 4");
    assert_eq!(client.value("n"), "0");
    assert_eq!(reason_and_top(client.go_to(&folder, 4)), "goto: main 4");
    assert_eq!(reason_and_top(client.go("next")), "step: main 5");
    // An `until` that is never reached is none to go to: the next statement is.
    assert_eq!(reason_and_top(client.go_to(&folder, 10)), "goto: main 11");
    assert_eq!(client.run_out(&folder), ("end\n".into(), json!(0)));
}

#[test]
fn variables_stay_in_functions_with_goto() {
    let folder = Folder::new("pointer_goto").with(
        "main.arl",
        "func void main()\n    int n = 0\n    double d = 25\n    const int most = 3\n    goto over\n    int x = 5\nover:\n    \
         x = 7\n    n = n + 1\n    print x, \" \", d, \" \", most\n    if(n < 2)\n        goto over\n    endif\nendfunc\n",
    );
    let mut client = Client::running(&folder, json!({}), &[9]);
    client.halt();
    let (_, locals) = client.scope("Locals");
    assert!(locals.contains(&"x = 7".to_owned()) && locals.contains(&"d = 25".to_owned()), "{locals:?}");
    assert_eq!(reason_and_top(client.go_to(&folder, 10)), "goto: main 10");
    assert_eq!(reason_and_top(client.go("next")), "step: main 11");
    assert_eq!(reason_and_top(client.go_to(&folder, 5)), "goto: main 5");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 9");
    assert_eq!((client.value("d"), client.value("x")), ("25".into(), "7".into()));
    assert_eq!(client.run_out(&folder), ("7 25 3\n7 25 3\n7 25 3\n".into(), json!(0)));
}

#[test]
fn variables_stay_in_functions_of_parts() {
    let mut text = "func void main()\n    int n = 1\n    while(n < 3)\n".to_owned();
    for at in 0..100 {
        let _ = writeln!(text, "        waittime 0.{:03}1", at);
    }
    text += "        n = n + 1\n        break\n    endwhile\n";
    for at in 0..100 {
        let _ = writeln!(text, "    waittime 0.{:03}1", at);
    }
    text += "    print n\nendfunc\n";
    let folder = Folder::new("pointer_parts").with("main.arl", &text);
    let mut client = Client::running(&folder, json!({}), &[150]);
    assert_eq!(reason_and_top(client.halt()), "breakpoint: main 150");
    assert_eq!(client.value("n"), "2");
    assert_eq!(reason_and_top(client.go_to(&folder, 20)), "goto: main 20");
    assert_eq!(client.value("n"), "2");
    assert_eq!(reason_and_top(client.go("continue")), "breakpoint: main 150");
    assert_eq!(client.value("n"), "3");
}

#[test]
fn a_step_back_undoes_it_with_what_was_set_since() {
    let folder = Folder::new("pointer_edits").with("main.arl", BRANCHES);
    let mut client = Client::running(&folder, json!({}), &[11]);
    client.halt();
    client.value("seen = 8");
    assert_eq!(reason_and_top(client.go_to(&folder, 14)), "goto: main 14");
    client.value("seen = 50");
    assert_eq!(reason_and_top(client.go("stepBack")), "step: main 11");
    assert_eq!(client.value("seen"), "8");
}
