//! Picture files: PNG, JPEG and TGA to rows of 8- or 16-bit samples, OpenEXR and Radiance HDR to 16-bit
//! floats.
//!
//! A header may lie, so the size is checked before a texel is allocated, and everything a decoder
//! says against a file becomes an error with the file's name. Pictures are taken as stored:
//! colour profiles, gamma chunks and a camera's orientation are not looked at. All samples are codes of
//! 16 bits at most, so that what they stand for is looked up, floats' too.

use crate::project::{Problem, Project};
use half::f16;
use image::{ColorType, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};

/// The longest side that is decoded, in texels. A texture may be smaller still.
pub const MAX_SIDE: u32 = 16_384;

/// Why samples are not read.
const UNKNOWN: &str = "its samples are neither of 8 or 16 bits nor floats";

/// The most bytes that a decoder may use.
const MAX_BYTES: u64 = 1 << 30;

/// A decoded picture, its samples as stored.
pub struct Decoded {
    /// Texels across and down.
    pub size: [u32; 2],
    channels: usize,
    /// What a code of its samples is.
    pub depth: Depth,
    samples: Samples,
}

enum Samples {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
}

/// What a sample's code is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Depth {
    /// A share of 255.
    Eight,
    /// A share of 65,535.
    Sixteen,
    /// A 16-bit float's bits. Colours are light, not encoded.
    Half,
}

impl Depth {
    /// Whether 8 bits don't hold it.
    pub fn is_deep(self) -> bool {
        self != Depth::Eight
    }

    /// The code of an alpha that lets nothing through.
    pub fn opaque(self) -> u16 {
        match self {
            Depth::Eight => u16::from(u8::MAX),
            Depth::Sixteen => u16::MAX,
            Depth::Half => f16::ONE.to_bits(),
        }
    }

    /// The greatest code.
    pub fn last(self) -> u16 {
        if self == Depth::Eight { u16::from(u8::MAX) } else { u16::MAX }
    }

    /// The number that a code is: 0..1, or any that a 16-bit float can be. What is no number is 0.
    pub fn number(self, code: u16) -> f32 {
        match self {
            Depth::Eight => f32::from(code) / 255.0,
            Depth::Sixteen => f32::from(code) / 65535.0,
            Depth::Half => float(f16::from_bits(code)),
        }
    }

    /// Which of so many equal parts of 0..1 a code's number lies in.
    pub fn part(self, code: u16, parts: u32) -> u32 {
        match self {
            Depth::Half => (f64::from(self.number(code)) * f64::from(parts)) as u32,
            _ => (u64::from(code) * u64::from(parts) / (u64::from(self.last()) + 1)) as u32,
        }
        .min(parts.saturating_sub(1))
    }
}

/// A 16-bit float as a finite number.
fn float(half: f16) -> f32 {
    match half.is_nan() {
        true => 0.0,
        false => half.to_f32().clamp(f16::MIN.to_f32(), f16::MAX.to_f32()),
    }
}

impl Decoded {
    /// A picture of three 8-bit samples a texel, row by row; none if there are more or fewer than that.
    pub fn rgb(size: [u32; 2], samples: Vec<u8>) -> Option<Decoded> {
        let texels = size[0] as usize * size[1] as usize;
        (samples.len() == 3 * texels).then_some(Decoded {
            size,
            channels: 3,
            depth: Depth::Eight,
            samples: Samples::Eight(samples),
        })
    }

    /// The cells of pictures, row by row, one below another; none where the pictures' samples differ in
    /// form.
    pub fn stacked(pictures: &[Decoded], [columns, rows]: [u32; 2]) -> Option<Decoded> {
        let first = pictures.first()?;
        if pictures.iter().any(|other| (other.channels, other.depth) != (first.channels, first.depth)) {
            return None;
        }
        let [width, height] = [first.size[0] / columns, first.size[1] / rows];
        // Where each row of each cell begins, in samples, and how many it has.
        let length = width as usize * first.channels;
        let begins = (0..rows * columns).flat_map(|cell| {
            let [column, row] = [cell % columns, cell / columns];
            let texel = move |y: u32| (row * height + y) as usize * first.size[0] as usize;
            (0..height).map(move |y| (texel(y) + (column * width) as usize) * first.channels)
        });
        let begins: Vec<usize> = begins.collect();
        let samples = match first.samples {
            Samples::Eight(_) => Samples::Eight(cut(pictures, &begins, length, |samples| match samples {
                Samples::Eight(samples) => samples,
                Samples::Sixteen(_) => &[],
            })?),
            Samples::Sixteen(_) => {
                Samples::Sixteen(cut(pictures, &begins, length, |samples| match samples {
                    Samples::Eight(_) => &[],
                    Samples::Sixteen(samples) => samples,
                })?)
            }
        };
        let size = [width, height * rows * columns * pictures.len() as u32];
        Some(Decoded { size, channels: first.channels, depth: first.depth, samples })
    }

    /// Whether there is a channel of alpha.
    pub fn has_alpha(&self) -> bool {
        matches!(self.channels, 2 | 4)
    }

    /// Whether red, green and blue are one channel.
    pub fn is_grey(&self) -> bool {
        self.channels <= 2
    }

    /// Whether no texel lets anything through.
    pub fn is_opaque(&self) -> bool {
        let mut is_opaque = true;
        if self.has_alpha() {
            let opaque = self.depth.opaque();
            let texels = self.size[0] as usize * self.size[1] as usize;
            self.read(0, texels, |_, texel| is_opaque &= texel[3] == opaque);
        }
        is_opaque
    }

    /// Gives so many texels to a function with their number from 0 on, row by row from the `first` on:
    /// as [`Decoded::texel`] gives them, faster.
    pub fn read(&self, first: usize, count: usize, mut each: impl FnMut(usize, [u16; 4])) {
        let (opaque, channels) = (self.depth.opaque(), self.channels);
        let range = first * channels..(first + count) * channels;
        match &self.samples {
            Samples::Eight(samples) => read_texels(&samples[range], channels, opaque, &mut each),
            Samples::Sixteen(samples) => read_texels(&samples[range], channels, opaque, &mut each),
        }
    }

    /// Red, green, blue and alpha as stored. Grey gives (v, v, v); without alpha it is opaque.
    pub fn texel(&self, x: u32, y: u32) -> [u16; 4] {
        let at = (y as usize * self.size[0] as usize + x as usize) * self.channels;
        let s = |channel: usize| match &self.samples {
            Samples::Eight(samples) => samples.get(at + channel).copied().map_or(0, u16::from),
            Samples::Sixteen(samples) => samples.get(at + channel).copied().unwrap_or(0),
        };
        match self.channels {
            1 => [s(0), s(0), s(0), self.depth.opaque()],
            2 => [s(0), s(0), s(0), s(1)],
            3 => [s(0), s(1), s(2), self.depth.opaque()],
            _ => [s(0), s(1), s(2), s(3)],
        }
    }
}

/// The same rows of all pictures.
fn cut<T: Copy>(
    pictures: &[Decoded],
    begins: &[usize],
    length: usize,
    of: impl Fn(&Samples) -> &[T],
) -> Option<Vec<T>> {
    let rows = pictures
        .iter()
        .flat_map(|picture| begins.iter().map(|at| of(&picture.samples).get(*at..at + length)));
    Some(rows.collect::<Option<Vec<_>>>()?.concat())
}

fn read_texels<T: Copy + Into<u16>>(
    samples: &[T],
    channels: usize,
    opaque: u16,
    each: &mut impl FnMut(usize, [u16; 4]),
) {
    match channels {
        1 => samples
            .iter()
            .enumerate()
            .for_each(|(i, s)| each(i, [(*s).into(), (*s).into(), (*s).into(), opaque])),
        2 => samples.as_chunks().0.iter().enumerate().for_each(|(i, [s, a])| {
            each(i, [(*s).into(), (*s).into(), (*s).into(), (*a).into()]);
        }),
        3 => samples.as_chunks().0.iter().enumerate().for_each(|(i, [r, g, b])| {
            each(i, [(*r).into(), (*g).into(), (*b).into(), opaque]);
        }),
        _ => samples.as_chunks().0.iter().enumerate().for_each(|(i, [r, g, b, a])| {
            each(i, [(*r).into(), (*g).into(), (*b).into(), (*a).into()]);
        }),
    }
}

/// A picture file whose header was read: what it says of itself, before a texel is allocated.
pub struct PictureFile<'a> {
    path: &'a str,
    place: Place,
    bytes: Vec<u8>,
    format: ImageFormat,
    /// Texels across and down.
    pub size: [u32; 2],
    /// What a code of its samples is.
    pub depth: Depth,
}

/// Reads a picture file of the project, and its header.
///
/// # Errors
/// The file can't be read, is no picture, or claims to be too large.
pub fn open<'a>(project: &Project, path: &'a str, place: Place) -> Result<PictureFile<'a>, Vec<Diagnostic>> {
    let bytes = project.read(path).map_err(|error| vec![unread(place, path, error.problem)])?;
    let refuse = |reason: &str| vec![resources::not_a_picture(place, path, reason)];
    let format =
        format(&bytes, path).ok_or_else(|| refuse("it is no PNG, JPEG, TGA, OpenEXR or HDR file"))?;
    if format == ImageFormat::Jpeg && !is_whole_jpeg(&bytes) {
        return Err(refuse("the file ends too early"));
    }
    let mut file = PictureFile { path, place, bytes, format, size: [0, 0], depth: Depth::Eight };
    let decoder = file.decoder()?;
    let (width, height) = decoder.dimensions();
    if width > MAX_SIDE || height > MAX_SIDE || decoder.total_bytes() > MAX_BYTES {
        return Err(vec![resources::picture_too_large(place, path, [width, height], MAX_SIDE)]);
    }
    if width == 0 || height == 0 {
        return Err(refuse("it has no texels"));
    }
    let (_, depth) = layout(decoder.color_type()).ok_or_else(|| refuse(UNKNOWN))?;
    drop(decoder);
    file.size = [width, height];
    file.depth = depth;
    Ok(file)
}

impl PictureFile<'_> {
    fn refuse(&self, reason: &str) -> Vec<Diagnostic> {
        vec![resources::not_a_picture(self.place, self.path, reason)]
    }

    fn decoder(&self) -> Result<impl ImageDecoder + '_, Vec<Diagnostic>> {
        let mut reader = ImageReader::with_format(Cursor::new(self.bytes.as_slice()), self.format);
        reader.limits(limits(None));
        reader.into_decoder().map_err(|error| self.refuse(&error.to_string()))
    }

    /// The texels.
    ///
    /// # Errors
    /// The file is no whole picture.
    pub fn decode(&self) -> Result<Decoded, Vec<Diagnostic>> {
        let mut decoder = self.decoder()?;
        let refused = |error: image::ImageError| self.refuse(&error.to_string());
        decoder.set_limits(limits(Some(MAX_SIDE))).map_err(refused)?;
        let (channels, depth) = layout(decoder.color_type()).ok_or_else(|| self.refuse(UNKNOWN))?;
        let mut buffer = vec![0; decoder.total_bytes() as usize];
        decoder.read_image(&mut buffer).map_err(refused)?;
        Ok(Decoded { size: self.size, channels, depth, samples: samples(buffer, channels, depth) })
    }
}

/// A file's problem in the compiler's words.
pub fn unread(place: Place, path: &str, problem: Problem) -> Diagnostic {
    match problem {
        Problem::Missing { near } => resources::missing_file(place, path, near.as_deref()),
        Problem::Outside { link } => resources::outside(place, path, link),
        Problem::Folder => resources::unreadable_file(place, path, "it is a folder"),
        Problem::Unreadable { reason } => resources::unreadable_file(place, path, &reason),
        Problem::TooLarge { limit } => resources::file_too_large(place, path, limit),
    }
}

/// By the first bytes; a TGA has no mark, so by its name.
fn format(bytes: &[u8], path: &str) -> Option<ImageFormat> {
    let known = [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::OpenExr, ImageFormat::Hdr];
    let by_content = image::guess_format(bytes).ok().filter(|format| known.contains(format));
    let by_name = || ImageFormat::from_path(path).ok().filter(|format| *format == ImageFormat::Tga);
    by_content.or_else(by_name)
}

/// Whether an end mark follows the last scan: the decoder fills what is missing with grey.
fn is_whole_jpeg(bytes: &[u8]) -> bool {
    let scan = bytes.windows(2).rposition(|pair| pair == [0xff, 0xda]).unwrap_or(0);
    bytes[scan..].windows(2).any(|pair| pair == [0xff, 0xd9])
}

fn limits(side: Option<u32>) -> Limits {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_BYTES);
    limits.max_image_width = side;
    limits.max_image_height = side;
    limits
}

/// Channels, and what a sample is.
fn layout(color: ColorType) -> Option<(usize, Depth)> {
    match color {
        ColorType::L8 => Some((1, Depth::Eight)),
        ColorType::La8 => Some((2, Depth::Eight)),
        ColorType::Rgb8 => Some((3, Depth::Eight)),
        ColorType::Rgba8 => Some((4, Depth::Eight)),
        ColorType::L16 => Some((1, Depth::Sixteen)),
        ColorType::La16 => Some((2, Depth::Sixteen)),
        ColorType::Rgb16 => Some((3, Depth::Sixteen)),
        ColorType::Rgba16 => Some((4, Depth::Sixteen)),
        ColorType::Rgb32F => Some((3, Depth::Half)),
        ColorType::Rgba32F => Some((4, Depth::Half)),
        _ => None,
    }
}

fn samples(buffer: Vec<u8>, channels: usize, depth: Depth) -> Samples {
    match depth {
        Depth::Eight => Samples::Eight(buffer),
        Depth::Sixteen => {
            Samples::Sixteen(buffer.as_chunks().0.iter().map(|pair| u16::from_ne_bytes(*pair)).collect())
        }
        Depth::Half => {
            let numbers = buffer.as_chunks().0.iter().map(|bytes| f32::from_ne_bytes(*bytes));
            let mut halves: Vec<f16> = numbers.map(f16::from_f32).collect();
            // OpenEXR's colours are multiplied by alpha, all others are not.
            for texel in halves.chunks_exact_mut(4).filter(|_| channels == 4) {
                let alpha = float(texel[3]);
                if alpha > 0.0 {
                    texel[..3].iter_mut().for_each(|color| *color = f16::from_f32(color.to_f32() / alpha));
                }
            }
            Samples::Sixteen(halves.into_iter().map(f16::to_bits).collect())
        }
    }
}
