//! Grips and holds of steps that are done elsewhere: what they do as recorded formulas, and their numbers step by step.

use super::{CLAMP_RISE, Holds, Kind, Reaction, smooth};
use crate::base::triple::Triple;
use crate::engine::recorded::HoldFormula;

impl Holds {
    /// What each group does.
    ///
    /// # Errors
    /// Why it cannot be told in advance.
    pub fn formulas(&self) -> Result<Vec<HoldFormula>, &'static str> {
        if self.grip.as_ref().is_some_and(|grip| grip.free_rotation) {
            return Err("a grip that turns freely asks for its torque before it moves");
        }
        let formula = |group: &super::Group| match &group.kind {
            Kind::Rigid if !self.turns(group) => HoldFormula::Straight,
            Kind::Rigid => HoldFormula::Rigid { clamped: false },
            Kind::Jaw { .. } => HoldFormula::Rigid { clamped: true },
            Kind::Components(hold) => {
                HoldFormula::Components { fixed: hold.fixed, motion: [hold.velocity.into(), hold.spin.into()] }
            }
        };
        Ok(self.groups.iter().map(formula).collect())
    }

    /// Where the axis of the grips crosses the plane of x and y (m).
    pub fn axis(&self) -> [f64; 2] {
        self.axis.to_array()
    }

    /// Particles of each group.
    pub fn members(&self) -> impl Iterator<Item = &[u32]> {
        self.groups.iter().map(|group| &group.particles[..])
    }

    /// Particles of the lower and of the upper grip.
    pub fn gripped(&self) -> [Vec<u32>; 2] {
        [false, true].map(|driven| {
            let grips = self.groups.iter().filter(|g| g.driven == driven && !matches!(g.kind, Kind::Components(_)));
            grips.flat_map(|group| group.particles.iter().copied()).collect()
        })
    }

    /// Whether the pull is adaptive: it changes the speed of all particles that are free.
    pub fn is_adaptive(&self) -> bool {
        self.loading_rate.is_some()
    }

    /// Numbers of the formulas in a step of `dt` (s) from `time` (s) on, by name, after a kick over `kicked` (s); goes on by
    /// that step.
    pub fn foretell(&mut self, time: f64, dt: f64, kicked: f64) -> Vec<(String, f64)> {
        self.loading_rate.iter_mut().for_each(|rate| rate.advance(kicked));
        let rise = self.rise(time, dt);
        let numbers = self.numbers(rise, time, dt, kicked);
        self.stretch.displacement += rise;
        numbers
    }

    fn numbers(&self, rise: f64, time: f64, dt: f64, kicked: f64) -> Vec<(String, f64)> {
        let mut all: Vec<(String, f64)> = Vec::new();
        if self.is_adaptive() {
            let [low, high] = self.faces();
            let numbers = [("speed_change", self.speed_change()), ("low", low), ("high", high)];
            all.extend(numbers.map(|(name, number)| (name.to_owned(), number)));
        }
        for (g, group) in self.groups.iter().enumerate() {
            let mut put = |name: &str, number| all.push((format!("{name}_{g}"), number));
            match &group.kind {
                Kind::Rigid if !self.turns(group) => put("speed", Self::straight_speed(group, rise, dt)),
                Kind::Rigid | Kind::Jaw { .. } => {
                    let motion = self.rigid_motion(group, rise, dt, kicked, None);
                    put("cos", motion.chord[0]);
                    put("sin", motion.chord[1]);
                    put("speed", motion.speed);
                    put("spin", motion.spin);
                    put("acceleration", motion.acceleration);
                    if let Kind::Jaw { clamp } = group.kind {
                        put("clamp", smooth(time / CLAMP_RISE) * clamp);
                    }
                }
                Kind::Components(hold) => {
                    let [push, moment] = Self::load(hold, group.particles.len(), time).map(Triple::<f64>::from);
                    for (name, vector) in [("push", push), ("moment", moment)] {
                        for (axis, number) in [('x', vector.x), ('y', vector.y), ('z', vector.z)] {
                            all.push((format!("{name}_{g}_{axis}"), number));
                        }
                    }
                }
            }
        }
        all
    }

    /// Takes in a step of `dt` (s) from `time` (s) on that was done elsewhere after a kick over `kicked` (s): forces of the lower
    /// and of the upper grip (N), and torque of the upper one (N m), as the formulas give them.
    pub fn take(&mut self, [lower, upper, torque]: [f64; 3], time: f64, dt: f64, kicked: f64, mass: &[f64]) {
        self.loading_rate.iter_mut().for_each(|rate| rate.advance(kicked));
        let straight = |group: &&super::Group| matches!(group.kind, Kind::Rigid) && group.driven && !self.turns(group);
        let held = self.groups.iter().filter(straight).flat_map(|group| &group.particles);
        let held: f64 = held.map(|p| mass[*p as usize]).sum();
        self.reaction = Reaction { force: [-lower, self.force_on_body(upper, held, kicked)], torque };
        self.stretch.displacement += self.rise(time, dt);
    }
}
