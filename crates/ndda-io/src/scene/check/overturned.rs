//! Dips of planes that are written as overturned.

/// Advice on a dip that is not from 0 to 90°: that of an overturned plane is 180° minus it, in the opposite direction.
pub(super) fn help(dip_deg: f64, dip_direction_deg: f64) -> String {
    let usual = "0 is level, 90 upright";
    if 90.0 < dip_deg && dip_deg <= 180.0 && dip_direction_deg.is_finite() {
        let (dip, direction) = (180.0 - dip_deg, (dip_direction_deg + 180.0).rem_euclid(360.0));
        return format!(
            "{usual}; an overturned plane of {dip_deg}° is one of {dip}° that dips towards {direction}°"
        );
    }
    usual.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_overturned_plane_dips_the_other_way() {
        assert!(
            help(110.0, 90.0).ends_with("an overturned plane of 110° is one of 70° that dips towards 270°")
        );
        assert!(help(100.0, 225.0).ends_with("is one of 80° that dips towards 45°"));
        for none in [-10.0, 200.0, f64::NAN] {
            assert_eq!(help(none, 90.0), "0 is level, 90 upright");
        }
    }
}
