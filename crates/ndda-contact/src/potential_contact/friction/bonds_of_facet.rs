//! The bonds of one facet on one block, and what they leave to its friction.

use ndda_mesh::{BlockId, BlockSet, TetId, TriangleId};

use crate::friction::law_table::Memory;
use crate::model::Bond;

/// Identifies a facet's contact: the triangle, the other block and, with memory per element, the element.
pub(crate) type Key = (TriangleId, BlockId, Option<TetId>);

/// The bonds of a facet; all are in the order of their keys, which begin with the triangle.
fn of_facet<'a>(
    bonds: &'a [Bond],
    (blocks, memory, wanted): (&'a BlockSet, Memory, Key),
) -> impl Iterator<Item = &'a Bond> + Clone {
    let first = bonds.partition_point(|bond| bond.facet < wanted.0);
    let of_triangle = bonds[first..].iter().take_while(move |bond| bond.facet == wanted.0);
    of_triangle.filter(move |bond| key(blocks, memory, bond) == wanted)
}

/// Part of a facet's contact that no bond holds any more; none where there are no bonds.
pub(crate) fn broken_part(bonds: &[Bond], blocks: &BlockSet, memory: Memory, wanted: Key) -> Option<f64> {
    let own = of_facet(bonds, (blocks, memory, wanted));
    let whole: f64 = own.map(|bond| (1.0 - bond.damage) * bond.part).sum();
    (whole > 0.0).then_some(1.0 - whole)
}

/// Share of one bond in a force on its facet, `weights` being the parts of the force at the corners of the facet. The shares add up to the force and act where it does,
/// unless a share would be a pull: that bond then bears nothing, and the others bear the whole force.
fn borne_of(own: impl Iterator<Item = [f64; 3]> + Clone, bears: &[f64; 3], weights: &[f64; 3]) -> f64 {
    let of =
        |bears: &[f64; 3]| -> f64 { bears.iter().zip(weights).map(|(part, weight)| part * weight).sum() };
    let (force, each) = (of(bears), own.map(|bears| of(&bears)));
    if each.clone().all(|force| force >= 0.0) {
        return force;
    }
    let (all, pressed) =
        each.fold((0.0, 0.0), |(all, pressed), force| (all + force, pressed + force.max(0.0)));
    if pressed > 0.0 { force.max(0.0) * (all / pressed).max(0.0) } else { 0.0 }
}

/// Share of the bond at index `place` in a force on its facet; bonds are sorted by their keys, so that those of a facet are neighbours.
pub(crate) fn borne(
    bonds: &[Bond],
    place: usize,
    facet: (&BlockSet, Memory, Key),
    weights: &[f64; 3],
) -> f64 {
    let (blocks, memory, wanted) = facet;
    let is_own = |bond: &&Bond| key(blocks, memory, bond) == wanted;
    let before = bonds[..place].iter().rev().take_while(is_own);
    let own = before.chain(bonds[place..].iter().take_while(is_own)).map(|bond| bond.bears);
    borne_of(own, &bonds[place].bears, weights)
}

/// What the broken bonds of a facet leave to its friction: ∫ φ dA that they would bear, of which each corner has its weight, and the area that the other bonds do not
/// hold [m²].
pub(crate) fn left_to_friction(
    bonds: &[Bond],
    facet: (&BlockSet, Memory, Key),
    (weights, area_m2, facet_m2): (&[f64; 3], f64, f64),
) -> [f64; 2] {
    let own = of_facet(bonds, facet);
    let all = of_facet(bonds, facet).map(|bond| bond.bears);
    let (mut pressure, mut free_m2) = (0.0, area_m2);
    for bond in own {
        if bond.damage < 1.0 {
            free_m2 -= bond.share * facet_m2;
        } else {
            pressure += borne_of(all.clone(), &bond.bears, weights);
        }
    }
    [pressure.max(0.0), free_m2.max(0.0)]
}

/// Drops the bonds of facets on which none holds any more.
pub(crate) fn forget_opened(bonds: &mut Vec<Bond>, blocks: &BlockSet, memory: Memory) {
    let (mut start, mut kept) = (0, 0);
    while let Some(first) = bonds.get(start) {
        let wanted = key(blocks, memory, first);
        let own = bonds[start..].iter().take_while(|bond| key(blocks, memory, bond) == wanted);
        let end = start + own.count();
        if bonds[start..end].iter().any(|bond| bond.damage < 1.0) {
            bonds.copy_within(start..end, kept);
            kept += end - start;
        }
        start = end;
    }
    bonds.truncate(kept);
}

pub(crate) fn key(blocks: &BlockSet, memory: Memory, bond: &Bond) -> Key {
    let element = (memory == Memory::Element).then_some(bond.tet);
    (bond.facet, blocks.tet_block[bond.tet.index()], element)
}
