//! Which parts of the language a generated program uses.

/// What may occur in a program. What the compiler does not take yet is off in [`Features::NOW`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Features {
    /// `image` and `patterns`. Their pictures are named, not made: compiling opens none.
    pub pictures: bool,
    /// Folds over a scalar range of literals.
    pub literal_folds: bool,
    /// Folds over computed ranges and boxes, with `max` and `while`.
    pub folds: bool,
    /// Nodes as inputs: lambdas and named nodes as arguments.
    pub lambdas: bool,
    /// `mat2` and `mat3`.
    pub matrices: bool,
    /// Constant tables, indexed when running.
    pub tables: bool,
    /// `bake`.
    pub bakes: bool,
}

impl Features {
    /// What the compiler takes today.
    pub const NOW: Features = Features {
        pictures: true,
        literal_folds: true,
        folds: true,
        lambdas: true,
        matrices: true,
        tables: true,
        bakes: true,
    };

    /// The whole language, as the grammar reads it.
    pub const ALL: Features = Features {
        pictures: true,
        literal_folds: true,
        folds: true,
        lambdas: true,
        matrices: true,
        tables: true,
        bakes: true,
    };
}
