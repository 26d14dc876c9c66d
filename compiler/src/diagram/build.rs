//! From the syntax tree to blocks and wires.

use super::formula::Formula;
use super::scope::{Scope, is_resource, type_name};
use super::text::{self, excerpt};
use super::{Block, Diagram, End, Kind, Port, Rate, Wire};
use crate::check::order::{Free, Needs, names_of, sort, value_of};
use crate::input::is_per_draw;
use crate::library::Library;
use crate::module::{Modules, Sources};
use rustc_hash::{FxHashMap, FxHashSet};
use texgraph_grammar::syntax::{
    Body, Expr, Input, Item, ItemKind, Name, Node, Pattern, Span, Statement, TypeKind,
};

/// What a name or an expression is in the diagram.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Value {
    /// One output of a block.
    Port(End),
    /// All outputs of a block. Of an open one nobody knows how many there are: they come into being
    /// when they are named.
    Record { block: usize, open: bool },
    /// A resource: its first output is itself, the others are its fields.
    Resource(usize),
}

/// A diagram in the making.
pub struct Maker<'a> {
    pub scope: Scope<'a>,
    sources: &'a Sources,
    /// Of the body that is drawn.
    pub module: usize,
    pub blocks: Vec<Block>,
    wires: Vec<Wire>,
    /// Inputs, wires and outputs that are read.
    names: FxHashMap<&'a str, Value>,
    /// The outputs of blocks by name.
    ports: FxHashMap<(usize, String), usize>,
    /// What the author calls all outputs of a block together.
    records: FxHashMap<usize, &'a str>,
    /// The kind of resource that a block stands for.
    pub kinds: FxHashMap<usize, &'a str>,
    /// The inputs that are nodes, with the names of what they take.
    pub node_inputs: FxHashMap<&'a str, Vec<&'a str>>,
    /// What files declare, by module and name.
    pub globals: FxHashMap<(usize, &'a str), Value>,
    /// Blocks of declarations whose wires are still to be drawn.
    pub pending: Vec<(usize, usize, &'a Expr)>,
}

/// The diagram of an item that is a node or a texture.
pub fn build(library: &Library, modules: &Modules, module: usize, item: usize) -> Diagram {
    let found = modules.modules.get(module).and_then(|module| module.tree.items.get(item));
    let (title, label, node) = match found.map(|item| (&item.kind, first_line(item))) {
        Some((ItemKind::Node(node), doc)) => ("node", doc, Some(node)),
        Some((ItemKind::Texture { node, .. }, doc)) => ("texture", doc, Some(node)),
        _ => ("", String::new(), None),
    };
    let mut maker = Maker {
        scope: Scope::new(library, &modules.modules),
        sources: &modules.sources,
        module,
        blocks: Vec::new(),
        wires: Vec::new(),
        names: FxHashMap::default(),
        ports: FxHashMap::default(),
        records: FxHashMap::default(),
        kinds: FxHashMap::default(),
        node_inputs: FxHashMap::default(),
        globals: FxHashMap::default(),
        pending: Vec::new(),
    };
    let mut title = title.to_owned();
    if let Some(node) = node {
        title = format!("{title} {}", node.name.text);
        maker.node(node, title.starts_with("texture"));
    }
    let mut diagram = Diagram { title, label, blocks: maker.blocks, wires: maker.wires };
    diagram.spread_rates();
    diagram
}

fn first_line(item: &Item) -> String {
    item.doc.lines().next().unwrap_or_default().trim().to_owned()
}

impl<'a> Maker<'a> {
    fn node(&mut self, node: &'a Node, is_texture: bool) {
        for input in &node.inputs {
            self.input(input, is_texture);
        }
        let mut given = self.body(&node.body);
        for output in &node.outputs {
            let title =
                self.text(self.module, Span { start: output.name.span.start, end: output.ty.span.end });
            let (note, wire) = given.remove(output.name.text.as_str()).unwrap_or_default();
            let block = self.block(Kind::Output, title, Rate::Load);
            self.blocks[block].text.extend((!note.is_empty()).then(|| format!("= {note}")));
            self.blocks[block].inputs.push(Port::default());
            if let Some((from, is_node)) = wire {
                self.wire(from, End { block, port: 0 }, is_node);
            }
        }
        self.wire_globals();
    }

    fn input(&mut self, input: &'a Input, is_texture: bool) {
        let end = input.default.as_ref().map_or(input.ty.span.end, |default| default.span.end);
        let title = self.text(self.module, Span { start: input.name.span.start, end });
        let name = input.name.text.as_str();
        let kind = type_name(input).filter(|ty| is_resource(ty));
        let is_fixed = kind.is_some() || matches!(input.ty.kind, TypeKind::Node { .. } | TypeKind::Choice(_));
        let rate = match () {
            () if is_fixed => Rate::Load,
            () if is_texture && is_per_draw(name) => Rate::Draw,
            () => Rate::Pixel,
        };
        let block = self.block(Kind::Input, text::shorten(&title, 48), rate);
        self.add_output(block, "");
        if let TypeKind::Node { inputs, .. } = &input.ty.kind {
            self.node_inputs.insert(name, inputs.iter().map(|input| input.name.text.as_str()).collect());
        }
        self.kinds.extend(kind.map(|kind| (block, kind)));
        let value = match kind {
            Some(_) => Value::Resource(block),
            None => Value::Port(End { block, port: 0 }),
        };
        self.names.insert(name, value);
    }

    /// Draws all statements, each after those it reads; gives what the outputs are assigned.
    fn body(&mut self, body: &'a Body) -> FxHashMap<&'a str, Given> {
        let mut binds: FxHashMap<&str, usize> = FxHashMap::default();
        for (i, statement) in body.statements.iter().enumerate() {
            for name in names_of(statement) {
                binds.entry(name).or_insert(i);
            }
        }
        let reads: Vec<Vec<&str>> = body.statements.iter().map(|s| Free::of(value_of(s)).values).collect();
        let is_read: FxHashSet<&str> = reads.iter().flatten().copied().collect();
        let mut needs = Needs::default();
        for names in &reads {
            needs.push(names.iter().filter_map(|name| binds.get(name).copied()));
        }
        let mut given = FxHashMap::default();
        for step in sort(&needs).0 {
            match &body.statements[step] {
                Statement::Let { pattern, value, .. } => self.bind(pattern, value),
                Statement::Assign { name, value } => {
                    let assigned = self.assign(name, value, is_read.contains(name.text.as_str()));
                    given.entry(name.text.as_str()).or_insert(assigned);
                }
            }
        }
        given
    }

    fn bind(&mut self, pattern: &'a Pattern, value: &'a Expr) {
        let value = self.value(value);
        match pattern {
            Pattern::Name(name) => self.call_it(value, name),
            Pattern::Record(names, _) => {
                for (i, name) in names.iter().enumerate() {
                    let part = self.part(value, i, name);
                    self.call_it(part, name);
                }
            }
        }
    }

    /// An output. If it is read as a wire too, its formula is a block of its own.
    fn assign(&mut self, name: &'a Name, value: &'a Expr, is_read: bool) -> Given {
        if !is_read {
            return self.operand(value);
        }
        let value = self.value(value);
        self.call_it(value, name);
        (String::new(), Some((self.end(value), false)))
    }

    /// Gives a value a name; the first that the author chose is shown.
    fn call_it(&mut self, value: Value, name: &'a Name) {
        self.names.entry(&name.text).or_insert(value);
        match value {
            Value::Port(end) => self.note(end, &name.text),
            Value::Record { block, .. } => {
                self.records.entry(block).or_insert(&name.text);
            }
            Value::Resource(_) => {}
        }
    }

    fn note(&mut self, end: End, name: &str) {
        let declares = matches!(self.blocks[end.block].kind, Kind::Input | Kind::Param | Kind::Constant);
        let port = &mut self.blocks[end.block].outputs[end.port];
        if port.note.is_empty() && port.name != name && !declares {
            port.note = name.to_owned();
        }
    }

    /// The output at a position of a record, or the one that is given that name.
    fn part(&mut self, value: Value, position: usize, name: &Name) -> Value {
        match value {
            Value::Record { block, open: false } if position < self.blocks[block].outputs.len() => {
                Value::Port(End { block, port: position })
            }
            Value::Record { block, open: true } => Value::Port(self.output(block, &name.text)),
            _ => value,
        }
    }

    /// The output of that name, made if it is not there.
    fn output(&mut self, block: usize, name: &str) -> End {
        if let Some(port) = self.ports.get(&(block, name.to_owned())) {
            return End { block, port: *port };
        }
        let port = self.add_output(block, name);
        End { block, port }
    }

    /// A new output of a block.
    pub fn add_output(&mut self, block: usize, name: &str) -> usize {
        let outputs = &mut self.blocks[block].outputs;
        outputs.push(Port { name: name.to_owned(), note: String::new() });
        let port = outputs.len() - 1;
        self.ports.entry((block, name.to_owned())).or_insert(port);
        port
    }

    /// The field of a value that is a port of its own, as those of records and resources are; a
    /// swizzle is none.
    pub fn select(&mut self, value: Value, field: &str) -> Option<Value> {
        let (block, is_port) = match value {
            Value::Port(_) => return None,
            Value::Record { block, open } => {
                let is_known = self.ports.contains_key(&(block, field.to_owned()));
                (block, is_known || open && !is_swizzle(field))
            }
            Value::Resource(block) => {
                let known = self.kinds.get(&block).and_then(|kind| self.scope.has_field(kind, field));
                (block, known.unwrap_or(!is_swizzle(field)))
            }
        };
        let end = is_port.then(|| self.output(block, field))?;
        if let Some(record) = self.records.get(&block) {
            let name = format!("{record}.{field}");
            self.note(end, &name);
        }
        Some(Value::Port(end))
    }

    /// The output that stands for a value as a whole.
    pub fn end(&mut self, value: Value) -> End {
        match value {
            Value::Port(end) => end,
            Value::Record { block, .. } | Value::Resource(block) => {
                if self.blocks[block].outputs.is_empty() {
                    self.output(block, "");
                }
                let end = End { block, port: 0 };
                if let Some(record) = self.records.get(&block) {
                    self.note(end, record);
                }
                end
            }
        }
    }

    /// What a name means: something of this body, or what a file declares.
    pub fn name(&mut self, name: &'a str) -> Option<Value> {
        self.names.get(name).copied().or_else(|| self.global(self.module, name, name))
    }

    /// A new block.
    pub fn block(&mut self, kind: Kind, title: String, rate: Rate) -> usize {
        self.blocks.push(Block { kind, title, text: vec![], inputs: vec![], outputs: vec![], rate });
        self.blocks.len() - 1
    }

    /// A new input of a block with what is given there.
    pub fn connect(&mut self, block: usize, name: &str, (note, wire): Given) {
        let port = self.blocks[block].inputs.len();
        self.blocks[block].inputs.push(Port { name: name.to_owned(), note });
        if let Some((from, is_node)) = wire {
            self.wire(from, End { block, port }, is_node);
        }
    }

    fn wire(&mut self, from: End, to: End, is_node: bool) {
        self.wires.push(Wire { from, to, is_node });
    }

    /// The text of a part of a file, on one line.
    pub fn text(&self, module: usize, span: Span) -> String {
        self.text_with(module, span, &[])
    }

    /// The same with parts replaced.
    pub fn text_with(&self, module: usize, span: Span, parts: &[(Span, String)]) -> String {
        let Some(module) = self.scope.module(module) else { return String::new() };
        let source = self.sources.0.get(module.file as usize);
        source.map_or(String::new(), |source| excerpt(&source.text, &module.tree.comments, span, parts))
    }

    /// A block for a formula.
    pub fn formula_block(&mut self, formula: &Formula, text: &str) -> End {
        let block = self.block(Kind::Formula, String::new(), Rate::Load);
        self.blocks[block].text = text::wrap(text, 44, 6);
        for used in &formula.uses {
            let from = self.end(used.value);
            self.connect(block, &used.label, (String::new(), Some((from, false))));
        }
        self.add_output(block, "");
        End { block, port: 0 }
    }
}

/// What is given to an input: a text, a wire, or a text about a wire. Whether the wire carries a
/// node.
pub type Given = (String, Option<(End, bool)>);

fn is_swizzle(field: &str) -> bool {
    let of = |letters: &str| field.chars().all(|c| letters.contains(c));
    field.len() <= 4 && (of("xyzw") || of("rgba"))
}
