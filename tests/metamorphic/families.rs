//! Families of random scenes.

use ndda::build;
use ndda_io::read::load_text;
use ndda_mesh::Vec3;
use std::path::Path;

use crate::generator::{Piece, Plan, Wanted};
use crate::laws;
use crate::random::{Random, few_digits};
use crate::shapes;

/// Clearance between faces that rest on each other: none.
const FLUSH: f64 = 0.0;

/// A random plan.
pub fn plan(random: &mut Random, wanted: &Wanted) -> Plan {
    let length_m = random.decades(0.05, 5.0);
    let young_pa = random.decades(1e8, 1e11);
    let mut plan = Plan {
        family: "",
        length_m,
        pieces: Vec::new(),
        rock: String::new(),
        gravity: [0.0; 3],
        loads: String::new(),
        contact: laws::contact(random, young_pa, length_m),
        material: laws::material(random, young_pa),
    };
    // Those from 88 on have no contact.
    let most = if wanted.damped { 87 } else { 99 };
    if wanted.damped {
        plan.contact = laws::damped(random, &plan.contact);
    }
    match random.whole(0, most) {
        0..45 => collision(&mut plan, random, wanted),
        45..65 => pile(&mut plan, random, wanted),
        65..75 => moved_base(&mut plan, random, wanted),
        75..88 if !wanted.uncut && !wanted.symmetric => cut_rock(&mut plan, random),
        88..94 if !wanted.free => held(&mut plan, random, wanted),
        94.. => flight(&mut plan, random, wanted),
        _ => collision(&mut plan, random, wanted),
    }
    plan
}

fn kind(random: &mut Random) -> &'static str {
    random.one_of::<&str>(&["Rigid", "Rigid", "Affine", "Elastic"])
}

fn piece(random: &mut Random, wanted: &Wanted, name: String, length_m: f64) -> Piece {
    Piece {
        name,
        shape: shapes::any(random, wanted, length_m),
        body: kind(random),
        turns: shapes::turn(random),
        at_m: [0.0; 3],
        away: [0.0; 3],
        velocity: random.vector(0.4),
        spin: if random.happens(0.5) { random.vector(1.0) } else { [0.0; 3] },
    }
}

/// A plate that is fixed, its top at z = 0.
fn plate(random: &mut Random, wanted: &Wanted, length_m: f64) -> Piece {
    let cells = if wanted.large { 8 } else { random.whole(1, 2) };
    let size_m = [4.0, 4.0, 0.5].map(|x| few_digits(x * length_m));
    Piece {
        name: "plate".into(),
        shape: shapes::boxed(random, wanted, size_m, [cells, cells, 1]),
        body: "Fixed",
        turns: String::new(),
        at_m: [-0.5 * size_m[0], -0.5 * size_m[1], -size_m[2]],
        away: [0.0; 3],
        velocity: [0.0; 3],
        spin: [0.0; 3],
    }
}

/// Blocks one above the other that fly downwards, onto a plate or onto a free block.
fn collision(plan: &mut Plan, random: &mut Random, wanted: &Wanted) {
    plan.family = "collision";
    let mut top = 0.0;
    let count = random.whole(1, 3);
    if count == 1 || random.happens(0.6) {
        plan.pieces.push(plate(random, wanted, plan.length_m));
    } else {
        let free = piece(random, wanted, "lowest".into(), plan.length_m);
        top = bounds(&free).1.z;
        plan.pieces.push(free);
    }
    for i in 0..count {
        let size_m = plan.length_m * random.decades(0.5, 2.0);
        let mut next = piece(random, wanted, format!("block_{i}"), size_m);
        let (low, high) = bounds(&next);
        let aside = random.vector(0.3 * plan.length_m);
        let middle = 0.5 * (low + high);
        next.at_m = [aside[0] - middle.x, aside[1] - middle.y, top - low.z];
        next.away = [0.0, 0.0, f64::from(i + 1)];
        next.velocity[2] -= f64::from(i + 1);
        top += high.z - low.z;
        plan.pieces.push(next);
    }
    if random.happens(0.5) {
        plan.gravity = [0.0, 0.0, -random.between(0.1, 1.0)];
    }
}

/// Boxes that lie flush on each other and on a plate; gravity may be oblique.
fn pile(plan: &mut Plan, random: &mut Random, wanted: &Wanted) {
    plan.family = "pile";
    plan.pieces.push(plate(random, wanted, plan.length_m));
    let mut top = 0.0;
    for i in 0..random.whole(1, 3) {
        let size_m = [0; 3].map(|_| few_digits(plan.length_m * random.between(0.5, 1.5)));
        let moves = random.happens(0.5);
        let cells = shapes::cells(random, wanted);
        let aside = random.vector(0.1 * plan.length_m);
        plan.pieces.push(Piece {
            name: format!("block_{i}"),
            shape: shapes::boxed(random, wanted, size_m, cells),
            body: kind(random),
            turns: format!("(axis: (0, 0, 1), angle_deg: {})", random.between(0.0, 30.0)),
            at_m: [aside[0] - 0.4 * size_m[0], aside[1] - 0.4 * size_m[1], top + FLUSH],
            away: [0.0; 3],
            velocity: if moves {
                [random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0]
            } else {
                [0.0; 3]
            },
            spin: if moves && random.happens(0.4) { [0.0, 0.0, random.between(-1.0, 1.0)] } else { [0.0; 3] },
        });
        top += size_m[2];
    }
    let slope = random.between(0.0, 0.8);
    let weight = random.between(0.5, 2.0);
    plan.gravity = [weight * slope, 0.0, -weight];
}

/// A pile on a plate that is moved.
fn moved_base(plan: &mut Plan, random: &mut Random, wanted: &Wanted) {
    pile(plan, random, wanted);
    plan.family = "moved base";
    plan.loads = "supports: [(block: \"plate\", on: All, hold: Motion([(time_s: 0, displacement_m: (0, 0, 0)), \
                  (time_s: {H}, displacement_m: ({D}, 0, 0)), (time_s: {T}, displacement_m: ({D}, {D}, 0))]))],"
        .into();
}

/// Rock cut by joints or into Voronoi cells; what is low stays where it is.
fn cut_rock(plan: &mut Plan, random: &mut Random) {
    plan.family = "cut rock";
    let side = few_digits(2.0 * plan.length_m);
    let cut = if random.happens(0.5) {
        format!("voronoi: (count: {}, least_distance_m: {})", random.whole(3, 6), 0.8 * plan.length_m)
    } else {
        let set = |random: &mut Random, name: &str| {
            format!(
                "Set(name: \"{name}\", dip_deg: {}, dip_direction_deg: {}, spacing_m: {})",
                random.between(0.0, 90.0),
                random.between(0.0, 360.0),
                few_digits(plan.length_m * random.between(0.9, 1.5))
            )
        };
        format!("joints: [{}, {}]", set(random, "first"), set(random, "second"))
    };
    plan.rock = format!(
        "(material: \"rock\", domain: Box(min_m: (0, 0, 0), max_m: ({side}, {side}, {side})), {cut}, seed: {}, \
         sliver_width_m: {}, body: {}, fill: {}, fixed: [Beyond(point_m: (0, 0, {}), normal: (0, 0, -1))])",
        random.whole(0, 999_999),
        0.15 * plan.length_m,
        kind(random),
        random.one_of(&["Fewest", "Centre"]),
        0.35 * side
    );
    plan.gravity = [random.between(-2.0, 2.0), random.between(-2.0, 2.0), -random.between(0.0, 2.0)];
}

/// An elastic box that is held at one end and loaded at the other.
fn held(plan: &mut Plan, random: &mut Random, wanted: &Wanted) {
    plan.family = "held";
    let size_m = [2.0, 1.0, 1.0].map(|x| few_digits(x * plan.length_m));
    let cells = [random.whole(1, 4), 1, random.whole(1, 2)];
    plan.pieces.push(Piece {
        name: "beam".into(),
        shape: shapes::boxed(random, wanted, size_m, cells),
        body: "Elastic",
        turns: String::new(),
        at_m: [0.0; 3],
        away: [0.0; 3],
        velocity: [0.0; 3],
        spin: [0.0; 3],
    });
    let by = if random.happens(0.3) { ", by: Springs(stiffness_n_m: {K})" } else { "" };
    let ramp = if random.happens(0.5) {
        ", factor: [(time_s: 0, factor: 0), (time_s: {H}, factor: 1), (time_s: {T}, factor: 0.3)]"
    } else {
        ""
    };
    plan.loads = format!(
        "supports: [(block: \"beam\", on: Set(\"x_min\"), hold: Fixed{by})],\n    \
         tractions: [(block: \"beam\", on: Set(\"x_max\"), traction_pa: (0, {{P}}, {{P}}){ramp})],"
    );
    plan.contact = "Off".into();
}

/// One block in free flight, turning, maybe pushed.
fn flight(plan: &mut Plan, random: &mut Random, wanted: &Wanted) {
    plan.family = "flight";
    let mut block = piece(random, wanted, "block".into(), plan.length_m);
    block.spin = random.vector(2.0);
    plan.pieces.push(block);
    plan.gravity = [0.0, 0.0, -random.between(0.0, 1.0)];
    plan.contact = "Off".into();
    if !wanted.free && random.happens(0.5) {
        plan.loads = "forces: [(block: \"block\", force_n: ({F}, 0, {F}))],".into();
    }
}

/// Lowest and highest coordinates of a block at its origin [m].
fn bounds(piece: &Piece) -> (Vec3, Vec3) {
    let text = format!(
        "(title: \"\", time: (step_s: 1, end_s: 1), materials: [(name: \"rock\", young_pa: 1, poisson: 0, \
         density_kg_m3: 1)], blocks: [(name: \"a\", material: \"rock\", shape: {}, turns: [{}])])",
        piece.shape, piece.turns
    );
    let loaded = load_text("piece.ron", &text, &[], None).unwrap_or_else(|e| panic!("{}", e.render(false)));
    let (meshes, _) = build::meshes(&loaded.scene, Path::new(".")).expect("a shape that can be built");
    let nodes = &meshes[0].1.nodes;
    nodes.iter().fold((nodes[0], nodes[0]), |(low, high), x| (low.inf(x), high.sup(x)))
}
