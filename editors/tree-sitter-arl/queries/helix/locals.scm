; Scopes, definitions and uses of names. Queries compare names letter by letter, though ARL ignores their case.

[
  (function_definition)
  (for_statement)
  (block)
] @local.scope

(parameter
  name: (identifier) @local.definition.variable.parameter)

(variable
  name: (identifier) @local.definition.variable)

(identifier) @local.reference
