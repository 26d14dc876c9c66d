//! Habits of other languages, and what is written here instead.

use super::{Guess, Place};
use crate::error::RANGE;
use crate::recover::{is_first_of_line, is_in_column_0};
use crate::scan::TokenKind;

/// Types as other languages write them before a name.
const TYPES: [&str; 16] = [
    "auto", "bool", "color", "double", "float", "half", "int", "ivec2", "ivec3", "ivec4", "mat2", "mat3",
    "uint", "vec2", "vec3", "vec4",
];

impl Place<'_, '_> {
    /// `#define`, `#include`
    pub(super) fn preprocessor(&self) -> Guess {
        let help = match self.text {
            "#define" => "a constant is declared with `let`, and a function is a `node`",
            "#include" | "#import" => "a file is imported with `use \"path.tex\"`",
            "#if" | "#ifdef" | "#ifndef" | "#else" | "#elif" | "#endif" => {
                "an `if` on a constant looks at one arm only"
            }
            "#version" | "#extension" | "#pragma" => "leave this line out",
            _ => return None,
        };
        Some(self.found(self.expected.to_vec(), Some(help)))
    }

    /// `not a`, `not (a)`
    pub(super) fn not_in_words(&self) -> Guess {
        let place = Place::new(self.scan, self.tokens.clone(), self.index.checked_sub(1)?, self.expected);
        let is_operand = self.is_name(0) || self.text == "(";
        let is_not = place.text == "not" && is_operand && !is_first_of_line(self.scan, self.index);
        is_not.then(|| place.found(vec!["an expression"], Some("not is written `!`")))
    }

    /// `texture(image, uv)`
    pub(super) fn is_called_texture(&self) -> bool {
        self.text == "texture" && self.text_at(1) == "("
    }

    /// Habits of other languages, and what is written here instead.
    pub(super) fn habit(&self) -> Option<&'static str> {
        let previous = self.text_at(-1);
        Some(match self.text {
            _ if self.is_called_texture() && self.expects("an expression") => {
                "an image is read with `image.sample(uv)`"
            }
            ":" if self.expects("`=`") => "a value is assigned with `=`, and its type is inferred",
            "=>" | "==" | "::" | "+=" | "-=" | "*=" | "/=" if self.expects("`=`") => {
                "a value is assigned once, with `=`"
            }
            "++" | "--" => "nothing is counted up: in a fold the next value is assigned, `n = n + 1`",
            "=" if self.expects("`,`") => "an argument is named with `:`: `f(octaves: 6)`",
            "{" | "=>" | ":" if self.expects("`->`") => "outputs stand behind `->`: `-> (value: float)`",
            _ if self.expects("`..`") => RANGE,
            _ if self.expects("a string") && previous == "use" => {
                "a path stands between quotes: `use \"path.tex\"`"
            }
            _ if previous == "as" && self.token.kind == TokenKind::Text => {
                "the name of an import stands without quotes: `use \"path.tex\" as name`"
            }
            _ if previous == ")" && TYPES.contains(&self.text_at(-2)) && self.text_at(-3) == "(" => {
                "a value is converted by a call: `int(x)`"
            }
            _ if previous == "->" && self.expects("`(`") => "outputs have names: `-> (value: float)`",
            "let" if previous == "{" => "an arm holds one expression: put the `let` before the `if`",
            "for" | "while" if self.expects("an assignment") => {
                "the only loop is `fold (a = start) for i in 0..n { … }`"
            }
            "if" if self.expects("an assignment") => "`if` chooses a value: `x = if c { a } else { b }`",
            "and" => "and is written `&&`",
            "or" => "or is written `||`",
            "|" | "&" if self.expects("`,`") => "or is written `||`, and `&&`",
            _ if self.expects("`=`") && self.is_name(0) && TYPES.contains(&previous) => {
                "a wire begins with `let`, and its type is inferred: `let x = …`"
            }
            _ => return self.item_habit(),
        })
    }

    /// The same for what stands where an item should.
    fn item_habit(&self) -> Option<&'static str> {
        if !self.expects("an item") {
            return None;
        }
        let begins_line =
            is_first_of_line(self.scan, self.index) && is_in_column_0(self.scan.source, self.token);
        Some(match self.text {
            "fn" | "func" | "function" | "def" | "void" => {
                "a function is a `node`: `node f(x: float) -> (value: float) { value = x }`"
            }
            "import" | "include" | "require" => "a file is imported with `use \"path.tex\"`",
            "const" | "var" => "a constant or a resource is declared with `let`",
            "uniform" => "what a host sets is a `param`",
            "struct" | "enum" | "class" | "type" => {
                "nobody declares types: a node with several outputs gives a record"
            }
            "with"
                if self.token.kind == TokenKind::Word
                    && self.at(-1).is_some_and(|t| t.kind == TokenKind::Text) =>
            {
                "an import is named with `as`: `use \"path.tex\" as name`"
            }
            "material" | "shader" => "an entry point is a `texture`",
            text if TYPES.contains(&text) && self.text_at(2) == "(" => {
                "a function is a `node`: `node f(x: float) -> (value: float) { value = x }`"
            }
            text if TYPES.contains(&text) => "a constant or a resource is declared with `let`",
            _ if begins_line && self.token.kind == TokenKind::Word && self.text_at(1) == "=" => {
                "a constant or a resource is declared with `let`"
            }
            _ => return None,
        })
    }
}
