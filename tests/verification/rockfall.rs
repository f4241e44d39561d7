//! Boulders over terrain: free flight, where they land, the probability of reach, zones, and independence of threads.

use std::path::Path;

use ndda::rockfall::result::wilson;
use ndda::rockfall::{End, Fall, Model, Outcome, RockfallError};
use ndda_io::read;

use crate::evidence::Answer::{AtMost, Near, Within};
use crate::evidence::{rounding, row};

const CASE: &str = "rockfall";
const G: f64 = 9.81;

/// A scene on ground with heights along x, the same for all y from 0 to 100 m, in which boulders fall for a time.
fn scene(heights: (&[f64], f64), end_s: f64, more: &str) -> Model {
    checked(heights, end_s, more).unwrap_or_else(|e| panic!("{e}"))
}

/// The same, or why it cannot be run.
fn checked((heights, step_x_m): (&[f64], f64), end_s: f64, more: &str) -> Result<Model, RockfallError> {
    let row = heights.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let text = format!(
        "(title: \"rockfall\", gravity_m_s2: (0, 0, -{G}), time: (end_s: {end_s}),
          materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 50e9, poisson: 0.25)],
          rockfall: (terrain: Heights(origin_m: (0, 0), step_m: ({step_x_m}, 50), heights_m: [[{row}], [{row}], [{row}]]), {more}))"
    );
    Model::new(read::load_text("rockfall.ron", &text, &[], None)?, Path::new("."), (None, None))
}

fn falls(model: &Model) -> Vec<Fall> {
    model.falls(&Default::default(), &|_| ()).expect("nobody interrupts")
}

#[test]
fn a_boulder_flies_along_a_parabola_and_lands_where_it_meets_the_slope() {
    let model = scene(
        (&[100.0, 60.0, 20.0], 100.0),
        5.0,
        "ground: (restitution: Always(0.3), friction_deg: Always(35)),
         boulders: (material: \"rock\", size: Diameter(diameter_m: Always(0.1)), shapes: [Ellipsoid()]),
         releases: [(name: \"top\", place: Points([(20, 50)]), height_m: Always(5), speed_m_s: Always(12), azimuth_deg: Always(90), dip_deg: Always(-10))],
         count: 1",
    );
    let fall = &falls(&model)[0];
    let start = fall.path[0];
    let [vx, _, vz] = start.velocity_m_s;
    let (mut worst, mut last) = (0.0f64, start);
    for moment in &fall.path {
        let t = moment.time_s;
        let flies = (moment.velocity_m_s[2] - (vz - G * t)).abs() < 1e-9;
        if !flies {
            break;
        }
        let [x, _, z] = moment.at_m;
        let away = (x - start.at_m[0] - vx * t).hypot(z - start.at_m[2] - vz * t + 0.5 * G * t * t);
        (worst, last) = (worst.max(away), *moment);
    }
    // A flight is exact in every step: rounding of a thousand at heights of 100 m.
    let rounds_m = 100.0 * rounding(1000);
    row(CASE, "distance from the parabola in flight [m]", worst, AtMost(rounds_m));
    // Height above the slope h + (v_z + 0.4 v_x) t − ½ g t² is that of the ball: 0.05 m, but for its facets.
    let (h, rise) = (start.at_m[2] - (100.0 - 0.4 * start.at_m[0]) - 0.05 * 1.16f64.sqrt(), vz + 0.4 * vx);
    let lands_s = (rise + (rise * rise + 2.0 * G * h).sqrt()) / G;
    let lands_m = start.at_m[0] + vx * lands_s;
    // The last point of the path in flight is less than its spacing away from there.
    let speed = last.speed_m_s();
    let from_last = (lands_m - last.at_m[0]) * speed / vx;
    row(CASE, "way from the last point in flight to where it lands [m]", from_last, Near(0.0, 0.6));
    let bounce = fall.path.iter().find(|m| m.time_s > last.time_s).expect("it goes on");
    assert!(bounce.time_s >= lands_s - 0.01, "in flight until {lands_s} s, but bounced by {}", bounce.time_s);
    row(CASE, "energy that came from nowhere over the largest", fall.accuracy.energy, AtMost(0.02));
}

#[test]
fn boulders_reach_a_line_as_often_as_their_speeds_say() {
    // Speeds from 5 to 25 m/s, horizontally off 20 m: they fly √(2 h/g) long, 10.1 to 50.5 m far.
    let mut heights = vec![0.0; 21];
    heights[0] = 0.01;
    let model = scene(
        (&heights, 5.0),
        2.1,
        "ground: (restitution: Always(0), friction_deg: Always(60)),
         boulders: (material: \"rock\", size: Diameter(diameter_m: Always(0.2)), shapes: [Cuboid()]),
         releases: [(name: \"edge\", place: Line([(20, 10), (20, 90)]), height_m: Always(20), speed_m_s: Uniform(5, 25), azimuth_deg: Always(90))],
         lines: [(name: \"wall\", points_m: [(50, 0), (50, 100)])], count: 200",
    );
    let falls = falls(&model);
    let flight_s = (2.0 * 20.0 / G).sqrt();
    let flew = |fall: &&Fall| fall.passages.iter().any(|(_, moment)| moment.time_s < flight_s);
    let reached = falls.iter().filter(flew).count();
    let probability = (25.0 - 30.0 / flight_s) / 20.0;
    let [low, high] = wilson(reached, falls.len());
    assert!(
        (low..=high).contains(&probability),
        "{reached} of {}: {low} to {high}, exact {probability}",
        falls.len()
    );
    row(CASE, "probability of reach in flight", reached as f64 / 200.0, Near(probability, 0.06));
    // Speeds at the wall: horizontal as released, vertical by the height that is left.
    let at_wall = |fall: &Fall| {
        fall.passages.iter().find(|(_, m)| m.time_s < flight_s).map(|(_, m)| (fall.path[0], *m))
    };
    for (start, moment) in falls.iter().filter_map(at_wall).take(20) {
        let t = (50.0 - 20.0) / start.velocity_m_s[0];
        let speed = start.velocity_m_s[0].hypot(G * t);
        assert!((moment.speed_m_s() / speed - 1.0).abs() < 1e-3 && (moment.time_s - t).abs() < 1e-3);
    }
}

/// Boulders that bounce down a slope onto level ground.
fn slope(zones: &str, count: u32) -> Model {
    let heights: Vec<f64> = (0..=40).map(|i| (60.0 - 3.0 * f64::from(i)).max(0.0)).collect();
    scene(
        (&heights, 4.0),
        6.0,
        &format!(
            "ground: (restitution: Always(0.35), friction_deg: Always(30)), zones: [{zones}],
             boulders: (material: \"rock\", size: Diameter(diameter_m: Uniform(0.5, 1.5))),
             releases: [(name: \"top\", place: Line([(8, 20), (8, 80)]), height_m: Uniform(0.5, 3))],
             lines: [(name: \"road\", points_m: [(90, 0), (90, 100)])], count: {count}"
        ),
    )
}

#[test]
fn a_zone_of_the_same_ground_changes_no_bit() {
    let all = "(name: \"all\", outline_m: [(-1, -1), (999, -1), (999, 999), (-1, 999)], restitution: Always(0.35), friction_deg: Always(30))";
    assert_eq!(falls(&slope("", 3)), falls(&slope(all, 3)));
    let soft = all.replace("0.35", "0.05");
    assert_ne!(falls(&slope("", 1)), falls(&slope(&soft, 1)));
}

#[test]
fn falls_depend_on_their_number_alone() {
    let model = slope("", 6);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| falls(&model))
    };
    let falls = on(1);
    assert_eq!(falls, on(3));
    assert_eq!(falls[4], slope("", 40).fall(4));
    let outcome = Outcome::new(&model, "slope", &falls, 0.0);
    let ends = outcome.ends;
    assert_eq!(ends.rest + ends.left_terrain + ends.still_moving + ends.stopped, 6);
    assert_eq!((ends.stopped, outcome.accuracy.inaccurate), (0, 0), "{:?}", outcome.accuracy);
}

#[test]
fn what_was_not_seen_to_its_end_makes_probabilities_lower_bounds_and_is_said() {
    let mut model = slope("", 8);
    model.loaded.scene.time.end_s = 0.5;
    let falls = falls(&model);
    let outcome = Outcome::new(&model, "slope", &falls, 0.0);
    let road = &outcome.lines[0];
    assert_eq!((outcome.ends.still_moving, road.reached, road.might), (8, 0, 8));
    // From that of none of eight to that of all.
    assert_eq!(road.confidence_95, [wilson(0, 8)[0], wilson(8, 8)[1]]);
    let said = outcome.to_string();
    for part in [
        "warning: 8 of 8 boulders still moved after 0.5 s: raise time.end_s",
        "at least 0.0 % (0.0 to 100.0 %)",
        "no median or 95 % value can be given: of 8 boulders 8 still moved at the end",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // Somebody ended the computation after three.
    let part = Outcome::new(&model, "slope", &falls[..3], 0.0);
    assert_eq!((part.count, part.asked, part.lines[0].might), (3, 8, 3));
    assert!(
        part.to_string().contains("warning: interrupted: results are those of the 3 boulders of 8"),
        "{part}"
    );
}

#[test]
fn a_boulder_that_is_slow_in_the_air_does_not_rest_there() {
    let mut model = scene(
        (&[0.0, 0.0, 0.0], 100.0),
        100.0,
        "ground: (restitution: Always(0.1), friction_deg: Always(45)),
         boulders: (material: \"rock\", size: Diameter(diameter_m: Always(1)), shapes: [Cuboid()]),
         releases: [(name: \"drop\", place: Points([(100, 50)]), height_m: Always(2))], count: 1",
    );
    model.loaded.scene.gravity_m_s2[2] = -0.01;
    let fall = &falls(&model)[0];
    let last = fall.path.last().expect("a path");
    // It needs √(2 h/g) = 20 s for 2 m, and is never faster than 0.2 m/s.
    assert_eq!(fall.end, End::Rest);
    assert!(last.time_s > 20.0 && last.height_m < 1.0, "{last:?}");
}

#[test]
fn falls_that_were_not_computed_to_their_end_are_not_accurate() {
    let model = slope("", 3);
    let mut falls = falls(&model);
    falls[1].end = End::Stopped("contact is too stiff".into());
    let outcome = Outcome::new(&model, "slope", &falls, 0.0);
    assert_eq!(outcome.accuracy.inaccurate, 1);
    let said = outcome.to_string();
    assert!(
        said.contains("note: 1 of 3 falls is inaccurate:\n  1 fall was not computed to the end"),
        "{said}"
    );
    assert!(!said.contains("accurately computed"), "{said}");
}

#[test]
fn lines_through_a_release_or_without_a_length_are_refused() {
    let refused = |line: &str, place: &str| {
        let more = format!(
            "ground: (restitution: Always(0.5), friction_deg: Always(20)),
             boulders: (material: \"rock\", size: Diameter(diameter_m: Always(1))),
             releases: [(name: \"top\", place: {place})], lines: [(name: \"road\", points_m: {line})], count: 9"
        );
        checked((&[60.0, 30.0, 0.0], 30.0), 1.0, &more).err().map_or_else(String::new, |e| e.to_string())
    };
    let through = refused("[(10, 0), (10, 100)]", "Points([(20, 50), (10, 60)])");
    assert!(through.contains("rockfall.lines[0].points_m"), "{through}");
    assert!(
        through.contains("line `road` passes through (10.000, 60.000), where boulder 1 starts"),
        "{through}"
    );
    // Places along a line are on it but for rounding.
    assert!(refused("[(10, 0), (13, 90)]", "Line([(11, 30), (12, 60)])").contains("move one of them"));
    assert_eq!(refused("[(10.001, 0), (10.001, 100)]", "Points([(10, 60)])"), "");
    let point = refused("[(10, 50), (10, 50)]", "Points([(20, 50)])");
    assert!(point.contains("has no length"), "{point}");
}

#[test]
fn heights_of_releases_that_are_cut_off_are_said() {
    let model = scene(
        (&[60.0, 30.0, 0.0], 30.0),
        0.01,
        "ground: (restitution: Always(0.5), friction_deg: Always(20)),
         boulders: (material: \"rock\", size: Diameter(diameter_m: Always(1))),
         releases: [(name: \"top\", place: Points([(10, 50)]), height_m: Normal(0, 1), speed_m_s: Normal(9, 1))], count: 1",
    );
    let outcome = Outcome::new(&model, "steep", &falls(&model), 0.0);
    let cut_off: Vec<_> = outcome.warnings.iter().filter(|said| said.contains("cut off")).collect();
    assert_eq!(cut_off.len(), 1, "{cut_off:?}");
    assert!(cut_off[0].starts_with("height_m of release `top`: 50.0 % of its distribution lies below 0"));
}

#[test]
fn a_boulder_that_leaves_the_terrain_is_said() {
    let model = scene(
        (&[60.0, 30.0, 0.0], 30.0),
        40.0,
        "ground: (restitution: Always(0.5), friction_deg: Always(20)),
         boulders: (material: \"rock\", size: Diameter(diameter_m: Always(1))),
         releases: [(name: \"top\", place: Points([(10, 50)]), speed_m_s: Always(5))], count: 2",
    );
    let falls = falls(&model);
    assert!(falls.iter().all(|fall| fall.end == End::LeftTerrain), "{:?}", falls[0].end);
    let said = Outcome::new(&model, "steep", &falls, 0.0).to_string();
    assert!(
        said.contains("runout: no median or 95 % value can be given: of 2 boulders 2 left the terrain"),
        "{said}"
    );
    // It may leave no sooner than its radius from the end, which is less than 0.9 m for this size.
    let last = falls[0].path.last().expect("a path").at_m[0];
    row(CASE, "place where it left the terrain [m]", last, Within(60.0, 0.03));
}
