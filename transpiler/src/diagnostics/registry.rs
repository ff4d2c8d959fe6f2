//! The codes: number, severity and title of every kind of diagnostic.

use super::{Code, Severity};

/// What is known of a code without a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CodeInfo {
    /// The number.
    pub code: Code,
    /// Error or warning.
    pub severity: Severity,
    /// A few words, the page's title.
    pub title: &'static str,
}

/// The codes of the compiler proper, ascending; those of the syntax (below 200) come from `arl_lang`.
static CODES: &[CodeInfo] = &[
    error(201, "name of a variable that is not known"),
    error(202, "name of a function that is not known"),
    error(203, "name of a module or enumeration that is not known"),
    error(204, "name of a type that is not known"),
    error(205, "name declared twice in one scope"),
    error(206, "global variable used above its declaration"),
    error(207, "function called above its definition"),
    error(208, "component that the structure does not have"),
    error(209, "name of a system variable that is not known"),
    error(210, "constant that the enumeration does not have"),
    error(211, "name of an instruction that is not known"),
    error(212, "label that the function does not have"),
    error(213, "name that the module does not have"),
    error(214, "spelling of a name that is not accepted"),
    error(301, "value of the wrong type"),
    error(302, "constant that does not fit its type"),
    error(303, "operator on types that it does not work on"),
    error(304, "index on something that is not an array"),
    error(305, "wrong number of indices"),
    error(306, "index that is not an integer"),
    error(307, "component of something that is not a structure"),
    error(308, "braces without a type"),
    error(309, "too many values in braces"),
    error(310, "named and unnamed values mixed in braces"),
    error(311, "component given twice"),
    error(312, "const written"),
    error(313, "something written that is not a variable"),
    error(314, "read-only system variable written"),
    error(315, "structures or arrays compared"),
    error(316, "handle copied"),
    error(317, "value used where there is none"),
    error(318, "array size that is not a positive constant"),
    error(319, "array of more than 10000 elements"),
    error(320, "too many dimensions"),
    error(321, "const without a value"),
    error(322, "variable of type void"),
    error(323, "type of the other robot family"),
    error(324, "integer literal beyond int"),
    error(325, "Rust value of unknown ARL type"),
    error(326, "array where a single value is wanted, or the other way round"),
    error(327, "braces that do not fit the array"),
    error(328, "function result of a type that cannot be returned"),
    error(401, "too many arguments"),
    error(402, "mandatory argument missing"),
    error(403, "label that is not known"),
    error(404, "argument given twice"),
    error(405, "arguments that exclude each other"),
    error(406, "argument that no parameter takes"),
    error(407, "braces without a label"),
    error(408, "value where a variable is written"),
    error(409, "wrong unit"),
    error(410, "unit behind something that is not a number"),
    error(411, "constant argument out of range"),
    error(412, "argument types that the function does not take"),
    error(413, "events behind something that is not a motion"),
    error(414, "argument that needs its label"),
    error(501, "program without main"),
    error(502, "main with parameters or a result"),
    error(503, "function defined twice"),
    error(504, "return without a value"),
    error(505, "return with a value in a void function"),
    error(506, "break outside a loop"),
    error(507, "continue outside a loop"),
    error(508, "case value that stands twice"),
    error(509, "case value that is not constant"),
    error(510, "more than one default"),
    error(511, "switch on a type that cannot be compared"),
    error(512, "condition that waits or moves"),
    error(513, "first motion that is not fully set"),
    error(601, "file not found"),
    error(602, "file that cannot be read"),
    error(603, "file of unknown encoding"),
    error(604, "file name that cannot name a module"),
    error(605, "two modules of one name"),
    error(606, "function in a data file"),
    error(607, "file too large"),
    error(701, "not supported yet"),
    error(702, "not for this kind of robot"),
    error(801, "constant division by zero"),
    error(802, "constant shift out of range"),
    error(803, "constant index out of range"),
    error(804, "constant that depends on itself"),
    warning(851, "constant expression that wraps"),
    warning(852, "division of a double by zero"),
    warning(901, "code that is never reached"),
    warning(902, "variable that is never read"),
    warning(903, "label that is never used"),
    warning(904, "import that is never used"),
    warning(905, "end of a function reached without return"),
    warning(906, "value that is not used"),
    warning(951, "name written in another case than declared"),
    warning(952, "conversion beyond the manual"),
    warning(953, "form beyond the manual"),
];

const fn error(code: u16, title: &'static str) -> CodeInfo {
    CodeInfo { code: Code(code), severity: Severity::Error, title }
}

const fn warning(code: u16, title: &'static str) -> CodeInfo {
    CodeInfo { code: Code(code), severity: Severity::Warning, title }
}

/// All codes in ascending order.
pub fn registry() -> &'static [CodeInfo] {
    CODES
}

/// What is known of this code.
pub fn info(code: Code) -> Option<&'static CodeInfo> {
    let at = CODES.binary_search_by_key(&code, |info| info.code).ok()?;
    CODES.get(at)
}
