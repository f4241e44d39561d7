//! Former and current keys of fields that have been renamed.

/// A field of a top-level struct of the scene, with its old and its new key.
struct Renamed {
    parent: &'static str,
    old: &'static str,
    new: &'static str,
}

/// The fields that have been renamed.
const RENAMED: [Renamed; 2] = [
    Renamed { parent: "contact", old: "joints", new: "material_pairs" },
    Renamed { parent: "contact", old: "laws", new: "rock_joints" },
];

/// The key by which a field of `parent` goes now.
pub(super) fn current<'a>(parent: &str, key: &'a str) -> &'a str {
    RENAMED.iter().find(|r| r.parent == parent && r.old == key).map_or(key, |r| r.new)
}
