//! Every row of the intrinsic table with arguments at the edges: 0 of either sign, −1, tiny, huge,
//! the greatest and the least, equal and reversed bounds; each argument constant and not. What the
//! CPU renderer and the GPU draw is what the row says, as near as WGSL lets a shader be, and a
//! number. Only where arithmetic overflows the GPU may draw anything; the CPU renderer saturates.
//!
//! GPU tests are shown as ignored where there is no adapter; `TEXGRAPH_GPU=required` makes that a
//! failure. `TEXGRAPH_WGSL=FOLDER` writes the shaders to `FOLDER/rows`, for `tests/tint`.

#[path = "rows/bounds.rs"]
mod bounds;
#[path = "rows/overflow.rs"]
mod overflow;
#[path = "rows/program.rs"]
mod program;
#[path = "rows/values.rs"]
mod values;

use libtest_mimic::{Arguments, Failed, Trial};
use program::{Case, Kind, Shape};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;
use texgraph_compiler::graph::{Constant, Scalar};
use texgraph_compiler::intrinsic::Intrinsic;
use texgraph_compiler::{Library, Options, Program, compile, diagnostic::render};
use texgraph_grammar::parse_signature;
use texgraph_runtime::cpu;
use texgraph_runtime::gpu::{Gpu, Preference};
use texgraph_runtime::render::Request;
use texgraph_runtime::resource::Tables;

/// Vectors are tried at one width besides scalars: components are alike.
const WIDTHS: [u8; 2] = [1, 3];

fn main() {
    let arguments = Arguments::from_args();
    let required = std::env::var("TEXGRAPH_GPU").is_ok_and(|value| value == "required");
    let gpu = Gpu::new(Preference::Hardware).map(Arc::new);
    let library = Arc::new(Library::standard().unwrap_or_else(|why| panic!("{why}")));
    let mut trials = Vec::new();
    for intrinsic in Intrinsic::all().filter(|intrinsic| can_be_written(intrinsic.row().name)) {
        let row = intrinsic.row();
        let name = format!("{} {}", row.name, row.signature);
        let known = Arc::clone(&library);
        trials.push(Trial::test(format!("cpu::{name}"), move || on_cpu(&known, intrinsic)));
        let (known, gpu) = (Arc::clone(&library), gpu.clone());
        let ignored = gpu.is_err() && !required;
        let run = move || on_gpu(&known, &*gpu.map_err(|error| error.to_string())?, intrinsic);
        trials.push(Trial::test(format!("gpu::{name}"), run).with_ignored_flag(ignored));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

/// Operators and functions, and the conversions and the index that expressions have. The other
/// rows in parentheses are what these expand to.
fn can_be_written(name: &str) -> bool {
    !name.starts_with('(') || ["(float)", "(int)", "([i])"].contains(&name)
}

/// The cases of a row, each with its program.
fn programs(library: &Library, intrinsic: Intrinsic) -> Result<Vec<(Case, Program)>, Failed> {
    let row = intrinsic.row();
    let signature = parse_signature(row.signature).map_err(|error| error.to_string())?;
    let widths = if signature.dims.is_empty() { &WIDTHS[..1] } else { &WIDTHS[..] };
    let cases = widths.iter().flat_map(|width| program::cases(row.name, &signature, *width));
    cases.map(|case| compiled(library, &case).map(|program| (case, program))).collect()
}

fn compiled(library: &Library, case: &Case) -> Result<Program, Failed> {
    let text = case.text();
    let files: HashMap<String, String> = [("row.tex".to_owned(), text.clone())].into();
    let compiled = compile(library, "row.tex", &files, &Options::default()).map_err(|failure| {
        format!("{}: {}\n{text}", case.describe(), render::human(&failure.sources, &failure.diagnostics))
    })?;
    if let Some(folder) = std::env::var_os("TEXGRAPH_WGSL") {
        let folder = Path::new(&folder).join("rows");
        std::fs::create_dir_all(&folder)?;
        std::fs::write(folder.join(case.file_name()), &compiled.program.texture().wgsl)?;
    }
    Ok(compiled.program)
}

fn on_cpu(library: &Library, intrinsic: Intrinsic) -> Result<(), Failed> {
    for (case, program) in programs(library, intrinsic)? {
        let draw = |output| {
            let request = Request { output, ..Request::new(case.size()) };
            cpu::render(&program, &Tables::default(), &request, &|_| {}).map(|picture| picture.pixels)
        };
        let pictures = [draw(0), draw(1)].map(|pixels| pixels.map_err(|error| error.to_string()));
        let [low, high] = pictures;
        judge(intrinsic, &case, &low?, &high?, |_| false)?;
    }
    Ok(())
}

fn on_gpu(library: &Library, gpu: &Gpu, intrinsic: Intrinsic) -> Result<(), Failed> {
    for (case, program) in programs(library, intrinsic)? {
        let draw = |output| {
            let mut scene = gpu.prepare(&program, &Tables::default(), output)?;
            scene.render(&Request::new(case.size()), &|_| {}).map(|picture| picture.pixels)
        };
        let low = draw(0).map_err(|error| error.to_string())?;
        let high = match case.output.0 {
            Kind::Int => draw(1).map_err(|error| error.to_string())?,
            _ => vec![[0.0; 4]; low.len()],
        };
        let name = intrinsic.row().name;
        judge(intrinsic, &case, &low, &high, |arguments| overflow::overflows(name, arguments))?;
    }
    Ok(())
}

/// Compares every pixel with what the row says of its arguments, but for the `undefined` ones.
fn judge(
    intrinsic: Intrinsic,
    case: &Case,
    low: &[[f32; 4]],
    high: &[[f32; 4]],
    undefined: impl Fn(&[Constant]) -> bool,
) -> Result<(), Failed> {
    let width = case.columns();
    let mut wrong = Vec::new();
    for (pixel, (low, high)) in low.iter().zip(high).enumerate() {
        let places = case.places(pixel % width, pixel / width);
        let arguments: Vec<Constant> =
            case.inputs.iter().zip(&places).map(|(shape, at)| argument(*shape, *at)).collect();
        if undefined(&arguments) {
            continue;
        }
        let drawn = |i: usize| match case.output.0 {
            Kind::Int => f64::from(high[i]) * 65_536.0 + f64::from(low[i]),
            Kind::Float | Kind::Bool => f64::from(low[i]),
        };
        for i in 0..usize::from(case.output.1) {
            if let Some(why) = off(intrinsic, &arguments, i, drawn(i)) {
                wrong.push(why);
            }
        }
    }
    match wrong.first() {
        None => Ok(()),
        Some(_) => {
            let shown = wrong.iter().take(8).cloned().collect::<Vec<_>>().join("\n");
            Err(format!("{}: {} wrong:\n{shown}", case.describe(), wrong.len()).into())
        }
    }
}

/// What is wrong with component `i` of a result. Arguments below 2⁻¹²⁶ may count as 0, and a 0 may
/// lose its sign.
fn off(intrinsic: Intrinsic, arguments: &[Constant], i: usize, drawn: f64) -> Option<String> {
    let name = intrinsic.row().name;
    let near = |arguments: &[Constant]| {
        let right = intrinsic.evaluate(arguments);
        let bound = bounds::bound(name, arguments, &right, i);
        let right = match right.scalar() {
            Scalar::Float => f64::from(right.float(i)),
            Scalar::Int | Scalar::Bool => f64::from(right.int(i)),
        };
        drawn.is_finite() && (drawn == right || (drawn - right).abs() <= bound)
    };
    let flushed = |zero: fn(f32) -> f32| arguments.iter().map(|c| flush(c, zero)).collect::<Vec<_>>();
    if near(arguments) || near(&flushed(|x| 0.0_f32.copysign(x))) || near(&flushed(|_| 0.0)) {
        return None;
    }
    let right = intrinsic.evaluate(arguments);
    Some(format!("{name} of {arguments:?}, component {i}: {drawn:?}, the row says {right:?}"))
}

fn argument((kind, width): Shape, at: usize) -> Constant {
    let places = (0..width).map(|component| values::place(at, component));
    match kind {
        Kind::Float => Constant::floats(&places.map(values::float).collect::<Vec<_>>()),
        Kind::Int => Constant::ints(&places.map(values::int).collect::<Vec<_>>()),
        Kind::Bool => Constant::bools(&places.map(values::bool).collect::<Vec<_>>()),
    }
}

/// With a `zero` for what is too small for a normal float.
fn flush(c: &Constant, zero: fn(f32) -> f32) -> Constant {
    if c.scalar() != Scalar::Float {
        return *c;
    }
    let normal = |x: f32| if x.abs() < f32::MIN_POSITIVE { zero(x) } else { x };
    Constant::floats(&(0..usize::from(c.width())).map(|i| normal(c.float(i))).collect::<Vec<_>>())
}
