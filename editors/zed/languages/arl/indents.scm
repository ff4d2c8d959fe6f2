(function_definition
  "endfunc" @end) @indent
(if_statement
  "endif" @end) @indent
(while_statement
  "endwhile" @end) @indent
(repeat_statement
  "until" @end) @indent
(loop_statement
  "endloop" @end) @indent
(for_statement
  "endfor" @end) @indent
(case_clause) @indent
(default_clause) @indent
(elseif_clause
  "elseif" @outdent)
(else_clause
  "else" @outdent)
