//! The values that a user sets for a program's params, read from text.
//!
//! `NAME=VALUE`, where a value is a number, `true` or `false`, as many of them as the type has
//! components with commas between, or for four floats a colour (`#rrggbb`). A value outside the
//! param's range is clamped to it, as whoever writes the uniform block must.

use crate::nearest::nearest;
use std::collections::BTreeMap;
use std::fmt;
use texgraph_compiler::manifest::{Manifest, Param, Scalar, Type, Value};

/// Values of params, by name; those that are not set keep their default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    values: BTreeMap<String, Value>,
}

impl Settings {
    /// Nothing set.
    pub fn new() -> Settings {
        Settings::default()
    }

    /// Sets a param from text: `scale=2`, `stone.tint=#8d8f94`.
    ///
    /// # Errors
    /// There is no such param, or the value is not of its type, or not finite.
    pub fn parse(&mut self, manifest: &Manifest, text: &str) -> Result<(), SettingError> {
        let Some((name, value)) = text.split_once('=') else {
            return Err(SettingError::NoEquals { text: text.to_string() });
        };
        let name = name.trim();
        let param = find(manifest, name)?;
        let value = read(param, value.trim())?;
        self.values.insert(name.to_string(), value);
        Ok(())
    }

    /// Sets a param.
    ///
    /// # Errors
    /// As for [`Settings::parse`].
    pub fn set(&mut self, manifest: &Manifest, name: &str, value: Value) -> Result<(), SettingError> {
        let param = find(manifest, name)?;
        let finite = !matches!(&value, Value::Float(components) if components.iter().any(|f| !f.is_finite()));
        if type_of(&value) != Some(param.ty) || !finite {
            return Err(SettingError::wrong(param, &format!("{value:?}")));
        }
        self.values.insert(name.to_string(), value);
        Ok(())
    }

    /// What a param is worth: what was set, or its default, clamped to its range.
    pub fn value(&self, param: &Param) -> Value {
        let set = self.values.get(&param.name).filter(|value| type_of(value) == Some(param.ty));
        clamp(set.unwrap_or(&param.default), param.range.as_ref())
    }
}

fn find<'a>(manifest: &'a Manifest, name: &str) -> Result<&'a Param, SettingError> {
    manifest.params.iter().find(|param| param.name == name).ok_or_else(|| {
        let names = manifest.params.iter().map(|param| param.name.as_str());
        SettingError::Unknown { name: name.to_string(), near: nearest(name, names).map(str::to_string) }
    })
}

/// The type of a value; none for more components than a type has.
fn type_of(value: &Value) -> Option<Type> {
    let (scalar, width) = match value {
        Value::Float(components) => (Scalar::Float, components.len()),
        Value::Int(components) => (Scalar::Int, components.len()),
        Value::Bool(components) => (Scalar::Bool, components.len()),
    };
    u8::try_from(width).ok().map(|width| Type { scalar, width })
}

fn read(param: &Param, text: &str) -> Result<Value, SettingError> {
    let wrong = || SettingError::wrong(param, text);
    if let Some(digits) = text.strip_prefix('#') {
        let colour = Some(digits).filter(|_| param.ty == Type { scalar: Scalar::Float, width: 4 });
        return colour.and_then(color).map(|color| Value::Float(color.to_vec())).ok_or_else(wrong);
    }
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    if parts.len() != usize::from(param.ty.width) {
        return Err(wrong());
    }
    let value = match param.ty.scalar {
        Scalar::Float => {
            all(&parts, |part| part.parse().ok().filter(|f: &f32| f.is_finite())).map(Value::Float)
        }
        Scalar::Int => all(&parts, |part| part.parse().ok()).map(Value::Int),
        Scalar::Bool => all(&parts, |part| part.parse().ok()).map(Value::Bool),
    };
    value.ok_or_else(wrong)
}

fn all<T>(parts: &[&str], parse: impl Fn(&str) -> Option<T>) -> Option<Vec<T>> {
    parts.iter().map(|part| parse(part)).collect()
}

/// `rgb`, `rrggbb` or `rrggbbaa`, sRGB-encoded, as linear premultiplied light.
fn color(digits: &str) -> Option<[f32; 4]> {
    let nibbles: Vec<u8> = digits.chars().map(|c| c.to_digit(16).map(|d| d as u8)).collect::<Option<_>>()?;
    let bytes: Vec<u8> = match nibbles.len() {
        3 => nibbles.iter().map(|nibble| nibble * 17).collect(),
        6 | 8 => nibbles.chunks(2).map(|pair| pair[0] * 16 + pair[1]).collect(),
        _ => return None,
    };
    let alpha = bytes.get(3).copied().unwrap_or(255);
    Some(texgraph_compiler::color::linear([bytes[0], bytes[1], bytes[2], alpha]))
}

fn clamp(value: &Value, range: Option<&(Value, Value)>) -> Value {
    match (value, range) {
        (Value::Float(x), Some((Value::Float(low), Value::Float(high)))) => {
            Value::Float(clamp_each(x, low, high))
        }
        (Value::Int(x), Some((Value::Int(low), Value::Int(high)))) => Value::Int(clamp_each(x, low, high)),
        _ => value.clone(),
    }
}

/// Components beyond those of a bound have none.
fn clamp_each<T: PartialOrd + Copy>(values: &[T], low: &[T], high: &[T]) -> Vec<T> {
    let clamped = values.iter().enumerate().map(|(i, value)| {
        let raised = low.get(i).copied().filter(|low| value < low).unwrap_or(*value);
        high.get(i).copied().filter(|high| raised > *high).unwrap_or(raised)
    });
    clamped.collect()
}

/// Why a setting is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SettingError {
    /// No `=` in it.
    NoEquals {
        /// The whole setting.
        text: String,
    },
    /// The program has no such param.
    Unknown {
        /// The name.
        name: String,
        /// A param with a similar name.
        near: Option<String>,
    },
    /// The value is not of the param's type.
    Wrong {
        /// The param.
        name: String,
        /// What it takes.
        takes: String,
        /// What was given.
        text: String,
    },
}

impl SettingError {
    fn wrong(param: &Param, text: &str) -> SettingError {
        let (one, example) = match param.ty.scalar {
            Scalar::Float => ("a number", ["0.5", "0.5,1", "0.5,1,2", "0.5,1,2,1` or `#8d8f94"]),
            Scalar::Int => ("a whole number", ["12", "12,3", "12,3,4", "12,3,4,5"]),
            Scalar::Bool => {
                ("true or false", ["true", "true,false", "true,false,true", "true,false,true,false"])
            }
        };
        let width = usize::from(param.ty.width.clamp(1, 4));
        let takes = match width {
            1 => format!("{one}, as `{}`", example[0]),
            _ => format!("{width} components, as `{}`", example[width - 1]),
        };
        SettingError::Wrong { name: param.name.clone(), takes, text: text.to_string() }
    }
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SettingError::NoEquals { text } => write!(f, "`{text}` is no setting; write NAME=VALUE"),
            SettingError::Unknown { name, near: Some(near) } => {
                write!(f, "there is no param `{name}`; is `{near}` meant?")
            }
            SettingError::Unknown { name, near: None } => write!(f, "there is no param `{name}`"),
            SettingError::Wrong { name, takes, text } => {
                write!(f, "`{name}` takes {takes}; `{text}` is not that")
            }
        }
    }
}

impl std::error::Error for SettingError {}
