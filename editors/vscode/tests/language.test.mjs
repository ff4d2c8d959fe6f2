// Indentation, words and folding of language-configuration.json.

import assert from "node:assert/strict";
import { test } from "node:test";
import { json } from "./support.mjs";

const { indentationRules, wordPattern, folding } = json("language-configuration.json");
const rule = ({ pattern, flags }) => new RegExp(pattern, flags);
const opens = rule(indentationRules.increaseIndentPattern);
const closes = rule(indentationRules.decreaseIndentPattern);

test("lines that open a block", () => {
  const lines = [
    "func void main()", "  IF(a)", "if (f(g(1), (2)) == 3) // why", "if(a == \")\")", "elseif(b)", "Else", "while(a)",
    "for(int i = 0; i < 3; i++)", "loop", "repeat", "switch(a)", "case 1:", "case a::b: x()", "default:",
    "if(((a)))", "if(a) /* all of it */",
  ];
  assert.deepEqual(lines.filter((line) => !opens.test(line)), []);
});

test("lines that open none", () => {
  const lines = [
    "if(a) setdo(1, true)", "if(f(1)) x = (2)", "if(a) print \"b\" // c", "// if(a)", "endif", "until(a)",
    "function = 1", "forward(1)", "elsewhere = 2", "print \"if(a)\"",
    "if(a", "iff(a)", "a = if_b(c)",
  ];
  assert.deepEqual(lines.filter((line) => opens.test(line)), []);
});

test("lines that close a block", () => {
  const lines = [
    "endfunc", "  ENDIF // a", "endwhile", "endfor", "endloop", "until(a)", "endswitch", "else", "elseif(a)", "case 1:",
    "default:",
  ];
  assert.deepEqual(lines.filter((line) => !closes.test(line)), []);
  assert.deepEqual(["endless = 1", "print 1", "untilted()", "defaults()"].filter((line) => closes.test(line)), []);
});

test("a long line is looked at in no time", () => {
  assert.equal(opens.test(`if(${"((a".repeat(2000)}`), false);
  assert.equal(opens.test(`if(${"\"a\"(b)".repeat(2000)}) x(1)`), false);
});

test("words", () => {
  const words = "a_1 = $PGNO + b::c * 1.5e3 ".match(new RegExp(wordPattern.pattern, "g"));
  assert.deepEqual(words, ["a_1", "$PGNO", "b", "c", "1.5e3"]);
});

test("regions", () => {
  const { start, end } = folding.markers;
  assert.match("  // region points", new RegExp(start));
  assert.match("//endregion", new RegExp(end));
  assert.doesNotMatch("// regional", new RegExp(start));
});
