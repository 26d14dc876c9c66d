// Blocks of four by four tiles, each block turned by quarters.

@group(0) @binding(0) var tiles: texture_2d_array<f32>;
@group(0) @binding(1) var filtering: sampler;
@group(0) @binding(2) var means: texture_2d<f32>;

const TEXELS = 128.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let block = vec2<i32>(floor(p * 0.25));
    let turn = rotation(1.5707964 * floor(hash(block, 1).x * 4.0));
    let inside = (turn * (fract(p * 0.25) - 0.5) + 0.5) * 4.0;
    let right = turn * dpdx(p);
    let down = turn * dpdy(p);
    let pick = i32(hash(block * 4 + vec2<i32>(floor(inside)), 0).x * 16.0);
    let tile = textureSampleGrad(tiles, filtering, fract(inside), pick, right, down);
    return mix(tile, textureLoad(means, vec2(16, 0), 0), fade(p));
}
