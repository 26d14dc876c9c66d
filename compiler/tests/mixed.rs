//! The mixed graph: what the bench compiles is right, and the WGSL of ten nodes is about as short as
//! a careful author's.

#[path = "../benches/mixed/mod.rs"]
mod mixed;

use mixed::{Kind, Mixed};
use naga::back::wgsl::{WriterFlags, write_string};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::HashMap;
use texgraph_compiler::{Compiled, Library, Options, compile};

const SIZES: [usize; 4] = [10, 100, 1_000, 10_000];
/// Ours over the hand-written text as naga writes it.
const LONGEST: f64 = 1.25;

fn compiled(graph: &Mixed) -> Compiled {
    let library = Library::standard().expect("the library parses");
    let files: HashMap<String, String> = [("mixed.tex".to_owned(), mixed::tex(graph))].into();
    match compile(&library, "mixed.tex", &files, &Options::default()) {
        Ok(compiled) => compiled,
        Err(failure) => panic!("{} nodes: {:?}", graph.nodes.len(), failure.diagnostics),
    }
}

/// A text as naga writes it.
fn rewritten(text: &str) -> String {
    let module = naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(&module).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
    write_string(&module, &info, WriterFlags::empty()).expect("naga writes what it has validated")
}

#[test]
fn every_size_compiles_in_canonical_layout() {
    for nodes in SIZES {
        let graph = Mixed::new(nodes);
        assert_eq!(graph.nodes.len(), nodes);
        let text = mixed::tex(&graph);
        assert_eq!(texgraph_grammar::format(&text).as_deref(), Ok(text.as_str()));
        let program = compiled(&graph).program;
        let wgsl = &program.texture().wgsl;
        // What came out holds the whole graph: a fetch for each image, a call for each hex tiling.
        let images = graph.nodes.iter().filter(|node| matches!(node, Kind::Image(..))).count();
        assert_eq!(wgsl.matches("textureSampleGrad(").count(), images + 1, "and the hexagon's");
    }
}

#[test]
fn every_size_is_a_module_that_naga_takes() {
    for nodes in SIZES {
        let text = rewritten(&mixed::wgsl(&Mixed::new(nodes)));
        assert!(text.contains("fn mixed_fragment("));
    }
}

#[test]
fn every_size_is_a_document_of_as_many_elements() {
    for nodes in SIZES {
        let graph = Mixed::new(nodes);
        let text = mixed::materialx(&graph);
        let (opened, closed) = (text.matches("\n    <").count(), text.matches("\n    </").count());
        // The coordinate and the output are elements too, and means of what is left over.
        assert_eq!(
            (opened - closed, closed),
            (nodes + 2 + graph.ends.len() - 1, nodes + graph.ends.len() - 1)
        );
    }
}

#[test]
fn few_nodes_are_dead() {
    for nodes in SIZES {
        let graph = Mixed::new(nodes);
        let mut live = vec![false; nodes];
        graph.ends.iter().for_each(|end| live[*end] = true);
        for i in (0..nodes).rev() {
            if live[i] {
                graph.nodes[i].operands().into_iter().for_each(|operand| live[operand] = true);
            }
        }
        let dead = live.iter().filter(|live| !**live).count();
        assert!(dead * 50 <= nodes, "{dead} of {nodes}");
    }
}

#[test]
fn the_example_is_the_graph_of_ten_nodes() {
    assert_eq!(include_str!("../../examples/mixed.tex"), mixed::tex(&Mixed::new(10)));
}

#[test]
fn ten_nodes_are_as_short_as_by_hand() {
    let ours = compiled(&Mixed::new(10)).program.texture().wgsl.len();
    let by_hand = rewritten(mixed::HAND_WRITTEN).len();
    let ratio = ours as f64 / by_hand as f64;
    println!("ours {ours} bytes, by hand {by_hand} bytes as naga writes it: {ratio:.2}");
    assert!(ratio <= LONGEST, "{ours} bytes are {ratio:.2} times {by_hand}");
}
