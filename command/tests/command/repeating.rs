//! The same programs, cell and scenario give the same messages and traces, byte for byte: at every start, however busy
//! the machine is, and however far the runtime and the programs are optimised.

use super::{Answer, Folder, cache};
use std::process::{Child, Stdio};

/// Blends and stops in the profiles S and O, interrupts within each other, timers, triggers, io and chance.
const MAIN: &str = "\
int ticks
int marks

func void note(string what)
  print what,\" \",$TRAJ_ELAPSE_DIS,\" \",ticks
  pulsedo(4,true,0.1)
endfunc

func void hold()
  stopmove fast
  waittime 0.05 + rand() % 10 / 1000.0
  print \"held at \",cjoint()
  startmove
endfunc

func void aside(pose p)
  stopmove
  lin offset(p,0,0,0,20,0,0),vl:150mm/s
  startmove 1
endfunc

func void work(double size)
  movej j:{0,-90,90,0,60,0},vp:60%,sp:30%
  waittime 0
  pose p = cpose($FLANGE,$WORLD)
  trigger 20,when:P(40),do:note(\"trigger\")
  lin offset(p,0,size,0,0,0,0),vl:400mm/s,sl:30mm;S(20),note(\"S\")
  lin offset(p,0,size,size,10,0,0),vl:400mm/s,sl:30mm;StoEnd(15),setdo(1,true);T(0.1),marks++
  cir m:offset(p,50,size / 2,size * 1.2,0,0,0),p:offset(p,0,0,size,0,0,0),vl:300mm/s,sl:20mm
  spl offset(p,0,0,size / 2,0,0,0),vl:200mm/s
  spl offset(p,0,-20,0,0,0,0),vl:200mm/s
  movej j:{30,-80,85,10,50,20},vp:80%,sp:40%
  movej j:{0,-90,90,0,60,0},vp:80%
  setdo(2,true)
  waittime 0.1
  setdo(2,false)
endfunc

func void main()
  timer priority:200,interval:0.037,rmode:true,do:ticks++
  interrupt 5,when:getdi(1) && ticks > 3,do:hold()
  pose p = getpose({0,-90,90,0,60,0},$FLANGE,$WORLD)
  interrupt \"aside\",priority:6,when:getdi(2),do:aside(p)
  $VEL_PROFILE = S_type
  work(120)
  $VEL_PROFILE = O_type
  work(100)
  print marks,\" \",ticks,\" \",rand() % 1000
endfunc
";

/// Another robot in the profile O, and its part of the io.
const SECOND: &str = "\
func void main()
  $VEL_PROFILE = O_type
  for(int i = 0; i < 3; i++)
    movej j:{-40,-85,90,0,40,0},vp:90%,sp:50%
    movej j:{10,-80,80,20,60,0},vp:90%,sp:50%
    movej j:{40,-90,70,0,50,90},vp:90%
    waituntil getdo(1),maxtime:0.3
    setdo(3,getdo(3) == false)
    print \"second \",i,\" \",cjoint()
  endfor
endfunc
";

const BACKGROUND: &str = "\
int edges
func void count()
  edges++
  print \"edge \",edges,\" \",getdo(1),\" \",rand() % 1000
endfunc

func void main()
  interrupt 1,when:getdo(3) || getdo(4),do:count()
  loop
    waittime 0.01
    if(getdo(2)) setdo(5,true)
  endloop
endfunc
";

const CELL: &str = "[[channel]]\nprogram = \"second.arl\"\nrobot = \"six-10\"\n[[channel]]\nprogram = \"back.arl\"\nbackground = true\n";

const SCENARIO: &str = "\
[[event]]
at = 1.4
di.1 = true
[[event]]
at = 2.0
di.2 = true
[[event]]
at = 2.2
di.1 = false
override = 70
[[event]]
at = 3.5
pendant = \"pause\"
[[event]]
at = 4.0
pendant = \"start\"
[[event]]
at = 4.3
override = 100
di.1 = true
[[event]]
when = \"do.4\"
after = 0.02
ai.1 = 2.5
";

/// What a run gave: its messages, and the trace of each robot.
#[derive(PartialEq)]
struct Ran {
    answer: Answer,
    traces: [String; 2],
}

/// How a program is run.
#[derive(Clone, Copy, PartialEq, Eq)]
enum How {
    /// Compiled, as programs are as a rule.
    Optimised,
    /// Compiled without any optimisation, and with all checks that are left out otherwise.
    Plain,
    /// By the engine.
    Engine,
}

/// Runs at the same time: the threads that find laws are in each other's way then.
fn run_at_once(folder: &Folder, how: How, count: usize) -> Vec<Ran> {
    let start = |at: usize| {
        let trace = format!("t{at}.csv");
        let mut command = folder.command(&["run", "main.arl", "--cell", "cell.toml", "--io", "s.toml"]);
        command.args(["--max-time", "60", "--trace", &trace]).stdout(Stdio::piped()).stderr(Stdio::piped());
        command.args(["--engine", if how == How::Engine { "engine" } else { "native" }]);
        if how == How::Plain {
            command.env("ARL2RS_CACHE", cache().with_file_name("cache-plain"));
            for (setting, value) in [("OPT_LEVEL", "0"), ("OVERFLOW_CHECKS", "true"), ("DEBUG_ASSERTIONS", "true")] {
                command.env(format!("CARGO_PROFILE_DEV_{setting}"), value);
            }
        }
        command.spawn().expect("it starts")
    };
    let children: Vec<Child> = (0..count).map(start).collect();
    let end = |(at, child): (usize, Child)| {
        let answer = Answer::of(child.wait_with_output().expect("it ends"));
        Ran { answer, traces: [folder.read(&format!("t{at}.csv")), folder.read(&format!("t{at}.2.csv"))] }
    };
    children.into_iter().enumerate().map(end).collect()
}

/// Fails where a run is not the same as another one, and says where.
#[track_caller]
fn assert_same(first: &Ran, other: &Ran, what: &str) {
    // What is said while something is compiled, is said by the first run alone.
    assert_eq!((first.answer.code, &first.answer.out), (other.answer.code, &other.answer.out), "{what}");
    for (robot, (a, b)) in first.traces.iter().zip(&other.traces).enumerate() {
        let differs = a.lines().zip(b.lines()).find(|(a, b)| a != b);
        assert!(a == b, "{what}, the trace of robot {}: {differs:?}", robot + 1);
    }
}

#[test]
fn a_run_is_the_same_every_time() {
    let folder =
        Folder::new("repeating").with("main.arl", MAIN).with("second.arl", SECOND).with("back.arl", BACKGROUND);
    folder.write("cell.toml", CELL);
    folder.write("s.toml", SCENARIO);
    // The first run compiles.
    let mut runs = run_at_once(&folder, How::Optimised, 1);
    runs.extend(run_at_once(&folder, How::Optimised, 5));
    runs.extend((0..4).flat_map(|_| run_at_once(&folder, How::Optimised, 1)));
    let first = &runs[0];
    assert_eq!(first.answer.code, Some(0), "{}", first.answer.err);
    // It did what it is meant to do.
    for words in ["held at", "trigger ", "S ", "edge ", "second 2"] {
        assert!(first.answer.out.contains(words), "{words}: {}", first.answer.out);
    }
    assert!(first.traces.iter().all(|trace| trace.lines().count() > 4000));
    assert_eq!(runs.len(), 10);
    for (at, run) in runs.iter().enumerate() {
        assert_same(first, run, &format!("run {at}"));
    }

    let plain = run_at_once(&folder, How::Plain, 1).into_iter();
    for run in plain.chain((0..3).flat_map(|_| run_at_once(&folder, How::Plain, 3))) {
        assert_same(first, &run, "without optimisation");
    }
    for run in run_at_once(&folder, How::Engine, 2) {
        assert_same(first, &run, "by the engine");
    }
}
