//! Habits of other languages, and what is written here instead.

use super::Place;

impl Place<'_, '_> {
    /// Habits of other languages, and what is written here instead.
    pub(super) fn habit(&self) -> Option<&'static str> {
        let previous = self.text_at(-1);
        Some(match self.text {
            ":" if self.expects("`=`") => "a value is assigned with `=`, and its type is inferred",
            "=>" | "==" | "::" | "+=" | "-=" | "*=" | "/=" if self.expects("`=`") => {
                "a value is assigned once, with `=`"
            }
            "=" if self.expects("`,`") => "an argument is named with `:`: `f(octaves: 6)`",
            "{" if self.expects("`->`") => "outputs stand behind `->`: `-> (value: float)`",
            _ if previous == "->" && self.expects("`(`") => "outputs have names: `-> (value: float)`",
            "let" if previous == "{" => "an arm holds one expression: put the `let` before the `if`",
            "for" | "while" if self.expects("an assignment") => {
                "the only loop is `fold (a = start) for i in 0..n { … }`"
            }
            "if" if self.expects("an assignment") => "`if` chooses a value: `x = if c { a } else { b }`",
            "fn" | "func" | "function" | "def" if self.expects("an item") => {
                "a function is a `node`: `node f(x: float) -> (value: float) { value = x }`"
            }
            "import" | "include" | "require" if self.expects("an item") => {
                "a file is imported with `use \"path.tex\"`"
            }
            "const" | "var" if self.expects("an item") => "a constant or a resource is declared with `let`",
            "uniform" if self.expects("an item") => "what a host sets is a `param`",
            "|" | "&" if self.expects("`,`") => "or is written `||`, and `&&`",
            _ => return None,
        })
    }
}
