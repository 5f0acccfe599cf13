//! Charts as Plotly figures in JSON. What differs between light and dark is written as a token (`"$ink"`), which the
//! page's script replaces by the style sheet's colour of that name.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// Colours for layers that the style sheet has; more layers begin again.
const LAYER_COLOURS: usize = 6;

/// A chart.
pub struct Figure {
    /// Its anchor.
    pub id: &'static str,
    /// Height (px).
    pub height: usize,
    /// What it shows, for those who do not see it and below the chart.
    pub caption: Markup,
    /// Plotly's traces.
    pub data: Vec<Value>,
    /// Plotly's layout.
    pub layout: Value,
}

impl Figure {
    /// The chart's place on the page and its data.
    pub fn markup(self) -> Markup {
        let figure = json!({ "data": self.data, "layout": self.layout });
        html! {
            figure class="chart" {
                div class="plot" id=(self.id) role="group" aria-labelledby={ (self.id) "-caption" }
                    style={ "height:" (self.height) "px" } {
                    noscript { "This chart needs JavaScript; its numbers are in the run's tables." }
                }
                figcaption id={ (self.id) "-caption" } { (self.caption) }
                (data(&figure, "figure", self.id))
            }
        }
    }
}

/// Data for the page's script, which the browser does not run. `name` tells what it is, `of` whose it is.
pub fn data(value: &Value, name: &str, of: &str) -> Markup {
    // The only way out of such a block is a tag, and a tag begins with `<`.
    let text = value.to_string().replace('<', "\\u003c");
    html! { script type="application/json" class=(name) data-of=(of) { (PreEscaped(text)) } }
}

/// Numbers as Plotly reads them fastest: single precision, in base64.
pub fn numbers(values: impl IntoIterator<Item = f64>) -> Value {
    let bytes: Vec<u8> = values.into_iter().flat_map(|v| (v as f32).to_le_bytes()).collect();
    json!({ "dtype": "f4", "bdata": STANDARD.encode(bytes) })
}

/// A table of numbers, row by row.
pub fn table(values: impl IntoIterator<Item = f64>, rows: usize, columns: usize) -> Value {
    let mut table = numbers(values);
    table["shape"] = json!(format!("{rows}, {columns}"));
    table
}

/// The token of a layer's colour.
pub fn layer_colour(layer: usize) -> String {
    format!("$layer{}", layer % LAYER_COLOURS)
}

/// Text from outside, for places where Plotly would take `<` for a tag and `%{` for a value.
pub fn literal(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace("%{", "% {")
}

/// An axis with title and unit.
pub fn axis(title: &str) -> Value {
    json!({
        "title": { "text": title, "standoff": 8 },
        "gridcolor": "$grid", "linecolor": "$line", "tickcolor": "$line", "zerolinecolor": "$line",
        "ticks": "outside", "showline": true, "automargin": true, "exponentformat": "power",
    })
}

/// A layout with its two axes; `more` overrides.
pub fn layout(x: Value, y: Value, more: Value) -> Value {
    let layout = json!({
        "xaxis": x, "yaxis": y,
        "paper_bgcolor": "rgba(0,0,0,0)", "plot_bgcolor": "rgba(0,0,0,0)",
        "font": { "family": "system-ui, sans-serif", "size": 13, "color": "$ink" },
        "margin": { "l": 56, "r": 16, "t": 68, "b": 48 },
        "modebar": { "bgcolor": "rgba(0,0,0,0)", "color": "$muted", "activecolor": "$ink" },
        "hoverlabel": { "bgcolor": "$panel", "bordercolor": "$line", "font": { "color": "$ink" }, "align": "left" },
        "hovermode": "closest",
        "legend": { "orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0, "font": { "size": 12 } },
    });
    merged(layout, more)
}

/// `base` with the entries of `more` in place of its own.
pub fn merged(mut base: Value, more: Value) -> Value {
    if let (Value::Object(base), Value::Object(more)) = (&mut base, more) {
        base.extend(more);
    }
    base
}

/// An upright line across the chart with a word at its top.
pub fn upright(x: f64, word: &str) -> (Value, Value) {
    let line = json!({
        "type": "line", "x0": x, "x1": x, "xref": "x", "y0": 0, "y1": 1, "yref": "paper",
        "line": { "color": "$signal", "width": 1, "dash": "dot" },
    });
    let note = json!({
        "x": x, "xref": "x", "y": 0.5, "yref": "paper", "text": word, "textangle": -90, "showarrow": false,
        "xanchor": "right", "yanchor": "middle", "xshift": -2, "font": { "color": "$signal", "size": 12 },
    });
    (line, note)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_in_the_data_can_end_its_block() {
        let hostile = json!({ "name": "</script><script>alert(1)</script><!--" });
        let markup = data(&hostile, "figure", "x").into_string();
        assert_eq!(markup.matches('<').count(), 2, "{markup}");
        let inside = &markup[markup.find('>').unwrap() + 1..markup.rfind('<').unwrap()];
        assert_eq!(serde_json::from_str::<Value>(inside).unwrap(), hostile);
    }

    #[test]
    fn numbers_are_single_precision_little_endian() {
        assert_eq!(numbers([1.0, -2.5])["bdata"], "AACAPwAAIMA=");
        assert_eq!(table([1.0, -2.5], 1, 2)["shape"], "1, 2");
    }
}
