//! Commented scenes to begin with.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

use serde::Serialize;

/// A scene to begin with.
#[derive(Serialize)]
pub struct Template {
    /// Its name.
    pub name: &'static str,
    /// Purpose.
    pub about: &'static str,
    /// The command that runs it: `run` or `rockfall`.
    #[serde(skip)]
    pub verb: &'static str,
    /// The scene.
    #[serde(skip)]
    pub scene: &'static str,
    /// Files that it refers to: name and content.
    #[serde(skip)]
    pub files: &'static [(&'static str, &'static str)],
}

impl Template {
    /// Writes the scene to a file, and beside it the files that it refers to.
    ///
    /// # Errors
    /// The file that cannot be written, or that is there already, unless it is to be replaced; a file of the same name as one that the scene refers to, with other
    /// content, is never replaced.
    pub fn write(&self, scene: &Path, replace: bool) -> Result<(), String> {
        let folder = scene.parent().unwrap_or(Path::new(""));
        if !replace && scene.exists() {
            return Err(format!(
                "{} is there already; --force replaces it, --out names another",
                scene.display()
            ));
        }
        let mut files = vec![(scene.to_path_buf(), self.scene)];
        for (name, content) in self.files {
            let file = folder.join(name);
            match std::fs::read(&file) {
                Ok(there) if there == content.as_bytes() => (),
                Ok(_) => {
                    return Err(format!(
                        "{} is there already, with other content: move it, or write the scene to another folder with --out",
                        file.display()
                    ));
                }
                Err(_) => files.push((file, *content)),
            }
        }
        for (file, content) in files {
            let mut options = OpenOptions::new();
            let opened = options.write(true).create(true).create_new(!replace).truncate(true).open(&file);
            opened
                .and_then(|mut opened| opened.write_all(content.as_bytes()))
                .map_err(|error| format!("{} cannot be written: {error}", file.display()))?;
        }
        Ok(())
    }
}

/// A template for `ndda run`, without other files.
const fn template(name: &'static str, about: &'static str, scene: &'static str) -> Template {
    Template { name, about, verb: "run", scene, files: &[] }
}

/// All templates; the first is the default.
pub const TEMPLATES: [Template; 11] = [
    template("slide", "a block on a slope, with friction", include_str!("../templates/slide.ron")),
    template("collide", "two blocks that meet in flight", include_str!("../templates/collide.ron")),
    template("topple", "a slender block on a base that is shaken", include_str!("../templates/topple.ron")),
    Template {
        files: &[("record.at2", include_str!("../templates/record.at2"))],
        ..template(
            "earthquake",
            "a block on a slope under a recorded earthquake",
            include_str!("../templates/earthquake.ron"),
        )
    },
    template("slope", "a slope in two joint sets", include_str!("../templates/slope.ron")),
    template("wedge", "a wedge between two joints and a face", include_str!("../templates/wedge.ron")),
    template("tunnel", "a wedge in the roof of a tunnel", include_str!("../templates/tunnel.ron")),
    Template {
        verb: "rockfall",
        files: &[("terrain.asc", include_str!("../templates/terrain.asc"))],
        ..template(
            "rockfall",
            "boulders that fall over terrain, for `ndda rockfall`",
            include_str!("../templates/rockfall.ron"),
        )
    },
    template("column", "rock cut by joint sets, on a base", include_str!("../templates/column.ron")),
    template("pile", "blocks that fall into a box", include_str!("../templates/pile.ron")),
    Template {
        files: &[("block.msh", include_str!("../templates/block.msh"))],
        ..template("mesh", "a block from a mesh file", include_str!("../templates/mesh.ron"))
    },
];
