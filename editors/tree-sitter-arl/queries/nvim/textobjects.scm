(function_definition) @function.outer

(function_definition
  body: (block) @function.inner)

(block) @block.inner

[
  (if_statement)
  (compact_if_statement)
  (switch_statement)
] @conditional.outer

(if_statement
  body: (block) @conditional.inner)
(elseif_clause
  body: (block) @conditional.inner)
(else_clause
  body: (block) @conditional.inner)
(compact_if_statement
  consequence: (_) @conditional.inner)

[
  (while_statement)
  (repeat_statement)
  (loop_statement)
  (for_statement)
] @loop.outer

(while_statement
  body: (block) @loop.inner)
(repeat_statement
  body: (block) @loop.inner)
(loop_statement
  body: (block) @loop.inner)
(for_statement
  body: (block) @loop.inner)

(call) @call.outer
(call
  arguments: (arguments) @call.inner)

(instruction) @statement.outer
(expression_statement) @statement.outer
(declaration) @statement.outer

(assignment
  left: (_) @assignment.lhs
  right: (_) @assignment.rhs) @assignment.outer

(parameters
  (parameter) @parameter.inner @parameter.outer)
(arguments
  (argument) @parameter.inner @parameter.outer)

[
  (line_comment)
  (block_comment)
] @comment.outer
