//! The certificate of a run on its page: what its answers may be wrong by.

use maud::{Markup, html};

use crate::certify::certificate::Certificate;
use crate::certify::report::{shown, with_error};
use crate::summary::Summary;

/// Each quantity with its error bar; nothing where the run has no certificate.
pub fn certificate(certificate: Option<&Certificate>, summary: &Summary) -> Markup {
    let Some(certificate) = certificate else { return html! {} };
    let (shown, left_out) = shown(certificate, &[]);
    let is_of_run = certificate.runs.iter().any(|run| run.state_crc32 == summary.state_crc32);
    html! {
        section.card {
            h2 { "Error bars" }
            p.note {
                "Estimated: " (certificate.estimates) "; from " (certificate.runs.len()) " runs of "
                (format!("{:.1}", certificate.wall_s)) " s in all. Values are those of the shortest step."
            }
            @if !is_of_run { p.alert.warn { "This certificate is of other runs: certify the scene again." } }
            @for remark in &certificate.remarks { p.alert.warn { (remark) } }
            div.scroll {
                table {
                    thead { tr { th { "" } th.number { "value ± error" } th.number { "largest error" } th.number { "error at scene's step" } th { "" } } }
                    tbody {
                        @for quantity in &shown {
                            tr {
                                td { (quantity.name) }
                                td.number { (with_error(quantity.value, quantity.error)) " " (quantity.unit) }
                                td.number { (format!("{:.1e}", quantity.largest_error)) }
                                td.number { (format!("{:.1e}", quantity.own_error)) }
                                td { (quantity.behaviour.word()) }
                            }
                        }
                    }
                }
            }
            @if left_out > 0 { p.note { (left_out) " more are in certificate.json." } }
        }
    }
}
