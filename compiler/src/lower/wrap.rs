//! The thin wrapper around a texture's plain function: where globals are read.

use super::body::Body;
use super::types::{Types, numeric, scalar};
use super::{Lowering, Member};
use crate::graph::{Scalar, Slot, Type, Value, ViewId};
use crate::manifest::{Form, Source};
use crate::naming::{Scope, camel_case};
use naga::{AddressSpace, Binding, Expression, GlobalVariable, Handle, Literal, Span};
use rustc_hash::FxHashMap;
use smol_str::SmolStr;

/// The globals of the module.
struct Globals {
    block: Option<UniformBlock>,
    views: FxHashMap<ViewId, (Handle<GlobalVariable>, Option<Handle<GlobalVariable>>)>,
}

/// The uniform block with its members' names and types, in order.
struct UniformBlock {
    variable: Handle<GlobalVariable>,
    members: Vec<(SmolStr, Type)>,
}

impl Lowering<'_> {
    /// Makes the wrapper that the manifest asks for.
    pub(super) fn wrap(&mut self, name: &str) {
        let wrapper = match self.manifest.form {
            Form::Complete => Self::entry_point,
            Form::Library => Self::library,
            Form::Functions => return,
        };
        let globals = self.globals();
        wrapper(self, name, &globals);
    }

    /// Declares the uniform block, the textures and the samplers.
    fn globals(&mut self) -> Globals {
        let block = self.uniform_block();
        let mut views = FxHashMap::default();
        // The entry, which is last, reads what all the others read.
        let read = self.reads.last().map(|reads| reads.views.clone());
        for id in read.unwrap_or_default() {
            let view = &self.graph.views[id.0 as usize];
            let resource = &self.manifest.resources[view.resource as usize];
            let Some(texture) = resource.textures.iter().find(|t| t.field == view.field) else { continue };
            let ty = self.types.get(&mut self.module.types, Type::View(view.view));
            let variable =
                self.global(&texture.name, AddressSpace::Handle, ty, texture.group, texture.binding);
            let sampler = texture.sampler.as_ref().map(|sampler| {
                let ty = Types::sampler(&mut self.module.types);
                self.global(&sampler.name, AddressSpace::Handle, ty, sampler.group, sampler.binding)
            });
            views.insert(id, (variable, sampler));
        }
        Globals { block, views }
    }

    fn global(
        &mut self,
        name: &str,
        space: AddressSpace,
        ty: Handle<naga::Type>,
        group: u32,
        binding: u32,
    ) -> Handle<GlobalVariable> {
        let variable = GlobalVariable {
            name: Some(self.names.placeholder(name)),
            space,
            binding: Some(naga::ResourceBinding { group, binding }),
            ty,
            init: None,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        self.module.global_variables.append(variable, Span::UNDEFINED)
    }

    /// The params that are read, then the inputs that are the same for a draw, in offset order.
    fn uniform_block(&mut self) -> Option<UniformBlock> {
        let uniform = self.manifest.uniform.as_ref()?;
        let mut members: Vec<(u32, SmolStr, Type)> = Vec::new();
        for (param, public) in self.graph.params.iter().zip(&self.manifest.params) {
            members.extend(public.offset.map(|offset| (offset, param.name.as_str().into(), param.ty)));
        }
        let entry = self.graph.function(self.graph.entry());
        for (slot, public) in entry.inputs.iter().zip(&self.manifest.inputs) {
            if let Source::Uniform(offset) = public.source {
                members.push((offset, slot.name.clone(), slot.ty));
            }
        }
        // A bake has none of its texture's inputs.
        if members.is_empty() {
            return None;
        }
        members.sort_by_key(|(offset, ..)| *offset);
        let fields = members
            .iter()
            .map(|(_, name, ty)| {
                // A bool can't stand in a uniform block.
                let kind = if ty.scalar() == Some(Scalar::Bool) { naga::Scalar::U32 } else { scalar_of(*ty) };
                let ty = Types::of(&mut self.module.types, numeric(kind, ty.width()));
                Member { name: name.clone(), ty, binding: None }
            })
            .collect();
        let ty = self.structure(&camel_case(&uniform.name), fields);
        let variable = self.global(&uniform.name, AddressSpace::Uniform, ty, uniform.group, uniform.binding);
        let members = members.into_iter().map(|(_, name, ty)| (name, ty)).collect();
        Some(UniformBlock { variable, members })
    }

    /// A member of the uniform block, loaded.
    fn member(&mut self, body: &mut Body, globals: &Globals, name: &str) -> Handle<Expression> {
        let Some(UniformBlock { variable, members }) = &globals.block else {
            unreachable!("a param is read from a block")
        };
        let index = members.iter().position(|(member, _)| member == name).unwrap_or(0);
        let ty = members[index].1;
        let base = body.add(Expression::GlobalVariable(*variable));
        let pointer = body.add(Expression::AccessIndex { base, index: index as u32 });
        let loaded = body.add(Expression::Load { pointer });
        body.name(&mut self.names, loaded, name);
        if ty.scalar() != Some(Scalar::Bool) {
            return loaded;
        }
        let zero = body.literal(Literal::U32(0));
        body.binary(naga::BinaryOperator::NotEqual, loaded, zero)
    }

    /// Calls the plain function: inputs and their derivatives as given, the rest from globals.
    fn call_plain(
        &mut self,
        body: &mut Body,
        globals: &Globals,
        inputs: Vec<Handle<Expression>>,
    ) -> Handle<Expression> {
        let mut arguments = inputs;
        let entry = self.graph.entry();
        let reads = self.reads[entry.0 as usize].clone();
        for id in &reads.params {
            let name = self.graph.params[id.0 as usize].name.clone();
            arguments.push(self.member(body, globals, &name));
        }
        for id in &reads.views {
            let (texture, sampler) = globals.views[id];
            for variable in std::iter::once(texture).chain(sampler) {
                arguments.push(body.add(Expression::GlobalVariable(variable)));
            }
        }
        body.call(self.callee(entry).handle, arguments, "result")
    }

    /// Adds an argument that the rasteriser gives; its number.
    fn varying(&mut self, function: &mut naga::Function, name: SmolStr, ty: Type, location: u32) -> u32 {
        let binding = Some(at_location(location, ty.is_float()));
        let ty = self.types.get(&mut self.module.types, ty);
        let name = Some(self.names.placeholder(name));
        function.arguments.push(naga::FunctionArgument { name, ty, binding });
        function.arguments.len() as u32 - 1
    }

    /// The type of what an entry point gives: every output widened to four floats.
    fn targets(&mut self, outputs: &[(Slot, Value)]) -> (Handle<naga::Type>, Option<Binding>) {
        let floats = Types::of(&mut self.module.types, numeric(naga::Scalar::F32, 4));
        if outputs.len() <= 1 {
            return (floats, Some(at_location(0, true)));
        }
        let members = outputs.iter().enumerate().map(|(i, (slot, _))| Member {
            name: slot.name.clone(),
            ty: floats,
            binding: Some(at_location(i as u32, true)),
        });
        let name = camel_case(&format!("{}_targets", self.prefix));
        (self.structure(&name, members.collect()), None)
    }

    /// `@fragment fn NAME(@location(0) uv: vec2<f32>) -> …`, every output widened to four floats.
    fn entry_point(&mut self, name: &str, globals: &Globals) {
        let entry = self.graph.function(self.graph.entry());
        let mut scope = Scope::inside(&self.prefix);
        let mut function = naga::Function::default();
        let mut varying = Vec::new();
        for (slot, public) in entry.inputs.iter().zip(&self.manifest.inputs) {
            let Source::Varying(location) = public.source else {
                varying.push(None);
                continue;
            };
            let name = scope.name(&slot.name);
            varying.push(Some(self.varying(&mut function, name, slot.ty, location)));
        }
        let mut given = Vec::new();
        for (input, gradient) in self.gradients(true) {
            let Source::Varying(location) = gradient.source else { continue };
            let name = scope.name(&gradient.name);
            given.push(self.varying(&mut function, name, entry.inputs[input].ty, location));
        }
        let (result, binding) = self.targets(&entry.outputs);
        function.result = Some(naga::FunctionResult { ty: result, binding });
        let mut body = Body::new(&mut function, scope);
        let mut inputs: Vec<Handle<Expression>> = entry
            .inputs
            .iter()
            .zip(varying)
            .map(|(slot, argument)| match argument {
                Some(argument) => body.add(Expression::FunctionArgument(argument)),
                None => self.member(&mut body, globals, &slot.name),
            })
            .collect();
        inputs.extend(given.into_iter().map(|argument| body.add(Expression::FunctionArgument(argument))));
        let value = self.call_plain(&mut body, globals, inputs);
        let outputs: Vec<Handle<Expression>> = entry
            .outputs
            .iter()
            .enumerate()
            .map(|(i, (slot, _))| {
                let value = if entry.outputs.len() > 1 {
                    body.add(Expression::AccessIndex { base: value, index: i as u32 })
                } else {
                    value
                };
                self.widened(&mut body, value, slot)
            })
            .collect();
        self.discard(&mut body, &outputs);
        let value = match outputs.as_slice() {
            [single] => *single,
            _ => body.add(Expression::Compose { ty: result, components: outputs }),
        };
        self.results.push(body.finish(value));
        self.module.entry_points.push(naga::EntryPoint {
            name: self.names.placeholder(name),
            stage: naga::ShaderStage::Fragment,
            early_depth_test: None,
            workgroup_size: [0; 3],
            workgroup_size_overrides: None,
            function,
            mesh_info: None,
            task_payload: None,
            incoming_ray_payload: None,
        });
    }

    /// Ends the pixels that cover too little.
    fn discard(&mut self, body: &mut Body, outputs: &[Handle<Expression>]) {
        let entry = self.graph.function(self.graph.entry());
        let color = entry.outputs.iter().position(|(slot, _)| slot.name == "color");
        let (Some(bound), Some(color)) = (self.manifest.discard_below, color) else { return };
        let alpha = body.add(Expression::AccessIndex { base: outputs[color], index: 3 });
        let bound = body.literal(Literal::F32(bound));
        let condition = body.binary(naga::BinaryOperator::Less, alpha, bound);
        body.open();
        body.statement(naga::Statement::Kill);
        let accept = body.close();
        body.statement(naga::Statement::If { condition, accept, reject: naga::Block::new() });
    }

    /// `fn NAME(in: NAMEInputs) -> NAMEOutputs`, or `fn NAME(in: NAMEInputs, gradients:
    /// NAMEGradients) -> NAMEOutputs`.
    fn library(&mut self, name: &str, globals: &Globals) {
        let entry = self.graph.function(self.graph.entry());
        let mut scope = Scope::inside(&self.prefix);
        let inputs: Vec<(SmolStr, Type)> =
            entry.inputs.iter().map(|slot| (slot.name.clone(), slot.ty)).collect();
        let outputs = self.members(entry.outputs.iter().map(|(slot, _)| (slot.name.clone(), slot.ty)));
        let gradients = self.gradients(true);
        let gradients: Vec<(SmolStr, Type)> = gradients
            .map(|(input, gradient)| (gradient.name.as_str().into(), entry.inputs[input].ty))
            .collect();
        let mut function = naga::Function { name: Some(self.names.placeholder(name)), ..Default::default() };
        let mut groups = Vec::new();
        for (argument, kind, slots) in [("in", "inputs", inputs), ("gradients", "gradients", gradients)] {
            if slots.is_empty() {
                continue;
            }
            groups.push(slots.len() as u32);
            let members = self.members(slots.into_iter());
            let ty = self.structure(&camel_case(&format!("{}_{kind}", self.prefix)), members);
            let placeholder = self.names.placeholder(scope.name(argument));
            function.arguments.push(naga::FunctionArgument { name: Some(placeholder), ty, binding: None });
        }
        let ty = self.structure(&camel_case(&format!("{}_outputs", self.prefix)), outputs);
        function.result = Some(naga::FunctionResult { ty, binding: None });
        let mut body = Body::new(&mut function, scope);
        let bases: Vec<Handle<Expression>> =
            (0..groups.len() as u32).map(|i| body.add(Expression::FunctionArgument(i))).collect();
        let mut given = Vec::new();
        for (base, count) in bases.into_iter().zip(groups) {
            given.extend((0..count).map(|index| body.add(Expression::AccessIndex { base, index })));
        }
        let value = self.call_plain(&mut body, globals, given);
        let components = if entry.outputs.len() > 1 {
            (0..entry.outputs.len() as u32)
                .map(|index| body.add(Expression::AccessIndex { base: value, index }))
                .collect()
        } else {
            vec![value]
        };
        let value = body.add(Expression::Compose { ty, components });
        self.results.push(body.finish(value));
        self.module.functions.append(function, Span::UNDEFINED);
    }

    /// Members of a struct from names and types.
    fn members(&mut self, slots: impl Iterator<Item = (SmolStr, Type)>) -> Vec<Member> {
        let member = |(name, ty)| {
            let ty = self.types.get(&mut self.module.types, ty);
            Member { name, ty, binding: None }
        };
        slots.map(member).collect()
    }
}

fn scalar_of(ty: Type) -> naga::Scalar {
    scalar(ty.scalar().unwrap_or(Scalar::Float))
}

fn at_location(location: u32, float: bool) -> Binding {
    Binding::Location {
        location,
        interpolation: Some(if float { naga::Interpolation::Perspective } else { naga::Interpolation::Flat }),
        sampling: float.then_some(naga::Sampling::Center),
        blend_src: None,
        per_primitive: false,
    }
}
