[
  (function_definition)
  (if_statement)
  (while_statement)
  (repeat_statement)
  (loop_statement)
  (for_statement)
  (case_clause)
  (default_clause)
] @indent

; A line that goes on behind a `\`.
[
  (declaration)
  (expression_statement)
  (instruction)
  (return_statement)
  (compact_if_statement)
] @indent

[
  "elseif"
  "else"
  "endif"
  "endwhile"
  "until"
  "endloop"
  "endfor"
  "endfunc"
] @outdent
