//! Running the steps of a function: what each makes goes to the names that it binds.

use super::types::{self, Declared};
use super::wire::Wire;
use super::{Checker, Frame, Step, Target};
use crate::diagnostic::{Place, limits, types as type_errors};
use std::rc::Rc;
use texgraph_grammar::syntax::{Expr, Name, Pattern};

impl<'a> Checker<'a> {
    /// Runs steps until the function is done (true) or one has to wait (false).
    pub(super) fn step(&mut self, f: &mut Frame<'a>) -> bool {
        while let Some(step) = f.order.get(f.next) {
            let Step { target, value } = f.steps[*step];
            let (mark, failed, unknown) = (self.diagnostics.len(), f.failed, f.unknown.len());
            let values = f.builder.function().values.len();
            f.current = target.name();
            let wire = match target {
                Target::Render(item) => self.render_node(f, item),
                _ => self.expr(f, value),
            };
            if !f.waiting.is_empty() {
                // What was said while waiting may be a consequence of it; the step runs again.
                self.diagnostics.truncate(mark);
                f.unknown.truncate(unknown);
                f.failed = failed;
                // Values stand in the order of a step that finds everything made.
                let kept = f.progress.values().map(|progress| progress.values).max().unwrap_or(0);
                f.builder.rewind(kept.max(values));
                return false;
            }
            self.finish_step(f, target, value, wire);
            if !f.waiting.is_empty() {
                // The ends of a param's range may call nodes too.
                self.diagnostics.truncate(mark);
                f.unknown.truncate(unknown);
                f.failed = failed;
                return false;
            }
            f.next += 1;
            f.progress.clear();
            if self.values + f.builder.function().values.len() > limits::MAX_VALUES {
                // Said once; the functions that wait for this one are over the bound too.
                f.failed = true;
                if std::mem::replace(&mut self.overfull, true) {
                    return true;
                }
                let place = self.place(f, value.span);
                let name = f.builder.function().name.clone();
                self.report(f, limits::too_many_values(place, &name));
                return true;
            }
        }
        true
    }

    fn finish_step(&mut self, f: &mut Frame<'a>, target: Target<'a>, value: &'a Expr, wire: Wire) {
        let place = self.place(f, value.span);
        match target {
            Target::Let(Pattern::Name(name)) => self.bind(f, name, wire),
            Target::Let(Pattern::Record(names, span)) => {
                let place = self.place(f, *span);
                self.take_apart(f, names, wire, place);
            }
            Target::Output(name) => self.set_output(f, name, wire, place),
            Target::Global(name, doc) => self.set_global(f, name, doc, wire, place),
            Target::Param(item) => self.set_param(f, item, wire, place),
            Target::Default(input) => self.check_default(f, input, wire, place),
            Target::Tiles(item) => self.set_period(f, item, &wire, place),
            Target::Render(_) => {
                let name = f.key.as_ref().and_then(|key| key.wire.clone());
                self.output_parts(f, name.as_deref().unwrap_or("value"), wire, place);
            }
        }
    }

    pub(super) fn bind(&mut self, f: &mut Frame<'a>, name: &'a Name, wire: Wire) {
        if let Wire::Value(value) = wire {
            f.builder.name(value, name.text.as_str());
        }
        // A bare word that reaches a wire is a name that nobody declared.
        let wire =
            if let Wire::Word(word) = wire { self.unknown_value(f, &word.text, word.place) } else { wire };
        let is_doubtful = f.doubtful.contains(name.text.as_str());
        f.failed |= is_doubtful;
        let wire = if is_doubtful { Wire::Unknown } else { wire };
        if let Some(scope) = f.scopes.last_mut()
            && !f.repeated.contains(&name.span.start)
        {
            scope.insert(&name.text, wire);
        }
    }

    pub(super) fn take_apart(&mut self, f: &mut Frame<'a>, names: &'a [Name], wire: Wire, place: Place) {
        let wire =
            if let Wire::Word(word) = wire { self.unknown_value(f, &word.text, word.place) } else { wire };
        let outputs = match &wire {
            Wire::Record(outputs) => Rc::clone(outputs),
            Wire::Unknown => Rc::new(Vec::new()),
            _ => {
                self.report(f, type_errors::not_a_record(place));
                Rc::new(Vec::new())
            }
        };
        if matches!(wire, Wire::Record(_)) && outputs.len() != names.len() {
            let known: Vec<String> = outputs.iter().map(|(name, _)| name.to_string()).collect();
            self.report(f, type_errors::destructuring(place, names.len(), &known));
            // The outputs that got no name may be read by their own: that is the same slip.
            known.iter().for_each(|name| f.unknown.insert(name));
        }
        let fits = outputs.len() == names.len();
        for (i, name) in names.iter().enumerate() {
            let output = outputs.get(i).filter(|_| fits);
            let wire = output.map_or(Wire::Unknown, |(_, wire)| wire.clone());
            self.bind(f, name, wire);
        }
    }

    fn set_output(&mut self, f: &mut Frame<'a>, name: &'a Name, wire: Wire, place: Place) {
        let declared = f.node.and_then(|node| node.outputs.iter().find(|o| o.name.text == name.text));
        if f.doubtful.contains(name.text.as_str()) {
            f.failed = true;
            return self.bind(f, name, Wire::Unknown);
        }
        let wire =
            match declared.map(|output| types::resolve(&output.ty, &f.dims, self.modules[f.module].file)) {
                Some(Ok(Declared::Vector(scalar, width))) => self
                    .coerce_named(f, &wire, (scalar, width), place, Some(&name.text))
                    .map_or(Wire::Unknown, Wire::Value),
                Some(Ok(Declared::Matrix(size))) => {
                    self.coerce_matrix(f, &wire, size, place).map_or(Wire::Unknown, Wire::Matrix)
                }
                Some(Ok(_)) => {
                    let ty = declared.map(|o| types::show(&o.ty)).unwrap_or_default();
                    let place = self.place(f, declared.map_or(name.span, |o| o.ty.span));
                    self.report(f, type_errors::type_not_allowed(place, &ty, "an output"))
                }
                Some(Err(diagnostic)) => self.report(f, diagnostic),
                None => Wire::Unknown,
            };
        self.bind(f, name, wire);
    }
}

#[cfg(test)]
mod tests {
    use crate::library::Library;
    use crate::{Options, compile};
    use std::collections::HashMap;

    const TEXT: &str = "
node inner(x: float) -> (y: float) {
    let s = sin(x)
    y = s * s + s
}

node outer(x: float) -> (y: float) {
    let a = x * 3.0
    y = inner(a + 1.0) * 2.0 + tan(x) * cos(a)
}

texture waits(uv: vec2) -> (v: float) {
    v = outer(uv.x)
}

texture finds(uv: vec2) -> (v: float) {
    let before = inner(uv.y)
    v = outer(uv.x) + before
}
";

    #[test]
    fn a_node_is_the_same_whether_or_not_it_waited() {
        let library = Library::standard().unwrap();
        let files: HashMap<String, String> = [("t.tex".to_owned(), TEXT.to_owned())].into();
        let [waits, finds] = ["waits", "finds"].map(|texture| {
            let options = Options { texture: Some(texture.to_owned()), ..Options::default() };
            let program = compile(&library, "t.tex", &files, &options).unwrap().program;
            let wgsl = program.passes[0].wgsl.replace(texture, "");
            let (_, outer) = wgsl.split_once("fn _outer(").expect("it is a function");
            outer.split_once("\n}").expect("it ends").0.to_owned()
        });
        assert_eq!(waits, finds);
    }
    #[test]
    fn what_only_calls_another_is_taken_over() {
        let library = Library::standard().unwrap();
        let text = "texture t(uv: vec2) -> (v: float) { v = noise(uv, width: 0.0) }";
        let files: HashMap<String, String> = [("t.tex".to_owned(), text.to_owned())].into();
        let program = compile(&library, "t.tex", &files, &Options::default()).unwrap().program;
        let wgsl = &program.passes[0].wgsl;
        assert_eq!(wgsl.matches("fn t_noise").count(), 1, "{wgsl}");
    }

    #[test]
    fn bits_are_compared_with_0_where_they_stand() {
        let library = Library::standard().unwrap();
        let text = "texture t(uv: vec2) -> (v: float) {
    let n = ifloor(uv.x * 100.0)
    v = (if bits(n, 3, 2) != 0 { 1.0 } else { 0.0 }) + (if bits(n, 30, 2) == 0 { 1.0 } else { 0.0 })
}";
        let files: HashMap<String, String> = [("t.tex".to_owned(), text.to_owned())].into();
        let program = compile(&library, "t.tex", &files, &Options::default()).unwrap().program;
        let wgsl = &program.passes[0].wgsl;
        assert!(wgsl.contains("(n & 24i) != 0i"), "{wgsl}");
        // The sign is no bit of a positive mask.
        assert!(wgsl.contains("((n >> 30u) & 3i) == 0i"), "{wgsl}");
    }
}
