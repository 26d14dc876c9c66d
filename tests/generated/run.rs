//! Generated programs and mutants, by the thousand: what `tests/generated.rs` does with a few.
//!
//! ```text
//! cargo run --release --example generated                          the whole budget
//! cargo run --release --example generated -- --seed 1608           one program again, with its text
//! cargo run --release --example generated -- --mutant 77           one mutant again
//! cargo run --release --example generated -- --shaders FOLDER      and the shaders, for tests/tint
//! ```
//!
//! Prints a hash over all shaders and manifests of the programs: it is the same for any number of
//! threads, in debug and in release.

#[path = "mod.rs"]
mod generated;

use clap::Parser;
use generated::choices::Choices;
use generated::corpus::Corpus;
use generated::features::Features;
use generated::hash::Hash;
use generated::judge::{self, Depth, Outcome};
use generated::mutant::mutant;
use generated::pool::{self, Report};
use generated::program::{Known, Program, program};
use std::collections::HashSet;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use texgraph_compiler::Library;

/// Compiles generated programs and mutants, and says what is wrong.
#[derive(Parser)]
struct Arguments {
    /// Well-typed random programs, from seed 0.
    #[arg(long, default_value_t = 10_000)]
    programs: u64,
    /// Mutants of the repository's programs, from seed 0.
    #[arg(long, default_value_t = 100_000)]
    mutants: u64,
    /// As many as the machine has when not given.
    #[arg(long)]
    threads: Option<usize>,
    /// Writes the different shaders to files of a thousand in this folder.
    #[arg(long)]
    shaders: Option<PathBuf>,
    /// One program: its text, and what is wrong with it.
    #[arg(long)]
    seed: Option<u64>,
    /// One mutant: its text, and what is wrong with it.
    #[arg(long, conflicts_with = "seed")]
    mutant: Option<u64>,
    /// The whole language, as the grammar reads it.
    #[arg(long)]
    all_features: bool,
}

/// Failures that are shown.
const SHOWN: usize = 10;

struct Bench {
    library: Library,
    known: Known,
    corpus: Corpus,
    features: Features,
}

/// What a job has to show.
#[derive(Default)]
struct Made {
    parses: bool,
    checks: bool,
    /// Why it is refused.
    page: String,
    hash: Hash,
    /// Each with a hash of its own.
    shaders: Vec<(Hash, String, String)>,
}

fn main() -> Result<(), String> {
    let arguments = Arguments::parse();
    let library = Library::standard()?;
    let known = Known::new(&library);
    let features = if arguments.all_features { Features::ALL } else { Features::NOW };
    let bench = Bench { library, known, corpus: Corpus::read()?, features };
    if let Some(seed) = arguments.seed {
        println!("{}", bench.program(seed).text());
        return bench.judge_program(seed).map(drop);
    }
    if let Some(seed) = arguments.mutant {
        println!("{}", bench.mutant(seed).1);
        return bench.judge_mutant(seed).map(|made| println!("{}", made.page));
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = arguments.threads.unwrap_or(cores).max(1);
    let mut shaders = Shaders::new(arguments.shaders.clone());
    let programs = pool::run(arguments.programs, threads, |seed| bench.judge_program(seed));
    let mutants = pool::run(arguments.mutants, threads, |seed| bench.judge_mutant(seed));
    for (option, report) in [("seed", &programs), ("mutant", &mutants)] {
        say(option, report);
        shaders.add(option, report)?;
    }
    println!("{} different shaders", shaders.seen.len());
    let hashes = |count: usize| {
        programs.results.iter().take(count).fold(Hash::default(), |sum, made| {
            sum.with(&made.as_ref().map_or(0, |made| made.hash.number()).to_le_bytes())
        })
    };
    for count in [500, programs.results.len()] {
        println!("hash of {} programs: {}", count.min(programs.results.len()), hashes(count));
    }
    let failures = programs.failures.len() + mutants.failures.len();
    if failures == 0 { Ok(()) } else { Err(format!("{failures} failures")) }
}

impl Bench {
    fn program(&self, seed: u64) -> Program {
        program(&mut Choices::Seed(seed), self.features, &self.known)
    }

    fn judge_program(&self, seed: u64) -> Result<Made, String> {
        let Program { files, main } = self.program(seed);
        files.values().try_for_each(|text| judge::formats(text, Depth::Most).map(drop))?;
        let outcome = judge::compiles(&self.library, &main, &files, true, Depth::Most)?;
        Ok(made(true, outcome))
    }

    fn mutant(&self, seed: u64) -> (usize, String) {
        mutant(&mut Choices::Seed(seed), &self.corpus.texts())
    }

    fn judge_mutant(&self, seed: u64) -> Result<Made, String> {
        let (which, text) = self.mutant(seed);
        let parses = judge::formats(&text, Depth::Most)?;
        let (main, files) = self.corpus.with(self.corpus.paths()[which], &text);
        let outcome = judge::compiles(&self.library, main, &files, false, Depth::Most)?;
        Ok(made(parses, outcome))
    }
}

fn made(parses: bool, outcome: Outcome) -> Made {
    let shaders = match outcome {
        Outcome::Shaders(shaders) => shaders,
        Outcome::Refused(page) => return Made { parses, page, ..Made::default() },
    };
    let mut made = Made { parses, checks: true, ..Made::default() };
    for shader in shaders {
        made.hash = made.hash.with(shader.wgsl.as_bytes()).with(shader.manifest.as_bytes());
        made.shaders.push((Hash::default().with(shader.wgsl.as_bytes()), shader.name, shader.wgsl));
    }
    made
}

fn say(option: &str, report: &Report<Made>) {
    let count = |holds: fn(&Made) -> bool| report.results.iter().flatten().filter(|made| holds(made)).count();
    println!(
        "{} by --{option}: {} parse, {} check, {} fail; the slowest, {}, took {:.2} s",
        report.results.len(),
        count(|made| made.parses),
        count(|made| made.checks),
        report.failures.len(),
        report.slowest.0,
        report.slowest.1.as_secs_f64(),
    );
    for (seed, why) in report.failures.iter().take(SHOWN) {
        println!("\n---- --{option} {seed}\n{why}");
    }
}

/// The different shaders, written to files in which each stands behind a line `//// NAME`.
struct Shaders {
    folder: Option<PathBuf>,
    seen: HashSet<Hash>,
    file: Option<BufWriter<File>>,
}

impl Shaders {
    fn new(folder: Option<PathBuf>) -> Shaders {
        Shaders { folder, seen: HashSet::new(), file: None }
    }

    fn add(&mut self, option: &str, report: &Report<Made>) -> Result<(), String> {
        for (seed, made) in report.results.iter().enumerate() {
            for (hash, name, wgsl) in made.iter().flat_map(|made| &made.shaders) {
                if self.seen.insert(*hash) {
                    self.write(&format!("--{option} {seed}, {name}"), wgsl).map_err(|why| why.to_string())?;
                }
            }
        }
        Ok(())
    }

    fn write(&mut self, name: &str, wgsl: &str) -> std::io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        if self.seen.len() % 1_000 == 1 {
            std::fs::create_dir_all(folder)?;
            let path = folder.join(format!("{:04}.shaders", self.seen.len() / 1_000));
            self.file = Some(BufWriter::new(File::create(path)?));
        }
        match &mut self.file {
            Some(file) => write!(file, "//// {name}\n{wgsl}\n"),
            None => Ok(()),
        }
    }
}
