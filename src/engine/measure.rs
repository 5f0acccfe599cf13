//! Running means of what is measured: strain, nominal stress, grip forces, stresses per wire.

use super::estimates::wave_passage;
use super::grips::{Holds, Reaction};
use super::saved::{Reader, Unfit, Writer};
use super::view::BodyState;
use crate::scene::spec::Spec;
use crate::strand::assembly::Assembly;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::ops::Range;

/// Window of the running means, over the time in which an elastic wave runs along the body (-).
const WINDOW: f64 = 0.125;
/// By how much strain and stress of a row lag behind its instant, over the same time: the middle of the window (-).
pub const MEAN_LAG: f64 = 0.5 * WINDOW;

/// Running means of what a row of the curve says, and who is broken.
///
/// Everything is the mean over the same last L/(8c), an eighth of an elastic wave's way along the body: strain, grip forces,
/// torque and the forces in the wires. A mean lags by half its window behind what grows evenly. Since strain lags as stress
/// does, the curve keeps its phase, and modulus can be read from it at any speed; it rounds off a yield point by half the
/// strain that the grip brings in a window, v/(16c). A window takes out what neighbouring particles ring; the ringing of
/// the body as a whole, of a period of 2L/c, stays.
pub struct Measures {
    /// Length of the window (s).
    window: f64,
    area: f64,
    /// The steps in the window.
    steps: VecDeque<Step>,
    /// Sums over them of length, and of values times length.
    sum: Step,
    /// Bonds in the middle of each wire, whose mean is the wire's stress; wire by wire.
    middle: Vec<usize>,
    /// Those of each wire among them.
    of_wire: Vec<Range<usize>>,
    broken: Vec<bool>,
    /// Number of rigid bodies.
    bodies: usize,
}

/// What was measured at one step, times its length.
#[derive(Default, Clone, Serialize, Deserialize)]
struct Step {
    /// (s)
    length: f64,
    /// Strain (-), force of the lower and upper grip (N), torque (N m), axial force of each middle bond (N), the numbers
    /// of each rigid body; each times s.
    values: Vec<f64>,
}

/// The running mean of strain alone, which is known before a step is done: grips go by plan.
pub struct Strains {
    window: f64,
    steps: VecDeque<[f64; 2]>,
    sum: [f64; 2],
}

impl Strains {
    /// Takes in a step of `dt` (s) at a strain (-) as [`Measures::take`] does; gives what [`Measures::strain`] then is.
    pub fn take(&mut self, strain: f64, dt: f64) -> f64 {
        while let Some([length, part]) = self.steps.pop_front_if(|first| self.sum[0] + dt - first[0] >= self.window) {
            self.sum = [self.sum[0] - length, self.sum[1] - part];
        }
        if self.steps.is_empty() {
            self.sum = [0.0; 2];
        }
        let step = [dt, strain * dt];
        self.sum = [self.sum[0] + step[0], self.sum[1] + step[1]];
        self.steps.push_back(step);
        if self.sum[0] > 0.0 { self.sum[1] / self.sum[0] } else { 0.0 }
    }
}

const STRAIN: usize = 0;
const FORCE: usize = 1;
const TORQUE: usize = 3;
const BONDS: usize = 4;

impl Measures {
    /// For `assembly` between `holds`.
    pub fn new(spec: &Spec, assembly: &Assembly, holds: &Holds) -> Self {
        let gauge = holds.stretch.gauge;
        let (mut slots, mut of_wire) = (Vec::new(), Vec::new());
        for w in 0..assembly.wires.len() {
            let first = slots.len();
            slots.extend(middle(assembly, w, gauge));
            of_wire.push(first..slots.len());
        }
        Self {
            window: WINDOW * wave_passage(spec, assembly),
            area: assembly.area,
            steps: VecDeque::new(),
            sum: Step { length: 0.0, values: vec![0.0; BONDS + slots.len() + BodyState::NUMBERS * spec.rigids.len()] },
            middle: slots,
            of_wire,
            broken: vec![false; assembly.wires.len()],
            bodies: spec.rigids.len(),
        }
    }

    /// Bonds whose axial forces it takes in.
    pub fn bonds(&self) -> &[usize] {
        &self.middle
    }

    /// Takes in a step of `dt` (s): the grips' reactions, the strain (-) and the axial forces of [`Self::bonds`] (N), asked
    /// for in order, and the rigid bodies, all at one instant.
    pub fn take(
        &mut self,
        strain: f64,
        now: &Reaction,
        axial_force: impl FnMut(usize) -> f64,
        bodies: &[BodyState],
        dt: f64,
    ) {
        let mut step = Step::default();
        while self.steps.front().is_some_and(|first| self.sum.length + dt - first.length >= self.window) {
            step = self.steps.pop_front().unwrap_or_default();
            self.sum.length -= step.length;
            self.sum.values.iter_mut().zip(&step.values).for_each(|(sum, value)| *sum -= value);
        }
        if self.steps.is_empty() {
            // No rounding is left of what has gone.
            self.sum.length = 0.0;
            self.sum.values.fill(0.0);
        }
        step.length = dt;
        step.values.clear();
        step.values.extend([strain, now.force[0], now.force[1], now.torque].map(|value| value * dt));
        step.values.extend(self.middle.iter().copied().map(axial_force).map(|force| force * dt));
        step.values.extend(bodies.iter().flat_map(BodyState::numbers).map(|value| value * dt));
        self.sum.length += dt;
        self.sum.values.iter_mut().zip(&step.values).for_each(|(sum, value)| *sum += value);
        self.steps.push_back(step);
    }

    /// What the strain of coming steps will be.
    pub fn strains(&self) -> Strains {
        let one = |step: &Step| [step.length, step.values[STRAIN]];
        let steps = self.steps.iter().map(one).collect();
        Strains { window: self.window, steps, sum: one(&self.sum) }
    }

    fn mean(&self, value: usize) -> f64 {
        if self.sum.length > 0.0 { self.sum.values[value] / self.sum.length } else { 0.0 }
    }

    /// Force of the lower grip and of the upper grip, tension positive (N).
    pub fn grip_force(&self) -> [f64; 2] {
        [0, 1].map(|grip| self.mean(FORCE + grip))
    }

    /// Torque about z on the upper grip (N m).
    pub fn torque(&self) -> f64 {
        self.mean(TORQUE)
    }

    /// Rigid bodies; `None` before the first step.
    pub fn bodies(&self) -> Option<Vec<BodyState>> {
        let first = |body: usize| BONDS + self.middle.len() + BodyState::NUMBERS * body;
        let one = |body: usize| BodyState::of(|number| self.mean(first(body) + number));
        (self.sum.length > 0.0).then(|| (0..self.bodies).map(one).collect())
    }

    /// Wires broken so far.
    pub fn wires_broken(&self) -> usize {
        self.broken.iter().filter(|broken| **broken).count()
    }

    /// Strain of the body: grip displacement over the length that is free between the grips (-).
    pub fn strain(&self) -> f64 {
        self.mean(STRAIN)
    }

    /// Nominal stress: upper grip force over the copper area (Pa).
    pub fn stress(&self) -> f64 {
        if self.area > 0.0 { self.mean(FORCE + 1) / self.area } else { 0.0 }
    }

    /// Part along z of the force of a wire (N): mean over the bonds in the middle of the gauge, `slope` being the cosine between
    /// a bond and z (-). Forces of wires are compared with those of the grips, which are means over the same time: so a bond
    /// that broke in that time counts with what it carried until then.
    pub fn wire_pull(&self, wire: usize, slope: impl Fn(usize) -> f64) -> f64 {
        let range = self.of_wire[wire].clone();
        let count = range.len().max(1) as f64;
        range.map(|i| self.mean(BONDS + i) * slope(self.middle[i])).sum::<f64>() / count
    }

    /// Axial force of a wire (N): mean over the bonds in the middle of the gauge, in which a broken one counts with zero
    /// from the moment at which it broke, whatever it carried before.
    pub fn wire_force(&self, wire: usize, whole: &[bool]) -> f64 {
        let range = self.of_wire[wire].clone();
        let count = range.len().max(1) as f64;
        range.filter(|i| whole[self.middle[*i]]).map(|i| self.mean(BONDS + i)).sum::<f64>() / count
    }

    /// Puts in what was measured so far.
    pub fn save(&self, out: &mut Writer) {
        out.put(&self.steps);
        out.put(&self.sum);
        out.put(&self.broken);
    }

    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is of another body.
    pub fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        let values = self.sum.values.len();
        (self.steps, self.sum) = (from.take()?, from.take()?);
        if self.steps.iter().chain([&self.sum]).any(|step| step.values.len() != values) {
            return Err(Unfit("its measures are those of other wires".into()));
        }
        from.take_into(&mut self.broken)
    }

    /// Marks a wire as broken; true when it was whole.
    pub fn mark_broken(&mut self, wire: usize) -> bool {
        !std::mem::replace(&mut self.broken[wire], true)
    }
}

/// Bonds of wire `w` within a fortieth of the gauge around its middle, at least one.
fn middle(assembly: &Assembly, w: usize, gauge: [f64; 2]) -> Vec<usize> {
    let wire = &assembly.wires[w];
    let z = |slot: usize| 0.5 * (assembly.position.z[slot] + assembly.position.z[slot + 1]);
    let bonds = wire.bonds();
    if bonds.is_empty() {
        return Vec::new();
    }
    let half = wire.first + wire.len / 2;
    if gauge[1] <= gauge[0] {
        return vec![half.min(bonds.end - 1)];
    }
    let centre = 0.5 * (gauge[0] + gauge[1]);
    let near: Vec<usize> = bonds.clone().filter(|s| (z(*s) - centre).abs() <= 0.025 * (gauge[1] - gauge[0])).collect();
    if near.is_empty() {
        bonds.min_by(|a, b| (z(*a) - centre).abs().total_cmp(&(z(*b) - centre).abs())).into_iter().collect()
    } else {
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wires of 40 mm, of particles 0.4 mm apart.
    fn assembly() -> Assembly {
        let text = r#"
            about = "Two wires, one of them half as long."
            [bond]
            law = "elastic"
            [[wire]]
            diameter = "0.4 mm"
            from = ["0 mm", "0 mm", "0 mm"]
            to = ["0 mm", "0 mm", "40 mm"]
            [[wire]]
            diameter = "0.4 mm"
            from = ["1 mm", "0 mm", "0 mm"]
            to = ["1 mm", "0 mm", "20 mm"]
            [stop]
            steps = 1
        "#;
        let scene = crate::scene::parse(text, "two.toml", std::path::Path::new("."), &[]).unwrap();
        crate::strand::build(&scene.spec).unwrap()
    }

    #[test]
    fn the_middle_of_a_wire_is_a_twentieth_of_the_gauge() {
        let a = assembly();
        let centre = |slot: &usize| 0.5 * (a.position.z[*slot] + a.position.z[*slot + 1]);
        // 18 ± 0.4 mm: two or three bonds of 0.4 mm.
        let found = middle(&a, 0, [10e-3, 26e-3]);
        let expected: Vec<usize> = a.wires[0].bonds().filter(|s| (17.6e-3..=18.4e-3).contains(&centre(s))).collect();
        assert!(expected.len() >= 2, "{expected:?}");
        assert_eq!(found, expected);
        // A gauge too short for the spacing takes the nearest bond.
        let nearest = middle(&a, 1, [9.99e-3, 10.01e-3]);
        assert!(nearest.len() == 1 && (centre(&nearest[0]) - 10e-3).abs() <= 0.2e-3 + 1e-9, "{nearest:?}");
        assert!(a.wires[1].bonds().contains(&nearest[0]));
        // Without a gauge, the bond at half its length.
        for (w, half) in [(0, 20e-3), (1, 10e-3)] {
            let free = middle(&a, w, [0.0, 0.0]);
            assert!(free.len() == 1 && (centre(&free[0]) - half).abs() <= 0.4e-3, "{free:?}");
        }
    }
}
