//! Damaged and hostile inputs of a rockfall: files of terrain and of classes, and numbers of the scene. Each is refused with the file and what is wrong, or it is
//! harmless; none makes the program panic.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use ndda::rockfall::{Model, map};
use ndda_io::mesh::terrain_grid::TerrainGrid;
use ndda_io::read;

const COLUMNS: usize = 9;
const ROWS: usize = 7;
const CELL_M: f64 = 10.0;

fn height_m(i: usize, j: usize) -> f64 {
    60.0 - 5.0 * i as f64 + 0.25 * ((i * 7 + j * 5) % 4) as f64
}

/// An ESRI ASCII grid of numbers.
fn esri(number: impl Fn(usize, usize) -> f64) -> String {
    let mut text = format!(
        "ncols {COLUMNS}\nnrows {ROWS}\nxllcenter 0\nyllcenter 0\ncellsize {CELL_M}\nNODATA_value -9999\n"
    );
    for j in (0..ROWS).rev() {
        let row: Vec<String> = (0..COLUMNS).map(|i| number(i, j).to_string()).collect();
        text += &(row.join(" ") + "\n");
    }
    text
}

fn points() -> String {
    let point = |k: usize| {
        let (i, j) = (k % COLUMNS, k / COLUMNS);
        format!("{} {} {}\n", CELL_M * i as f64, CELL_M * j as f64, height_m(i, j))
    };
    "x y z\n".to_string() + &(0..COLUMNS * ROWS).map(point).collect::<String>()
}

/// Corners of the two triangles of each cell.
fn triangles() -> Vec<[[f64; 3]; 3]> {
    let corner = |i: usize, j: usize| [CELL_M * i as f64, CELL_M * j as f64, height_m(i, j)];
    let cells = (0..ROWS - 1).flat_map(|j| (0..COLUMNS - 1).map(move |i| (i, j)));
    let of_cell = |(i, j): (usize, usize)| {
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        [[a, b, c], [a, c, d]]
    };
    cells.flat_map(of_cell).collect()
}

fn stl_text() -> String {
    let vertex = |[x, y, z]: [f64; 3]| format!("vertex {x} {y} {z}\n");
    let facet = |corners: [[f64; 3]; 3]| {
        format!("facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n", corners.map(vertex).concat())
    };
    format!("solid ground\n{}endsolid ground\n", triangles().into_iter().map(facet).collect::<String>())
}

fn stl_bytes() -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles().len() as u32).to_le_bytes());
    for corners in triangles() {
        let numbers = [0.0, 0.0, 1.0].into_iter().chain(corners.into_iter().flatten());
        numbers.for_each(|x| bytes.extend((x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// A GeoTIFF of numbers of 32 bits in one strip.
fn geotiff() -> Vec<u8> {
    const TAIL: u32 = 8 + 2 + 12 * 11 + 4;
    let (at_scale, at_tie, at_data) = (TAIL, TAIL + 24, TAIL + 72);
    let count = (COLUMNS * ROWS) as u32;
    // Tag, type (2 text, 3 and 4 whole numbers, 12 numbers of 64 bits), count, and value or place.
    let entries: [(u16, u16, u32, u32); 11] = [
        (256, 3, 1, COLUMNS as u32),
        (257, 3, 1, ROWS as u32),
        (258, 3, 1, 32),
        (259, 3, 1, 1),
        (273, 4, 1, at_data),
        (277, 3, 1, 1),
        (278, 3, 1, ROWS as u32),
        (279, 4, 1, 4 * count),
        (339, 3, 1, 3),
        (33550, 12, 3, at_scale),
        (33922, 12, 6, at_tie),
    ];
    let mut bytes = b"II\x2a\x00\x08\x00\x00\x00".to_vec();
    bytes.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, count, value) in entries {
        [tag, kind].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        [count, value].iter().for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    bytes.resize(TAIL as usize, 0);
    let (north, west) = (CELL_M * (ROWS as f64 - 0.5), -0.5 * CELL_M);
    for number in [CELL_M, CELL_M, 0.0, 0.0, 0.0, 0.0, west, north, 0.0] {
        bytes.extend(number.to_le_bytes());
    }
    for j in (0..ROWS).rev() {
        (0..COLUMNS).for_each(|i| bytes.extend((height_m(i, j) as f32).to_le_bytes()));
    }
    bytes
}

/// A scene of one boulder on terrain from a file.
fn scene(file: &str) -> String {
    format!(
        "(title: \"rockfall\", gravity_m_s2: (0, 0, -9.81), time: (end_s: 1),
          materials: [(name: \"rock\", density_kg_m3: 2700, young_pa: 50e9, poisson: 0.25)],
          rockfall: (
            terrain: File(file: \"{file}\"), class_grid: \"classes.asc\",
            ground: (restitution: Normal(0.4, 0.05), friction_deg: Uniform(30, 36)),
            zones: [(name: \"talus\", classes: [2, 3], restitution: Always(0.3), friction_deg: Triangular(30, 34, 38)),
                    (name: \"road\", outline_m: [(60, 0), (75, 0), (75, 60)], restitution: Always(0.4), friction_deg: LogNormal(31, 2))],
            boulders: (material: \"rock\", size: Diameter(diameter_m: LogNormal(0.9, 0.35)), within: (0.4, 2.5)),
            releases: [(name: \"cliff\", place: Line([(12, 20), (12, 40)]), height_m: Uniform(0.2, 2), speed_m_s: Uniform(0, 2), azimuth_deg: Normal(90, 10))],
            count: 1, seed: 3,
            lines: [(name: \"barrier\", points_m: [(50, 0), (50, 60)])],
          ))"
    )
}

/// What became of a scene: nothing where its boulder has fallen, else the error.
fn outcome(text: &str, folder: &Path) -> Result<(), String> {
    let run = || {
        let loaded = read::load_text("rockfall.ron", text, &[], Some(folder));
        let loaded = loaded.map_err(|errors| errors.render(false))?;
        let model = Model::new(loaded, folder, (Some(1), None)).map_err(|error| error.to_string())?;
        let _ = model.to_string();
        let fall = model.fall(0);
        let places = fall.path.iter().flat_map(|moment| moment.at_m);
        assert!(places.into_iter().all(f64::is_finite), "a path is not finite");
        Ok(())
    };
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| panic!("{text}"))
}

/// Numbers that are the same in every run (xorshift of Marsaglia).
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % most as u64) as usize
    }
}

/// A folder with undamaged classes.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("classes.asc"), esri(|i, _| (1 + i / 3) as f64)).unwrap();
    folder
}

/// Whether an error names the file, or says that a release or a boulder has no place on the terrain that it gives.
fn names(error: &str, file: &str) -> bool {
    error.contains(file)
        || ["the terrain, x from", "the end of the terrain", "is nowhere on the terrain"]
            .iter()
            .any(|part| error.contains(part))
}

/// Damages a file in many ways: whatever is refused names the file.
fn damaged(file: &str, whole: &[u8]) {
    let folder = folder();
    let path = folder.path().join(file);
    fs::write(&path, whole).unwrap();
    outcome(&scene(file), folder.path()).unwrap_or_else(|error| panic!("{file} undamaged: {error}"));
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let truncated = (0..20).map(|part| whole[..whole.len() * part / 20].to_vec());
    let mut changed = |count: usize| {
        let mut bytes = whole.to_vec();
        for _ in 0..count {
            let place = random.below(bytes.len());
            bytes[place] = random.below(256) as u8;
        }
        bytes
    };
    let changed: Vec<Vec<u8>> = (0..40).map(|k| changed(1 + k % 3)).collect();
    let mut refused = 0;
    for bytes in truncated.chain(changed) {
        fs::write(&path, &bytes).unwrap();
        if let Err(error) = outcome(&scene(file), folder.path()) {
            assert!(names(&error, file), "{error}");
            refused += 1;
        }
    }
    // A file that is cut off is never taken for a whole one.
    assert!(refused >= 18, "{refused} refused");
}

#[test]
fn damaged_terrain_is_refused_by_its_name_whatever_its_format() {
    damaged("ground.asc", esri(height_m).as_bytes());
    damaged("ground.xyz", points().as_bytes());
    damaged("ground.tif", &geotiff());
    damaged("ascii.stl", stl_text().as_bytes());
    damaged("binary.stl", &stl_bytes());
}

#[test]
fn the_map_of_reach_is_in_the_coordinates_of_the_terrains_file() {
    let folder = folder();
    // The south-eastern height is missing, and its cell with it; the corner of the grid is (500 000, 200 000).
    let grid = esri(|i, j| if (i, j) == (COLUMNS - 1, 0) { -9999.0 } else { height_m(i, j) });
    let grid = grid.replace("xllcenter 0", "xllcorner 500000").replace("yllcenter 0", "yllcorner 200000");
    fs::write(folder.path().join("ground.asc"), grid).unwrap();
    let text = scene("ground.asc").replace("class_grid: \"classes.asc\",", "");
    let zones = text.find("zones: [").unwrap()..text.find("boulders: (").unwrap();
    let text =
        text.replace(&text[zones], "").replace("ground.asc\")", "ground.asc\", origin_m: (500000, 200000))");
    let loaded = read::load_text("rockfall.ron", &text, &[], Some(folder.path())).unwrap();
    let model = Model::new(loaded, folder.path(), (Some(1), None)).unwrap();
    let falls = [model.fall(0)];
    let written = map::esri_grid(&model, &map::reach(&model, &falls));
    // Reach is counted between heights, the first of which is half a cell from the corner.
    let path = folder.path().join("reach.asc");
    fs::write(&path, &written).unwrap();
    let read = TerrainGrid::read(&path, None).unwrap();
    assert_eq!(read.origin_m, [500_010.0, 200_010.0]);
    assert_eq!((read.heights_m.len(), read.heights_m[0].len()), (ROWS - 1, COLUMNS - 1));
    assert_eq!(read.heights_m[0][COLUMNS - 2], None, "{written}");
    let known = read.heights_m.iter().flatten().filter_map(|part| *part);
    assert_eq!(known.clone().count(), (ROWS - 1) * (COLUMNS - 1) - 1);
    // Cells that were not reached are zero, and the boulder was where it was released.
    assert!(known.clone().any(|part| part == 0.0) && known.clone().all(|part| part == 0.0 || part == 1.0));
    let [x, y, _] = falls[0].path[0].at_m;
    let cell = [x, y].map(|at| ((at - 0.5 * CELL_M) / CELL_M).floor() as usize);
    assert_eq!(read.heights_m[cell[1]][cell[0]], Some(1.0));
}

/// Words in the place of numbers, and whether each is refused with its line wherever it stands.
const HOSTILE: [(&str, bool); 12] = [
    ("nan", true),
    ("inf", true),
    ("1e400", true),
    ("x", true),
    ("1,5", false),
    ("-1", false),
    ("0", false),
    ("1e308", false),
    ("-1e308", false),
    ("1e-308", false),
    ("1e18", false),
    ("99999999999999999999", false),
];

#[test]
fn hostile_numbers_in_grids_and_points_are_refused_with_their_line() {
    for (file, whole, class_grid) in [
        ("ground.asc", esri(height_m), false),
        ("ground.xyz", points(), false),
        ("classes.asc", esri(|i, _| (1 + i / 3) as f64), true),
    ] {
        let folder = folder();
        fs::write(folder.path().join("ground.asc"), esri(height_m)).unwrap();
        let text = scene(if class_grid { "ground.asc" } else { file });
        let lines: Vec<&str> = whole.lines().collect();
        // All lines of a header, and some of numbers.
        for number in (0..lines.len()).filter(|k| *k < 7 || k % 23 == 0) {
            let words: Vec<&str> = lines[number].split_whitespace().collect();
            let Some(place) = words.iter().rposition(|word| word.parse::<f64>().is_ok()) else { continue };
            for (hostile, is_refused) in HOSTILE {
                let mut words = words.clone();
                words[place] = hostile;
                let mut lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
                lines[number] = words.join(" ");
                fs::write(folder.path().join(file), lines.join("\n")).unwrap();
                let ended = outcome(&text, folder.path());
                // Any number may say that a height is missing, also one that is not finite.
                let is_refused = is_refused && !(hostile != "x" && lines[number].starts_with("NODATA"));
                match ended {
                    Ok(()) => assert!(!is_refused, "{file}:{}: {hostile} is taken", number + 1),
                    Err(error) => assert!(
                        names(&error, file)
                            && (!is_refused || error.contains(&format!("{file}:{}", number + 1))),
                        "{file}:{}: {hostile}: {error}",
                        number + 1
                    ),
                }
            }
        }
    }
}

#[test]
fn hostile_numbers_in_the_scene_are_refused_at_their_place_or_harmless() {
    let folder = folder();
    fs::write(folder.path().join("ground.asc"), esri(height_m)).unwrap();
    let whole = scene("ground.asc");
    let is_part = |byte: u8| byte.is_ascii_digit() || byte == b'.' || byte == b'-';
    let bytes = whole.as_bytes();
    let mut from = whole.find("rockfall: (").unwrap();
    while let Some(start) = (from..bytes.len()).find(|&k| is_part(bytes[k])) {
        let end = (start..bytes.len()).find(|&k| !is_part(bytes[k])).unwrap_or(bytes.len());
        from = end;
        // Names have digits, too.
        if bytes[start - 1].is_ascii_alphanumeric() || bytes[start - 1] == b'_' || &whole[start..end] == "." {
            continue;
        }
        for hostile in ["NaN", "-1", "0", "1e-30", "1e30", "-1e300"] {
            let text = format!("{}{hostile}{}", &whole[..start], &whole[end..]);
            if let Err(error) = outcome(&text, folder.path()) {
                assert!(error.contains("rockfall.ron:"), "{hostile} for {}: {error}", &whole[start..end]);
            }
        }
    }
}
