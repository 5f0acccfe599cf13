//! What a bond does in a step, and the section values that its rupture looks at, as formulas that can be recorded.

use super::kinematics::{Node, Step, reached};
use super::layout::{ACROSS, SHAPE_NAMES, VISCOSITY, force, shape};
use crate::base::lanes::Real;
use crate::base::recorder::{Formula, put_vector, take_vector};
use crate::base::triple::Triple;
use crate::engine::rupture::Limit;
use crate::law::bond::rupture::BeamStress;
use crate::law::bond::{BondForce, BondLaw, Section};
use std::collections::BTreeMap;

/// A step of one bond: its motion, its law, its dashpots. A bond whose `live` is 0 stays as it was and does nothing.
#[derive(Debug, Clone)]
pub struct BondStep<L> {
    /// Its law.
    pub law: L,
    /// Whether particles turn: bending, shear and torsion.
    pub turn: bool,
    /// Whether there are dashpots.
    pub damped: bool,
}

impl<L: BondLaw> Formula for BondStep<L> {
    /// Takes positions (m), velocities (m/s) and spins (rad/s) of the two particles, the shape, what the bond remembers
    /// (frame, forces, force of the dashpot, history of the law, its factor on the radius), viscous coefficients, step (s) and its inverse. Puts what it
    /// then remembers, its pull (N) and moments (N m) on the particles, plastic work and work of the dashpots (J), the factor
    /// on the radius and the equivalent plastic strain (-).
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let Self { law, turn, damped } = self;
        let mut node = |name: &str| {
            let mut vector = |what: &str| take_vector(take, &format!("{name}_{what}"));
            let (x, v) = (vector("x"), vector("v"));
            Node { x, v, w: if *turn { vector("w") } else { Triple::zero(v.x) } }
        };
        let ends = [node("near"), node("far")];
        let shape_numbers = SHAPE_NAMES.map(&mut *take);
        let shape = shape(|k| shape_numbers[k]);
        let zero = shape.radius.splat(0.0);
        let old_e1 = if *turn { take_vector(take, "e1") } else { ends[0].w };
        let axial = take("axial");
        let across = if *turn { ACROSS.map(&mut *take) } else { [zero; 5] };
        let old_force = force(axial, |k| across[k]);
        let old_dashpot = if *damped { take("dashpot") } else { zero };
        let old_history: Vec<R> = (0..L::HISTORY).map(|k| take(&format!("history_{k}"))).collect();
        let viscosity = match (damped, turn) {
            (false, _) => None,
            (true, false) => Some([take(VISCOSITY[0]), zero, zero, zero]),
            (true, true) => Some(VISCOSITY.map(&mut *take)),
        };
        let old_thinning = take("thinning");
        let dt = if *turn || *damped { take("dt") } else { zero };
        let per = if *turn && *damped { take("inverse_dt") } else { zero };
        let live = take("live").simd_gt(zero);

        let (mut e1, mut force, mut dashpot) = (old_e1, old_force, old_dashpot);
        let mut state = L::history(|k| old_history[k]);
        let mut step = Step { law, dt, per, live, plastic: zero, damping: zero };
        let acts = if *turn {
            step.turning(&ends, &shape, &mut e1, &mut force, &mut state, &mut dashpot, viscosity)
        } else {
            step.stretching(&ends, &shape, &mut force, &mut state, &mut dashpot, viscosity)
        };

        let done = |number: R| R::select(live, number, zero);
        let of = |f: &BondForce<R>| [f.shear[0], f.shear[1], f.bend[0], f.bend[1], f.twist];
        if *turn {
            put_vector(put, "e1", e1);
        }
        let force = BondForce::select(live, &force, &old_force);
        put("axial", force.axial);
        if *turn {
            ACROSS.iter().zip(of(&force)).for_each(|(name, number)| put(name, number));
        }
        if *damped {
            put("dashpot", R::select(live, dashpot, old_dashpot));
        }
        L::each_number(&state, |k, number| put(&format!("history_{k}"), R::select(live, number, old_history[k])));
        put_vector(put, "pull", acts.pull.map(done));
        if *turn {
            put_vector(put, "moment_near", acts.near.map(done));
            put_vector(put, "moment_far", acts.far.map(done));
        }
        put("plastic_work", done(step.plastic));
        put("damping_work", done(step.damping));
        put("thinning", R::select(live, law.thinning(&shape, &state), old_thinning));
        put("plastic_strain", law.plastic_strain(&shape, &state));
    }
}

/// [`BondStep`] in a run: energies are added up, and it is seen whether a bond has reached its limit.
#[derive(Debug, Clone)]
pub struct BondInRun<L> {
    /// The step.
    pub step: BondStep<L>,
    /// What limits it.
    pub limit: Option<Limit>,
}

impl<L: BondLaw> Formula for BondInRun<L> {
    /// Takes what the step takes, the energies so far (J) and the bond's limit. Puts what the step puts, but the energies with
    /// its own (J), and whether the bond has to be broken (1 or 0).
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let (mut taken, mut done) = (BTreeMap::new(), BTreeMap::new());
        let mut take = |name: &str| *taken.entry(name.to_owned()).or_insert_with(|| take(name));
        self.step.compute(&mut take, &mut |name, number| {
            done.insert(name.to_owned(), number);
        });
        let (zero, one) = (done["axial"].splat(0.0), done["axial"].splat(1.0));
        let due = self.limit.map(|limit| {
            let (live, most) = (take("live").simd_gt(zero), take("limit"));
            let due = match limit {
                Limit::PlasticStrain => reached(done["plastic_strain"], most),
                Limit::BeamStress(criterion) => {
                    let across = ACROSS.map(|name| done.get(name).copied().unwrap_or(zero));
                    let shape_numbers = SHAPE_NAMES.map(&mut take);
                    let state = L::history(|k| done[&format!("history_{k}")]);
                    let section = self.step.law.section(&shape(|k| shape_numbers[k]), &state);
                    let force = force(done["axial"], |k| across[k]);
                    let [tension, shear] = criterion.utilisation(&force, &section);
                    reached(tension, most) | reached(shear, most)
                }
            };
            R::select(live & due, one, zero)
        });
        for (name, number) in &done {
            match name.as_str() {
                "plastic_work" | "damping_work" => put(name, take(name) + *number),
                "plastic_strain" => {}
                _ => put(name, *number),
            }
        }
        due.into_iter().for_each(|due| put("due", due));
    }
}

/// What the criterion of [`BeamStress`] looks at in a bond: its two utilisations.
#[derive(Debug, Clone)]
pub struct SectionStress<L> {
    /// The bond's law.
    pub law: L,
    /// The criterion.
    pub criterion: BeamStress,
}

impl<L: BondLaw> Formula for SectionStress<L> {
    /// Takes the shape, forces and history of a bond; puts its section (radius (m), area (m²), second moment (m⁴)) and its
    /// tensile and shear utilisation (-).
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let shape_numbers = SHAPE_NAMES.map(&mut *take);
        let axial = take("axial");
        let across = ACROSS.map(&mut *take);
        let history: Vec<R> = (0..L::HISTORY).map(|k| take(&format!("history_{k}"))).collect();
        let section = self.law.section(&shape(|k| shape_numbers[k]), &L::history(|k| history[k]));
        let [tension, shear] = self.criterion.utilisation(&force(axial, |k| across[k]), &section);
        let Section { radius, area, inertia } = section;
        let results =
            [("radius", radius), ("area", area), ("inertia", inertia), ("tension", tension), ("shear", shear)];
        results.into_iter().for_each(|(name, number)| put(name, number));
    }
}
