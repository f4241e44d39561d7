//! Contact between two tetrahedra as a filter: one JSON object per line in, one out.
//!
//! ```text
//! cargo run --release -p ndda-contact --example pair < pairs.jsonl
//! in    {"contactor":[[x,y,z],[x,y,z],[x,y,z],[x,y,z]],"target":[…],"penalty_pa":k}
//! out   {"volume":…,"energy":…,"force":[…],"torque":[…],"nodal":[[…],… eight],"stiffness_offdiagonal":…}
//! ```
//!
//! Element potential φ = 4 min λᵢ; force and torque (about the origin) on the contactor; nodal forces ∫ N dF of the
//! contactor's corners, then of the target's. `stiffness_offdiagonal` is the largest singular value of ∂f/∂x_t, the
//! change of the contactor's force with a shift of the target [N/m]. A line that has no answer gives
//! {"line":n,"error":"…"} and the rest goes on; blank lines are skipped.

use std::io::{self, BufRead, Write};

use ndda_contact::tet_pair::{PairForces, pair_forces};
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
fn answer(number: usize, line: &[u8]) -> Value {
    let text = std::str::from_utf8(line).map_err(|e| format!("not UTF-8: {e}"));
    let pair = text.and_then(|text| serde_json::from_str::<Pair>(text).map_err(|e| e.to_string()));
    let forces = pair.and_then(|pair| {
        let [contactor, target] = [pair.contactor, pair.target].map(|corners| corners.map(Vec3::from));
        pair_forces(&contactor, &target, pair.penalty_pa).map_err(|e| e.to_string())
    });
    match forces {
        Ok(forces) => written(&forces),
        Err(error) => json!({ "line": number, "error": error }),
    }
}

fn written(forces: &PairForces) -> Value {
    let numbers = |v: &Vec3| [v.x, v.y, v.z];
    json!({
        "volume": forces.volume_m3,
        "energy": forces.energy_j,
        "force": numbers(&forces.force_n),
        "torque": numbers(&forces.torque_n_m),
        "nodal": forces.nodal_n.iter().map(numbers).collect::<Vec<_>>(),
        "stiffness_offdiagonal": forces.stiffness_n_m.singular_values().max(),
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
