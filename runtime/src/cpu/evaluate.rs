//! What single operations are worth, all but calls and folds.

use super::texture::Texture;
use glam::{IVec2, Vec2};
use texgraph_compiler::graph::{Constant, Level, Operation, Scalar, Type, Value};

/// What stands where a program that is not whole has nothing.
pub fn zero() -> Constant {
    Constant::zero(Scalar::Float, 1)
}

/// What an operation is worth. A view is worth its number. `scratch` is memory to use again.
pub fn evaluate(
    operation: &Operation,
    read: impl Fn(Value) -> Constant,
    textures: &[Texture],
    scratch: &mut Vec<Constant>,
) -> Constant {
    let texture = |view: Value| textures.get(read(view).int(0) as usize);
    let layer = |layer: &Option<Value>| layer.map_or(0, |layer| read(layer).int(0));
    match operation {
        Operation::Constant(constant) => *constant,
        Operation::View(id) => Constant::ints(&[id.0 as i32]),
        Operation::Builtin(intrinsic, arguments) => {
            scratch.clear();
            scratch.extend(arguments.iter().map(|argument| read(*argument)));
            intrinsic.evaluate(scratch)
        }
        Operation::Compose(scalars) => compose(scalars, read),
        Operation::Extract(vector, component) => read(*vector).component(usize::from(*component)),
        Operation::Select(condition, yes, no) => read(if read(*condition).bool(0) { *yes } else { *no }),
        Operation::Sample { view, coordinate, layer: l, level } => {
            let Some(texture) = texture(*view) else { return Constant::zero(Scalar::Float, 4) };
            let lod = match level {
                Level::Auto => 0.0,
                Level::Gradient(x, y) => texture.level(pair(read(*x)), pair(read(*y))),
                Level::Level(level) => read(*level).float(0),
            };
            Constant::floats(&texture.sample(pair(read(*coordinate)), lod, layer(l)).to_array())
        }
        Operation::Texel { view, index, layer: l } => {
            let index = read(*index);
            let index = IVec2::new(index.int(0), index.int(1));
            texture(*view).map_or(Constant::zero(Scalar::Float, 4), |texture| texture.fetch(index, layer(l)))
        }
        Operation::Size(view) => {
            Constant::ints(&texture(*view).map_or([1, 1], |texture| texture.size().to_array()))
        }
        Operation::Lookup(table, index) => {
            let last = table.len().saturating_sub(1);
            let index = usize::try_from(read(*index).int(0)).unwrap_or(0).min(last);
            table.get(index).copied().unwrap_or_else(zero)
        }
        // The plan makes registers of these; calls and folds are run by the machine.
        Operation::Input(_)
        | Operation::Param(_)
        | Operation::Call(..)
        | Operation::Fold(_)
        | Operation::Output(..)
        | Operation::Derivative(..) => zero(),
    }
}

fn compose(scalars: &[Value], read: impl Fn(Value) -> Constant) -> Constant {
    let first = scalars.first().map_or(Type::FLOAT, |scalar| read(*scalar).ty());
    let bits = scalars.iter().map(|scalar| read(*scalar).bits().first().copied().unwrap_or(0));
    Constant::new(first.scalar().unwrap_or(Scalar::Float), bits)
}

fn pair(value: Constant) -> Vec2 {
    Vec2::new(value.float(0), value.float(1))
}
