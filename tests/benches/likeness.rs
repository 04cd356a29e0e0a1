//! How like its example each sample of arrangement is, from the reports of the command: the measures
//! are defined in `lib/src/arrange/measure.rs`.

#[path = "../tests/support/mod.rs"]
mod support;

use serde_json::Value;

const MEASURES: [&str; 8] = [
    "elements",
    "residual",
    "symbols-apart",
    "neighbours-apart",
    "repeats",
    "spacing-variation",
    "example-spacing-variation",
    "collisions",
];

fn main() {
    let folder = support::folder();
    let (out, report) = (folder.path().join("out.svg"), folder.path().join("report.json"));
    print!("{:14}", "sample");
    MEASURES.iter().for_each(|measure| print!(" {:>25}", measure));
    println!();
    for sample in support::geometry::samples_of("arrange") {
        let arguments = [
            "arrange".as_ref(),
            sample.as_os_str(),
            "-o".as_ref(),
            out.as_os_str(),
            "--report".as_ref(),
            report.as_os_str(),
        ];
        support::rinceau(arguments).succeed();
        let report: Value = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
        print!("{:14}", sample.file_stem().unwrap().to_string_lossy());
        for measure in MEASURES {
            print!(" {:25.4}", report["counts"][measure].as_f64().unwrap_or(f64::NAN));
        }
        println!();
    }
}
