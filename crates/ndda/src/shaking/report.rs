//! What there is to know of a record, in words and tables.

use std::fmt::Write;

use ndda_io::{WriteError, atomic};

use super::{Motion, Response, Shaking};

/// Periods that are told [s].
const TOLD_S: [f64; 6] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0];

/// A record in words.
pub fn tell(shaking: &Shaking) -> String {
    let Shaking { measures: m, .. } = shaking;
    let mut out = format!("{}\n", shaking.record);
    let mut line = |text: String| writeln!(out, "{text}").expect("a string takes all");
    let peak = |name: &str, peak: super::measures::Peak, unit: &str| {
        format!("  peak {name:<13} {:>10.4} {unit:<5} at {:.3} s", peak.value, peak.time_s)
    };
    line(peak("acceleration", m.peak_acceleration_m_s2, "m/s²"));
    line(peak("velocity", m.peak_velocity_m_s, "m/s"));
    line(peak("displacement", m.peak_displacement_m, "m"));
    line(format!("  velocity left at the end {:.4} m/s", m.last_velocity_m_s));
    line(format!("  Arias intensity {:.4} m/s, 5 % to 95 % of it within {:.3} s", m.arias_m_s, m.duration_s));
    line(format!("  pseudo-acceleration at {:.3} of critical damping:", shaking.damping));
    for told_s in TOLD_S {
        let nearest = shaking.spectrum.iter().min_by(|a, b| off(a, told_s).total_cmp(&off(b, told_s)));
        if let Some(response) = nearest {
            line(format!(
                "    {:>6.3} s {:>10.4} m/s²",
                response.period_s, response.pseudo_acceleration_m_s2
            ));
        }
    }
    if let Some(slips) = &shaking.slip {
        for (slip, which) in slips.iter().zip(["as it is", "turned round"]) {
            let rests = slip.rests_s.map_or("never slides".into(), |s| format!("at rest from {s:.4} s on"));
            line(format!(
                "  slip of a block, record {which:<12} {:>10.5} m at the end, {:.5} m at most, {rests}",
                slip.last_m, slip.farthest_m
            ));
        }
    }
    shaking.picture.iter().for_each(|picture| line(format!("  picture {}", picture.display())));
    let [motion, spectrum] = &shaking.tables;
    line(format!("  tables {} and {}", motion.display(), spectrum.display()));
    out.trim_end().to_string()
}

/// How far a period is from another, by their ratio.
fn off(response: &Response, period_s: f64) -> f64 {
    (response.period_s / period_s).ln().abs()
}

/// Writes motion and spectrum as CSV.
pub(super) fn write_tables(shaking: &Shaking, motion: &Motion) -> Result<(), WriteError> {
    let mut text = String::from("time_s,acceleration_m_s2,velocity_m_s,displacement_m\n");
    for (i, time_s) in motion.time_s.iter().enumerate() {
        let (a, v, u) = (motion.acceleration[i], motion.velocity[i], motion.displacement[i]);
        writeln!(text, "{time_s},{a},{v},{u}").expect("a string takes all");
    }
    atomic::write_named(&shaking.tables[0], text.as_bytes())?;
    let mut text = String::from("period_s,displacement_m,pseudo_velocity_m_s,pseudo_acceleration_m_s2\n");
    for r in &shaking.spectrum {
        let values = (r.period_s, r.displacement_m, r.pseudo_velocity_m_s, r.pseudo_acceleration_m_s2);
        writeln!(text, "{},{},{},{}", values.0, values.1, values.2, values.3).expect("a string takes all");
    }
    atomic::write_named(&shaking.tables[1], text.as_bytes())
}
