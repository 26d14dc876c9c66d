// Sixteen tiles at random, as a careful person writes it: the gradient of the place before `fract`.

@group(0) @binding(0) var tiles: texture_2d_array<f32>;
@group(0) @binding(1) var filtering: sampler;
@group(0) @binding(2) var means: texture_2d<f32>;

const TEXELS = 128.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let right = dpdx(p);
    let down = dpdy(p);
    let pick = i32(hash(vec2<i32>(floor(p)), 0).x * 16.0);
    let tile = textureSampleGrad(tiles, filtering, fract(p), pick, right, down);
    return mix(tile, textureLoad(means, vec2(16, 0), 0), fade(p));
}
