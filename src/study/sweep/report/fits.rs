//! Tables of fitted curves.

use super::super::comparison;
use super::super::definition::Definition;
use super::super::quantity;
use super::findings::{Findings, Fitted};
use crate::study::fit::{Compared, Fit};
use crate::study::table::Table;

/// For each quantity, all models with their parameters and cross-validation, and residuals and folds point by point.
pub fn tables(definition: &Definition, findings: &Findings) -> Vec<Table> {
    findings.fits.iter().flat_map(|fitted| [models(definition, fitted), points(definition, fitted)]).collect()
}

fn label(fitted: &Fitted) -> String {
    quantity::find(fitted.quantity).map_or_else(|| fitted.quantity.into(), |quantity| quantity.label())
}

fn models(definition: &Definition, fitted: &Fitted) -> Table {
    let axis = definition.abscissa().expect("curves run over an axis");
    let row = |compared: &Compared| {
        let (parameters, rms) = match &compared.fit {
            Ok(fit) => (parameters(fit), format!("{:.4}", fit.rms)),
            Err(_) => (String::new(), String::new()),
        };
        let mse = compared.cross_validation.as_ref().map_or(String::new(), |cv| format!("{:.4}", cv.mean));
        let best = Some(compared.model) == fitted.comparison.best;
        let note = match (&compared.fit, &compared.cross_validation) {
            (Err(why), _) => why.to_string(),
            (_, Err(why)) => format!("without one of the points: {why}"),
            _ if best => "foretells best".into(),
            _ => String::new(),
        };
        vec![compared.model.formula().into(), parameters, rms, mse, note]
    };
    let mut rows: Vec<Vec<String>> = fitted.comparison.models.iter().map(row).collect();
    if let Some(paper) = comparison::fitted_over(definition, axis, fitted.quantity) {
        let parameters = format!("A = {}, B = {}, C = {}", paper.a, paper.b, paper.c);
        let note = "as printed, through its own seven points".to_string();
        rows.push(vec!["the paper's".into(), parameters, String::new(), format!("{}", paper.loo_mse), note]);
    }
    Table {
        title: format!("Curves through {} over {}, means over seeds", label(fitted), axis.label()),
        heads: ["curve", "parameters ± standard error", "rms residual", "cross-validation MSE", "note"]
            .map(String::from)
            .to_vec(),
        rows,
        default: None,
        left: 2,
    }
}

fn parameters(fit: &Fit) -> String {
    let one = |(k, name): (usize, &&str)| {
        let value = significant(fit.parameters[k]);
        match &fit.errors {
            Some(errors) => format!("{name} = {value} ± {}", significant(errors[k])),
            None => format!("{name} = {value}"),
        }
    };
    fit.model.names().iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
}

/// Five figures, by powers of ten where the number is very large or small.
fn significant(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if value == 0.0 => "0".into(),
        _ if (1e-3..1e5).contains(&size) => {
            let decimals = (4 - size.log10().floor() as i32).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.4e}"),
    }
}

fn points(definition: &Definition, fitted: &Fitted) -> Table {
    let axis = definition.abscissa().expect("curves run over an axis");
    let models = &fitted.comparison.models;
    let residuals = models.iter().map(|one| format!("{} [residual]", one.model.formula()));
    let folds = models.iter().map(|one| format!("{} [fold's MSE]", one.model.formula()));
    let heads = [axis.label(), label(fitted)].into_iter().chain(residuals).chain(folds);
    let row = |(k, [x, y]): (usize, &[f64; 2])| {
        let mut cells = vec![format!("{x}"), format!("{y:.3}")];
        cells.extend(
            models.iter().map(|one| one.fit.as_ref().map_or(String::new(), |fit| format!("{:+.3}", fit.residuals[k]))),
        );
        cells.extend(
            models
                .iter()
                .map(|one| one.cross_validation.as_ref().map_or(String::new(), |cv| format!("{:.4}", cv.folds[k]))),
        );
        cells
    };
    Table {
        title: format!("Residuals of {}, and the squared error at each point when it is left out", label(fitted)),
        heads: heads.collect(),
        rows: fitted.comparison.points.iter().enumerate().map(row).collect(),
        default: None,
        left: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fit::Model;

    #[test]
    fn numbers_have_five_figures() {
        for (value, text) in
            [(62.8958, "62.896"), (-0.09, "-0.090000"), (311.0, "311.00"), (2.1e-9, "2.1000e-9"), (0.0, "0")]
        {
            assert_eq!(significant(value), text);
        }
    }

    #[test]
    fn parameters_carry_their_errors() {
        let fit = crate::study::fit::fit(Model::Line, &[[0.0, 1.0], [1.0, 2.1], [2.0, 2.9]]).unwrap();
        assert!(parameters(&fit).starts_with("a = 1.0500 ± 0."), "{}", parameters(&fit));
    }
}
