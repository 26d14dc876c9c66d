//! Syntax errors: what can be wrong with a text, and the sentences that say so.
//!
//! A [`SyntaxErrorKind`] holds the facts; [`SyntaxError::message`], [`label`](SyntaxError::label)
//! and [`help`](SyntaxError::help) turn them into words. Where and how those are drawn is the
//! business of whoever shows them.

use crate::nesting::MAX_NESTING;
use crate::scan::MAX_BYTES;
use crate::syntax::Span;
use std::fmt;

/// Every code of this crate with its title, in order.
pub const SYNTAX_CODES: &[(&str, &str)] = &[
    ("E0001", "file too large"),
    ("E0002", "nesting too deep"),
    ("E0003", "comment not closed"),
    ("E0004", "string not closed"),
    ("E0005", "unknown character"),
    ("E0006", "character outside ASCII"),
    ("E0007", "bad escape in a string"),
    ("E0008", "malformed number"),
    ("E0009", "number too large"),
    ("E0010", "malformed colour"),
    ("E0011", "unexpected token"),
    ("E0012", "unexpected end"),
    ("E0013", "bracket not closed"),
    ("E0014", "bracket not opened"),
    ("E0015", "keyword used as a name"),
    ("E0016", "`if` without `else`"),
    ("E0017", "chained comparison"),
    ("E0018", "lambda outside a call's arguments"),
    ("E0019", "space before a bracket"),
    ("E0020", "not an assignment"),
    ("E0021", "positional argument after a named one"),
    ("E0022", "semicolon"),
    ("E0049", "error in the grammar itself"),
];

/// One thing that is wrong with a text, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// What is wrong.
    pub kind: SyntaxErrorKind,
    /// The offending token; empty only in an empty text.
    pub span: Span,
    /// Another place that matters, with a few words for it.
    pub related: Option<(Span, &'static str)>,
}

/// What can be wrong with a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SyntaxErrorKind {
    /// The text has more than [`MAX_BYTES`] bytes.
    FileTooLarge,
    /// More than [`MAX_NESTING`] levels.
    TooDeep,
    /// `/*` without its `*/`.
    UnclosedComment,
    /// A string without its second `"` on the same line.
    UnclosedText,
    /// An ASCII character that begins no token.
    UnknownCharacter {
        /// The character.
        character: char,
    },
    /// A character outside ASCII that stands in no comment and no string.
    NonAscii {
        /// The character.
        character: char,
    },
    /// A backslash with something behind it that has no meaning.
    BadEscape {
        /// The escape, backslash included.
        escape: String,
    },
    /// Digits with something attached that is no number: `3y`, `1.`, `.5`.
    BadNumber {
        /// As written.
        text: String,
        /// How it may have been meant.
        mend: Option<String>,
    },
    /// A number that its type cannot hold.
    NumberTooLarge {
        /// As written.
        text: String,
    },
    /// `#` without three, six or eight hexadecimal digits.
    BadColor {
        /// As written.
        text: String,
    },
    /// A token that cannot stand where it does.
    Unexpected {
        /// The token as written.
        found: String,
        /// What could stand there, in words.
        expected: Vec<&'static str>,
        /// How to mend it, where the mistake is a frequent one.
        help: Option<&'static str>,
    },
    /// The text ends in the middle of something; the span is the last token.
    UnexpectedEnd {
        /// What could follow, in words.
        expected: Vec<&'static str>,
    },
    /// An opening bracket without its closing one; the span is the opening one.
    Unclosed {
        /// The opening bracket.
        open: char,
        /// The closing bracket.
        close: char,
    },
    /// A closing bracket without its opening one.
    Unopened {
        /// The closing bracket.
        close: char,
    },
    /// A keyword where a name has to stand.
    KeywordAsName {
        /// The keyword.
        keyword: String,
    },
    /// `if` without `else`; the span is the `if`.
    MissingElse,
    /// `a < b < c`; the span is the second operator.
    ChainedComparison,
    /// A lambda that is no argument of a call.
    StrayLambda,
    /// `f (x)` or `v [i]`.
    SpaceBeforeBracket {
        /// The name before the space.
        name: String,
        /// The bracket behind it.
        bracket: char,
    },
    /// A statement that assigns nothing.
    NotAnAssignment {
        /// What stands there instead.
        found: Statement,
    },
    /// `f(a: 1, 2)`; the span is the positional argument.
    PositionalAfterNamed {
        /// The last named argument before it.
        named: String,
    },
    /// A `;`.
    Semicolon {
        /// Whether it stands between arguments, inputs or elements.
        in_brackets: bool,
    },
    /// pest accepted what the tree cannot hold: a bug of this crate.
    Grammar {
        /// What was missing.
        missing: &'static str,
    },
}

/// What stands where an assignment should.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statement {
    /// `return x`
    Return,
    /// `color.r = x`
    Component,
    /// An expression.
    Expression,
}

impl SyntaxError {
    pub(crate) fn new(kind: SyntaxErrorKind, span: Span) -> SyntaxError {
        SyntaxError { kind, span, related: None }
    }

    /// With another place that matters, if there is one.
    pub(crate) fn related(mut self, place: Option<Span>, label: &'static str) -> SyntaxError {
        self.related = place.map(|span| (span, label)).or(self.related);
        self
    }

    /// The code that `texgraph explain` knows.
    pub fn code(&self) -> &'static str {
        use SyntaxErrorKind as Kind;
        match &self.kind {
            Kind::FileTooLarge => "E0001",
            Kind::TooDeep => "E0002",
            Kind::UnclosedComment => "E0003",
            Kind::UnclosedText => "E0004",
            Kind::UnknownCharacter { .. } => "E0005",
            Kind::NonAscii { .. } => "E0006",
            Kind::BadEscape { .. } => "E0007",
            Kind::BadNumber { .. } => "E0008",
            Kind::NumberTooLarge { .. } => "E0009",
            Kind::BadColor { .. } => "E0010",
            Kind::Unexpected { .. } => "E0011",
            Kind::UnexpectedEnd { .. } => "E0012",
            Kind::Unclosed { .. } => "E0013",
            Kind::Unopened { .. } => "E0014",
            Kind::KeywordAsName { .. } => "E0015",
            Kind::MissingElse => "E0016",
            Kind::ChainedComparison => "E0017",
            Kind::StrayLambda => "E0018",
            Kind::SpaceBeforeBracket { .. } => "E0019",
            Kind::NotAnAssignment { .. } => "E0020",
            Kind::PositionalAfterNamed { .. } => "E0021",
            Kind::Semicolon { .. } => "E0022",
            Kind::Grammar { .. } => "E0049",
        }
    }

    /// One line of what is wrong.
    pub fn message(&self) -> String {
        use SyntaxErrorKind as Kind;
        match &self.kind {
            Kind::FileTooLarge => format!("this file has more than {} MiB", MAX_BYTES >> 20),
            Kind::TooDeep => format!("this is nested more than {MAX_NESTING} levels deep"),
            Kind::UnclosedComment => "this comment is never closed".into(),
            Kind::UnclosedText => "this string is not closed on its line".into(),
            Kind::UnknownCharacter { character } => format!("`{character}` has no meaning here"),
            Kind::NonAscii { character } => {
                format!("`{}` stands outside comments and strings", character.escape_debug())
            }
            Kind::BadEscape { escape } => format!("`{}` is no escape", shorten(escape)),
            Kind::BadNumber { text, .. } => format!("`{}` is no number", shorten(text)),
            Kind::NumberTooLarge { text } => format!("`{}` is too large", shorten(text)),
            Kind::BadColor { text } => format!("`{}` is no colour", shorten(text)),
            Kind::Unexpected { found, expected, .. } if expected.is_empty() => {
                format!("unexpected {}", shorten(found))
            }
            Kind::Unexpected { found, expected, .. } => {
                format!("expected {}, found {}", either(expected), shorten(found))
            }
            Kind::UnexpectedEnd { expected } if expected.is_empty() => "the text ends too early".into(),
            Kind::UnexpectedEnd { expected } => {
                format!("expected {}, but the text ends", either(expected))
            }
            Kind::Unclosed { open, .. } => format!("this `{open}` is never closed"),
            Kind::Unopened { close } => format!("this `{close}` closes nothing"),
            Kind::KeywordAsName { keyword } => {
                format!("`{keyword}` is a keyword and cannot be a name")
            }
            Kind::MissingElse => "this `if` has no `else`".into(),
            Kind::ChainedComparison => "comparisons do not chain".into(),
            Kind::StrayLambda => "a lambda stands only as an argument of a call".into(),
            Kind::SpaceBeforeBracket { name, bracket } => {
                format!("there is a space between `{}` and its `{bracket}`", shorten(name))
            }
            Kind::NotAnAssignment { found: Statement::Return } => "there is no `return`".into(),
            Kind::NotAnAssignment { found: Statement::Component } => {
                "a component can't be assigned on its own".into()
            }
            Kind::NotAnAssignment { .. } => "this statement assigns nothing".into(),
            Kind::PositionalAfterNamed { named } => {
                format!("an argument without a name follows the named argument `{named}`")
            }
            Kind::Semicolon { .. } => "there are no semicolons".into(),
            Kind::Grammar { missing } => {
                format!("this is a bug in texgraph's grammar: {missing} is missing")
            }
        }
    }

    /// A few words for the underlined place.
    pub fn label(&self) -> String {
        use SyntaxErrorKind as Kind;
        match &self.kind {
            Kind::FileTooLarge => "from here on".into(),
            Kind::TooDeep => "one level too many".into(),
            Kind::UnclosedComment | Kind::UnclosedText => "opened here".into(),
            Kind::Unclosed { close, .. } => format!("its `{close}` is missing"),
            Kind::Unopened { .. } => "nothing is open here".into(),
            Kind::UnknownCharacter { .. } | Kind::NonAscii { .. } => "not part of any token".into(),
            Kind::BadEscape { .. } => "unknown escape".into(),
            Kind::BadNumber { .. } => "malformed number".into(),
            Kind::NumberTooLarge { .. } => "out of range".into(),
            Kind::BadColor { .. } => "malformed colour".into(),
            Kind::Unexpected { expected, .. } if expected.is_empty() => "unexpected".into(),
            Kind::Unexpected { expected, .. } => format!("expected {}", either(expected)),
            Kind::UnexpectedEnd { .. } => "the text ends after this".into(),
            Kind::KeywordAsName { .. } => "a keyword".into(),
            Kind::MissingElse => "needs an `else`".into(),
            Kind::ChainedComparison => "a second comparison".into(),
            Kind::StrayLambda => "not an argument".into(),
            Kind::SpaceBeforeBracket { .. } => "must touch the name".into(),
            Kind::NotAnAssignment { .. } => "not an assignment".into(),
            Kind::PositionalAfterNamed { .. } => "has no name".into(),
            Kind::Semicolon { in_brackets: true } => "a `,` stands here".into(),
            Kind::Semicolon { .. } => "remove this".into(),
            Kind::Grammar { .. } => "please report this text".into(),
        }
    }

    /// A likely mend, or the reason for the rule.
    pub fn help(&self) -> Option<String> {
        use SyntaxErrorKind as Kind;
        let help: &str = match &self.kind {
            Kind::FileTooLarge => "split the file and join the parts with `use`",
            Kind::TooDeep => "give inner parts names with `let`",
            Kind::UnclosedComment => "block comments nest: every `/*` needs its own `*/`",
            Kind::UnclosedText => "close it with `\"`; a line break is written `\\n`",
            Kind::UnknownCharacter { character } => return character_help(*character),
            Kind::NonAscii { .. } => "names use the letters A to Z, digits and `_`",
            Kind::BadEscape { .. } => "the escapes are `\\\"`, `\\\\`, `\\n`, `\\t` and `\\u{…}`",
            Kind::BadNumber { mend: Some(mend), .. } => return Some(format!("write `{mend}`")),
            Kind::BadNumber { .. } => "numbers are `3`, `3.0` and `1e-3`; angles are `90deg` and `0.25turn`",
            Kind::BadColor { .. } => "colours are `#rgb`, `#rrggbb` and `#rrggbbaa`",
            Kind::Unexpected { help, .. } => return help.map(str::to_string),
            Kind::KeywordAsName { keyword } => return Some(format!("try `{keyword}_`")),
            Kind::MissingElse => "`if` chooses between two values: write `if c { a } else { b }`",
            Kind::ChainedComparison => "join two comparisons: `a < b && b < c`",
            Kind::StrayLambda => "declare a `node` and use its name, or pass the lambda directly",
            Kind::SpaceBeforeBracket { name, bracket } => {
                return Some(format!("write `{name}{bracket}`"));
            }
            Kind::NotAnAssignment { found: Statement::Return } => "assign to an output: `color = …`",
            Kind::NotAnAssignment { found: Statement::Component } => {
                "a value is assigned whole: `color = vec4(rgb, a)`"
            }
            Kind::NotAnAssignment { .. } => "a body holds only `let name = …` and `output = …`",
            Kind::PositionalAfterNamed { .. } => "arguments go by position first, then by name",
            Kind::Semicolon { in_brackets: true } => "what stands in brackets is separated by `,`",
            Kind::Semicolon { .. } => "statements need no `;`: remove it",
            Kind::UnexpectedEnd { expected } if expected.contains(&"`..`") => RANGE,
            Kind::NumberTooLarge { .. }
            | Kind::UnexpectedEnd { .. }
            | Kind::Unclosed { .. }
            | Kind::Unopened { .. }
            | Kind::Grammar { .. } => return None,
        };
        Some(help.to_string())
    }
}

impl fmt::Display for SyntaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.code(), self.message())
    }
}

impl std::error::Error for SyntaxError {}

/// How a range is written.
pub(crate) const RANGE: &str = "a range is `0.0..1.0`, or `0..=8` with its end";

/// What the habits of other languages mean here.
fn character_help(character: char) -> Option<String> {
    let help = match character {
        '&' => "and is written `&&`",
        '\'' => "strings stand between double quotes",
        '?' => "a choice is written `if c { a } else { b }`",
        '^' => "a power is written `x.pow(y)`",
        _ => return None,
    };
    Some(help.to_string())
}

/// `a`, `a or b`, `a, b or c`.
fn either(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [one] => one.to_string(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// The beginning of what may be thousands of characters.
fn shorten(text: &str) -> String {
    match text.char_indices().nth(24) {
        Some((cut, _)) => format!("{}…", &text[..cut]),
        None => text.to_string(),
    }
}
