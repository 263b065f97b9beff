//! Why order can be lost on a jittered cloud: the curl instability of a compressed state, not MLS.

use crate::meshes::Grid;
use crate::problem::prestrained;
use crate::solve::{JITTER, Kind};
use crate::table::{Row, run_all};

/// S3 on 8 and 16 cells until t = .25; waves of 2 % about F = `stretch` times the unit tensor.
fn row(kind: Kind, stretch: f64, alpha: Option<f64>) -> Row {
    let lcf = if alpha.is_some() { "LCF" } else { "no LCF" };
    let (name, problem) = (format!("F0 = {stretch} {lcf}"), prestrained(stretch, 0.02, 0.25, alpha));
    Row { name, problem, ..Row::new(Grid::Squares, kind, 3, &[8, 16]) }
}

#[test]
fn a_jittered_cloud_loses_order_by_the_curl_instability_of_compression_which_lcf_cures_and_not_by_mls() {
    let rows = [row(JITTER, 0.9, None), row(JITTER, 0.9, Some(3.0)), row(JITTER, 1.1, None), row(Kind::Fem, 0.9, None)];
    let [lost, cured, tension, nodes] = <[_; 4]>::try_from(run_all(&rows)).unwrap();
    // Compressed and without LCF the errors of sampling at jittered points grow like exp(k c t / h): measured
    // 2.621e-6 1.384e-6, rate .92 (24 cells: 5.4e-6, more than on 8).
    assert!(lost.rate < 2.0, "order kept without LCF: {lost:?}");
    // The same points and functions chi_p. With LCF: measured 2.960e-6 1.542e-7, rate 4.26 (3.78 from 16 to 24).
    // In tension nothing grows, LCF or not: measured 2.241e-6 1.284e-7, rate 4.13.
    for found in [&cured, &tension] {
        assert!((3.75..4.35).contains(&found.rate), "{found:?}");
    }
    // A factor 9.0 measured on 16 cells.
    assert!(lost.errors[1] > 5.0 * cured.errors[1], "{lost:?} {cured:?}");
    // At the nodes the seed of the growth is smaller, not the growth: measured rate 4.10, the order is not lost yet.
    assert!((3.75..4.25).contains(&nodes.rate), "{nodes:?}");
}
