// GPU Gems, chapter 20, listings 20-1, 20-2 and 20-4 with the images of 20.1.6, as the chapter writes
// them: four cells, two images each, the highest priority wins. Only the samples in the loop say their
// gradients and levels, since WGSL takes none by itself where pixels may differ.

@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var image_filtering: sampler;
@group(0) @binding(2) var random_numbers: texture_2d<f32>;
@group(0) @binding(3) var random_filtering: sampler;

const NUMBER_OF_SAMPLES = 2;
const NUM_IMAGES_PER_ROW = 8.0;

@fragment
fn listing_fragment(@location(0) uv: vec2<f32>) -> @location(0) vec4<f32> {
    let scaled_uv = uv * 12.0;
    let cell = floor(scaled_uv);
    let offset = scaled_uv - cell;
    let right = dpdx(scaled_uv) * vec2(1.0 / NUM_IMAGES_PER_ROW, 1.0);
    let down = dpdy(scaled_uv) * vec2(1.0 / NUM_IMAGES_PER_ROW, 1.0);
    var color = vec4(0.042311, 0.14703, 0.013702, 1.0);
    var priority = -1.0;
    for (var i = -1; i <= 0; i += 1) {
        for (var j = -1; j <= 0; j += 1) {
            let cell_t = cell + vec2(f32(i), f32(j));
            let offset_t = offset - vec2(f32(i), f32(j));
            var random_uv = cell_t * vec2(0.037, 0.119);
            for (var k = 0; k < NUMBER_OF_SAMPLES; k += 1) {
                let random = textureSampleLevel(random_numbers, random_filtering, random_uv, 0.0);
                random_uv += vec2(0.03, 0.17);
                let index = 4.0 + floor(random.z * 4.0);
                var at = offset_t - random.xy;
                at.x = (saturate(at.x) + index) / NUM_IMAGES_PER_ROW;
                let image_color = textureSampleGrad(image, image_filtering, at, right, down);
                if random.w > priority && image_color.w > 0.0 {
                    color = image_color;
                    priority = random.w;
                }
            }
        }
    }
    return color;
}
