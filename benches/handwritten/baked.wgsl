// Another part of a baked picture in each cell.

@group(0) @binding(0) var ripples: texture_2d<f32>;
@group(0) @binding(1) var filtering: sampler;

const TEXELS = 512.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let right = dpdx(p) * 0.25;
    let down = dpdy(p) * 0.25;
    let at = fract(p) * 0.25 + hash(vec2<i32>(floor(p)), 1918987876).xy;
    return textureSampleGrad(ripples, filtering, at, right, down);
}
