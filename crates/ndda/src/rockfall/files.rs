//! The outcome as files.

use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};

use ndda_io::{OutputFolder, WriteError, atomic};

use super::fall::{End, Fall};
use super::passage::Moment;
use super::profile::{self, Station};
use super::result::Outcome;
use super::spread::{AtLine, Spread};
use super::{Model, RockfallError, map};
use crate::documents::{is_of, write_json};
use crate::places;

/// File of the outcome in a folder.
pub fn outcome(out: &Path) -> PathBuf {
    out.join(places::ROCKFALL)
}

/// All files of an outcome.
const NAMES: [&str; 14] = [
    places::ROCKFALL,
    "boulders.csv",
    "trajectories.csv",
    "lines.csv",
    "profiles.csv",
    "reach.asc",
    "map.svg",
    "map.png",
    "reach.svg",
    "reach.png",
    "profile.svg",
    "profile.png",
    "lines.svg",
    "lines.png",
];

/// Makes the folder of an outcome and holds it until the answer is dropped; `anew` replaces an earlier outcome.
///
/// # Errors
/// The folder has an earlier outcome that is not to be replaced, or files of somebody else, is that of a run, is in use, or cannot be made.
pub fn make_folder(out: &Path, anew: bool) -> Result<Option<File>, RockfallError> {
    OutputFolder::refuse_run(out)?;
    std::fs::create_dir_all(out)
        .map_err(|source| RockfallError::Folder { folder: out.to_path_buf(), source })?;
    let held = OutputFolder::hold(out)?;
    let has_earlier = is_of(&outcome(out), "ndda.rockfall");
    OutputFolder::refuse_others(out, has_earlier, &NAMES)?;
    if has_earlier && !anew { Err(RockfallError::Earlier(out.to_path_buf())) } else { Ok(held) }
}

/// Writes all files of an outcome but pictures into a folder.
///
/// # Errors
/// [`WriteError`] of the first file that cannot be written.
pub fn write(model: &Model, outcome: &Outcome, falls: &[Fall], out: &Path) -> Result<(), WriteError> {
    write_json(&self::outcome(out), outcome)?;
    let text = |name: &str, text: String| atomic::write(&out.join(name), text.as_bytes());
    text("boulders.csv", boulders(model, falls))?;
    text("trajectories.csv", trajectories(falls))?;
    text("lines.csv", lines(model, falls))?;
    text("profiles.csv", profiles(&profile::stations(model, (&outcome.profile_m, outcome.part_m), falls)))?;
    text("reach.asc", map::esri_grid(model, &map::reach(model, falls)))
}

/// A row per boulder.
fn boulders(model: &Model, falls: &[Fall]) -> String {
    let mut text = "boulder,release,mass_kg,diameter_m,end,time_s,runout_m,start_x_m,start_y_m,start_z_m,end_x_m,end_y_m,end_z_m,\
                    largest_speed_m_s,largest_energy_j,largest_height_m,steps,energy_error,friction_error,depth_ratio\n"
        .to_string();
    for fall in falls {
        let end = match &fall.end {
            End::Rest => "rest",
            End::LeftTerrain => "left_terrain",
            End::StillMoving => "still_moving",
            End::Stopped(_) => "stopped",
        };
        let place = |moment: Option<&Moment>| moment.map_or([f64::NAN; 3], |moment| moment.at_m);
        let ([sx, sy, sz], [ex, ey, ez]) = (place(fall.path.first()), place(fall.path.last()));
        let time_s = fall.path.last().map_or(0.0, |moment| moment.time_s);
        let release = &model.rockfall.releases[fall.release].name;
        let _ = writeln!(
            text,
            "{},{release},{:.6e},{:.6e},{end},{time_s:.4},{:.4},{sx:.4},{sy:.4},{sz:.4},{ex:.4},{ey:.4},{ez:.4},{:.6e},{:.6e},{:.6e},{},{:.3e},{:.3e},{:.3e}",
            fall.boulder,
            fall.mass_kg,
            fall.diameter_m,
            map::runout_m(fall),
            fall.largest.speed_m_s,
            fall.largest.energy_j,
            fall.largest.height_m,
            fall.steps,
            fall.accuracy.energy,
            fall.accuracy.friction,
            fall.accuracy.depth
        );
    }
    text
}

/// The columns of a moment.
const MOMENT: &str = "time_s,x_m,y_m,z_m,velocity_x_m_s,velocity_y_m_s,velocity_z_m_s,speed_m_s,translation_j,rotation_j,height_m,top_m";

fn moment(m: &Moment) -> String {
    let ([x, y, z], [vx, vy, vz]) = (m.at_m, m.velocity_m_s);
    format!(
        "{:.4},{x:.4},{y:.4},{z:.4},{vx:.5e},{vy:.5e},{vz:.5e},{:.5e},{:.5e},{:.5e},{:.4},{:.4}",
        m.time_s,
        m.speed_m_s(),
        m.translation_j,
        m.rotation_j,
        m.height_m,
        m.top_m
    )
}

/// A row per point of a path.
fn trajectories(falls: &[Fall]) -> String {
    let mut text = format!("boulder,{MOMENT}\n");
    for fall in falls {
        for point in &fall.path {
            let _ = writeln!(text, "{},{}", fall.boulder, moment(point));
        }
    }
    text
}

/// A row per passage of a line, boulder by boulder.
fn lines(model: &Model, falls: &[Fall]) -> String {
    let mut text = format!("line,boulder,mass_kg,{MOMENT}\n");
    for fall in falls {
        for (line, at) in &fall.passages {
            let name = &model.rockfall.lines[*line].name;
            let _ = writeln!(text, "{name},{},{:.6e},{}", fall.boulder, fall.mass_kg, moment(at));
        }
    }
    text
}

/// A row per station; cells are empty where no boulder passed.
fn profiles(stations: &[Station]) -> String {
    let quantities = ["height_m", "top_m", "speed_m_s", "energy_j", "rotation_j"];
    let columns = quantities.map(|of| format!(",{of}_median,{of}_95,{of}_largest"));
    let mut text = format!("chainage_m,ground_m,passed{}\n", columns.concat());
    for station in stations {
        let ground = station.ground_m.map_or_else(String::new, |z| format!("{z:.4}"));
        let _ = write!(text, "{:.4},{ground},{}", station.chainage_m, station.passed);
        match &station.first {
            None => text.push_str(&",".repeat(3 * quantities.len())),
            Some(AtLine { height_m, top_m, speed_m_s, energy_j, rotation_j }) => {
                for Spread { median, percentile_95, largest } in
                    [height_m, top_m, speed_m_s, energy_j, rotation_j]
                {
                    let _ = write!(text, ",{median:.5e},{percentile_95:.5e},{largest:.5e}");
                }
            }
        }
        text.push('\n');
    }
    text
}
