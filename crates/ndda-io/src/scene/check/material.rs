//! Checks of materials.

use super::Check;
use crate::scene::code::Code;

/// Young's modulus [Pa] of diamond, more or less: what is above it was written in another unit.
const STIFFEST_PA: f64 = 1.2e12;

impl Check<'_> {
    pub(super) fn materials(&mut self) {
        let scene = self.scene;
        self.names("materials", &scene.materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>());
        let is_known = |name: &String| scene.materials.iter().any(|material| material.name == *name);
        // A misspelt name of a block is told as such.
        let names_are_known = scene.blocks.iter().all(|block| is_known(&block.material))
            && scene.rock.iter().all(|rock| is_known(&rock.material));
        for (i, material) in scene.materials.iter().enumerate() {
            let path = |field: &str| format!("materials[{i}].{field}");
            self.positive(path("young_pa"), material.young_pa, "Pa");
            self.positive(path("density_kg_m3"), material.density_kg_m3, "kg/m³");
            if !(-1.0 < material.poisson && material.poisson < 0.5) {
                let message = format!("{}: must lie between −1 and 0.5, both excluded", material.poisson);
                self.error(path("poisson"), message, "rock has 0.15 to 0.35");
            } else if material.poisson > 0.49 {
                let help = "four-node tetrahedra lock near 0.5: displacements come out too small";
                self.warn(Code::Inexact, path("poisson"), "nearly incompressible", help);
            }
            if material.young_pa > 0.0 && material.young_pa < 1e6 {
                let help = "the unit is pascal: 20 GPa is 20e9";
                self.warn(
                    Code::UnitSlip,
                    path("young_pa"),
                    format!("{} Pa is softer than any rock", material.young_pa),
                    help,
                );
            }
            if material.young_pa > STIFFEST_PA {
                let message = format!("{:e} Pa is stiffer than any material", material.young_pa);
                let help = "the unit is pascal: 20 GPa is 20e9, or Gigapascal(20)";
                self.warn(Code::UnitSlip, path("young_pa"), message, help);
            }
            let density = material.density_kg_m3;
            if density > 0.0 && !(100.0..=20000.0).contains(&density) {
                let help = "the unit is kg/m³: granite is 2650";
                self.warn(
                    Code::UnitSlip,
                    path("density_kg_m3"),
                    format!("{density} kg/m³ is not the density of a rock"),
                    help,
                );
            }
            for (name, value) in
                [("mass_per_s", material.damping.mass_per_s), ("stiffness_s", material.damping.stiffness_s)]
            {
                if !(value >= 0.0 && value.is_finite()) {
                    let message = format!("{value}: must not be negative");
                    self.error(path(&format!("damping.{name}")), message, "0 means no damping");
                }
            }
            if let Some(bedding) = &material.bedding {
                self.positive(path("bedding.young_across_pa"), bedding.young_across_pa, "Pa");
                self.positive(path("bedding.shear_across_pa"), bedding.shear_across_pa, "Pa");
                if bedding.normal == [0.0; 3] {
                    let help = "give a direction, such as (0, 0, 1) for level beds";
                    self.report(
                        Code::NoDirection,
                        path("bedding.normal"),
                        "the normal of the bedding is zero",
                        help,
                    );
                }
            }
            let of_rock = scene.rock.iter().any(|rock| rock.material == material.name);
            let beyond = scene.quiet.iter().any(|quiet| quiet.beyond.as_ref() == Some(&material.name));
            let falls = scene.rockfall.iter().any(|rockfall| rockfall.boulders.material == material.name);
            if names_are_known
                && !of_rock
                && !beyond
                && !falls
                && !scene.blocks.iter().any(|b| b.material == material.name)
            {
                self.warn(
                    Code::NoEffect,
                    path("name"),
                    format!("no block is made of `{}`", material.name),
                    "it may be left out",
                );
            }
        }
    }
}
