// The mixed graph of ten nodes (examples/mixed.tex) as a careful author writes it by hand.
// It gives the same picture; the size of our own output is measured against it.

@group(0) @binding(0) var rock: texture_2d<f32>;
@group(0) @binding(1) var rock_sampler: sampler;
@group(0) @binding(2) var planks: texture_2d<f32>;
@group(0) @binding(3) var planks_sampler: sampler;

// The functions.

// pcg4d (Jarzynski & Olano, Hash Functions for GPU Rendering, JCGT 2020).
fn hash(v: vec4<i32>) -> vec4<f32> {
    var u = vec4<u32>(v) * 1664525u + 1013904223u;
    u.x += u.y * u.w;
    u.y += u.z * u.x;
    u.z += u.x * u.y;
    u.w += u.y * u.z;
    u ^= u >> vec4(16u);
    u.x += u.y * u.w;
    u.y += u.z * u.x;
    u.z += u.x * u.y;
    u.w += u.y * u.z;
    return vec4<f32>(u >> vec4(8u)) / 16777216.0;
}

// Hex-tiling (Mikkelsen, Practical Real-Time Hex-Tiling, JCGT 2022).
fn hexagon(picture: texture_2d<f32>, smp: sampler, at: vec2<f32>, dx: vec2<f32>, dy: vec2<f32>, vertex: vec2<i32>) -> vec4<f32> {
    let random = hash(vec4(vertex, 0, 1752528993));
    let centre = mat2x2(0.28867513, 0.0, 0.14433757, 0.25) * vec2<f32>(vertex);
    let angle = (random.z - 0.5) * 6.2831855;
    let c = cos(angle);
    let s = sin(angle);
    let turn = mat2x2(c, s, -s, c);
    return textureSampleGrad(picture, smp, turn * (at - centre) + centre + random.xy, turn * dx, turn * dy);
}

fn hex_tile(picture: texture_2d<f32>, smp: sampler, at: vec2<f32>, dx: vec2<f32>, dy: vec2<f32>) -> vec4<f32> {
    let skewed = mat2x2(3.4641016, 0.0, -2.0, 4.0) * at;
    let corner = vec2<i32>(floor(skewed));
    let inside = fract(skewed);
    let upper = inside.x + inside.y > 1.0;
    let s = select(0, 1, upper);
    let near = select(inside, 1.0 - inside, upper);
    let a = hexagon(picture, smp, at, dx, dy, corner + s);
    let b = hexagon(picture, smp, at, dx, dy, corner + vec2(s, 1 - s));
    let c = hexagon(picture, smp, at, dx, dy, corner + vec2(1 - s, s));
    let grey = vec3(0.299, 0.587, 0.114);
    let bright = vec3(dot(a.rgb, grey), dot(b.rgb, grey), dot(c.rgb, grey));
    let place = vec3(1.0 - near.x - near.y, near.y, near.x);
    let weight = mix(vec3(1.0), bright, 0.6) * pow(max(place, vec3(0.0)), vec3(7.0));
    return (a * weight.x + b * weight.y + c * weight.z) / (weight.x + weight.y + weight.z);
}

// Gradient noise (Perlin, Improving Noise, SIGGRAPH 2002).
fn slope(cell: vec2<i32>) -> vec2<f32> {
    return normalize(hash(vec4(cell, 0, 0)).xy - 0.5);
}

fn noise(p: vec2<f32>) -> f32 {
    let cell = vec2<i32>(floor(p));
    let at = fract(p);
    let fade = at * at * at * (at * (at * 6.0 - 15.0) + 10.0);
    let a = dot(slope(cell), at);
    let b = dot(slope(cell + vec2(1, 0)), at - vec2(1.0, 0.0));
    let c = dot(slope(cell + vec2(0, 1)), at - vec2(0.0, 1.0));
    let d = dot(slope(cell + 1), at - 1.0);
    return mix(mix(a, b, fade.x), mix(c, d, fade.x), fade.y) * 1.4142135;
}

fn fbm(p: vec2<f32>, octaves: i32) -> f32 {
    var sum = 0.0;
    var place = p;
    var height = 1.0;
    for (var i = 0; i < octaves; i++) {
        sum += noise(place) * height;
        place = place * 2.0 + 17.25;
        height *= 0.5;
    }
    return sum;
}

// The graph.

@fragment
fn mixed_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let dx = dpdx(uv);
    let dy = dpdy(uv);
    let place = uv * 3.741;
    let hex = hex_tile(rock, rock_sampler, uv * 6.482, dx * 6.482, dy * 6.482);
    let level = noise(place) * 0.5 + 0.5;
    let image = textureSampleGrad(planks, planks_sampler, uv * 2.223, dx * 2.223, dy * 2.223);
    let blend = mix(hex, image, level);
    let fractal = fbm(place + level, 3);
    let shape = smoothstep(0.0, 0.6, fractal * level);
    return mix(blend, 1.0 - (1.0 - image) * (1.0 - blend), shape);
}
