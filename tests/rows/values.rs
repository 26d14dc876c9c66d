//! The numbers that rows are tried with.

/// As written in a `.tex` file: nothing, one, halves, tiny ones, ones at the edges of what a float
/// is, and some of each sign. The fourth from the end is below what graphics hardware need tell
/// from 0.
pub const FLOATS: [&str; 16] = [
    "0.0",
    "-0.0",
    "1.0",
    "-1.0",
    "0.5",
    "-2.75",
    "3.0",
    "100.0",
    "-0.3",
    "1e-30",
    "1e38",
    "-1e38",
    "1e-40",
    "1.2e-38",
    "3.4028234663852886e38",
    "-3.4028234663852886e38",
];

/// The same for ints.
pub const INTS: [&str; 16] = [
    "0",
    "1",
    "-1",
    "2",
    "3",
    "-5",
    "8",
    "31",
    "32",
    "1000",
    "65536",
    "-65537",
    "1073741824",
    "2147483647",
    "-2147483647",
    "-2147483648",
];

/// How many there are of each.
pub const COUNT: usize = 16;

/// A float of the list.
pub fn float(i: usize) -> f32 {
    FLOATS[i % COUNT].parse().unwrap_or(0.0)
}

/// An int of the list.
pub fn int(i: usize) -> i32 {
    INTS[i % COUNT].parse().unwrap_or(0)
}

/// A bool for a place in the lists.
pub fn bool(i: usize) -> bool {
    i % 2 == 1
}

/// Component `component` of the argument that begins at a place of the list: the components of a
/// vector differ.
pub fn place(at: usize, component: u8) -> usize {
    (at + 5 * usize::from(component)) % COUNT
}
