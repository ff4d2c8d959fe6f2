//! Both sides of the interface, in one process: the library is this test itself.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may fail")]

use std::cell::Cell;
use std::ffi::{c_char, c_void};

use arl_library::{INTERFACE, Interface, Library, LoadError, Served, Session, WRONG_THREAD};
use arl_rt::emit::*;
use arl_rt::program::Other;

const FILE: File = File::new("fill.arl");

/// Opens a valve, waits for the sensor on input 1, moves, and divides by what input 1 of the analog ones has.
#[derive(Default)]
struct Fill {
    litres: Cell<i32>,
}

impl Program for Fill {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn init<'a>(&'a self, _cx: &'a Cx) -> BoxFuture<'a> {
        self.litres.set(12);
        Box::pin(async { Ok(()) })
    }

    fn variables(&self) -> Vec<DataFile<'_>> {
        vec![DataFile { file: "fill.arl", vars: vec![DataVar { name: "litres", sizes: &[], slot: &self.litres }] }]
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            io::setdo(cx, 1, true).await.at(FILE, 1)?;
            flow::waituntil(cx).start().await.at(FILE, 2)?;
            while !io::getdi(cx, 1).await.at(FILE, 2)? {
                cx.change().await;
            }
            motion::movej(Joint::of_axes([10.0, -90.0, 90.0, 0.0, 45.0, 0.0])).run(cx).await.at(FILE, 3)?;
            flow::waittime(0.0).run(cx).await.at(FILE, 4)?;
            let divisor = io::getai(cx, 1).await.at(FILE, 5)? as i32;
            assert_ne!(divisor, 7, "a bug of the runtime");
            text::print().argtoprint(&div(self.litres.get(), divisor).at(FILE, 5)?).run(cx).at(FILE, 5)
        })
    }
}

fn make() -> Fill {
    Fill::default()
}

fn nobody() -> Box<dyn Program> {
    Box::new(Fill::default())
}

arl_library::library!(make, [Other { file: "other.arl", folder: "", make: &nobody }], ".");

fn library() -> Library {
    // SAFETY: it is what the function gave, and a static.
    unsafe { Library::of(arl_interface()) }.unwrap()
}

fn begun(arguments: &[&str]) -> Session {
    library().begin(arguments, true).unwrap()
}

#[test]
fn a_run_goes_on_as_far_as_it_is_asked_to_and_takes_orders() {
    let mut run = begun(&[]);
    assert_eq!(run.go_on(100, false), Ok(None));
    assert_eq!(run.time(), 0.1);
    assert!(run.state().contains("\"do\":\"1000"), "{}", run.state());
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 4.0").unwrap();
    assert_eq!(run.go_on(u64::MAX, false), Ok(Some(0)));
    let output = run.take_said();
    assert!(output.starts_with("{\"message\":") && output.contains("\"text\":\"3\""), "{output}");
    assert_eq!(run.take_said(), "");
    // It is over, and stays so.
    assert_eq!(run.go_on(1, false), Ok(Some(0)));
    assert_eq!(run.order("pendant = \"reset\""), Err(LoadError::Refused("the run is over".into())));
}

#[test]
fn what_came_of_a_run_is_reported_with_what_its_motions_did() {
    let mut run = begun(&["--report"]);
    assert!(run.summary().starts_with("{\"outcome\":\"runs\",\"code\":null,\"cycle_time\":0.0"), "{}", run.summary());
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 4.0").unwrap();
    run.go_on(u64::MAX, true).unwrap();
    let (summary, report) = (run.summary(), run.report());
    assert!(summary.starts_with("{\"outcome\":\"ended\",\"code\":0,"), "{summary}");
    assert!(
        summary.contains("\"motions\":1,\"way\":") && summary.contains("\"alarms\":[],\"ended_by\":null}"),
        "{summary}"
    );
    assert_eq!(report.lines().count(), 2, "{report}");
    let mut run = begun(&[]);
    run.order("di.1 = true").unwrap();
    run.go_on(u64::MAX, true).unwrap();
    assert!(run.summary().contains("\"outcome\":\"alarm\",\"code\":3,"), "{}", run.summary());
    assert!(run.summary().contains("\"alarms\":[{\"number\":20001,"), "{}", run.summary());
}

#[test]
fn rows_of_the_trace_name_the_files_of_their_lines_where_that_is_asked_for() {
    let columns = library().columns().len();
    let mut run = begun(&["--trace-columns", "file"]);
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 4.0").unwrap();
    run.go_on(u64::MAX, true).unwrap();
    let rows = run.take_rows();
    assert_eq!(rows.len() % (columns + 1), 0);
    let moves = |row: &&[f64]| row[2] != 0.0;
    let (moving, standing): (Vec<&[f64]>, Vec<&[f64]>) = rows.chunks(columns + 1).partition(moves);
    assert!(moving.len() > 10 && moving.iter().all(|row| row[columns] == 0.0));
    assert!(standing.iter().all(|row| row[columns].is_nan()));
    assert_eq!(run.files(), ["fill.arl"]);
    assert_eq!(
        library().begin(&["--trace-columns", "tcp"], true).unwrap_err().to_string(),
        "--trace-columns tcp: `tcp` is not a column: expected file"
    );
}

#[test]
fn what_is_watched_comes_behind_the_row_of_the_trace() {
    let mut run = begun(&[]);
    run.watch(&["do.1", "di.1", "ai.1", "global.litres"]).unwrap();
    run.order("ai.1 = 2.5").unwrap();
    run.go_on(10, false).unwrap();
    let columns = library().columns().len();
    let mut numbers = vec![-1.0; columns + 5];
    assert_eq!(run.observe(&mut numbers), columns + 4);
    assert_eq!((numbers[0], numbers[3], &numbers[columns..]), (0.009, 0.0, &[1.0, 0.0, 2.5, 12.0, -1.0][..]));
    let mut few = [0.0; 2];
    assert_eq!(run.observe(&mut few), columns + 4);
    assert_eq!(run.observe(&mut []), columns + 4);
    for (name, words) in [
        ("do.5000", "no such signal"),
        ("door", "`door` is neither a signal nor"),
        ("global.liters", "did you mean `litres`?"),
        ("internal.1", "or it cannot be watched"),
    ] {
        let refused = run.watch(&[name]).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
    assert_eq!(run.observe(&mut []), columns + 4, "what was watched stays");
}

#[test]
fn global_variables_are_set_before_a_run_and_in_it() {
    let mut run = begun(&["--set", "global.litres=20"]);
    assert_eq!(run.go_on(10, false), Ok(None));
    assert_eq!(run.global("litres"), Ok("20".into()));
    run.set_global("Litres", "40").unwrap();
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 4.0").unwrap();
    run.go_on(u64::MAX, true).unwrap();
    assert!(run.take_said().contains("\"text\":\"10\""));
    for (name, value, words) in [
        ("litre", "1", "did you mean `litres`?"),
        ("litres", "x", "global variable `litres` = x: expected a value of type int"),
        ("litres", "1 +", "global variable `litres` = 1 +:"),
    ] {
        let refused = run.set_global(name, value).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
    assert!(run.global("other").is_err());
}

#[test]
fn the_trace_has_a_row_a_cycle() {
    let columns = library().columns();
    assert_eq!((columns.len(), &*columns[0], &*columns[3]), (21, "t", "j1"));
    let mut run = begun(&[]);
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 4.0").unwrap();
    assert_eq!(run.go_on(10, false), Ok(None));
    let first = run.take_rows();
    assert_eq!(first.len(), 10 * columns.len());
    assert_eq!(run.go_on(u64::MAX, false), Ok(Some(0)));
    let rows: Vec<f64> = first.into_iter().chain(run.take_rows()).collect();
    let rows: Vec<&[f64]> = rows.chunks(columns.len()).collect();
    assert!(rows.iter().enumerate().all(|(at, row)| (row[0] - at as f64 * 0.001).abs() < 1e-9));
    assert_eq!(rows.last().unwrap()[3], 10.0);
    assert!(rows[0][9].is_nan(), "there is no external axis");
}

#[test]
fn the_trace_is_that_of_the_file() {
    let file = std::env::temp_dir().join(format!("arl-library-{}.csv", std::process::id()));
    let mut run = begun(&["--trace", file.to_str().unwrap()]);
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 4.0").unwrap();
    assert_eq!(run.go_on(u64::MAX, true), Ok(Some(0)));
    let rows = run.take_rows();
    let rows: Vec<&[f64]> = rows.chunks(library().columns().len()).collect();
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next().map(str::to_owned), Some(library().columns().join(",")));
    let lines: Vec<&str> = lines.collect();
    assert_eq!(lines.len(), rows.len());
    for (line, row) in lines.iter().zip(rows) {
        let same = |(written, value): (&str, &f64)| match written.parse::<f64>() {
            Ok(written) => (written - value).abs() < 1e-6,
            Err(_) => written.is_empty() && value.is_nan(),
        };
        assert!(line.split(',').zip(row).all(same), "{line}: {row:?}");
    }
}

/// A run that another thread has a pointer to.
struct Lent(*mut Served);

// SAFETY: the other thread does with it what `arl.h` allows.
unsafe impl Send for Lent {}

#[test]
fn other_threads_may_stop_a_run_and_nothing_else() {
    unsafe extern "C" fn forget(_: *mut c_void, _: *const c_char, _: usize) {}
    // SAFETY: it is what the function gave.
    let arl = unsafe { &*arl_interface() };
    // SAFETY: there are no arguments.
    let run = unsafe { (arl.begin)(std::ptr::null(), 0, 0, forget, std::ptr::null_mut()) };
    let lent = Lent(run);
    let other = std::thread::spawn(move || {
        let Lent(run) = { lent };
        // SAFETY: the run lives until this thread has ended.
        unsafe {
            assert_eq!((arl.go_on)(run, 1, 0), WRONG_THREAD);
            assert_eq!((arl.order)(run, c"di.1 = true".as_ptr(), forget, std::ptr::null_mut()), WRONG_THREAD);
            assert!((arl.time)(run).is_nan());
            (arl.end)(run);
            (arl.stop)(run);
        }
    });
    // It waits for an input, for ever.
    // SAFETY: this is its thread.
    assert_eq!(unsafe { (arl.go_on)(run, u64::MAX, 0) }, 130);
    other.join().unwrap();
    // SAFETY: this is its thread, and nobody has it any more.
    unsafe { (arl.end)(run) };
}

#[test]
fn alarms_have_their_exit_code_and_their_line() {
    let mut run = begun(&[]);
    run.order("di.1 = true").unwrap();
    assert_eq!(run.go_on(u64::MAX, true), Ok(Some(3)));
    let output = run.take_said();
    assert!(output.contains("{\"alarm\":{\"number\":20001,") && output.contains("\"line\":5}"), "{output}");
}

#[test]
fn what_waits_in_vain_ends_where_nobody_else_is_there() {
    let mut run = begun(&[]);
    assert_eq!(run.go_on(100_000, true), Ok(Some(4)));
    assert!(run.take_said().contains("nothing can change any more"), "it says why");
    let mut run = begun(&[]);
    assert_eq!(run.go_on(100_000, false), Ok(None));
}

#[test]
fn it_ends_when_its_time_is_over_or_it_is_stopped() {
    let mut run = begun(&["--max-time", "0.5"]);
    assert_eq!(run.go_on(u64::MAX, false), Ok(Some(4)));
    assert!((run.time() - 0.5).abs() < 0.01, "{}", run.time());
    let mut run = begun(&[]);
    assert_eq!(run.go_on(10, false), Ok(None));
    run.stop();
    assert_eq!(run.go_on(u64::MAX, false), Ok(Some(130)));
}

#[test]
fn who_listens_hears_a_run_to_its_end() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let mut run = begun(&["--listener", &address, "--each-cycle", "--max-time", "0.1"]);
    assert_eq!(run.go_on(u64::MAX, false), Ok(Some(4)));
    // It is over for who listens, too, while the run is still there.
    let heard = std::io::read_to_string(listener.accept().unwrap().0).unwrap();
    assert!(heard.starts_with("{\"hello\":") && heard.ends_with("{\"ended\":0}\n"), "{heard}");
    assert_eq!(heard.matches("{\"cycle\":").count() as f64, (run.time() * 1000.0).round());
    assert!(run.summary().contains("time_over"), "{}", run.summary());
    match library().begin(&["--listener", "127.0.0.1:1"], false) {
        Err(LoadError::Refused(why)) => assert!(why.contains("there is no listener at 127.0.0.1:1"), "{why}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_wrong_is_reported() {
    let refused = |arguments: &[&str]| match library().begin(arguments, false) {
        Err(LoadError::Refused(why)) => why,
        other => panic!("{arguments:?}: {other:?}"),
    };
    assert!(refused(&["--robot", "nobody"]).contains("nobody"));
    assert!(refused(&["--override", "200"]).contains("percent from 0 to 100"));
    for option in ["--live", "--paused", "--each-cycle", "--report=FILE", "--realtime"] {
        assert!(
            refused(&[option]).contains(&format!("{option} is only for a program that runs on its own")),
            "{option}"
        );
    }
    assert!(refused(&["--speed"]).contains("--speed"));
    assert!(refused(&["a\0b"]).contains("NUL character"));
    let mut run = begun(&[]);
    assert!(matches!(run.order("di.1 = maybe"), Err(LoadError::Refused(_))));
    assert!(matches!(run.order("\0"), Err(LoadError::Refused(_))));
}

#[test]
fn a_panic_breaks_its_run_alone() {
    let mut run = begun(&[]);
    run.order("di.1 = true").unwrap();
    run.order("ai.1 = 7.0").unwrap();
    assert_eq!(run.go_on(u64::MAX, false), Err(LoadError::Broken));
    assert_eq!(run.go_on(1, false), Err(LoadError::Broken));
    assert_eq!(run.order("di.1 = true"), Err(LoadError::Broken));
    assert!(!run.take_rows().is_empty(), "what led to it is there");
    drop(run);
    assert_eq!(begun(&[]).go_on(10, false), Ok(None));
}

#[test]
fn another_version_is_reported() {
    // SAFETY: it is what the function gave, and a static.
    let ours = unsafe { *arl_interface() };
    let theirs: &'static Interface = Box::leak(Box::new(Interface { version: INTERFACE + 1, ..ours }));
    // SAFETY: it lives as long as the process.
    let opened = unsafe { Library::of(theirs) };
    assert_eq!(opened.unwrap_err(), LoadError::Version(INTERFACE + 1));
}

#[test]
fn what_is_no_library_is_reported() {
    let open = |path: &str| {
        // SAFETY: there is no such file, or no library.
        unsafe { Library::open(path.as_ref()) }.unwrap_err()
    };
    assert!(matches!(open("/nowhere/libnothing.so"), LoadError::Open(_)));
    assert!(matches!(open(concat!(env!("CARGO_MANIFEST_DIR"), "/arl.h")), LoadError::Open(_)));
    if cfg!(all(target_os = "linux", target_env = "gnu")) {
        assert_eq!(open("libm.so.6"), LoadError::NotOurs);
    }
}
