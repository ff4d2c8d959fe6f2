// Draws docs/editor.svg: a program in the colours of the grammar, with what the language server says of it.
//
// node scripts/picture.mjs COMMAND [--check]

import { spawn } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const require = createRequire(import.meta.url);
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");
const at = (file) => fileURLToPath(new URL(file, import.meta.url));

const PROGRAM = `// Takes parts from the feeder while the gate is closed.
wobj table
joint home = {0, -90, 90, 0, 90, 0}
pose feeder = {x 900, y -500, z 400, a 0, b 180, c 0}
int taken = 0
func void opened(int gate)
    setdo(gate, true)
endfunc
func void main()
    interrupt "gate", when:getdi(5), do:opened(3)
    movej home, vp:50%
    lin feeder, vl:250mm/s, w:table
    waituntil getdi(2), maxtime:5
    if(taken = 1)
        print "taken: ", taken + 1
    endif
    movej hom, vp:50%
endfunc
`;

// The colours of VS Code's own dark theme, by the beginnings of scopes.
const COLOURS = {
  comment: "#6a9955",
  string: "#ce9178",
  "constant.numeric": "#b5cea8",
  "constant.language": "#569cd6",
  "constant.other": "#4fc1ff",
  "keyword.control": "#c586c0",
  "keyword.other": "#569cd6",
  "keyword.other.unit": "#b5cea8",
  "keyword.operator": "#d4d4d4",
  storage: "#569cd6",
  "entity.name.function": "#dcdcaa",
  "support.function": "#dcdcaa",
  "support.constant": "#4fc1ff",
  "support.type": "#4ec9b0",
  variable: "#9cdcfe",
  "entity.name.label": "#c8c8c8",
};
const PLAIN = "#d4d4d4";
const COLUMN = 8.4;
const LINE = 22;
const LEFT = 52;

/** What the server says of the program: its problems, and its hints. */
async function told(command) {
  const server = spawn(command, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  let buffer = Buffer.alloc(0);
  const waiting = [];
  server.stdout.on("data", (bytes) => {
    buffer = Buffer.concat([buffer, bytes]);
    for (;;) {
      const head = /^Content-Length: (\d+)\r\n\r\n/.exec(buffer.toString("latin1"));
      const end = head ? head[0].length + Number(head[1]) : Infinity;
      if (buffer.length < end) return;
      const message = JSON.parse(buffer.subarray(head[0].length, end).toString());
      buffer = buffer.subarray(end);
      const index = waiting.findIndex((one) => one.wanted(message));
      if (index >= 0) waiting.splice(index, 1)[0].done(message);
    }
  });
  const until = (wanted) => new Promise((done) => waiting.push({ wanted, done }));
  const send = (message) => {
    const text = JSON.stringify({ jsonrpc: "2.0", ...message });
    server.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  };
  const ask = (id, method, params) => {
    const answer = until((message) => message.id === id);
    send({ id, method, params });
    return answer;
  };
  const uri = "file:///nowhere/pick.arl";
  await ask(1, "initialize", { capabilities: {} });
  send({ method: "initialized", params: {} });
  const published = until((message) => message.method === "textDocument/publishDiagnostics");
  send({
    method: "textDocument/didOpen",
    params: { textDocument: { uri, languageId: "arl", version: 1, text: PROGRAM } },
  });
  const diagnostics = (await published).params.diagnostics;
  const range = { start: { line: 0, character: 0 }, end: { line: 999, character: 0 } };
  const hints = (await ask(2, "textDocument/inlayHint", { textDocument: { uri }, range })).result ?? [];
  await ask(3, "shutdown", null);
  send({ method: "exit" });
  return { diagnostics, hints };
}

/** The colours of each line, piece by piece. */
async function coloured() {
  const wasm = readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => textmate.parseRawGrammar(readFileSync(at("../syntaxes/arl.tmLanguage.json"), "utf8"), "arl.json"),
  });
  const grammar = await registry.loadGrammar("source.arl");
  let stack = textmate.INITIAL;
  return PROGRAM.trimEnd()
    .split("\n")
    .map((line) => {
      const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
      stack = ruleStack;
      return tokens.map(({ startIndex, endIndex, scopes }) => ({
        start: startIndex,
        text: line.slice(startIndex, endIndex),
        colour: colour(scopes),
      }));
    });
}

/** The colour of the innermost scope that has one; of its beginnings the longest counts. */
function colour(scopes) {
  for (const scope of scopes.toReversed()) {
    const known = Object.keys(COLOURS).filter((name) => scope === name || scope.startsWith(`${name}.`));
    if (known.length > 0) return COLOURS[known.sort((one, other) => other.length - one.length)[0]];
  }
  return PLAIN;
}

const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
const numbered = (value) => Number(value.toFixed(1));

function drawn(lines, { diagnostics, hints }) {
  const hintText = (hint) => (typeof hint.label === "string" ? hint.label : hint.label.map((part) => part.value).join(""));
  const height = lines.length * LINE + 24;
  const out = [
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 860 ${height}" font-family="Consolas, Menlo, monospace" font-size="14">`,
    `<rect width="860" height="${height}" rx="6" fill="#1e1e1e"/>`,
  ];
  lines.forEach((pieces, number) => {
    const y = numbered(12 + LINE * number + 15);
    const here = hints.filter((hint) => hint.position.line === number);
    const shown = here.map((hint) => ({ column: hint.position.character, text: hintText(hint) }));
    // Hints push the text behind them to the right.
    const x = (column, behind) => {
      const before = shown.filter((one) => one.column < column || (behind && one.column === column));
      return numbered(LEFT + COLUMN * (column + before.reduce((sum, one) => sum + one.text.length + 1, 0)));
    };
    out.push(`<text x="${LEFT - 14}" y="${y}" fill="#858585" text-anchor="end">${number + 1}</text>`);
    for (const { start, text, colour } of pieces.flatMap((piece) => split(piece, shown))) {
      if (text.trim() === "") continue;
      const indent = text.length - text.trimStart().length;
      out.push(`<text x="${x(start + indent, true)}" y="${y}" fill="${colour}" xml:space="preserve">${escaped(text.trim())}</text>`);
    }
    for (const { column, text } of shown) {
      const left = x(column, false);
      out.push(`<rect x="${left}" y="${y - 13}" width="${numbered(COLUMN * text.length + 4)}" height="17" rx="3" fill="#2f3136"/>`);
      out.push(`<text x="${numbered(left + 2)}" y="${y}" fill="#969696">${escaped(text)}</text>`);
    }
    for (const { range, severity, message } of diagnostics.filter((one) => one.range.start.line === number)) {
      const [left, right] = [x(range.start.character, true), x(range.end.character, false)];
      const tint = severity === 1 ? "#f14c4c" : "#cca700";
      const wave = "q1 -2 2 0t2 0".repeat(Math.ceil((right - left) / 4));
      out.push(`<path d="M${left} ${y + 4}${wave}" fill="none" stroke="${tint}"/>`);
      const end = x(pieces.at(-1).start + pieces.at(-1).text.length, true) + 24;
      out.push(`<text x="${numbered(end)}" y="${y}" fill="${tint}" font-style="italic">${escaped(message.split("\n")[0])}</text>`);
    }
  });
  return `${[...out, "</svg>"].join("\n")}\n`;
}

/** A piece, cut where hints stand in it. */
function split(piece, hints) {
  const cuts = hints.map((one) => one.column - piece.start).filter((cut) => cut > 0 && cut < piece.text.length);
  const ends = [...new Set([...cuts, piece.text.length])].sort((one, other) => one - other);
  return ends.map((end, index) => {
    const start = index === 0 ? 0 : ends[index - 1];
    return { ...piece, start: piece.start + start, text: piece.text.slice(start, end) };
  });
}

const [command, check] = process.argv.slice(2);
const target = at("../../../docs/editor.svg");
const picture = drawn(await coloured(), await told(command));
if (check !== "--check") {
  writeFileSync(target, picture);
} else if (readFileSync(target, "utf8") !== picture) {
  console.error("docs/editor.svg is not what the script draws: node scripts/picture.mjs COMMAND");
  process.exit(1);
}
