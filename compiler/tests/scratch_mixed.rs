#[path = "../benches/mixed/mod.rs"]
mod mixed;
use mixed::Mixed;
use std::collections::HashMap;
use std::time::*;
use texgraph_compiler::{Library, Options, compile};
#[test]
fn go() {
    let n: usize = std::env::var("N").unwrap().parse().unwrap();
    let r: usize = std::env::var("R").unwrap().parse().unwrap();
    let library = Library::standard().unwrap();
    let files: HashMap<String, String> =
        [("main.tex".to_owned(), mixed::tex(&Mixed::new(n)).to_string())].into();
    let mut least = f64::MAX;
    let mut values = 0;
    for _ in 0..r {
        let t = Instant::now();
        let c = compile(&library, "main.tex", &files, &Options::default()).ok().unwrap();
        least = least.min(t.elapsed().as_secs_f64() * 1e3);
        values = c.program.texture().graph.functions.iter().map(|f| f.values.len()).sum::<usize>();
    }
    eprintln!("N {n}: {least:.3} ms, {values} values");
}
