// Writes syntaxes/arl.tmLanguage.json from words.json. With --check it only says whether that file is fresh.

import { readFileSync, writeFileSync } from "node:fs";

const here = (path) => new URL(`../${path}`, import.meta.url);
const words = JSON.parse(readFileSync(here("words.json"), "utf8"));

/** Words of this grammar that have a rule or a scope of their own, by what they are. */
const KEYWORDS = {
  conditional: ["if", "elseif", "else", "endif", "switch", "case", "default", "endswitch"],
  loop: ["while", "endwhile", "for", "endfor", "loop", "endloop", "repeat", "until", "break", "continue"],
  flow: ["return", "goto"],
  import: ["import"],
  function: ["func", "endfunc"],
  modifier: ["const"],
  boolean: ["true", "false"],
  text: ["endl"],
};

/** A pattern for one of these words, the longest first. */
const oneOf = (list) => `(?:${[...list].sort((a, b) => b.length - a.length || (a < b ? -1 : 1)).join("|")})`;

const known = Object.values(KEYWORDS).flat();
const strangers = words.keywords.filter((word) => !known.includes(word));
const missing = known.filter((word) => !words.keywords.includes(word));
if (strangers.length > 0 || missing.length > 0) {
  throw new Error(`scripts/grammar.mjs has no kind for the keywords: ${[...strangers, ...missing].join(", ")}`);
}

const NAME = "[A-Za-z_][A-Za-z0-9_]*";
/** Not inside a longer word, not a component, not a member of a module, not a system variable. */
const ALONE = "(?<![A-Za-z0-9_$.])(?<!::)";
/** What may stand between the end of a statement and the end of its line. */
const LINE_END = "(?=[ \\t]*(?:$|//|/\\*))";
/** The end of an argument or of an element. */
const VALUE_END = "(?=[ \\t]*(?:$|//|/\\*|[,;)}\\]]))";
/** An assignment, an index, a component, or a step: what a variable's name has behind it. */
const USED_AS_VARIABLE = "[ \\t]*(?:=(?!=)|\\+\\+|--|[-+*/%&|^]=|<<=|>>=|\\[|\\.|::)";
/** Where a statement or an action can begin: a line, behind the condition of a compact `if`, behind `case 1:`. */
const STATEMENT_START = "(?:^[ \\t]*|(?<=[):]|\\*/)[ \\t]*)";
/** Names that are types and constants; alone as an argument they are constants. */
const types_and_constants = words.types.filter((word) => words.constants.includes(word));

const anyCase = (pattern) => `(?i)${pattern}`;
const include = (...names) => names.map((name) => ({ include: `#${name}` }));
const captures = (...names) =>
  Object.fromEntries(names.map((name, at) => [String(at + 1), { name }]).filter(([, { name }]) => name));

const keyword = (list, name) => ({ match: anyCase(`${ALONE}${oneOf(list)}\\b`), name });

/** The order matters: where two rules match at the same place, the first one counts. */
const EVERYTHING = [
  "comments", "strings", "continuation", "cases", "function-definition", "goto", "jump-label", "keywords",
  "instructions", "argument-label", "paths", "components", "system", "types", "functions", "calls", "constants",
  "numbers", "percent", "braces", "parens", "brackets", "operators", "punctuation", "variables",
];

const repository = {
  comments: {
    patterns: [
      {
        match: "(//).*$",
        name: "comment.line.double-slash.arl",
        captures: captures("punctuation.definition.comment.arl"),
      },
      {
        begin: "/\\*",
        end: "\\*/",
        name: "comment.block.arl",
        captures: { 0: { name: "punctuation.definition.comment.arl" } },
      },
    ],
  },
  strings: {
    patterns: [
      {
        begin: "\"",
        end: "(\")|(?=\\n|$)",
        name: "string.quoted.double.arl",
        beginCaptures: { 0: { name: "punctuation.definition.string.begin.arl" } },
        endCaptures: captures("punctuation.definition.string.end.arl"),
        patterns: [
          { match: "\\\\[nrt\"\\\\]", name: "constant.character.escape.arl" },
          { match: "\\\\[^\\n]", name: "invalid.illegal.escape.arl" },
        ],
      },
      { match: "'[^'\\n]*'?", name: "invalid.illegal.quotes.arl" },
    ],
  },
  continuation: {
    match: "(\\\\)[ \\t]*\\n",
    captures: captures("punctuation.separator.continuation.arl"),
  },
  // A case has its value between the word and the colon; that value is not a label.
  cases: {
    patterns: [
      {
        match: anyCase(`${ALONE}(default)[ \\t]*(:)(?!:)`),
        captures: captures("keyword.control.conditional.arl", "punctuation.separator.case.arl"),
      },
      {
        begin: anyCase(`${ALONE}case\\b`),
        end: "(:)(?!:)|(?=\\n|$)",
        beginCaptures: { 0: { name: "keyword.control.conditional.arl" } },
        endCaptures: captures("punctuation.separator.case.arl"),
        patterns: include(...EVERYTHING.filter((rule) => !["argument-label", "jump-label", "cases"].includes(rule))),
      },
    ],
  },
  "function-definition": {
    match: anyCase(`${ALONE}(func)[ \\t]+(\\$?${NAME})[ \\t]+(${NAME})(?=[ \\t]*\\()`),
    captures: captures("storage.type.function.arl", "storage.type.arl", "entity.name.function.arl"),
  },
  goto: {
    match: anyCase(`${ALONE}(goto)[ \\t]+(${NAME})`),
    captures: captures("keyword.control.flow.arl", "entity.name.label.arl"),
  },
  "jump-label": {
    match: anyCase(`^[ \\t]*(?!${oneOf(words.keywords)}\\b)(${NAME})[ \\t]*(:)(?!:)${LINE_END}`),
    captures: captures("entity.name.label.arl", "punctuation.separator.label.arl"),
  },
  keywords: {
    patterns: [
      keyword(KEYWORDS.conditional, "keyword.control.conditional.arl"),
      keyword(KEYWORDS.loop, "keyword.control.loop.arl"),
      keyword(KEYWORDS.flow, "keyword.control.flow.arl"),
      keyword(KEYWORDS.import, "keyword.control.import.arl"),
      keyword(KEYWORDS.function, "storage.type.function.arl"),
      keyword(KEYWORDS.modifier, "storage.modifier.arl"),
      keyword(KEYWORDS.boolean, "constant.language.boolean.arl"),
      keyword(KEYWORDS.text, "constant.language.arl"),
    ],
  },
  instructions: {
    match: anyCase(`${STATEMENT_START}(${oneOf(words.instructions)})\\b(?!\\(|${USED_AS_VARIABLE}|[ \\t]*[,)}\\]:])`),
    captures: captures("keyword.other.instruction.arl"),
  },
  "argument-label": {
    patterns: [
      {
        match: anyCase(`${ALONE}(${NAME})[ \\t]*(:)(?!:)[ \\t]*(${oneOf(types_and_constants)})\\b${VALUE_END}`),
        captures: captures("variable.parameter.label.arl", "punctuation.separator.label.arl", "support.constant.arl"),
      },
      {
        match: `${ALONE}(${NAME})[ \\t]*(:)(?!:)`,
        captures: captures("variable.parameter.label.arl", "punctuation.separator.label.arl"),
      },
    ],
  },
  paths: {
    patterns: [
      {
        match: anyCase(`${ALONE}(${oneOf(words.types)})[ \\t]*(::)[ \\t]*(${NAME})`),
        captures: captures("entity.name.type.arl", "punctuation.separator.scope.arl", "support.constant.arl"),
      },
      {
        match: `(?<![A-Za-z0-9_$.])(${NAME})[ \\t]*(::)[ \\t]*(${NAME})(?=[ \\t]*\\()`,
        captures: captures(
          "entity.name.namespace.arl", "punctuation.separator.scope.arl", "entity.name.function.call.arl",
        ),
      },
      {
        match: `(?<![A-Za-z0-9_$.])(${NAME})[ \\t]*(::)(?:[ \\t]*(${NAME}))?`,
        captures: captures("entity.name.namespace.arl", "punctuation.separator.scope.arl", "variable.other.arl"),
      },
    ],
  },
  components: {
    match: `(\\.)[ \\t]*(${NAME})`,
    captures: captures("punctuation.accessor.arl", "variable.other.property.arl"),
  },
  system: {
    patterns: [
      {
        match: `(\\$${NAME})[ \\t]*(::)[ \\t]*(${NAME})`,
        captures: captures("storage.type.arl", "punctuation.separator.scope.arl", "support.constant.arl"),
      },
      { match: `\\$${NAME}(?=[ \\t]+${NAME}[ \\t]*(?:[=,\\[]|$))`, name: "storage.type.arl" },
      { match: anyCase(`\\$${oneOf(words.system)}\\b`), name: "variable.language.system.arl" },
      { match: `\\$(?:${NAME})?`, name: "variable.other.system.arl" },
    ],
  },
  types: {
    patterns: [
      {
        match: anyCase(`${ALONE}(${oneOf(words.types)})[ \\t]+(?!${oneOf(words.keywords)}\\b)(${NAME})\\b`),
        captures: captures("storage.type.arl", "variable.other.arl"),
      },
      {
        match: anyCase(`${ALONE}(${oneOf(words.types)})\\b(?!${USED_AS_VARIABLE})`),
        captures: captures("storage.type.arl"),
      },
    ],
  },
  functions: {
    match: anyCase(`${ALONE}${oneOf(words.functions)}(?=[ \\t]*\\()`),
    name: "support.function.arl",
  },
  calls: { match: `${ALONE}${NAME}(?=[ \\t]*\\()`, name: "entity.name.function.call.arl" },
  constants: {
    match: anyCase(`${ALONE}${oneOf(words.constants)}\\b(?!${USED_AS_VARIABLE})`),
    name: "support.constant.arl",
  },
  numbers: {
    patterns: [
      { match: anyCase("(?<![A-Za-z0-9_$])\\d[0-9a-f]*h\\b"), name: "constant.numeric.hex.arl" },
      { match: anyCase("(?<![A-Za-z0-9_$])[01]+b\\b"), name: "constant.numeric.binary.arl" },
      number("(?:\\d+\\.(?!\\.)\\d*|\\.\\d+)(?:e[-+]?\\d+)?|\\d+e[-+]?\\d+", "constant.numeric.float.arl"),
      number("\\d+", "constant.numeric.integer.arl"),
      { match: "(?<![A-Za-z0-9_$])\\.?\\d[A-Za-z0-9_.]*", name: "invalid.illegal.number.arl" },
    ],
  },
  percent: { match: `%${VALUE_END}`, name: "keyword.other.unit.arl" },
  braces: {
    begin: "\\{",
    end: "(\\})|(?=\\n)",
    beginCaptures: { 0: { name: "punctuation.section.braces.begin.arl" } },
    endCaptures: captures("punctuation.section.braces.end.arl"),
    name: "meta.braces.arl",
    patterns: include("comments", "strings", "continuation", "component-in-braces", ...EVERYTHING),
  },
  "component-in-braces": {
    patterns: [
      {
        match: `(?:(?<=[{,])|^)[ \\t]*(${NAME})(?=[ \\t]+[A-Za-z0-9_.]|[ \\t]*["{$~]|[ \\t]*-(?![-=])|[ \\t]*!(?!=))`,
        captures: captures("variable.other.property.arl"),
      },
      {
        match: anyCase(`(?:(?<=[{,])|^)[ \\t]*(${oneOf(words.types)})(?=[ \\t]*\\()`),
        captures: captures("variable.other.property.arl"),
      },
    ],
  },
  parens: {
    begin: "\\(",
    end: "(\\))|(?=\\n)",
    beginCaptures: { 0: { name: "punctuation.section.parens.begin.arl" } },
    endCaptures: captures("punctuation.section.parens.end.arl"),
    name: "meta.parens.arl",
    patterns: include(...EVERYTHING),
  },
  brackets: { match: "[\\[\\]]", name: "punctuation.section.brackets.arl" },
  operators: {
    patterns: [
      { match: "\\+\\+|--", name: "keyword.operator.increment.arl" },
      { match: "<<=|>>=|[-+*/%&|^]=", name: "keyword.operator.assignment.compound.arl" },
      { match: "==|!=|<=|>=|<(?!<)|(?<!>)>(?!>)", name: "keyword.operator.comparison.arl" },
      { match: "&&|\\|\\||!", name: "keyword.operator.logical.arl" },
      { match: "<<|>>|[&|^~]", name: "keyword.operator.bitwise.arl" },
      { match: "=", name: "keyword.operator.assignment.arl" },
      { match: "[-+*/%]", name: "keyword.operator.arithmetic.arl" },
    ],
  },
  punctuation: {
    patterns: [
      { match: ",", name: "punctuation.separator.arl" },
      { match: ";", name: "punctuation.terminator.arl" },
    ],
  },
  variables: { match: `${ALONE}${NAME}`, name: "variable.other.arl" },
};

/** A decimal number, with a unit directly behind it or behind a blank. */
function number(digits, name) {
  const close = "mm/s|mm|deg/s|deg|s";
  const behind_blank = "mm(?:[ \\t]*/[ \\t]*s\\b)?|deg(?:[ \\t]*/[ \\t]*s\\b)?|s";
  const unit = `(?:(${close})(?![A-Za-z0-9_])|[ \\t]+(${behind_blank})(?![A-Za-z0-9_]))`;
  return {
    match: anyCase(`(?<![A-Za-z0-9_$])(${digits})(?:${unit}|(?![A-Za-z0-9_.]))`),
    captures: captures(name, "keyword.other.unit.arl", "keyword.other.unit.arl"),
  };
}

const grammar = {
  name: "ARL",
  scopeName: "source.arl",
  comment: "Written by scripts/grammar.mjs. Change that, or words.json.",
  patterns: include(...EVERYTHING),
  repository,
};

const target = here("syntaxes/arl.tmLanguage.json");
const text = `${JSON.stringify(grammar, null, 2)}\n`;
if (process.argv.includes("--check")) {
  if (readFileSync(target, "utf8") !== text) {
    throw new Error("syntaxes/arl.tmLanguage.json is not what scripts/grammar.mjs writes: run `npm run grammar`");
  }
} else {
  writeFileSync(target, text);
}
