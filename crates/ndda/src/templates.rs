//! Commented scenes to begin with.

use serde::Serialize;

/// A scene to begin with.
#[derive(Serialize)]
pub struct Template {
    /// Its name.
    pub name: &'static str,
    /// Purpose.
    pub about: &'static str,
    /// The scene.
    #[serde(skip)]
    pub scene: &'static str,
    /// Files that it refers to: name and content.
    #[serde(skip)]
    pub files: &'static [(&'static str, &'static str)],
}

const fn template(name: &'static str, about: &'static str, scene: &'static str) -> Template {
    Template { name, about, scene, files: &[] }
}

/// All templates; the first is the default.
pub const TEMPLATES: [Template; 6] = [
    template("slide", "a block on a slope, with friction", include_str!("../templates/slide.ron")),
    template("collide", "two blocks that meet in flight", include_str!("../templates/collide.ron")),
    template("topple", "a slender block on a base that is shaken", include_str!("../templates/topple.ron")),
    template("column", "rock cut by joint sets, on a base", include_str!("../templates/column.ron")),
    template("pile", "blocks that fall into a box", include_str!("../templates/pile.ron")),
    Template {
        name: "mesh",
        about: "a block from a mesh file",
        scene: include_str!("../templates/mesh.ron"),
        files: &[("block.msh", include_str!("../templates/block.msh"))],
    },
];
