; With the names of Helix and Zed.

(function_definition) @function.around

(function_definition
  body: (block) @function.inside)

[
  (line_comment)
  (block_comment)
] @comment.inside

(line_comment)+ @comment.around

(block_comment) @comment.around

(parameters
  ((parameter) @parameter.inside
    .
    ","? @parameter.around) @parameter.around)

(arguments
  ((argument) @parameter.inside
    .
    ","? @parameter.around) @parameter.around)

(braces
  ([
    (component)
    (expression)
  ] @entry.inside
    .
    ","? @entry.around) @entry.around)
