// Basic tiling as one writes it by hand: sixteen tiles, one at random in each cell. The bindings, the
// entry point and the picture are those of examples/tiling.tex.

struct Params {
    cells: i32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var tiles: texture_2d_array<f32>;
@group(0) @binding(2) var tiles_sampler: sampler;

// The first word of pcg4d (Jarzynski & Olano 2020) of (cell, 0, 0). Two of the seeded words are known,
// and of the second round only the first line is needed.
fn pcg4d_x(cell: vec2<u32>) -> u32 {
    const SEED = 1013904223u;
    let v = cell * 1664525u + SEED;
    let x = v.x + v.y * SEED;
    let y = v.y + SEED * x;
    let z = SEED + x * y;
    let w = SEED + y * z;
    let first = vec3(x, y, w);
    let mixed = first ^ (first >> vec3(16u));
    return mixed.x + mixed.y * mixed.z;
}

@fragment
fn tiling_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let place = uv * f32(params.cells);
    let cell = vec2<u32>(vec2<i32>(floor(place)));
    // The upper four bits are one of sixteen.
    let pick = pcg4d_x(cell) >> 28u;
    return textureSampleGrad(tiles, tiles_sampler, fract(place), pick, dpdx(place), dpdy(place));
}
