//! One function of the graph as one naga function.

use super::body::Body;
use super::frame::{Argument, Frame, has_sampler};
use super::types::Types;
use super::{Callee, Lowering, Member};
use crate::contract::Reads;
use crate::graph::regions::{Region, Regions, draw_rate};
use crate::graph::{Axis, Function, FunctionId, Type};
use crate::manifest::{self, Form, Gradient, Manifest};
use crate::naming::{Scope, camel_case};
use naga::{Expression, Handle, Span};
use smol_str::{SmolStr, format_smolstr};

impl<'a> Lowering<'a> {
    /// Lowers function `index` of the graph; its callees are lowered already. `public` is the name
    /// of what hosts call.
    pub(super) fn function(&mut self, index: usize, public: &str) {
        let graph = self.graph;
        let source = &graph.functions[index];
        let reads = self.reads[index].clone();
        let is_entry = FunctionId(index as u32) == graph.entry();
        let name = match self.manifest.form {
            Form::Functions if is_entry => public.into(),
            _ => self.module_name(if is_entry { "texture" } else { &source.name }),
        };
        let mut scope = Scope::inside(&self.prefix);
        let arguments = self.arguments(source, &reads, is_entry, &mut scope);
        let result = self.result_type(source, &name);
        let mut function = naga::Function {
            name: Some(self.names.placeholder(name)),
            arguments,
            result: Some(naga::FunctionResult { ty: result, binding: None }),
            ..Default::default()
        };
        let mut body = Body::new(&mut function, scope);
        let first = if is_entry { draw_rate(source, &self.weights) } else { Vec::new() };
        let regions = Regions::inside(source, &self.weights, 0, &first);
        let mut frame = Frame::new(source, regions);
        if is_entry && self.manifest.gradients.is_empty() {
            frame.find_slopes(&first);
        }
        let inputs = self.bind_arguments(&mut body, source, &reads, is_entry);
        frame.bind(&inputs);
        self.numbers(&mut body, &mut frame);
        self.first(&mut body, &mut frame, &first);
        self.block(&mut body, &mut frame, Region::TOP);
        let outputs: Vec<Handle<Expression>> =
            source.outputs.iter().map(|(_, value)| self.operand(&mut body, &frame, *value)).collect();
        let value = match outputs.as_slice() {
            [single] => *single,
            _ => body.add(Expression::Compose { ty: result, components: outputs }),
        };
        self.results.push(body.finish(value));
        let handle = self.module.functions.append(function, Span::UNDEFINED);
        self.linked.add(source, handle);
        self.functions[index] = Some(Callee::new(handle, source));
    }

    /// The type of a function's result: its only output, or a struct of all.
    pub(super) fn result_type(&mut self, source: &Function, name: &str) -> Handle<naga::Type> {
        let types: Vec<Handle<naga::Type>> =
            source.outputs.iter().map(|(slot, _)| self.types.get(&mut self.module.types, slot.ty)).collect();
        match types.as_slice() {
            [single] => *single,
            _ => {
                let members = source.outputs.iter().zip(types);
                let members =
                    members.map(|((slot, _), ty)| Member { name: slot.name.clone(), ty, binding: None });
                self.structure(&camel_case(name), members.collect())
            }
        }
    }

    /// Inputs, params, views; a sampled view is a texture and a sampler.
    fn arguments(
        &mut self,
        source: &Function,
        reads: &Reads,
        is_entry: bool,
        scope: &mut Scope,
    ) -> Vec<naga::FunctionArgument> {
        let mut slots: Vec<(SmolStr, Type)> = source.inputs.iter().map(|s| (s.name.clone(), s.ty)).collect();
        slots.extend(
            self.gradients(is_entry)
                .map(|(input, gradient)| (gradient.name.as_str().into(), source.inputs[input].ty)),
        );
        for id in &reads.params {
            let param = &self.graph.params[id.0 as usize];
            slots.push((param.name.as_str().into(), param.ty));
        }
        for id in &reads.views {
            let view = &self.graph.views[id.0 as usize];
            let resource = &self.graph.resources[view.resource as usize];
            slots.push((format_smolstr!("{}_{}", resource.name, view.field), Type::View(view.view)));
        }
        let mut arguments = Vec::new();
        for (wish, ty) in slots {
            let name = scope.name(&wish);
            let placeholder = self.names.placeholder(name);
            let handle = self.types.get(&mut self.module.types, ty);
            arguments.push(naga::FunctionArgument { name: Some(placeholder), ty: handle, binding: None });
            if has_sampler(ty) {
                let resource = wish.rsplit_once('_').map_or(&*wish, |(resource, _)| resource);
                let sampler = format_smolstr!("{resource}_sampler");
                let placeholder = self.names.placeholder(scope.name(&sampler));
                let ty = Types::sampler(&mut self.module.types);
                arguments.push(naga::FunctionArgument { name: Some(placeholder), ty, binding: None });
            }
        }
        arguments
    }

    /// The derivatives that the texture is given, each with the place of its input.
    pub(super) fn gradients(&self, is_entry: bool) -> impl Iterator<Item = (usize, &'a Gradient)> + use<'a> {
        let manifest: &'a Manifest = self.manifest;
        let gradients = manifest.gradients.iter().filter(move |_| is_entry);
        gradients.filter_map(|gradient| {
            Some((manifest.inputs.iter().position(|input| input.name == gradient.input)?, gradient))
        })
    }

    /// Tells a body where its arguments are; the inputs among them, in order.
    fn bind_arguments(
        &mut self,
        body: &mut Body,
        source: &Function,
        reads: &Reads,
        is_entry: bool,
    ) -> Vec<Argument> {
        let mut next = 0;
        let mut argument = |body: &mut Body, ty: Type| {
            let handle = body.add(Expression::FunctionArgument(next));
            next += 1;
            if has_sampler(ty) {
                let sampler = body.add(Expression::FunctionArgument(next));
                next += 1;
                body.samplers.insert(handle, sampler);
            }
            handle
        };
        let inputs = source.inputs.iter();
        let inputs: Vec<Argument> =
            inputs.map(|slot| Argument { handle: argument(body, slot.ty), known: None }).collect();
        for (input, gradient) in self.gradients(is_entry) {
            let handle = argument(body, source.inputs[input].ty);
            let axis = match gradient.axis {
                manifest::Axis::X => Axis::X,
                manifest::Axis::Y => Axis::Y,
            };
            body.gradients.insert((inputs[input].handle, axis), handle);
        }
        for id in &reads.params {
            let handle = argument(body, self.graph.params[id.0 as usize].ty);
            body.params.insert(*id, handle);
        }
        for id in &reads.views {
            let handle = argument(body, Type::View(self.graph.views[id.0 as usize].view));
            body.views.insert(*id, handle);
        }
        inputs
    }
}
