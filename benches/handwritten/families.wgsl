// Two families of tiles and the transitions between them; far away the mean of all neighbourhoods.

@group(0) @binding(0) var grass: texture_2d_array<f32>;
@group(0) @binding(1) var grass_filtering: sampler;
@group(0) @binding(2) var grass_means: texture_2d<f32>;
@group(0) @binding(4) var sand: texture_2d_array<f32>;
@group(0) @binding(5) var sand_filtering: sampler;
@group(0) @binding(6) var sand_means: texture_2d<f32>;
@group(0) @binding(8) var shore: texture_2d_array<f32>;
@group(0) @binding(9) var shore_filtering: sampler;
@group(0) @binding(10) var shore_means: texture_2d<f32>;
@group(0) @binding(12) var order: texture_2d<i32>;

const TEXELS = 96.0;

// A permutation, looked up for each digit of a place: both families stand equally often in any
// sixty-four cells of a row or a column (Lefebvre & Neyret 2003, §3.5).
fn family(cell: vec2<i32>) -> i32 {
    let place = cell + 81006;
    var s = 0;
    for (var digit = 0; digit < 6; digit += 1) {
        let part = select(place.x, place.y, digit > 2) >> u32(6 * (digit % 3));
        s = textureLoad(order, vec2((part + s) & 63, 0), 0).x;
    }
    return s >> 5;
}

@fragment
fn t_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let p = place(uv);
    let right = dpdx(p);
    let down = dpdy(p);
    let cell = vec2<i32>(floor(p));
    let at = fract(p);
    let code = family(cell) + 2 * family(cell + vec2(1, 0)) + 4 * family(cell + vec2(0, 1)) + 8 * family(cell + 1);
    let pick = i32(hash(cell, 0).x * 16.0);
    let border = textureSampleGrad(shore, shore_filtering, at, code, right, down);
    let green = textureSampleGrad(grass, grass_filtering, at, pick, right, down);
    let yellow = textureSampleGrad(sand, sand_filtering, at, pick, right, down);
    let tile = select(select(border, green, code == 15), yellow, code == 0);
    let others = textureLoad(grass_means, vec2(16, 0), 0) + textureLoad(sand_means, vec2(16, 0), 0)
        - textureLoad(shore_means, vec2(0, 0), 0) - textureLoad(shore_means, vec2(15, 0), 0);
    return mix(tile, textureLoad(shore_means, vec2(16, 0), 0) + others / 16.0, fade(p));
}
