//! The page of a run, if there is one: its charts against the trajectory.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::base::regular;
use crate::engine::view::Sample;
use crate::run::folder::REPORT;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use std::collections::BTreeMap;

pub const PAGE: Invariant = Invariant {
    name: "page",
    about: "charts of report.html show stresses that the trajectory has at the same abscissa",
    check: page,
};

fn page(run: &Folder) -> InvariantOutcome {
    let path = run.path.join(REPORT);
    let text = match regular::text_if_there(&path, regular::LONGEST_TABLE) {
        Ok(Some(text)) => text,
        Ok(None) => {
            return InvariantOutcome::NotApplicable(format!("there is no {REPORT}; `strandsnap report` makes it"));
        }
        Err(e) => return failed(e.to_string()),
    };
    if !run.trajectory.info.is_pulled() {
        return InvariantOutcome::NotApplicable("the body is not pulled".into());
    }
    let mut search = Search::new();
    let rows = Rows::new(&run.trajectory.samples);
    if let Err(what) = curve(&text, &rows, &mut search).and_then(|()| wires(&text, run, &rows, &mut search)) {
        return failed(what);
    }
    search.end(0.0, "-", "the page has no charts")
}

fn failed(what: String) -> InvariantOutcome {
    let mut search = Search::new();
    search.add(f64::NAN, || what);
    search.end(0.0, "-", "")
}

/// Rows by their strain as the page has it.
struct Rows<'a>(BTreeMap<u32, Vec<&'a Sample>>);

impl<'a> Rows<'a> {
    fn new(samples: &'a [Sample]) -> Self {
        let mut rows: BTreeMap<u32, Vec<&Sample>> = BTreeMap::new();
        for sample in samples {
            rows.entry(((sample.strain * 1e2) as f32).to_bits()).or_default().push(sample);
        }
        Self(rows)
    }

    /// Looks whether a row at `x` (%) has the value `y`; `of` tells a row's.
    fn look(&self, [x, y]: [f32; 2], of: impl Fn(&Sample) -> Option<f64>, what: &str, search: &mut Search) {
        let values: Vec<f32> =
            self.0.get(&x.to_bits()).into_iter().flatten().map(|row| of(row).map_or(f32::NAN, |v| v as f32)).collect();
        let there = values.iter().any(|v| *v == y || (v.is_nan() && y.is_nan()));
        search.add(f64::from(u8::from(!there)), || format!("{what} at {x} %: {y} against {values:?} in the rows"));
    }
}

/// Traces of a chart by its anchor; `None` without it.
fn traces(text: &str, anchor: &str) -> Result<Option<Vec<Value>>, String> {
    let mark = format!("<script type=\"application/json\" class=\"figure\" data-of=\"{anchor}\">");
    let Some(from) = text.find(&mark).map(|at| at + mark.len()) else { return Ok(None) };
    let damaged = |what: &str| format!("{REPORT}, chart {anchor}: {what}");
    let length = text[from..].find("</script>").ok_or_else(|| damaged("its data have no end"))?;
    let mut figure: Value = serde_json::from_str(&text[from..from + length]).map_err(|e| damaged(&e.to_string()))?;
    match figure["data"].take() {
        Value::Array(traces) => Ok(Some(traces)),
        _ => Err(damaged("it has no traces")),
    }
}

/// Points of a trace.
fn points(trace: &Value) -> Result<Vec<[f32; 2]>, String> {
    let numbers = |axis: &str| -> Result<Vec<f32>, String> {
        let text = trace[axis]["bdata"].as_str().ok_or_else(|| format!("{REPORT}: a trace has no {axis}"))?;
        let bytes = STANDARD.decode(text).map_err(|e| format!("{REPORT}: {e}"))?;
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    };
    let (x, y) = (numbers("x")?, numbers("y")?);
    if x.len() != y.len() {
        return Err(format!("{REPORT}: a trace has {} abscissae and {} values", x.len(), y.len()));
    }
    Ok(x.into_iter().zip(y).map(|(x, y)| [x, y]).collect())
}

fn curve(text: &str, rows: &Rows, search: &mut Search) -> Result<(), String> {
    let traces = traces(text, "curve-whole")?.ok_or_else(|| format!("{REPORT} has no chart of the curve"))?;
    for point in points(traces.first().ok_or_else(|| format!("{REPORT}: the curve has no trace"))?)? {
        rows.look(point, |row| Some(row.stress * 1e-6), "nominal stress", search);
    }
    Ok(())
}

/// Wires in their order, then layers.
fn wires(text: &str, run: &Folder, rows: &Rows, search: &mut Search) -> Result<(), String> {
    let info = &run.trajectory.info;
    for (k, trace) in traces(text, "wires-whole")?.unwrap_or_default().iter().enumerate() {
        for point in points(trace)? {
            match k.checked_sub(info.wires.len()) {
                None => {
                    let of = |row: &Sample| row.wire_stress.get(k).map(|s| s * 1e-6);
                    rows.look(point, of, &format!("wire {}", k + 1), search);
                }
                Some(layer) => {
                    let of = |row: &Sample| row.layer_stress.get(layer).map(|s| s * 1e-6);
                    let name = info.layers.get(layer).map_or("?", String::as_str);
                    rows.look(point, of, &format!("{name} layer"), search);
                }
            }
        }
    }
    Ok(())
}
