//! The linear model of a factorial study.

use serde::Serialize;

/// Intercept, main effects of all factors, and chosen two-factor interactions, in sum-to-zero coding: the intercept is the
/// mean over the grid, and the effects of a factor's levels add up to zero (Montgomery, *Design and Analysis of
/// Experiments*, 8th ed. 2013, chapters 5 and 10).
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Model {
    /// Levels of each factor; at least one each.
    pub levels: Vec<usize>,
    /// Pairs of different factors.
    pub interactions: Vec<[usize; 2]>,
}

impl Model {
    /// Terms beside the intercept: a main effect per factor with several levels, then the interactions of such.
    pub fn terms(&self) -> Vec<Vec<usize>> {
        let varied = |f: &usize| self.levels[*f] > 1;
        let mains = (0..self.levels.len()).filter(varied).map(|f| vec![f]);
        let pairs = self.interactions.iter().filter(|pair| pair.iter().all(varied)).map(|pair| pair.to_vec());
        mains.chain(pairs).collect()
    }

    /// Columns of a term.
    pub fn freedom(&self, term: &[usize]) -> usize {
        term.iter().map(|f| self.levels[*f] - 1).product()
    }

    /// Columns in all, with the intercept.
    pub fn parameters(&self) -> usize {
        1 + self.terms().iter().map(|term| self.freedom(term)).sum::<usize>()
    }

    /// First column of each term.
    pub fn offsets(&self) -> Vec<usize> {
        let add = |at: &mut usize, term: &Vec<usize>| {
            let here = *at;
            *at += self.freedom(term);
            Some(here)
        };
        self.terms().iter().scan(1, add).collect()
    }

    /// The row of a combination of levels.
    pub fn row(&self, levels: &[usize]) -> Vec<f64> {
        self.contrast(|factor| self.coding(factor, levels[factor]))
    }

    /// The row of a mean over the grid in which the factors of `fixed` stand at these levels, and all others take each of
    /// theirs: what is summed over a factor vanishes.
    pub fn mean_row(&self, fixed: &[(usize, usize)]) -> Vec<f64> {
        self.contrast(|factor| match fixed.iter().find(|(f, _)| *f == factor) {
            Some((_, level)) => self.coding(factor, *level),
            None => vec![0.0; self.levels[factor] - 1],
        })
    }

    fn contrast(&self, coding: impl Fn(usize) -> Vec<f64>) -> Vec<f64> {
        let mut row = vec![1.0];
        for term in self.terms() {
            let mut columns = vec![1.0];
            for factor in term {
                let coded = coding(factor);
                columns = columns.iter().flat_map(|a| coded.iter().map(move |b| a * b)).collect();
            }
            row.extend(columns);
        }
        row
    }

    /// Columns of a level: one per level but the last, which is minus their sum.
    fn coding(&self, factor: usize, level: usize) -> Vec<f64> {
        let columns = self.levels[factor] - 1;
        if level == columns {
            return vec![-1.0; columns];
        }
        (0..columns).map(|k| f64::from(u8::from(k == level))).collect()
    }

    /// Points of the full grid; `None` when they are more than a machine can count.
    pub fn grid_size(&self) -> Option<usize> {
        self.levels.iter().try_fold(1usize, |all, levels| all.checked_mul(*levels))
    }

    /// The full grid, the last factor running fastest.
    pub fn grid(&self) -> Vec<Vec<usize>> {
        let mut points = vec![Vec::new()];
        for levels in &self.levels {
            let further = |point: Vec<usize>| (0..*levels).map(move |level| [point.clone(), vec![level]].concat());
            points = points.into_iter().flat_map(further).collect();
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_add_up_to_zero_over_a_factor() {
        let model = Model { levels: vec![2, 3], interactions: vec![[0, 1]] };
        assert_eq!(model.parameters(), 6);
        assert_eq!(model.row(&[0, 0]), [1.0, 1.0, 1.0, 0.0, 1.0, 0.0]);
        assert_eq!(model.row(&[1, 2]), [1.0, -1.0, -1.0, -1.0, 1.0, 1.0]);
        let grid = model.grid();
        assert_eq!((grid.len(), &grid[1]), (6, &vec![0, 1]));
        for (column, mean) in model.mean_row(&[]).iter().enumerate() {
            let sum: f64 = grid.iter().map(|point| model.row(point)[column]).sum();
            assert_eq!(sum / 6.0, *mean);
        }
    }

    #[test]
    fn a_factor_of_one_level_has_no_effect() {
        let model = Model { levels: vec![1, 2], interactions: vec![[0, 1]] };
        assert_eq!((model.parameters(), model.terms()), (2, vec![vec![1]]));
        assert_eq!(model.row(&[0, 1]), [1.0, -1.0]);
    }
}
