//! Bakes on the GPU.

use super::common::bakes::{bake_of_a_bake, baked, constant, pattern, program_of, shown, single, smooth};
use super::{FILTERED, compare};
use libtest_mimic::Failed;
use texgraph_compiler::Program;
use texgraph_compiler::manifest::{Filter, Format, Value, Wrap};
use texgraph_runtime::gpu::Gpu;
use texgraph_runtime::render::{RenderError, Request};
use texgraph_runtime::resource::Tables;

fn with(program: &Program, mut request: Request, name: &str, value: &[f32]) -> Request {
    request.settings.set(&program.manifest, name, Value::Float(value.to_vec())).expect("it is set");
    request
}

/// From a file's text: a bake with a param, one without, one of both, and a fold over the last.
const SOURCE: &str = r#"
param stripes: float = 5.0 in 1.0..=20.0
node waves(p: vec2) -> (v: vec4) {
    v = vec4(0.5 + 0.5 * sin(6.2832 * stripes * p.x), p.y, p.x * p.y, 1.0)
}
node rings(p: vec2) -> (v: float) { v = fract(4.0 * length(p - 0.5)) }
let base = bake(waves, size: ivec2(64))
let ring = bake(rings, size: ivec2(128), wrap: clamp)
node mixed(at: vec2) -> (v: vec4) { v = base.sample(at * 2.0) * ring.sample(at).x }
let both = bake(mixed, size: ivec2(256, 128), format: rgba8unorm)
texture shown(uv: vec2, time: float) -> (color: color) {
    let sum = fold (sum = vec4(0.0)) for i in 0..ifloor(uv.x * 6.0) max 8 {
        sum = sum + 0.2 * both.sample(uv + float(i) * 0.1 + time)
    }
    color = sum
}
"#;

pub fn compiled_bakes_agree(gpu: &Gpu) -> Result<(), Failed> {
    let folder = super::common::folder();
    let (program, tables) = super::compiled(folder.path(), SOURCE)?;
    let mut ahead = tables.clone();
    texgraph_runtime::bake::render_fixed(&program, &mut ahead).map_err(|error| error.to_string())?;
    if ahead.iter().count() != 1 {
        return Err("one bake of three depends on no param".into());
    }
    for side in [200, 90] {
        let request =
            Request { time: 0.25, region: [0.113, -0.21, 1.207, 0.884], ..Request::new([side, side]) };
        compare(gpu, &program, &tables, &request, FILTERED)?;
        let request = with(&program, request, "stripes", &[2.0]);
        compare(gpu, &program, &ahead, &request, FILTERED)?;
    }
    Ok(())
}

/// Every format and wrap, from near to far: all levels.
pub fn bakes_agree(gpu: &Gpu) -> Result<(), Failed> {
    let formats = [Format::Rgba16Float, Format::Rgba8Unorm, Format::Rgba8UnormSrgb, Format::Rgba8Snorm];
    for format in formats {
        for size in [[64, 64], [37, 20]] {
            let mut resource = baked(0, size, format);
            for (wrap, filter) in [(Wrap::Repeat, Filter::Linear), (Wrap::Mirror, Filter::Nearest)] {
                if let Some(sampler) = &mut resource.textures[0].sampler {
                    (sampler.wrap, sampler.filter) = (wrap, filter);
                }
                let program = program_of(vec![pattern(0), shown(0)], vec![resource.clone()]);
                for side in [160, 40, 12] {
                    let request =
                        Request { region: [-0.313, 0.107, 1.303, 1.719], ..Request::new([side, side]) };
                    compare(gpu, &program, &Tables::default(), &request, FILTERED)?;
                }
            }
        }
    }
    Ok(())
}

/// A bake of more than one tile, shown texel by texel where four of them meet. Neighbouring texels
/// are a fifth apart.
pub fn large_bakes_agree(gpu: &Gpu) -> Result<(), Failed> {
    let size = [1500, 1100];
    let program = single(pattern(0), size, Format::Rgba16Float);
    let bound = |texel: u32, axis: usize| f64::from(texel) / f64::from(size[axis]);
    let region = [bound(992, 0), bound(992, 1), bound(1056, 0), bound(1056, 1)];
    let request = Request { region, ..Request::new([64, 64]) };
    let request = with(&program, request, "scale", &[300.0, 220.0]);
    compare(gpu, &program, &Tables::default(), &request, FILTERED)
}

pub fn bakes_of_bakes_agree(gpu: &Gpu) -> Result<(), Failed> {
    let program = bake_of_a_bake();
    for side in [100, 16] {
        compare(gpu, &program, &Tables::default(), &Request::new([side, side]), FILTERED)?;
        let request = with(&program, Request::new([side, side]), "tint", &[0.0, 1.0, 1.0, 1.0]);
        compare(gpu, &program, &Tables::default(), &request, FILTERED)?;
    }
    Ok(())
}

pub fn bakes_are_drawn_again_only_for_their_params(gpu: &Gpu) -> Result<(), Failed> {
    let program = bake_of_a_bake();
    let mut scene = gpu.prepare(&program, &Tables::default(), 0).map_err(|error| error.to_string())?;
    let mut expect = |request: &Request, drawn: u64| {
        let picture = scene.render(request, &|_| {}).map_err(|error| error.to_string())?;
        let mut fresh = gpu.prepare(&program, &Tables::default(), 0).map_err(|error| error.to_string())?;
        let anew = fresh.render(request, &|_| {}).map_err(|error| error.to_string())?;
        if scene.bakes_drawn() != drawn {
            return Err(format!("{} bakes were drawn, not {drawn}", scene.bakes_drawn()));
        }
        if picture == anew { Ok(picture) } else { Err("a kept bake is not as a new one".to_owned()) }
    };
    let request = Request::new([20, 20]);
    let first = expect(&request, 2)?;
    expect(&Request { time: 2.0, region: [0.5, 0.5, 1.0, 1.0], ..request.clone() }, 2)?;
    let request = with(&program, request, "gain", &[0.25]);
    let gained = expect(&request, 2)?;
    let request = with(&program, request, "tint", &[1.0, 0.0, 1.0, 1.0]);
    let tinted = expect(&request, 3)?;
    let request = with(&program, request, "scale", &[5.0, 1.0]);
    let scaled = expect(&request, 5)?;
    let pictures = [&first, &gained, &tinted, &scaled];
    if pictures.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err("a param changes nothing: it proves nothing".into());
    }
    Ok(())
}

pub fn values_out_of_range_are_stored_alike(gpu: &Gpu) -> Result<(), Failed> {
    let formats = [Format::Rgba16Float, Format::Rgba8Unorm, Format::Rgba8UnormSrgb, Format::Rgba8Snorm];
    for format in formats {
        let program = single(constant(&[1e30, -1e30, 0.5, 0.25]), [4, 4], format);
        let request = Request::new([3, 3]);
        let ours = texgraph_runtime::cpu::render(&program, &Tables::default(), &request, &|_| {})
            .map_err(|error| error.to_string())?;
        let mut scene = gpu.prepare(&program, &Tables::default(), 0).map_err(|error| error.to_string())?;
        let theirs = scene.render(&request, &|_| {}).map_err(|error| error.to_string())?;
        let difference = ours.difference(&theirs, FILTERED);
        if difference.within < 1.0 {
            return Err(format!("{format:?}: {difference:?}").into());
        }
    }
    Ok(())
}

pub fn a_broken_bake_is_an_error_with_its_name(gpu: &Gpu) -> Result<(), Failed> {
    let mut program = single(smooth(), [4, 4], Format::Rgba16Float);
    program.passes[0].wgsl = "@fragment fn main() -> @location(0) vec4<f32> { return 1; }".into();
    match gpu.prepare(&program, &Tables::default(), 0) {
        Err(RenderError::Bake { name, error }) if name == "r0" && matches!(*error, RenderError::Gpu(_)) => {}
        Err(other) => return Err(other.to_string().into()),
        Ok(_) => return Err("it was accepted".into()),
    }
    let mut program = single(smooth(), [4, 4], Format::Rgba16Float);
    program.manifest.passes[1].reads.clear();
    match gpu.prepare(&program, &Tables::default(), 0) {
        Err(RenderError::Gpu(_)) => Ok(()),
        Err(other) => Err(other.to_string().into()),
        Ok(_) => Err("what a pass does not say that it reads was bound all the same".into()),
    }
}
