// The disc of the highest priority among those of four cells, sampled once behind the loop (GPU Gems,
// 20.2.1); far away a baked patch of them.

@group(0) @binding(0) var tiles: texture_2d_array<f32>;
@group(0) @binding(1) var filtering: sampler;
@group(0) @binding(2) var patch_of_many: texture_2d<f32>;
@group(0) @binding(3) var repeating: sampler;

const TEXELS = 128.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let corner = vec2<i32>(floor(p - 0.5));
    var rank = -1.0;
    var at = vec2(0.0);
    var right = vec2(0.0);
    var down = vec2(0.0);
    var pick = 0;
    for (var k = 0; k < 4; k += 1) {
        let cell = corner + vec2(k & 1, k >> 1);
        let random = hash(cell, 1918987876);
        let turn = rotation(random.z * 6.2831855);
        let away = turn * (p - vec2<f32>(cell) - mix(vec2(0.4), vec2(0.6), random.xy));
        let wins = length(away) < 0.55 && random.w > rank;
        rank = select(rank, random.w, wins);
        at = select(at, away + 0.5, wins);
        right = select(right, turn * dpdx(p), wins);
        down = select(down, turn * dpdy(p), wins);
        pick = select(pick, i32(hash(cell, 1).x * 16.0), wins);
    }
    let tile = textureSampleGrad(tiles, filtering, at, pick, right, down);
    let ground = vec4(0.06847817, 0.049706567, 0.035601314, 1.0);
    let color = select(tile, ground, rank < 0.0);
    let q = p / 64.0;
    let many = textureSampleGrad(patch_of_many, repeating, q, dpdx(q), dpdy(q));
    return mix(color, many, fade(p));
}
