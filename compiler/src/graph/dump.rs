//! The graph as text, for tests and for looking at it.

use super::{Function, Graph, Level, Operation, Sampled, Value};
use std::fmt::{Display, Formatter, Result};

impl Display for Graph {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        for (i, function) in self.functions.iter().enumerate() {
            writeln!(f, "function {i} {function}")?;
        }
        Ok(())
    }
}

impl Display for Function {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let inputs: Vec<String> =
            self.inputs.iter().map(|slot| format!("{}: {:?}", slot.name, slot.ty)).collect();
        writeln!(f, "{}({})", self.name, inputs.join(", "))?;
        for (value, operation) in self.iter() {
            write!(f, "  {value} = {}", Shown(operation))?;
            match self.names.get(value) {
                Some(name) => writeln!(f, "  # {name}")?,
                None => writeln!(f)?,
            }
        }
        for (slot, value) in &self.outputs {
            writeln!(f, "  {} = {value}", slot.name)?;
        }
        Ok(())
    }
}

impl Display for Value {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "%{}", self.0)
    }
}

/// An operation on one line.
struct Shown<'a>(&'a Operation);

impl Display for Shown<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let list = |values: &[Value]| values.iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
        match self.0 {
            Operation::Constant(c) => write!(f, "{c:?}"),
            Operation::Input(i) => write!(f, "input {i}"),
            Operation::Param(id) => write!(f, "param {}", id.0),
            Operation::View(id) => write!(f, "view {}", id.0),
            Operation::Builtin(intrinsic, v) => write!(f, "`{}` {}", intrinsic.row().name, list(v)),
            Operation::Compose(v) => write!(f, "compose {}", list(v)),
            Operation::Extract(v, i) => write!(f, "extract {v}.{i}"),
            Operation::Select(c, a, b) => write!(f, "select {c} ? {a} : {b}"),
            Operation::Sample { view, coordinate, layer, level } => {
                write!(f, "sample {view} at {coordinate}")?;
                layer.iter().try_for_each(|layer| write!(f, " layer {layer}"))?;
                match level {
                    Level::Auto => write!(f, " auto"),
                    Level::Gradient(x, y) => write!(f, " gradient {x}, {y}"),
                    Level::Level(l) => write!(f, " level {l}"),
                }
            }
            Operation::Texel { view, index, layer } => {
                write!(f, "texel {view} at {index}")?;
                layer.iter().try_for_each(|layer| write!(f, " layer {layer}"))
            }
            Operation::Size(v) => write!(f, "size {v}"),
            Operation::Call(id, v) => write!(f, "call {} ({})", id.0, list(v)),
            Operation::Lookup(table, v) => write!(f, "lookup {table:?} at {v}"),
            Operation::Fold(fold) => {
                write!(
                    f,
                    "fold {} ({}) for {} of {}",
                    fold.body.0,
                    list(&fold.starts),
                    fold.steps,
                    fold.most
                )?;
                fold.condition.iter().try_for_each(|condition| write!(f, " while {}", condition.0))?;
                write!(f, " over ({})", list(&fold.captures))
            }
            Operation::Output(v, i) => write!(f, "output {v}.{i}"),
            Operation::Derivative(v, axis, Sampled::Constant) => write!(f, "derivative {v} {axis:?}"),
            Operation::Derivative(v, axis, Sampled::Changing) => write!(f, "derivative {v} {axis:?} sampled"),
        }
    }
}
