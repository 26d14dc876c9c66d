//! How long compiling takes: the mixed graph at four sizes, from text to validated WGSL, beside the
//! same graph as WGSL text through naga (parse, validate, write) and beside the floor that naga
//! sets (validate and write the module of the same program). Run with
//! `cargo bench -p texgraph-compiler`; a table with ratios and bounds is printed at the end.

#[path = "mixed/mod.rs"]
mod mixed;

use criterion::{BenchmarkId, Criterion, Throughput};
use mixed::Mixed;
use naga::back::wgsl::{WriterFlags, write_string};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::HashMap;
use std::hint::black_box;
use std::time::{Duration, Instant};
use texgraph_compiler::lower::{Objects, lower};
use texgraph_compiler::{Compiled, Library, Options, compile};

/// The allocator of the command.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const TILING: &str = include_str!("../../examples/tiling.tex");
const SIZES: [usize; 4] = [10, 100, 1_000, 10_000];

/// A file ready to be compiled.
struct Text {
    files: HashMap<String, String>,
}

impl Text {
    fn new(text: impl Into<String>) -> Text {
        Text { files: [("main.tex".to_owned(), text.into())].into() }
    }

    fn compiled(&self, library: &Library) -> Compiled {
        match compile(library, "main.tex", &self.files, &Options::default()) {
            Ok(compiled) => compiled,
            Err(failure) => panic!("it does not compile: {:?}", failure.diagnostics),
        }
    }
}

fn library() -> Library {
    Library::standard().expect("the library parses")
}

/// The module of a compiled texture.
fn module_of(compiled: &Compiled) -> naga::Module {
    lower(&compiled.program.texture().graph, &compiled.program.manifest, &Objects::default()).module
}

fn validated_and_written(module: &naga::Module) -> String {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator.validate(module).expect("the module is valid");
    write_string(module, &info, WriterFlags::empty()).expect("a valid module can be written")
}

fn through_naga(text: &str) -> String {
    validated_and_written(&naga::front::wgsl::parse_str(text).expect("it is WGSL"))
}

fn measure(c: &mut Criterion) {
    c.bench_function("library", |b| b.iter(|| black_box(library())));
    let library = library();
    let tiling = Text::new(TILING);
    c.bench_function("tiling.tex", |b| b.iter(|| black_box(tiling.compiled(&library))));
    let mut group = c.benchmark_group("mixed");
    for nodes in SIZES {
        let graph = Mixed::new(nodes);
        let text = Text::new(mixed::tex(&graph));
        let wgsl = mixed::wgsl(&graph);
        let module = module_of(&text.compiled(&library));
        group.throughput(Throughput::Elements(nodes as u64));
        group.sample_size(if nodes > 1_000 { 10 } else { 50 });
        group.bench_function(BenchmarkId::new("tex to WGSL", nodes), |b| {
            b.iter(|| black_box(text.compiled(&library)));
        });
        group.bench_function(BenchmarkId::new("WGSL through naga", nodes), |b| {
            b.iter(|| black_box(through_naga(&wgsl)));
        });
        group.bench_function(BenchmarkId::new("the floor, validate and write", nodes), |b| {
            b.iter(|| black_box(validated_and_written(&module)));
        });
    }
    group.finish();
}

/// The least of several runs, for about half a second: what the machine can do when nobody else
/// wants it.
fn least(mut work: impl FnMut()) -> Duration {
    let start = Instant::now();
    let mut least = Duration::MAX;
    while start.elapsed() < Duration::from_millis(500) || least == Duration::MAX {
        let once = Instant::now();
        work();
        least = least.min(once.elapsed());
    }
    least
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// The same again as a table. The three of a row are measured one after another, so load on the
/// machine hits them alike.
fn table() {
    println!("\nleast of the runs of half a second, ms");
    println!("library, once: {:.2} (bound 10)", milliseconds(least(|| drop(black_box(library())))));
    println!("  nodes  tex to WGSL   bound  naga text  times ours  floor  WGSL bytes");
    let library = library();
    let mut last = None;
    for nodes in SIZES {
        let graph = Mixed::new(nodes);
        let text = Text::new(mixed::tex(&graph));
        let wgsl = mixed::wgsl(&graph);
        let compiled = text.compiled(&library);
        let module = module_of(&compiled);
        let ours = milliseconds(least(|| drop(black_box(text.compiled(&library)))));
        let naga = milliseconds(least(|| drop(black_box(through_naga(&wgsl)))));
        let floor = milliseconds(least(|| drop(black_box(validated_and_written(&module)))));
        let bound = match nodes {
            10 => "0.25".to_owned(),
            1_000 => "4.40".to_owned(),
            10_000 => last.map_or(String::new(), |last: f64| format!("{:.1}", last * 12.0)),
            _ => String::new(),
        };
        let bytes = compiled.program.texture().wgsl.len();
        println!(
            "{nodes:7}  {ours:11.3}  {bound:>6}  {naga:9.3}  {:10.2}  {floor:5.2}  {bytes:10}",
            naga / ours
        );
        last = Some(ours);
    }
    println!("naga's text is to take at least 3 times as long at 1,000 nodes");
}

fn main() {
    // `--table` prints the table only.
    if !std::env::args().any(|argument| argument == "--table") {
        let mut criterion = Criterion::default().configure_from_args();
        measure(&mut criterion);
        criterion.final_summary();
    }
    table();
}
