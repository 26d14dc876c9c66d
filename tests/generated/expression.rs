//! Expressions of a wanted type.
//!
//! `exact` makes one of just that type, so that an operator or an overload is sure to get it;
//! `fitting` one that widens to it, as any argument or output may be.

use super::program::Generator;
use super::types::{Kind, N, Rate, Scalar, Scope, Ty, Wire};
use std::fmt::Write;

/// How tightly an expression holds together: 1 (`||`) to 5 (`*`), 6 a sign, 7 all else.
const TIGHTEST: u8 = 7;

/// An expression as text.
pub struct Expr {
    pub text: String,
    tight: u8,
}

impl Expr {
    /// A product.
    pub fn product(text: String) -> Expr {
        Expr { text, tight: 5 }
    }

    /// One that needs no brackets anywhere.
    pub fn primary(text: impl Into<String>) -> Expr {
        Expr { text: text.into(), tight: TIGHTEST }
    }

    /// With brackets where something else would tear it apart.
    pub fn at_least(self, tight: u8) -> String {
        if self.tight < tight { format!("({})", self.text) } else { self.text }
    }

    /// As what a dot or an index stands behind.
    pub fn base(self) -> String {
        self.at_least(TIGHTEST)
    }
}

const FLOATS: &[&str] = &[
    "0.0",
    "1.0",
    "0.5",
    "2.0",
    "3.75",
    "0.1",
    "1e-3",
    "90deg",
    "0.25turn",
    "1e3",
    "16777217.0",
    "1e38",
    "3.4e38",
    "1e-37",
    "1e-45",
    "255.0",
];
const INTS: &[&str] = &["0", "1", "2", "3", "7", "8", "16", "31", "32", "255", "65536", "2147483647"];
const COLORS: &[&str] = &["#fff", "#102030", "#8040c0", "#ff000080", "#000"];

impl Generator<'_, '_> {
    /// An expression that widens to a type.
    pub fn fitting(&mut self, s: &Scope, ty: Ty, depth: u32) -> Expr {
        let mut narrow = ty;
        if ty.scalar == Scalar::Float && self.choices.chance(25) {
            narrow.scalar = Scalar::Int;
        }
        if ty.width != 1 && self.choices.chance(30) {
            narrow.width = 1;
        }
        if depth > 0 && self.choices.chance(5) {
            // The arms of a choice may differ, and widen.
            return self.choice(s, depth, |me, depth| me.fitting(s, narrow, depth));
        }
        self.exact(s, narrow, depth)
    }

    /// An expression of just that type.
    pub fn exact(&mut self, s: &Scope, ty: Ty, depth: u32) -> Expr {
        let made = if depth == 0 || self.room == 0 {
            None
        } else {
            self.room -= 1;
            match ty.scalar {
                Scalar::Bool => self.bool(s, depth - 1),
                _ => self.number(s, ty, depth - 1),
            }
        };
        let made = made.unwrap_or_else(|| self.leaf(s, ty));
        if self.choices.chance(2) { Expr::primary(format!("({})", made.text)) } else { made }
    }

    /// A name or a literal.
    fn leaf(&mut self, s: &Scope, ty: Ty) -> Expr {
        let wires = s.of(ty);
        if !wires.is_empty() && !self.choices.chance(30) {
            let wire = *self.choices.pick(&wires);
            self.touch(wire.touches);
            return Expr::primary(wire.text.clone());
        }
        if wires.is_empty() && ty.scalar != Scalar::Bool && self.choices.chance(60) {
            let others: Vec<&Wire> =
                s.wires.iter().filter(|wire| wire.ty.scalar != Scalar::Bool && wire.rate <= s.most).collect();
            if !others.is_empty() {
                let wire = *self.choices.pick(&others);
                self.touch(wire.touches);
                return self.adapted(&wire.text, wire.ty, ty);
            }
        }
        self.literal(ty)
    }

    /// A literal, or a constructor of one.
    pub fn literal(&mut self, ty: Ty) -> Expr {
        if ty.width != 1 {
            if ty == Ty::float(4) && self.choices.chance(30) {
                return Expr::primary(*self.choices.pick(COLORS));
            }
            let inner = self.literal(Ty { width: 1, ..ty }).text;
            return Expr::primary(format!("{}({inner})", ty.name()));
        }
        let text = match ty.scalar {
            Scalar::Bool => return Expr::primary(*self.choices.pick(&["false", "true"])),
            Scalar::Int if self.choices.chance(2) => "2147483648",
            Scalar::Int => {
                let text = *self.choices.pick(INTS);
                return if self.choices.chance(25) { negative(text) } else { Expr::primary(text) };
            }
            Scalar::Float => {
                let text = *self.choices.pick(FLOATS);
                return if self.choices.chance(25) { negative(text) } else { Expr::primary(text) };
            }
        };
        // The least int stands with its sign only.
        negative(text)
    }

    fn number(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        match self.choices.below(26) {
            0..4 => None,
            4..10 => Some(self.operator(s, ty, depth)),
            10 => Some(Expr { text: format!("-{}", self.exact(s, ty, depth).at_least(6)), tight: 6 }),
            11..16 => self.call(s, ty, depth),
            16 => Some(self.choice(s, depth, |me, depth| me.exact(s, ty, depth))),
            17 => Some(self.constructor(s, ty, depth)),
            18 | 19 => self.swizzle(s, ty, depth),
            20 if ty.width == 1 => Some(self.component(s, ty, depth)),
            21 | 22 => self.read(s, ty, depth),
            23 => self.derivative(s, ty, depth),
            24 => self.fold_value(s, ty, depth),
            25 => self.later(s, ty, depth),
            _ => None,
        }
    }

    /// What stands behind a switch.
    fn later(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        if self.choices.chance(50) { self.product(s, ty, depth) } else { self.entry(s, ty, depth) }
    }

    /// An operator: one operand is of the wanted type, or one has its scalar and one its width.
    fn operator(&mut self, s: &Scope, ty: Ty, depth: u32) -> Expr {
        let (symbol, tight) = *self.choices.pick(&[("+", 4), ("*", 5), ("-", 4), ("/", 5), ("%", 5)]);
        let split = ty.scalar == Scalar::Float && ty.width != 1 && self.choices.chance(10);
        let (full, other) = if split {
            (self.exact(s, Ty { scalar: Scalar::Int, ..ty }, depth), self.exact(s, Ty::FLOAT, depth))
        } else {
            (self.exact(s, ty, depth), self.fitting(s, ty, depth))
        };
        let (left, right) = if self.choices.chance(50) { (other, full) } else { (full, other) };
        Expr { text: format!("{} {symbol} {}", left.at_least(tight), right.at_least(tight + 1)), tight }
    }

    fn bool(&mut self, s: &Scope, depth: u32) -> Option<Expr> {
        match self.choices.below(12) {
            0 | 1 => None,
            2..6 => Some(self.comparison(s, depth)),
            6 | 7 => Some(self.equality(s, depth)),
            8 => Some(Expr { text: format!("!{}", self.exact(s, Ty::BOOL, depth).at_least(6)), tight: 6 }),
            9 => Some(self.choice(s, depth, |me, depth| me.exact(s, Ty::BOOL, depth))),
            10 => self.call(s, Ty::BOOL, depth),
            _ => {
                let (symbol, tight) = *self.choices.pick(&[("&&", 2), ("||", 1)]);
                let left = self.exact(s, Ty::BOOL, depth).at_least(tight);
                let right = self.exact(s, Ty::BOOL, depth).at_least(tight + 1);
                Some(Expr { text: format!("{left} {symbol} {right}"), tight })
            }
        }
    }

    fn comparison(&mut self, s: &Scope, depth: u32) -> Expr {
        let symbol = *self.choices.pick(&["<", "<=", ">", ">="]);
        let left = self.fitting(s, Ty::FLOAT, depth).at_least(4);
        let right = self.fitting(s, Ty::FLOAT, depth).at_least(4);
        Expr { text: format!("{left} {symbol} {right}"), tight: 3 }
    }

    fn equality(&mut self, s: &Scope, depth: u32) -> Expr {
        let symbol = *self.choices.pick(&["==", "!="]);
        let ty = if self.choices.chance(20) { Ty::BOOL } else { self.some_number(s) };
        let left = self.fitting(s, ty, depth).at_least(4);
        let right = self.fitting(s, ty, depth).at_least(4);
        Expr { text: format!("{left} {symbol} {right}"), tight: 3 }
    }

    /// A number or vector that may stand here.
    pub fn some_number(&mut self, s: &Scope) -> Ty {
        let scalar = *self.choices.pick(&[Scalar::Float, Scalar::Float, Scalar::Int]);
        Ty { scalar, width: self.some_width(s) }
    }

    pub fn some_width(&mut self, s: &Scope) -> u8 {
        if s.generic && self.choices.chance(40) { N } else { *self.choices.pick(&[1, 2, 3, 4, 1, 2]) }
    }

    /// `if … { … } else { … }`; as an operand it needs no brackets.
    fn choice(&mut self, s: &Scope, depth: u32, mut arm: impl FnMut(&mut Self, u32) -> Expr) -> Expr {
        let mut text = String::new();
        for _ in 0..=usize::from(self.choices.chance(20)) {
            let condition = self.exact(s, Ty::BOOL, depth).text;
            let value = arm(self, depth).text;
            let _ = write!(text, "if {condition} {{ {value} }} else ");
        }
        let otherwise = arm(self, depth).text;
        let _ = write!(text, "{{ {otherwise} }}");
        Expr::primary(text)
    }

    /// Components from parts, or one scalar in every component.
    fn constructor(&mut self, s: &Scope, ty: Ty, depth: u32) -> Expr {
        let mut widths = Vec::new();
        if ty.width == 1 || ty.width == N || self.choices.chance(30) {
            widths.push(1);
        } else {
            let mut left = ty.width;
            while left > 0 {
                let part = 1 + self.choices.below(usize::from(left)) as u8;
                widths.push(part);
                left -= part;
            }
        }
        let mut parts = Vec::new();
        for width in widths {
            let scalar = *self.choices.pick(&[ty.scalar, ty.scalar, Scalar::Float, Scalar::Int]);
            parts.push(self.exact(s, Ty { scalar, width }, depth).text);
        }
        let name = match ty.width {
            1..=4 if self.choices.chance(10) => {
                let vector = if ty.scalar == Scalar::Float { "vec" } else { "ivec" };
                format!("{vector}<{}>", ty.width)
            }
            _ => ty.name(),
        };
        Expr::primary(format!("{name}({})", parts.join(", ")))
    }

    /// Components of something wide enough, by `.xyzw` or `.rgba`.
    fn swizzle(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        if ty.width == N {
            return None;
        }
        let width = if s.generic && ty.width == 1 && self.choices.chance(40) {
            N
        } else {
            1 + self.choices.below(4) as u8
        };
        let base = self.exact(s, Ty { width, ..ty }, depth).base();
        Some(self.components(&base, width, ty.width))
    }

    /// So many components of a vector.
    fn components(&mut self, base: &str, width: u8, count: u8) -> Expr {
        let set = *self.choices.pick(&["xyzw", "rgba"]);
        let within = &set[..usize::from(width.max(1))];
        let letters: String = (0..count)
            .map(|_| {
                let at = self.choices.below(within.len());
                &within[at..=at]
            })
            .collect();
        Expr::primary(format!("{base}.{letters}"))
    }

    /// `v[i]`
    fn component(&mut self, s: &Scope, ty: Ty, depth: u32) -> Expr {
        let width = self.some_width(s);
        let base = self.exact(s, Ty { width, ..ty }, depth).base();
        let index = self.exact(s, Ty::INT, depth).text;
        Expr::primary(format!("{base}[{index}]"))
    }

    /// A screen derivative.
    fn derivative(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        if ty.scalar != Scalar::Float || s.most < Rate::Pixel {
            return None;
        }
        self.touch(Rate::Pixel);
        let scalar = *self.choices.pick(&[Scalar::Float, Scalar::Int]);
        let of = self.exact(s, Ty { scalar, ..ty }, depth);
        let name = *self.choices.pick(&["dx", "dy"]);
        Some(if self.choices.chance(20) {
            Expr::primary(format!("{}.{name}()", of.base()))
        } else {
            Expr::primary(format!("{name}({})", of.text))
        })
    }

    /// What a resource tells, made to the wanted type.
    fn read(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        if s.resources.is_empty() {
            return None;
        }
        let (name, kind) = self.choices.pick(&s.resources).clone();
        let (text, found) = if s.most == Rate::Pixel {
            self.touch(Rate::Pixel);
            self.texels(s, &name, kind, depth)
        } else {
            (format!("{name}.{}", kind.constant()?), Ty::INT)
        };
        Some(self.adapted(&text, found, ty))
    }

    /// A value that a resource gives per pixel, with its type.
    fn texels(&mut self, s: &Scope, name: &str, kind: Kind, depth: u32) -> (String, Ty) {
        let at = self.choices.below(5);
        let place = self.exact(s, Ty::float(2), depth).text;
        let index = self.fitting_wide(s, 2, depth);
        let layer = self.exact(s, Ty::INT, depth).text;
        match (kind, at) {
            (Kind::Permutation, 0 | 1) => (format!("{name}.at({layer})"), Ty::int(4)),
            (Kind::Permutation, 2 | 3) => (format!("{name}.table.texel({index})"), Ty::int(4)),
            (Kind::Permutation, _) => (format!("{name}.table.size"), Ty::int(2)),
            (Kind::Indices, 0 | 1) => (format!("{name}.at({index})"), Ty::INT),
            (Kind::Indices, 2) => (format!("{name}.texel({index})"), Ty::int(4)),
            (Kind::Indices, 3) => (format!("{name}.map.texel(i: {index})"), Ty::int(4)),
            (Kind::Indices, _) => (format!("{name}.size"), Ty::int(2)),
            (Kind::Image, 0 | 1) => (format!("{name}.sample({place})"), Ty::float(4)),
            (Kind::Image, 2) => {
                let level = self.fitting(s, Ty::FLOAT, depth).text;
                (format!("{name}.sample({place}, lod: {level})"), Ty::float(4))
            }
            (Kind::Image, 3) => {
                let of = self.exact(s, Ty::float(2), depth).text;
                (format!("{name}.pixels.sample({place}, gradient: {of})"), Ty::float(4))
            }
            (Kind::Image, _) => (format!("{name}.texel({index})"), Ty::float(4)),
            (Kind::Patterns, 0 | 1) => (format!("{name}.reference({layer}, {place})"), Ty::float(4)),
            (Kind::Patterns, 2) => (format!("{name}.layers.sample({place}, layer: {layer})"), Ty::float(4)),
            (Kind::Patterns, 3) => (format!("{name}.layers.texel({index}, layer: {layer})"), Ty::float(4)),
            (Kind::Patterns, _) => (format!("{name}.layers.size"), Ty::int(2)),
        }
    }

    /// An index of a texel: of full width, for a scalar does not spread there.
    fn fitting_wide(&mut self, s: &Scope, width: u8, depth: u32) -> String {
        self.exact(s, Ty::int(width), depth).text
    }

    /// A primary of one type as an expression of another.
    pub fn adapted(&mut self, text: &str, found: Ty, wanted: Ty) -> Expr {
        if found == wanted {
            return Expr::primary(text);
        }
        if wanted.width == N || found.scalar != wanted.scalar {
            let inner = self.components(text, found.width, if wanted.width == N { 1 } else { wanted.width });
            return Expr::primary(format!("{}({})", wanted.name(), inner.text));
        }
        self.components(text, found.width, wanted.width)
    }
}

fn negative(text: &str) -> Expr {
    Expr { text: format!("-{text}"), tight: 6 }
}
