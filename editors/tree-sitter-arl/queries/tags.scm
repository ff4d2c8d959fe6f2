(function_definition
  name: (identifier) @name) @definition.function

(source_file
  (declaration
    (variable
      name: (identifier) @name)) @definition.constant)

(call
  function: (identifier) @name) @reference.call

(call
  function: (scoped_identifier
    name: (identifier) @name)) @reference.call
