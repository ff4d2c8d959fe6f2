// What the server of the view says, made from its types in Rust (runs/src/view/api.rs); `scripts/renew.sh`
// writes it anew.

/**
 * All of a run except the positions of the robots.
 */
export type RunAnswer = { 
/**
 * The file that is shown.
 */
name: string, channels: Array<PageChannel>, 
/**
 * The cell's names of signals, by their names in files: `di.1`.
 */
names: { [key in string]: string }, sources: Array<SourceText>, 
/**
 * The words of the language.
 */
keywords: Array<string>, 
/**
 * Whether points of the program may be written.
 */
teaches: boolean, 
/**
 * What of the recording could not be read, and the reason.
 */
trouble: string | null, 
/**
 * The time of the last message in s.
 */
end: number, 
/**
 * Counts the messages that were added.
 */
version: number, 
/**
 * Whether a running program adds to it.
 */
live: boolean, scene: Array<PageSceneUpdate>, controller: Array<Mode>, log: Array<Logged>, contacts: Array<PageContact>, motions: Array<PageMotion>, tracks: Array<PageTrack>, signals: Array<SignalChanges>, levels: Levels, };

/**
 * What happened since the page's last request.
 */
export type News = { 
/**
 * The time of the last message in s.
 */
end: number, 
/**
 * Counts the messages that were added.
 */
version: number, 
/**
 * Whether a running program adds to it.
 */
live: boolean, scene: Array<PageSceneUpdate>, controller: Array<Mode>, log: Array<Logged>, contacts: Array<PageContact>, motions: Array<PageMotion>, tracks: Array<PageTrack>, signals: Array<SignalChanges>, levels: Levels, };

/**
 * A channel: what it runs, and its robot; a background channel has none.
 */
export type PageChannel = { program: string, robot: string, 
/**
 * The frame of its TCP.
 */
tcp: string, axes: Array<PageAxis>, 
/**
 * From the base on, with the flange last.
 */
links: Array<PageLink>, 
/**
 * What its external axes move.
 */
carriers: Array<PageLink>, };

/**
 * An axis: its range, and its unit, `deg` or `mm`.
 */
export type PageAxis = { name: string, unit: string, min: number, max: number, };

/**
 * A frame of a robot, relative to the frame that it is fixed to or moves against.
 */
export type PageLink = { frame: string, parent: string, 
/**
 * x, y, z in mm, and a quaternion x, y, z, w, while its axis is at 0.
 */
origin: Array<number>, 
/**
 * The axis that it turns about, or moves along; empty: it does not move.
 */
axis: Array<number>, linear: boolean, 
/**
 * The name of the axis that moves it; empty: none.
 */
moved_by: string, };

/**
 * A file of the program.
 */
export type SourceText = { name: string, text: string, };

/**
 * A change of bodies: those that appear or change, and the names of those that disappear.
 */
export type PageSceneUpdate = { time: number, entities: Array<Entity>, gone: Array<string>, };

/**
 * A body, or a limb of a robot.
 */
export type Entity = { id: string, frame: string, cubes: Array<PageSolid>, spheres: Array<PageSolid>, 
/**
 * Along z.
 */
cylinders: Array<PageSolid>, models: Array<PageModel>, };

/**
 * A form of a body: its lengths along x, y and z in m.
 */
export type PageSolid = { pose: [number, number, number, number, number, number, number], size: [number, number, number], color: [number, number, number, number], };

/**
 * A mesh of the recording, by its number.
 */
export type PageModel = { pose: [number, number, number, number, number, number, number], scale: [number, number, number], color: [number, number, number, number], model: number | null, };

/**
 * The operating mode and the override from a time on.
 */
export type Mode = { time: number, mode: string, 
/**
 * %
 */
override: number, };

/**
 * A message, a warning or an alarm.
 */
export type Logged = { time: number, level: LogLevel, text: string, name: string, file: string, line: number, };

export type LogLevel = "alarm" | "warning" | "message";

/**
 * Two bodies begin to touch, or come nearer than the clearance: `distance` in mm, 0 where they touch.
 */
export type PageContact = { time: number, file: string, line: number, one: string, other: string, distance: number, };

/**
 * What a motion did: times in s, the path in mm, speeds in `unit`.
 */
export type PageMotion = { channel: number, motion: number, file: string, line: number, kind: string, start: number, duration: number, way: number, programmed: number, reached: number, unit: string, blend: PageBlend | null, vel: [string, number] | null, acc: [string, number] | null, jerk: [string, number] | null, };

/**
 * How much of a zone was requested and used, in its unit, and why the robot stopped, if it did.
 */
export type PageBlend = { asked: number, used: number, unit: string, why: string, };

/**
 * What a channel did.
 */
export type PageTrack = { 
/**
 * The file names to which rows and lines refer by number.
 */
files: Array<string>, rows: number, states: Array<[number, string]>, bases: Array<[number, [number, number, number, number, number, number, number]]>, lines: Array<PageLine>, };

/**
 * How long the robot moved for a line, and was at rest in it, in s.
 */
export type PageLine = { file: number, line: number, moving: number, standing: number, };

/**
 * Changes of a signal: times and values in turn.
 */
export type SignalChanges = { signal: string, changes: Array<number>, };

/**
 * The present inputs and outputs: a digit for each digital one.
 */
export type Levels = { di: string, do: string, ai: Array<number>, ao: Array<number>, };

/**
 * The differences: lines that took another time or path length, and the rest in words.
 */
export type Differences = { 
/**
 * How long both took, in s.
 */
time: [number, number], said: Array<string>, lines: Array<LineDifference>, };

/**
 * A line in both runs; a time is absent where the line did not run.
 */
export type LineDifference = { channel: number, file: string, line: number, 
/**
 * s
 */
one: number | null, other: number | null, 
/**
 * The lengths of the path of the TCP, in mm.
 */
way: [number, number], };

/**
 * The content of data files, for the page.
 */
export type Points = { points: Array<Point>, frames: Array<Mounted>, 
/**
 * How many steps can be undone.
 */
undo: number, 
/**
 * What cannot be read, and the reason.
 */
troubles: Array<string>, };

/**
 * A point: its components that are plain numbers, in mm and deg.
 */
export type Point = { file: string, type: string, name: string, values: { [key in string]: number }, 
/**
 * Whether it has no other components.
 */
plain: boolean, };

/**
 * A tool or workpiece.
 */
export type Mounted = { file: string, type: string, name: string, 
/**
 * a, b, c in deg.
 */
angles: [number, number, number], placed: [number, number, number, number, number, number, number], 
/**
 * Whether it is mounted in the less usual way: a stationary tool, a workpiece that the robot holds.
 */
other: boolean, };

/**
 * How a place is reached.
 */
export type TaughtPose = { 
/**
 * The TCP in the workpiece frame: x, y, z, a, b, c.
 */
components: [number, number, number, number, number, number], 
/**
 * The TCP in the world.
 */
placed: [number, number, number, number, number, number, number], solutions: Array<Solution>, 
/**
 * The nearest of the solutions that exist.
 */
nearest: number | null, };

/**
 * A configuration: the axes, or why there are none.
 */
export type Solution = { cfg: number, axes: [number, number, number, number, number, number] | null, why: string | null, 
/**
 * 0 at a singular point, up to 1.
 */
clearance: number, 
/**
 * Which kind of singular point is near, if one is.
 */
near: string | null, };

/**
 * The places of a plane, row by row: a digit each, 0 where the robot does not reach, else how clear of singular points
 * it is.
 */
export type Mapped = { side: number, step: number, 
/**
 * The first place, and the frame of the plane, in the world.
 */
origin: [number, number, number, number, number, number, number], places: string, };
