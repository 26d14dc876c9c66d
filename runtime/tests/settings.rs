//! Params from text, and the bytes of the uniform block.

mod common;

use common::manifest;
use texgraph_compiler::manifest::{Input, Manifest, Param, Scalar, Source, Type, Uniform, Value};
use texgraph_runtime::settings::{SettingError, Settings};
use texgraph_runtime::uniform::{Draw, block};

fn param(name: &str, default: Value, range: Option<(Value, Value)>, offset: Option<u32>) -> Param {
    let (scalar, width) = match &default {
        Value::Float(components) => (Scalar::Float, components.len()),
        Value::Int(components) => (Scalar::Int, components.len()),
        Value::Bool(components) => (Scalar::Bool, components.len()),
    };
    let ty = Type { scalar, width: width as u8 };
    Param { name: name.into(), label: String::new(), ty, default, range, offset }
}

/// Five params, `time` and `base`, in 64 bytes.
fn example() -> Manifest {
    let mut manifest = manifest();
    let floats = |x: &[f32]| Value::Float(x.to_vec());
    manifest.params = vec![
        param("scale", floats(&[2.0]), Some((floats(&[1.0]), floats(&[4.0]))), Some(0)),
        param(
            "cells",
            Value::Int(vec![8, 8]),
            Some((Value::Int(vec![1, 1]), Value::Int(vec![99, 9]))),
            Some(8),
        ),
        param("on", Value::Bool(vec![true]), None, Some(4)),
        param("stone.tint", floats(&[0.0; 4]), None, Some(16)),
        param("unread", floats(&[0.0; 3]), None, None),
    ];
    let input = |name: &str, scalar, width, offset| Input {
        name: name.into(),
        ty: Type { scalar, width },
        source: Source::Uniform(offset),
    };
    manifest.inputs = vec![input("time", Scalar::Float, 1, 32), input("base", Scalar::Int, 2, 40)];
    manifest.uniform = Some(Uniform { name: "params".into(), group: 0, binding: 0, size: 64 });
    manifest
}

/// The value of a param after a setting.
fn after(text: &str) -> Result<Value, SettingError> {
    let manifest = example();
    let mut settings = Settings::new();
    settings.parse(&manifest, text)?;
    let name = text.split('=').next().unwrap_or_default().trim();
    let param = manifest.params.iter().find(|param| param.name == name).expect("the param was found");
    Ok(settings.value(param))
}

#[test]
fn values_are_read_by_their_type() {
    assert_eq!(after("scale=3.5"), Ok(Value::Float(vec![3.5])));
    assert_eq!(after("scale = 3"), Ok(Value::Float(vec![3.0])));
    assert_eq!(after("cells=12, 3"), Ok(Value::Int(vec![12, 3])));
    assert_eq!(after("on=false"), Ok(Value::Bool(vec![false])));
    assert_eq!(after("unread=1,-2,3e-1"), Ok(Value::Float(vec![1.0, -2.0, 0.3])));
    assert_eq!(after("stone.tint=1,0.5,0,1"), Ok(Value::Float(vec![1.0, 0.5, 0.0, 1.0])));
}

#[test]
fn colours_are_linear_and_premultiplied() {
    assert_eq!(after("stone.tint=#fff"), Ok(Value::Float(vec![1.0; 4])));
    assert_eq!(after("stone.tint=#ff000000"), Ok(Value::Float(vec![0.0; 4])));
    let Ok(Value::Float(tint)) = after("stone.tint=#bcbcbc80") else { panic!("it is a colour") };
    let light = 0.502_886_5 * (128.0 / 255.0);
    assert!((tint[0] - light).abs() < 1e-6 && (tint[3] - 128.0 / 255.0).abs() < 1e-6, "{tint:?}");
}

#[test]
fn values_outside_the_range_are_clamped() {
    assert_eq!(after("scale=100"), Ok(Value::Float(vec![4.0])));
    assert_eq!(after("scale=-1"), Ok(Value::Float(vec![1.0])));
    assert_eq!(after("cells=0,10"), Ok(Value::Int(vec![1, 9])));
}

#[test]
fn what_is_no_value_is_refused() {
    let wrong = [
        "scale=",
        "scale=x",
        "scale=nan",
        "scale=inf",
        "scale=1e39",
        "scale=1,2",
        "scale=#fff",
        "scale=true",
        "cells=1",
        "cells=1.5,2",
        "cells=99999999999,1",
        "on=1",
        "on=yes",
        "stone.tint=#ffff",
        "stone.tint=#12345g",
        "stone.tint=#é",
        "unread=1,2",
        "unread=1,,2",
    ];
    for text in wrong {
        assert!(matches!(after(text), Err(SettingError::Wrong { .. })), "{text}");
    }
    let sentence = after("unread=1,2").expect_err("it is too short").to_string();
    assert_eq!(sentence, "`unread` takes 3 components, as `0.5,1,2`; `1,2` is not that");
    assert_eq!(after("scale"), Err(SettingError::NoEquals { text: "scale".into() }));
}

#[test]
fn unknown_names_are_told_with_the_nearest() {
    let near = |near: Option<&str>, name: &str| {
        Err(SettingError::Unknown { name: name.into(), near: near.map(str::to_string) })
    };
    assert_eq!(after("scal=1"), near(Some("scale"), "scal"));
    assert_eq!(after("stone.tnit=1"), near(Some("stone.tint"), "stone.tnit"));
    assert_eq!(after("water=1"), near(None, "water"));
}

#[test]
fn set_checks_what_parse_checks() {
    let manifest = example();
    let mut settings = Settings::new();
    assert!(settings.set(&manifest, "scale", Value::Float(vec![f32::NAN])).is_err());
    assert!(settings.set(&manifest, "scale", Value::Int(vec![1])).is_err());
    assert!(settings.set(&manifest, "scale", Value::Float(vec![3.0])).is_ok());
    assert_eq!(settings.value(&manifest.params[0]), Value::Float(vec![3.0]));
}

#[test]
fn the_block_has_every_value_at_its_offset() {
    let manifest = example();
    let mut settings = Settings::new();
    settings.parse(&manifest, "scale=100").expect("it is set");
    settings.parse(&manifest, "stone.tint=1,2,3,4").expect("it is set");
    let bytes = block(&manifest, &settings, &Draw { time: 0.5, base: [7, -1, 5], instance: 3 });
    let words: Vec<u32> = bytes.chunks(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect();
    let mut expected = [0u32; 16];
    expected[..4].copy_from_slice(&[4f32.to_bits(), 1, 8, 8]);
    expected[4..8].copy_from_slice(&[1f32, 2.0, 3.0, 4.0].map(f32::to_bits));
    expected[8] = 0.5f32.to_bits();
    expected[10..12].copy_from_slice(&[7, u32::MAX]);
    assert_eq!(words, expected);
}

#[test]
fn offsets_outside_the_block_are_not_written() {
    let mut manifest = example();
    manifest.params[0].offset = Some(62);
    manifest.params[2].offset = Some(u32::MAX);
    assert_eq!(block(&manifest, &Settings::new(), &Draw::default()).len(), 64);
    manifest.uniform = None;
    assert!(block(&manifest, &Settings::new(), &Draw::default()).is_empty());
}
