//! `include: "rock.ron"`: materials from another file.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::scene::code::Code;
use crate::scene::diagnostic::{Diagnostic, SceneErrors, line_column};
use crate::scene::locate::Node;
use crate::scene::parameters::Parameters;
use crate::scene::parse;
use crate::scene::units::INCLUDE as FIELD;
use crate::scene::{Material, Scene};

/// A file of materials; it may also be a bare list of them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialFile {
    /// More files, whose paths count from this one.
    #[serde(default)]
    include: Vec<String>,
    #[serde(default)]
    materials: Vec<Material>,
}

/// A file that has been read, and which materials of the scene are from it.
pub(crate) struct Included {
    file: String,
    text: String,
    /// Number of its first material in the scene, and how many they are.
    first: usize,
    count: usize,
}

/// Adds the materials of all files that a scene names to its own, and the files that these name to `scene.include`.
///
/// # Errors
/// A file is missing, includes itself or has errors.
pub(crate) fn read(
    scene: &mut Scene,
    folder: &Path,
    (file, text): (&str, &str),
    parameters: &Parameters,
) -> Result<Vec<Included>, SceneErrors> {
    let mut reader = Reader { scene, folder, parameters, done: Vec::new(), read: Vec::new() };
    let names = std::mem::take(&mut reader.scene.include);
    for (i, name) in names.iter().enumerate() {
        let place = Place { file, text, path: format!("{FIELD}[{i}]") };
        reader.add(Path::new(name), &place, &mut Vec::new())?;
    }
    Ok(reader.read)
}

/// Where a file is named.
struct Place<'a> {
    file: &'a str,
    text: &'a str,
    path: String,
}

impl Place<'_> {
    fn refuse(&self, code: Code, message: String, help: &str) -> SceneErrors {
        let span = parse::place(&Node::of(self.text), self.text, &self.path);
        let refused = Diagnostic::error(code, self.path.clone(), message, span).with_help(help);
        SceneErrors { file: self.file.into(), text: self.text.into(), diagnostics: vec![refused] }
    }
}

struct Reader<'a> {
    scene: &'a mut Scene,
    folder: &'a Path,
    parameters: &'a Parameters,
    /// Files that are read, each once.
    done: Vec<PathBuf>,
    read: Vec<Included>,
}

impl Reader<'_> {
    /// Reads the file `name`, a path from the folder of the scene; `above` are the files that include it.
    fn add(&mut self, name: &Path, place: &Place, above: &mut Vec<PathBuf>) -> Result<(), SceneErrors> {
        let path = self.folder.join(name);
        let Ok(known_as) = path.canonicalize() else {
            let help = "paths are relative to the folder of the file that names them";
            return Err(place.refuse(
                Code::MissingFile,
                format!("there is no file {}", path.display()),
                help,
            ));
        };
        if !known_as.is_file() {
            let message = format!("{} is a folder, a pipe or a device", path.display());
            return Err(place.refuse(Code::MissingFile, message, "name a file of materials"));
        }
        if above.contains(&known_as) {
            let message = format!("{} includes itself", path.display());
            return Err(place.refuse(Code::DoesNotFit, message, "leave this one out"));
        }
        if self.done.contains(&known_as) {
            return Ok(());
        }
        let text = parse::text_of(&path)?;
        let file = path.display().to_string();
        let fail = |diagnostics| SceneErrors { file: file.clone(), text: text.clone(), diagnostics };
        parse::refuse_blank(&text).map_err(|(_, refused)| fail(vec![refused]))?;
        let tree = Node::of(&text);
        let content = self.parse(&text, &tree).map_err(fail)?;
        let (first, count) = (self.scene.materials.len(), content.materials.len());
        self.scene.include.push(name.to_string_lossy().into_owned());
        self.scene.materials.extend(content.materials);
        self.done.push(known_as.clone());
        above.push(known_as);
        let beside = name.parent().unwrap_or(Path::new(""));
        for (i, inner) in content.include.iter().enumerate() {
            let place = Place { file: &file, text: &text, path: format!("{FIELD}[{i}]") };
            self.add(&beside.join(inner), &place, above)?;
        }
        above.pop();
        self.read.push(Included { file, text, first, count });
        Ok(())
    }

    fn parse(&self, text: &str, tree: &Node) -> Result<MaterialFile, Vec<Diagnostic>> {
        if tree.opening == Some('[') {
            let materials =
                parse::parse_with(text, tree, self.parameters).map_err(|mistakes| mistakes.found)?;
            return Ok(MaterialFile { include: Vec::new(), materials });
        }
        parse::parse_with(text, tree, self.parameters).map_err(|mistakes| mistakes.found)
    }
}

/// Puts what was found about included materials where they are: in their file, with its line and column. That a material
/// of it is not used is not said.
pub(crate) fn name_files(found: &mut Vec<Diagnostic>, included: &[Included]) {
    let own = included.iter().map(|file| file.first).min().unwrap_or(usize::MAX);
    let number = |d: &Diagnostic| d.path.strip_prefix("materials[")?.split_once(']')?.0.parse::<usize>().ok();
    let is_included = |d: &Diagnostic| number(d).is_some_and(|i| i >= own);
    found.retain(|d| d.code != Code::NoEffect || !is_included(d));
    for d in found.iter_mut() {
        let Some(i) = number(d) else { continue };
        let Some(file) = included.iter().find(|file| (file.first..file.first + file.count).contains(&i))
        else {
            continue;
        };
        let tree = Node::of(&file.text);
        let field = d.path.split_once(']').map_or("", |(_, field)| field);
        let list = if tree.opening == Some('[') { "" } else { "materials" };
        let path = format!("{list}[{}]{field}", i - file.first);
        let (line, column) =
            parse::place(&tree, &file.text, &path).map_or((1, 1), |span| line_column(&file.text, span.start));
        d.message = format!("{}:{line}:{column}: {path}: {}", file.file, d.message);
        d.path = FIELD.into();
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::read::load;

    const SCENE: &str =
        "(title: \"t\", time: (step_s: 1e-3, end_s: 1), parameters: (e_gpa: 20), include: \"rocks/all.ron\",
    blocks: [(name: \"a\", material: \"granite\", shape: Box(size_m: (1, 1, 1), cells: (1, 1, 1)))])";
    const ALL: &str = "(include: [\"granite.ron\"], materials: [
    (name: \"shale\", density_kg_m3: 2500, young_pa: 1e10, poisson: 0.25),
])";
    const GRANITE: &str = "// One rock.\n[(name: \"granite\", density_kg_m3: 2700, young_pa: Gigapascal(Calc(2 * e_gpa)), poisson: 0.25)]";

    fn folder(scene: &str, all: &str, granite: &str) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("rocks")).unwrap();
        for (name, text) in [("scene.ron", scene), ("rocks/all.ron", all), ("rocks/granite.ron", granite)] {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        folder
    }

    #[test]
    fn materials_come_from_files_and_from_files_that_these_name() {
        let folder = folder(SCENE, ALL, GRANITE);
        let loaded = load(&folder.path().join("scene.ron"), &[]).unwrap();
        let names: Vec<&str> = loaded.scene.materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["shale", "granite"]);
        assert_eq!(loaded.scene.materials[1].young_pa, 40e9);
        assert_eq!(loaded.scene.include, ["rocks/all.ron", "rocks/granite.ron"]);
        assert_eq!(loaded.warnings, []);
        let own = SCENE.replace(
            "include:",
            "materials: [(name: \"x\", density_kg_m3: 2, young_pa: 1e10, poisson: 0.2)], include:",
        );
        std::fs::write(folder.path().join("scene.ron"), own).unwrap();
        assert_eq!(load(&folder.path().join("scene.ron"), &[]).unwrap().scene.materials.len(), 3);
    }

    #[test]
    fn a_changed_file_is_found_by_its_checksum() {
        let folder = folder(SCENE, ALL, GRANITE);
        let loaded = load(&folder.path().join("scene.ron"), &[]).unwrap();
        let files = crate::scene::outside_files::OutsideFile::all_of(&loaded.scene, folder.path());
        assert_eq!(files.len(), 2);
        assert_eq!(crate::scene::outside_files::OutsideFile::verify_all(&files, folder.path()), Ok(()));
        std::fs::write(folder.path().join("rocks/granite.ron"), GRANITE.replace("2700", "2701")).unwrap();
        let said = crate::scene::outside_files::OutsideFile::verify_all(&files, folder.path())
            .unwrap_err()
            .to_string();
        assert!(said.contains("granite.ron") && said.contains("has changed"), "{said}");
    }

    #[test]
    fn mistakes_name_the_file_in_which_they_are() {
        for (old, new, place, words) in [
            ("rocks/all.ron", "rocks/al.ron", "scene.ron:1:", "there is no file"),
            ("granite.ron", "granit.ron", "all.ron:1:12", "there is no file"),
            ("poisson: 0.25)]", "poissen: 0.25)]", "granite.ron:2:", "there is no field `poissen`"),
            ("poisson: 0.25)]", "poisson: 0.75)]", "granite.ron:2:89: [0].poisson: 0.75", "must lie between"),
            ("e_gpa))", "e_pga))", "granite.ron:2:71", "in `2 * e_pga`: there is no parameter"),
            ("e_gpa: 20", "e_gpa: 20, unused: 1", "scene.ron:1:", "no number of the scene uses"),
            ("\"granite.ron\"]", "\"../rocks/all.ron\"]", "all.ron:1:12", "includes itself"),
            ("\"shale\"", "\"granite\"", "granite.ron:2:", "granite"),
            ("rocks/all.ron", "rocks", "scene.ron:1:", "is a folder"),
            ("// One rock.", "", "", ""),
        ] {
            let [scene, all, granite] = [SCENE, ALL, GRANITE].map(|text| text.replacen(old, new, 1));
            let folder = folder(&scene, &all, &granite);
            let said = match load(&folder.path().join("scene.ron"), &[]) {
                Ok(loaded) => loaded.errors(loaded.warnings.clone()).render(false),
                Err(errors) => errors.render(false),
            };
            assert!(said.contains(place) && said.contains(words), "{new}: {said}");
        }
    }
}
