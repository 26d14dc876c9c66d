//! Writes `rows.rs`: each row as the steps that the planner makes of a node.
//!
//! `TEXGRAPH_FUSED=write cargo test -p texgraph-runtime fused` writes it anew.

use super::super::plan::{Plan, Planned};
use super::super::planner::Fuse;
use super::super::texture;
use super::range::{Range, ranges};
use super::shape::{Operand, Operation, Shape};
use super::{MOST_ARGUMENTS, MOST_OUTPUTS, ROWS, Rows};
use crate::pass;
use crate::render::Request;
use crate::resource::Tables;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Write;
use std::path::Path;
use texgraph_compiler::graph::Scalar;
use texgraph_compiler::intrinsic::{Evaluate, HASH4, Intrinsic, LANES, Lanes, MULTIPLY, TO_INT, ZERO};
use texgraph_compiler::module::Loader;
use texgraph_compiler::{Library, Options, Program, compile};

/// A use of a library node, and the function in it that becomes a row. `SEED` and `PERIOD` are free.
struct Form {
    /// The function.
    node: &'static str,
    /// The use, of a place `p`.
    text: &'static str,
    /// How many dimensions the place has.
    dimensions: &'static [usize],
}

const FORMS: &[Form] = &[
    Form { node: "_noise", text: "noise(p, seed: SEED)", dimensions: &[1, 2, 3, 4] },
    Form { node: "_value_noise", text: "value_noise(p, seed: SEED)", dimensions: &[1, 2, 3, 4] },
    Form { node: "_simplex", text: "simplex(p, seed: SEED)", dimensions: &[1, 2, 3, 4] },
    Form { node: "_close", text: "worley(p, seed: SEED)", dimensions: &[2, 3] },
    Form { node: "_close", text: "voronoi(p, seed: SEED).f1", dimensions: &[2, 3] },
    Form { node: "_close", text: "voronoi(p, search: near, seed: SEED).f1", dimensions: &[2, 3] },
    Form { node: "_close", text: "voronoi(p, seed: SEED).color.r", dimensions: &[2, 3] },
    Form { node: "_better", text: "worley(p, seed: SEED)", dimensions: &[2, 3] },
    Form { node: "_better", text: "voronoi(p, seed: SEED).f1", dimensions: &[2, 3] },
    Form { node: "_better", text: "voronoi(p, seed: SEED).color.r", dimensions: &[2, 3] },
];

/// A row to be written.
struct Made {
    node: &'static str,
    title: String,
    shape: Shape,
    free: Vec<Vec<u16>>,
}

impl Made {
    fn hash(&self) -> u128 {
        self.shape.hash(&self.free.iter().map(Vec::as_slice).collect::<Vec<_>>())
    }
}

fn compiled(library: &Library, form: &Form, dimensions: usize, seed: i32, period: i32) -> Program {
    let place = match dimensions {
        1 => "uv.x * 32.0",
        2 => "uv * 32.0",
        3 => "vec3(uv, uv.x) * 32.0",
        _ => "vec4(uv, uv) * 32.0",
    };
    let text = form.text.replace("SEED", &seed.to_string()).replace("PERIOD", &period.to_string());
    let text = format!("texture t(uv: vec2) -> (height: float) {{\n let p = {place}\n height = {text}\n}}");
    let files: HashMap<String, String> = [("t.tex".to_owned(), text)].into();
    let compiled = compile(library, "t.tex", &files as &dyn Loader, &Options::default());
    compiled.unwrap_or_else(|failure| panic!("{}: {:?}", form.text, failure.diagnostics)).program
}

/// Keeps the shapes of functions of a name.
struct Found {
    node: &'static str,
    shapes: Vec<Shape>,
}

impl Fuse for Found {
    fn knows(&self, name: &str) -> bool {
        name == self.node
    }

    fn fuse(&mut self, _: &str, planned: &mut Planned, known: &[Lanes], _: &mut usize) -> bool {
        self.shapes.push(Shape::of(planned, known).expect("it is arithmetic alone"));
        false
    }
}

/// Plans a program.
fn plan(program: &Program, fuse: &mut dyn Fuse) {
    let pass = pass::texture(program).expect("it has a pass");
    let graph = super::super::only(&pass.code.graph, 0);
    let textures = texture::decode_all(&pass, &[], &Tables::default()).expect("it has no textures");
    Plan::new(&pass, &graph, &Request::new([64, 64]), &textures, fuse).expect("it is small");
}

/// The shapes of a program's functions of that name.
fn shapes(program: &Program, node: &'static str) -> Vec<Shape> {
    let mut found = Found { node, shapes: Vec::new() };
    plan(program, &mut found);
    found.shapes
}

/// All rows.
fn made() -> Vec<Made> {
    let library = Library::standard().expect("the library parses");
    let mut made = Vec::new();
    for form in FORMS {
        for n in form.dimensions {
            let [some, others] = [(7_316, 37), (-90_281, 53)].map(|(seed, period)| {
                let shapes = shapes(&compiled(&library, form, *n, seed, period), form.node);
                assert!(!shapes.is_empty(), "{} has no {}", form.text, form.node);
                shapes
            });
            for (shape, other) in some.into_iter().zip(others) {
                assert_eq!(shape.operations, other.operations, "{}", form.text);
                assert_eq!(shape.outputs, other.outputs, "{}", form.text);
                let mut free: BTreeMap<[u32; 2], Vec<u16>> = BTreeMap::new();
                for (place, (one, two)) in shape.constants.iter().zip(&other.constants).enumerate() {
                    if one.1 != two.1 {
                        free.entry([one.1, two.1]).or_default().push(place as u16);
                    }
                }
                let mut free: Vec<Vec<u16>> = free.into_values().collect();
                free.sort();
                assert!(shape.inputs + free.len() <= MOST_ARGUMENTS && shape.outputs.len() <= MOST_OUTPUTS);
                let title = form.text.replace("SEED", "_").replace("PERIOD", "_");
                let new = Made { node: form.node, title: format!("`{title}` in {n}D"), shape, free };
                if made.iter().all(|old: &Made| old.hash() != new.hash()) {
                    made.push(new);
                }
            }
        }
    }
    made
}

/// An int that is cut out of a hash: of `int(hash(…).x * 2.0ⁿ)` the n upper bits of the word that the
/// number is made of.
struct Pick<'a> {
    words: &'a [Operand],
    component: u32,
    bits: u32,
}

/// The picks of a shape, by their values.
fn picks<'a>(shape: &'a Shape, free: &[Vec<u16>]) -> HashMap<u32, Pick<'a>> {
    let made = |value: Operand| {
        let Operand::Value(value) = value else { return None };
        let (operation, operands, first) = shape.operations.iter().rfind(|(.., first)| *first <= value)?;
        Some((*operation, operands.as_slice(), value - first))
    };
    let pick = |operands: &[Operand]| {
        let (Operation::Each(row), factors, _) = made(operands[0])? else { return None };
        let Operand::Constant(place) = factors[1] else { return None };
        let is_free = free.iter().any(|places| places.contains(&place));
        let power = f32::from_bits(shape.constants[usize::from(place)].1);
        let bits = (1..=24).find(|bits| power == (1_u32 << bits) as f32)?;
        let (Operation::Whole(hash, _), words, component) = made(factors[0])? else { return None };
        let is_pick = row == MULTIPLY && hash == HASH4 && !is_free;
        is_pick.then_some(Pick { words: &words[..4], component, bits })
    };
    let ints = shape.operations.iter().filter(|(operation, ..)| *operation == Operation::Each(TO_INT));
    ints.filter_map(|(_, operands, first)| Some((*first, pick(operands)?))).collect()
}

/// The values that are read, where picks read words alone.
fn read(shape: &Shape, picks: &HashMap<u32, Pick>) -> HashSet<Operand> {
    let mut read: HashSet<Operand> = shape.outputs.iter().copied().collect();
    for (operation, operands, first) in shape.operations.iter().rev() {
        let values = if matches!(operation, Operation::Whole(..)) { 4 } else { 1 };
        if (*first..first + values).any(|value| read.contains(&Operand::Value(value))) {
            read.extend(picks.get(first).map_or(operands.as_slice(), |pick| pick.words));
        }
    }
    read
}

/// The text of a row.
fn write(made: &Made, to: &mut String) {
    let Made { node, title, shape, free } = made;
    let name = |operand: &Operand| match operand {
        Operand::Input(n) => format!("p{n}"),
        Operand::Value(n) => format!("v{n}"),
        Operand::Constant(place) => match free.iter().position(|places| places.contains(place)) {
            Some(n) => format!("c{n}"),
            None => shape.constants[usize::from(*place)].1.to_string(),
        },
    };
    let arguments: Vec<String> =
        (0..shape.inputs).map(|n| format!("p{n}")).chain((0..free.len()).map(|n| format!("c{n}"))).collect();
    let places: Vec<String> = free.iter().map(|places| format!("&{places:?}")).collect();
    let hash = made.hash();
    let (inputs, operations) = (shape.inputs, shape.operations.len());
    writeln!(to, "    // {title}.\n    Row {{\n        name: {node:?},\n        inputs: {inputs},").unwrap();
    writeln!(to, "        operations: {operations},\n        hash: {hash:#034x},").unwrap();
    writeln!(to, "        free: &[{}],", places.join(", ")).unwrap();
    writeln!(to, "        run: |arguments, mask, out| run(arguments, mask, out,").unwrap();
    writeln!(to, "            #[inline(always)]\n            |[{}]| {{", arguments.join(", ")).unwrap();
    let ranges = ranges(shape, free);
    let range = |ranges: &[Range], operand: Operand| match operand {
        Operand::Value(n) => ranges[n as usize].clone(),
        _ => Range::any(),
    };
    let picks = picks(shape, free);
    let read = read(shape, &picks);
    let is_read = |value: u32| read.contains(&Operand::Value(value));
    for (operation, operands, first) in &shape.operations {
        let values = if matches!(operation, Operation::Whole(..)) { 4 } else { 1 };
        let values: Vec<u32> = (*first..first + values).collect();
        if !values.iter().any(|value| is_read(*value)) {
            continue;
        }
        let of: Vec<String> = operands.iter().map(name).collect();
        // A float that may be infinite is made finite, as its row says.
        let may = |value: u32| !ranges[value as usize].is_finite();
        let line = match operation {
            _ if picks.contains_key(first) => {
                let Pick { words, component, bits } = &picks[first];
                let words: Vec<String> = words.iter().map(name).collect();
                format!("let v{first} = pcg4d([{}])[{component}] >> {};", words.join(", "), 32 - bits)
            }
            Operation::Select => format!("let v{first} = choose({});", of.join(", ")),
            // What is whole already need not be rounded, what is small not be clamped.
            Operation::Each(row) if row.row().name == "(int)" && range(&ranges, operands[0]).is_whole() => {
                let range = range(&ranges, operands[0]);
                let of_what = if range.is_below(4_194_304.0) { "small_int" } else { "whole_int" };
                format!("let v{first} = {of_what}({});", of[0])
            }
            Operation::Each(row) => {
                let call = format!(
                    "const {{ each({:?}, {}) }}([{}])",
                    row.row().name,
                    overload(*row),
                    of.join(", ")
                );
                if row.row().value.scalar() == Some(Scalar::Float) && may(*first) {
                    format!("let v{first} = finite({call});")
                } else {
                    format!("let v{first} = {call};")
                }
            }
            Operation::Whole(row, width) => {
                let name = |value: &u32| if is_read(*value) { format!("v{value}") } else { "_".to_owned() };
                let names: Vec<String> = values.iter().map(name).collect();
                let mut line = format!(
                    "let [{}] = const {{ whole({:?}, {}) }}({width}, [[{}], [{}]]);",
                    names.join(", "),
                    row.row().name,
                    overload(*row),
                    of[..4].join(", "),
                    of[4..].join(", ")
                );
                if row.row().value.scalar() == Some(Scalar::Float) && may(*first) {
                    for v in values.iter().filter(|v| is_read(**v)) {
                        line += &format!(" let v{v} = finite(v{v});");
                    }
                }
                line
            }
        };
        writeln!(to, "                {line}").unwrap();
    }
    let outputs: Vec<String> = shape.outputs.iter().map(name).collect();
    writeln!(to, "                [{}]\n            }}),\n    }},", outputs.join(", ")).unwrap();
}

/// The file is what the library's nodes make of it.
#[test]
fn rows_are_up_to_date() {
    let mut text = String::from(
        "//! Made by `write` of the library's nodes; not to be edited.\n\n\
         use super::{Row, choose, each, finite, pcg4d, run, small_int, whole, whole_int};\n\n\
         /// Every row.\npub static ROWS: &[Row] = &[\n",
    );
    made().iter().for_each(|made| write(made, &mut text));
    text += "];\n";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cpu/fused/rows.rs");
    if std::env::var_os("TEXGRAPH_FUSED").is_some_and(|value| value == "write") {
        std::fs::write(&path, &text).expect("the file can be written");
    }
    let found = std::fs::read_to_string(&path).expect("the file is there");
    assert!(found == text, "rows.rs is stale: run this test with TEXGRAPH_FUSED=write");
}

/// Which of the rows with its name a row is.
fn overload(row: Intrinsic) -> usize {
    let name = row.row().name;
    Intrinsic::all().take_while(|other| *other != row).filter(|other| other.row().name == name).count()
}

/// What an operation is worth, by the intrinsics' table.
fn value(operation: Operation, words: &[u32]) -> Vec<u32> {
    match operation {
        Operation::Select => vec![if words[0] != 0 { words[1] } else { words[2] }],
        Operation::Each(row) => match row.row().value {
            Evaluate::Each { one, .. } => vec![one([words[0], words[1], words[2]])],
            Evaluate::Whole { .. } => unreachable!(),
        },
        Operation::Whole(row, width) => match row.row().value {
            Evaluate::Whole { all, .. } => {
                let lanes: Vec<Lanes> = words.iter().map(|word| [*word; LANES]).collect();
                let vector = |k: usize| std::array::from_fn(|c| &lanes[4 * k + c]);
                let mut out = [ZERO; 4];
                all(width, [vector(0), vector(1)], &mut out);
                out.iter().map(|lanes| lanes[0]).collect()
            }
            Evaluate::Each { .. } => unreachable!(),
        },
    }
}

/// Rows give the bits that their nodes' steps give, one by one.
#[test]
fn rows_are_their_nodes() {
    for made in made() {
        let Made { title, shape, free, .. } = &made;
        let slices: Vec<&[u16]> = free.iter().map(Vec::as_slice).collect();
        let row = ROWS.iter().find(|row| shape.is(row) && row.free == slices);
        let row = row.unwrap_or_else(|| panic!("{title} has no row"));
        let random = |i: usize, k: usize| ((i * 31 + k) as u32).wrapping_mul(2_654_435_769).rotate_left(13);
        for turn in 0..8 {
            let arguments: Vec<Lanes> = (0..shape.inputs + free.len())
                .map(|k| {
                    std::array::from_fn(|i| {
                        let word = random(i + LANES * turn, k);
                        let place = (word as i32 as f32 / 1e7) * [0.01, 1.0, 1e5, 1e30][turn % 4];
                        if k < shape.inputs { place.to_bits() } else { word >> 5 }
                    })
                })
                .collect();
            let lanes = std::array::from_fn(|k| arguments.get(k).unwrap_or(&ZERO));
            let mut out = std::array::from_fn(|_| Box::new(ZERO));
            (row.run)(&lanes, !0, &mut out);
            for i in 0..LANES {
                let mut values = vec![0; 4 * shape.operations.len() + 4];
                let word = |values: &[u32], operand: &Operand| match operand {
                    Operand::Input(n) => arguments[*n as usize][i],
                    Operand::Value(n) => values[*n as usize],
                    Operand::Constant(place) => match free.iter().position(|places| places.contains(place)) {
                        Some(n) => arguments[shape.inputs + n][i],
                        None => shape.constants[usize::from(*place)].1,
                    },
                };
                for (operation, operands, first) in &shape.operations {
                    let words: Vec<u32> = operands.iter().map(|operand| word(&values, operand)).collect();
                    for (to, value) in values[*first as usize..].iter_mut().zip(value(*operation, &words)) {
                        *to = value;
                    }
                }
                for (n, output) in shape.outputs.iter().enumerate() {
                    assert_eq!(out[n][i], word(&values, output), "{title}, output {n}, lane {i}");
                }
            }
        }
    }
}

/// Counts the functions that become one step, and those of a row's name that don't.
#[derive(Default)]
struct Counted([usize; 2]);

impl Fuse for Counted {
    fn knows(&self, name: &str) -> bool {
        Rows.knows(name)
    }

    fn fuse(&mut self, name: &str, planned: &mut Planned, known: &[Lanes], registers: &mut usize) -> bool {
        let fused = Rows.fuse(name, planned, known, registers);
        self.0[usize::from(!fused)] += 1;
        fused
    }
}

/// Rows stand for their nodes with any seed.
#[test]
fn rows_are_found() {
    let library = Library::standard().expect("the library parses");
    for form in FORMS {
        for n in form.dimensions {
            for seed in [0, 1, -5, 1 << 30] {
                let mut counted = Counted::default();
                plan(&compiled(&library, form, *n, seed, 11), &mut counted);
                let [fused, others] = counted.0;
                assert!(fused > 0 && others == 0, "{}, seed {seed}: {:?}", form.text, counted.0);
            }
        }
    }
}
