//! D-optimal designs by exchange.

use super::model::Model;
use nalgebra::{DMatrix, DVector};

/// Largest grid that is searched.
const MOST_CANDIDATES: usize = 100_000;
/// Starts, each from other points.
const STARTS: u64 = 20;
/// Added to the diagonal, so that a start that does not tell all parameters apart can be improved, too.
const RIDGE: f64 = 1e-6;
/// Least gain of an exchange, over the determinant (-).
const GAIN: f64 = 1e-9;

/// Why there is no design.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DesignError {
    /// Fewer points than parameters.
    #[error(
        "{points} points cannot tell {parameters} parameters apart: take at least {parameters}, or fewer interactions"
    )]
    TooFew {
        /// Points asked for.
        points: usize,
        /// Parameters of the model.
        parameters: usize,
    },
    /// More points than the grid has.
    #[error("the grid has only {grid} points: take at most so many; all of them are the full grid")]
    TooMany {
        /// Points of the grid.
        grid: usize,
    },
    /// A grid that cannot be searched.
    #[error("the grid has more than {MOST_CANDIDATES} points, too many to search: give the factors fewer levels")]
    TooLarge,
}

/// The `points` different points of the full grid that make det(XᵀX) greatest, as far as exchanging points one by one
/// finds them (Fedorov 1972; Cook & Nachtsheim 1980), in the order of the grid. The same on every call.
///
/// # Errors
/// Fewer points than parameters, more than the grid has, or a grid too large to search.
pub fn d_optimal(model: &Model, points: usize) -> Result<Vec<Vec<usize>>, DesignError> {
    let parameters = model.parameters();
    if points < parameters {
        return Err(DesignError::TooFew { points, parameters });
    }
    match model.grid_size() {
        Some(grid) if points > grid => return Err(DesignError::TooMany { grid }),
        Some(grid) if grid <= MOST_CANDIDATES => {}
        _ => return Err(DesignError::TooLarge),
    }
    let grid = model.grid();
    let rows: Vec<DVector<f64>> = grid.iter().map(|point| DVector::from_vec(model.row(point))).collect();
    let best = (0..STARTS)
        .map(|start| exchange(&rows, start_points(rows.len(), points, start)))
        .reduce(|best, other| if other.1 > best.1 + GAIN { other } else { best });
    let (mut chosen, _) = best.expect("there are starts");
    chosen.sort_unstable();
    Ok(chosen.into_iter().map(|k| grid[k].clone()).collect())
}

/// det(XᵀX/n)^(1/p) of a design over that of the full grid (-): 1 is as good per run as the grid; 0 does not tell all
/// parameters apart.
pub fn efficiency(model: &Model, design: &[Vec<usize>]) -> f64 {
    let (of_design, of_grid) = (information(model, design), information(model, &model.grid()));
    ((of_design - of_grid) / model.parameters() as f64).exp()
}

/// ln det(XᵀX/n).
fn information(model: &Model, points: &[Vec<usize>]) -> f64 {
    let rows = points.iter().map(|point| DVector::from_vec(model.row(point)));
    let zero = DMatrix::zeros(model.parameters(), model.parameters());
    let sum = rows.fold(zero, |sum, row| sum + &row * row.transpose()) / points.len() as f64;
    log_det(sum)
}

fn log_det(matrix: DMatrix<f64>) -> f64 {
    matrix.cholesky().map_or(f64::NEG_INFINITY, |factor| 2.0 * factor.l_dirty().diagonal().map(f64::ln).sum())
}

/// `points` different numbers below `grid`, by SplitMix64 (Steele, Lea & Flood 2014).
fn start_points(grid: usize, points: usize, start: u64) -> Vec<usize> {
    let mut state = start;
    let mut next = || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    };
    let mut all: Vec<usize> = (0..grid).collect();
    for k in 0..points {
        all.swap(k, k + (next() % (grid - k) as u64) as usize);
    }
    all.truncate(points);
    all
}

/// Exchanges points as long as one exchange gains; gives the points and ln det(XᵀX).
fn exchange(rows: &[DVector<f64>], mut chosen: Vec<usize>) -> (Vec<usize>, f64) {
    let size = rows[0].len();
    let information = |chosen: &[usize]| {
        let ridge = DMatrix::identity(size, size) * RIDGE;
        chosen.iter().fold(ridge, |sum, k| sum + &rows[*k] * rows[*k].transpose())
    };
    loop {
        let matrix = information(&chosen);
        let Some(factor) = matrix.clone().cholesky() else { return (chosen, f64::NEG_INFINITY) };
        let inverse = factor.inverse();
        let solved: Vec<DVector<f64>> = rows.iter().map(|row| &inverse * row).collect();
        let spread: Vec<f64> = rows.iter().zip(&solved).map(|(row, solved)| row.dot(solved)).collect();
        let mut best = (GAIN, 0, 0);
        for (place, out) in chosen.iter().enumerate() {
            for into in (0..rows.len()).filter(|into| !chosen.contains(into)) {
                let cross = rows[*out].dot(&solved[into]);
                // det grows by (1 + d_in)(1 − d_out) + d_in,out² (Fedorov 1972).
                let gain = (1.0 + spread[into]) * (1.0 - spread[*out]) + cross * cross - 1.0;
                if gain > best.0 {
                    best = (gain, place, into);
                }
            }
        }
        if best.0 <= GAIN {
            return (chosen, log_det(matrix));
        }
        chosen[best.1] = best.2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The factors of the mechanism study with some of their interactions: pitch, grip, scatter, shape, friction.
    fn mechanism() -> Model {
        Model { levels: vec![2, 4, 4, 2, 3], interactions: vec![[0, 1], [0, 2], [0, 3], [0, 4], [1, 4]] }
    }

    #[test]
    fn half_of_three_factors_of_two_levels() {
        let model = Model { levels: vec![2, 2, 2], interactions: vec![] };
        let design = d_optimal(&model, 4).unwrap();
        // The half fraction: XᵀX = 4 I, as good per run as the grid.
        assert!((efficiency(&model, &design) - 1.0).abs() < 1e-9, "{design:?}");
        let parity = |point: &Vec<usize>| point.iter().sum::<usize>() % 2;
        assert!(design.iter().all(|point| parity(point) == parity(&design[0])), "{design:?}");
    }

    #[test]
    fn the_mechanism_study_tells_all_its_terms_apart() {
        let model = mechanism();
        assert_eq!(model.parameters(), 26);
        let design = d_optimal(&model, 32).unwrap();
        assert_eq!(design.len(), 32);
        // A sixth of the grid, and per run nearly as good.
        assert!(efficiency(&model, &design) > 0.85, "{}", efficiency(&model, &design));
        assert_eq!(d_optimal(&model, 32).unwrap(), design);
        for factor in 0..5 {
            for level in 0..model.levels[factor] {
                assert!(design.iter().filter(|point| point[factor] == level).count() >= 5, "{factor} {level}");
            }
        }
    }

    #[test]
    fn the_whole_grid_is_as_good_as_itself() {
        let model = Model { levels: vec![2, 3], interactions: vec![[0, 1]] };
        let all = d_optimal(&model, 6).unwrap();
        assert_eq!(all, model.grid());
        assert!((efficiency(&model, &all) - 1.0).abs() < 1e-12);
        assert_eq!(efficiency(&model, &all[..5]), 0.0);
    }

    #[test]
    fn what_cannot_be_had_is_said() {
        let model = mechanism();
        assert!(d_optimal(&model, 25).unwrap_err().to_string().contains("at least 26"));
        assert_eq!(d_optimal(&model, 193), Err(DesignError::TooMany { grid: 192 }));
        let huge = Model { levels: vec![10; 30], interactions: vec![] };
        assert_eq!(d_optimal(&huge, 300), Err(DesignError::TooLarge));
    }
}
