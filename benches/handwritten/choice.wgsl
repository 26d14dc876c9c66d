// One of two pictures in each cell; far away the mean of both.

@group(0) @binding(0) var rock: texture_2d<f32>;
@group(0) @binding(1) var rock_filtering: sampler;
@group(0) @binding(2) var planks: texture_2d<f32>;
@group(0) @binding(3) var planks_filtering: sampler;

const TEXELS = 512.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let right = dpdx(p) * 0.25;
    let down = dpdy(p) * 0.25;
    let cell = vec2<i32>(floor(p));
    let at = fract(p) * 0.25 + hash(cell, 1918987876).xy;
    let stone = textureSampleGrad(rock, rock_filtering, at, right, down);
    let wood = textureSampleGrad(planks, planks_filtering, at, right, down);
    let chosen = select(wood, stone, hash(cell, 1).x < 0.5);
    let stones = textureSampleLevel(rock, rock_filtering, at, 16.0);
    let woods = textureSampleLevel(planks, planks_filtering, at, 16.0);
    return mix(chosen, (stones + woods) * 0.5, fade(p));
}
