//! What a pixel costs, counted in a shader's text: fetches, and arithmetic in scalar operations.

use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{Block, Expression, Function, Handle, MathFunction, Module, ScalarKind, Statement, TypeInner};

/// Operations of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Samples and loads of textures.
    pub fetches: u32,
    /// Operations on numbers, one for each component. What only arranges components is none, nor is
    /// a word that is read as an int.
    pub arithmetic: u32,
}

impl Count {
    fn add(&mut self, other: Count) {
        self.fetches += other.fetches;
        self.arithmetic += other.arithmetic;
    }

    fn max(self, other: Count) -> Count {
        Count { fetches: self.fetches.max(other.fetches), arithmetic: self.arithmetic.max(other.arithmetic) }
    }
}

/// The count of the only entry point of a text, its calls followed, of two arms the greater of each
/// figure.
///
/// # Errors
/// The text is not WGSL, or it loops: how often is not known here.
pub fn count(wgsl: &str) -> Result<Count, String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    let info = validator.validate(&module).map_err(|error| error.emit_to_string(wgsl))?;
    let [entry] = module.entry_points.as_slice() else { return Err("one entry point is expected".into()) };
    let counting = Counting { module: &module, info: &info };
    counting.block(&entry.function, info.get_entry_point(0), &entry.function.body)
}

struct Counting<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
}

impl Counting<'_> {
    fn block(&self, function: &Function, info: &FunctionInfo, block: &Block) -> Result<Count, String> {
        let mut count = Count::default();
        for statement in block {
            match statement {
                Statement::Emit(range) => {
                    range
                        .clone()
                        .for_each(|expression| count.add(self.expression(function, info, expression)));
                }
                Statement::Call { function, .. } => {
                    let callee = &self.module.functions[*function];
                    count.add(self.block(callee, &self.info[*function], &callee.body)?);
                }
                Statement::Block(inner) => count.add(self.block(function, info, inner)?),
                Statement::If { accept, reject, .. } => {
                    let accepted = self.block(function, info, accept)?;
                    count.add(accepted.max(self.block(function, info, reject)?));
                }
                Statement::Loop { .. } | Statement::Switch { .. } => {
                    return Err("loops and switches are not counted".into());
                }
                _ => {}
            }
        }
        Ok(count)
    }

    fn expression(&self, function: &Function, info: &FunctionInfo, handle: Handle<Expression>) -> Count {
        let width = |handle: Handle<Expression>| match info[handle].ty.inner_with(&self.module.types) {
            TypeInner::Vector { size, .. } => *size as u32,
            TypeInner::Matrix { columns, rows, .. } => *columns as u32 * *rows as u32,
            _ => 1,
        };
        let arithmetic = match &function.expressions[handle] {
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } => {
                return Count { fetches: 1, arithmetic: 0 };
            }
            Expression::Math { fun: MathFunction::Dot, arg, .. } => 2 * width(*arg) - 1,
            Expression::Math { fun: MathFunction::Length | MathFunction::Distance, arg, .. } => {
                2 * width(*arg)
            }
            Expression::Math { fun: MathFunction::Clamp | MathFunction::Mix, arg, .. } => 2 * width(*arg),
            Expression::Relational { argument, .. } => width(*argument),
            Expression::Binary { .. }
            | Expression::Unary { .. }
            | Expression::Math { .. }
            | Expression::Derivative { .. }
            | Expression::Select { .. } => width(handle),
            Expression::As { expr, kind, convert: Some(_) } => {
                let from = info[*expr].ty.inner_with(&self.module.types).scalar_kind();
                let is_real =
                    from != Some(*kind) && (from == Some(ScalarKind::Float) || *kind == ScalarKind::Float);
                if is_real { width(handle) } else { 0 }
            }
            _ => 0,
        };
        Count { fetches: 0, arithmetic }
    }
}
