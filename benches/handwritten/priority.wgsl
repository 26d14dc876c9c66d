// The disc of the highest priority among those of four cells; far away a baked patch of them.

@group(0) @binding(0) var tiles: texture_2d_array<f32>;
@group(0) @binding(1) var filtering: sampler;
@group(0) @binding(2) var patch_of_many: texture_2d<f32>;
@group(0) @binding(3) var repeating: sampler;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let corner = vec2<i32>(floor(p - 0.5));
    var color = vec4(0.06847817, 0.049706567, 0.035601314, 1.0);
    var rank = -1.0;
    for (var k = 0; k < 4; k += 1) {
        let cell = corner + vec2(k & 1, k >> 1);
        let random = hash(cell, 0);
        let turn = rotation(random.z * 6.2831855);
        let away = turn * (p - vec2<f32>(cell) - mix(vec2(0.4), vec2(0.6), random.xy));
        let right = turn * dpdx(p);
        let down = turn * dpdy(p);
        let pick = i32(hash(cell, 1).x * 16.0);
        let tile = textureSampleGrad(tiles, filtering, away + 0.5, pick, right, down);
        let wins = length(away) < 0.55 && random.w > rank;
        color = select(color, tile, wins);
        rank = select(rank, random.w, wins);
    }
    let q = p / 64.0;
    let many = textureSampleGrad(patch_of_many, repeating, q, dpdx(q), dpdy(q));
    return mix(color, many, fade(p));
}
