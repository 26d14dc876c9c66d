//! The syntax tree: what the text says, before anything is known about names or types.
//!
//! Every node carries the [`Span`] of the text it was read from. Chains (operators, postfixes,
//! prefixes, `else if`) are flat lists, so the tree is never deeper than the brackets of the text,
//! and those are bounded (see [`crate::MAX_NESTING`]).

use smol_str::SmolStr;

/// A half-open range of byte offsets in one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Span {
    /// Offset of the first byte.
    pub start: u32,
    /// Offset behind the last byte.
    pub end: u32,
}

impl Span {
    /// The bytes `start..end`.
    pub fn new(start: usize, end: usize) -> Span {
        Span { start: start as u32, end: end as u32 }
    }

    /// The smallest span that covers both.
    pub fn to(self, other: Span) -> Span {
        Span { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// As a range of indices, to slice the source with.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// A name where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The name itself.
    pub text: SmolStr,
    /// Where it stands.
    pub span: Span,
}

/// A string literal, escapes resolved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// The value, escapes resolved.
    pub value: String,
    /// Where it stands, quotes included.
    pub span: Span,
}

/// A whole file.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct File {
    /// The `//!` lines, without the marks, joined by line breaks.
    pub doc: String,
    /// The items, in source order.
    pub items: Vec<Item>,
    /// Every comment, doc comments included, in source order: what the formatter must keep.
    pub comments: Vec<Comment>,
}

/// A comment, marks included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Comment {
    /// Where it stands; a line comment's line break is not part of it.
    pub span: Span,
    /// Line (`//`), documentation (`///`, `//!`) or block.
    pub kind: CommentKind,
}

/// The kinds of comments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommentKind {
    /// `// …`
    Line,
    /// `/// …`
    Doc,
    /// `//! …`
    FileDoc,
    /// `/* … */`, nested ones inside it included.
    Block,
}

/// One item with its documentation.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// The `///` lines right above, without the marks, joined by line breaks.
    pub doc: String,
    /// From the keyword to the end.
    pub span: Span,
    /// What it declares.
    pub kind: ItemKind,
}

/// What an item declares.
#[derive(Clone, Debug, PartialEq)]
pub enum ItemKind {
    /// `use "path" as alias`
    Use {
        /// The path as written, relative to this file.
        path: Text,
        /// `as alias`
        alias: Option<Name>,
    },
    /// `let name = value`: a constant or a resource.
    Let {
        /// Its name.
        name: Name,
        /// Its value.
        value: Expr,
    },
    /// `param name: type = default in lo..=hi`
    Param {
        /// Its name.
        name: Name,
        /// Its type.
        ty: Type,
        /// The value before a host sets one.
        default: Expr,
        /// The values it is clamped to.
        range: Option<Range>,
    },
    /// `node …`
    Node(Node),
    /// `texture …`
    Texture {
        /// Everything a texture shares with a node; `dims` is empty.
        node: Node,
        /// `tiles period`
        tiles: Option<Expr>,
    },
}

/// The common part of nodes and textures.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Its name.
    pub name: Name,
    /// `<n, m>`: the dimension variables.
    pub dims: Vec<Name>,
    /// What it takes.
    pub inputs: Vec<Input>,
    /// What it gives, in order.
    pub outputs: Vec<Field>,
    /// How.
    pub body: Body,
}

/// An input of a node, of a texture or of an intrinsic.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub ty: Type,
    /// What it is when no argument is given; may read earlier inputs.
    pub default: Option<Expr>,
}

/// A name with a type: an output, or a field of a record type.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub ty: Type,
}

/// A type as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Type {
    /// Where it stands.
    pub span: Span,
    /// Which type.
    pub kind: TypeKind,
}

/// The forms of types.
#[derive(Clone, Debug, PartialEq)]
pub enum TypeKind {
    /// `float`, `vec<n>`, `patterns<3>`.
    Named {
        /// The name.
        name: Name,
        /// What stands between `<` and `>`.
        dim: Option<Dim>,
    },
    /// `clamp | wrap | clear`: one of these bare words. Always two or more.
    Choice(Vec<Name>),
    /// `node(a: T, …) -> U`
    Node {
        /// What the node takes; no defaults.
        inputs: Vec<Field>,
        /// What it gives.
        output: Box<Type>,
    },
    /// `(distance: float, random: float)`: only inside a node type.
    Record(Vec<Field>),
}

/// What stands between `<` and `>`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dim {
    /// A dimension variable.
    Name(Name),
    /// A number.
    Number(u32, Span),
}

/// `start..end` or `start..=end`.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Where it begins.
    pub start: Box<Expr>,
    /// Where it ends.
    pub end: Box<Expr>,
    /// Whether the end belongs to it (`..=`).
    pub inclusive: bool,
    /// From start to end.
    pub span: Span,
}

/// A list of statements between braces. Order has no meaning.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Body {
    /// In source order.
    pub statements: Vec<Statement>,
    /// The braces included.
    pub span: Span,
}

/// One assignment.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// `let pattern = value`
    Let {
        /// From `let` to the end.
        span: Span,
        /// The names it binds.
        pattern: Pattern,
        /// The value.
        value: Expr,
    },
    /// `output = value`, or the next value of an accumulator.
    Assign {
        /// The output or accumulator.
        name: Name,
        /// The value.
        value: Expr,
    },
}

/// What a `let` binds.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    /// `name`
    Name(Name),
    /// `(a, b)`: the outputs of a record in order. One name or more.
    Record(Vec<Name>, Span),
}

/// An expression with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// Where it stands.
    pub span: Span,
    /// Which expression.
    pub kind: ExprKind,
}

/// The forms of expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `3`; `None` when it does not fit 64 bits.
    Int(Option<u64>),
    /// `3.0`, `1e-3`, and angles in radians.
    Float(f64),
    /// `true`, `false`
    Bool(bool),
    /// `"…"`
    Text(String),
    /// `#rgb`, `#rrggbb`, `#rrggbbaa`: red, green, blue, alpha as written (sRGB-encoded, straight).
    Color([u8; 4]),
    /// A name on its own.
    Name(SmolStr),
    /// `(inner)`: kept for the formatter.
    Paren(Box<Expr>),
    /// `name<n>(arguments)`
    Call(Box<Call>),
    /// `base.field.method(…)[i]`: at least one link.
    Postfix {
        /// What the links apply to.
        base: Box<Expr>,
        /// In source order.
        links: Vec<Postfix>,
    },
    /// `-!-x`: operators in source order, the last applies first. At least one.
    Unary {
        /// In source order.
        operators: Vec<(UnaryOperator, Span)>,
        /// What they apply to.
        operand: Box<Expr>,
    },
    /// `first op a op b …`: operators of one precedence, applied from the left. At least one link.
    Chain {
        /// The leftmost operand.
        first: Box<Expr>,
        /// In source order.
        links: Vec<ChainLink>,
    },
    /// `if c { a } else if d { b } else { e }`
    If {
        /// Conditions with their arms, in source order. At least one.
        arms: Vec<(Expr, Expr)>,
        /// The last arm.
        otherwise: Box<Expr>,
    },
    /// `[a, b, c]`
    List(Vec<Expr>),
    /// `|a, b| body`: only as an argument.
    Lambda {
        /// The names of its inputs; may be empty.
        inputs: Vec<Name>,
        /// Its value.
        body: Box<Expr>,
    },
    /// `fold (…) for i in range { … }`
    Fold(Box<Fold>),
}

/// `name<n>(arguments)`
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// What is called.
    pub name: Name,
    /// `<n>`, when written.
    pub dim: Option<Dim>,
    /// By position first, then by name.
    pub arguments: Vec<Argument>,
}

/// `value` or `name: value`
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// The input's name, when given.
    pub name: Option<Name>,
    /// The value.
    pub value: Expr,
}

/// One link behind an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum Postfix {
    /// `.name`: a field, an output, an import's item or a swizzle.
    Field(Name),
    /// `.name(…)`, and the span from the name to the closing bracket.
    Method(Call, Span),
    /// `[index]`, and the span of the brackets.
    Index(Box<Expr>, Span),
}

/// Prefix operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOperator {
    /// `-`
    Negate,
    /// `!`
    Not,
}

/// One operator and what stands right of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainLink {
    /// The operator.
    pub operator: BinaryOperator,
    /// Where the operator stands.
    pub operator_span: Span,
    /// Its right operand.
    pub operand: Expr,
}

/// Binary operators, from tight to loose: `* / %`, `+ -`, comparisons, `&&`, `||`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "the names say it")]
pub enum BinaryOperator {
    Multiply,
    Divide,
    Remainder,
    Add,
    Subtract,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
}

impl BinaryOperator {
    /// As written.
    pub fn symbol(self) -> &'static str {
        use BinaryOperator::*;
        match self {
            Multiply => "*",
            Divide => "/",
            Remainder => "%",
            Add => "+",
            Subtract => "-",
            Less => "<",
            LessEqual => "<=",
            Greater => ">",
            GreaterEqual => ">=",
            Equal => "==",
            NotEqual => "!=",
            And => "&&",
            Or => "||",
        }
    }

    /// How tightly it binds: 5 (`*`) to 1 (`||`).
    pub fn precedence(self) -> u8 {
        use BinaryOperator::*;
        match self {
            Multiply | Divide | Remainder => 5,
            Add | Subtract => 4,
            Less | LessEqual | Greater | GreaterEqual | Equal | NotEqual => 3,
            And => 2,
            Or => 1,
        }
    }
}

/// `fold (a = start, …) for i in lo..hi max n while condition { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Fold {
    /// The accumulators with their starts. At least one.
    pub accumulators: Vec<(Name, Expr)>,
    /// The name of the step.
    pub variable: Name,
    /// What it runs over.
    pub range: Range,
    /// `max n`
    pub max: Option<Expr>,
    /// `while condition`
    pub condition: Option<Expr>,
    /// The next values.
    pub body: Body,
}

/// The head of an intrinsic in the compiler's table: `name<n>(inputs) -> type`.
#[derive(Clone, Debug, PartialEq)]
pub struct Signature {
    /// `<n>`
    pub dims: Vec<Name>,
    /// What it takes.
    pub inputs: Vec<Input>,
    /// What it gives.
    pub output: Type,
}
