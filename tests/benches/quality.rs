//! How evenly each sample of packing is filled, from the reports of the command: the measures are defined
//! in `lib/src/quality.rs`. The last columns compare with the unrefined pass without fillers: how much
//! refinement alone, and refinement and fillers together, raise the evenness and lower the variation of gap
//! widths.

#[path = "../tests/support/mod.rs"]
mod support;

use serde_json::Value;
use std::path::Path;

const MEASURES: [&str; 9] = [
    "coverage",
    "mean_gap",
    "largest_gap",
    "gap_cv",
    "evenness",
    "boundary",
    "overlap",
    "spill",
    "grown_overlap",
];

fn report(sample: &Path, flags: &[&str]) -> Value {
    let folder = support::folder();
    let (out, report) = (folder.path().join("out.svg"), folder.path().join("report.json"));
    support::rinceau(["pack"])
        .arg(sample)
        .arg("-o")
        .arg(&out)
        .arg("--report")
        .arg(&report)
        .args(flags)
        .succeed();
    serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap()
}

fn main() {
    print!("{:12} {:>8} {:>7}", "sample", "elements", "angle");
    MEASURES.iter().for_each(|measure| print!(" {measure:>11}"));
    println!(" {:>6} {:>9} {:>9} {:>9} {:>9}", "kinds", "refined:", "gap_cv", "filled:", "gap_cv");
    for sample in support::samples() {
        let whole = report(&sample, &[]);
        let counts = whole["counts"].as_object().unwrap();
        let name = sample.file_stem().unwrap().to_string_lossy().into_owned();
        print!("{name:12} {:8} {:7.1}", counts["elements"], counts["flow-angle"].as_f64().unwrap());
        MEASURES.iter().for_each(|measure| print!(" {:11.3}", whole["quality"][*measure].as_f64().unwrap()));
        // Kinds that are used, as many as would be if all were equally frequent.
        let all = counts["elements"].as_f64().unwrap();
        let kinds = counts.iter().filter(|(name, _)| name.starts_with("elements."));
        let shares = kinds.map(|(_, count)| count.as_f64().unwrap() / all);
        let entropy: f64 = shares.map(|share| -share * share.ln()).sum();
        let refined = report(&sample, &["--fillers", "none"]);
        let plain = report(&sample, &["--fillers", "none", "--iterations", "0"]);
        let of = |report: &Value, measure: &str| report["quality"][measure].as_f64().unwrap();
        print!(" {:6.1}", entropy.exp());
        for report in [&refined, &whole] {
            let gain = of(report, "evenness") - of(&plain, "evenness");
            let change = of(report, "gap_cv") / of(&plain, "gap_cv") - 1.0;
            print!(" {gain:+9.3} {:+7.0} %", 100.0 * change);
        }
        println!();
    }
}
