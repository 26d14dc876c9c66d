//! Colours as people write them.

/// A straight sRGB colour of 8 bits a channel as linear premultiplied light, 0..1.
pub fn linear([r, g, b, a]: [u8; 4]) -> [f32; 4] {
    let alpha = f32::from(a) / 255.0;
    let light = |channel: u8| linear_channel(channel) * alpha;
    [light(r), light(g), light(b), alpha]
}

/// IEC 61966-2-1.
fn linear_channel(channel: u8) -> f32 {
    let c = f64::from(channel) / 255.0;
    let light = if c <= 0.040_45 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) };
    light as f32
}
