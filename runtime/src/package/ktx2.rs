//! Tables as KTX2 files: a container that viewers and engines read (Khronos, KTX File Format 2.0).
//!
//! ```text
//!  head   identifier, format, size │ where each level stands │ format descriptor │ keys and values
//!  data   the smallest level │ … │ the largest
//! ```
//!
//! Levels follow one another from the smallest to the largest, each on a multiple of its texels (or
//! blocks); layers, rows and texels in a level are as in a table. Beside what KTX2 asks for, a file says
//! under which key its table was made (`texgraph.key`) and what all of it hashes to (`texgraph.sum`, over
//! the file with 32 zeros in this place).
//!
//! Reading is writing once more: a file is ours, and whole, if a head that is written of what its own
//! head says is the same, byte for byte, and the file has that hash. Nothing else is believed, so
//! there is no bad file that could do harm.

use super::format::Row;
use super::key;
use crate::resource::table::{MAX_BYTES, MAX_SIDE};
use texgraph_compiler::manifest::{Table, ViewDimension};

/// The first bytes of every KTX2 file.
const IDENTIFIER: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";

/// More bytes than any head has.
pub const MAX_HEAD: u64 = 1024;

/// More bytes than any file has.
pub const MAX_FILE: u64 = MAX_BYTES + 2 * MAX_HEAD;

/// What stands before the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// The shape that a shader sees.
    pub view: ViewDimension,
    /// Size, format, levels (their offsets are in the file) and key.
    pub table: Table,
    /// What the file hashes to.
    pub sum: String,
    /// Bytes of the head, up to the first level.
    start: u64,
    /// Bytes of the file.
    pub length: u64,
}

/// A file of a table's bytes, and the table with the offsets that its levels have in the file; none
/// where the bytes do not fit the table.
pub fn write(view: ViewDimension, table: &Table, bytes: &[u8]) -> Option<(Table, Vec<u8>)> {
    let mut head = Head::new(view, table.clone())?;
    let mut file = vec![0; usize::try_from(head.length).ok()?];
    for (from, to) in table.levels.iter().zip(&head.table.levels) {
        let length = from.bytes(table.format);
        slice_mut(&mut file, to.offset, length)?.copy_from_slice(slice(bytes, from.offset, length)?);
    }
    let start = head.bytes()?;
    head.sum = key::sum(&start, file.get(start.len()..)?);
    let start = head.bytes()?;
    file.get_mut(..start.len())?.copy_from_slice(&start);
    Some((head.table, file))
}

/// The table of a file that [`write`] has written and nothing has changed, and its bytes as the table
/// lays them out.
pub fn read(file: &[u8]) -> Option<(Table, Vec<u8>)> {
    let head = Head::read(file)?;
    let start = Head { sum: NO_SUM.to_owned(), ..head.clone() }.bytes()?;
    if file.len() as u64 != head.length || key::sum(&start, file.get(start.len()..)?) != head.sum {
        return None;
    }
    let plain = laid_out(head.view, &head.table)?;
    let mut bytes = vec![0; usize::try_from(plain.bytes()).ok()?];
    for (from, to) in head.table.levels.iter().zip(&plain.levels) {
        let length = to.bytes(plain.format);
        slice_mut(&mut bytes, to.offset, length)?.copy_from_slice(slice(file, from.offset, length)?);
    }
    Some((plain, bytes))
}

impl Head {
    /// The head of a table's file, zeros for the hash.
    fn new(view: ViewDimension, mut table: Table) -> Option<Head> {
        let row = Row::of(table.format)?;
        let values = values(view, table.key.as_deref()?, NO_SUM).len();
        let head = 80 + 24 * table.levels.len() + row.descriptor().len() + values;
        // Texels and blocks of ours have 4, 8 or 16 bytes, which KTX2 aligns levels to.
        let align = u64::from(table.format.bytes().max(4));
        let start = (head as u64).next_multiple_of(align);
        let mut offset = start;
        for level in table.levels.iter_mut().rev() {
            level.offset = offset;
            offset = (offset + level.bytes(row.format)).next_multiple_of(align);
        }
        let length = table.levels.first().map(|level| level.offset + level.bytes(row.format))?;
        Some(Head { view, table, sum: NO_SUM.to_owned(), start, length })
    }

    /// Reads a head of ours.
    pub fn read(file: &[u8]) -> Option<Head> {
        let word = |at: usize| Some(u32::from_le_bytes(file.get(at..at + 4)?.try_into().ok()?));
        let (vulkan, width, height, depth) = (word(12)?, word(20)?, word(24)?, word(28)?);
        let (layers, levels) = (word(32)?, word(40)?);
        let (view, layers) = match (depth, layers) {
            (0, 0) => (ViewDimension::D2, 1),
            (0, layers) => (ViewDimension::D2Array, layers),
            (depth, _) => (ViewDimension::D3, depth),
        };
        let fits = |count: &u32| (1..=MAX_SIDE).contains(count);
        let most = width.max(height).max(1).ilog2() + 1;
        if ![width, height, layers].iter().all(fits) || !(1..=most).contains(&levels) {
            return None;
        }
        let row = Row::of_vulkan(vulkan)?;
        let table = Table::with_levels(row.format, [width, height], layers, levels);
        let mut table = laid_out(view, &table).filter(|table| table.bytes() <= MAX_BYTES)?;
        let values_at = 80 + 24 * table.levels.len() + row.descriptor().len();
        table.key = Some(value(file.get(values_at..)?, KEY)?);
        let head = Head { sum: value(file.get(values_at..)?, SUM)?, ..Head::new(view, table)? };
        let bytes = head.bytes()?;
        (file.get(..bytes.len())? == bytes).then_some(head)
    }

    /// The head as it stands in the file.
    fn bytes(&self) -> Option<Vec<u8>> {
        let Head { view, table, sum, start, .. } = self;
        let row = Row::of(table.format)?;
        let descriptor = row.descriptor();
        let values = values(*view, table.key.as_deref()?, sum);
        let (depth, layers) = match view {
            ViewDimension::D2 => (0, 0),
            ViewDimension::D2Array => (0, table.layers),
            ViewDimension::D3 => (table.layers, 0),
        };
        let levels = table.levels.len() as u32;
        let described_at = 80 + 24 * levels;
        let values_at = described_at + descriptor.len() as u32;
        let (one_face, not_packed) = (1, 0);
        let words = [
            row.vulkan,
            row.type_size,
            table.width,
            table.height,
            depth,
            layers,
            one_face,
            levels,
            not_packed,
        ];
        let places = [described_at, descriptor.len() as u32, values_at, values.len() as u32];
        // Of what a packing would share there is nothing, nowhere.
        let nothing = [0; 4];
        let mut bytes = IDENTIFIER.to_vec();
        bytes.extend(words.iter().chain(&places).chain(&nothing).flat_map(|word| word.to_le_bytes()));
        for level in &table.levels {
            let length = level.bytes(table.format);
            bytes.extend([level.offset, length, length].into_iter().flat_map(u64::to_le_bytes));
        }
        bytes.extend(descriptor);
        bytes.extend(values);
        bytes.resize(usize::try_from(*start).ok()?, 0);
        Some(bytes)
    }
}

/// A table with its levels one after another from the largest; in space each is half as deep as the one
/// before. None where that is not what its levels are.
fn laid_out(view: ViewDimension, table: &Table) -> Option<Table> {
    let mut offset = 0;
    let mut table = table.clone();
    for (number, level) in (0..).zip(&mut table.levels) {
        if view == ViewDimension::D3 {
            level.layers = table.layers.checked_shr(number)?.max(1);
        }
        level.offset = offset;
        offset += level.bytes(table.format);
    }
    Some(table)
}

const KEY: &str = "texgraph.key";
const SUM: &str = "texgraph.sum";

/// What stands for a hash while it is made.
const NO_SUM: &str = "00000000000000000000000000000000";
const _: () = assert!(NO_SUM.len() == key::LENGTH, "it is as long as a hash");

/// Keys and values, in the keys' order.
fn values(view: ViewDimension, key: &str, sum: &str) -> Vec<u8> {
    // Rows run to the right and downwards, slices inwards.
    let orientation = if view == ViewDimension::D3 { "rdi" } else { "rd" };
    let writer = concat!("texgraph ", env!("CARGO_PKG_VERSION"));
    let pairs = [("KTXorientation", orientation), ("KTXwriter", writer), (KEY, key), (SUM, sum)];
    let mut bytes = Vec::new();
    for (key, value) in pairs {
        let pair = format!("{key}\0{value}\0");
        bytes.extend((pair.len() as u32).to_le_bytes());
        bytes.extend(pair.bytes());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

/// The value of a key, where keys and values begin.
fn value(mut bytes: &[u8], wanted: &str) -> Option<String> {
    loop {
        let (length, rest) = bytes.split_first_chunk()?;
        let length = u32::from_le_bytes(*length) as usize;
        let pair = std::str::from_utf8(rest.get(..length)?).ok()?;
        match pair.strip_suffix('\0')?.split_once('\0')? {
            (key, value) if key == wanted => return Some(value.to_owned()),
            _ => bytes = rest.get(length.next_multiple_of(4)..)?,
        }
    }
}

fn slice(bytes: &[u8], offset: u64, length: u64) -> Option<&[u8]> {
    let start = usize::try_from(offset).ok()?;
    bytes.get(start..start.checked_add(usize::try_from(length).ok()?)?)
}

fn slice_mut(bytes: &mut [u8], offset: u64, length: u64) -> Option<&mut [u8]> {
    let start = usize::try_from(offset).ok()?;
    bytes.get_mut(start..start.checked_add(usize::try_from(length).ok()?)?)
}

#[cfg(test)]
mod tests {
    use super::{Head, laid_out, read, write};
    use crate::package::format::ROWS;
    use texgraph_compiler::manifest::ViewDimension::{self, D2, D2Array, D3};
    use texgraph_compiler::manifest::{Format, Table};

    const KEY: &str = "0123456789abcdef0123456789abcdef";

    /// A table and bytes that are all different for a while.
    fn sample(
        view: ViewDimension,
        format: Format,
        size: [u32; 2],
        layers: u32,
        levels: u32,
    ) -> (Table, Vec<u8>) {
        let table = Table { key: Some(KEY.into()), ..Table::with_levels(format, size, layers, levels) };
        let table = laid_out(view, &table).expect("it has few levels");
        let bytes = (0..table.bytes()).map(|at| (at ^ (at >> 8) ^ (at * 7)) as u8).collect();
        (table, bytes)
    }

    /// Every format in every shape.
    fn all() -> impl Iterator<Item = (ViewDimension, Table, Vec<u8>)> {
        let shapes = [(D2, 1, 5), (D2, 1, 1), (D2Array, 1, 5), (D2Array, 3, 4), (D3, 5, 5), (D3, 1, 1)];
        ROWS.iter().flat_map(move |row| {
            shapes.into_iter().map(move |(view, layers, levels)| {
                let (table, bytes) = sample(view, row.format, [20, 12], layers, levels);
                (view, table, bytes)
            })
        })
    }

    #[test]
    fn every_format_has_a_row() {
        let names = [
            "rgba8unorm-srgb",
            "rgba8unorm",
            "rgba8snorm",
            "rgba16float",
            "r32sint",
            "rgba32sint",
            "bc1-rgba-unorm",
            "bc7-rgba-unorm",
        ];
        let known: Vec<String> = ROWS.iter().map(|row| String::from(row.format)).collect();
        assert_eq!(known, names);
    }

    #[test]
    fn what_is_written_is_read_again() {
        for (view, table, bytes) in all() {
            let (placed, file) = write(view, &table, &bytes).expect("it fits");
            assert_eq!(read(&file), Some((table.clone(), bytes.clone())), "{view:?} {table:?}");
            assert_eq!(Head::read(&file).map(|head| (head.view, head.table)), Some((view, placed.clone())));
            // A host that takes the manifest's word needs no reader.
            for (from, to) in table.levels.iter().zip(&placed.levels) {
                let (from, to, length) =
                    (from.offset as usize, to.offset as usize, from.bytes(table.format) as usize);
                assert_eq!(bytes[from..from + length], file[to..to + length]);
            }
        }
    }

    #[test]
    fn another_reader_finds_the_same() {
        for (view, table, bytes) in all() {
            let (_, file) = write(view, &table, &bytes).expect("it fits");
            let reader = ktx2::Reader::new(&file[..]).expect("it is KTX2");
            let header = reader.header();
            let depth = if view == D3 { table.layers } else { 0 };
            let layers = if view == D2Array { table.layers } else { 0 };
            assert_eq!(
                [header.pixel_width, header.pixel_height, header.pixel_depth],
                [table.width, table.height, depth]
            );
            assert_eq!(
                (header.layer_count, header.face_count, header.supercompression_scheme),
                (layers, 1, None)
            );
            assert_eq!(
                header.format.map(|format| format!("{format:?}")).as_deref(),
                Some(vulkan(table.format))
            );
            assert_eq!(reader.levels().len(), table.levels.len());
            let align = u64::from(table.format.bytes());
            for (level, read) in table.levels.iter().zip(reader.levels()) {
                let start = level.offset as usize;
                assert_eq!(read.data, &bytes[start..start + level.bytes(table.format) as usize]);
                let at = read.data.as_ptr() as usize - file.as_ptr() as usize;
                assert_eq!(at as u64 % align, 0, "{table:?}");
            }
            let values: Vec<(&str, &[u8])> = reader.key_value_data().collect();
            assert!(values.is_sorted(), "{values:?}");
            assert!(values.contains(&("texgraph.key", format!("{KEY}\0").as_bytes())), "{values:?}");
            assert!(reader.writer().is_some_and(|writer| writer.starts_with("texgraph ")));
            let is_srgb = table.format == Format::Rgba8UnormSrgb;
            let transfer =
                if is_srgb { ktx2::TransferFunction::SRGB } else { ktx2::TransferFunction::Linear };
            assert_eq!(
                (reader.transfer_function(), reader.is_alpha_premultiplied()),
                (Some(transfer), Some(is_srgb))
            );
            let basic = reader.basic_dfd().expect("a descriptor");
            let channels: u32 =
                basic.sample_information.iter().map(|sample| u32::from(sample.bit_length.get())).sum();
            assert_eq!(channels, 8 * table.format.bytes(), "the channels fill a texel");
        }
    }

    fn vulkan(format: Format) -> &'static str {
        match format {
            Format::Rgba8UnormSrgb => "R8G8B8A8_SRGB",
            Format::Rgba8Unorm => "R8G8B8A8_UNORM",
            Format::Rgba8Snorm => "R8G8B8A8_SNORM",
            Format::Rgba16Float => "R16G16B16A16_SFLOAT",
            Format::R32Sint => "R32_SINT",
            Format::Rgba32Sint => "R32G32B32A32_SINT",
            Format::Bc1RgbaUnorm => "BC1_RGBA_UNORM_BLOCK",
            Format::Bc7RgbaUnorm => "BC7_UNORM_BLOCK",
        }
    }

    #[test]
    fn a_file_with_one_other_byte_or_less_of_them_is_none_of_ours() {
        let (table, bytes) = sample(D2Array, Format::Rgba16Float, [5, 3], 2, 3);
        let (_, file) = write(D2Array, &table, &bytes).expect("it fits");
        for at in 0..file.len() {
            for flip in [1, 0x80, 0xff] {
                let mut other = file.clone();
                other[at] ^= flip;
                assert_eq!(read(&other), None, "byte {at}");
            }
            assert_eq!(read(&file[..at]), None, "the first {at} bytes");
        }
        let longer = [&file[..], &[0]].concat();
        assert_eq!(read(&longer), None);
    }

    #[test]
    fn heads_of_any_numbers_do_no_harm() {
        let (table, bytes) = sample(D2, Format::Rgba8Unorm, [4, 4], 1, 1);
        let (_, file) = write(D2, &table, &bytes).expect("it fits");
        // From the format's number to the end of the sections' places.
        for at in (12..80).step_by(4) {
            for word in [0, 1, 2, 31, 32, 33, 0x7fff_ffff, 0x8000_0000, u32::MAX - 3, u32::MAX] {
                let mut other = file.clone();
                other[at..at + 4].copy_from_slice(&u32::to_le_bytes(word));
                assert!(read(&other).is_none() || other == file, "{word} at {at}");
            }
        }
        for length in [0_u32, 1, 3, 4, 1000, u32::MAX] {
            let mut other = file.clone();
            let values = 80 + 24 + 4 + 24 + 64;
            other[values..values + 4].copy_from_slice(&length.to_le_bytes());
            assert_eq!(read(&other), None);
        }
    }

    #[test]
    fn bytes_that_do_not_fit_are_not_written() {
        let (table, bytes) = sample(D2, Format::Rgba8Unorm, [4, 4], 1, 3);
        assert!(write(D2, &table, &bytes[1..]).is_none());
        assert!(write(D2, &Table { key: None, ..table }, &bytes).is_none());
    }
}
