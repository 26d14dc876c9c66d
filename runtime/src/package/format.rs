//! What KTX2 says of each texel format: one row for each.
//!
//! A file names its format twice: by Vulkan's number, and by a basic data format descriptor, which says
//! where the bits of each channel stand and what they mean (Khronos Data Format Specification 1.3,
//! section 5). Of a descriptor only what differs between our formats stands in a row.

use texgraph_compiler::manifest::Format;

/// What is said of a format.
pub struct Row {
    /// The format.
    pub format: Format,
    /// Vulkan's number of it (`VkFormat`).
    pub vulkan: u32,
    /// Bytes of the numbers that a machine of the other byte order would have to swap.
    pub type_size: u32,
    /// The colour model: channels of their own, or a scheme of blocks.
    model: u8,
    /// How numbers stand for light: linear, or as sRGB encodes it.
    transfer: u8,
    /// Whether colours are multiplied by alpha.
    is_premultiplied: bool,
    /// The channels, in the order of their bits.
    samples: &'static [Sample],
}

/// The bits of one channel.
struct Sample {
    first_bit: u16,
    bits: u16,
    /// The channel, with its qualifiers.
    channel: u8,
    /// The words that stand for the least and the greatest value.
    range: [u32; 2],
}

const RGBSDA: u8 = 1;
const BC1A: u8 = 128;
const BC7: u8 = 134;

const LINEAR: u8 = 1;
const SRGB: u8 = 2;

const RED: u8 = 0;
const GREEN: u8 = 1;
const BLUE: u8 = 2;
const ALPHA: u8 = 15;
/// The one channel of a BC1 whose blocks may have alpha.
const BC1A_ALPHA: u8 = 1;
const BC7_COLOR: u8 = 0;

/// Qualifiers of a channel. An alpha is linear where its colours are not.
const LINEAR_ALPHA: u8 = 0x1f;
const SIGNED: u8 = 0x40;
const FLOAT: u8 = 0xc0;

const UNORM: [u32; 2] = [0, 255];
const SNORM: [u32; 2] = [-127_i32 as u32, 127];
const SINT: [u32; 2] = [-1_i32 as u32, 1];
const SFLOAT: [u32; 2] = [(-1.0_f32).to_bits(), 1.0_f32.to_bits()];
const BLOCK: [u32; 2] = [0, u32::MAX];

const fn sample(first_bit: u16, bits: u16, channel: u8, range: [u32; 2]) -> Sample {
    Sample { first_bit, bits, channel, range }
}

/// Red, green, blue and alpha, of so many bits each.
const fn rgba(bits: u16, qualifier: u8, alpha: u8, range: [u32; 2]) -> [Sample; 4] {
    [
        sample(0, bits, RED | qualifier, range),
        sample(bits, bits, GREEN | qualifier, range),
        sample(2 * bits, bits, BLUE | qualifier, range),
        sample(3 * bits, bits, alpha | qualifier, range),
    ]
}

/// All formats.
pub static ROWS: &[Row] = &[
    Row {
        format: Format::Rgba8UnormSrgb,
        vulkan: 43,
        type_size: 1,
        model: RGBSDA,
        transfer: SRGB,
        is_premultiplied: true,
        samples: &rgba(8, 0, LINEAR_ALPHA, UNORM),
    },
    Row { vulkan: 37, samples: &rgba(8, 0, ALPHA, UNORM), ..data(Format::Rgba8Unorm, 1) },
    Row { vulkan: 38, samples: &rgba(8, SIGNED, ALPHA, SNORM), ..data(Format::Rgba8Snorm, 1) },
    Row { vulkan: 97, samples: &rgba(16, FLOAT, ALPHA, SFLOAT), ..data(Format::Rgba16Float, 2) },
    Row { vulkan: 99, samples: &[sample(0, 32, RED | SIGNED, SINT)], ..data(Format::R32Sint, 4) },
    Row { vulkan: 108, samples: &rgba(32, SIGNED, ALPHA, SINT), ..data(Format::Rgba32Sint, 4) },
    Row {
        vulkan: 133,
        model: BC1A,
        samples: &[sample(0, 64, BC1A_ALPHA, BLOCK)],
        ..data(Format::Bc1RgbaUnorm, 1)
    },
    Row {
        vulkan: 145,
        model: BC7,
        samples: &[sample(0, 128, BC7_COLOR, BLOCK)],
        ..data(Format::Bc7RgbaUnorm, 1)
    },
];

/// Numbers as they are, with a channel each.
const fn data(format: Format, type_size: u32) -> Row {
    Row {
        format,
        vulkan: 0,
        type_size,
        model: RGBSDA,
        transfer: LINEAR,
        is_premultiplied: false,
        samples: &[],
    }
}

impl Row {
    /// The row of a format.
    pub fn of(format: Format) -> Option<&'static Row> {
        ROWS.iter().find(|row| row.format == format)
    }

    /// The row of a number of Vulkan's.
    pub fn of_vulkan(number: u32) -> Option<&'static Row> {
        ROWS.iter().find(|row| row.vulkan == number)
    }

    /// The data format descriptor, with its length before it.
    pub fn descriptor(&self) -> Vec<u8> {
        let block = 24 + 16 * self.samples.len() as u32;
        let bt709 = 1;
        let flags = u8::from(self.is_premultiplied);
        let side = self.format.block() as u8 - 1;
        let mut words = vec![
            block + 4,
            // Khronos's own descriptor of the basic type, version 1.3.
            0,
            2 | block << 16,
            u32::from_le_bytes([self.model, bt709, self.transfer, flags]),
            u32::from_le_bytes([side, side, 0, 0]),
            // All in one plane.
            self.format.bytes(),
            0,
        ];
        for Sample { first_bit, bits, channel, range } in self.samples {
            let place = u32::from(*first_bit) | u32::from(bits - 1) << 16 | u32::from(*channel) << 24;
            words.extend([place, 0, range[0], range[1]]);
        }
        words.into_iter().flat_map(u32::to_le_bytes).collect()
    }
}
