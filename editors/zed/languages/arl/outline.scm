(function_definition
  "func" @context
  result: (_) @context
  name: (identifier) @name
  parameters: (parameters)? @context) @item

(source_file
  (declaration
    "const"? @context
    type: (_) @context
    (variable
      name: (identifier) @name) @item))

(label
  name: (label_name) @name) @item
