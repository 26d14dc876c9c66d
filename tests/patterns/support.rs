//! Texts drawn by the CPU renderer.

use std::collections::HashMap;
use std::path::Path;
use texgraph_compiler::cost::{Counts, cost};
use texgraph_compiler::{Compiled, Library, Options, compile, diagnostic::render};
use texgraph_runtime::cpu;
use texgraph_runtime::project::Project;
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::{Tables, load};
use texgraph_runtime::settings::Settings;

/// What stands before each text: sixteen patterns.
pub const GRASS: &str = "let grass = patterns(\"tiles/grass.png\", grid: ivec2(4, 4))\n";

/// A program with the bytes of its tables.
pub struct Drawing {
    compiled: Compiled,
    tables: Tables,
}

impl Drawing {
    /// Of a text that has one texture and reads its files in examples/.
    pub fn of(text: &str) -> Drawing {
        Drawing::beside(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples"), text)
    }

    /// Of a text that reads its files in a folder.
    pub fn beside(folder: &Path, text: &str) -> Drawing {
        Drawing::output(folder, text, None)
    }

    /// The same, but only an output of its texture.
    pub fn output(folder: &Path, text: &str, output: Option<&str>) -> Drawing {
        let files: HashMap<String, String> = [("main.tex".to_owned(), text.to_owned())].into();
        let library = Library::standard().expect("the library is right");
        let outputs = output.map(|output| vec![output.to_owned()]);
        let mut compiled = compile(&library, "main.tex", &files, &Options { outputs, ..Options::default() })
            .unwrap_or_else(|f| panic!("{}", render::human(&f.sources, &f.diagnostics)));
        let tables = load(&mut compiled.program, &Project::new(&folder.join("main.tex"), false))
            .unwrap_or_else(|found| panic!("{}", render::human(&compiled.sources, &found)));
        Drawing { compiled, tables }
    }

    /// The first output at a pixel for each of `cells` a side, row by row.
    pub fn cells(&self, cells: u32) -> Vec<[f32; 4]> {
        self.seen([cells; 2], [0.0, 0.0, 1.0, 1.0])
    }

    /// The first output of a region of `uv`.
    pub fn seen(&self, size: [u32; 2], region: [f64; 4]) -> Vec<[f32; 4]> {
        self.seen_with("", size, region)
    }

    /// The same with a param set, `name=value`.
    pub fn seen_with(&self, setting: &str, size: [u32; 2], region: [f64; 4]) -> Vec<[f32; 4]> {
        let mut settings = Settings::new();
        if !setting.is_empty() {
            settings.parse(&self.compiled.program.manifest, setting).expect("it can be set");
        }
        let request = Request { region, settings, ..Request::new(size) };
        let picture = cpu::render(&self.compiled.program, &self.tables, &request, &|_| {});
        picture.unwrap_or_else(|error| panic!("{error}")).pixels
    }

    /// What a pixel takes at most.
    pub fn worst(&self) -> Counts {
        cost(&self.compiled).texture().map(|pass| pass.worst).unwrap_or_default()
    }
}

/// The pages of what is wrong with a text.
pub fn errors(text: &str) -> String {
    let files: HashMap<String, String> = [("main.tex".to_owned(), text.to_owned())].into();
    let library = Library::standard().expect("the library is right");
    let failure = compile(&library, "main.tex", &files, &Options::default()).expect_err("it is wrong");
    render::human(&failure.sources, &failure.diagnostics)
}

/// How far a count of `n` draws of probability `p` is from the expected one, in standard deviations.
pub fn deviations(count: usize, n: usize, p: f64) -> f64 {
    let (n, spread) = (n as f64, (n as f64 * p * (1.0 - p)).sqrt());
    let off = (count as f64 - n * p).abs();
    if off == 0.0 { 0.0 } else { off / spread }
}
