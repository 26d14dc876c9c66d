//! The clause `tiles` of a texture: its period, and the proof that its outputs repeat.

use super::wire::Wire;
use super::{Checker, Frame, Key, Step, Target};
use crate::diagnostic::{Place, tiling as sentences};
use crate::graph::{FunctionId, Scalar};
use crate::tiling::{Culprit, Walk, What};
use smol_str::SmolStr;
use texgraph_grammar::syntax::{Expr, ItemKind, Node};

/// The axes of `uv`, as errors name them.
const AXES: [&str; 2] = ["u", "v"];

/// What breaks a period, with the axes along which it does and the outputs that it breaks.
struct Breach {
    culprit: Culprit,
    axes: Vec<&'static str>,
    outputs: Vec<SmolStr>,
}

impl<'a> Checker<'a> {
    /// The period of a texture of the main file, by its key, if it was proved to have one: how far
    /// `uv` moves along each axis until the picture comes again, 0 where it need not.
    pub fn period(&self, key: &Key) -> Option<[f32; 2]> {
        self.periods.get(&key.item).copied().filter(|_| key.wire.is_none())
    }

    /// Proves that the outputs of a texture repeat as it asks for, or says what breaks it.
    pub(super) fn check_tiles(&mut self, module: usize, item: usize, function: FunctionId) {
        let modules = self.modules;
        let ItemKind::Texture { node, tiles: Some(tiles) } = &modules[module].tree.items[item].kind else {
            return;
        };
        let clause = Place { file: modules[module].file, span: tiles.span };
        if !node.inputs.iter().any(|input| input.name.text == "uv") {
            self.diagnostics.push(sentences::no_uv(clause));
            return;
        }
        self.evaluate_period(module, item, tiles);
        let Some(period) = self.periods.get(&item).copied() else { return };
        for breach in self.breaches(function, period) {
            let place = self.place_of(&breach.culprit, module, node);
            let culprit = Culprit { place, ..breach.culprit };
            let period = self.has_period(&culprit);
            self.diagnostics.push(sentences::does_not_tile(
                &culprit,
                &breach.axes,
                &breach.outputs,
                clause,
                period,
            ));
        }
    }

    /// Works out the period; what is wrong with it is reported.
    fn evaluate_period(&mut self, module: usize, item: usize, tiles: &'a Expr) {
        let mut f = Frame::empty();
        f.module = module;
        f.steps.push(Step { target: Target::Tiles(item), value: tiles });
        f.bind_steps();
        self.sort(&mut f);
        self.run(f);
    }

    /// The period of a texture is a constant, above 0 along one axis at least.
    pub(super) fn set_period(&mut self, f: &mut Frame<'a>, item: usize, wire: &Wire, place: Place) {
        let Some(value) = self.coerce_value(f, wire, Scalar::Float, 2, place) else { return };
        let Some(period) = f.builder.as_constant(value) else {
            self.report(f, sentences::period_not_constant(place));
            return;
        };
        let period = [period.float(0), period.float(1)];
        let is_length = |length: &f32| *length >= 0.0 && length.is_finite();
        if !period.iter().all(is_length) || period == [0.0, 0.0] {
            self.report(f, sentences::period_not_positive(place));
            return;
        }
        self.periods.insert(item, period);
    }

    /// What breaks a period, axis by axis; each culprit once.
    fn breaches(&self, function: FunctionId, period: [f32; 2]) -> Vec<Breach> {
        let mut breaches: Vec<Breach> = Vec::new();
        for (axis, length) in period.into_iter().enumerate().filter(|(_, length)| *length > 0.0) {
            let globals = (self.params.as_slice(), self.views.as_slice(), self.resources.as_slice());
            let walk = Walk::new(&self.functions, globals, self.library.modules().len() as u32);
            for (culprit, outputs) in walk.culprits(function, axis, length) {
                let same = |breach: &&mut Breach| {
                    (breach.culprit.place, &breach.culprit.name) == (culprit.place, &culprit.name)
                };
                if let Some(known) = breaches.iter_mut().find(same) {
                    known.axes.push(AXES[axis]);
                    let new = outputs.into_iter().filter(|output| !known.outputs.contains(output));
                    let new: Vec<SmolStr> = new.collect();
                    known.outputs.extend(new);
                } else {
                    breaches.push(Breach { culprit, axes: vec![AXES[axis]], outputs });
                }
            }
        }
        breaches
    }

    /// A culprit's place; the texture's name for what stands nowhere in the author's files.
    fn place_of(&self, culprit: &Culprit, module: usize, node: &Node) -> Place {
        let is_written = culprit.place.file as usize >= self.library.modules().len();
        let head = Place { file: self.modules[module].file, span: node.name.span };
        if is_written { culprit.place } else { head }
    }

    /// Whether a culprit is a node of the library that can be given a period.
    fn has_period(&self, culprit: &Culprit) -> bool {
        let library = self.library.modules().iter();
        let mut nodes = library.flat_map(|module| &module.tree.items).filter_map(super::globals::node_of);
        culprit.kind == What::Node
            && nodes.any(|node| {
                node.name.text == culprit.name && node.inputs.iter().any(|input| input.name.text == "period")
            })
    }
}
