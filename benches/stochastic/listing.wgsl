// Listings 1.1 to 1.3, 1.5, 1.10 and 1.11 of Deliot & Heitz 2019 as WGSL. The table has the layout of
// ours, so colours differ; what is done, and how often, is the listings'. WGSL has no textureQueryLod:
// the level is worked out as it is defined.

@group(0) @binding(0) var t_input: texture_2d<f32>;
@group(0) @binding(1) var t_sampler: sampler;
@group(0) @binding(2) var inv_t: texture_2d<f32>;
@group(0) @binding(3) var inv_sampler: sampler;

const vector1: vec3<f32> = vec3(0.6, 0.6, 0.5);
const vector2: vec3<f32> = vec3(-0.5, 0.1, 0.6);
const vector3: vec3<f32> = vec3(0.3, -0.7, 0.5);
const origin: vec3<f32> = vec3(0.1, 0.2, 0.1);

struct Grid { w1: f32, w2: f32, w3: f32, vertex1: vec2<i32>, vertex2: vec2<i32>, vertex3: vec2<i32> }

fn triangle_grid(place: vec2<f32>) -> Grid {
    let uv = place * 3.464;
    let skewed = mat2x2<f32>(1.0, 0.0, -0.57735027, 1.15470054) * uv;
    let base = vec2<i32>(floor(skewed));
    var temp = vec3(fract(skewed), 0.0);
    temp.z = 1.0 - temp.x - temp.y;
    if temp.z > 0.0 {
        return Grid(temp.z, temp.y, temp.x, base, base + vec2(0, 1), base + vec2(1, 0));
    }
    return Grid(-temp.z, 1.0 - temp.y, 1.0 - temp.x, base + vec2(1, 1), base + vec2(1, 0), base + vec2(0, 1));
}

fn hash(p: vec2<i32>) -> vec2<f32> {
    return fract(sin(mat2x2<f32>(127.1, 311.7, 269.5, 183.3) * vec2<f32>(p)) * 43758.5453);
}

fn return_to_original_color_space(color: vec3<f32>) -> vec3<f32> {
    return origin + vector1 * color.r + vector2 * color.g + vector3 * color.b;
}

@fragment
fn listing_fragment(@location(0) place: vec2<f32>) -> @location(0) vec4<f32> {
    let uv = place * 16.0;
    let g = triangle_grid(uv);
    let uv1 = uv + hash(g.vertex1);
    let uv2 = uv + hash(g.vertex2);
    let uv3 = uv + hash(g.vertex3);
    let dx = dpdx(uv);
    let dy = dpdy(uv);
    let g1 = textureSampleGrad(t_input, t_sampler, uv1, dx, dy).rgb;
    let g2 = textureSampleGrad(t_input, t_sampler, uv2, dx, dy).rgb;
    let g3 = textureSampleGrad(t_input, t_sampler, uv3, dx, dy).rgb;
    var gaussian = g.w1 * g1 + g.w2 * g2 + g.w3 * g3;
    gaussian = gaussian - vec3(0.5);
    gaussian = gaussian * inverseSqrt(g.w1 * g.w1 + g.w2 * g.w2 + g.w3 * g.w3);
    gaussian = gaussian + vec3(0.5);
    let size = vec2<f32>(textureDimensions(t_input));
    let tx = dx * size;
    let ty = dy * size;
    let lod = 0.5 * log2(max(dot(tx, tx), dot(ty, ty))) / f32(textureDimensions(inv_t).y);
    let color = vec3(
        textureSampleLevel(inv_t, inv_sampler, vec2(gaussian.r, lod), 0.0).r,
        textureSampleLevel(inv_t, inv_sampler, vec2(gaussian.g, lod), 0.0).g,
        textureSampleLevel(inv_t, inv_sampler, vec2(gaussian.b, lod), 0.0).b,
    );
    return vec4(return_to_original_color_space(color), 1.0);
}
