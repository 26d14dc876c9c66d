//! Picture files: PNG, JPEG and TGA to rows of 8- or 16-bit samples.
//!
//! A header may lie, so the size is checked before a texel is allocated, and everything a decoder
//! says against a file becomes an error with the file's name. Pictures are taken as stored:
//! colour profiles, gamma chunks and a camera's orientation are not looked at.

use crate::project::{Problem, Project};
use image::{ColorType, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use texgraph_compiler::diagnostic::{Diagnostic, Place, resources};

/// The longest side that is decoded, in texels. A texture may be smaller still.
pub const MAX_SIDE: u32 = 16_384;

/// The most bytes that a decoder may use.
const MAX_BYTES: u64 = 1 << 30;

/// A decoded picture, its samples as stored.
pub struct Decoded {
    /// Texels across and down.
    pub size: [u32; 2],
    channels: usize,
    samples: Samples,
}

enum Samples {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
}

impl Decoded {
    /// A picture of three 8-bit samples a texel, row by row; none if there are more or fewer than that.
    pub fn rgb(size: [u32; 2], samples: Vec<u8>) -> Option<Decoded> {
        let texels = size[0] as usize * size[1] as usize;
        (samples.len() == 3 * texels).then_some(Decoded {
            size,
            channels: 3,
            samples: Samples::Eight(samples),
        })
    }

    /// Whether a sample has 16 bits rather than 8.
    pub fn is_deep(&self) -> bool {
        matches!(self.samples, Samples::Sixteen(_))
    }

    /// The greatest sample: 255 or 65535.
    pub fn white(&self) -> u16 {
        if self.is_deep() { u16::MAX } else { u16::from(u8::MAX) }
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
            let white = self.white();
            let texels = self.size[0] as usize * self.size[1] as usize;
            self.read(0, texels, |_, texel| is_opaque &= texel[3] == white);
        }
        is_opaque
    }

    /// Gives so many texels to a function with their number from 0 on, row by row from the `first` on:
    /// as [`Decoded::texel`] gives them, faster.
    pub fn read(&self, first: usize, count: usize, mut each: impl FnMut(usize, [u16; 4])) {
        let (white, channels) = (self.white(), self.channels);
        let range = first * channels..(first + count) * channels;
        match &self.samples {
            Samples::Eight(samples) => read_texels(&samples[range], channels, white, &mut each),
            Samples::Sixteen(samples) => read_texels(&samples[range], channels, white, &mut each),
        }
    }

    /// Red, green, blue and alpha as stored. Grey gives (v, v, v); without alpha it is white.
    pub fn texel(&self, x: u32, y: u32) -> [u16; 4] {
        let at = (y as usize * self.size[0] as usize + x as usize) * self.channels;
        let s = |channel: usize| match &self.samples {
            Samples::Eight(samples) => samples.get(at + channel).copied().map_or(0, u16::from),
            Samples::Sixteen(samples) => samples.get(at + channel).copied().unwrap_or(0),
        };
        match self.channels {
            1 => [s(0), s(0), s(0), self.white()],
            2 => [s(0), s(0), s(0), s(1)],
            3 => [s(0), s(1), s(2), self.white()],
            _ => [s(0), s(1), s(2), s(3)],
        }
    }
}

fn read_texels<T: Copy + Into<u16>>(
    samples: &[T],
    channels: usize,
    white: u16,
    each: &mut impl FnMut(usize, [u16; 4]),
) {
    match channels {
        1 => samples
            .iter()
            .enumerate()
            .for_each(|(i, s)| each(i, [(*s).into(), (*s).into(), (*s).into(), white])),
        2 => samples.as_chunks().0.iter().enumerate().for_each(|(i, [s, a])| {
            each(i, [(*s).into(), (*s).into(), (*s).into(), (*a).into()]);
        }),
        3 => samples.as_chunks().0.iter().enumerate().for_each(|(i, [r, g, b])| {
            each(i, [(*r).into(), (*g).into(), (*b).into(), white]);
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
    /// Whether a sample has 16 bits rather than 8.
    pub is_deep: bool,
}

/// Reads a picture file of the project, and its header.
///
/// # Errors
/// The file can't be read, is no picture, or claims to be too large.
pub fn open<'a>(project: &Project, path: &'a str, place: Place) -> Result<PictureFile<'a>, Vec<Diagnostic>> {
    let bytes = project.read(path).map_err(|error| vec![unread(place, path, error.problem)])?;
    let refuse = |reason: &str| vec![resources::not_a_picture(place, path, reason)];
    let format = format(&bytes, path).ok_or_else(|| refuse("it is no PNG, JPEG or TGA file"))?;
    if format == ImageFormat::Jpeg && !is_whole_jpeg(&bytes) {
        return Err(refuse("the file ends too early"));
    }
    let mut file = PictureFile { path, place, bytes, format, size: [0, 0], is_deep: false };
    let decoder = file.decoder()?;
    let (width, height) = decoder.dimensions();
    if width > MAX_SIDE || height > MAX_SIDE || decoder.total_bytes() > MAX_BYTES {
        return Err(vec![resources::picture_too_large(place, path, [width, height], MAX_SIDE)]);
    }
    if width == 0 || height == 0 {
        return Err(refuse("it has no texels"));
    }
    let (_, is_deep) =
        layout(decoder.color_type()).ok_or_else(|| refuse("its samples have neither 8 nor 16 bits"))?;
    drop(decoder);
    file.size = [width, height];
    file.is_deep = is_deep;
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
        let (channels, deep) = layout(decoder.color_type())
            .ok_or_else(|| self.refuse("its samples have neither 8 nor 16 bits"))?;
        let mut buffer = vec![0; decoder.total_bytes() as usize];
        decoder.read_image(&mut buffer).map_err(refused)?;
        Ok(Decoded { size: self.size, channels, samples: samples(buffer, deep) })
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
    let known = [ImageFormat::Png, ImageFormat::Jpeg];
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

/// Channels, and whether a sample has 16 bits.
fn layout(color: ColorType) -> Option<(usize, bool)> {
    match color {
        ColorType::L8 => Some((1, false)),
        ColorType::La8 => Some((2, false)),
        ColorType::Rgb8 => Some((3, false)),
        ColorType::Rgba8 => Some((4, false)),
        ColorType::L16 => Some((1, true)),
        ColorType::La16 => Some((2, true)),
        ColorType::Rgb16 => Some((3, true)),
        ColorType::Rgba16 => Some((4, true)),
        _ => None,
    }
}

fn samples(buffer: Vec<u8>, deep: bool) -> Samples {
    if !deep {
        return Samples::Eight(buffer);
    }
    let pairs = buffer.chunks_exact(2);
    Samples::Sixteen(pairs.map(|pair| u16::from_ne_bytes([pair[0], pair[1]])).collect())
}
