// The positions of a channel's robot: pieces of a run as the server reports them.

/** The length of a piece in s: the part of the path that is shown around a moment of a long run. */
export const PIECE_S = 300;
/** The number of pieces that are kept. */
const PIECES = 6;
/** Between rows farther apart than this, in s, the robot was at rest. */
const GAP_S = 0.06;
/** The interval between rows while a robot moves, in s. */
const STEP_S = 0.004;

/**
 * Rows of a run, in columns.
 * @typedef {Float64Array | Float32Array | Uint32Array | Uint8Array} Column
 */

/**
 * @template T
 * @typedef {{new (length: number): T, new (buffer: ArrayBuffer, at: number, length: number): T}} ColumnKind
 */

/**
 * @typedef {{count: number, width: number, times: Float64Array, axes: Float32Array, tcp: Float32Array, speed: Float32Array, pointers: Uint32Array, jumps: Uint8Array}} Rows
 * `jumps`: the tool has changed since the row before: no motion led there.
 * A moment: axes in deg (mm), TCP in mm and as a quaternion, speed in mm/s.
 * @typedef {{axes: number[], tcp: number[], speed: number, line: number, motionLine: number, motion: number, file: number, motionFile: number}} Moment
 */

/**
 * Reads what the server sends.
 * @param {ArrayBuffer} buffer
 * @returns {Rows}
 */
export function decode(buffer) {
  const [count, width] = new Uint32Array(buffer, 0, 2);
  let at = 8;
  /**
   * @template {Column} T
   * @param {ColumnKind<T>} kind @param {number} length
   */
  const next = (kind, length) => {
    const column = new kind(buffer, at, length);
    at += column.byteLength;
    return column;
  };
  return {
    count,
    width,
    times: next(Float64Array, count),
    axes: next(Float32Array, count * width),
    tcp: next(Float32Array, count * 7),
    speed: next(Float32Array, count),
    pointers: next(Uint32Array, count * 4),
    jumps: next(Uint8Array, count),
  };
}

/**
 * The last row that is not later than a time; -1 if there is none.
 * @param {ArrayLike<number>} times
 * @param {number} time
 */
export function rowAt(times, time) {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/**
 * The moment at a time, interpolated between the rows around it.
 * @param {Rows} rows
 * @param {number} time
 * @returns {Moment | undefined}
 */
export function momentAt(rows, time) {
  const row = Math.max(rowAt(rows.times, time), 0);
  if (row >= rows.count) return undefined;
  const next = Math.min(row + 1, rows.count - 1);
  const apart = rows.times[next] - rows.times[row];
  const begin = apart > GAP_S ? rows.times[next] - STEP_S : rows.times[row];
  const part = apart > 0 ? Math.min(Math.max((time - begin) / (rows.times[next] - begin), 0), 1) : 0;
  /** @param {Float32Array} column @param {number} width @param {number} [far] */
  const between = (column, width, far = part) =>
    Array.from({ length: width }, (_, at) => {
      const from = column[row * width + at];
      return from + (column[next * width + at] - from) * far;
    });
  // A change of tool takes effect at once.
  const far = rows.jumps[next] && part < 1 ? 0 : part;
  // A row describes the motion of the cycle before it.
  const [line, motionLine, motion, files] = rows.pointers.subarray((part > 0 ? next : row) * 4);
  const program = rows.pointers.subarray(row * 4);
  return {
    axes: between(rows.axes, rows.width),
    tcp: turned(between(rows.tcp, 7, far), rows.tcp.subarray(row * 7 + 3), rows.tcp.subarray(next * 7 + 3), far),
    speed: rows.speed[part > 0 ? next : row],
    line: part < 1 ? program[0] : line,
    motionLine,
    motion,
    file: (part < 1 ? program[3] : files) & 0xffff,
    motionFile: files >>> 16,
  };
}

/**
 * Interpolates from one quaternion to another on the shorter arc, and writes the result into `tcp`.
 * @param {number[]} tcp @param {Float32Array} from @param {Float32Array} to @param {number} part
 */
function turned(tcp, from, to, part) {
  const sign = from[0] * to[0] + from[1] * to[1] + from[2] * to[2] + from[3] * to[3] < 0 ? -1 : 1;
  for (let at = 0; at < 4; at++) tcp[3 + at] = from[at] + (sign * to[at] - from[at]) * part;
  const length = Math.hypot(tcp[3], tcp[4], tcp[5], tcp[6]) || 1;
  for (let at = 3; at < 7; at++) tcp[at] /= length;
  return tcp;
}

/** The rows of a channel, fetched where they are needed. */
export class Samples {
  /** @param {string} address @param {() => void} arrived called when rows have arrived */
  constructor(address, arrived) {
    this.address = address;
    this.arrived = arrived;
    /** @type {Map<number, {rows?: Rows, end: number, asked: boolean}>} */
    this.pieces = new Map();
  }

  /** @param {number} from @param {number} to @param {number} [most] @returns {Promise<Rows>} */
  async window(from, to, most = 400000) {
    const answer = await fetch(`${this.address}&from=${from}&to=${to}&most=${Math.round(most)}`);
    if (!answer.ok) throw new Error(await answer.text());
    return decode(await answer.arrayBuffer());
  }

  /**
   * The piece around a time, as far as it has arrived; requests what is missing. A run that goes on is requested again, up to its end.
   * @param {number} time @param {number} end
   * @returns {Rows | undefined}
   */
  piece(time, end) {
    const number = Math.max(Math.floor(time / PIECE_S), 0);
    const piece = this.pieces.get(number) ?? { end: -1, asked: false };
    this.pieces.delete(number);
    this.pieces.set(number, piece);
    const until = Math.min((number + 1) * PIECE_S, end);
    if (!piece.asked && piece.end < until) this.ask(number, piece, until);
    for (const old of this.pieces.keys()) {
      if (this.pieces.size <= PIECES) break;
      this.pieces.delete(old);
    }
    return piece.rows;
  }

  /** @param {number} number @param {{rows?: Rows, end: number, asked: boolean}} piece @param {number} until */
  async ask(number, piece, until) {
    piece.asked = true;
    try {
      const known = piece.rows;
      const from = known && known.count ? piece.end : number * PIECE_S;
      const more = await this.window(from, until);
      piece.rows = known ? joined(known, more) : more;
      piece.end = until;
    } catch {
      // The next access requests it again.
      await new Promise((done) => setTimeout(done, 500));
    }
    piece.asked = false;
    this.arrived();
  }

  /** @param {number} time @param {number} end */
  at(time, end) {
    const rows = this.piece(time, end);
    return rows && momentAt(rows, time);
  }
}

/**
 * Joins rows with later ones.
 * @param {Rows} known @param {Rows} more
 * @returns {Rows}
 */
function joined(known, more) {
  const skip = rowAt(more.times, known.times[known.count - 1] ?? -1) + 1;
  const count = known.count + more.count - skip;
  /**
   * @template {Column} T
   * @param {T} one @param {T} other @param {number} width
   */
  const both = (one, other, width) => {
    const column = new /** @type {ColumnKind<T>} */ (one.constructor)(count * width);
    column.set(one);
    column.set(other.subarray(skip * width), known.count * width);
    return column;
  };
  return {
    count,
    width: known.width,
    times: both(known.times, more.times, 1),
    axes: both(known.axes, more.axes, known.width),
    tcp: both(known.tcp, more.tcp, 7),
    speed: both(known.speed, more.speed, 1),
    pointers: both(known.pointers, more.pointers, 4),
    jumps: both(known.jumps, more.jumps, 1),
  };
}
