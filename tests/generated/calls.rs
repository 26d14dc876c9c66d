//! Calls of whatever gives a value of the wanted type: intrinsics as their table says, library
//! nodes, the program's own.

use super::expression::Expr;
use super::program::Generator;
use super::types::{Callable, Input, Kind, N, Rate, Scope, Takes, Ty};
use texgraph_compiler::Library;
use texgraph_compiler::intrinsic::Intrinsic;
use texgraph_compiler::library::Callable as Known;
use texgraph_grammar::syntax::{self, Dim, ItemKind, TypeKind};

/// Steps of all folds that a value takes at most, far below the language's bound.
const MOST_STEPS: u32 = 2_000;

/// Inputs of library nodes that refuse constants beyond a bound, and the greatest each takes.
const BOUNDED: &[(&str, &str, usize)] = &[("transition_tile", "families", 4)];

/// Nodes of the library that look at many cells.
const LONG: &[&str] = &["voronoi", "worley", "granite", "bomb"];

/// One output of one thing to call.
type Candidate = (Callable, usize);

impl Generator<'_, '_> {
    /// A call that gives just that type.
    pub fn call(&mut self, s: &Scope, ty: Ty, depth: u32) -> Option<Expr> {
        let candidates = self.candidates(s, ty);
        if candidates.is_empty() {
            return None;
        }
        // A program's own nodes first: they are few.
        let own = candidates.iter().filter(|(_, known)| !known).count();
        let own = own > 0 && self.choices.chance(40);
        let several: Vec<&Candidate> =
            candidates.iter().filter(|(_, known)| !(own && *known)).map(|(candidate, _)| candidate).collect();
        let (callable, output) = self.choices.pick(&several);
        let (name, given) = &callable.outputs[*output];
        let n = match (callable.generic, given.width) {
            // The widths of a node that came as an input are ours.
            (false, _) => N,
            (true, N) => ty.width,
            (true, _) => self.some_width(s).min(callable.widest),
        };
        let call = self.call_of(s, callable, n, depth)?;
        Some(match callable.outputs.as_slice() {
            [_] => Expr::primary(call),
            _ => Expr::primary(format!("{call}.{name}")),
        })
    }

    /// A call of something with several outputs, with the width that its variable is bound to.
    pub fn record_call(&mut self, s: &Scope, depth: u32) -> Option<(String, Vec<(String, Ty)>)> {
        let several: Vec<Callable> = self
            .all_callables(s)
            .filter(|callable| callable.outputs.len() > 1 && self.may_call(s, callable))
            .cloned()
            .collect();
        if several.is_empty() {
            return None;
        }
        let callable = self.choices.pick(&several).clone();
        let n = if callable.generic { self.some_width(s).min(callable.widest) } else { N };
        let call = self.call_of(s, &callable, n, depth)?;
        let outputs = callable.outputs.into_iter().map(|(name, ty)| (name, ty.bound(n)));
        Some((call, outputs.collect()))
    }

    fn all_callables<'s>(&'s self, s: &'s Scope) -> impl Iterator<Item = &'s Callable> {
        self.library.iter().chain(&self.callables).chain(&s.functions)
    }

    /// What gives that type, and whether it is the library's.
    fn candidates(&self, s: &Scope, ty: Ty) -> Vec<(Candidate, bool)> {
        let mut candidates = Vec::new();
        for callable in self.all_callables(s).filter(|callable| self.may_call(s, callable)) {
            for (output, (_, given)) in callable.outputs.iter().enumerate() {
                // A callee's own variable stands for any width.
                let generic = callable.generic
                    && given.width == N
                    && given.scalar == ty.scalar
                    && ty.width <= callable.widest;
                if generic || *given == ty {
                    candidates.push(((callable.clone(), output), callable.library));
                }
            }
        }
        candidates
    }

    /// Whether a call may stand here.
    fn may_call(&self, s: &Scope, callable: &Callable) -> bool {
        let takes = |input: &Input| {
            input.optional
                || match &input.takes {
                    Takes::Value(_) => true,
                    Takes::Matrix(_) => self.features.matrices,
                    Takes::Resource(kind) => s.resources.iter().any(|(_, found)| found == kind),
                    Takes::Node(..) => s.most == Rate::Pixel,
                }
        };
        callable.rate <= s.most
            && callable.steps.saturating_mul(s.steps) <= MOST_STEPS
            && callable.inputs.iter().all(takes)
    }

    /// A call with its variable bound to `n`.
    fn call_of(&mut self, s: &Scope, callable: &Callable, n: u8, depth: u32) -> Option<String> {
        let vectors = |input: &&Input| matches!(input.takes, Takes::Value(ty) if ty.width == N);
        let mut binder = None;
        let mut explicit = false;
        if callable.generic && n != 1 {
            let binders: Vec<String> =
                callable.inputs.iter().filter(vectors).map(|input| input.name.clone()).collect();
            explicit = callable.explicit && (binders.is_empty() || self.choices.chance(15));
            if !explicit {
                if binders.is_empty() {
                    return None;
                }
                binder = Some(self.choices.pick(&binders).clone());
            }
        }
        self.touch(callable.rate);
        if callable.generic && n == N {
            self.widest = self.widest.min(callable.widest);
        }
        let arguments = self.arguments(s, callable, n, binder.as_deref(), depth)?;
        let dim = match n {
            _ if !explicit => String::new(),
            N => "<n>".to_owned(),
            n => format!("<{n}>"),
        };
        Some(self.written(callable, &dim, arguments))
    }

    /// The arguments as text, each with the name of its input; what may be left out is, at times.
    fn arguments(
        &mut self,
        s: &Scope,
        callable: &Callable,
        n: u8,
        binder: Option<&str>,
        depth: u32,
    ) -> Option<Vec<(Option<String>, Expr)>> {
        let mut named = false;
        let mut arguments = Vec::new();
        for (i, input) in callable.inputs.iter().enumerate() {
            let binds = binder == Some(input.name.as_str());
            // A walk through a permutation is a fold of the library.
            let walks = callable.library && !self.features.folds;
            let missing = matches!(input.takes, Takes::Resource(kind)
                if walks || !s.resources.iter().any(|(_, found)| *found == kind));
            if input.optional && !binds && (missing || self.choices.chance(50)) {
                named = true;
                continue;
            }
            // The type of the first argument chooses between overloads.
            named |= i > 0 && self.choices.chance(10);
            let argument = match input.takes {
                // Some of these bound a fold of the library.
                Takes::Value(Ty::INT) if input.optional && callable.library => self.up_to(6),
                _ => match bound(callable, input) {
                    Some(greatest) => self.up_to(greatest),
                    None => self.argument(s, callable, input, (i == 0, binds), n, depth)?,
                },
            };
            arguments.push((named.then(|| input.name.clone()), argument));
        }
        Some(arguments)
    }

    /// A literal from 1 on.
    fn up_to(&mut self, greatest: usize) -> Expr {
        Expr::primary((1 + self.choices.below(greatest)).to_string())
    }

    fn argument(
        &mut self,
        s: &Scope,
        callable: &Callable,
        input: &Input,
        (first, binds): (bool, bool),
        n: u8,
        depth: u32,
    ) -> Option<Expr> {
        Some(match &input.takes {
            Takes::Value(ty) => {
                let ty = ty.bound(n);
                match (binds, first && callable.overloaded) {
                    (true, _) if first && callable.overloaded => self.exact(s, ty, depth),
                    (true, _) => {
                        let int = ty.scalar == super::types::Scalar::Float && self.choices.chance(15);
                        let scalar = if int { super::types::Scalar::Int } else { ty.scalar };
                        self.exact(s, Ty { scalar, ..ty }, depth)
                    }
                    (false, true) => {
                        let width = if self.choices.chance(50) { 1 } else { ty.width };
                        self.exact(s, Ty { width, ..ty }, depth)
                    }
                    (false, false) => self.fitting(s, ty, depth),
                }
            }
            Takes::Resource(kind) => self.resource(s, *kind)?,
            Takes::Matrix(size) => self.matrix(s, *size, depth),
            Takes::Node(inputs, outputs) => self.node_argument(s, inputs, outputs, n, depth)?,
        })
    }

    /// A resource of a kind, or one of two where that is known when compiling.
    fn resource(&mut self, s: &Scope, kind: Kind) -> Option<Expr> {
        let known: Vec<&String> =
            s.resources.iter().filter(|(_, found)| *found == kind).map(|(text, _)| text).collect();
        if known.is_empty() {
            return None;
        }
        let (one, other) = (self.choices.pick(&known).as_str(), self.choices.pick(&known).as_str());
        if one != other && self.choices.chance(20) {
            let condition = self.literal(Ty::BOOL).text;
            return Some(Expr::primary(format!("if {condition} {{ {one} }} else {{ {other} }}")));
        }
        Some(Expr::primary(one))
    }

    /// `f<n>(a, b, name: c)` or `a.f<n>(b, name: c)`.
    fn written(&mut self, callable: &Callable, dim: &str, arguments: Vec<(Option<String>, Expr)>) -> String {
        let name = &callable.text;
        // A lambda stands as an argument only.
        let based =
            callable.method && !matches!(callable.inputs.first(), Some(Input { takes: Takes::Node(..), .. }));
        let mut arguments = arguments.into_iter().peekable();
        let mut text = match arguments.next_if(|(named, _)| named.is_none()) {
            Some((_, first)) if based && self.choices.chance(20) => {
                format!("{}.{name}{dim}(", first.base())
            }
            Some((_, first)) if arguments.peek().is_some() => format!("{name}{dim}({}, ", first.text),
            Some((_, first)) => format!("{name}{dim}({}", first.text),
            None => format!("{name}{dim}("),
        };
        let rest: Vec<String> = arguments
            .map(|(name, argument)| match name {
                Some(name) => format!("{name}: {}", argument.text),
                None => argument.text,
            })
            .collect();
        text.push_str(&rest.join(", "));
        if !rest.is_empty() && self.choices.chance(3) {
            text.push(',');
        }
        text + ")"
    }
}

/// Everything of the library that can be called by a name and takes what we know to give.
pub fn library(library: &Library) -> Vec<Callable> {
    let mut callables = Vec::new();
    for name in library.callable_names() {
        let named = library.callables(name);
        for known in named {
            let callable = match *known {
                Known::Intrinsic(intrinsic) => intrinsic_call(library, intrinsic),
                Known::Node(module, item) => node_call(library, module, item),
                Known::Constructor(_) => None,
            };
            callables.extend(callable.map(|callable| Callable { overloaded: named.len() > 1, ..callable }));
        }
    }
    callables
}

/// The greatest literal that an input takes, where it has a bound.
fn bound(callable: &Callable, input: &Input) -> Option<usize> {
    let bounded = |(name, of, _): &&(&str, &str, usize)| callable.text == *name && input.name == *of;
    BOUNDED.iter().filter(|_| callable.library).find(bounded).map(|(.., greatest)| *greatest)
}

fn intrinsic_call(library: &Library, intrinsic: Intrinsic) -> Option<Callable> {
    let signature = library.signature(Known::Intrinsic(intrinsic))?;
    let name = intrinsic.row().name;
    name.starts_with(|c: char| c.is_ascii_lowercase()).then_some(())?;
    let output = vec![(String::new(), value(&signature.output)?)];
    let made = head(name, &signature.dims, &signature.inputs, output)?;
    Some(Callable { rate: Rate::Load, steps: 1, widest: 4, ..made })
}

fn node_call(library: &Library, module: usize, item: usize) -> Option<Callable> {
    let module = library.modules().get(module)?;
    let ItemKind::Node(node) = &module.tree.items.get(item)?.kind else { return None };
    let outputs = node.outputs.iter().map(|field| Some((field.name.text.to_string(), value(&field.ty)?)));
    head(&node.name.text, &node.dims, &node.inputs, outputs.collect::<Option<_>>()?)
}

/// What a library node reads besides its arguments, and how long its folds are, is not looked up:
/// any may read derivatives, and loop over octaves and corners.
fn head(
    name: &str,
    dims: &[syntax::Name],
    inputs: &[syntax::Input],
    outputs: Vec<(String, Ty)>,
) -> Option<Callable> {
    // With a period a lacunarity has to be a whole number: the one or the other.
    let has_lacunarity = inputs.iter().any(|input| input.name.text.as_str() == "lacunarity");
    let free = inputs.iter().take_while(|input| !has_lacunarity || input.name.text.as_str() != "period");
    let inputs = free.map(|input| {
        let takes = takes(&input.ty)?;
        Some(Input { name: input.name.text.to_string(), takes, optional: input.default.is_some() })
    });
    Some(Callable {
        text: name.to_owned(),
        inputs: inputs.collect::<Option<_>>()?,
        outputs,
        generic: !dims.is_empty(),
        rate: Rate::Pixel,
        overloaded: false,
        method: true,
        explicit: true,
        steps: if LONG.contains(&name) { 8192 } else { 128 },
        library: true,
        widest: 3,
    })
}

/// A type that we know to give.
fn takes(ty: &syntax::Type) -> Option<Takes> {
    let TypeKind::Named { name, dim } = &ty.kind else { return None };
    if let Some(size) = name.text.strip_prefix("mat") {
        return size.parse().ok().map(Takes::Matrix);
    }
    // Resources are all of the plane.
    let kind = Kind::ALL.into_iter().find(|kind| dim.is_none() && kind.name() == name.text);
    kind.map(Takes::Resource).or_else(|| value(ty).map(Takes::Value))
}

fn value(ty: &syntax::Type) -> Option<Ty> {
    let TypeKind::Named { name, dim } = &ty.kind else { return None };
    let width = match dim {
        Some(Dim::Name(_)) => N,
        Some(Dim::Number(width, _)) => u8::try_from(*width).ok()?,
        None => 1,
    };
    Some(match name.text.as_str() {
        "float" | "vec" => Ty::float(width),
        "int" | "ivec" => Ty::int(width),
        "bool" => Ty::BOOL,
        "color" | "vec4" => Ty::float(4),
        "vec2" => Ty::float(2),
        "vec3" => Ty::float(3),
        "ivec2" => Ty::int(2),
        "ivec3" => Ty::int(3),
        "ivec4" => Ty::int(4),
        _ => return None,
    })
}
