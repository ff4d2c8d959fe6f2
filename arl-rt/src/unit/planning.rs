//! The motions of a program: planning, setting aside, going on, dropping.

use super::Unit;
use super::changes::Change;
use super::hold::Button;
use super::refusal::{Mounts, alarm};
use crate::fault::{Alarm, File};
use crate::motion::{Command, Settings, Start, Stop, circle_steps};

impl Unit {
    /// Whether a level of the program can plan another motion.
    pub(crate) fn takes(&self, level: u32) -> bool {
        self.queue.takes(level)
    }

    /// Stops on the path and sets the motions aside: this level of the program, and those above it, move in between.
    pub(crate) fn set_aside(&mut self, stop: Stop, level: u32) {
        self.queue.request_suspension(stop, level);
        self.changes.follow(self.queue.depth(), self.planned, &mut self.effort);
    }

    /// Goes on with the motions set aside last; returns whether there were any.
    pub(crate) fn start_again(&mut self, start: Start, file: File) -> bool {
        self.files.start = file;
        let started = self.queue.start_again(start);
        self.note_start();
        started
    }

    /// Drops the motions set aside, where going on with them was not requested; returns whether there were any. A stop
    /// under way goes on to rest.
    pub(crate) fn drop_aside(&mut self) -> bool {
        self.queue.drop_suspended()
    }

    /// Whether more motions were to be skipped than there were, since the last call.
    pub(crate) fn take_beyond(&mut self) -> bool {
        self.queue.take_beyond()
    }

    /// Takes in motions that go on, and the motion back to them.
    pub(super) fn note_start(&mut self) {
        if let Some((number, command, settings)) = self.queue.take_return_motion() {
            self.planned = number;
            let file = self.files.start;
            self.note_planned(number, &command, &settings, file);
        }
        self.changes.follow(self.queue.depth(), self.planned, &mut self.effort);
    }

    /// Takes in a motion that was planned.
    fn note_planned(&mut self, number: u64, command: &Command, settings: &Settings, file: File) {
        if let Some(recorder) = &mut self.recorder {
            recorder.planned(&mut self.queue, number, command, settings);
            self.files.note_recorded(number, file);
        }
        self.files.note(number, file);
    }

    /// Plans a motion of a program file with `settings`: [`Unit::settings`] with the changes that it brings along.
    /// Returns the alarm where it, or a motion before it, cannot be planned.
    pub(crate) fn plan(
        &mut self,
        command: &Command,
        settings: &Settings,
        mounts: Mounts,
        file: File,
    ) -> Result<(), Alarm> {
        let planned = self.queue.add(command, settings);
        let about = Some((&command.target, mounts));
        self.planned = planned.map_err(|error| alarm(error, self.files.last, file, command.line, about))?;
        self.files.last = file;
        self.note_planned(self.planned, command, settings, file);
        Ok(())
    }

    /// The two motions of a circle that is to be planned, for single steps; `None` for everything else.
    pub(crate) fn circle_steps(&self, command: &Command, settings: &Settings) -> Option<[Command; 2]> {
        circle_steps(&self.robot, self.queue.end(), command, settings)
    }

    /// The program waits: motions that waited for the next one are planned without it. Returns the alarm where that
    /// fails.
    pub(crate) fn conclude(&mut self) -> Result<(), Alarm> {
        self.queue.conclude().map_err(|error| alarm(error, self.files.last, self.files.last, 0, None))
    }

    /// The alarm of a motion that was planned without the next one and failed.
    pub(crate) fn take_broken(&mut self) -> Option<Alarm> {
        if let Some(error) = self.queue.take_broken_start() {
            return Some(alarm(error, self.files.start, self.files.start, 0, None));
        }
        Some(alarm(self.queue.take_broken()?, self.files.last, self.files.last, 0, None))
    }

    /// Adds a change that holds from the next planned motion on: at once where no motion is left before that.
    pub(super) fn change(&mut self, change: Change) {
        self.changes.push(self.planned + 1, change);
        self.change_due();
    }

    /// Makes the changes of the motion after the last one that has ended take effect.
    pub(super) fn change_due(&mut self) {
        self.changes.make(self.finished + 1, &mut self.effort);
    }

    /// Comes to rest on the path as fast as it can, and forgets what was planned.
    pub(crate) fn stop_fast(&mut self) {
        self.queue.stop_on_path(Stop::Fast);
        self.stop();
    }

    /// Comes to rest on the path, and forgets what was planned.
    pub(crate) fn stop(&mut self) {
        self.queue.stop_on_path(Stop::General);
        self.queue.clear();
        self.stop_button();
    }

    /// A button that is held has to be pressed again.
    fn stop_button(&mut self) {
        if self.jogging.button == Button::Held {
            self.jogging.button = Button::LetGo;
        }
    }

    /// Lets motion be planned again after [`Unit::stop`], at rest.
    pub(crate) fn reset(&mut self) {
        if std::mem::take(&mut self.jogging.jogged) {
            // What was set aside is not gone back to.
            self.queue.drop_suspended();
        }
        if self.has_servo() {
            self.queue.resume();
        }
        (self.jogging.halted, self.jogging.jogged) = (!self.has_servo(), false);
        self.changes.clear(&mut self.effort);
        self.files.clear();
        self.settings = Settings { manual: self.settings.manual, ..Settings::default() };
    }
}
