//! Textures that try a row with many arguments: a pixel for each.
//!
//! An argument that is not constant is chosen from params by the place of the pixel, so no
//! compiler can know it. A constant one stands as a literal, another in each band of pixels.

use super::values::{COUNT, FLOATS, INTS, bool, place};
use texgraph_grammar::syntax::{Dim, Signature, Type, TypeKind};

/// Different constant arguments in one texture at most: each is an arm of a choice.
pub const BANDS: usize = 16;

/// The places in the lists that constant arguments begin at, by how many of them are constant.
const CONSTANT_PLACES: [&[usize]; 3] =
    [&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15], &[0, 3, 4, 10, 14, 15], &[0, 3, 4, 14]];

/// A type of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Float,
    Int,
    Bool,
}

/// An argument or result: its kind and width.
pub type Shape = (Kind, u8);

/// A row to try at one width, with some arguments constant.
pub struct Case {
    /// The row's name: of a function, or an operator.
    pub name: &'static str,
    /// What it takes.
    pub inputs: Vec<Shape>,
    /// What it gives.
    pub output: Shape,
    /// The arguments that vary over the pixels.
    pub open: Vec<usize>,
    /// The places of the constant arguments, for each band: one for each of them.
    pub bands: Vec<Vec<usize>>,
}

/// The shape that a row's type has at a width.
pub fn shape(ty: &Type, width: u8) -> Shape {
    let TypeKind::Named { name, dim } = &ty.kind else { panic!("a row takes vectors only") };
    let kind = match name.text.trim_end_matches(char::is_numeric) {
        "vec" | "float" => Kind::Float,
        "ivec" | "int" => Kind::Int,
        "bvec" | "bool" => Kind::Bool,
        other => panic!("a row takes `{other}`"),
    };
    let own = name.text.chars().last().and_then(|c| c.to_digit(10)).unwrap_or(1) as u8;
    (kind, if matches!(dim, Some(Dim::Name(_))) { width } else { own })
}

/// Every way in which some of a row's arguments are constant, in textures of so many bands.
pub fn cases(name: &'static str, signature: &Signature, width: u8) -> Vec<Case> {
    let inputs: Vec<Shape> = signature.inputs.iter().map(|input| shape(&input.ty, width)).collect();
    let output = shape(&signature.output, width);
    let mut cases = Vec::new();
    for constant in 0..1_usize << inputs.len() {
        let (closed, open): (Vec<usize>, Vec<usize>) =
            (0..inputs.len()).partition(|i| constant >> i & 1 == 1);
        for bands in combinations(closed.len()).chunks(BANDS) {
            let (inputs, open) = (inputs.clone(), open.clone());
            cases.push(Case { name, inputs, output, open, bands: bands.to_vec() });
        }
    }
    cases
}

/// Every combination of places for so many constant arguments; one empty one for none.
fn combinations(count: usize) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for _ in 0..count {
        let places = CONSTANT_PLACES[count - 1];
        all = all.iter().flat_map(|head| places.iter().map(|at| [&head[..], &[*at]].concat())).collect();
    }
    all
}

impl Case {
    /// Pixels across: one for each place of the first argument that varies.
    pub fn columns(&self) -> usize {
        if self.open.is_empty() { 1 } else { COUNT }
    }

    /// Rows of pixels in a band.
    pub fn band(&self) -> usize {
        COUNT.pow(self.open.len().saturating_sub(1) as u32)
    }

    /// The size of the picture.
    pub fn size(&self) -> [u32; 2] {
        [self.columns() as u32, (self.band() * self.bands.len()) as u32]
    }

    /// The place in the lists that each argument begins at, for a pixel.
    pub fn places(&self, x: usize, y: usize) -> Vec<usize> {
        let mut constants = self.bands[y / self.band()].iter();
        let mut rest = y % self.band();
        let mut first = true;
        (0..self.inputs.len())
            .map(|i| {
                if !self.open.contains(&i) {
                    return constants.next().copied().unwrap_or(0);
                }
                if std::mem::take(&mut first) {
                    return x;
                }
                let at = rest % COUNT;
                rest /= COUNT;
                at
            })
            .collect()
    }

    /// What the row is and how it is tried, for messages.
    pub fn describe(&self) -> String {
        let inputs: Vec<String> = self
            .inputs
            .iter()
            .enumerate()
            .map(|(i, shape)| {
                format!("{:?}{}{}", shape.0, shape.1, if self.open.contains(&i) { "" } else { " constant" })
            })
            .collect();
        format!("{}({})", self.name, inputs.join(", "))
    }

    /// A name for a file, different from every other case's.
    pub fn file_name(&self) -> String {
        let name: String = self.name.bytes().map(|byte| format!("{byte:02x}")).collect();
        let rest = format!("{}-{:?}", self.describe(), self.bands.first());
        let rest: String = rest.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        format!("{name}{rest}.wgsl")
    }

    /// The texture. `low` and `high` are the result; of ints, their lower and upper 16 bits.
    pub fn text(&self) -> String {
        let mut text = params();
        text.push_str(&picks());
        let [width, height] = self.size();
        text.push_str("texture row(uv: vec2) -> (low: vec4, high: vec4) {\n");
        text.push_str(&format!("    let cell = ifloor(uv * vec2({width}.0, {height}.0))\n"));
        text.push_str(&format!("    let band = cell.y / {}\n", self.band()));
        let mut before = 1;
        let mut first = true;
        for i in &self.open {
            let at = if std::mem::take(&mut first) {
                "cell.x".to_owned()
            } else {
                before *= COUNT;
                format!("cell.y / {} % {COUNT}", before / COUNT)
            };
            text.push_str(&format!(
                "    let at{i}_ = {at}\n    let open{i}_ = {}\n",
                picked(self.inputs[*i], &format!("at{i}_"))
            ));
        }
        text.push_str(&format!("    let result = {}\n", self.choice()));
        text.push_str(&self.outputs());
        text + "}\n"
    }

    /// The call with the constants of the band.
    fn choice(&self) -> String {
        let mut text = String::new();
        let last = self.bands.len() - 1;
        for (n, band) in self.bands.iter().enumerate() {
            let call = self.call(band);
            match n {
                _ if n == last && n == 0 => text.push_str(&call),
                _ if n == last => text.push_str(&format!("{{ {call} }}")),
                _ => text.push_str(&format!("if band == {n} {{ {call} }} else ")),
            }
        }
        text
    }

    fn call(&self, band: &[usize]) -> String {
        let mut constants = band.iter();
        let arguments: Vec<String> = (0..self.inputs.len())
            .map(|i| match self.open.contains(&i) {
                true => format!("open{i}_"),
                false => literal(self.inputs[i], constants.next().copied().unwrap_or(0)),
            })
            .collect();
        match (self.name, arguments.as_slice()) {
            ("-x" | "!x", [only]) => format!("{}{only}", &self.name[..1]),
            ("(float)", [only]) => format!("{}({only})", name_of((Kind::Float, self.output.1))),
            ("(int)", [only]) => format!("{}({only})", name_of((Kind::Int, self.output.1))),
            ("([i])", [vector, index]) => format!("{vector}[{index}]"),
            (operator, [a, b]) if !operator.starts_with(|c: char| c.is_ascii_lowercase()) => {
                format!("({a} {operator} {b})")
            }
            (function, arguments) => format!("{function}({})", arguments.join(", ")),
        }
    }

    fn outputs(&self) -> String {
        let (kind, width) = self.output;
        let fill = |part: &str| {
            let zeros = ", 0.0".repeat(usize::from(4 - width));
            format!("vec4({part}{zeros})")
        };
        let (low, high) = match kind {
            Kind::Float => (fill("result"), "vec4(0.0)".to_owned()),
            Kind::Int => (fill("result % 65536"), fill("result / 65536")),
            Kind::Bool => (fill("if result { 1.0 } else { 0.0 }"), "vec4(0.0)".to_owned()),
        };
        format!("    low  = {low}\n    high = {high}\n")
    }
}

fn name_of((kind, width): Shape) -> String {
    match (kind, width) {
        (Kind::Bool, _) => "bool".to_owned(),
        (Kind::Float, 1) => "float".to_owned(),
        (Kind::Int, 1) => "int".to_owned(),
        (Kind::Float, width) => format!("vec{width}"),
        (Kind::Int, width) => format!("ivec{width}"),
    }
}

/// A param for every number of the lists.
fn params() -> String {
    let floats = FLOATS.iter().enumerate().map(|(i, text)| format!("param f{i}_: float = {text}\n"));
    let ints = INTS.iter().enumerate().map(|(i, text)| format!("param i{i}_: int = {text}\n"));
    floats.chain(ints).collect()
}

/// The nodes that choose one by its place.
fn picks() -> String {
    let pick = |ty: &str, letter: &str| {
        let arms: String =
            (0..COUNT - 1).map(|i| format!("if place == {i} {{ {letter}{i}_ }} else ")).collect();
        format!(
            "node pick_{letter}(at: int) -> (x: {ty}) {{\n    let place = at % {COUNT}\n    \
             x = {arms}{{ {letter}{}_ }}\n}}\n\n",
            COUNT - 1
        )
    };
    pick("float", "f") + &pick("int", "i")
}

/// An argument that begins at a place told by an expression.
fn picked((kind, width): Shape, at: &str) -> String {
    if kind == Kind::Bool {
        return format!("{at} % 2 == 1");
    }
    let letter = if kind == Kind::Float { "f" } else { "i" };
    let parts: Vec<String> =
        (0..width).map(|component| format!("pick_{letter}({at} + {})", place(0, component))).collect();
    format!("{}({})", name_of((kind, width)), parts.join(", "))
}

/// An argument that begins at a known place.
fn literal((kind, width): Shape, at: usize) -> String {
    let parts: Vec<String> = (0..width)
        .map(|component| {
            let at = place(at, component);
            match kind {
                Kind::Float => FLOATS[at].to_owned(),
                Kind::Int => INTS[at].to_owned(),
                Kind::Bool => bool(at).to_string(),
            }
        })
        .collect();
    match kind {
        Kind::Bool => parts.concat(),
        _ => format!("{}({})", name_of((kind, width)), parts.join(", ")),
    }
}
