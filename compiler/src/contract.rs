//! The manifest of a graph: which names, bindings and offsets its shader has.
//!
//! Lowering reads the names and places from here, so the two can't disagree.

use crate::Options;
use crate::graph::{self, Constant, Graph, Operation, ParamId, PassGraph, Scalar, ViewDimension, ViewId};
use crate::input::is_per_draw;
use crate::manifest::{
    self, Argument, Call, Form, Gradient, Gradients, Input, Manifest, Output, Param, Pass, Recipe, Resource,
    SampleKind, Sampler, Source, Table, Texture, Type, Uniform, Value,
};
use crate::naming::{self, Scope};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// The params and views that are read, in order.
#[derive(Clone, Default)]
pub struct Reads {
    /// Of the whole program.
    pub params: BTreeSet<ParamId>,
    /// Of the whole program.
    pub views: BTreeSet<ViewId>,
}

impl Reads {
    fn extend(&mut self, other: &Reads) {
        self.params.extend(&other.params);
        self.views.extend(&other.views);
    }
}

/// What a graph reads: its entry, and all that it calls.
fn reads(graph: &Graph) -> Reads {
    reads_of_functions(graph).pop().unwrap_or_default()
}

/// What each function reads, itself and through what it calls.
pub fn reads_of_functions(graph: &Graph) -> Vec<Reads> {
    let mut all: Vec<Reads> = Vec::with_capacity(graph.functions.len());
    for function in &graph.functions {
        let mut reads = Reads::default();
        for operation in &function.values {
            match operation {
                Operation::Param(id) => {
                    reads.params.insert(*id);
                }
                Operation::View(id) => {
                    reads.views.insert(*id);
                }
                Operation::Call(callee, _) => reads.extend(&all[callee.0 as usize]),
                Operation::Fold(fold) => {
                    fold.functions().for_each(|part| reads.extend(&all[part.0 as usize]));
                }
                _ => {}
            }
        }
        all.push(reads);
    }
    all
}

/// Everything a host has to know of a program's shaders: bakes with the resources they fill, then
/// the texture. There is at least one graph.
pub fn manifest(graphs: &[PassGraph], label: &str, options: &Options) -> Manifest {
    let Some(PassGraph { graph, .. }) = graphs.last() else { unreachable!("a program has a pass") };
    let entry = graph.function(graph.entry());
    let name = naming::identifier(&entry.name);
    let each: Vec<Reads> = graphs.iter().map(|pass| reads(&pass.graph)).collect();
    let mut all = Reads::default();
    each.iter().for_each(|reads| all.extend(reads));
    let mut block = Block::default();
    let params = params(graph, &bound_params(&each, options.form), &mut block);
    let inputs = inputs(entry, options.form, &mut block);
    let gradients = gradients(entry, &inputs, options);
    let mut next = options.first_binding;
    // Global names are public: they are chosen here, apart from each other, and lowering keeps away.
    let mut scope = Scope::default();
    let entry_point = match options.form {
        Form::Complete => scope.name(&format!("{name}_fragment")),
        Form::Library | Form::Functions => scope.name(&name),
    };
    let uniform = (block.size > 0).then(|| {
        next += 1;
        Uniform {
            name: scope.name(&format!("{name}_params")).to_string(),
            group: options.group,
            binding: options.first_binding,
            size: block.size.next_multiple_of(16),
        }
    });
    let resources = resources(graph, &all, &name, &mut scope, (options.group, next));
    let mut files = Scope::default();
    files.take(&entry.name);
    let passes: Vec<Pass> = graphs
        .iter()
        .zip(&each)
        .map(|(PassGraph { graph: pass, bake }, reads)| {
            let function = pass.function(pass.entry());
            let shader = match bake {
                Some(_) => files.name(&format!("{}_{}", entry.name, function.name)).to_string(),
                None => entry.name.to_string(),
            };
            Pass {
                name: function.name.to_string(),
                bake: *bake,
                reads: views(graph, reads),
                params: reads.params.iter().map(|id| graph.params[id.0 as usize].name.clone()).collect(),
                shader: format!("{shader}.wgsl"),
                entry_point: match bake {
                    Some(_) => format!("{}_fragment", naming::identifier(&shader)),
                    None => entry_point.to_string(),
                },
                call: (bake.is_none() && options.form == Form::Functions)
                    .then(|| call(graph, function, &gradients, reads)),
                gradients: taken(function, bake.is_some(), options),
            }
        })
        .collect();
    Manifest {
        version: manifest::VERSION,
        generator: format!("texgraph {}", env!("CARGO_PKG_VERSION")),
        texture: entry.name.to_string(),
        label: label.to_owned(),
        form: options.form,
        inputs,
        gradients,
        outputs: outputs(entry),
        discard_below: options.discard_below.filter(|_| options.form == Form::Complete),
        tiles: None,
        params,
        uniform,
        passes,
        resources,
    }
}

/// What lowering reads of the manifest for one of its passes: a bake is a texture of its own, in
/// the complete form, over the program's bindings.
pub fn of_pass(manifest: &Manifest, index: usize) -> Cow<'_, Manifest> {
    if manifest.passes.len() == 1 {
        return Cow::Borrowed(manifest);
    }
    let mut own = manifest.clone();
    own.passes = manifest.passes.get(index).cloned().into_iter().collect();
    let Some(pass) = own.passes.first().filter(|pass| pass.bake.is_some()) else { return Cow::Owned(own) };
    let float = |width| Type { scalar: manifest::Scalar::Float, width };
    own.texture = pass.shader.trim_end_matches(".wgsl").to_owned();
    own.form = Form::Complete;
    own.inputs = vec![Input { name: "uv".to_owned(), ty: float(2), source: Source::Varying(0) }];
    let texel = Output { name: "texel".to_owned(), ty: float(4), location: 0, is_color: false };
    own.gradients = Vec::new();
    own.discard_below = None;
    own.outputs = vec![texel];
    Cow::Owned(own)
}

/// The params that shaders read from the uniform block; the last reads its arguments in the
/// functions form.
fn bound_params(each: &[Reads], form: Form) -> BTreeSet<ParamId> {
    let unbound = usize::from(form == Form::Functions);
    let bound = each.iter().take(each.len().saturating_sub(unbound));
    bound.flat_map(|reads| reads.params.iter().copied()).collect()
}

/// How the function of a texture is called; lowering makes the same arguments.
fn call(graph: &Graph, entry: &graph::Function, gradients: &[Gradient], reads: &Reads) -> Call {
    let mut arguments: Vec<Argument> =
        entry.inputs.iter().map(|slot| Argument::Input(slot.name.to_string())).collect();
    arguments.extend(gradients.iter().map(|gradient| Argument::Gradient(gradient.name.clone())));
    let params = reads.params.iter().map(|id| &graph.params[id.0 as usize]);
    arguments.extend(params.map(|param| Argument::Param(param.name.clone())));
    for view in reads.views.iter().map(|id| &graph.views[id.0 as usize]) {
        arguments.push(Argument::Texture(view.resource, view.field.to_owned()));
        if view.view.texel == graph::Texel::Sampled {
            arguments.push(Argument::Sampler(view.resource, view.field.to_owned()));
        }
    }
    let mut members = Scope::default();
    let members = entry.outputs.iter().map(|(slot, _)| members.name(&slot.name).to_string()).collect();
    Call { arguments, members: (entry.outputs.len() > 1).then_some(members) }
}

/// The views that a pass reads, as resource and field.
fn views(graph: &Graph, reads: &Reads) -> Vec<(u32, String)> {
    let views = reads.views.iter().map(|id| &graph.views[id.0 as usize]);
    views.map(|view| (view.resource, view.field.to_owned())).collect()
}

/// Where a pass has its derivatives from.
fn taken(entry: &graph::Function, is_bake: bool, options: &Options) -> Gradients {
    match derivatives(entry).next() {
        None => Gradients::None,
        Some(_) if is_bake => Gradients::Derive,
        Some(_) => options.gradients,
    }
}

/// The derivatives that an entry reads: input and axis.
fn derivatives(entry: &graph::Function) -> impl Iterator<Item = (usize, graph::Axis)> {
    entry.values.iter().filter_map(|operation| {
        let Operation::Derivative(of, axis, _) = operation else { return None };
        let Operation::Input(input) = entry.operation(*of) else { return None };
        Some((*input as usize, *axis))
    })
}

/// The derivatives that a texture is given.
fn gradients(entry: &graph::Function, inputs: &[Input], options: &Options) -> Vec<Gradient> {
    if options.gradients != Gradients::Argument {
        return Vec::new();
    }
    let varying = |input: &&Input| matches!(input.source, Source::Varying(_));
    let mut location = inputs.iter().filter(varying).count() as u32;
    let mut read: Vec<(usize, graph::Axis)> = derivatives(entry).collect();
    read.sort_unstable();
    let gradient = |(input, axis): (usize, graph::Axis)| {
        let Input { name: input, ty, source } = inputs.get(input)?;
        let source = match source {
            Source::Varying(_) => {
                location += 1;
                Source::Varying(location - 1)
            }
            other => *other,
        };
        let (axis, suffix) = match axis {
            graph::Axis::X => (manifest::Axis::X, "dx"),
            graph::Axis::Y => (manifest::Axis::Y, "dy"),
        };
        Some(Gradient { name: format!("{input}_{suffix}"), input: input.clone(), axis, ty: *ty, source })
    };
    read.into_iter().filter_map(gradient).collect()
}

/// The uniform block as it grows.
#[derive(Default)]
struct Block {
    size: u32,
}

impl Block {
    /// The offset of a member of that width, natural alignment.
    fn add(&mut self, width: u8) -> u32 {
        let align = match width {
            1 => 4,
            2 => 8,
            _ => 16,
        };
        let offset = self.size.next_multiple_of(align);
        self.size = offset + 4 * u32::from(width);
        offset
    }
}

fn params(graph: &Graph, bound: &BTreeSet<ParamId>, block: &mut Block) -> Vec<Param> {
    let params = graph.params.iter().enumerate();
    params
        .map(|(i, param)| {
            let read = bound.contains(&ParamId(i as u32));
            Param {
                name: param.name.clone(),
                label: param.label.clone(),
                ty: public_type(param.ty),
                default: value(&param.default),
                range: param.range.as_ref().map(|(low, high)| (value(low), value(high))),
                offset: read.then(|| block.add(param.ty.width())),
            }
        })
        .collect()
}

fn inputs(entry: &graph::Function, form: Form, block: &mut Block) -> Vec<Input> {
    let mut location = 0;
    let mut source = |slot: &graph::Slot| match form {
        Form::Library => Source::Member,
        Form::Functions => Source::Argument,
        Form::Complete if is_per_draw(&slot.name) => Source::Uniform(block.add(slot.ty.width())),
        Form::Complete => {
            location += 1;
            Source::Varying(location - 1)
        }
    };
    let inputs = entry.inputs.iter();
    inputs
        .map(|slot| Input { name: slot.name.to_string(), ty: public_type(slot.ty), source: source(slot) })
        .collect()
}

fn outputs(entry: &graph::Function) -> Vec<Output> {
    let outputs = entry.outputs.iter().enumerate();
    outputs
        .map(|(i, (slot, _))| Output {
            name: slot.name.to_string(),
            ty: public_type(slot.ty),
            location: i as u32,
            is_color: slot.name == "color",
        })
        .collect()
}

/// The resources, all of them, so that indices agree with the graph's; those without textures are
/// not read and need not be loaded.
fn resources(
    graph: &Graph,
    reads: &Reads,
    prefix: &str,
    scope: &mut Scope,
    (group, first): (u32, u32),
) -> Vec<Resource> {
    let mut binding = first;
    let mut next = || {
        binding += 1;
        binding - 1
    };
    let mut all: Vec<Resource> = graph
        .resources
        .iter()
        .map(|r| Resource {
            name: r.name.clone(),
            label: r.label.clone(),
            recipe: r.recipe.clone(),
            textures: Vec::new(),
        })
        .collect();
    for id in &reads.views {
        let view = &graph.views[id.0 as usize];
        let resource = &graph.resources[view.resource as usize];
        let name = format!("{prefix}_{}", naming::identifier(&resource.name));
        all[view.resource as usize].textures.push(Texture {
            field: view.field.to_owned(),
            name: scope.name(&format!("{name}_{}", view.field)).to_string(),
            group,
            binding: next(),
            view: match view.view.dimension {
                ViewDimension::D2 => manifest::ViewDimension::D2,
                ViewDimension::D2Array => manifest::ViewDimension::D2Array,
                ViewDimension::D3 => manifest::ViewDimension::D3,
            },
            sample: match view.view.texel {
                graph::Texel::Sampled => SampleKind::Float,
                graph::Texel::Integer => SampleKind::Int,
            },
            sampler: resource.sampler.map(|state| Sampler {
                name: scope.name(&format!("{name}_sampler")).to_string(),
                group,
                binding: next(),
                wrap: state.wrap,
                filter: state.filter,
                anisotropy: u16::from(state.anisotropy),
            }),
            table: baked(&resource.recipe),
            plain: None,
        });
    }
    all
}

/// The table of a bake, which is known before anything is drawn.
fn baked(recipe: &Recipe) -> Option<Table> {
    match recipe {
        Recipe::Bake { size: [width, height], format } => {
            Some(Table::mipmapped(*format, [*width, *height], 1))
        }
        _ => None,
    }
}

fn public_type(ty: graph::Type) -> Type {
    let scalar = match ty.scalar() {
        Some(Scalar::Int) => manifest::Scalar::Int,
        Some(Scalar::Bool) => manifest::Scalar::Bool,
        _ => manifest::Scalar::Float,
    };
    Type { scalar, width: ty.width() }
}

fn value(constant: &Constant) -> Value {
    let components = 0..usize::from(constant.width());
    match constant.scalar() {
        Scalar::Float => Value::Float(components.map(|i| constant.float(i)).collect()),
        Scalar::Int => Value::Int(components.map(|i| constant.int(i)).collect()),
        Scalar::Bool => Value::Bool(components.map(|i| constant.bool(i)).collect()),
    }
}
