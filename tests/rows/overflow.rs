//! Where a shader may overflow: what it draws there is not defined.

use texgraph_compiler::graph::{Constant, Scalar};

/// Nearer to the greatest float than this, rounding alone may overflow.
const GREATEST: f64 = f32::MAX as f64 * (1.0 - 1e-6);
/// Smaller divisors count as 0.
const LEAST: f64 = 1e-37;

/// Whether a component of a row, or a term that it is made of, passes the greatest float.
pub fn overflows(name: &str, arguments: &[Constant]) -> bool {
    let width = arguments.iter().map(|c| usize::from(c.width())).max().unwrap_or(1);
    let whole: Vec<Vec<f64>> = arguments.iter().map(|c| components(c, width)).collect();
    let terms = match (name, whole.as_slice()) {
        ("dot", [a, b]) => vec![dot(a, b)],
        ("length" | "normalize", [v]) => vec![square(v)],
        ("distance", [a, b]) => {
            let offset: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            let size = offset.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            vec![size, square(&offset)]
        }
        ("cross", [a, b]) => vec![dot(a, a).max(dot(b, b))],
        _ => (0..width).flat_map(|i| component(name, |k| whole[k][i])).collect(),
    };
    arguments.iter().any(|c| c.scalar() == Scalar::Float) && terms.iter().any(|term| term.abs() > GREATEST)
}

/// The terms of a row that goes component by component.
fn component(name: &str, x: impl Fn(usize) -> f64) -> Vec<f64> {
    let quotient = |x: f64, y: f64| if y.abs() < LEAST { 0.0 } else { x / y };
    match name {
        "+" => vec![x(0) + x(1)],
        "-" => vec![x(0) - x(1)],
        "*" => vec![x(0) * x(1)],
        "/" => vec![quotient(x(0), x(1))],
        "%" => {
            let quotient = quotient(x(0), x(1));
            vec![quotient, x(1) * quotient.floor()]
        }
        // A shader's compiler may take t out, and for t = 1/2 half the sum.
        "mix" => {
            vec![x(0) * (1.0 - x(2)), x(1) * x(2), (x(1) - x(0)) * x(2), x(1) - x(0), x(1) + x(0)]
        }
        "smoothstep" => vec![x(2) - x(0), x(1) - x(0), quotient(x(2) - x(0), x(1) - x(0))],
        _ => Vec::new(),
    }
}

fn components(c: &Constant, width: usize) -> Vec<f64> {
    let component = |i: usize| match c.scalar() {
        Scalar::Float => f64::from(c.float(i)),
        Scalar::Int | Scalar::Bool => f64::from(c.int(i)),
    };
    (0..width).map(|i| component(i.min(usize::from(c.width()) - 1))).collect()
}

/// The sum of the absolute products.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a * b).abs()).sum()
}

/// What a length is the root of; a scalar's needs none.
fn square(v: &[f64]) -> f64 {
    if v.len() == 1 { 0.0 } else { dot(v, v) }
}
