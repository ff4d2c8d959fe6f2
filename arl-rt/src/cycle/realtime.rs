//! Requests to the operating system, so that cycles begin in time.

/// Resources of the operating system for the thread of the cycle: priority over all other threads, locked memory, a
/// core of its own. Linux provides them, where it is allowed; `docs/drivers.md` describes how to allow it.
///
/// Call [`begin`](Realtime::begin) on the thread that steps the controller, before that is built: threads beside the
/// cycle (time laws, blends, the disk, connections) are started after it, and get a lower priority.
///
/// ```
/// use arl_rt::clock::Realtime;
///
/// // What could not be done is told, and nothing is worse for it.
/// for problem in Realtime::new().priority(60).without_core().begin() {
///     println!("not in real time: {problem}");
/// }
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Realtime {
    priority: u8,
    core: Core,
}

/// The core of the cycle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Core {
    /// The last of the cores that the process may use, where there is more than one.
    Last,
    Number(usize),
    Any,
}

/// Above the kernel's threads for devices, below those that it needs itself.
const PRIORITY: u8 = 80;

impl Default for Realtime {
    fn default() -> Self {
        Self { priority: PRIORITY, core: Core::Last }
    }
}

impl Realtime {
    /// Priority 80 of `SCHED_FIFO`, the last core that the process may use, all memory locked.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the priority of `SCHED_FIFO`, 1 to 99.
    pub fn priority(self, priority: u8) -> Self {
        Self { priority: priority.clamp(1, 99), ..self }
    }

    /// Sets the core on which the cycle runs, from 0.
    pub fn core(self, core: usize) -> Self {
        Self { core: Core::Number(core), ..self }
    }

    /// Lets the cycle run on any core.
    pub fn without_core(self) -> Self {
        Self { core: Core::Any, ..self }
    }

    /// Requests the resources for this thread; returns those that it did not get, and the reasons.
    pub fn begin(self) -> Vec<String> {
        system::begin(self)
    }
}

#[cfg(all(target_os = "linux", feature = "realtime"))]
mod system {
    use std::sync::{Mutex, OnceLock, PoisonError};

    use arl_motion::beside;
    use rustix::mm::{MlockAllFlags, mlockall};
    use rustix::process::{Resource, geteuid, getrlimit};
    use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
    use thread_priority::unix::{
        NormalThreadSchedulePolicy, RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy,
        thread_native_id,
    };
    use thread_priority::{ThreadPriority, ThreadPriorityValue};

    use super::{Core, Realtime};

    /// The cores that the process may use, as they were at first.
    static ALL: OnceLock<CpuSet> = OnceLock::new();
    /// The cores of all threads but that of the cycle.
    static OTHERS: Mutex<Option<CpuSet>> = Mutex::new(None);
    /// Of 99, which is a niceness of 3.
    const BESIDE: u8 = 40;

    pub(super) fn begin(asked: Realtime) -> Vec<String> {
        let memory = lock_memory().err().map(|why| format!("its memory is not locked: {why}"));
        memory.into_iter().chain(begin_without_memory(asked)).collect()
    }

    pub(super) fn begin_without_memory(asked: Realtime) -> Vec<String> {
        beside::each_does_first(step_back);
        let core = take_core(asked.core).err().map(|why| format!("no core of its own: {why}"));
        let first = go_first(asked.priority).err();
        let first = first.map(|why| format!("no priority {} of SCHED_FIFO: {why}", asked.priority));
        core.into_iter().chain(first).collect()
    }

    fn take_core(core: Core) -> Result<(), String> {
        let now = sched_getaffinity(None).map_err(|error| error.to_string())?;
        let all = *ALL.get_or_init(|| now);
        let ours: Vec<usize> = (0..CpuSet::MAX_CPU).filter(|core| all.is_set(*core)).collect();
        let core = match core {
            Core::Any => {
                *OTHERS.lock().unwrap_or_else(PoisonError::into_inner) = Some(all);
                return sched_setaffinity(None, &all).map_err(|error| error.to_string());
            }
            // A core that is reserved from other programs is not in our set, and may be available all the same.
            Core::Number(core) if core < CpuSet::MAX_CPU => core,
            Core::Number(core) => return Err(format!("there is no core {core}")),
            Core::Last if ours.len() < 2 => return Err("there is only one core for all threads".to_owned()),
            Core::Last => ours.last().copied().unwrap_or_default(),
        };
        let mut own = CpuSet::new();
        own.set(core);
        sched_setaffinity(None, &own).map_err(|error| {
            let known: Vec<String> = ours.iter().map(ToString::to_string).collect();
            format!("core {core}: {error} (this process has {})", known.join(", "))
        })?;
        let mut others = all;
        if ours != [core] {
            others.unset(core);
        }
        *OTHERS.lock().unwrap_or_else(PoisonError::into_inner) = Some(others);
        Ok(())
    }

    /// With a limit, later allocations would fail, so that memory is not locked then. The superuser has no limit.
    fn lock_memory() -> Result<(), String> {
        if let (Some(most), false) = (getrlimit(Resource::Memlock).current, geteuid().is_root()) {
            return Err(format!("only {} KiB may be locked (`ulimit -l`): it must be unlimited", most / 1024));
        }
        mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE).map_err(|error| error.to_string())
    }

    fn go_first(priority: u8) -> Result<(), String> {
        let value = ThreadPriorityValue::try_from(priority).map_err(|why| why.to_owned())?;
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        let done = set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), policy);
        done.map_err(|error| format!("{error} (`ulimit -r` shows which are allowed)"))
    }

    /// Gives a thread beside the cycle resources of its own instead of those inherited from the cycle. Where that is
    /// not allowed, the thread gets no slower.
    fn step_back() {
        if let Some(others) = *OTHERS.lock().unwrap_or_else(PoisonError::into_inner) {
            let _ = sched_setaffinity(None, &others);
        }
        let policy = ThreadSchedulePolicy::Normal(NormalThreadSchedulePolicy::Other);
        if let Ok(value) = ThreadPriorityValue::try_from(BESIDE) {
            let priority = ThreadPriority::Crossplatform(value);
            let _ = set_thread_priority_and_policy(thread_native_id(), priority, policy);
        }
    }
}

#[cfg(test)]
#[cfg(all(target_os = "linux", feature = "realtime"))]
mod tests {
    use arl_motion::beside;
    use rustix::thread::{CpuSet, sched_getaffinity};
    use thread_priority::unix::{ThreadSchedulePolicy, thread_native_id, thread_schedule_policy_param};

    use super::*;

    /// The cores that this thread may use, and whether it has a real-time priority.
    fn mine() -> (Vec<usize>, bool) {
        let cores = sched_getaffinity(None).unwrap();
        let (policy, _) = thread_schedule_policy_param(thread_native_id()).unwrap();
        let cores = (0..CpuSet::MAX_CPU).filter(|core| cores.is_set(*core)).collect();
        (cores, matches!(policy, ThreadSchedulePolicy::Realtime(_)))
    }

    #[test]
    fn threads_beside_the_cycle_step_back_from_what_that_has() {
        let before = mine().0;
        // In a thread of its own, as other tests must go on unchanged.
        let cycle = std::thread::spawn(move || {
            let problems = system::begin_without_memory(Realtime::new());
            // A second call gives the same result.
            assert_eq!(system::begin_without_memory(Realtime::new()), problems);
            let worker = beside::spawn(std::thread::Builder::new(), mine).unwrap().join().unwrap();
            (problems, mine(), worker)
        });
        let (problems, (own, first), (others, worker_first)) = cycle.join().unwrap();
        assert!(!worker_first);
        let has = |what: &str| problems.iter().any(|problem| problem.contains(what));
        assert_eq!(first, !has("SCHED_FIFO"), "{problems:?}");
        if before.len() > 1 {
            assert_eq!(own, before[before.len() - 1..], "{problems:?}");
            assert_eq!(others, before[..before.len() - 1]);
        } else {
            assert!(has("only one"), "{problems:?}");
        }
        let nowhere = std::thread::spawn(|| system::begin_without_memory(Realtime::new().core(1023))).join().unwrap();
        assert!(nowhere.iter().any(|problem| problem.contains("core 1023: ")), "{nowhere:?}");
    }
}

#[cfg(not(all(target_os = "linux", feature = "realtime")))]
mod system {
    use super::Realtime;

    pub(super) fn begin(_: Realtime) -> Vec<String> {
        let why = if cfg!(target_os = "linux") {
            "it was built without the feature `realtime`"
        } else {
            "only Linux supports it"
        };
        vec![why.to_owned()]
    }
}
