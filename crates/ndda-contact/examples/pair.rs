//! Contact between two tetrahedra as a filter: one JSON object per line in, one out.
//!
//! ```text
//! cargo run --release -p ndda-contact --example pair < pairs.jsonl
//! in    {"contactor":[[x,y,z],[x,y,z],[x,y,z],[x,y,z]],"target":[…],"penalty_pa":k}
//! out   {"volume":…,"energy":…,"force":[…],"torque":[…],"nodal":[[…],… eight],"stiffness_offdiagonal":…}
//! ```
//!
//! Element potential φ = 4 min λᵢ, W = k ∫ (φ_c + φ_t) dV over the overlap. Lengths in m, k in Pa: volume [m³], energy
//! W [J], force [N] and torque [N m] on the contactor, the torque about the origin of the coordinates; nodal forces
//! ∫ N dF [N] of the contactor's corners, then of the target's, in the order in which they came. Corners may have
//! either orientation.
//!
//! `stiffness_offdiagonal` [N/m] is the largest singular value (the spectral norm) of the 3 × 3 block ∂f_c/∂x_t: the
//! change of the contactor's force when the target is shifted as a whole. φ vanishes where the other body cuts a face,
//! so only φ changes on the pieces of the surface: k Σ ∫ n ⊗ ∇φ_t dS over c's faces in t, and the same of t's in c.
//!
//! A line that has no answer gives {"line":n,"error":"…"} and the rest goes on; blank lines count and are skipped.

use std::io::{self, BufRead, Write};

use ndda_contact::reference::tet_pair::{PairForces, pair_forces};
use ndda_mesh::Vec3;
use serde::Deserialize;
use serde_json::{Value, json};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Pair {
    contactor: [[f64; 3]; 4],
    target: [[f64; 3]; 4],
    penalty_pa: f64,
}

/// The answer to one line; `number` counts from 1.
pub fn answer(number: usize, line: &[u8]) -> Value {
    let forces = read(line).and_then(|pair| {
        let [contactor, target] = [pair.contactor, pair.target].map(|corners| corners.map(Vec3::from));
        pair_forces(&contactor, &target, pair.penalty_pa).map_err(|e| e.to_string())
    });
    match forces {
        Ok(forces) => written(&forces),
        Err(error) => json!({ "line": number, "error": error }),
    }
}

fn read(line: &[u8]) -> Result<Pair, String> {
    let text = std::str::from_utf8(line).map_err(|e| format!("not UTF-8: {e}"))?;
    // Three values in a row would otherwise pass for the three fields.
    if !text.trim_start().starts_with('{') {
        return Err("not a JSON object".to_owned());
    }
    serde_json::from_str(text).map_err(|e| e.to_string())
}

fn written(forces: &PairForces) -> Value {
    let numbers = |v: &Vec3| [v.x, v.y, v.z];
    json!({
        "volume": forces.volume_m3,
        "energy": forces.energy_j,
        "force": numbers(&forces.force_n),
        "torque": numbers(&forces.torque_n_m),
        "nodal": forces.nodal_n.iter().map(numbers).collect::<Vec<_>>(),
        "stiffness_offdiagonal": forces.largest_stiffness_n_m(),
    })
}

fn main() -> io::Result<()> {
    let (mut input, mut output) = (io::stdin().lock(), io::BufWriter::new(io::stdout().lock()));
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        if input.read_until(b'\n', &mut line)? == 0 {
            break;
        }
        if line.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        if let Err(error) = writeln!(output, "{}", answer(number, &line)) {
            return quiet_if_closed(error);
        }
    }
    output.flush().or_else(quiet_if_closed)
}

/// A reader that has seen enough is no error.
fn quiet_if_closed(error: io::Error) -> io::Result<()> {
    if error.kind() == io::ErrorKind::BrokenPipe { Ok(()) } else { Err(error) }
}
