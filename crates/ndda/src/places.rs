//! Where results go that no folder is named for.

use std::path::{Path, PathBuf};

use ndda_io::{OutputFolder, read};

/// File of a factor of safety, of the state of rest that its trials begin from, folder beside it of the run that shows how blocks fail, and file of a rockfall.
pub(crate) const SAFETY: &str = "safety.json";
pub(crate) const REST: &str = "rest.ndda";
pub(crate) const MECHANISM: &str = "mechanism";
pub(crate) const ROCKFALL: &str = "rockfall.json";

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

/// What a folder without a run holds instead, and what shows it or goes on with it.
pub fn instead(folder: &Path) -> Option<String> {
    if [OutputFolder::SUMMARY, OutputFolder::HISTORY, OutputFolder::CHECKPOINT, OutputFolder::LOG]
        .iter()
        .any(|file| folder.join(file).is_file())
    {
        return None;
    }
    let mechanism = folder.join(MECHANISM);
    if folder.join(ROCKFALL).is_file() {
        let map = folder.join("map.png");
        return Some(format!(
            "it holds a rockfall: look at {}, profile.png and rockfall.json; `ndda rockfall SCENE --force` computes it anew",
            map.display()
        ));
    }
    let shows = match mechanism.join(OutputFolder::SUMMARY).is_file() {
        true => format!("`ndda view {}` shows how blocks fail, and ", mechanism.display()),
        false => String::new(),
    };
    let is_safety = folder.join(SAFETY).is_file();
    is_safety
        .then(|| format!("it holds a factor of safety: {shows}`ndda safety SCENE` goes on with its trials"))
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

    #[test]
    fn what_a_folder_holds_instead_of_a_run_is_said_with_what_shows_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        assert_eq!(instead(path), None);
        std::fs::write(path.join(SAFETY), "{}").unwrap();
        assert!(
            instead(path)
                .unwrap()
                .ends_with("it holds a factor of safety: `ndda safety SCENE` goes on with its trials")
        );
        std::fs::create_dir(path.join(MECHANISM)).unwrap();
        std::fs::write(path.join(MECHANISM).join(OutputFolder::SUMMARY), "{}").unwrap();
        let shows = format!("`ndda view {}`", path.join(MECHANISM).display());
        assert!(instead(path).unwrap().contains(&shows));
        std::fs::write(path.join(ROCKFALL), "{}").unwrap();
        assert!(instead(path).unwrap().contains("map.png"));
        std::fs::write(path.join(OutputFolder::SUMMARY), "{}").unwrap();
        assert_eq!(instead(path), None, "there is a run");
    }
}
