//! Files in which somebody changed something, and sealed the summary again, so that no digest tells of it: what the files
//! say of each other must.

use crate::damaged::{Copy, copy};
use crate::wrong;
use serde_json::Value;
use std::fs;
use strandsnap::observe::trajectory::Trajectory;
use strandsnap::run::identity;
use strandsnap::study::check_run::{InvariantCheck, check};

impl Copy {
    /// The summary gets a seal that fits the files as they are now.
    pub fn seal(&self) {
        let path = self.run.join("summary.json");
        let text = fs::read_to_string(&path).unwrap();
        let mut summary: Value = serde_json::from_str(&text).unwrap();
        summary.as_object_mut().unwrap().remove("seal");
        let bare = serde_json::to_string_pretty(&summary).unwrap();
        let origin = Trajectory::open(&self.run.join("trajectory.bin")).unwrap().origin();
        fs::write(&path, identity::seal(&bare, origin, &self.run, &[]).unwrap()).unwrap();
        assert_eq!(identity::doubts(&self.run).unwrap(), [], "the seal is right");
    }

    fn text(&self, file: &str) -> String {
        fs::read_to_string(self.run.join(file)).unwrap()
    }
}

/// Writes `text` into a file of a run that is sealed again, and asserts that this is found.
fn found(run: &Copy, file: &str, text: &str, what: &str) {
    let before = run.text(file);
    assert_ne!(before, text, "{what} changes nothing");
    fs::write(run.run.join(file), text).unwrap();
    run.seal();
    assert!(!wrong(&run.run).is_empty(), "{file}: {what} is not found");
    fs::write(run.run.join(file), before).unwrap();
    run.seal();
}

/// A table as cells, its heads first.
fn cells(text: &str) -> Vec<Vec<String>> {
    text.lines().map(|line| line.split(',').map(String::from).collect()).collect()
}

fn joined(cells: &[Vec<String>]) -> String {
    cells.iter().map(|row| row.join(",") + "\n").collect()
}

/// Another number instead of this one; a word gets a letter more.
fn other(cell: &str, factor: f64) -> String {
    match cell.parse::<f64>() {
        Ok(0.0) => (factor - 1.0).to_string(),
        // A count changes by one at least.
        Ok(value) if value.fract() == 0.0 && value.abs() < 1e6 => (value + 1.0).to_string(),
        Ok(value) => (value * factor).to_string(),
        Err(_) => format!("{cell}x"),
    }
}

#[test]
fn single_cells_of_the_tables() {
    let run = copy();
    run.seal();
    assert!(wrong(&run.run).is_empty(), "{:?}", wrong(&run.run));
    for file in ["curve.csv", "wires.csv", "ruptures.csv"] {
        let right = cells(&run.text(file));
        for column in 0..right[0].len() {
            let (rows, factor) = (right.len(), if column % 2 == 0 { 1.01 } else { 1.001 });
            let row = 1 + (7 * column) % (rows - 1);
            let mut changed = right.clone();
            changed[row][column] = other(&right[row][column], factor);
            found(&run, file, &joined(&changed), &format!("{} in line {}", right[0][column], row + 1));
        }
    }
}

#[test]
fn rows_columns_and_units_of_the_tables() {
    let run = copy();
    for file in ["curve.csv", "wires.csv", "ruptures.csv"] {
        let right = cells(&run.text(file));
        let change = |what: &str, change: &dyn Fn(&mut Vec<Vec<String>>)| {
            let mut changed = right.clone();
            change(&mut changed);
            found(&run, file, &joined(&changed), what);
        };
        let middle = right.len() / 2;
        change("two rows swapped", &|rows| rows.swap(middle, middle + 1));
        change("a row left out", &|rows| drop(rows.remove(middle)));
        change("the last row left out", &|rows| drop(rows.pop()));
        change("a row twice", &|rows| rows.insert(middle, rows[middle].clone()));
        let numbers = |row: &[String]| row.iter().filter(|cell| cell.parse::<f64>().is_ok()).count();
        change("all that is measured of two rows swapped", &|rows| {
            let (first, second) = (rows[1].clone(), rows[2].clone());
            assert!(numbers(&first) > 1);
            rows[1][1..].clone_from_slice(&second[1..]);
            rows[2][1..].clone_from_slice(&first[1..]);
        });
        for (k, head) in right[0].iter().enumerate() {
            let unit = ["_mpa", "_percent", "_mm", "_n", "_s", "_j"].iter().any(|unit| head.ends_with(unit));
            let told = right[1..].iter().any(|row| row[k].parse::<f64>().is_ok_and(|value| value != 0.0));
            if unit && told {
                change(&format!("{head} in another unit"), &|rows| {
                    for row in &mut rows[1..] {
                        row[k] = row[k].parse::<f64>().map_or(row[k].clone(), |value| (value * 1e3).to_string());
                    }
                });
            }
        }
    }
}

/// Keys of a summary whose values only the run itself knew: nothing else in its folder tells of them but the seal.
const SEALED: [&str; 18] = [
    "kinetic_over_internal_max",
    "kinetic_over_internal_overall",
    "grip_force_mismatch_percent",
    "grip_force_mismatch_overall_percent",
    "energy_residual_greatest_percent",
    "deepest_contact",
    "least_time_step",
    "greatest_time_step",
    "wall_s",
    "cpu_s",
    "ms_per_step",
    "threads",
    "threads_available",
    "frames",
    "versions",
    "stopped",
    "written",
    "seal",
];

fn paths(value: &Value, path: &str, all: &mut Vec<String>) {
    match value {
        Value::Object(map) => {
            map.iter().for_each(|(key, value)| paths(value, &format!("{path}/{key}"), all));
        }
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(k, value)| paths(value, &format!("{path}/{k}"), all));
        }
        Value::Null => {}
        _ => all.push(path.to_owned()),
    }
}

#[test]
fn every_number_and_word_of_the_summary() {
    let run = copy();
    let right: Value = serde_json::from_str(&run.text("summary.json")).unwrap();
    let mut all = Vec::new();
    paths(&right, "", &mut all);
    let all: Vec<&String> = all.iter().filter(|path| !SEALED.contains(&path.split('/').nth(1).unwrap())).collect();
    assert!(all.len() > 60, "{all:?}");
    // The page shows most of them: it must not be what finds them.
    fs::remove_file(run.run.join("report.html")).unwrap();
    let before = run.text("summary.json");
    let mut missed = Vec::new();
    for path in all {
        let mut changed = right.clone();
        let value = changed.pointer_mut(path).unwrap();
        *value = match &*value {
            Value::Number(count) if count.is_u64() => (count.as_u64().unwrap() + 1).into(),
            Value::Number(number) => other(&number.to_string(), 1.001).parse::<f64>().unwrap().into(),
            Value::Bool(right) => (!right).into(),
            Value::String(words) => words.replacen(|c: char| c.is_ascii_lowercase(), "q", 1).into(),
            other => panic!("{path}: {other}"),
        };
        fs::write(run.run.join("summary.json"), changed.to_string()).unwrap();
        run.seal();
        // What cannot be read any more is found too.
        let silent = check(&run.run).is_ok_and(|findings| !findings.iter().any(InvariantCheck::failed));
        missed.extend(silent.then_some(path));
        fs::write(run.run.join("summary.json"), &before).unwrap();
    }
    assert!(missed.is_empty(), "{missed:?}");
}

/// Places of digits in what people read of the page, outside of tags, styles and scripts.
fn digits(page: &str) -> Vec<usize> {
    let main = page.find("<main>").unwrap()..page.find("</main>").unwrap();
    let study = page.find("<section id=\"accuracy\"").unwrap();
    let after = study + page[study..].find("</section>").unwrap();
    let (mut inside, mut script) = (false, false);
    let mut found = Vec::new();
    for (at, letter) in page.char_indices().filter(|(at, _)| main.contains(at)) {
        match letter {
            '<' => {
                inside = true;
                script = page[at..].starts_with("<script") || (script && !page[at..].starts_with("</script"));
            }
            '>' => inside = false,
            '0'..='9' if !inside && !script && !(study..after).contains(&at) => found.push(at),
            _ => {}
        }
    }
    found
}

#[test]
fn figures_of_the_page_in_words_and_tables() {
    let run = copy();
    let page = run.text("report.html");
    let all = digits(&page);
    assert!(all.len() > 300, "{}", all.len());
    for at in all.iter().step_by(all.len() / 40) {
        let mut changed = page.clone().into_bytes();
        changed[*at] = if changed[*at] == b'7' { b'3' } else { b'7' };
        let context: String = page[..*at].chars().rev().take(30).collect();
        let context: String = context.chars().rev().collect();
        found(&run, "report.html", &String::from_utf8(changed).unwrap(), &context);
    }
    for (from, to) in
        [("snapped first", "snapped last"), ("core", "kernel"), ("bdata\":\"", "bdata\":\"AAAA"), ("MPa", "GPa")]
    {
        found(&run, "report.html", &page.replacen(from, to, 1), from);
    }
    let place = {
        fs::write(run.run.join("report.html"), page.replacen(" MPa", "1 MPa", 1)).unwrap();
        let wrong = wrong(&run.run);
        wrong.into_iter().find(|w| w.starts_with("page-words")).unwrap()
    };
    assert!(place.contains("answer") && place.contains("1 MPa"), "the words are shown: {place}");
}
