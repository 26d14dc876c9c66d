// The tile of the nearest random point among nine cells; far away the mean.

@group(0) @binding(0) var tiles: texture_2d_array<f32>;
@group(0) @binding(1) var filtering: sampler;
@group(0) @binding(2) var means: texture_2d<f32>;

const TEXELS = 128.0;

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let right = dpdx(p);
    let down = dpdy(p);
    let home = vec2<i32>(floor(p));
    var nearest = 9.0;
    var winner = home;
    for (var k = 0; k < 9; k += 1) {
        let cell = home + vec2(k % 3, k / 3) - 1;
        let away = vec2<f32>(cell) + hash(cell, 1668246636).xy - p;
        let wins = dot(away, away) < nearest;
        nearest = select(nearest, dot(away, away), wins);
        winner = select(winner, cell, wins);
    }
    let pick = i32(hash(winner, 0).x * 16.0);
    let at = fract(p + hash(winner, 1769109).xy);
    let tile = textureSampleGrad(tiles, filtering, at, pick, right, down);
    return mix(tile, textureLoad(means, vec2(16, 0), 0), fade(p));
}
