//! The tables as data: every row is whole, and the parts of a row agree with each other.

use std::collections::BTreeSet;
use texgraph_compiler::graph::{Builder, Constant, Scalar, Value};
use texgraph_compiler::intrinsic::{Derivative, Form, Intrinsic, Tangents};
use texgraph_compiler::resource::KINDS;
use texgraph_grammar::syntax::{Dim, Signature, Type, TypeKind};

const FLOATS: &[f32] = &[0.0, -0.0, 1.0, -1.0, 0.5, -2.75, 3.0, 1e-30, 1e30, -1e30, f32::MAX, f32::MIN];
const INTS: &[i32] = &[0, 1, -1, 2, 3, -5, 8, 31, 32, 1000, i32::MAX, i32::MIN];

/// Arguments for a row, the scalars of each input taken from a list at an offset.
fn arguments(signature: &Signature, width: u8, pick: usize) -> Vec<Constant> {
    let inputs = signature.inputs.iter().enumerate();
    inputs.map(|(i, input)| argument(&input.ty, width, pick / 12_usize.pow(i as u32))).collect()
}

fn argument(ty: &Type, width: u8, pick: usize) -> Constant {
    let (scalar, width) = shape(ty, width);
    let at = |i: u8| (pick + usize::from(i) * 5) % 12;
    Constant::new(
        scalar,
        (0..width).map(|i| match scalar {
            Scalar::Float => FLOATS[at(i)].to_bits(),
            Scalar::Int => INTS[at(i)] as u32,
            Scalar::Bool => (at(i) % 2) as u32,
        }),
    )
}

fn shape(ty: &Type, width: u8) -> (Scalar, u8) {
    let TypeKind::Named { name, dim } = &ty.kind else { panic!("a row takes vectors only") };
    let generic = matches!(dim, Some(Dim::Name(_)));
    let scalar = match name.text.as_str() {
        "vec" | "float" | "vec2" | "vec3" | "vec4" => Scalar::Float,
        "ivec" | "int" | "ivec2" | "ivec3" | "ivec4" => Scalar::Int,
        "bvec" | "bool" => Scalar::Bool,
        other => panic!("a row takes `{other}`"),
    };
    let fixed = name.text.chars().last().and_then(|c| c.to_digit(10)).unwrap_or(1) as u8;
    (scalar, if generic { width } else { fixed })
}

fn rows() -> impl Iterator<Item = (Intrinsic, Signature)> {
    Intrinsic::all().map(|intrinsic| {
        let row = intrinsic.row();
        let signature = texgraph_grammar::parse_signature(row.signature);
        (intrinsic, signature.unwrap_or_else(|error| panic!("{}: {}: {error}", row.name, row.signature)))
    })
}

fn widths(signature: &Signature) -> std::ops::RangeInclusive<u8> {
    if signature.dims.is_empty() { 1..=1 } else { 1..=4 }
}

#[test]
fn every_row_is_documented_and_no_two_take_the_same() {
    let mut seen = BTreeSet::new();
    for (intrinsic, _) in rows() {
        let row = intrinsic.row();
        assert!(row.doc.ends_with('.'), "{}: {}", row.name, row.doc);
        assert!(seen.insert((row.name, row.signature)), "{} {} stands twice", row.name, row.signature);
    }
    let kinds: BTreeSet<&str> = KINDS.iter().map(|kind| kind.name).collect();
    assert_eq!(kinds.len(), KINDS.len());
    for kind in KINDS {
        assert!(kind.doc.ends_with('.'), "{}", kind.name);
        assert!(kind.gives.is_some() || !kind.fields.is_empty(), "{}", kind.name);
        texgraph_grammar::parse_signature(kind.constructor).expect("a constructor is a signature");
    }
}

#[test]
fn values_are_total_and_of_the_declared_type() {
    for (intrinsic, signature) in rows() {
        for width in widths(&signature) {
            for pick in 0..12_usize.pow(signature.inputs.len() as u32) {
                let arguments = arguments(&signature, width, pick);
                let value = intrinsic.evaluate(&arguments);
                let (scalar, wide) = shape(&signature.output, width);
                let name = intrinsic.row().name;
                assert_eq!((value.scalar(), value.width()), (scalar, wide), "{name} {arguments:?}");
                let finite = |i: u8| scalar != Scalar::Float || value.float(usize::from(i)).is_finite();
                assert!((0..wide).all(finite), "{name} of {arguments:?} is {value:?}");
            }
        }
    }
}

#[test]
fn what_a_row_expands_to_is_worth_the_same() {
    for (intrinsic, signature) in rows() {
        let Form::Expand(rule) = intrinsic.row().form else { continue };
        for width in widths(&signature) {
            for pick in 0..12_usize.pow(signature.inputs.len() as u32) {
                let arguments = arguments(&signature, width, pick);
                let mut builder = Builder::default();
                let values: Vec<Value> = arguments.iter().map(|c| builder.constant(*c)).collect();
                let expanded = rule(&mut builder, &values);
                let found = builder.as_constant(expanded).expect("constants fold");
                let wanted = intrinsic.evaluate(&arguments);
                let name = intrinsic.row().name;
                assert!(
                    alike(&found, &wanted),
                    "{name} of {arguments:?}: {found:?}, the row says {wanted:?}"
                );
            }
        }
    }
}

/// Ints and bools are equal; floats agree to seven digits.
fn alike(a: &Constant, b: &Constant) -> bool {
    a.ty() == b.ty()
        && (0..usize::from(a.width())).all(|i| match a.scalar() {
            Scalar::Float => (a.float(i) - b.float(i)).abs() <= 1e-6 * a.float(i).abs().max(b.float(i).abs()),
            Scalar::Int | Scalar::Bool => a.int(i) == b.int(i),
        })
}

#[test]
fn expansions_need_no_further_expansion() {
    for (intrinsic, signature) in rows() {
        let Form::Expand(rule) = intrinsic.row().form else { continue };
        let mut builder = Builder::default();
        let zeros = arguments(&signature, 3, 0);
        let inputs: Vec<Value> = zeros.iter().map(|c| builder.input("x", c.ty())).collect();
        rule(&mut builder, &inputs);
        for operation in &builder.function().values {
            if let texgraph_compiler::graph::Operation::Builtin(inner, _) = operation {
                let expands = matches!(inner.row().form, Form::Expand(_));
                assert!(!expands, "{} expands to {}", intrinsic.row().name, inner.row().name);
            }
        }
    }
}

/// Central differences of the value, at points where nothing is singular.
#[test]
fn derivatives_are_slopes() {
    let points = [0.3_f32, 0.55, 0.7, 0.42, 0.61, 0.85, 0.35, 0.78, 0.5, 0.66, 0.25, 0.9];
    for (intrinsic, signature) in rows() {
        let Derivative::Rule(rule) = intrinsic.row().derivative else { continue };
        if intrinsic.row().name == "narrow" {
            continue; // What it is there for is another change than that of its value.
        }
        let all_floats = signature.inputs.iter().all(|input| shape(&input.ty, 2).0 == Scalar::Float);
        if !all_floats {
            continue;
        }
        let width = *widths(&signature).end();
        let at = |input: usize, i: u8, step: f32| {
            let slope = 0.5 + 0.25 * (input as f32 - f32::from(i));
            points[(input * 5 + usize::from(i) * 3) % 12] + step * slope
        };
        let place = |step: f32| -> Vec<Constant> {
            let inputs = signature.inputs.iter().enumerate();
            let wide = |ty: &Type| shape(ty, width).1;
            inputs
                .map(|(input, declared)| {
                    let parts: Vec<f32> = (0..wide(&declared.ty)).map(|i| at(input, i, step)).collect();
                    Constant::floats(&parts)
                })
                .collect()
        };
        let (before, here, after) = (place(-1e-2), place(0.0), place(1e-2));
        let tangents: Vec<Constant> = here
            .iter()
            .enumerate()
            .map(|(input, c)| {
                let slopes: Vec<f32> =
                    (0..c.width()).map(|i| at(input, i, 1.0) - at(input, i, 0.0)).collect();
                Constant::floats(&slopes)
            })
            .collect();
        let mut builder = Builder::default();
        let values: Vec<Value> = here.iter().map(|c| builder.constant(*c)).collect();
        let changes: Vec<Value> = tangents.iter().map(|c| builder.constant(*c)).collect();
        let result = builder.constant(intrinsic.evaluate(&here));
        let slope =
            rule(&mut Tangents { builder: &mut builder, arguments: &values, result, tangents: &changes });
        let slope = builder.as_constant(slope).expect("constants fold");
        let (low, high) = (intrinsic.evaluate(&before), intrinsic.evaluate(&after));
        for i in 0..usize::from(slope.width()) {
            let measured = (high.float(i) - low.float(i)) / 2e-2;
            let error = (slope.float(i) - measured).abs();
            let name = intrinsic.row().name;
            assert!(error < 0.02 * measured.abs().max(0.5), "{name}: {slope:?}, measured {measured}");
        }
    }
}

/// An argument of a declared type that no pass can fold.
fn open_argument(ty: &Type, width: u8) -> String {
    let (scalar, width) = shape(ty, width);
    let float = ["uv.x", "uv", "tangent.xyz", "tangent"][usize::from(width) - 1];
    match scalar {
        Scalar::Float => float.to_owned(),
        Scalar::Int => format!("ifloor({float} * 8.0)"),
        Scalar::Bool => "uv.x < 0.5".to_owned(),
    }
}

/// Every row that has a name reaches the shader, at every width, and naga accepts it.
#[test]
fn every_named_row_is_lowered() {
    let library = texgraph_compiler::Library::standard().expect("the library parses");
    for (intrinsic, signature) in rows() {
        let name = intrinsic.row().name;
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) {
            continue;
        }
        for width in widths(&signature) {
            let arguments: Vec<String> =
                signature.inputs.iter().map(|input| open_argument(&input.ty, width)).collect();
            let call = format!("{name}({})", arguments.join(", "));
            let text =
                format!("texture t(uv: vec2, tangent: vec4) -> (height: float) {{ height = {call}.x }}");
            let files: std::collections::HashMap<String, String> = [("t.tex".to_owned(), text)].into();
            let compiled = texgraph_compiler::compile(&library, "t.tex", &files, &Default::default());
            let errors = compiled.err().map(|failure| failure.diagnostics);
            assert_eq!(errors, None, "{call}");
        }
    }
}
