//! What goes into a shader and comes out of it: inputs, outputs, params.

use serde::{Deserialize, Serialize};

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Type {
    /// The type of a component.
    pub scalar: Scalar,
    /// Components, 1 to 4.
    pub width: u8,
}

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scalar {
    /// 32-bit float.
    Float,
    /// 32-bit signed integer.
    Int,
    /// One of two; in the uniform block a 32-bit unsigned integer, 0 or 1.
    Bool,
}

/// Numbers of a constant, one per component.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Value {
    /// Components of a float.
    Float(Vec<f32>),
    /// Components of an int.
    Int(Vec<i32>),
    /// Components of a bool.
    Bool(Vec<bool>),
}

/// An input of the texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// One of the fixed names: `uv`, `position`, `normal`, `time`, …
    pub name: String,
    /// Its type.
    pub ty: Type,
    /// Where the complete form reads it.
    pub source: Source,
}

/// A derivative of an input that the shader is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gradient {
    /// The input's name with `_dx` or `_dy`: how much the input grows from a pixel to the next one to
    /// the right, or to the next one down.
    pub name: String,
    /// The input.
    pub input: String,
    /// Along which axis of the screen.
    pub axis: Axis,
    /// Its type, that of the input.
    pub ty: Type,
    /// Where it comes from. In the library form it is a member of the function's second argument, a
    /// struct `NAMEGradients`.
    pub source: Source,
}

/// An axis of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// To the right.
    X,
    /// Down.
    Y,
}

/// Where a value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Interpolated, at this `@location`. Integers are flat.
    Varying(u32),
    /// In the uniform block, at this byte offset.
    Uniform(u32),
    /// A member of the inputs' struct (library form).
    Member,
    /// An argument of the function (functions form).
    Argument,
}

/// An output of the texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its type in the language. The complete form widens every output to `vec4<f32>`: a scalar to
    /// (v, v, v, 1), two components to (x, y, 0, 1), three to (x, y, z, 1).
    pub ty: Type,
    /// Its `@location` in the complete form.
    pub location: u32,
    /// `color: color` is linear and premultiplied; anything else is data.
    pub is_color: bool,
}

/// A param: a value that a host sets without recompiling.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Param {
    /// Its name, as `--set` takes it (`scale`, or `stone.scale` of an import).
    pub name: String,
    /// Its documentation.
    pub label: String,
    /// Its type.
    pub ty: Type,
    /// The value before a host sets one.
    pub default: Value,
    /// The least and greatest value; whoever writes the block clamps to it.
    pub range: Option<(Value, Value)>,
    /// Byte offset in the uniform block; none when nothing that binds the block reads it (in the
    /// functions form, bakes alone do).
    pub offset: Option<u32>,
}

/// The uniform block: params and draw-rate inputs in declaration order, natural alignment, padded
/// to a multiple of 16 bytes, little endian.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uniform {
    /// The variable's name in the WGSL.
    pub name: String,
    /// `@group`
    pub group: u32,
    /// `@binding`
    pub binding: u32,
    /// Bytes, a multiple of 16.
    pub size: u32,
}
