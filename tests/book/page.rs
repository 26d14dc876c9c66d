//! The pages: what the doc comments of a file of the library say.

use std::collections::BTreeSet;
use std::fmt::Write;
use texgraph_compiler::Library;
use texgraph_compiler::intrinsic::Intrinsic;
use texgraph_grammar::parse;
use texgraph_grammar::syntax::{Item, ItemKind};

/// A file of the library with the one of tests/nodes that draws its nodes.
pub struct Group {
    /// The files' name, without extension.
    pub name: String,
    /// What it is about.
    doc: String,
    nodes: Vec<Entry>,
    examples: Vec<(String, String)>,
}

/// A node that programs can call.
struct Entry {
    name: String,
    signature: String,
    doc: String,
}

/// All files of the library, by name.
pub fn groups() -> Vec<Group> {
    let library = Library::standard().expect("the library is right");
    let mut groups: Vec<Group> = library.modules().iter().map(|module| group(&module.path)).collect();
    groups.retain(|group| !group.nodes.is_empty());
    groups.sort_by(|a, b| a.name.cmp(&b.name));
    groups
}

fn group(path: &str) -> Group {
    let name = path.trim_start_matches("std/").trim_end_matches(".tex").to_owned();
    let read = |file: String| std::fs::read_to_string(crate::root().join(file)).unwrap_or_default();
    let text = read(format!("compiler/{path}"));
    let drawn = read(format!("tests/nodes/{name}.tex"));
    let tree = parse(&text).expect("the library parses");
    let nodes = tree.items.iter().filter_map(|item| entry(item, &text)).collect();
    let examples = parse(&drawn).map(|tree| examples(&tree.items, &drawn)).unwrap_or_default();
    Group { name, doc: tree.doc.clone(), nodes, examples }
}

fn entry(item: &Item, text: &str) -> Option<Entry> {
    let ItemKind::Node(node) = &item.kind else { return None };
    let name = node.name.text.to_string();
    let source = &text[item.span.start as usize..item.span.end as usize];
    let head = source.split(" {\n").next().unwrap_or(source);
    let signature = head.trim_start_matches("node ").to_owned();
    (!name.starts_with('_')).then(|| Entry { name, signature, doc: item.doc.clone() })
}

/// The textures of a file and their texts.
fn examples(items: &[Item], text: &str) -> Vec<(String, String)> {
    let textures = items.iter().filter_map(|item| match &item.kind {
        ItemKind::Texture { node, .. } => Some((node.name.text.to_string(), item.span)),
        _ => None,
    });
    textures.map(|(name, span)| (name, text[span.start as usize..span.end as usize].to_owned())).collect()
}

impl Group {
    /// The names of its nodes, each once, as they stand there.
    pub fn nodes(&self) -> Vec<String> {
        let mut seen = BTreeSet::new();
        self.nodes.iter().map(|node| node.name.clone()).filter(|name| seen.insert(name.clone())).collect()
    }

    /// The page.
    pub fn text(&self) -> String {
        let (title, rest) = first_sentence(&self.doc);
        let mut page = format!("# {}\n\n{title}{rest}\n", self.name);
        for name in self.nodes() {
            let _ = write!(page, "\n## {name}\n");
            for node in self.nodes.iter().filter(|node| node.name == name) {
                let _ = write!(page, "\n```text\n{}\n```\n\n{}\n", node.signature, node.doc);
            }
            let _ = write!(page, "\n![{name}](images/{}/{name}.jpg)\n", self.name);
            let alone = format!("{name}_alone");
            if let Some((_, text)) = self.examples.iter().find(|(texture, _)| *texture == alone) {
                let _ = write!(page, "\n```tex\n{}\n```\n", text.trim_end());
            }
        }
        page
    }
}

/// The first sentence of a text, and what follows.
fn first_sentence(text: &str) -> (&str, &str) {
    let end = text.find(". ").or_else(|| text.find(".\n")).map_or(text.len(), |end| end + 1);
    text.split_at(end)
}

/// The list of all pages.
pub fn contents(groups: &[Group]) -> String {
    let mut page = "# The library\n\nEvery node with its signature, a picture and the text that draws it. Made from the doc comments of\n`compiler/std` by `TEXGRAPH_BOOK=write cargo test --test book`.\n\n| page | nodes |\n| --- | --- |\n".to_owned();
    for group in groups {
        let nodes: Vec<String> =
            group.nodes().iter().map(|node| format!("[{node}]({}.md#{node})", group.name)).collect();
        let _ = writeln!(page, "| [{0}]({0}.md) | {1} |", group.name, nodes.join(", "));
    }
    page + "| [intrinsics](intrinsics.md) | what is not written in the language |\n"
}

/// The page of what is not written in the language.
pub fn intrinsics() -> String {
    let mut page = "# Intrinsics\n\nOperators and functions that are not written in the language, by what they take. A guard that no row\nneeds is dropped when compiling.\n\n| name | signature | value |\n| --- | --- | --- |\n".to_owned();
    for intrinsic in Intrinsic::all().filter(|intrinsic| intrinsic.is_callable()) {
        let row = intrinsic.row();
        let cell = |text: &str| text.replace('|', "\\|");
        let _ = writeln!(page, "| `{}` | `{}` | {} |", cell(row.name), cell(row.signature), cell(row.doc));
    }
    page
}
