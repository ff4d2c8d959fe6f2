//! The codes: number, severity and title of every kind of diagnostic.

use super::{Code, Severity};
use arl_lang::syntax_error::TITLES;
use std::sync::LazyLock;

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

/// The codes of the syntax (below 200), then those of the compiler proper.
static ALL: LazyLock<Vec<CodeInfo>> =
    LazyLock::new(|| TITLES.iter().map(|(code, title)| error(*code, title)).chain(CODES.iter().copied()).collect());

/// The codes of the compiler proper, ascending. A number that was given once is never given again.
static CODES: &[CodeInfo] = &[
    error(201, "A variable that is not known"),
    error(202, "A function that is not known"),
    error(203, "A module or enumeration that is not known"),
    error(204, "A type that is not known"),
    error(205, "A name declared twice in one scope"),
    error(206, "A global variable used above its declaration"),
    error(207, "A function called above its definition"),
    error(208, "A component that the structure does not have"),
    error(209, "A system variable that is not known"),
    error(210, "A constant that the enumeration does not have"),
    error(211, "An instruction that is not known"),
    error(212, "A label that the function does not have"),
    error(213, "A name that the module does not have"),
    error(214, "An old or misprinted name"),
    error(301, "A value of the wrong type"),
    error(302, "A constant that does not fit its type"),
    error(303, "An operator on types that it does not work on"),
    error(304, "An index on something that is not an array"),
    error(305, "The wrong number of indices"),
    error(306, "An index that is not an integer"),
    error(307, "A component of something that is not a structure"),
    error(308, "Braces without a type"),
    error(309, "Too many values in braces"),
    error(310, "Named and unnamed values mixed in braces"),
    error(311, "A component given twice"),
    error(312, "A const that is written"),
    error(313, "Something written that is not a variable"),
    error(314, "A read-only system variable that is written"),
    error(315, "Structures or arrays compared"),
    error(316, "A handle that is copied"),
    error(317, "A value taken from something that has none"),
    error(318, "An array size that is not a positive constant"),
    error(319, "An array of more than 10000 elements"),
    error(320, "An array of too many dimensions"),
    error(321, "A const without a value"),
    error(322, "A variable of type void"),
    error(323, "A type of the other kind of robot"),
    error(324, "A whole number beyond int"),
    error(325, "A Rust value of unknown ARL type"),
    error(326, "An array and a value of another size"),
    error(327, "Braces that do not fit the array"),
    error(328, "A result of a type that cannot be returned"),
    error(401, "Too many arguments"),
    error(402, "A mandatory argument is missing"),
    error(403, "A label that is not known"),
    error(404, "An argument given twice"),
    error(405, "Arguments that exclude each other"),
    error(406, "An argument that no parameter takes"),
    error(407, "Braces without a label"),
    error(408, "A value where a variable is written"),
    error(409, "A wrong unit"),
    error(410, "A unit behind something that is not a number"),
    error(411, "A constant argument out of range"),
    error(412, "Argument types that the function does not take"),
    error(413, "Events behind something that is not a motion"),
    error(414, "A length that an array does not have"),
    error(415, "A system variable that cannot be saved"),
    error(501, "A program without main"),
    error(502, "A main with parameters or a result"),
    error(503, "A function defined twice"),
    error(504, "A return without a value"),
    error(505, "A return with a value in a void function"),
    error(506, "A break outside of loops"),
    error(507, "A continue outside of loops"),
    error(508, "A case value that stands twice"),
    error(509, "A case value that is not constant"),
    error(511, "A switch on a type that it cannot compare"),
    error(512, "A condition that waits or moves"),
    error(513, "A first motion that is not fully set"),
    error(601, "A file that is not there"),
    error(602, "A file that cannot be read"),
    error(603, "A file of unknown encoding"),
    error(604, "A file name that cannot name a module"),
    error(605, "Two modules of one name"),
    error(606, "A function in a data file"),
    error(702, "Something for the other kind of robot"),
    error(703, "Something that arl2rs cannot make sense of"),
    error(704, "Something that needs a robot, in the background"),
    error(801, "A constant division by zero"),
    error(802, "A constant shift out of range"),
    error(803, "A constant index out of range"),
    error(804, "A constant that depends on itself"),
    error(805, "A channel that the cell does not have"),
    error(806, "An analog value that its channel does not carry"),
    error(807, "An argument that a connection cannot have"),
    error(808, "Registers or bytes that a bus does not have"),
    error(809, "A serial line without a device"),
    warning(851, "A constant expression that wraps"),
    warning(852, "A double divided by zero"),
    warning(853, "Registers that no PLC reaches"),
    warning(901, "Statements that are never reached"),
    warning(902, "A variable that is never read"),
    warning(903, "A label that is never used"),
    warning(904, "An import that is never used"),
    warning(905, "The end of a function reached without return"),
    warning(906, "A value that is not used"),
    warning(907, "A target beyond the range of an axis"),
    warning(908, "A pose that the robot cannot reach"),
    warning(909, "A configuration that does not reach its pose"),
    warning(910, "A line that passes a singular point"),
    warning(911, "A component out of its range"),
    warning(912, "A value that a system variable does not take"),
    warning(951, "A name in another case than declared"),
    warning(952, "A conversion beyond the manual"),
    warning(953, "A form beyond the manual"),
];

const fn error(code: u16, title: &'static str) -> CodeInfo {
    CodeInfo { code: Code(code), severity: Severity::Error, title }
}

const fn warning(code: u16, title: &'static str) -> CodeInfo {
    CodeInfo { code: Code(code), severity: Severity::Warning, title }
}

/// All codes in ascending order.
pub fn registry() -> &'static [CodeInfo] {
    &ALL
}

/// What is known of this code.
pub fn info(code: Code) -> Option<&'static CodeInfo> {
    let at = ALL.binary_search_by_key(&code, |info| info.code).ok()?;
    ALL.get(at)
}
