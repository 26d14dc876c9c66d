//! Folds, tables, matrices and nodes as arguments: each behind its switch in `Features`.

use super::expression::Expr;
use super::program::Generator;
use super::types::{N, Rate, Scalar, Scope, Ty};

/// Folds inside each other multiply; one has few steps.
const MOST_AROUND: u32 = 400;

impl Generator<'_, '_> {
    /// A fold of one accumulator of that type.
    pub fn fold_value(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        let name = self.fresh();
        self.fold(s, &[(name, ty)], depth).map(Expr::primary)
    }

    /// A fold over accumulators; none where folds are off, or too many are around.
    pub fn fold(&mut self, s: &Scope, accumulators: &[(String, Ty)], depth: u32) -> Option<String> {
        if !(self.features.folds || self.features.literal_folds) || s.steps > MOST_AROUND {
            return None;
        }
        let starts: Vec<String> = accumulators
            .iter()
            .map(|(name, ty)| format!("{name} = {}", self.exact(s, *ty, depth.min(2)).text))
            .collect();
        let variable = self.fresh();
        let (range, over, steps) = self.range(s, depth);
        let mut inner = s.clone();
        inner.steps = s.steps.saturating_mul(steps.max(1));
        self.steps = self.steps.max(inner.steps);
        for (name, ty) in accumulators {
            inner.declare_in_fold(name.clone(), *ty);
        }
        let condition = self.while_part(&inner, depth);
        inner.declare_in_fold(variable.clone(), over);
        let mut lines = Vec::new();
        for _ in 0..self.choices.below(3) {
            let ty = self.some_number(&inner);
            let name = self.fresh();
            let value = self.exact(&inner, ty, depth.min(2)).text;
            lines.push(format!("let {name} = {value}"));
            inner.declare_in_fold(name, ty);
        }
        for (name, ty) in accumulators {
            // One that is not assigned keeps its value.
            if !self.choices.chance(10) {
                lines.push(format!("{name} = {}", self.fitting(&inner, *ty, depth).text));
            }
        }
        self.choices.shuffle(&mut lines);
        let (starts, lines) = (starts.join(", "), lines.join("\n"));
        Some(format!("fold ({starts}) for {variable} in {range}{condition} {{\n{lines}\n}}"))
    }

    /// A range with its bound, the type of what runs over it, and how many steps it has at most.
    fn range(&mut self, s: &Scope, depth: u32) -> (String, Ty, u32) {
        let dots = *self.choices.pick(&["..", "..="]);
        let last = self.choices.below(5) as u32;
        let literal = |from: i32| (format!("{from}{dots}{}", from + last as i32), Ty::INT, last + 1);
        if !self.features.folds {
            return literal(self.choices.below(5) as i32 - 2);
        }
        match self.choices.below(6) {
            0 | 1 => literal(self.choices.below(5) as i32 - 2),
            2 => (format!("0..min({}, {last})", self.exact(s, Ty::INT, depth.min(2)).text), Ty::INT, last),
            3 => {
                let ends = [0, 1].map(|_| self.exact(s, Ty::INT, depth.min(2)).at_least(4));
                (format!("{}{dots}{} max {last}", ends[0], ends[1]), Ty::INT, last)
            }
            _ => {
                let widths: &[u8] = if s.generic { &[N, 2] } else { &[2, 3] };
                let ty = Ty::int(*self.choices.pick(widths));
                let side = 1 + self.choices.below(2) as u32;
                let steps = (side + 1).pow(if ty.width == N { 4 } else { u32::from(ty.width) });
                (format!("{0}(-1){dots}{0}({1})", ty.name(), side as i32 - 1), ty, steps)
            }
        }
    }

    fn while_part(&mut self, s: &Scope, depth: u32) -> String {
        if self.features.folds && self.choices.chance(25) {
            return format!(" while {}", self.exact(s, Ty::BOOL, depth.min(2)).text);
        }
        String::new()
    }

    /// `m * v`, or a column `m[i]`.
    pub fn product(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        if !self.features.matrices || ty.scalar != Scalar::Float || ![2, 3].contains(&ty.width) {
            return None;
        }
        if self.choices.chance(30) {
            let base = self.matrix(s, ty.width, depth).base();
            return Some(Expr::primary(format!("{base}[{}]", self.exact(s, Ty::INT, depth.min(2)).text)));
        }
        let matrix = self.matrix(s, ty.width, depth).at_least(5);
        let vector = self.exact(s, ty, depth).at_least(6);
        Some(Expr::product(format!("{matrix} * {vector}")))
    }

    /// A matrix by its name, or from its columns.
    pub fn matrix(&mut self, s: &Scope, size: u8, depth: u32) -> Expr {
        let known: Vec<&String> =
            s.matrices.iter().filter(|(_, found)| *found == size).map(|(text, _)| text).collect();
        if !known.is_empty() && self.choices.chance(70) {
            return Expr::primary(self.choices.pick(&known).as_str());
        }
        match self.choices.below(8) {
            0 if size == 2 => {
                let angle = self.fitting(s, Ty::FLOAT, depth.min(2)).text;
                Expr::primary(format!("rotation({angle})"))
            }
            1 | 2 if depth > 0 => {
                let node = *self.choices.pick(&["transpose", "inverse"]);
                Expr::primary(format!("{node}({})", self.matrix(s, size, depth - 1).text))
            }
            3 if depth > 0 => {
                let factor = self.exact(s, Ty::FLOAT, depth.min(2)).at_least(6);
                Expr::product(format!("{} * {factor}", self.matrix(s, size, depth - 1).at_least(5)))
            }
            4 if depth > 0 => {
                let right = self.matrix(s, size, depth - 1).at_least(6);
                Expr::product(format!("{} * {right}", self.matrix(s, size, depth - 1).at_least(5)))
            }
            5 => {
                let entries = (0..size * size).map(|_| self.fitting(s, Ty::FLOAT, 1).text);
                Expr::primary(format!("mat{size}({})", entries.collect::<Vec<_>>().join(", ")))
            }
            _ => {
                let columns = (0..size).map(|_| self.exact(s, Ty::float(size), depth.min(2)).text);
                Expr::primary(format!("mat{size}({})", columns.collect::<Vec<_>>().join(", ")))
            }
        }
    }

    /// `table[i]` of a constant table.
    pub fn entry(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        if !self.features.tables || ty.width == N {
            return None;
        }
        let index = self.exact(s, Ty::INT, depth).text;
        let known: Vec<&String> =
            s.tables.iter().filter(|(_, found)| *found == ty).map(|(text, _)| text).collect();
        if !known.is_empty() && self.choices.chance(70) {
            return Some(Expr::primary(format!("{}[{index}]", self.choices.pick(&known))));
        }
        let table = self.table(s, ty);
        Some(Expr::primary(format!("{table}[{index}]")))
    }

    /// A constant table.
    pub fn table(&mut self, s: &Scope, ty: Ty) -> String {
        let known = s.constants();
        let entries: Vec<String> =
            (0..=self.choices.below(5)).map(|_| self.exact(&known, ty, 1).text).collect();
        format!("[{}]", entries.join(", "))
    }

    /// A lambda, or a named node of the same inputs and outputs.
    pub fn node_argument(
        &mut self,
        s: &Scope,
        inputs: &[Ty],
        outputs: &[(String, Ty)],
        n: u8,
        depth: u32,
    ) -> Option<Expr> {
        let alike: Vec<String> = self
            .callables
            .iter()
            .filter(|callable| {
                let takes = callable.inputs.iter().map(|input| &input.takes);
                !callable.generic
                    && takes.eq(inputs.iter().map(|ty| super::types::Takes::Value(ty.bound(n))).collect::<Vec<_>>().iter())
                    && callable.outputs.iter().map(|(_, ty)| *ty).eq(outputs.iter().map(|(_, ty)| ty.bound(n)))
                    // A record is matched by its names.
                    && (outputs.len() == 1 || callable.outputs == outputs)
                    && callable.steps.saturating_mul(s.steps) <= MOST_AROUND
            })
            .map(|callable| callable.text.clone())
            .collect();
        let several = outputs.len() > 1;
        if !alike.is_empty() && (several || self.choices.chance(50)) {
            return Some(Expr::primary(self.choices.pick(&alike).as_str()));
        }
        let [(_, output)] = outputs else { return None };
        let mut inner = s.clone();
        let names: Vec<String> = inputs
            .iter()
            .map(|ty| {
                let name = self.fresh();
                inner.declare(name.clone(), ty.bound(n), Rate::Pixel, Rate::Load);
                name
            })
            .collect();
        // A node that gets it may call it in its folds.
        inner.steps = inner.steps.saturating_mul(16);
        let body = self.fitting(&inner, output.bound(n), depth.min(2)).text;
        Some(Expr::primary(format!("|{}| {body}", names.join(", "))))
    }
}
