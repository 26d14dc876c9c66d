//! The statements of a body, in any order.

use super::program::Generator;
use super::types::{Rate, Scope, Ty};

/// How deep an expression nests.
const DEPTH: u32 = 4;

impl Generator<'_, '_> {
    /// Some `let`s, and every output once.
    pub fn body(&mut self, s: &mut Scope, outputs: &[(String, Ty)]) -> String {
        let mut lines = Vec::new();
        for _ in 0..self.choices.below(6) {
            lines.push(self.statement(s));
        }
        for (name, ty) in outputs {
            let depth = 1 + self.choices.below(DEPTH as usize) as u32;
            lines.push(format!("{name} = {}", self.fitting(s, *ty, depth).text));
            // An output may be read as a wire.
            s.declare(name.clone(), *ty, Rate::Pixel, Rate::Load);
        }
        self.choices.shuffle(&mut lines);
        let mut text = String::from("{\n");
        for line in lines {
            text.push_str(&self.aside());
            text.push_str(&line);
            text.push('\n');
        }
        text + "}"
    }

    fn statement(&mut self, s: &mut Scope) -> String {
        match self.choices.below(10) {
            0 | 1 => self.record(s),
            2 => self.fold_statement(s),
            3 => self.matrix_or_table(s),
            _ => None,
        }
        .unwrap_or_else(|| self.value(s))
    }

    fn value(&mut self, s: &mut Scope) -> String {
        let ty = if self.choices.chance(15) { Ty::BOOL } else { self.some_number(s) };
        let depth = self.choices.below(DEPTH as usize + 1) as u32;
        let value = self.exact(s, ty, depth).text;
        let name = self.fresh();
        s.declare(name.clone(), ty, Rate::Pixel, Rate::Load);
        format!("let {name} = {value}")
    }

    /// `let (a, b) = …`, or `let r = …` for `r.a`.
    fn record(&mut self, s: &mut Scope) -> Option<String> {
        let (call, outputs) = self.record_call(s, 2)?;
        Some(self.bind_record(s, &call, outputs))
    }

    fn bind_record(&mut self, s: &mut Scope, call: &str, outputs: Vec<(String, Ty)>) -> String {
        if self.choices.chance(40) {
            let record = self.fresh();
            for (field, ty) in outputs {
                s.declare(format!("{record}.{field}"), ty, Rate::Pixel, Rate::Load);
            }
            return format!("let {record} = {call}");
        }
        let names: Vec<String> = outputs
            .iter()
            .map(|(_, ty)| {
                let name = self.fresh();
                s.declare(name.clone(), *ty, Rate::Pixel, Rate::Load);
                name
            })
            .collect();
        format!("let ({}) = {call}", names.join(", "))
    }

    /// A fold of several accumulators.
    fn fold_statement(&mut self, s: &mut Scope) -> Option<String> {
        let accumulators: Vec<(String, Ty)> = (0..2 + self.choices.below(2))
            .map(|_| {
                let ty = if self.choices.chance(15) { Ty::BOOL } else { self.some_number(s) };
                (self.fresh(), ty)
            })
            .collect();
        let fold = self.fold(s, &accumulators, 2)?;
        Some(self.bind_record(s, &fold, accumulators))
    }

    fn matrix_or_table(&mut self, s: &mut Scope) -> Option<String> {
        let name = self.fresh();
        if self.features.matrices && self.choices.chance(50) {
            let size = *self.choices.pick(&[2, 3]);
            // Not one that is there already, which would be the same value under two names.
            let nameless = Scope { matrices: Vec::new(), ..s.clone() };
            let matrix = self.matrix(&nameless, size, 2).text;
            s.matrices.push((name.clone(), size));
            return Some(format!("let {name} = {matrix}"));
        }
        if !self.features.tables {
            return None;
        }
        let ty = Ty { width: 1 + self.choices.below(4) as u8, ..self.some_number(s) };
        let table = self.table(s, ty);
        s.tables.push((name.clone(), ty));
        Some(format!("let {name} = {table}"))
    }
}
