//! Bounds on the messages of a recording: numbers that a run can have, and no more of anything than a cell has. A
//! recording may come from anywhere; what is kept of it is shown in pages, which cannot handle other numbers.

use arl_robot::channels::MOST_CHANNELS as MOST_SIGNALS;
use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES};

use crate::record::RunMessage;
use crate::record::message::MOST_PROGRAMS;
use crate::record::messages::{
    Cell, Channel, Closest, Color, Contact, Controller, Cylinder, Io, Link, Model, Motion, Pose, SceneUpdate, Solid,
    Vector3,
};

/// No time, place, angle or speed of a run is larger, in s, mm, deg, and per s.
const LARGEST: f64 = 1e9;
/// The axes of a robot with all external ones.
const MOST_AXES: usize = ROBOT_AXES + EXTERNAL_AXES;
/// How many kinds of signals have names.
const KINDS_OF_SIGNALS: usize = 6;
/// No cell has more bodies, and no body more solids.
const MOST_SOLIDS: usize = 100_000;

/// A message that can be checked against what a run can have.
pub(super) trait Bounded {
    /// Checks that every number is valid, and every list has a length that a run can have.
    ///
    /// # Errors
    /// What is wrong with the message.
    fn check(&self) -> Result<(), String>;
}

impl Bounded for RunMessage {
    fn check(&self) -> Result<(), String> {
        match self {
            Self::Cell(message) => message.check(),
            Self::Scene(message) => message.check(),
            Self::Controller(message) => message.check(),
            Self::Io(message) => message.check(),
            Self::Channel(_, message) => message.check(),
            Self::Motion(message) => message.check(),
            Self::Contact(message) => message.check(),
            // These have no numbers, or are for viewers only.
            Self::Log(_) | Self::Frames(_) | Self::Joints(_) => Ok(()),
        }
    }
}

impl Bounded for Cell {
    fn check(&self) -> Result<(), String> {
        at_most("names of signals", self.names.len(), KINDS_OF_SIGNALS * MOST_SIGNALS as usize)?;
        at_most("channels", self.channels.len(), MOST_PROGRAMS)?;
        for runs in &self.channels {
            at_most("axes", runs.axes.len(), MOST_AXES)?;
            runs.axes.iter().try_for_each(|axis| numbers("the range of an axis", &[axis.min, axis.max]))?;
            // The links of the axes, and the flange.
            at_most("links", runs.links.len(), MOST_AXES + 1)?;
            at_most("carriers", runs.carriers.len(), EXTERNAL_AXES)?;
            runs.links.iter().chain(&runs.carriers).try_for_each(link)?;
        }
        Ok(())
    }
}

impl Bounded for Channel {
    fn check(&self) -> Result<(), String> {
        numbers("the time", &[self.time])?;
        at_most("axes", self.axes.len(), MOST_AXES)?;
        numbers("the axes", &self.axes)?;
        frame("the TCP", &self.tcp)?;
        frame("the base", &self.base)
    }
}

impl Bounded for Controller {
    fn check(&self) -> Result<(), String> {
        numbers("the override", &[self.time, self.speed_override])
    }
}

impl Bounded for Io {
    fn check(&self) -> Result<(), String> {
        let all = [self.di.len(), self.r#do.len(), self.ai.len(), self.ao.len()];
        all.into_iter().try_for_each(|count| at_most("signals of a kind", count, MOST_SIGNALS as usize))?;
        numbers("the time", &[self.time])?;
        numbers("analog signals", &self.ai)?;
        numbers("analog signals", &self.ao)
    }
}

impl Bounded for Motion {
    fn check(&self) -> Result<(), String> {
        numbers("a motion", &[self.start, self.duration, self.way, self.programmed, self.reached])?;
        let blend = self.blend.iter().map(|blend| [blend.asked, blend.used]);
        blend.into_iter().try_for_each(|zone| numbers("a zone", &zone))?;
        let closest = [&self.closest_vel, &self.closest_acc, &self.closest_jerk];
        let percent = |Closest { percent, .. }: &Closest| numbers("a limit", &[*percent]);
        closest.into_iter().flatten().try_for_each(percent)
    }
}

impl Bounded for Contact {
    fn check(&self) -> Result<(), String> {
        numbers("a contact", &[self.time, self.distance])
    }
}

impl Bounded for SceneUpdate {
    fn check(&self) -> Result<(), String> {
        at_most("entities", self.entities.len(), MOST_SOLIDS)?;
        at_most("deletions", self.deletions.len(), MOST_SOLIDS)?;
        for entity in &self.entities {
            let solids = [entity.cubes.len(), entity.spheres.len(), entity.cylinders.len(), entity.models.len()];
            solids.into_iter().try_for_each(|count| at_most("solids of a form", count, MOST_SOLIDS))?;
            entity.cubes.iter().chain(&entity.spheres).try_for_each(solid)?;
            entity.cylinders.iter().try_for_each(cylinder)?;
            entity.models.iter().try_for_each(model)?;
        }
        Ok(())
    }
}

fn solid(Solid { pose, size, color }: &Solid) -> Result<(), String> {
    placed((pose.as_ref(), size.as_ref(), color.as_ref()))
}

fn cylinder(Cylinder { pose, size, color, .. }: &Cylinder) -> Result<(), String> {
    placed((pose.as_ref(), size.as_ref(), color.as_ref()))
}

fn model(Model { pose, scale, color, .. }: &Model) -> Result<(), String> {
    placed((pose.as_ref(), scale.as_ref(), color.as_ref()))
}

fn placed((pose, size, color): (Option<&Pose>, Option<&Vector3>, Option<&Color>)) -> Result<(), String> {
    let vector = |Vector3 { x, y, z }: &Vector3| numbers("a form", &[*x, *y, *z]);
    size.map_or(Ok(()), vector)?;
    color.map_or(Ok(()), |Color { r, g, b, a }| numbers("a colour", &[*r, *g, *b, *a]))?;
    let Some(Pose { position, orientation }) = pose else { return Ok(()) };
    position.as_ref().map_or(Ok(()), vector)?;
    orientation.map_or(Ok(()), |turned| numbers("a form", &[turned.x, turned.y, turned.z, turned.w]))
}

fn link(Link { origin, axis, .. }: &Link) -> Result<(), String> {
    at_most("numbers of a pose", origin.len(), 7)?;
    at_most("numbers of a direction", axis.len(), 3)?;
    numbers("a link", origin)?;
    numbers("a link", axis)
}

/// x, y, z, a, b, c, or empty.
fn frame(what: &str, values: &[f64]) -> Result<(), String> {
    at_most("numbers of a pose", values.len(), 6)?;
    numbers(what, values)
}

fn at_most(what: &str, count: usize, most: usize) -> Result<(), String> {
    if count <= most { Ok(()) } else { Err(format!("it has {count} {what}, and a run has {most} at most")) }
}

fn numbers(what: &str, values: &[f64]) -> Result<(), String> {
    let wrong = values.iter().find(|value| value.is_nan() || value.abs() > LARGEST);
    wrong.map_or(Ok(()), |value| Err(format!("{what}: {value:?} is not a value that a run can have")))
}

#[cfg(test)]
mod tests {
    use super::super::store::Store;
    use super::*;
    use prost::Message as _;

    fn taken(topic: &str, message: &impl prost::Message) -> Result<(), String> {
        Store::default().take(topic, 0, &message.encode_to_vec())
    }

    #[test]
    fn what_no_run_says_is_refused() {
        let refused = |topic: &str, message: &[u8], words: &str| {
            let problem = Store::default().take(topic, 0, message).expect_err(words);
            assert!(problem.contains(words), "{problem}");
        };
        let channel = |change: fn(&mut Channel)| {
            let mut channel = Channel { axes: vec![0.0; 6], tcp: vec![0.0; 6], ..Channel::default() };
            change(&mut channel);
            channel.encode_to_vec()
        };
        let topic = "/arl/channel_1";
        assert_eq!(Store::default().take(topic, 0, &channel(|_| {})), Ok(()));
        refused(topic, &channel(|of| of.axes = vec![0.0; 200_000]), "it has 200000 axes, and a run has 12 at most");
        refused(topic, &channel(|of| of.axes[3] = f64::NAN), "the axes: NaN is not a value that a run can have");
        refused(topic, &channel(|of| of.tcp[0] = f64::INFINITY), "the TCP: inf");
        refused(topic, &channel(|of| of.base = vec![1e300; 6]), "the base: 1e300 is not a value");
        refused(topic, &channel(|of| of.time = f64::NAN), "the time: NaN");
        refused(topic, &channel(|of| of.tcp = vec![0.0; 7]), "7 numbers of a pose");
        let io = Io { di: vec![false; 3_000_000], ..Io::default() };
        refused("/arl/io", &io.encode_to_vec(), "it has 3000000 signals of a kind, and a run has 10000 at most");
        let io = Io { ao: vec![0.0, f64::NAN], ..Io::default() };
        refused("/arl/io", &io.encode_to_vec(), "analog signals: NaN");
        let motion =
            Motion { closest_acc: Some(Closest { percent: f64::NAN, ..Closest::default() }), ..Motion::default() };
        refused("/arl/motions", &motion.encode_to_vec(), "a limit: NaN");
        let contact = Contact { distance: f64::NEG_INFINITY, ..Contact::default() };
        refused("/arl/contacts", &contact.encode_to_vec(), "a contact: -inf");
        refused("/arl/contacts", &[0xff], "");
    }

    #[test]
    fn scenes_and_cells_have_numbers_too() {
        use super::super::super::record::messages::{Axis, Runs, SceneEntity, SceneEntityDeletion};
        let size = Some(Vector3 { x: 1.0, y: f64::NAN, z: 1.0 });
        let entity = SceneEntity { cubes: vec![Solid { size, ..Solid::default() }], ..SceneEntity::default() };
        let scene = SceneUpdate { entities: vec![entity], deletions: Vec::new() };
        assert!(taken("/scene", &scene).unwrap_err().contains("a form: NaN"));
        let deletions = vec![SceneEntityDeletion::default(); MOST_SOLIDS + 1];
        let scene = SceneUpdate { entities: Vec::new(), deletions };
        assert!(taken("/scene", &scene).unwrap_err().contains("it has 100001 deletions"));
        let cell = Cell { channels: vec![Runs::default(); 300], names: Vec::new() };
        assert!(taken("/arl/cell", &cell).unwrap_err().contains("it has 300 channels, and a run has 261 at most"));
        let axis = Axis { max: f64::INFINITY, ..Axis::default() };
        let runs = Runs { axes: vec![axis], ..Runs::default() };
        let cell = Cell { channels: vec![runs], names: Vec::new() };
        assert!(taken("/arl/cell", &cell).unwrap_err().contains("the range of an axis: inf"));
    }

    #[test]
    fn many_files_and_names_cost_by_their_number() {
        let mut store = Store::default();
        let channel = |number: usize| Channel { file: format!("f{number}.arl"), ..Channel::default() }.encode_to_vec();
        // One of the names is that of no file.
        for number in 0..usize::from(u16::MAX) {
            store.take("/arl/channel_1", 0, &channel(number)).unwrap();
        }
        assert_eq!(store.tracks[0].files.len(), usize::from(u16::MAX) + 1);
        let problem = store.take("/arl/channel_1", 0, &channel(usize::from(u16::MAX))).unwrap_err();
        assert!(problem.contains("the program has more than 65536 files"), "{problem}");
    }
}
