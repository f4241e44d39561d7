//! Rock taken apart into pieces that bonds hold together: how stiff it is as a whole.
//!
//! Under a stress σ a face between two pieces takes the traction σ n and opens by its parts along and across the normal over k_n and k_s. Over faces of all directions,
//! of the area A per volume, that is a strain σ/E_b in series with that of the pieces:
//!
//! ```text
//! 1/E_b = A (1/5k_n + 2/15k_s)        1/E_eff = 1/E + 1/E_b        ν_eff/E_eff = ν/E
//! ```
//!
//! Pieces that cannot open everywhere as much as that hold each other back, so that the rock is somewhat stiffer ([`HELD_BACK`]).

use std::fmt;

use ndda_contact::FrictionLaw;
use ndda_io::scene::{self, Body, Contact, Pieces, Potential, Rock, Scene};
use ndda_mesh::BlockSet;
use ndda_mesh::geometry::{tet_volume, triangle_area_vector};
use ndda_mesh::tetrahedralise::TETRAHEDRA;
use serde::Serialize;

use super::friction::friction_law;
use super::pairs::{contact_stiffness_pa_m, surfaces_of};
use crate::numbers::{counted, four_figures};

/// Strain by the opening of faces over that if each opened freely: 0.89 where bonds are of 10 E/h, 0.83 where they are of E/h, in direct solutions of all
/// pieces and bonds (tests/verification/bonded_rock.rs).
const HELD_BACK: f64 = 0.88;
/// Largest difference of stiffnesses that are the same.
const SAME: f64 = 0.01;
/// Largest Poisson's ratio of pieces that are made stiffer.
const MOST_POISSON: f64 = 0.45;

/// Rock of bonded pieces.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bonded {
    /// Pieces.
    pub pieces: usize,
    /// Area of the faces between them, per volume of rock [1/m].
    pub faces_per_m: f64,
    /// Stiffness of the bonds; none where nothing holds the pieces together.
    pub bonds: Option<Bonds>,
}

/// Stiffness of bonds between pieces, and of the rock with them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bonds {
    /// Of a bond that is pulled or sheared [Pa/m].
    pub pulled_pa_m: f64,
    /// Of one that is pressed, which is that of contact [Pa/m].
    pub pressed_pa_m: f64,
    /// Young's modulus of the material [Pa].
    pub material_pa: f64,
    /// Young's modulus of the pieces [Pa]; infinite where they are rigid.
    #[serde(skip_serializing_if = "is_infinite")]
    pub pieces_pa: f64,
    /// Young's modulus of the rock while it is pulled, and while it is pressed [Pa].
    pub rock_pa: [f64; 2],
}

fn is_infinite(x: &f64) -> bool {
    x.is_infinite()
}

impl Bonded {
    /// Measures rock `index` of a scene on its blocks; none where it is not taken apart.
    pub fn new(scene: &Scene, index: usize, blocks: &BlockSet) -> Option<Self> {
        let rock = &scene.rock[index];
        rock.into?;
        let (mut pieces, mut area_m2, mut volume_m3) = (0, 0.0, 0.0);
        let between = surfaces_of(TETRAHEDRA, blocks);
        let at = |n: ndda_mesh::NodeId| blocks.rest_position[n.index()];
        for block in blocks.ids().filter(|block| rock.makes(&blocks.names[block.index()])) {
            pieces += 1;
            volume_m3 += blocks.tets_of(block).map(|t| tet_volume(&blocks.tets[t].map(at))).sum::<f64>();
            let inner = |t: &usize| blocks.triangle_surface[*t].is_some_and(|s| between.contains(&s));
            let inner = blocks.triangles_of(block).filter(inner);
            // Each face is that of two pieces.
            area_m2 +=
                0.5 * inner.map(|t| triangle_area_vector(&blocks.triangles[t].map(at)).norm()).sum::<f64>();
        }
        let faces_per_m = area_m2 / volume_m3;
        Some(Self { pieces, faces_per_m, bonds: bonds(scene, rock, blocks, faces_per_m) })
    }
}

/// Young's modulus of bonds in series with rigid pieces [Pa].
fn bonds_pa(faces_per_m: f64, normal_pa_m: f64, shear_pa_m: f64) -> f64 {
    1.0 / (HELD_BACK * faces_per_m * (1.0 / (5.0 * normal_pa_m) + 2.0 / (15.0 * shear_pa_m)))
}

fn in_series(a_pa: f64, b_pa: f64) -> f64 {
    1.0 / (1.0 / a_pa + 1.0 / b_pa)
}

fn bonds(scene: &Scene, rock: &Rock, blocks: &BlockSet, faces_per_m: f64) -> Option<Bonds> {
    let law = law(scene, rock).filter(|law| law.holds_together())?;
    let pressed_pa_m = pressed_pa_m(scene, blocks)?;
    let (open_pa_m, shear_pa_m) = (law.bond_stiffness_pa_m(), law.shear_stiffness_pa_m());
    let material_pa = scene.materials.iter().find(|m| m.name == rock.material)?.young_pa;
    let bonds = [open_pa_m, pressed_pa_m].map(|normal_pa_m| bonds_pa(faces_per_m, normal_pa_m, shear_pa_m));
    let pieces_pa = match (rock.body, rock.into) {
        (Body::Rigid | Body::Fixed, _) => f64::INFINITY,
        (_, Some(Pieces::Tetrahedra { compensate: true, .. })) => {
            let stiffer = 1.0 / (1.0 / material_pa - 1.0 / bonds[0]);
            // What cannot be made up for is refused where the bodies are built.
            if stiffer > 0.0 { stiffer } else { material_pa }
        }
        _ => material_pa,
    };
    let rock_pa = bonds.map(|bonds_pa| in_series(pieces_pa, bonds_pa));
    Some(Bonds { pulled_pa_m: open_pa_m, pressed_pa_m, material_pa, pieces_pa, rock_pa })
}

/// The law on the faces between pieces: that of the joint, else that between the rock's material and itself, else that of all contact.
fn law(scene: &Scene, rock: &Rock) -> Option<Box<dyn FrictionLaw>> {
    let Some(Contact::Potential { friction, material_pairs, rock_joints, .. }) = &scene.contact else {
        return None;
    };
    let named = rock_joints.iter().rfind(|law| scene::matches(&law.joint, TETRAHEDRA));
    let of_material =
        |pair: &&scene::MaterialPair| pair.between.0 == rock.material && pair.between.1 == rock.material;
    let pair = || material_pairs.iter().rfind(of_material).and_then(|pair| pair.friction.as_ref());
    let found = match named {
        Some(law) => law.friction.as_ref(),
        None => pair().or(friction.as_ref()),
    };
    found.and_then(friction_law)
}

/// Stiffness of closed joints; none where it depends on the area of contact.
fn pressed_pa_m(scene: &Scene, blocks: &BlockSet) -> Option<f64> {
    let Some(Contact::Potential { penalty_pa, potential, .. }) = &scene.contact else { return None };
    match potential {
        Potential::Element => {
            Some(contact_stiffness_pa_m(&surfaces_of(TETRAHEDRA, blocks), *penalty_pa, blocks))
        }
        _ => Some(2.0 * penalty_pa / potential.reference_m()?),
    }
}

/// The material of pieces that make up for their bonds, 1/E′ = 1/E − 1/E_b and ν′ = ν E′/E; none where the rock is not to do so.
///
/// # Errors
/// What cannot be made up for, and what to change.
pub(super) fn stiffer(
    scene: &Scene,
    index: usize,
    blocks: &BlockSet,
) -> Result<Option<scene::Material>, String> {
    let rock = &scene.rock[index];
    let Some(Pieces::Tetrahedra { compensate: true, .. }) = rock.into else { return Ok(None) };
    let material = scene.materials.iter().find(|m| m.name == rock.material);
    let bonded = Bonded::new(scene, index, blocks);
    let (Some(bonded), Some(material)) = (bonded, material) else { return Ok(None) };
    let Some(Bonds { pulled_pa_m, pressed_pa_m, .. }) = bonded.bonds else {
        return Err(format!(
            "nothing holds the {} pieces together: give contact.rock_joints a law for `{TETRAHEDRA}` with cohesion_pa or tension_pa",
            bonded.pieces
        ));
    };
    if (pressed_pa_m / pulled_pa_m - 1.0).abs() > SAME {
        let cure = match &scene.contact {
            Some(Contact::Potential { potential: Potential::Smooth { reference_m }, .. }) => {
                format!(
                    "give penalty_pa: {:e}, which is ½ shear_penalty_pa_m L₀",
                    0.5 * pulled_pa_m * reference_m
                )
            }
            _ => "use the potential Smooth with penalty_pa = ½ shear_penalty_pa_m L₀".into(),
        };
        return Err(format!(
            "bonds are {pressed_pa_m:.4e} Pa/m stiff while they are pressed, but {pulled_pa_m:.4e} Pa/m while they are pulled, so that no one modulus makes up for \
             both: {cure}"
        ));
    }
    let bonds_pa = bonds_pa(bonded.faces_per_m, pulled_pa_m, pulled_pa_m);
    let least_pa = material.young_pa / (1.0 - material.poisson.max(0.0) / MOST_POISSON);
    if !(bonds_pa > material.young_pa
        && (material.poisson <= 0.0 || (least_pa > 0.0 && bonds_pa >= least_pa)))
    {
        return Err(if material.poisson >= MOST_POISSON {
            format!(
                "Poisson's ratio {} is too near to ½ to compensate for bonds: leave out compensate",
                material.poisson
            )
        } else {
            let needed_pa_m = pulled_pa_m * least_pa / bonds_pa;
            format!(
                "bonds of {pulled_pa_m:.4e} Pa/m are too soft to compensate for: give a shear_penalty_pa_m of at least {needed_pa_m:.1e} and penalty_pa = ½ shear_penalty_pa_m L₀, or a larger size_m"
            )
        });
    }
    let young_pa = 1.0 / (1.0 / material.young_pa - 1.0 / bonds_pa);
    let poisson = material.poisson * young_pa / material.young_pa;
    Ok(Some(scene::Material { young_pa, poisson, ..material.clone() }))
}

impl fmt::Display for Bonded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pieces = counted(self.pieces, "piece", "pieces");
        let Some(Bonds { pulled_pa_m, pressed_pa_m, material_pa, pieces_pa, rock_pa }) = &self.bonds else {
            return write!(f, "{pieces} that nothing holds together");
        };
        let gpa = |pa: f64| four_figures(1e-9 * pa);
        write!(f, "{pieces} held by bonds of {} GPa/m", gpa(*pulled_pa_m))?;
        let same = (pressed_pa_m / pulled_pa_m - 1.0).abs() <= SAME;
        if !same {
            write!(f, " ({} GPa/m while pressed)", gpa(*pressed_pa_m))?;
        }
        let [pulled, pressed] = rock_pa.map(gpa);
        write!(f, ": as stiff as rock of about {pulled} GPa")?;
        if !same {
            write!(f, " while pulled and {pressed} GPa while pressed")?;
        }
        match pieces_pa {
            e if e.is_infinite() => write!(f, ", the pieces being rigid"),
            e if e != material_pa => write!(f, ", the pieces being of {} GPa", gpa(*e)),
            e => write!(f, ", the material being of {} GPa", gpa(*e)),
        }
    }
}
