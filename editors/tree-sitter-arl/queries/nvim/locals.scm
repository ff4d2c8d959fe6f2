; Scopes, definitions and uses of names. Queries compare names letter by letter, though ARL ignores their case.

[
  (source_file)
  (function_definition)
  (for_statement)
  (block)
] @local.scope

((function_definition
  name: (identifier) @local.definition.function)
  (#set! definition.function.scope "parent"))

(parameter
  name: (identifier) @local.definition.parameter)

(variable
  name: (identifier) @local.definition.var)

(identifier) @local.reference
