//! ARL, the robot language of the AE, Peitian and Ligent controllers, for [tree-sitter].
//!
//! ```
//! let mut parser = tree_sitter::Parser::new();
//! parser.set_language(&tree_sitter_arl::LANGUAGE.into()).unwrap();
//! let tree = parser.parse("movej home, vp:20%\n", None).unwrap();
//! assert!(!tree.root_node().has_error());
//! ```
//!
//! [tree-sitter]: https://tree-sitter.github.io

use tree_sitter_language::LanguageFn;

unsafe extern "C" {
    fn tree_sitter_arl() -> *const ();
}

/// The language.
// SAFETY: the function is that of the generated parser.
pub const LANGUAGE: LanguageFn = unsafe { LanguageFn::from_raw(tree_sitter_arl) };

/// The kinds of nodes with their fields, as JSON.
pub const NODE_TYPES: &str = include_str!("../../src/node-types.json");

/// What has which colour.
pub const HIGHLIGHTS_QUERY: &str = include_str!("../../queries/highlights.scm");

/// Scopes, definitions and uses of local names.
pub const LOCALS_QUERY: &str = include_str!("../../queries/locals.scm");

/// Functions and calls, for lists of symbols.
pub const TAGS_QUERY: &str = include_str!("../../queries/tags.scm");
