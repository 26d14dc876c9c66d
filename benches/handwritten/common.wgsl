// What the hand-written shaders of the quality bench share. Before it stand two constants: REPEAT,
// units along the lower edge of the plane in perspective, 0 for a flat view; and ASPECT, the width of
// the picture by its height.

const HORIZON = 0.25;

// The place that a pixel sees.
fn place(uv: vec2<f32>) -> vec2<f32> {
    if REPEAT == 0.0 {
        return uv;
    }
    let far = (1.0 - HORIZON) / (uv.y - HORIZON);
    return REPEAT * vec2(0.5 + (uv.x - 0.5) * far, 1.0 + (1.0 - far) / ASPECT);
}

// How much of the mean shows: none up to one cell a pixel, nothing else from two on.
fn fade(p: vec2<f32>) -> f32 {
    return clamp(max(length(dpdx(p)), length(dpdy(p))) - 1.0, 0.0, 1.0);
}

// The level of detail as it is defined, of a picture with TEXELS a side, which each shader says.
fn level(right: vec2<f32>, down: vec2<f32>) -> f32 {
    return log2(max(length(right), length(down)) * TEXELS);
}

// pcg4d (Jarzynski & Olano, JCGT 2020), as floats below 1.
fn hash(cell: vec2<i32>, seed: i32) -> vec4<f32> {
    var v = vec4<u32>(vec4(cell, 0, seed)) * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> vec4(16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return vec4<f32>(v >> vec4(8u)) / 16777216.0;
}

fn rotation(angle: f32) -> mat2x2<f32> {
    let c = cos(angle);
    let s = sin(angle);
    return mat2x2(c, s, -s, c);
}
