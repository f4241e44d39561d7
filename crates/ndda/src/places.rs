//! Where results go that no folder is named for.

use std::path::{Path, PathBuf};

use ndda_io::read;

/// Name of what is in a file: the file's name without its ending; `scene` for standard input.
pub fn name_of(file: &Path) -> String {
    if read::is_standard_input(file) {
        return "scene".into();
    }
    file.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned())
}

/// The folder that was asked for, or `out/` with the name of what is in a file and a suffix such as `_safety`.
pub fn folder_for(asked: Option<&Path>, file: &Path, suffix: &str) -> PathBuf {
    asked.map_or_else(|| Path::new("out").join(name_of(file) + suffix), Path::to_path_buf)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_named_after_the_scene() {
        let file = Path::new("scenes/wedge.ron");
        assert_eq!(folder_for(None, file, "_safety"), Path::new("out/wedge_safety"));
        assert_eq!(folder_for(Some(Path::new("here")), file, "_safety"), Path::new("here"));
        assert_eq!(name_of(Path::new("/")), "scene");
        assert_eq!(name_of(Path::new("-")), "scene");
    }
}
