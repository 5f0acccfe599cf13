//! Hardening laws of a scene: from keys to [`HardeningSpec`], and the conversion of an engineering curve.

use super::at::{At, Range};
use super::raw::{RawForm, RawHardening, Scalar};
use super::spec::HardeningSpec;
use crate::base::error::Result;
use crate::base::units::Dimension::{Pressure, Ratio};
use crate::base::units::shortest;

/// A point of an engineering curve lies on the elastic line when its plastic strain is within this share of its
/// elastic strain: people write strains with two or three digits.
const ELASTIC_LINE_TOLERANCE: f64 = 0.01;

/// Resolves `bond.hardening`; `young` (Pa) serves the engineering curve.
pub(super) fn resolve(at: &At, raw: &RawHardening, young: f64) -> Result<HardeningSpec> {
    let form = raw.form.ok_or_else(|| at.missing("form", "\"voce\""))?;
    refuse_other_keys(at, raw, form)?;
    match form {
        RawForm::Voce => voce(at, raw),
        RawForm::Swift => Ok(HardeningSpec::Swift {
            strength: at.required("strength", &raw.strength, Pressure, Range::Positive)?,
            prestrain: at.required("prestrain", &raw.prestrain, Ratio, Range::Positive)?,
            exponent: at.required("exponent", &raw.exponent, Ratio, Range::Fraction)?,
        }),
        RawForm::Ludwik => Ok(HardeningSpec::Ludwik {
            yield_stress: at.required("yield_stress", &raw.yield_stress, Pressure, Range::Positive)?,
            strength: at.required("strength", &raw.strength, Pressure, Range::NotNegative)?,
            exponent: at.required("exponent", &raw.exponent, Ratio, Range::Fraction)?,
        }),
        RawForm::Table => table(at, raw),
        RawForm::EngineeringCurve => engineering_curve(at, raw, young),
    }
}

/// Refuses keys that the form does not have, so that no number in a scene is without effect.
fn refuse_other_keys(at: &At, raw: &RawHardening, form: RawForm) -> Result<()> {
    use RawForm::{EngineeringCurve, Ludwik, Swift, Table, Voce};
    let why = match form {
        Voce => "does not belong to voce, which takes yield_stress, saturation, rate and linear",
        Swift => "does not belong to swift, which takes strength, prestrain and exponent",
        Ludwik => "does not belong to ludwik, which takes yield_stress, strength and exponent",
        Table => "does not belong to table, which takes points",
        EngineeringCurve => "does not belong to engineering-curve, which takes points",
    };
    let scalars: [(&str, &Option<Scalar>, &[RawForm]); 7] = [
        ("yield_stress", &raw.yield_stress, &[Voce, Ludwik]),
        ("saturation", &raw.saturation, &[Voce]),
        ("rate", &raw.rate, &[Voce]),
        ("linear", &raw.linear, &[Voce]),
        ("strength", &raw.strength, &[Swift, Ludwik]),
        ("prestrain", &raw.prestrain, &[Swift]),
        ("exponent", &raw.exponent, &[Swift, Ludwik]),
    ];
    for (name, given, forms) in scalars {
        if !forms.contains(&form) {
            at.refuse(name, given, why)?;
        }
    }
    match form {
        Table | EngineeringCurve => Ok(()),
        _ => at.refuse("points", &raw.points, why),
    }
}

fn voce(at: &At, raw: &RawHardening) -> Result<HardeningSpec> {
    let or_zero = |name, raw: &Option<Scalar>, dimension| -> Result<f64> {
        Ok(at.optional(name, raw, dimension, Range::NotNegative)?.unwrap_or(0.0))
    };
    let saturation = or_zero("saturation", &raw.saturation, Pressure)?;
    let rate = or_zero("rate", &raw.rate, Ratio)?;
    if saturation > 0.0 && rate == 0.0 {
        return Err(at.missing("rate", "8"));
    }
    Ok(HardeningSpec::Voce {
        yield_stress: at.required("yield_stress", &raw.yield_stress, Pressure, Range::Positive)?,
        saturation,
        rate,
        linear: or_zero("linear", &raw.linear, Pressure)?,
    })
}

/// The points as [strain, stress], strains rising; at least two.
fn points(at: &At, raw: &RawHardening, example: &str) -> Result<Vec<[f64; 2]>> {
    let given = raw.points.as_ref().ok_or_else(|| at.missing("points", example))?;
    let at = at.key("points");
    if given.len() < 2 {
        return Err(at.error("`points` needs two points at least", format!("for example {example}")));
    }
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(given.len());
    for (index, [strain, stress]) in given.iter().enumerate() {
        let element = at.element(index);
        let strain = element.element(0).quantity(strain, Ratio, Range::NotNegative)?;
        let stress = element.element(1).quantity(stress, Pressure, Range::NotNegative)?;
        if let Some([before, _]) = points.last().filter(|[before, _]| strain <= *before) {
            let [strain, before] = [strain, *before].map(shortest);
            let what = format!("the strain of point {index} is {strain}, not above {before}, that of the point before");
            return Err(element.error(what, "order the points by rising strain"));
        }
        points.push([strain, stress]);
    }
    Ok(points)
}

fn table(at: &At, raw: &RawHardening) -> Result<HardeningSpec> {
    let points = points(at, raw, "[[0.0, \"90 MPa\"], [0.3, \"300 MPa\"]]")?;
    let first = at.key("points").element(0);
    if points[0][0] != 0.0 {
        return Err(
            first.error("the first point of a table must be at plastic strain 0", "its stress is the yield stress")
        );
    }
    if points[0][1] == 0.0 {
        return Err(first.error("the yield stress of a table must be greater than zero", ""));
    }
    for (index, pair) in points.windows(2).enumerate() {
        refuse_softening(&at.key("points").element(index + 1), "", pair[0][1], pair[1][1])?;
    }
    Ok(HardeningSpec::Table(points))
}

fn refuse_softening(at: &At, true_: &str, before: f64, stress: f64) -> Result<()> {
    if stress >= before {
        return Ok(());
    }
    let what = format!("the {true_}stress falls from {} to {} MPa: softening", before / 1e6, stress / 1e6);
    Err(at.error(what, "strain would localise in one bond; end the curve where it stops rising"))
}

/// Engineering stress s over engineering strain e of one wire → true stress over true plastic strain.
///
/// The area that thins is the plastic one, A = A₀e^(−p): elastic stretch changes the volume, by (1 − 2ν) of itself, and
/// the bonds leave it out. So σ = s e^p and p = ln(1 + e) − σ/E together
/// (Dieter, Mechanical Metallurgy, § 8-3, where p = ln(1 + e)). Between its points the engineering curve is straight,
/// and is followed in short pieces, since the true curve is not. The yield stress is that of the last point on the
/// elastic line; without one, the first plastic piece is drawn back to p = 0.
fn engineering_curve(at: &At, raw: &RawHardening, young: f64) -> Result<HardeningSpec> {
    let given = points(at, raw, "[[\"0 %\", \"0 MPa\"], [\"0.1 %\", \"90 MPa\"], [\"25 %\", \"240 MPa\"]]")?;
    let at = at.key("points");
    let mut curve = TrueCurve { young, yield_stress: None, plastic: Vec::new(), before: 0.0 };
    for (index, point) in given.iter().enumerate() {
        let element = at.element(index);
        // What comes before the yield stress is elastic, and that line is straight enough as it is.
        let from = index.checked_sub(1).filter(|_| curve.yield_stress.is_some() || !curve.plastic.is_empty());
        match from {
            Some(from) => pieces(given[from], *point).try_for_each(|piece| curve.add(&element, index, piece))?,
            None => curve.add(&element, index, *point)?,
        }
    }
    let TrueCurve { yield_stress, mut plastic, .. } = curve;
    if plastic.is_empty() {
        return Err(at.error("no point of the curve lies beyond the elastic line", "give plastic points too"));
    }
    let yield_stress = match yield_stress {
        Some(stress) => stress,
        None => drawn_back(&at, &plastic)?,
    };
    plastic.insert(0, [0.0, yield_stress]);
    Ok(HardeningSpec::Table(plastic))
}

/// Longest piece (-) of an engineering curve whose true curve is taken as straight: its sagitta is at most
/// σ″/σ Δp²/8 = 4 × 0.005²/8, 1e-5 of the stress.
const PIECE: f64 = 0.005;

/// Points [strain, stress] on the straight line from one point to the next, which is the last of them.
fn pieces([e0, s0]: [f64; 2], [e1, s1]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let count = ((e1 - e0) / PIECE).ceil().max(1.0);
    (1..=count as u64).map(move |k| {
        let share = k as f64 / count;
        [e0 + share * (e1 - e0), s0 + share * (s1 - s0)]
    })
}

/// A true curve in the making.
struct TrueCurve {
    young: f64,
    /// True stress of the last point on the elastic line (Pa).
    yield_stress: Option<f64>,
    /// True plastic strain (-) and true stress (Pa) beyond it.
    plastic: Vec<[f64; 2]>,
    /// True stress of the last point of any kind (Pa).
    before: f64,
}

impl TrueCurve {
    /// Takes the next point of the engineering curve, of or on the way to the one with number `index`.
    fn add(&mut self, element: &At, index: usize, [strain, stress]: [f64; 2]) -> Result<()> {
        let young = self.young;
        let p = true_plastic_strain(strain, stress, young);
        let true_stress = stress * p.exp();
        let elastic = true_stress / young;
        refuse_softening(element, "true ", self.before, true_stress)?;
        self.before = true_stress;
        if p < -ELASTIC_LINE_TOLERANCE * elastic {
            let what = format!("point {index} is stiffer than Young's modulus of {} GPa", young / 1e9);
            return Err(element.error(what, "correct the point or material.young"));
        }
        if p <= ELASTIC_LINE_TOLERANCE * elastic && self.plastic.is_empty() {
            self.yield_stress = Some(true_stress).filter(|stress| *stress > 0.0);
            return Ok(());
        }
        if p <= self.plastic.last().map_or(0.0, |[before, _]| *before) {
            let what = format!("the plastic strain falls to {p:.3e} at point {index}");
            return Err(element.error(what, "the curve may not rise more steeply than Young's modulus"));
        }
        if true_stress == 0.0 {
            return Err(element.error(format!("the stress of point {index} is zero"), ""));
        }
        self.plastic.push([p, true_stress]);
        Ok(())
    }
}

/// p with p + s e^p/E = ln(1 + e) (-), for engineering strain e `strain` (-) and stress s `stress` (Pa) of a bar of
/// Young's modulus E `young` (Pa).
///
/// The left side rises and curves upwards, so Newton's method comes down to the root from p = ln(1 + e); the elastic
/// part is so small that it is there, to the last bits, after a few steps.
fn true_plastic_strain(strain: f64, stress: f64, young: f64) -> f64 {
    let total = strain.ln_1p();
    (0..20).fold(total, |p, _| {
        let elastic = stress * p.exp() / young;
        p - (p + elastic - total) / (1.0 + elastic)
    })
}

/// Stress at p = 0 on the line through the first two plastic points (Pa).
fn drawn_back(at: &At, plastic: &[[f64; 2]]) -> Result<f64> {
    let help = "give a point on the elastic line: the end of proportionality";
    let [[p0, s0], [p1, s1], ..] = plastic else {
        return Err(at.error("one plastic point alone does not give the yield stress", help));
    };
    let stress = s0 - (s1 - s0) / (p1 - p0) * p0;
    match stress > 0.0 {
        true => Ok(stress),
        false => Err(at.error("the curve, drawn back to zero plastic strain, gives no positive yield stress", help)),
    }
}
