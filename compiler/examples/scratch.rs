use std::collections::HashMap;
fn main() {
    let lib = texgraph_compiler::Library::standard().unwrap();
    let path = std::env::args().nth(1).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let loader: HashMap<String,String> = [("main.tex".to_string(), text)].into();
    let mut options = texgraph_compiler::Options::default();
    if std::env::args().nth(2).as_deref() == Some("lib") { options.form = texgraph_compiler::Form::Library; }
    options.texture = std::env::args().nth(3);
    let t = std::time::Instant::now();
    match texgraph_compiler::compile(&lib, "main.tex", &loader, &options) {
        Ok(c) => { eprintln!("{:?}", t.elapsed()); println!("{}\n{}", c.program.graph, c.program.wgsl) }
        Err(f) => println!("{:?} {}", t.elapsed(), texgraph_compiler::diagnostic::render::human(&f.sources, &f.diagnostics)),
    }
}
