//! Random motion programs on robots that are built in, and on others with random limits: what the trace says about
//! limits, paths, corners, targets, stops and overrides.

mod check;
mod geometry;
mod grow;
mod plan;
mod promise;
mod robot;
mod scenario;
mod trace;

use crate::{BY_ENGINE, first_seed, report, times};
use arl_lang::catalog::Family;
use arl_tests::engine;
use arl_tests::project::{Project, compile_for};
use arl_tests::random::Random;
use arl2rs::CheckOptions;
use arl2rs::emit::Sizes;
use check::Tally;
use grow::{ROOMS, Wishes};
use plan::{Mode, Motion, Plan, Zone};
use robot::Robot;
use scenario::{Disturbance, Scenario};
use std::path::Path;
use std::process::Command;
use trace::Row;

/// What happens to how many of eight programs.
const DISTURBANCES: [Disturbance; 8] = [
    Disturbance::Overrides,
    Disturbance::Inputs,
    Disturbance::Inputs,
    Disturbance::Overrides,
    Disturbance::Steps,
    Disturbance::Pauses,
    Disturbance::Overrides,
    Disturbance::Pauses,
];

/// In which mode they run.
const MODES: [Mode; 8] =
    [Mode::Auto, Mode::Auto, Mode::Auto, Mode::Manual, Mode::Auto, Mode::Auto, Mode::ManualFast, Mode::Auto];

/// A program with its robot and what happens meanwhile.
struct Case {
    name: String,
    robot: Robot,
    plan: Plan,
    scenario: Scenario,
}

/// An axis that would have to leave its range.
struct TurnedOut {
    /// From 0.
    axis: usize,
    line: usize,
}

impl Case {
    /// A case that is grown anew.
    fn new(seed: u64) -> Case {
        let mut random = Random::new(seed);
        let room = seed as usize % ROOMS.len();
        let limits = if random.chance(50) { 1 + random.next() % 1_000_000 } else { 0 };
        let external = *random.pick(&[0, 0, 1, 2]);
        let robot = Robot::of(&format!("{} {limits} {external}", ROOMS[room].robot));
        let passes = room == ROOMS.len() - 1;
        // In any eight seeds in a row there is some of everything, and each robot gets everything in time.
        let round = (seed / ROOMS.len() as u64) as usize;
        let disturbance = if passes { Disturbance::Overrides } else { DISTURBANCES[(3 * room + round) % 8] };
        let mode = MODES[(room + 3 * round) % 8];
        let wishes = Wishes {
            count: if mode == Mode::Manual { 16 } else { 24 },
            passes,
            stops: disturbance == Disturbance::Inputs,
            mode,
        };
        let plan = grow::plan(&mut random, ROOMS[room], &robot, wishes);
        let scenario = Scenario::grow(&mut random, disturbance, &robot);
        Case { name: seed.to_string(), robot, plan, scenario }
    }

    /// A case that was kept: `NAME.arl`, whose first lines say why, and of which robot, with what happens in
    /// `NAME.io.toml`.
    fn kept(path: &Path) -> Case {
        let text = std::fs::read_to_string(path).unwrap();
        let robot = text.lines().find_map(|line| line.strip_prefix("// robot: ")).expect("a line that names the robot");
        let scenario = std::fs::read_to_string(path.with_extension("io.toml")).unwrap_or_default();
        let robot = Robot::of(robot);
        Case {
            name: path.file_stem().expect("a name").to_string_lossy().into_owned(),
            plan: Plan::read(&text, &robot.tcp),
            scenario: Scenario::read(&scenario, &robot),
            robot,
        }
    }

    /// How the program is checked, and its file.
    fn source(&self) -> (CheckOptions, [(String, String); 1]) {
        let family = if self.robot.scara { Family::Scara } else { Family::SixAxis };
        (CheckOptions { family, ..CheckOptions::default() }, [("main.arl".into(), self.plan.text.clone())])
    }

    /// The Rust of the program, in the forms of programs of such sizes.
    fn compile(&self, sizes: Sizes) -> Result<String, String> {
        let (options, files) = self.source();
        compile_for(&files, &options, sizes)
    }

    /// The command that runs the program by the engine.
    fn by_engine(&self, project: &Project) -> Command {
        let (options, files) = self.source();
        let file = self.file(project, "code");
        engine::write(engine::lowered(&files, &options).unwrap(), &file);
        engine::command(Path::new(BY_ENGINE), &file, project.folder())
    }

    /// Whether two commands that run the program go the same way to the last bit.
    fn move_identically(&self, project: &Project, [one, other]: [Command; 2]) -> bool {
        let trace = |command: Command| {
            let failure = self.run(project, command, true).err();
            (failure, std::fs::read(self.file(project, "disturbed.csv")).unwrap())
        };
        trace(one) == trace(other)
    }

    /// Runs the program `at` of a command, undisturbed and then as the scenario says, and tells what is wrong with the
    /// traces.
    fn test(&self, project: &Project, command: &Path, at: usize, tally: &mut Tally) -> Option<String> {
        let mut faults = Vec::new();
        self.examine(project, command, at, &mut faults, tally);
        (!faults.is_empty()).then(|| self.failure(project, &faults))
    }

    /// Tells what is wrong with the traces; returns the undisturbed one, unless it failed, and whether it is of this
    /// robot: not where an axis had to turn freely for it.
    fn examine(
        &self,
        project: &Project,
        command: &Path,
        at: usize,
        faults: &mut Vec<String>,
        tally: &mut Tally,
    ) -> Option<(Vec<Row>, bool)> {
        self.write(project);
        let undisturbed = match self.run(project, project.choose(command, at), false) {
            Ok(rows) => rows,
            Err(failure) => {
                let Some(turned) = self.turned_out(&failure) else {
                    faults.push(failure);
                    return None;
                };
                let rows = self.examine_turning_freely(&turned, (project, command, at), faults, tally);
                return rows.map(|rows| (rows, false));
            }
        };
        faults.extend(check::check(&self.robot, &self.plan, &undisturbed, &Scenario::default(), None, tally));
        if at == 0 && faults.is_empty() {
            self.assert_objections(&undisturbed);
        }
        if !self.scenario.events.is_empty() {
            let found = match self.run(project, project.choose(command, at), true) {
                Ok(rows) => check::check(&self.robot, &self.plan, &rows, &self.scenario, Some(&undisturbed), tally),
                Err(failure) => vec![failure],
            };
            faults.extend(found.into_iter().map(|fault| format!("disturbed: {fault}")));
        }
        Some((undisturbed, true))
    }

    /// Every passage through the wrist singularity may turn axes 4 and 6 by half a turn, until the range of one of them
    /// ends: with an alarm. Is it one of these, then of which axis, and of which line?
    fn turned_out(&self, failure: &str) -> Option<TurnedOut> {
        let (_, alarm) = failure.split_once("alarm 20020: j")?;
        let (axis, rest) = alarm.split_once(" would have to go to ")?;
        let (to, _) = rest.split_once(", but its range is ")?;
        let line = rest.rsplit_once("(main.arl:")?.1.split(')').next()?.parse().ok()?;
        let (axis, to) = (axis.parse::<usize>().ok()?.checked_sub(1)?, to.parse::<f64>().ok()?);
        let range = self.robot.axes[axis].min..=self.robot.axes[axis].max;
        let passes = self.plan.motions.iter().any(|motion| motion.wrist && motion.line == line);
        (passes && matches!(axis, 3 | 5) && !range.contains(&to)).then_some(TurnedOut { axis, line })
    }

    /// Where an axis ends the program, as its range ends, everything must hold of the same robot whose axis turns
    /// freely. There the axis really leaves its range in that line, and up to the alarm the robots go the same way:
    /// unless it leaves it earlier, on another way through the wrist, from where on they are not compared. Where the
    /// other axis has to turn freely as well, that one may take another way through the wrist, on which this one stays
    /// within its range.
    fn examine_turning_freely(
        &self,
        turned: &TurnedOut,
        (project, command, at): (&Project, &Path, usize),
        faults: &mut Vec<String>,
        tally: &mut Tally,
    ) -> Option<Vec<Row>> {
        let stopped = trace::read(&std::fs::read_to_string(self.file(project, "csv")).unwrap());
        let TurnedOut { axis, line } = *turned;
        let free = Case {
            name: format!("{}-j{}", self.name, axis + 1),
            robot: self.robot.turning_freely(axis),
            plan: self.plan.clone(),
            scenario: self.scenario.clone(),
        };
        let (rows, is_its_own) = free.examine(project, command, at, faults, tally)?;
        let range = self.robot.axes[axis].min..=self.robot.axes[axis].max;
        let exit = rows.iter().position(|row| !range.contains(&row.axes[axis]));
        // Where the free axis turns out already, the other one was turned to the other side: from there on they go
        // apart.
        let apart = exit.map(|at| rows[at].line).filter(|apart| self.comes_before(*apart, line));
        let apart_from = apart.map(|apart| self.blended_from(apart));
        let many = apart_from.and_then(|from| stopped.iter().position(|row| row.line == from)).unwrap_or(stopped.len());
        faults.extend(check::check_stopped(&self.robot, &self.plan, (&stopped, many), &rows, tally));
        if apart.is_some() || (exit.is_none() && !is_its_own) {
            return Some(rows);
        }
        let is_there = |at: usize| {
            rows[at].line == line || self.leads_into(line, &rows, at) || self.blends_into(line, rows[at].line)
        };
        if !exit.is_some_and(is_there) {
            let (axis, exit) = (axis + 1, exit.map(|at| rows[at].line));
            faults.push(format!("the alarm says that j{axis} leaves its range in line {line}; it does in {exit:?}"));
        }
        Some(rows)
    }

    /// Whether a motion through the wrist comes before another motion, and does not lead into it.
    fn comes_before(&self, line: usize, other: usize) -> bool {
        let place = |line: usize| self.plan.motions.iter().position(|motion| motion.line == line);
        let passes = place(line).is_some_and(|at| self.plan.motions[at].wrist);
        passes && place(line).zip(place(other)).is_some_and(|(at, other)| at + 1 < other)
    }

    /// The line from which on the way may depend on a motion: that before it, where a blend leads from there.
    fn blended_from(&self, line: usize) -> usize {
        let motions = &self.plan.motions;
        let at = motions.iter().position(|motion| motion.line == line);
        let before = at.and_then(|at| motions.get(at.checked_sub(1)?)).filter(|before| !before.rests);
        before.map_or(line, |before| before.line)
    }

    /// Whether a blend leads from one motion to another, which may take away the end of the first one.
    fn blends_into(&self, line: usize, next: usize) -> bool {
        let pairs = self.plan.motions.windows(2);
        pairs.into_iter().any(|pair| pair[0].line == line && !pair[0].rests && pair[1].line == next)
    }

    /// Whether a row may be of the half of a blend that leads into a motion: of the one before, in the second half of
    /// its time.
    fn leads_into(&self, line: usize, rows: &[Row], at: usize) -> bool {
        let motions = &self.plan.motions;
        let next = motions.iter().position(|motion| motion.line == line);
        let before = next.and_then(|next| motions.get(next.checked_sub(1)?)).filter(|before| !before.rests);
        before.is_some_and(|before| {
            let of = |row: &Row| row.line == before.line;
            let (first, last) = (rows.iter().position(of), rows.iter().rposition(of));
            of(&rows[at]) && first.zip(last).is_some_and(|(first, last)| 2 * at >= first + last)
        })
    }

    /// Writes what its runs need, and what a person may want to see.
    fn write(&self, project: &Project) {
        let write = |ending: &str, text: &str| std::fs::write(self.file(project, ending), text).unwrap();
        write("robot.toml", &self.robot.text);
        write("arl", &self.plan.text);
        write("io.toml", &self.scenario.text);
    }

    fn file(&self, project: &Project, ending: &str) -> std::path::PathBuf {
        project.folder().join(format!("{}.{ending}", self.name))
    }

    /// The rows of the trace.
    ///
    /// # Errors
    /// What the run said, where it failed.
    fn run(&self, project: &Project, mut run: Command, disturbed: bool) -> Result<Vec<Row>, String> {
        let trace = self.file(project, if disturbed { "disturbed.csv" } else { "csv" });
        run.arg("--robot").arg(self.file(project, "robot.toml")).arg("--trace").arg(&trace).args([
            "--max-time",
            "900",
            "--mode",
            self.plan.mode.word(),
        ]);
        if disturbed {
            run.arg("--io").arg(self.file(project, "io.toml"));
        }
        let run = run.output().unwrap();
        if run.status.success() {
            return Ok(trace::read(&std::fs::read_to_string(trace).unwrap()));
        }
        Err(format!("{}: {}", run.status, String::from_utf8_lossy(&run.stderr)))
    }

    /// The checks would find a jolt, a line that is none, a missed target, and zones that are too small for the blends.
    fn assert_objections(&self, rows: &[Row]) {
        let finds = |plan: &Plan, rows: &[Row], what: &str| {
            let faults = check::check(&self.robot, plan, rows, &Scenario::default(), None, &mut Tally::default());
            assert!(faults.iter().any(|fault| fault.contains(what)), "nobody objects: {what}; {faults:?}");
        };
        let mut jolt = rows.to_vec();
        jolt[rows.len() / 2].axes[0] += 0.01;
        finds(&self.plan, &jolt, "acceleration of j1");
        let mut gone = rows.to_vec();
        let axes = &mut gone[rows.len() / 2].axes;
        (axes[0], axes[2]) = (axes[0] + 0.1, axes[2] - 0.1);
        let faults = check::compare(rows, &gone, &mut Tally::default());
        assert!(faults.iter().any(|fault| fault.contains("undisturbed")), "nobody objects to a row beside the path");
        let (mut bent, mut missed) = (rows.to_vec(), rows.to_vec());
        // Where the tool stands it is the axes that tell.
        let shift = |row: &mut Row, motion: &Motion, by: f64| {
            let held = self.plan.settings[motion.setting].held;
            row.tcp.translation.vector.x += if held { 0.0 } else { by };
            row.axes[0] += if held { by } else { 0.0 };
        };
        let last = self.plan.motions.last().expect("a motion");
        let end = rows.iter().rposition(|row| row.line == last.line).expect("rows of the last motion");
        shift(&mut missed[end], last, 1e-4);
        let on_lines = check::places_on_lines(&self.robot, &self.plan, rows);
        for at in &on_lines {
            let motion = self.plan.motions.iter().find(|motion| motion.line == rows[*at].line);
            shift(&mut bent[*at], motion.expect("a motion of each row"), 0.01);
        }
        // Only a program that is always the same surely has some.
        if !on_lines.is_empty() || first_seed() == 0 {
            finds(&self.plan, &bent, "off the path");
        }
        finds(&self.plan, &missed, "is missed");
        let mut narrow = self.plan.clone();
        for motion in &mut narrow.motions {
            motion.zone = match motion.zone {
                Zone::Distance(size) => Zone::Distance(size / 10.0),
                other => other,
            };
        }
        finds(&narrow, rows, "from the corner of line");
    }

    fn failure(&self, project: &Project, faults: &[String]) -> String {
        let files = self.file(project, "*");
        let (faults, why) = (faults.join("\n"), &self.plan.text);
        format!("{} on {}, see {}\n{faults}\n{why}", self.name, self.robot.name, files.display())
    }
}

/// What runs found once, reduced.
fn kept() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("property/motions/kept");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "arl"));
    paths.sort();
    paths.iter().map(|path| Case::kept(path)).collect()
}

#[test]
fn motions_keep_limits_paths_corners_and_targets() {
    let grown_count = 8 * times() as usize;
    let grown = (first_seed()..).map(Case::new).take(grown_count);
    // What was kept is the same whatever the seed.
    let kept = if first_seed() == 0 { kept() } else { Vec::new() };
    let cases: Vec<Case> = grown.chain(kept).collect();
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-motions");
    let mut failures = Vec::new();
    let mut programs = Vec::new();
    // Those that are grown anew once more, in all forms that large programs have.
    let again = cases.iter().take(grown_count).map(|case| (case, Sizes::LEAST));
    for (case, sizes) in cases.iter().map(|case| (case, Sizes::default())).chain(again) {
        match case.compile(sizes) {
            Ok(rust) => programs.push(rust),
            Err(errors) => failures.push(case.failure(&project, &[errors])),
        }
    }
    report(&project, failures);
    let command = project.build_choosing(&programs).unwrap_or_else(|errors| panic!("{errors}"));
    // Two at a time: a run takes some seconds.
    let all: Vec<(usize, &Case)> = cases.iter().enumerate().collect();
    let halves = std::thread::scope(|scope| {
        let halves = [0, 1].map(|half| {
            let cases = all.iter().skip(half).step_by(2);
            let (project, command, all) = (&project, &command, &all);
            scope.spawn(move || -> (Vec<String>, Tally) {
                let mut tally = Tally::default();
                let mut failures = Vec::new();
                for (at, case) in cases {
                    failures.extend(case.test(project, command, *at, &mut tally));
                    let compiled = |at: usize| project.choose(command, at);
                    if *at < grown_count && !case.move_identically(project, [*at, all.len() + at].map(compiled)) {
                        failures.push(case.failure(project, &["in other forms it goes another way".into()]));
                    }
                    if !case.move_identically(project, [compiled(*at), case.by_engine(project)]) {
                        failures.push(case.failure(project, &["by the engine it goes another way".into()]));
                    }
                }
                (failures, tally)
            })
        });
        halves.map(|half| half.join().expect("a thread"))
    });
    let (mut failures, mut tally) = (Vec::new(), Tally::default());
    for (half, own) in halves {
        failures.extend(half);
        tally.add(&own);
    }
    println!("{tally}");
    report(&project, failures);
}
