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
        if self.loading_rate.is_some() {
            return Err("an adaptive pull changes the speed of all particles");
        }
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

    /// Numbers of the formulas in a step of `dt` (s) from `time` (s) on, by name, after a kick over `kicked` (s).
    pub fn numbers(&self, time: f64, dt: f64, kicked: f64) -> Vec<(String, f64)> {
        let rise = self.rise(time, dt);
        let mut all = Vec::new();
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

    /// Takes in a step of `dt` (s) from `time` (s) on that was done elsewhere, with the reactions in it.
    pub fn take(&mut self, time: f64, dt: f64, reaction: Reaction) {
        self.stretch.displacement += self.rise(time, dt);
        self.reaction = reaction;
    }
}
