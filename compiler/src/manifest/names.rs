//! Values that are written by the names WebGPU has for them.

/// The name of a value in a table of names.
pub(super) fn name_of<T: PartialEq>(names: &[(T, &str)], value: T) -> String {
    names.iter().find(|(known, _)| *known == value).map_or(String::new(), |(_, name)| (*name).to_owned())
}

/// The value of a name in a table of names.
pub(super) fn named<T: Copy>(names: &[(T, &str)], name: &str) -> Result<T, String> {
    let found = names.iter().find(|(_, known)| *known == name).map(|(value, _)| *value);
    found.ok_or_else(|| format!("`{name}` is not known here"))
}
