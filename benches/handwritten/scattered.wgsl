// A turned, scaled and moved part of one picture in each cell; the gradient is turned and scaled too.

@group(0) @binding(0) var rock: texture_2d<f32>;
@group(0) @binding(1) var filtering: sampler;

const TEXELS = 512.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let random = hash(vec2<i32>(floor(p)), 1918987876);
    let turn = rotation(random.z * 6.2831855) * mix(0.2, 0.35, random.w);
    let right = turn * dpdx(p);
    let down = turn * dpdy(p);
    return textureSampleGrad(rock, filtering, turn * fract(p) + random.xy, right, down);
}
