//! Components of structures.

use super::Problem;
use super::declare::problems;
use arl_lang::catalog::Component;

problems! {
    warning 911 "A component out of its range" =>
    /// A constant that makes no sense in a component.
    pub(crate) struct ComponentRange {
        /// The structure's name.
        pub(crate) structure: &'static str,
        /// The component, which has a range.
        pub(crate) component: &'static Component,
        /// The constant as written.
        pub(crate) value: String,
    }
}

impl Problem for ComponentRange {
    fn message(&self) -> String {
        let Self { structure, component, value } = self;
        let range = component.range.map_or_else(|| "another number".to_owned(), |range| range.to_string());
        format!("`{}` of this `{structure}` is {value}, but should be {range}", component.name)
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        Some(format!("`{}` is: {}", self.component.name, self.component.doc))
    }
}
