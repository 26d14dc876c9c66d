//! Names, order and repetition have no meaning: a graph, and the same graph with every `let` renamed,
//! reordered and written twice, have equally many operations and give the same picture.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use texgraph_compiler::{Library, Options, Program, compile, diagnostic::render};
use texgraph_grammar::syntax::{
    Body, Expr, ExprKind, File, Fold, ItemKind, Node, Pattern, Postfix, Span, Statement,
};
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::{cpu, resource};

/// Pixels along a side of the pictures that are compared.
const SIDE: u32 = 48;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every example and golden file.
fn files() -> Vec<PathBuf> {
    let folders = ["examples", "tests/golden"].map(|folder| root().join(folder));
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).expect("the folder is there"));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "tex"));
    files.sort();
    files
}

/// A generator of numbers that is the same on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % bound.max(1)
    }
}

/// Reads of names that an expression does not bind itself, with their places.
#[derive(Default)]
struct Reads<'a> {
    found: Vec<(&'a str, Span)>,
    bound: Vec<&'a str>,
}

impl<'a> Reads<'a> {
    fn expr(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Name(name) if !self.bound.contains(&name.as_str()) => {
                self.found.push((name, expr.span))
            }
            ExprKind::Paren(inner) => self.expr(inner),
            ExprKind::Call(call) => call.arguments.iter().for_each(|argument| self.expr(&argument.value)),
            ExprKind::Postfix { base, links } => {
                self.expr(base);
                for link in links {
                    match link {
                        Postfix::Field(_) => {}
                        Postfix::Method(call, _) => call.arguments.iter().for_each(|a| self.expr(&a.value)),
                        Postfix::Index(index, _) => self.expr(index),
                    }
                }
            }
            ExprKind::Unary { operand, .. } => self.expr(operand),
            ExprKind::Chain { first, links } => {
                self.expr(first);
                links.iter().for_each(|link| self.expr(&link.operand));
            }
            ExprKind::If { arms, otherwise } => {
                arms.iter().flat_map(|(condition, arm)| [condition, arm]).for_each(|e| self.expr(e));
                self.expr(otherwise);
            }
            ExprKind::List(items) => items.iter().for_each(|item| self.expr(item)),
            ExprKind::Lambda { inputs, body } => {
                let names = inputs.iter().map(|name| name.text.as_str());
                self.inside(names.collect(), |reads| reads.expr(body));
            }
            ExprKind::Fold(fold) => self.fold(fold),
            _ => {}
        }
    }

    fn fold(&mut self, fold: &'a Fold) {
        fold.accumulators.iter().for_each(|(_, start)| self.expr(start));
        [&fold.range.start, &fold.range.end].into_iter().for_each(|end| self.expr(end));
        fold.max.iter().for_each(|max| self.expr(max));
        let mut names: Vec<&str> = fold.accumulators.iter().map(|(name, _)| name.text.as_str()).collect();
        self.inside(names.clone(), |reads| fold.condition.iter().for_each(|c| reads.expr(c)));
        names.push(&fold.variable.text);
        names.extend(fold.body.statements.iter().flat_map(bound));
        self.inside(names, |reads| fold.body.statements.iter().for_each(|s| reads.expr(value(s))));
    }

    fn inside(&mut self, names: Vec<&'a str>, walk: impl FnOnce(&mut Self)) {
        let before = self.bound.len();
        self.bound.extend(names);
        walk(self);
        self.bound.truncate(before);
    }
}

/// The names that a statement binds.
fn bound(statement: &Statement) -> Vec<&str> {
    match statement {
        Statement::Let { pattern: Pattern::Name(name), .. } | Statement::Assign { name, .. } => {
            vec![&name.text]
        }
        Statement::Let { pattern: Pattern::Record(names, _), .. } => {
            names.iter().map(|name| name.text.as_str()).collect()
        }
    }
}

fn value(statement: &Statement) -> &Expr {
    match statement {
        Statement::Let { value, .. } | Statement::Assign { value, .. } => value,
    }
}

/// The text of a body with its `let`s renamed, written twice and shuffled.
fn disguised(text: &str, body: &Body, random: &mut Random) -> String {
    let lets = body.statements.iter().filter(|statement| matches!(statement, Statement::Let { .. }));
    let names: Vec<&str> = lets.flat_map(bound).collect();
    let mut statements = Vec::new();
    for statement in &body.statements {
        let copies = if matches!(statement, Statement::Let { .. }) { 2 } else { 1 };
        // What it binds it can't read: there the name is the word of a choice.
        let own = bound(statement);
        let others: Vec<&str> = names.iter().copied().filter(|name| !own.contains(name)).collect();
        for copy in 0..copies {
            let value = renamed(text, value(statement), &others, random);
            let targets: Vec<String> = bound(statement).iter().map(|name| named(name, copy)).collect();
            statements.push(match statement {
                Statement::Let { pattern: Pattern::Name(_), .. } => format!("let {} = {value}", targets[0]),
                Statement::Let { .. } => format!("let ({}) = {value}", targets.join(", ")),
                Statement::Assign { name, .. } => format!("{} = {value}", name.text),
            });
        }
    }
    for i in (1..statements.len()).rev() {
        statements.swap(i, random.below(i + 1));
    }
    format!("{{\n{}\n}}", statements.join("\n"))
}

fn named(name: &str, copy: usize) -> String {
    format!("{}_{name}", ["first", "second"][copy])
}

/// An expression's text; each read of one of the names is of either of its copies.
fn renamed(text: &str, expr: &Expr, names: &[&str], random: &mut Random) -> String {
    let mut reads = Reads::default();
    reads.expr(expr);
    let mut out = String::new();
    let mut at = expr.span.start as usize;
    reads.found.sort_by_key(|(_, span)| span.start);
    for (name, span) in reads.found.into_iter().filter(|(name, _)| names.contains(name)) {
        out.push_str(&text[at..span.start as usize]);
        out.push_str(&named(name, random.below(2)));
        at = span.end as usize;
    }
    out.push_str(&text[at..expr.span.end as usize]);
    out
}

/// A file with every body disguised.
fn disguise(text: &str, random: &mut Random) -> String {
    let tree: File = texgraph_grammar::parse(text).expect("it parses");
    let mut out = String::new();
    let mut at = 0;
    for item in &tree.items {
        let (ItemKind::Node(Node { body, .. }) | ItemKind::Texture { node: Node { body, .. }, .. }) =
            &item.kind
        else {
            continue;
        };
        out.push_str(&text[at..body.span.start as usize]);
        out.push_str(&disguised(text, body, random));
        at = body.span.end as usize;
    }
    out.push_str(&text[at..]);
    out
}

/// A text in place of a file, in its folder.
struct Edited<'a> {
    project: &'a Project,
    name: &'a str,
    text: String,
}

impl texgraph_compiler::module::Loader for Edited<'_> {
    fn load(&self, path: &str) -> Result<String, String> {
        if path == self.name { Ok(self.text.clone()) } else { self.project.load(path) }
    }
}

fn program(library: &Library, file: &Path, text: String) -> Program {
    let project = Project::new(file, true);
    let name = file.file_name().and_then(|name| name.to_str()).expect("names are UTF-8");
    let loader = Edited { project: &project, name, text };
    compile(library, project.main(), &loader, &Options::default())
        .unwrap_or_else(|f| panic!("{}\n{}", loader.text, render::human(&f.sources, &f.diagnostics)))
        .program
}

/// How many operations of each kind a program has, by its name in the graph's dump.
fn operations(program: &Program) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for line in program
        .passes
        .iter()
        .flat_map(|pass| pass.graph.to_string().lines().map(str::to_owned).collect::<Vec<_>>())
    {
        let Some((_, operation)) = line.split_once(" = ") else { continue };
        let kind = operation.split(' ').next().unwrap_or_default();
        if !kind.starts_with('%') {
            *counts.entry(kind.to_owned()).or_insert(0) += 1;
        }
    }
    counts
}

fn pictures(file: &Path, program: &mut Program) -> HashMap<String, Vec<[f32; 4]>> {
    let project = Project::new(file, true);
    let tables = resource::load(program, &project).expect("the resources load");
    let outputs = program.manifest.outputs.iter().enumerate();
    let render = |output| {
        let request = Request { time: 1.25, output, ..Request::new([SIDE, SIDE]) };
        cpu::render(program, &tables, &request, &|_| {}).expect("it renders").pixels
    };
    outputs.map(|(i, output)| (output.name.clone(), render(i))).collect()
}

#[test]
fn names_order_and_repetition_have_no_meaning() {
    let library = Library::standard().expect("the library parses");
    for file in files() {
        let text = std::fs::read_to_string(&file).expect("it can be read");
        let mut plain = program(&library, &file, text.clone());
        let expected = pictures(&file, &mut plain);
        for seed in 0..3 {
            let other = disguise(&text, &mut Random(seed));
            assert_ne!(other, text);
            let mut other = program(&library, &file, other);
            assert_eq!(operations(&other), operations(&plain), "{}", file.display());
            let found = pictures(&file, &mut other);
            assert!(found == expected, "{}, seed {seed}: another picture", file.display());
        }
    }
}
