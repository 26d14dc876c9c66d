//! The types of the language as far as programs are generated.

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    Float,
    Int,
    Bool,
}

/// The width of `vec<n>` and `ivec<n>` inside a node that declares `n`.
pub const N: u8 = 0;

/// A number, vector or bool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ty {
    pub scalar: Scalar,
    /// 1 to 4, or [`N`].
    pub width: u8,
}

impl Ty {
    pub const FLOAT: Ty = Ty { scalar: Scalar::Float, width: 1 };
    pub const INT: Ty = Ty { scalar: Scalar::Int, width: 1 };
    pub const BOOL: Ty = Ty { scalar: Scalar::Bool, width: 1 };

    pub const fn float(width: u8) -> Ty {
        Ty { scalar: Scalar::Float, width }
    }

    pub const fn int(width: u8) -> Ty {
        Ty { scalar: Scalar::Int, width }
    }

    /// With the dimension variable of a callee bound.
    pub fn bound(self, n: u8) -> Ty {
        if self.width == N { Ty { width: n, ..self } } else { self }
    }

    /// As written; also what its constructor is called, bools apart.
    pub fn name(self) -> String {
        let (one, many) = match self.scalar {
            Scalar::Float => ("float", "vec"),
            Scalar::Int => ("int", "ivec"),
            Scalar::Bool => ("bool", "bvec"),
        };
        match self.width {
            1 => one.to_owned(),
            N => format!("{many}<n>"),
            width => format!("{many}{width}"),
        }
    }
}

/// When something is known. In this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rate {
    /// When compiling.
    Load,
    /// For a whole draw.
    Draw,
    /// Per pixel.
    Pixel,
}

/// The resources that programs use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Image,
    Patterns,
    Permutation,
    Indices,
}

impl Kind {
    pub const ALL: [Kind; 4] = [Kind::Permutation, Kind::Indices, Kind::Image, Kind::Patterns];

    /// Its type as written.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Image => "image",
            Kind::Patterns => "patterns",
            Kind::Permutation => "permutation",
            Kind::Indices => "indices",
        }
    }
}

impl Kind {
    /// The field that is a number known when compiling.
    pub fn constant(self) -> Option<&'static str> {
        match self {
            Kind::Image => None,
            Kind::Patterns => Some("count"),
            Kind::Permutation => Some("size"),
            Kind::Indices => Some("levels"),
        }
    }
}

/// What a node takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Takes {
    Value(Ty),
    Resource(Kind),
    /// A square matrix of that size.
    Matrix(u8),
    /// A node of these inputs and outputs.
    Node(Vec<Ty>, Vec<(String, Ty)>),
}

impl Takes {
    /// As written. The inputs of a node type are named `a`, `b`, …
    pub fn name(&self) -> String {
        match self {
            Takes::Value(ty) => ty.name(),
            Takes::Resource(kind) => kind.name().to_owned(),
            Takes::Matrix(size) => format!("mat{size}"),
            Takes::Node(inputs, outputs) => {
                let inputs = ('a'..).zip(inputs).map(|(name, ty)| format!("{name}: {}", ty.name()));
                let inputs = inputs.collect::<Vec<_>>().join(", ");
                let output = match outputs.as_slice() {
                    [(_, single)] => single.name(),
                    several => record(several),
                };
                format!("node({inputs}) -> {output}")
            }
        }
    }
}

/// `(a: float, b: vec2)`
pub fn record(fields: &[(String, Ty)]) -> String {
    let fields: Vec<String> = fields.iter().map(|(name, ty)| format!("{name}: {}", ty.name())).collect();
    format!("({})", fields.join(", "))
}

/// An input of something that can be called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    pub name: String,
    pub takes: Takes,
    /// A call may leave it out.
    pub optional: bool,
}

/// Something that can be called: an intrinsic, a node, a texture, an input of node type.
#[derive(Clone, Debug)]
pub struct Callable {
    /// As it is called, alias included.
    pub text: String,
    pub inputs: Vec<Input>,
    /// One output is the value, several are a record.
    pub outputs: Vec<(String, Ty)>,
    /// Some widths are `<n>`, bound by the arguments.
    pub generic: bool,
    /// What it reads besides its arguments.
    pub rate: Rate,
    /// Others have the same name: the types of the arguments choose.
    pub overloaded: bool,
    /// `x.f(…)` finds it.
    pub method: bool,
    /// A call may say `f<n>(…)`.
    pub explicit: bool,
    /// Steps of its folds, all together.
    pub steps: u32,
    /// It is not the program's own.
    pub library: bool,
    /// The widest that `<n>` may be: the library's noises know up to three dimensions.
    pub widest: u8,
}

/// A name with a value.
#[derive(Clone, Debug)]
pub struct Wire {
    pub text: String,
    pub ty: Ty,
    /// When it is known.
    pub rate: Rate,
    /// What reading it makes of a node: an input does not make the node read anything.
    pub touches: Rate,
    /// It changes from step to step of a fold, so it is no constant even where all else is.
    pub steps: bool,
}

/// What names mean at a place of a program.
#[derive(Clone, Debug)]
pub struct Scope {
    pub wires: Vec<Wire>,
    /// Names of records with their outputs.
    pub records: Vec<(String, Vec<(String, Ty)>)>,
    pub resources: Vec<(String, Kind)>,
    /// Names of matrices with their sizes.
    pub matrices: Vec<(String, u8)>,
    /// Names of constant tables with the type of an entry.
    pub tables: Vec<(String, Ty)>,
    /// Nodes that came as inputs.
    pub functions: Vec<Callable>,
    /// The widths of `<n>` may be used.
    pub generic: bool,
    /// The highest rate that may be read.
    pub most: Rate,
    /// How often an expression here is computed, by the folds around it.
    pub steps: u32,
}

impl Scope {
    /// Nothing declared; everything may be read.
    pub fn empty() -> Scope {
        Scope {
            wires: Vec::new(),
            records: Vec::new(),
            resources: Vec::new(),
            matrices: Vec::new(),
            tables: Vec::new(),
            functions: Vec::new(),
            generic: false,
            most: Rate::Pixel,
            steps: 1,
        }
    }

    /// A name with a value; it hides any other of that name.
    pub fn declare(&mut self, text: impl Into<String>, ty: Ty, rate: Rate, touches: Rate) {
        let text = text.into();
        self.hide(&text);
        self.wires.push(Wire { text, ty, rate, touches, steps: false });
    }

    /// A name inside a fold.
    pub fn declare_in_fold(&mut self, text: impl Into<String>, ty: Ty) {
        let text = text.into();
        self.hide(&text);
        let rate = Rate::Pixel.min(self.most);
        self.wires.push(Wire { text, ty, rate, touches: Rate::Load, steps: true });
    }

    /// The same place, but only what is known when compiling may be read.
    pub fn constants(&self) -> Scope {
        let mut known = Scope { most: Rate::Load, ..self.clone() };
        known.wires.retain(|wire| !wire.steps);
        known.matrices.clear();
        known
    }

    /// Forgets a name.
    pub fn hide(&mut self, name: &str) {
        self.wires.retain(|wire| wire.text != name);
        self.records.retain(|(text, _)| text != name);
        self.resources.retain(|(text, _)| text != name);
        self.matrices.retain(|(text, _)| text != name);
        self.tables.retain(|(text, _)| text != name);
        self.functions.retain(|function| function.text != name);
    }

    /// The wires of a type that may be read here.
    pub fn of(&self, ty: Ty) -> Vec<&Wire> {
        self.wires.iter().filter(|wire| wire.ty == ty && wire.rate <= self.most).collect()
    }
}
