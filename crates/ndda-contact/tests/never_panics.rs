//! A pair gives a finite answer or an error for any bits that come in.
//!
//! `NDDA_CASES` sets the number of pairs and of lines (default 100 000); the same is done under a fuzzer in `fuzz/`.

use ndda_contact::integration::TetFrame;
use ndda_contact::integration::pair_moments;
use ndda_contact::integration::tet_overlap;
use ndda_contact::reference::tet_pair::pair_forces;
use ndda_mesh::Vec3;
use ndda_mesh::geometry::{TET_FACES, tet_volume, triangle_area_vector};
use serde_json::Value;

#[path = "../examples/pair.rs"]
#[allow(dead_code)]
mod calculator;

/// A kind of pair whose coordinates are of the size of one.
const PLAIN: usize = 8;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// Any bits at all, a grid point, one an ulp beside it, the ends of the range, a number that is none.
    fn number(&mut self, kind: usize) -> f64 {
        let small = self.below(9) as f64 - 4.0;
        let choice = if kind == PLAIN { [1, 2, 7][self.below(3)] } else { (kind + self.below(3)) % 8 };
        match choice {
            0 => f64::from_bits(self.next()),
            1 => small,
            2 => f64::from_bits((small + 0.5).to_bits() + self.next() % 3),
            3 => small * 1e-160,
            4 => small * 1e150,
            5 => small * f64::MIN_POSITIVE / 8.0,
            6 if self.below(40) == 0 => [f64::NAN, f64::INFINITY, -f64::INFINITY, f64::MAX][self.below(4)],
            _ => small + (self.next() as f64 / u64::MAX as f64),
        }
    }

    fn tet(&mut self, kind: usize) -> [Vec3; 4] {
        std::array::from_fn(|_| Vec3::from_fn(|_, _| self.number(kind)))
    }

    /// Two tetrahedra that as often as not share corners, planes or nearly so.
    fn pair(&mut self, kind: usize) -> [[Vec3; 4]; 2] {
        let (c, mut t) = (self.tet(kind), self.tet(kind));
        for i in 0..self.below(5) {
            t[i] = c[(i + self.below(2)) % 4];
        }
        if self.below(4) == 0 {
            t[3] = (t[0] + t[1] + t[2]) / 3.0 + (c[3] - t[0]) * 0.1f64.powi(self.below(17) as i32);
        }
        [c, t]
    }
}

fn cases() -> usize {
    std::env::var("NDDA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(100_000)
}

#[test]
fn a_pair_of_any_bits_is_answered_finitely_or_refused() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut answered = 0;
    for case in 0..cases() {
        let [c, t] = random.pair(case % 9);
        let penalty = random.number(case % 9).abs();
        if let Ok(forces) = pair_forces(&c, &t, penalty) {
            answered += 1;
            let vectors = forces.nodal_n.iter().chain([&forces.force_n, &forces.torque_n_m]);
            let numbers = vectors.flat_map(|v| v.iter()).chain(forces.stiffness_n_m.iter());
            let scalars = [forces.volume_m3, forces.energy_j, forces.largest_stiffness_n_m()];
            assert!(numbers.chain(&scalars).all(|v| v.is_finite()), "{forces:?} for {c:?}, {t:?}");
            assert!(scalars.iter().all(|v| *v >= 0.0), "{forces:?} for {c:?}, {t:?}");
        }
        if let Ok(overlap) = tet_overlap(&c, &t) {
            let scalars = [overlap.volume_m3, overlap.phi_contactor_m3, overlap.phi_target_m3];
            assert!(scalars.iter().all(|v| v.is_finite() && *v >= 0.0), "{overlap:?} for {c:?}, {t:?}");
            assert!(overlap.centroid.is_none_or(|x| x.iter().all(|v| v.is_finite())));
        }
    }
    assert!(answered > cases() / 50, "only {answered} of {} pairs had an answer", cases());
}

#[test]
fn the_kernel_takes_any_bits_and_answers_finitely_for_sound_tetrahedra() {
    let mut random = Random(0xD1B5_4A32_D192_ED03);
    let mut sound = 0;
    for case in 0..cases() {
        let [c, t] = random.pair(case % 9);
        let triangle = TET_FACES[case % 4].map(|i| c[i]);
        // The solver lets no flat tetrahedron through, and the kernel multiplies three lengths: where they are lost
        // it need only not panic.
        let in_range = c.iter().chain(&t).all(|x| x.amax() < 1e50) && tet_volume(&t).abs() > 1e-100;
        let is_sound = in_range && pair_forces(&c, &t, 1.0).is_ok();
        sound += usize::from(is_sound);
        let frame = TetFrame::new(&t);
        let moments = pair_moments(&triangle, &triangle_area_vector(&triangle), &frame);
        let Some(moments) = moments.filter(|_| is_sound) else { continue };
        let on_target = moments.on_target(&frame.lambda(&triangle)).pressure;
        let numbers = moments.pressure.iter().chain(&on_target).chain([&moments.area]);
        assert!(numbers.copied().all(f64::is_finite), "{moments:?} for {triangle:?} in {t:?}");
    }
    assert!(sound > cases() / 50, "only {sound} of {} pairs were sound", cases());
}

const PIECES: [&str; 24] = [
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"contactor\"",
    "\"target\"",
    "\"penalty_pa\"",
    "\"",
    "1e309",
    "-1e-400",
    "NaN",
    "null",
    "true",
    "0",
    "-0",
    "1e308",
    "5e-324",
    "\\u0000",
    "é",
    "\t",
    "[0,0,0]",
    "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]",
];

/// A sound line with some of it replaced, put in or cut off, or nothing but pieces.
fn line(random: &mut Random) -> Vec<u8> {
    let kind = [PLAIN, random.below(8)][random.below(2)];
    let [c, t] = random.pair(kind).map(|tet| tet.map(|x| [x.x, x.y, x.z]));
    let sound =
        serde_json::json!({ "contactor": c, "target": t, "penalty_pa": random.number(7) }).to_string();
    let mut line = if random.below(8) == 0 { Vec::new() } else { sound.into_bytes() };
    for _ in 0..random.below(4) {
        let at = random.below(line.len() + 1);
        match random.below(4) {
            0 => line.truncate(at),
            1 if at < line.len() => line[at] = random.next() as u8,
            _ => {
                let piece = PIECES[random.below(PIECES.len())].bytes();
                let end = at + random.below(line.len() - at + 1).min(random.below(12));
                line.splice(at..end, piece);
            }
        }
    }
    line
}

#[test]
fn any_line_gets_numbers_or_an_error_with_its_number() {
    let mut random = Random(0x2545_F491_4F6C_DD1D);
    let mut answered = 0;
    for number in 1..=cases() {
        let line = line(&mut random);
        let answer = calculator::answer(number, &line);
        let text = String::from_utf8_lossy(&line);
        if answer["error"].is_string() {
            assert_eq!(answer["line"], number, "{text}");
            continue;
        }
        answered += 1;
        // A number that is not finite is written as null.
        let scalars = ["volume", "energy", "stiffness_offdiagonal"].map(|name| &answer[name]);
        let lists = ["force", "torque"].map(|name| &answer[name]).into_iter();
        let vectors = lists.chain(answer["nodal"].as_array().into_iter().flatten());
        let numbers = vectors.flat_map(|v| v.as_array().into_iter().flatten());
        assert_eq!(numbers.chain(scalars).filter(|v| v.is_f64()).count(), 33, "{answer} for {text}");
    }
    assert!(answered > cases() / 50, "only {answered} of {} lines had an answer", cases());
}

#[test]
fn each_kind_of_bad_line_has_its_error() {
    let tet = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
    let error = |line: &str| match calculator::answer(7, line.as_bytes()) {
        Value::Object(answer) if answer.contains_key("error") => {
            assert_eq!(answer["line"], 7);
            answer["error"].as_str().unwrap_or_default().to_owned()
        }
        answer => panic!("{line} gave {answer}"),
    };
    let pair = |c: &str, t: &str, k: &str| format!("{{\"contactor\":{c},\"target\":{t},\"penalty_pa\":{k}}}");
    assert!(error("{").contains("EOF"));
    assert!(error(&format!("[{tet},{tet},1]")).contains("not a JSON object"));
    assert!(error(&format!("{{\"contactor\":{tet},\"target\":{tet}}}")).contains("missing field"));
    assert!(error(&pair(tet, tet, "1,\"more\":0")).contains("unknown field"));
    assert!(error(&pair("[[0,0,0],[1,0,0],[0,1,0]]", tet, "1")).contains("invalid length"));
    assert!(error(&pair(tet, "[[0,0],[1,0,0],[0,1,0],[0,0,1]]", "1")).contains("invalid length"));
    error(&pair(tet, "[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,1]]", "1"));
    assert!(error(&pair(tet, tet, "1e999")).contains("out of range"));
    error(&pair(tet, tet, "NaN"));
    assert!(error(&pair(tet, "[[0,0,0],[1,0,0],[0,1,0],[1,1,0]]", "1")).contains("target is flat"));
    assert!(error(&pair(tet, tet, "0")).contains("must be positive"));
    let error = calculator::answer(3, b"{\"contactor\":\xff}")["error"].to_string();
    assert!(error.contains("not UTF-8"), "{error}");
}

#[test]
fn a_tetrahedron_whose_height_is_lost_to_rounding_has_no_integrals() {
    // Found among a million: an edge of one ulp, so two faces of zero height beside a volume that is not zero.
    let t = [
        [1.5, -4e-160, -0.5000000000000002],
        [-1e-160, -1.0, -4.0],
        [1.5, 0.0, -0.5000000000000001],
        [-4.0, 2.0, 0.5000000000000002],
    ];
    let frame = TetFrame::new(&t.map(Vec3::from));
    assert!(frame.volume_m3 != 0.0 && !frame.has_heights());
    let triangle = [[2.5, 2.0, 2.5], [2.0, 3.0, -1.5], [2.5, -3.5, -1.5]].map(Vec3::from);
    assert_eq!(pair_moments(&triangle, &triangle_area_vector(&triangle), &frame), None);
}
