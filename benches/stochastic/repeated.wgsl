// The picture repeated: one sample, as anyone writes it.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var picture_sampler: sampler;

@fragment
fn repeated_fragment(@location(0) place: vec2<f32>) -> @location(0) vec4<f32> {
    let uv = place * 16.0;
    return textureSampleGrad(picture, picture_sampler, uv, dpdx(uv), dpdy(uv));
}
