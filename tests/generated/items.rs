//! The items of a file: imports, constants, params, resources, nodes and textures.

use super::expression::Expr;
use super::program::{Exports, Generator, Noted};
use super::types::{Callable, Input, Kind, N, Rate, Scalar, Scope, Takes, Ty, record};

/// What a texture may take, with its type.
const INPUTS: &[(&str, Ty)] = &[
    ("uv", Ty::float(2)),
    ("position", Ty::float(3)),
    ("normal", Ty::float(3)),
    ("tangent", Ty::float(4)),
    ("view", Ty::float(3)),
    ("time", Ty::FLOAT),
    ("base", Ty::int(2)),
    ("uv2", Ty::float(2)),
    ("vertex_color", Ty::float(4)),
    ("instance", Ty::INT),
];

/// Outputs with a fixed type.
const OUTPUTS: &[(&str, Ty)] = &[
    ("color", Ty::float(4)),
    ("height", Ty::FLOAT),
    ("normal", Ty::float(3)),
    ("emission", Ty::float(3)),
    ("roughness", Ty::FLOAT),
    ("metallic", Ty::FLOAT),
    ("occlusion", Ty::FLOAT),
];

impl Generator<'_, '_> {
    /// A file, and what it has for others.
    pub fn file(&mut self, path: &str, done: &[Exports], main: bool) -> (String, Exports) {
        self.callables.clear();
        let mut scope = Scope::empty();
        let mut exports = Exports { path: path.to_owned(), scope: Scope::empty(), callables: Vec::new() };
        let mut items = Vec::new();
        for other in done {
            if main || self.choices.chance(50) {
                items.push(self.import(path, other, &mut scope));
            }
        }
        for _ in 0..self.choices.below(4) {
            items.push(self.constant(&mut scope, &mut exports.scope));
        }
        for _ in 0..self.choices.below(4) {
            items.push(self.param(&mut scope, &mut exports.scope));
        }
        for _ in 0..self.choices.below(3) {
            items.push(self.resource_item(&mut scope, &mut exports.scope));
        }
        for _ in 0..self.choices.below(5) {
            let (text, callable) = self.node(&scope);
            items.push(text);
            self.callables.push(callable.clone());
            exports.callables.push(callable);
            if self.features.bakes && self.choices.chance(20) {
                items.extend(self.bake(&mut scope, &mut exports.scope));
            }
        }
        for _ in 0..if main { 1 + self.choices.below(2) } else { self.choices.below(2) } {
            let (text, callable) = self.texture(&scope);
            items.push(text);
            self.callables.push(callable.clone());
            exports.callables.push(callable);
        }
        self.choices.shuffle(&mut items);
        let mut text = if self.choices.chance(20) { "//! A generated file.\n\n" } else { "" }.to_owned();
        for item in items {
            text.push_str(&self.aside());
            if self.choices.chance(15) {
                text.push_str("/// A generated item.\n/// Its second line.\n");
            }
            text.push_str(&item);
            text.push_str("\n\n");
        }
        (text, exports)
    }

    /// `use "…"` or `use "…" as name`.
    fn import(&mut self, path: &str, other: &Exports, scope: &mut Scope) -> String {
        let inside = path.starts_with("parts/");
        let from = match (inside, other.path.strip_prefix("parts/")) {
            (true, Some(name)) => name.to_owned(),
            (true, None) => format!("../{}", other.path),
            (false, _) => other.path.clone(),
        };
        let alias = self.choices.chance(60).then(|| self.fresh());
        let of = |name: &str| alias.as_ref().map_or(name.to_owned(), |alias| format!("{alias}.{name}"));
        for wire in &other.scope.wires {
            scope.declare(of(&wire.text), wire.ty, wire.rate, wire.touches);
        }
        scope.resources.extend(other.scope.resources.iter().map(|(name, kind)| (of(name), *kind)));
        scope.tables.extend(other.scope.tables.iter().map(|(name, ty)| (of(name), *ty)));
        let method = alias.is_none();
        let callables = other.callables.iter().cloned();
        self.callables.extend(callables.map(|callable| Callable {
            text: of(&callable.text),
            method,
            ..callable
        }));
        match alias {
            Some(alias) => format!("use \"{from}\" as {alias}"),
            None => format!("use \"{from}\""),
        }
    }

    fn constant(&mut self, scope: &mut Scope, exports: &mut Scope) -> String {
        self.room = 10;
        let name = self.fresh();
        let known = scope.constants();
        if self.features.tables && self.choices.chance(20) {
            let ty = Ty { width: 1 + self.choices.below(4) as u8, ..self.some_number(scope) };
            let table = self.table(&known, ty);
            scope.tables.push((name.clone(), ty));
            exports.tables.push((name.clone(), ty));
            return format!("let {name} = {table}");
        }
        let ty = if self.choices.chance(15) { Ty::BOOL } else { self.some_number(scope) };
        let value = self.exact(&known, ty, 2).text;
        scope.declare(name.clone(), ty, Rate::Load, Rate::Load);
        exports.declare(name.clone(), ty, Rate::Load, Rate::Load);
        format!("let {name} = {value}")
    }

    fn param(&mut self, scope: &mut Scope, exports: &mut Scope) -> String {
        let name = self.fresh();
        let ty = if self.choices.chance(20) { Ty::BOOL } else { self.some_number(scope) };
        let text = if ty.scalar != Scalar::Bool && self.choices.chance(60) {
            self.ranged(&name, ty)
        } else if ty == Ty::float(4) && self.choices.chance(50) {
            format!("param {name}: color = {}", self.literal(ty).text)
        } else {
            let value = self.fitting(&scope.constants(), ty, 1).text;
            format!("param {name}: {} = {value}", ty.name())
        };
        scope.declare(name.clone(), ty, Rate::Draw, Rate::Draw);
        exports.declare(name, ty, Rate::Draw, Rate::Draw);
        text
    }

    /// A param whose default lies in its range, in each component.
    fn ranged(&mut self, name: &str, ty: Ty) -> String {
        let mut columns = [Vec::new(), Vec::new(), Vec::new()];
        let inclusive = self.choices.chance(60);
        for _ in 0..ty.width {
            let low = self.choices.below(12) as i32 - 6;
            let span = self.choices.below(9) as i32 + i32::from(!inclusive);
            let inside = self.choices.below((span + i32::from(inclusive)) as usize) as i32;
            for (column, number) in columns.iter_mut().zip([low, low + inside, low + span]) {
                column.push(if ty.scalar == Scalar::Float {
                    format!("{number}.5")
                } else {
                    number.to_string()
                });
            }
        }
        let [low, value, high] = columns.map(|column| match ty.width {
            1 => column.concat(),
            _ => format!("{}({})", ty.name(), column.join(", ")),
        });
        let dots = if inclusive { "..=" } else { ".." };
        format!("param {name}: {} = {value} in {low}{dots}{high}", ty.name())
    }

    fn resource_item(&mut self, scope: &mut Scope, exports: &mut Scope) -> String {
        let kinds = if self.features.pictures { &Kind::ALL[..] } else { &Kind::ALL[..2] };
        let kind = *self.choices.pick(kinds);
        let name = self.fresh();
        let constructor = match kind {
            Kind::Permutation => {
                let size = *self.choices.pick(&[2, 3, 16, 256]);
                let seed = self.choices.below(100);
                format!("permutation({size}, seed: {seed})")
            }
            Kind::Indices => self.index_map(),
            Kind::Image => {
                let wrap = *self.choices.pick(&["repeat", "clamp", "mirror"]);
                let filter = *self.choices.pick(&["linear", "nearest"]);
                let encoding = *self.choices.pick(&["srgb", "linear", "normal"]);
                format!(
                    "image(\"p{}.png\", wrap: {wrap}, filter: {filter}, encoding: {encoding})",
                    self.choices.below(3)
                )
            }
            Kind::Patterns if self.choices.chance(40) => "patterns([\"a.png\", \"b.png\"])".to_owned(),
            Kind::Patterns => {
                let grid = [1 + self.choices.below(4), 1 + self.choices.below(4)];
                format!("patterns(\"p.png\", grid: ivec2({}, {}))", grid[0], grid[1])
            }
        };
        scope.resources.push((name.clone(), kind));
        exports.resources.push((name.clone(), kind));
        format!("let {name} = {constructor}")
    }

    /// `indices([[…], …])`
    fn index_map(&mut self) -> String {
        let (width, height) = (1 + self.choices.below(4), 1 + self.choices.below(3));
        let rows: Vec<String> = (0..height)
            .map(|_| {
                let row: Vec<String> = (0..width).map(|_| self.choices.below(16).to_string()).collect();
                format!("[{}]", row.join(", "))
            })
            .collect();
        let levels = if self.choices.chance(30) { ", levels: 16" } else { "" };
        format!("indices([{}]{levels})", rows.join(", "))
    }

    /// `bake` of a node that takes a place and gives one value, if there is one.
    fn bake(&mut self, scope: &mut Scope, exports: &mut Scope) -> Option<String> {
        let place = Takes::Value(Ty::float(2));
        let node = self.callables.last()?;
        let (callee, inputs, outputs) = (node.text.clone(), &node.inputs, &node.outputs);
        let [only] = inputs.as_slice() else { return None };
        let [(_, given)] = outputs.as_slice() else { return None };
        if only.takes != place || given.scalar != Scalar::Float || node.generic {
            return None;
        }
        let side = *self.choices.pick(&["ivec2(16)", "ivec2(8, 32)", "ivec2(64)"]);
        let wrap = *self.choices.pick(&["", ", wrap: repeat", ", wrap: clamp"]);
        let format = *self.choices.pick(&["", ", format: rgba16float"]);
        let name = self.fresh();
        scope.resources.push((name.clone(), Kind::Image));
        exports.resources.push((name.clone(), Kind::Image));
        Some(format!("let {name} = bake({callee}, size: {side}{wrap}{format})"))
    }

    /// A node, and how it is called.
    fn node(&mut self, file: &Scope) -> (String, Callable) {
        self.room = 20 + self.choices.below(100);
        let generic = self.choices.chance(40);
        let mut s = Scope { generic, ..file.clone() };
        if generic {
            s.declare("n", Ty::INT, Rate::Pixel, Rate::Load);
        }
        let ((head, inputs, outputs, body), Noted { rate, steps, widest }) = self.noting(|me| {
            let (head, inputs) = me.inputs(&mut s);
            let outputs: Vec<(String, Ty)> = (0..*me.choices.pick(&[1, 1, 2, 3]))
                .map(|_| {
                    let ty = if me.choices.chance(10) { Ty::BOOL } else { me.some_number(&s) };
                    (me.fresh(), ty)
                })
                .collect();
            let body = me.body(&mut s, &outputs);
            (head, inputs, outputs, body)
        });
        let name = self.fresh();
        let dims = if generic { "<n>" } else { "" };
        let text = format!("node {name}{dims}({}) -> {} {body}", head.join(", "), record(&outputs));
        let callable = Callable {
            text: name,
            inputs,
            outputs,
            generic,
            rate,
            overloaded: false,
            method: true,
            explicit: true,
            steps,
            library: false,
            widest,
        };
        (text, callable)
    }

    /// The inputs of a node, as written and as they are called; they are declared in its scope.
    fn inputs(&mut self, s: &mut Scope) -> (Vec<String>, Vec<Input>) {
        let mut head = Vec::new();
        let mut inputs = Vec::new();
        // A default sees the file and the inputs before it, not `n` of vectors to come.
        for i in 0..self.choices.below(5) {
            let takes = self.takes(s, i == 0);
            let name = self.input_name(s, &inputs);
            let default = match &takes {
                Takes::Value(ty) if self.choices.chance(35) => {
                    let ty = *ty;
                    Some(self.fitting(&Scope { resources: Vec::new(), ..s.clone() }, ty, 1))
                }
                Takes::Resource(_) if self.choices.chance(25) => Some(Expr::primary("none")),
                _ => None,
            };
            let text = match &default {
                Some(default) => format!("{name}: {} = {}", takes.name(), default.text),
                None => format!("{name}: {}", takes.name()),
            };
            head.push(text);
            s.hide(&name);
            match &takes {
                Takes::Value(ty) => s.declare(name.clone(), *ty, Rate::Pixel, Rate::Load),
                // Whether it is there is known when compiling.
                Takes::Resource(kind) if default.is_some() => {
                    s.declare(format!("given({name})"), Ty::BOOL, Rate::Load, Rate::Load);
                    let count = kind.constant().unwrap_or("size.x");
                    let text = format!("(if given({name}) {{ {name}.{count} }} else {{ 3 }})");
                    s.declare(text, Ty::INT, Rate::Pixel, Rate::Pixel);
                }
                Takes::Resource(kind) => s.resources.push((name.clone(), *kind)),
                Takes::Matrix(size) => s.matrices.push((name.clone(), *size)),
                Takes::Node(of, gives) => s.functions.push(function(&name, of, gives)),
            }
            inputs.push(Input { name, takes, optional: default.is_some() });
        }
        (head, inputs)
    }

    /// A new name, or now and then one of the file's that it hides.
    fn input_name(&mut self, s: &Scope, before: &[Input]) -> String {
        let own = |name: &str| name == "n" || before.iter().any(|input| input.name == name);
        let plain = |name: &str| name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let outer: Vec<&String> =
            s.wires.iter().map(|wire| &wire.text).filter(|name| plain(name) && !own(name)).collect();
        if !outer.is_empty() && self.choices.chance(8) {
            return self.choices.pick(&outer).to_string();
        }
        self.fresh()
    }

    fn takes(&mut self, s: &Scope, first: bool) -> Takes {
        match self.choices.below(20) {
            0..14 => Takes::Value(match self.choices.chance(10) {
                true => Ty::BOOL,
                false if s.generic && first => Ty { width: N, ..self.some_number(s) },
                false => self.some_number(s),
            }),
            14..16 => {
                let kinds = if self.features.pictures { &Kind::ALL[..] } else { &Kind::ALL[..2] };
                Takes::Resource(*self.choices.pick(kinds))
            }
            16 if self.features.matrices => Takes::Matrix(*self.choices.pick(&[2, 3])),
            17..19 if self.features.lambdas => {
                let inputs = (0..1 + self.choices.below(2)).map(|_| self.some_number(s)).collect();
                let several = self.choices.chance(15);
                let outputs = (0..1 + usize::from(several)).map(|_| (self.fresh(), self.some_number(s)));
                Takes::Node(inputs, outputs.collect())
            }
            _ => Takes::Value(Ty::float(2)),
        }
    }

    /// A texture, and how it is called as a node.
    fn texture(&mut self, file: &Scope) -> (String, Callable) {
        self.room = 20 + self.choices.below(150);
        let mut s = file.clone();
        let mut known: Vec<(&str, Ty)> = INPUTS.to_vec();
        self.choices.shuffle(&mut known);
        known.truncate(1 + self.choices.below(4));
        for (name, ty) in &known {
            s.declare(*name, *ty, Rate::Pixel, Rate::Load);
        }
        let mut outputs: Vec<(String, Ty)> = Vec::new();
        let taken = |outputs: &[(String, Ty)], name: &str| outputs.iter().any(|(known, _)| known == name);
        for _ in 0..1 + self.choices.below(4) {
            let (name, ty) = *self.choices.pick(OUTPUTS);
            let clashes = taken(&outputs, name) || known.iter().any(|(input, _)| *input == name);
            if clashes || self.choices.chance(25) {
                outputs.push((self.fresh(), self.some_number(&s)));
            } else {
                outputs.push((name.to_owned(), ty));
            }
        }
        let (body, Noted { rate, steps, widest }) = self.noting(|me| me.body(&mut s, &outputs));
        let name = self.fresh();
        let head: Vec<String> = known.iter().map(|(name, ty)| format!("{name}: {}", ty.name())).collect();
        let text = format!("texture {name}({}) -> {} {body}", head.join(", "), record(&outputs));
        let input = |(name, ty): &(&str, Ty)| Input {
            name: (*name).to_owned(),
            takes: Takes::Value(*ty),
            optional: false,
        };
        let callable = Callable {
            text: name,
            inputs: known.iter().map(input).collect(),
            outputs,
            generic: false,
            rate,
            overloaded: false,
            method: true,
            explicit: false,
            steps,
            library: false,
            widest,
        };
        (text, callable)
    }
}

/// A node that came as an input, as it is called.
fn function(name: &str, inputs: &[Ty], outputs: &[(String, Ty)]) -> Callable {
    let inputs = ('a'..).zip(inputs).map(|(name, ty)| Input {
        name: name.to_string(),
        takes: Takes::Value(*ty),
        optional: false,
    });
    Callable {
        text: name.to_owned(),
        inputs: inputs.collect(),
        outputs: outputs.to_vec(),
        generic: false,
        rate: Rate::Pixel,
        overloaded: false,
        method: false,
        explicit: false,
        steps: 1,
        library: false,
        widest: 4,
    }
}
