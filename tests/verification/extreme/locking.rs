//! Rock that is nearly incompressible is warned of, and incompressible rock refused. How much a cantilever loses is measured by
//! tests/verification/cantilever.rs.

use std::path::Path;

use ndda::Model;
use ndda_io::code::Code;

use super::extreme;

#[test]
fn nearly_incompressible_rock_is_warned_of_and_incompressible_rock_refused() {
    for poisson in ["0.499", "0.4999"] {
        let warnings = extreme("locking", &[&format!("materials.rock.poisson={poisson}")]).loaded.warnings;
        assert!(
            warnings.iter().any(|w| w.code == Code::Inexact && w.path.ends_with("poisson")),
            "{warnings:?}"
        );
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/extreme/locking.ron");
    let refused = Model::open(&path, &["materials.rock.poisson=0.5".into()]).err().expect("a refusal");
    assert_eq!(refused.diagnostics[0].code, Code::OutOfRange);
}
