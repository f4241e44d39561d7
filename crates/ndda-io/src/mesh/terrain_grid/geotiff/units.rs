//! Whether heights and places of a GeoTIFF are in metres, by its keys and by what GDAL writes beside them.

use crate::mesh::error::Fault;

use super::not_read;

/// Keys of GeoTIFF: kind of coordinates, map grid, its unit of length, heights, their unit.
const MODEL_TYPE: u64 = 1024;
const MAP_GRID: u64 = 3072;
const LINEAR_UNITS: u64 = 3076;
const HEIGHTS: u64 = 4096;
const HEIGHT_UNITS: u64 = 4099;
const GEOGRAPHIC: u64 = 2;
const METRE: u64 = 9001;

/// Codes of heights in feet (EPSG 11.022).
const HEIGHTS_IN_FEET: [u64; 15] =
    [5614, 5702, 5754, 6130, 6131, 6132, 6358, 6359, 6360, 8050, 8051, 8052, 8053, 8228, 8897];

const PROJECT: &str =
    "reproject it to metres, as with gdalwarp -t_srs EPSG:32632 (take the code of your map grid)";
const SCALE: &str = "multiply its heights by the unit, 0.3048 m for feet, as with gdal_translate -scale 0 1 0 0.3048 -ot Float32, \
                     and save it without that unit";
const UNSCALE: &str =
    "write out the heights themselves in metres, as with gdal_translate -unscale -ot Float32";

/// Refuses what is not in metres; `key` gives the value of a key, and `metadata` is the XML of GDAL.
pub(super) fn are_metres(key: &dyn Fn(u64) -> Option<u64>, metadata: Option<&str>) -> Result<(), Fault> {
    if key(MODEL_TYPE) == Some(GEOGRAPHIC) {
        return Err(not_read("a grid in degrees", PROJECT));
    }
    if let Some(unit) = key(LINEAR_UNITS).filter(|unit| *unit != METRE) {
        return Err(not_read(format!("a grid in the unit of EPSG {unit}{}", name(unit)), PROJECT));
    }
    if let Some(grid) = key(MAP_GRID).filter(|grid| is_of_another_unit(*grid)) {
        return Err(not_read(format!("the map grid EPSG {grid}, which is not in metres,"), PROJECT));
    }
    if let Some(unit) = key(HEIGHT_UNITS).filter(|unit| *unit != METRE) {
        return Err(not_read(format!("a grid with heights in the unit of EPSG {unit}{}", name(unit)), SCALE));
    }
    if let Some(heights) = key(HEIGHTS).filter(|heights| HEIGHTS_IN_FEET.contains(heights)) {
        return Err(not_read(format!("a grid with heights of EPSG {heights}, which are in feet,"), SCALE));
    }
    let item = |role: &str| metadata.and_then(|xml| item(xml, role));
    for (role, plain) in [("scale", 1.0), ("offset", 0.0)] {
        let Some(text) = item(role).filter(|text| text.parse() != Ok(plain)) else { continue };
        return Err(not_read(format!("a grid of numbers with the {role} {text}"), UNSCALE));
    }
    let is_metre = |unit: &str| unit.is_empty() || unit == "m" || unit.to_lowercase().starts_with("met");
    match item("unittype").filter(|unit| !is_metre(unit)) {
        Some(unit) => Err(not_read(format!("a grid with heights in `{unit}`"), SCALE)),
        None => Ok(()),
    }
}

fn name(unit: u64) -> &'static str {
    match unit {
        9002 => " (feet)",
        9003 => " (feet of the US survey)",
        _ => "",
    }
}

/// The text of the first item of GDAL's metadata that has a role.
fn item<'a>(xml: &'a str, role: &str) -> Option<&'a str> {
    let has_role = |item: &&str| {
        let attributes = item.split('>').next().unwrap_or_default();
        attributes.contains(&format!("role=\"{role}\""))
    };
    let item = xml.split("<Item").skip(1).find(has_role)?;
    Some(item.split('>').nth(1)?.split('<').next().unwrap_or_default().trim())
}

/// Whether a map grid is not in metres.
fn is_of_another_unit(grid: u64) -> bool {
    NOT_METRES.partition_point(|code| u64::from(*code) <= grid) % 2 == 1
}

/// Codes of map grids whose unit differs from the metre by more than a thousandth, nearly all of them feet (EPSG 11.022): the first of codes in a row, the
/// first after them, and so on.
#[rustfmt::skip]
const NOT_METRES: [u16; 920] = [
    2066, 2067, 2136, 2137, 2155, 2156, 2159, 2161, 2194, 2195, 2204, 2205, 2222, 2290, 2314, 2315,
    2867, 2931, 2964, 2969, 2992, 2993, 2994, 2995, 3080, 3081, 3089, 3090, 3091, 3092, 3102, 3103,
    3139, 3141, 3167, 3168, 3359, 3360, 3361, 3362, 3363, 3364, 3365, 3366, 3404, 3405, 3407, 3408,
    3417, 3439, 3441, 3447, 3451, 3460, 3479, 3480, 3481, 3482, 3483, 3484, 3485, 3486, 3487, 3488,
    3490, 3491, 3492, 3493, 3494, 3495, 3496, 3497, 3498, 3499, 3500, 3501, 3502, 3503, 3504, 3505,
    3506, 3507, 3508, 3509, 3510, 3511, 3512, 3513, 3515, 3516, 3517, 3518, 3519, 3520, 3521, 3522,
    3523, 3524, 3525, 3526, 3527, 3528, 3529, 3530, 3531, 3532, 3533, 3534, 3535, 3536, 3537, 3538,
    3539, 3540, 3541, 3542, 3543, 3544, 3545, 3546, 3547, 3548, 3549, 3550, 3551, 3552, 3553, 3554,
    3560, 3571, 3582, 3583, 3584, 3585, 3586, 3587, 3588, 3589, 3590, 3591, 3593, 3594, 3598, 3599,
    3600, 3601, 3605, 3606, 3608, 3609, 3610, 3611, 3612, 3613, 3614, 3615, 3616, 3617, 3618, 3619,
    3620, 3621, 3622, 3623, 3624, 3625, 3626, 3627, 3628, 3629, 3630, 3631, 3632, 3633, 3634, 3635,
    3636, 3637, 3640, 3641, 3642, 3643, 3644, 3645, 3646, 3647, 3648, 3649, 3650, 3651, 3652, 3653,
    3654, 3655, 3656, 3657, 3658, 3659, 3660, 3661, 3662, 3663, 3664, 3665, 3668, 3669, 3670, 3671,
    3672, 3673, 3674, 3675, 3676, 3678, 3679, 3681, 3682, 3684, 3686, 3687, 3688, 3689, 3690, 3691,
    3692, 3693, 3696, 3697, 3698, 3699, 3700, 3701, 3728, 3740, 3753, 3761, 3991, 3993, 4217, 4218,
    4399, 4414, 4418, 4434, 4438, 4440, 4455, 4458, 5472, 5473, 5588, 5590, 5623, 5626, 5646, 5647,
    5654, 5656, 6128, 6130, 6141, 6142, 6200, 6203, 6391, 6392, 6405, 6406, 6407, 6408, 6409, 6410,
    6411, 6412, 6413, 6414, 6416, 6417, 6418, 6419, 6420, 6421, 6422, 6423, 6424, 6425, 6426, 6427,
    6428, 6429, 6430, 6431, 6432, 6433, 6434, 6435, 6436, 6437, 6438, 6439, 6441, 6442, 6443, 6444,
    6445, 6446, 6447, 6448, 6449, 6450, 6451, 6452, 6453, 6454, 6455, 6456, 6457, 6458, 6459, 6460,
    6461, 6462, 6463, 6464, 6465, 6466, 6467, 6468, 6469, 6470, 6471, 6472, 6473, 6474, 6475, 6476,
    6477, 6478, 6479, 6480, 6484, 6485, 6486, 6487, 6488, 6489, 6490, 6491, 6492, 6493, 6494, 6495,
    6496, 6497, 6499, 6500, 6501, 6502, 6503, 6504, 6505, 6506, 6507, 6508, 6510, 6511, 6515, 6516,
    6517, 6518, 6519, 6520, 6521, 6522, 6523, 6524, 6525, 6526, 6527, 6528, 6529, 6530, 6531, 6532,
    6533, 6534, 6535, 6536, 6537, 6538, 6539, 6540, 6541, 6542, 6543, 6544, 6545, 6546, 6547, 6548,
    6549, 6550, 6551, 6552, 6553, 6554, 6555, 6556, 6557, 6558, 6559, 6560, 6561, 6562, 6563, 6564,
    6565, 6566, 6568, 6569, 6570, 6571, 6572, 6573, 6574, 6575, 6576, 6577, 6578, 6579, 6582, 6583,
    6584, 6585, 6586, 6587, 6588, 6589, 6590, 6591, 6593, 6594, 6595, 6596, 6597, 6598, 6599, 6600,
    6601, 6602, 6603, 6604, 6605, 6606, 6607, 6608, 6609, 6610, 6612, 6613, 6614, 6615, 6616, 6617,
    6618, 6619, 6625, 6628, 6633, 6634, 6785, 6786, 6787, 6788, 6789, 6790, 6791, 6792, 6793, 6794,
    6795, 6796, 6797, 6798, 6799, 6800, 6801, 6802, 6803, 6804, 6805, 6806, 6807, 6808, 6809, 6810,
    6811, 6812, 6813, 6814, 6815, 6816, 6817, 6818, 6819, 6820, 6821, 6822, 6823, 6824, 6825, 6826,
    6827, 6828, 6829, 6830, 6831, 6832, 6833, 6834, 6835, 6836, 6837, 6838, 6839, 6840, 6841, 6842,
    6843, 6844, 6845, 6846, 6847, 6848, 6849, 6850, 6851, 6852, 6853, 6854, 6855, 6856, 6857, 6858,
    6859, 6860, 6861, 6862, 6863, 6864, 6868, 6869, 6880, 6881, 6885, 6886, 6887, 6888, 6923, 6924,
    6925, 6926, 6966, 6967, 6997, 6998, 7057, 7071, 7119, 7129, 7132, 7133, 7258, 7259, 7260, 7261,
    7262, 7263, 7264, 7265, 7266, 7267, 7268, 7269, 7270, 7271, 7272, 7273, 7274, 7275, 7276, 7277,
    7278, 7279, 7280, 7281, 7282, 7283, 7284, 7285, 7286, 7287, 7288, 7289, 7290, 7291, 7292, 7293,
    7294, 7295, 7296, 7297, 7298, 7299, 7300, 7301, 7302, 7303, 7304, 7305, 7306, 7307, 7308, 7309,
    7310, 7311, 7312, 7313, 7314, 7315, 7316, 7317, 7318, 7319, 7320, 7321, 7322, 7323, 7324, 7325,
    7326, 7327, 7328, 7329, 7330, 7331, 7332, 7333, 7334, 7335, 7336, 7337, 7338, 7339, 7340, 7341,
    7342, 7343, 7344, 7345, 7346, 7347, 7348, 7349, 7350, 7351, 7352, 7353, 7354, 7355, 7356, 7357,
    7358, 7359, 7360, 7361, 7362, 7363, 7364, 7365, 7366, 7367, 7368, 7369, 7370, 7371, 7587, 7646,
    8035, 8037, 8065, 8069, 8091, 8092, 8093, 8094, 8096, 8097, 8098, 8099, 8100, 8101, 8102, 8103,
    8104, 8105, 8106, 8107, 8108, 8109, 8110, 8111, 8112, 8113, 8114, 8115, 8116, 8117, 8118, 8119,
    8120, 8121, 8122, 8123, 8124, 8125, 8126, 8127, 8128, 8129, 8130, 8131, 8132, 8133, 8134, 8135,
    8136, 8137, 8138, 8139, 8140, 8141, 8142, 8143, 8144, 8145, 8146, 8147, 8148, 8149, 8150, 8151,
    8152, 8153, 8154, 8155, 8156, 8157, 8158, 8159, 8160, 8161, 8162, 8163, 8164, 8165, 8166, 8167,
    8168, 8169, 8170, 8171, 8172, 8173, 8177, 8178, 8180, 8181, 8182, 8183, 8185, 8186, 8189, 8190,
    8193, 8194, 8197, 8198, 8200, 8201, 8202, 8203, 8204, 8205, 8206, 8207, 8208, 8209, 8210, 8211,
    8213, 8214, 8216, 8217, 8220, 8221, 8224, 8225, 8226, 8227, 8312, 8313, 8314, 8315, 8316, 8317,
    8318, 8319, 8320, 8321, 8322, 8323, 8324, 8325, 8326, 8327, 8328, 8329, 8330, 8331, 8332, 8333,
    8334, 8335, 8336, 8337, 8338, 8339, 8340, 8341, 8342, 8343, 8344, 8345, 8346, 8347, 8348, 8349,
    8380, 8381, 8382, 8383, 8384, 8385, 8387, 8388, 8518, 8530, 8531, 8532, 8533, 8537, 8538, 8541,
    9748, 9750, 10481, 10482, 10516, 10517, 10622, 10623, 20050, 20051, 22300, 22301, 23301, 23334,
    24100, 24101, 24370, 24375, 24382, 24383, 24571, 24572, 26729, 26761, 26766, 26788, 26791,
    26800, 26801, 26804, 26811, 26814, 26847, 26871, 27291, 27293, 29871, 29873, 30200, 30201,
    32001, 32004, 32005, 32032, 32033, 32059, 32064, 32068, 32074, 32078, 32099, 32100, 32164,
    32168, 32664, 32668,
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn said(keys: &[(u64, u64)], metadata: &str) -> String {
        let key = |id| keys.iter().find(|(key, _)| *key == id).map(|(_, value)| *value);
        let found = are_metres(&key, Some(metadata)).err();
        found.map_or_else(String::new, |fault| fault.of(Path::new("a.tif")).to_string())
    }

    #[test]
    fn grids_and_heights_in_other_units_are_refused_with_a_cure() {
        for (key, value, part) in [
            (1024, 2, "a grid in degrees"),
            (3076, 9003, "EPSG 9003 (feet of the US survey) is not supported: reproject"),
            (3072, 2232, "the map grid EPSG 2232, which is not in metres, is not supported: reproject"),
            (4099, 9002, "heights in the unit of EPSG 9002 (feet) is not supported: multiply"),
            (4096, 6360, "in feet"),
        ] {
            assert!(said(&[(key, value)], "").contains(part), "{}", said(&[(key, value)], ""));
        }
        assert_eq!(said(&[(1024, 1), (3072, 32632), (3076, 9001), (4096, 5703), (4099, 9001)], ""), "");
        let item = |role: &str, text: &str| {
            let xml = "<GDALMetadata><Item name=\"A\">7</Item>\n<Item name=\"B\" sample=\"0\" role=";
            said(&[], &format!("{xml}\"{role}\">{text}</Item></GDALMetadata>"))
        };
        assert!(item("scale", "0.1").contains("the scale 0.1 is not supported: write out"));
        assert!(item("offset", "100").contains("the offset 100"));
        assert!(item("unittype", "us-ft").contains("heights in `us-ft`"));
        for (role, text) in [("scale", "1"), ("offset", "0.0"), ("unittype", "metre"), ("colour", "2")] {
            assert_eq!(item(role, text), "");
        }
    }

    #[test]
    fn map_grids_are_told_by_their_unit() {
        // UTM, Gauss and Krueger, Switzerland, Great Britain, Alabama of 1983, and none.
        for metres in [32632, 25832, 31467, 2056, 27700, 26930, 2135, 32767] {
            assert!(!is_of_another_unit(metres), "{metres}");
        }
        // Ghana, Colorado of 1983, California of 1927, BLM 14N.
        for feet in [2136, 2232, 26741, 32064] {
            assert!(is_of_another_unit(feet), "{feet}");
        }
        assert!(NOT_METRES.is_sorted() && NOT_METRES.len().is_multiple_of(2));
    }
}
