// The source of the program, with the line that runs, the line whose motion is executed, and the time each line took.

import { element, write } from "./dom.js";

const TOKEN = /\/\/.*|"(?:\\.|[^"\\])*"|\b\d[\w.]*|\$?[A-Za-z_]\w*|\s+|./gu;

/** A line of code with syntax colours. @param {string} text @param {Set<string>} keywords */
function colored(text, keywords) {
  return (text.match(TOKEN) ?? []).map((token) => {
    const kind = token.startsWith("//") ? "comment" : /^["\d]/.test(token) ? "literal" : keywords.has(token.toLowerCase()) ? "keyword" : "";
    return kind ? element("span", { className: kind }, token) : token;
  });
}

export class Source {
  /** @param {import('./run.js').Run} run @param {(file: string, line: number) => void} chosen */
  constructor(run, chosen) {
    this.run = run;
    this.keywords = new Set(run.answer.keywords);
    /** @type {Map<string, {row: HTMLElement, took: HTMLElement, pointer: HTMLElement}[]>} */
    this.lines = new Map();
    this.holder = element("div", { className: "source" });
    for (const { name, text } of run.answer.sources) {
      const rows = text
        .replace(/\n$/, "")
        .split("\n")
        .map((line, at) => {
          const took = element("span", { className: "took", title: "How long the robot moved for this line, or stood still in it, in s" });
          const pointer = element("span", { className: "pointer" });
          const code = element("span", {}, ...colored(line, this.keywords));
          const row = element("div", { className: "code" }, took, pointer, element("span", { className: "number" }, String(at + 1)), code);
          row.addEventListener("click", () => chosen(name, at + 1));
          return { row, took, pointer };
        });
      this.lines.set(name.toLowerCase(), rows);
      this.holder.append(element("div", { className: "file" }, name), ...rows.map(({ row }) => row));
    }
    if (this.lines.size === 0) this.holder.append(element("p", { className: "hint" }, "The recording does not contain the source of the program."));
    this.marked = "";
    this.version = -1;
  }

  /** @param {string} file @param {number} line */
  line(file, line) {
    const name = file.split(/[/\\]/).pop()?.toLowerCase() ?? "";
    return this.lines.get(name)?.[line - 1];
  }

  /** Shows the times that the lines of a channel took. @param {number} channel */
  times(channel) {
    if (this.version === this.run.answer.version * 100 + channel) return;
    this.version = this.run.answer.version * 100 + channel;
    const { files, lines } = this.run.track(channel);
    const most = Math.max(...lines.map((one) => one.moving + one.standing), 1e-9);
    for (const { file, line, moving, standing } of lines) {
      const found = this.line(files[file] ?? "", line);
      if (!found) continue;
      write(found.took, (moving + standing).toFixed(2));
      found.took.style.setProperty("--part", `${((moving + standing) / most) * 100}%`);
    }
  }

  /**
   * Marks the lines where the program and the robot are.
   * @param {{file: string, line: number} | undefined} program @param {{file: string, line: number} | undefined} motion
   */
  mark(program, motion) {
    const marked = JSON.stringify([program, motion]);
    if (marked === this.marked) return;
    this.marked = marked;
    for (const old of this.holder.querySelectorAll(".program, .motion")) {
      old.classList.remove("program", "motion");
      write(/** @type {HTMLElement} */ (old.querySelector(".pointer")), "");
    }
    const [at, moved] = [program && this.line(program.file, program.line), motion && this.line(motion.file, motion.line)];
    at?.row.classList.add("program");
    moved?.row.classList.add("motion");
    if (at) write(at.pointer, "▶");
    if (moved) write(moved.pointer, moved === at ? "▶●" : "●");
    this.scrollTo((moved ?? at)?.row);
  }

  /** @param {HTMLElement | undefined} row */
  scrollTo(row) {
    const panel = this.holder.parentElement;
    if (!row || !panel) return;
    const [top, view] = [row.offsetTop - panel.offsetTop, panel.clientHeight];
    if (top < panel.scrollTop + 24 || top > panel.scrollTop + view - 40) panel.scrollTop = top - view / 2;
  }
}
