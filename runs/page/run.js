// A run: the data that the server reports about it, and queries about a moment.

import { Samples, rowAt } from "./samples.js";

/**
 * A signal that changes: its name in files, its name in the cell, and its times and values.
 * @typedef {{signal: string, label: string, times: number[], values: number[]}} Lane
 * @typedef {import('./api.js').PageMotion} Motion
 * @typedef {import('./api.js').PageChannel & {number: number, samples: Samples}} Channel
 */

export class Run {
  /** @param {number} number @param {import('./api.js').RunAnswer} answer @param {() => void} changed */
  constructor(number, answer, changed) {
    this.address = `/api/run/${number}`;
    this.changed = changed;
    this.answer = answer;
    this.name = answer.name;
    this.end = answer.end;
    this.problem = answer.trouble;
    this.live = answer.live;
    /** @type {Map<string, Lane>} by the name of the signal */
    this.lanes = new Map();
    this.lanesFrom(answer.signals);
    this.channels = answer.channels.map((channel, at) => ({
      ...channel,
      number: at + 1,
      samples: new Samples(`${this.address}/samples?channel=${at + 1}`, changed),
    }));
    /** @type {Map<number, Motion[]>} by the number of the channel */
    this.motions = new Map();
    /** @type {Map<string, Motion>} by the numbers of channel and motion */
    this.byNumber = new Map();
    /** @type {Map<number, number[]>} */
    this.starts = new Map();
    this.sortMotions();
  }

  /** @param {number} number @param {() => void} changed */
  static async load(number, changed) {
    const answer = await fetch(`/api/run/${number}`);
    if (!answer.ok) throw new Error(await answer.text());
    return new Run(number, await answer.json(), changed);
  }

  /** The channels that have a robot. */
  get robots() {
    return this.channels.filter((channel) => channel.links.length > 0);
  }

  /** @param {import('./api.js').SignalChanges[]} signals */
  lanesFrom(signals) {
    for (const { signal, changes } of signals) {
      /** @type {Lane} */
      const lane = this.lanes.get(signal) ?? { signal, label: this.answer.names?.[signal] ?? signal, times: [], values: [] };
      for (let at = 0; at < changes.length; at += 2) {
        lane.times.push(changes[at]);
        lane.values.push(changes[at + 1]);
      }
      this.lanes.set(signal, lane);
    }
  }

  /** How many changes of signals are known. */
  get changes() {
    let count = 0;
    for (const { times } of this.lanes.values()) count += times.length;
    return count;
  }

  /** Takes in motions that have ended; some are reported again because they had continued. @param {Motion[]} motions */
  takeMotions(motions) {
    let news = false;
    for (const motion of motions) {
      const known = this.byNumber.get(`${motion.channel}/${motion.motion}`);
      if (known?.duration === motion.duration) continue;
      news = true;
      if (known) Object.assign(known, motion);
      else this.answer.motions.push(motion);
    }
    if (news) this.sortMotions();
  }

  sortMotions() {
    this.answer.motions.sort((one, other) => one.start - other.start);
    this.motions.clear();
    this.byNumber.clear();
    for (const motion of this.answer.motions) {
      const all = this.motions.get(motion.channel) ?? [];
      all.push(motion);
      this.motions.set(motion.channel, all);
      this.byNumber.set(`${motion.channel}/${motion.motion}`, motion);
    }
    this.starts = new Map([...this.motions].map(([channel, all]) => [channel, all.map((motion) => motion.start)]));
  }

  /** Requests what has happened since, and takes it in. */
  async refresh() {
    const { scene, controller, log, contacts, motions, tracks } = this.answer;
    const known = {
      scene: scene.length,
      controller: controller.length,
      log: log.length,
      contacts: contacts.length,
      motions: motions.length,
    };
    const states = Math.min(...tracks.map((track) => track.states.length), 1e9);
    const bases = Math.min(...tracks.map((track) => track.bases.length), 1e9);
    const query = new URLSearchParams(
      Object.entries({ ...known, states, bases, signals: this.changes }).map(([name, value]) => [name, String(value)]),
    );
    const answer = await fetch(`${this.address}/news?${query}`);
    if (!answer.ok) throw new Error(await answer.text());
    /** @type {import('./api.js').News} */
    const news = await answer.json();
    const isNew = news.version !== this.answer.version;
    // The program has begun since: only now is it known what runs on which robots.
    if (this.channels.length === 0 && isNew) return "begun";
    scene.push(...news.scene);
    controller.push(...news.controller);
    log.push(...news.log);
    contacts.push(...news.contacts);
    news.tracks.forEach((track, at) => {
      const mine = (this.answer.tracks[at] ??= { files: [], states: [], bases: [], lines: [], rows: 0 });
      mine.states.splice(Math.min(states, mine.states.length), Infinity, ...track.states);
      mine.bases.splice(Math.min(bases, mine.bases.length), Infinity, ...track.bases);
      Object.assign(mine, { files: track.files, lines: track.lines, rows: track.rows });
    });
    this.lanesFrom(news.signals);
    this.takeMotions(news.motions);
    Object.assign(this, { end: Math.max(this.end, news.end), live: news.live });
    Object.assign(this.answer, { version: news.version, live: news.live, levels: news.levels });
    return isNew ? "more" : "nothing";
  }

  /** @param {number} channel from 1 */
  track(channel) {
    return this.answer.tracks[channel - 1] ?? { files: [], states: [], bases: [], lines: [], rows: 0 };
  }

  /** The position of a robot's base at a time. @param {number} channel @param {number} time */
  baseAt(channel, time) {
    const { bases } = this.track(channel);
    // Before the first motion it is unknown.
    let base = bases[0]?.[1] ?? [0, 0, 0, 0, 0, 0, 1];
    for (const [from, value] of bases) if (from <= time) base = value;
    return base;
  }

  /** @param {number} channel @param {number} time */
  stateAt(channel, time) {
    let state = "";
    for (const [from, value] of this.track(channel).states) if (from <= time + 1e-9) state = value;
    return state;
  }

  /** The motion that a robot executes at a time, or the last one before. @param {number} channel @param {number} time */
  motionAt(channel, time) {
    return this.motions.get(channel)?.[rowAt(this.starts.get(channel) ?? [], time + 1e-9)];
  }

  /** The motions of a line of a file. Old recordings do not contain the files of motions. @param {number} channel @param {string} file @param {number} line */
  motionsOf(channel, file, line) {
    const name = (/** @type {string} */ path) => path.split(/[/\\]/).pop()?.toLowerCase() ?? "";
    const all = this.motions.get(channel) ?? [];
    return all.filter((motion) => motion.line === line && (!motion.file || name(motion.file) === name(file)));
  }

  /** @param {Lane} lane @param {number} time */
  levelAt(lane, time) {
    const at = rowAt(lane.times, time + 1e-9);
    return at < 0 ? 0 : lane.values[at];
  }

  /** Inputs and outputs in display order: those with names first. @returns {Lane[]} */
  get sortedLanes() {
    const order = ["di", "do", "ai", "ao"];
    /** @param {Lane} lane */
    const key = ({ signal, label }) => {
      const [kind, number] = signal.split(".");
      return [label === signal ? 1 : 0, order.indexOf(kind), Number(number)];
    };
    return [...this.lanes.values()].sort((one, other) => {
      const [a, b] = [key(one), key(other)];
      return a[0] - b[0] || a[1] - b[1] || a[2] - b[2];
    });
  }

  /** The entities of the scene at a time, by their names. @param {number} time */
  sceneAt(time) {
    /** @type {Map<string, import('./api.js').Entity>} */
    const there = new Map();
    for (const update of this.answer.scene) {
      if (update.time > time + 1e-9) break;
      for (const gone of update.gone) there.delete(gone);
      for (const entity of update.entities) there.set(entity.id, entity);
    }
    return there;
  }
}
