//! The whole command on every sample, by stage: medians of a few runs in milliseconds, from
//! the reports that the command itself writes.

#[path = "../tests/support/mod.rs"]
mod support;

use serde_json::Value;
use std::collections::BTreeMap;

const RUNS: usize = 7;
const STAGES: [&str; 12] = [
    "open",
    "read",
    "prepare",
    "field",
    "streamlines",
    "blobs",
    "cast",
    "refine",
    "place",
    "fill",
    "write",
    "save",
];

fn main() {
    let folder = support::folder();
    let (out, report) = (folder.path().join("out.svg"), folder.path().join("report.json"));
    print!("{:12} {:>8} {:>7}", "sample", "elements", "total");
    STAGES.iter().for_each(|stage| print!(" {stage:>11}"));
    println!();
    for sample in support::samples() {
        let mut runs: Vec<BTreeMap<String, f64>> = Vec::new();
        let mut elements = 0.0;
        for _ in 0..RUNS {
            let arguments = [
                "pack".as_ref(),
                sample.as_os_str(),
                "-o".as_ref(),
                out.as_os_str(),
                "--report".as_ref(),
                report.as_os_str(),
            ];
            support::rinceau(arguments).succeed();
            let report: Value = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
            elements = report["counts"]["elements"].as_f64().unwrap();
            let stages = report["milliseconds"].as_object().unwrap();
            let mut run: BTreeMap<String, f64> =
                stages.iter().map(|(stage, ms)| (stage.clone(), ms.as_f64().unwrap())).collect();
            run.insert("total".into(), report["milliseconds_total"].as_f64().unwrap());
            runs.push(run);
        }
        let median = |stage: &str| {
            let mut values: Vec<f64> =
                runs.iter().map(|run| run.get(stage).copied().unwrap_or(0.0)).collect();
            values.sort_by(f64::total_cmp);
            values[RUNS / 2]
        };
        let name = sample.file_stem().unwrap().to_string_lossy().into_owned();
        print!("{name:12} {elements:8} {:7.1}", median("total"));
        STAGES.iter().for_each(|stage| print!(" {:11.2}", median(stage)));
        println!();
    }
}
