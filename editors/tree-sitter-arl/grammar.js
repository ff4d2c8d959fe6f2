/**
 * ARL, the robot language of the AE, Peitian and Ligent controllers.
 *
 * A statement ends with its line, so the line end is a token. Lines end inside of no bracket; `\` at the end of a
 * line continues it. Words ignore case.
 */

/// <reference types="tree-sitter-cli/dsl" />
// @ts-check

/** The words of control structures and constants. */
const KEYWORDS = [
  'break', 'case', 'const', 'continue', 'default', 'else', 'elseif', 'endfor', 'endfunc', 'endif', 'endl', 'endloop',
  'endswitch', 'endwhile', 'false', 'for', 'func', 'goto', 'if', 'import', 'loop', 'repeat', 'return', 'switch', 'true',
  'until', 'while',
];

/** The types whose names are reserved. */
const TYPES = [
  'bool', 'byte', 'clock', 'controlmode', 'double', 'frame', 'int', 'joint', 'jvel', 'num_base', 'parity', 'pos',
  'pose', 'printto', 'slip', 'speed', 'stopbits', 'stoptype', 'string', 'tool', 'toolinertiapara', 'uint', 'void',
  'weavedata', 'weaverotaxis', 'weaveshape', 'wobj',
];

/** The instructions whose names are reserved. */
const INSTRUCTIONS = [
  'accset', 'ccir', 'cir', 'compen', 'endcompen', 'endweave', 'exit', 'interrupt', 'lin', 'movej', 'pause', 'print',
  'ptp', 'restart', 'scan', 'startcompen', 'startmove', 'startweave', 'stopmove', 'timer', 'toolload', 'toolswitch',
  'trigger', 'velset', 'waittime', 'waituntil',
];

/** The instructions whose names a program may use for its own things, too. */
const OPEN_INSTRUCTIONS = [
  'delint', 'disableint', 'enableint', 'enddetect', 'jump', 'setdoimv', 'spl', 'startdetect', 'startweavelin',
  'startweavespa',
];

/** What binds tighter has the higher number. */
const BINDING = {
  assign: 1,
  or: 2,
  and: 3,
  bitOr: 4,
  bitXor: 5,
  bitAnd: 6,
  equality: 7,
  comparison: 8,
  shift: 9,
  sum: 10,
  product: 11,
  unary: 12,
  access: 13,
};

/** A word in any case. @param {string} word */
const anyCase = (word) => new RegExp(word, 'i');

/** One of `words` in any case. @param {string[]} words */
const anyOf = (words) => token(choice(...words.map(anyCase)));

/** A word of the language, in the tree under its spelling in lower case. @param {string} word */
const word = (word) => alias(anyCase(word), word);

/** One or more with commas between. @param {RuleOrLiteral} rule */
const list = (rule) => seq(rule, repeat(seq(',', rule)));

/** The name of something new, in the tree as `as`. @param {any} $ @param {any} as */
const newName = ($, as) => choice(alias($.identifier, as), alias($._open_instruction, as));

/** A name that may be that of a type, too, in the tree as `as`. @param {any} $ @param {any} as */
const otherName = ($, as) => choice(newName($, as), alias($.primitive_type, as));

/** What stands behind the colon of a case, on its line or below. @param {any} $ */
const caseBody = ($) => [repeat($._newline), field('body', optional($.block))];

module.exports = grammar({
  name: 'arl',

  word: ($) => $.identifier,

  extras: ($) => [/[ \t\v\f]/, $.line_comment, $.block_comment, $.line_continuation],

  reserved: {
    global: ($) => [...KEYWORDS.map(anyCase), $.primitive_type, $._reserved_instruction],
    // Behind `.` and `::` every word is a name.
    none: (_) => [],
  },

  supertypes: ($) => [$.expression],

  conflicts: ($) => [
    // `20 %` at the end of an argument is a unit, `20 % n` a remainder.
    [$.quantity, $.expression],
  ],

  rules: {
    // Statements outside of functions are a mistake, but parts of programs shall be readable, too.
    source_file: ($) => seq(repeat($._line), optional(choice($.import, $._simple_line))),

    _line: ($) => choice($._newline, seq($.import, $._newline), $.function_definition, $._statement_line),

    _newline: (_) => /\r\n|\n|\r/,

    import: ($) => seq(word('import'), field('path', $.string)),

    // Functions

    function_definition: ($) =>
      seq(
        word('func'),
        field('result', $._type),
        field('name', newName($, $.identifier)),
        field('parameters', optional($.parameters)),
        $._body,
        word('endfunc'),
      ),

    parameters: ($) => seq('(', optional(list($.parameter)), ')'),

    parameter: ($) => seq(field('type', $._type), field('name', newName($, $.identifier)), repeat($.dimension)),

    // Blocks. What closes one needs no line end behind it, so that one that is missing can be put in before the
    // next word that closes a block.

    _body: ($) => seq(repeat1($._newline), field('body', optional($.block))),

    block: ($) => seq($._statement_line, repeat(choice($._newline, $._statement_line))),

    _statement_line: ($) => choice(seq($._simple_line, $._newline), $._block_statement),

    _block_statement: ($) =>
      choice(
        $.if_statement,
        $.while_statement,
        $.repeat_statement,
        $.loop_statement,
        $.for_statement,
        $.switch_statement,
      ),

    if_statement: ($) =>
      seq(
        word('if'),
        field('condition', $.condition),
        $._body,
        repeat($.elseif_clause),
        optional($.else_clause),
        word('endif'),
      ),

    elseif_clause: ($) => seq(word('elseif'), field('condition', $.condition), $._body),

    else_clause: ($) => seq(word('else'), $._body),

    while_statement: ($) => seq(word('while'), field('condition', $.condition), $._body, word('endwhile')),

    repeat_statement: ($) => seq(word('repeat'), $._body, word('until'), field('condition', $.condition)),

    loop_statement: ($) => seq(word('loop'), $._body, word('endloop')),

    for_statement: ($) =>
      seq(
        word('for'),
        '(',
        field('start', optional(choice($.declaration, $.expression))),
        ';',
        field('condition', optional($.expression)),
        ';',
        field('step', optional($.expression)),
        ')',
        $._body,
        word('endfor'),
      ),

    switch_statement: ($) =>
      seq(
        word('switch'),
        field('value', $.condition),
        repeat1($._newline),
        repeat(choice($.case_clause, $.default_clause)),
        word('endswitch'),
      ),

    case_clause: ($) => seq(word('case'), field('value', $.expression), ':', ...caseBody($)),

    default_clause: ($) => seq(word('default'), ':', ...caseBody($)),

    condition: ($) => seq('(', $.expression, ')'),

    // Lines

    _simple_line: ($) => choice($._simple_statement, $.compact_if_statement, $.declaration, $.label),

    compact_if_statement: ($) =>
      seq(word('if'), field('condition', $.condition), field('consequence', $._simple_statement)),

    _simple_statement: ($) =>
      choice(
        $.expression_statement,
        $.instruction,
        $.break_statement,
        $.continue_statement,
        $.goto_statement,
        $.return_statement,
      ),

    expression_statement: ($) => $.expression,

    break_statement: (_) => word('break'),

    continue_statement: (_) => word('continue'),

    goto_statement: ($) => seq(word('goto'), field('label', newName($, $.label_name))),

    return_statement: ($) => seq(word('return'), field('value', optional($.expression))),

    label: ($) => seq(field('name', newName($, $.label_name)), ':'),

    declaration: ($) => seq(optional(word('const')), field('type', $._type), list($.variable)),

    variable: ($) =>
      seq(
        field('name', newName($, $.identifier)),
        repeat($.dimension),
        optional(seq('=', field('value', $.expression))),
      ),

    dimension: ($) => seq('[', field('size', $.expression), ']'),

    _type: ($) =>
      choice($.primitive_type, alias($.identifier, $.type_identifier), alias($.system_variable, $.system_type)),

    // Instructions

    instruction: ($) =>
      choice(
        seq(
          field('name', alias($._reserved_instruction, $.instruction_name)),
          field('arguments', optional($.arguments)),
          repeat($.event),
        ),
        // Alone, or in front of what no name stands in front of. `jump (1)` is a call, `spl - 1` a difference.
        prec(3, seq(
          field('name', alias($._open_instruction, $.instruction_name)),
          repeat($.event),
        )),
        seq(
          field('name', alias($._open_instruction, $.instruction_name)),
          field('arguments', $.arguments),
          repeat($.event),
        ),
      ),

    arguments: ($) => list($.argument),

    event: ($) => seq(';', field('when', $.expression), ',', field('action', $.expression)),

    argument: ($) =>
      seq(
        optional(seq(field('label', otherName($, $.argument_label)), ':')),
        field('value', choice($.expression, $.quantity, alias($.primitive_type, $.identifier))),
      ),

    quantity: ($) => seq(optional('-'), $._decimal, field('unit', $.unit)),

    unit: (_) =>
      choice(
        '%',
        word('mm'),
        seq(word('mm'), '/', word('s')),
        word('deg'),
        seq(word('deg'), '/', word('s')),
        word('s'),
      ),

    // Expressions

    expression: ($) =>
      choice(
        $._name,
        $.scoped_identifier,
        $.system_variable,
        $._decimal,
        $.binary_integer,
        $.hexadecimal_integer,
        $.string,
        $.boolean,
        $.endl,
        $.parenthesized_expression,
        $.braces,
        $.call,
        $.index_expression,
        $.component_expression,
        $.update_expression,
        $.unary_expression,
        $.binary_expression,
        $.assignment,
      ),

    _name: ($) => choice($.identifier, prec(2, alias($._open_instruction, $.identifier))),

    scoped_identifier: ($) =>
      seq(
        field('scope', choice($._name, $.primitive_type, alias($.system_variable, $.system_type))),
        '::',
        field('name', reserved('none', $.identifier)),
      ),

    parenthesized_expression: ($) => seq('(', $.expression, ')'),

    call: ($) =>
      seq(
        field('function', choice($._called, $.scoped_identifier)),
        '(',
        field('arguments', optional($.arguments)),
        ')',
      ),

    // In braces `f(1)` is a call, `i++` a step and `x -5` the component `x`.
    _called: ($) => prec(3, newName($, $.identifier)),

    _stepped: ($) => prec(3, newName($, $.identifier)),

    braces: ($) =>
      seq('{', optional(seq(list(choice($.component, $.expression)), optional(','))), '}'),

    component: ($) =>
      prec(1, seq(field('name', otherName($, $.component_name)), field('value', $.expression))),

    index_expression: ($) =>
      prec(BINDING.access, seq(field('value', $.expression), '[', field('index', $.expression), ']')),

    component_expression: ($) =>
      prec(
        BINDING.access,
        seq(
          field('value', $.expression),
          '.',
          field('component', reserved('none', alias($.identifier, $.component_name))),
        ),
      ),

    update_expression: ($) =>
      choice(
        prec(
          BINDING.access,
          seq(field('operand', choice($._stepped, $.expression)), field('operator', choice('++', '--'))),
        ),
        prec(BINDING.unary, seq(field('operator', choice('++', '--')), field('operand', $.expression))),
      ),

    unary_expression: ($) =>
      prec(BINDING.unary, seq(field('operator', choice('-', '!', '~')), field('operand', $.expression))),

    binary_expression: ($) =>
      choice(
        ...[
          [BINDING.or, ['||']],
          [BINDING.and, ['&&']],
          [BINDING.bitOr, ['|']],
          [BINDING.bitXor, ['^']],
          [BINDING.bitAnd, ['&']],
          [BINDING.equality, ['==', '!=']],
          [BINDING.comparison, ['<', '<=', '>', '>=']],
          [BINDING.shift, ['<<', '>>']],
          [BINDING.sum, ['+', '-']],
          [BINDING.product, ['*', '/', '%']],
        ].map(([binding, operators]) =>
          prec.left(
            binding,
            seq(
              field('left', $.expression),
              field('operator', operators.length > 1 ? choice(...operators) : operators[0]),
              field('right', $.expression),
            ),
          ),
        ),
      ),

    assignment: ($) =>
      prec.right(
        BINDING.assign,
        seq(
          field('left', $.expression),
          field('operator', choice('=', '+=', '-=', '*=', '/=', '%=', '<<=', '>>=', '&=', '|=', '^=')),
          field('right', $.expression),
        ),
      ),

    // Tokens

    system_variable: (_) => /\$[A-Za-z_][A-Za-z0-9_]*/,

    primitive_type: (_) => anyOf(TYPES),

    _reserved_instruction: (_) => anyOf(INSTRUCTIONS),

    _open_instruction: (_) => anyOf(OPEN_INSTRUCTIONS),

    _decimal: ($) => choice($.integer, $.float),

    integer: (_) => /[0-9]+/,

    // The longest form counts: `10b` is 2, `0bh` is 11, `1e5h` is hexadecimal.
    binary_integer: (_) => /[01]+[bB]/,

    hexadecimal_integer: (_) => /[0-9][0-9a-fA-F]*[hH]/,

    float: (_) =>
      token(choice(/[0-9]+\.[0-9]*([eE][+-]?[0-9]+)?/, /\.[0-9]+([eE][+-]?[0-9]+)?/, /[0-9]+[eE][+-]?[0-9]+/)),

    boolean: (_) => choice(word('true'), word('false')),

    endl: (_) => word('endl'),

    string: ($) => seq('"', repeat(choice($.string_content, $.escape_sequence)), token.immediate('"')),

    string_content: (_) => token.immediate(prec(1, /[^"\\\r\n]+/)),

    escape_sequence: (_) => token.immediate(/\\[nrt"\\]/),

    line_comment: (_) => token(/\/\/[^\r\n]*/),

    block_comment: (_) => token(/\/\*([^*]|\*+[^*\/])*\*+\//),

    line_continuation: (_) => token(/\\[ \t\v\f]*(\r\n|\n|\r)/),

    // The last one: a word of the language goes before it.
    identifier: (_) => /[A-Za-z_][A-Za-z0-9_]*/,
  },
});
