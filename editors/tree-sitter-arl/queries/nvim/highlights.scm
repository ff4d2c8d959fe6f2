; Colours, with the names of Neovim.

(identifier) @variable

; Comments

[
  (line_comment)
  (block_comment)
] @comment @spell

; Literals

(string) @string
(escape_sequence) @string.escape
[
  (integer)
  (binary_integer)
  (hexadecimal_integer)
] @number
(float) @number.float
(unit) @number
(boolean) @boolean
(endl) @constant.builtin

; Words

[
  "if"
  "elseif"
  "else"
  "endif"
  "switch"
  "case"
  "default"
  "endswitch"
] @keyword.conditional

[
  "while"
  "endwhile"
  "repeat"
  "until"
  "loop"
  "endloop"
  "for"
  "endfor"
  "break"
  "continue"
] @keyword.repeat

"return" @keyword.return
"goto" @keyword
"import" @keyword.import

[
  "func"
  "endfunc"
] @keyword.function

"const" @keyword.modifier
(instruction_name) @keyword

; Types

(primitive_type) @type.builtin
(type_identifier) @type
(system_type) @type

; Functions

(function_definition
  name: (identifier) @function)

((call
  function: (identifier) @function.builtin)
  (#vim-match? @function.builtin
    "\\c^(abs|accept|acos|asin|assert|atan|atan2|bitcheck|bitclear|bitlcs|bitrcs|bitset|cdate|ceil|channeljoint|channeljointvel|channelpose|channeltcpvel|channeltojoint|channeltopose|cjoint|cjtc|cjtci|cjtcj|cjtq|cjttq|clearbuff|clkread|clkreset|clkstart|clkstop|close|connect|cos|cosh|cpose|ctcpforce|ctime|curmpfile|curmpline|curppfile|curppline|dhread|dnread|dnwrite|exp|filesize|floor|fmod|frexp|ftobytes|getai|getao|getbase_3p|getdi|getdo|geterror|getintdi|getintdo|getip|getjoint|getnostopdi|getpose|gettextstr|gettool_3p|gettoolrot_3p|gettoolrot_world|gettooltcp_ref|getwobj_3p|getwobj_flange|getwobj_indi|hypot|init|ldexp|log|log10|modf|norm|offset|open|p|poseinv|pow|pow10|pulsedo|rand|read|readcoils|readregisters|readuntil|reltool|removefile|renamefile|s|savearl|savefilejoint|savefilepose|savejointnow|saveposenow|savesv|setao|setcycle|setdo|setip|setpwm|sin|sinh|sqrt|stoend|strlen|substr|switchar|switcharl|syncao|syncdo|t|tan|tanh|tcpforce|toascii|tobytes|todouble|tofloat|toint|tostr|trunc|typeof|write|writecoils|writeregisters)$"))

((call
  function: (identifier) @function.call)
  (#not-vim-match? @function.call
    "\\c^(abs|accept|acos|asin|assert|atan|atan2|bitcheck|bitclear|bitlcs|bitrcs|bitset|cdate|ceil|channeljoint|channeljointvel|channelpose|channeltcpvel|channeltojoint|channeltopose|cjoint|cjtc|cjtci|cjtcj|cjtq|cjttq|clearbuff|clkread|clkreset|clkstart|clkstop|close|connect|cos|cosh|cpose|ctcpforce|ctime|curmpfile|curmpline|curppfile|curppline|dhread|dnread|dnwrite|exp|filesize|floor|fmod|frexp|ftobytes|getai|getao|getbase_3p|getdi|getdo|geterror|getintdi|getintdo|getip|getjoint|getnostopdi|getpose|gettextstr|gettool_3p|gettoolrot_3p|gettoolrot_world|gettooltcp_ref|getwobj_3p|getwobj_flange|getwobj_indi|hypot|init|ldexp|log|log10|modf|norm|offset|open|p|poseinv|pow|pow10|pulsedo|rand|read|readcoils|readregisters|readuntil|reltool|removefile|renamefile|s|savearl|savefilejoint|savefilepose|savejointnow|saveposenow|savesv|setao|setcycle|setdo|setip|setpwm|sin|sinh|sqrt|stoend|strlen|substr|switchar|switcharl|syncao|syncdo|t|tan|tanh|tcpforce|toascii|tobytes|todouble|tofloat|toint|tostr|trunc|typeof|write|writecoils|writeregisters)$"))

(call
  function: (scoped_identifier
    scope: (identifier) @module
    name: (identifier) @function.call))

; Names

(parameter
  name: (identifier) @variable.parameter)

(argument_label) @variable.parameter
(component_name) @variable.member
(label_name) @label

(declaration
  "const"
  (variable
    name: (identifier) @constant))

(system_variable) @variable.builtin

((argument
  value: (identifier) @constant.builtin)
  (#vim-match? @constant.builtin
    "\\c^(aut|auto|console|dec|eight|ellipse|even|fast|file|general|hex|hmi|manual|manufast|modify_path|none|o_type|odd|off|one|pi|r1|rot_x|rot_y|rot_z|s_type|simple|t1|t2|t_type|tool|tool_path|triangle|two|v_shape|wobj|world)$"))

(scoped_identifier
  scope: [
    (primitive_type)
    (system_type)
  ]
  name: (identifier) @constant.builtin)

; Operators and signs

(binary_expression
  operator: _ @operator)
(unary_expression
  operator: _ @operator)
(update_expression
  operator: _ @operator)
(assignment
  operator: _ @operator)
(variable
  "=" @operator)

[
  "("
  ")"
  "["
  "]"
  "{"
  "}"
] @punctuation.bracket

[
  ","
  ";"
  ":"
  "::"
  "."
] @punctuation.delimiter

(line_continuation) @punctuation.special
