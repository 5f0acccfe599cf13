//! The words for what a run finds out ([`super::finding`]): cause, place and remedy, in the units that people use. All
//! reports, logs, pages and recordings take them from here.

use super::finding::*;
use std::fmt;

/// "1 wire", "2 wires": a count of things whose plural is made with an s.
pub fn counted<N: fmt::Display + PartialEq + From<u8>>(count: N, thing: &str) -> String {
    let plural = if count == N::from(1) { "" } else { "s" };
    format!("{count} {thing}{plural}")
}

/// "1st", "2nd", "11th".
pub fn ordinal(number: usize) -> String {
    let suffix = match (number % 10, number % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{number}{suffix}")
}

impl fmt::Display for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wire { wire, layer } => write!(f, "wire {wire} ({layer} layer)"),
            Self::Sphere { sphere } => write!(f, "free sphere {sphere}"),
            Self::Rigid { body } => write!(f, "rigid body {body:?}"),
        }
    }
}

/// "particle 3 of wire 2 (outer layer)"; a free sphere is its own only particle.
fn member(what: &str, member: &Member) -> String {
    match member.number {
        Some(number) => format!("{what} {number} of {}", member.body),
        None => member.body.to_string(),
    }
}

impl fmt::Display for Instant {
    /// "strain 3.10 %" between grips, "t = 1.2e-4 s" without.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.strain {
            Some(strain) => write!(f, "strain {:.2} %", 100.0 * strain),
            None => write!(f, "t = {:.3e} s", self.time),
        }
    }
}

impl fmt::Display for StiffnessMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "nothing",
            Self::Axial => "axial stiffness",
            Self::Shear => "shear stiffness",
            Self::Bending => "bending stiffness",
            Self::Torsion => "torsional stiffness",
            Self::Normal => "normal stiffness",
            Self::Tangential => "tangential stiffness",
            Self::Duration => "duration",
        })
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bond => "a bond",
            Self::Contact => "a contact",
        })
    }
}

impl fmt::Display for StepLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => write!(f, "nothing is stiff"),
            Self::Scene { bound_s: Some(bound) } => write!(f, "fixed by the scene; the bound is {bound:.3e} s"),
            Self::Scene { bound_s: None } => write!(f, "fixed by the scene; nothing is stiff"),
            Self::Travel { share_of_radius } => {
                write!(f, "speed: the fastest particle moves by {share_of_radius} of the least radius in a step")
            }
            Self::Impact { steps } => write!(f, "the shortest impact of a free sphere, in at least {steps} steps"),
            Self::Stiffness { mode, element, body, bound_s, safety } => {
                write!(f, "{mode} of {element} in {body}; bound {bound_s:.3e} s × safety {safety}")
            }
        }
    }
}

impl fmt::Display for Relief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Speed => "lower the speed",
            Self::Clamp => "lower grip.clamp_pressure or the speed",
        })
    }
}

impl fmt::Display for StiffnessCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Spheres => {
                "with contact.shape = \"sphere\" touching spheres of one layer fall into the saddles of the next; another \
                 shape, or a smaller spacing, shows how much of it that is"
            }
            Self::Soft => "layers that close in, soft contacts or a pull too fast make a strand softer",
            Self::Stiff => "wires that overlap from the start, or a pull too fast, make a strand stiffer",
        })
    }
}

/// What helps against energy that is unaccounted for.
const LEDGER_REMEDY: &str =
    "lower time.safety (or time.step, below the bound), the speed, or give contacts and bonds damping";

fn ledger_open(missing_j: f64, over_work: f64) -> String {
    let how = if missing_j > 0.0 { "have vanished" } else { "came from nowhere" };
    format!(
        "the energy ledger does not close: {:.3e} J, {:.2} % of the work done, {how}",
        missing_j.abs(),
        100.0 * over_work
    )
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = &self.at;
        // Judgements of loading tell up to which strain they hold; only a gripped body is judged.
        let until = 100.0 * at.strain.unwrap_or(0.0);
        match &self.finding {
            Finding::DeepContact { overlap_over_radius, between: [a, b], z_m, force_n, pressure_pa, relief } => write!(
                f,
                "a contact is {:.1} % of the radius deep, between {a} and {b} at z = {:.1} mm, {at}: {force_n:.3} N, mean \
                 pressure {:.0} MPa; contact laws are made for overlaps below 10 %, so pressures and friction there are \
                 rough: {relief}, or raise contact.hardness_factor or contact.limiting_pressure",
                100.0 * overlap_over_radius,
                1e3 * z_m,
                1e-6 * pressure_pa,
            ),
            Finding::UnstableStep { step_s, bound_s, mode, element, body } => write!(
                f,
                "time.step = {step_s:.3e} s is not stable: the bound is {bound_s:.3e} s ({mode} of {element} in {body}, \
                 {at}); lower time.step, or leave it out so that the step follows the bound",
            ),
            Finding::StepShrunk { from_s, to_s, limit } => write!(
                f,
                "the time step has shrunk from {from_s:.3e} s to {to_s:.3e} s, {at}, because of {limit}; the run takes that \
                 much longer: contacts this stiff are crushed, or particles this light are few, so press less, lower \
                 contact.hardness_factor, or scale the mass (time.mass_scale)",
            ),
            Finding::Necking { bond, z_m, plastic_strain, others, maximum_load } => write!(
                f,
                "strain localises: {} at z = {:.1} mm flows on at a plastic strain of {:.1} % while the rest of its wire has \
                 stopped at {:.1} %, {at}; past the maximum load of the hardening law (dσ/dε ≤ σ from a plastic strain of \
                 {:.1} %, Considère) elongation depends on the spacing of the particles: use a law that still rises at \
                 rupture, or compare runs with other values of spacing",
                member("bond", bond),
                1e3 * z_m,
                100.0 * plastic_strain,
                100.0 * others,
                100.0 * maximum_load,
            ),
            Finding::ContactsAdded { body } => write!(
                f,
                "{body} has turned back on itself, {at}: contacts, left out for a straight body, run from here on; set \
                 plan = \"general\" to have them from the start",
            ),
            Finding::BondsStretched { stretch, covered } => write!(
                f,
                "the longest bond is {stretch:.1} times as long as at rest, {at}: contacts along bonds beyond {covered} \
                 times are not all found; a wire does not stretch like that before it breaks, so give bond.rupture, or a \
                 hardening law that rises",
            ),
            Finding::TooShort { passages, start } => write!(
                f,
                "too short to tell whether loading was quasi-static: it went on for {passages:.1} passages of an elastic \
                 wave along the body, and the first {start} belong to its start; load more slowly, or go on",
            ),
            Finding::GripForcesDiffer { mismatch, limit } => write!(
                f,
                "loading was not quasi-static: up to strain {until:.2} % the two grip forces differed by {:.2} % of the peak \
                 force (limit time.mismatch_limit = {} %); load more slowly",
                100.0 * mismatch,
                100.0 * limit,
            ),
            Finding::KineticEnergy { over_internal, limit } => write!(
                f,
                "loading was not quasi-static: up to strain {until:.2} % kinetic energy reached {over_internal:.3} of the \
                 internal energy (limit time.kinetic_limit = {limit}); load more slowly",
            ),
            Finding::LedgerOpen { missing_j, over_work } => {
                write!(f, "{}, at t = {:.3e} s; {LEDGER_REMEDY}", ledger_open(*missing_j, *over_work), at.time)
            }
            Finding::Stiffness { expected_pa, measured_pa, deviation, window: [from, to], cause } => write!(
                f,
                "the strand is not as stiff as strand theory expects: {:.1} GPa expected, {:.1} GPa measured ({:+.1} %) \
                 between {:.3} and {:.3} % of strain; {cause}",
                1e-9 * expected_pa,
                1e-9 * measured_pa,
                100.0 * deviation,
                100.0 * from,
                100.0 * to,
            ),
            Finding::Failed { failure } => {
                write!(f, "{}", Stopped { at: *at, failure: failure.clone(), kept: None })
            }
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Time => "time",
            Self::Strain => "strain",
            Self::NominalStress => "nominal stress",
            Self::LowerGripForce => "lower grip force",
            Self::UpperGripForce => "upper grip force",
            Self::Torque => "torque",
            Self::Work => "work",
            Self::KineticEnergy => "kinetic energy",
            Self::InternalEnergy => "internal energy",
            Self::WireStress { wire } => return write!(f, "stress of wire {wire}"),
        })
    }
}

impl fmt::Display for Stopped {
    /// When and why, without the remedy.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "stopped at step {}: {}", self.at.step, self.why())
    }
}

impl Stopped {
    /// Why.
    pub fn why(&self) -> String {
        let at = &self.at;
        match &self.failure {
            Failure::NotFinite { quantity } => format!("the {quantity} is not a finite number"),
            Failure::Runaway { particle, moved_m: None, .. } => {
                format!("the position at {} is not a number", member("particle", particle))
            }
            Failure::Runaway { particle, moved_m: Some(moved), limit_m, limit_over_radius, .. } => format!(
                "{} moved {moved:.3e} m in one step, more than {limit_over_radius} of the least radius ({limit_m:.3e} m)",
                member("particle", particle),
            ),
            Failure::UnstableMotion => "the motion turns round at every step: the time step is not stable".into(),
            Failure::LedgerOpen { missing_j, over_work } => ledger_open(*missing_j, *over_work),
            Failure::PassedThrough { between: [a, b], z_m, .. } => {
                let how = match [&a.body, &b.body] {
                    [_, Body::Rigid { .. }] => ["the centre of ", "into"],
                    [Body::Wire { .. }, _] => ["", "through"],
                    [Body::Sphere { .. } | Body::Rigid { .. }, _] => ["the centre of ", "into"],
                };
                let [a, b] = [a, b].map(|one| member("bond", one));
                format!("{}{a} has passed {} {b} at z = {:.1} mm, {at}", how[0], how[1], 1e3 * z_m)
            }
            Failure::Bends { body, z_m } => format!(
                "{body} bends at z = {:.1} mm, {at}, but rotations were left out for a straight body under axial load",
                1e3 * z_m,
            ),
        }
    }

    /// What would help, and where what is left of the run is.
    pub fn remedy(&self) -> String {
        let remedy = match &self.failure {
            Failure::NotFinite { .. } => "try a smaller time.safety, or stronger damping".to_owned(),
            Failure::Runaway { step_s, bound_s, .. } => {
                let bound = bound_s.map_or(String::new(), |bound| format!(", the bound {bound:.3e} s"));
                format!(
                    "the step was {step_s:.3e} s{bound}; lower time.safety or time.step, the speed, or raise damping"
                )
            }
            Failure::UnstableMotion => "lower time.safety, or time.step below the bound".to_owned(),
            Failure::LedgerOpen { .. } => LEDGER_REMEDY.to_owned(),
            Failure::PassedThrough { between, relief, .. } => {
                // Free spheres alone have no spacing and no shape.
                let sparse = match between.iter().any(|one| one.number.is_some()) {
                    true => [" or too sparse", ", lower spacing to 1 or less, or use contact.shape = \"wire\""],
                    false => ["", ", or material.young"],
                };
                format!(
                    "contacts were too soft{} for what pressed on them: {relief}, raise contact.hardness_factor{}",
                    sparse[0], sparse[1]
                )
            }
            Failure::Bends { .. } => "set plan = \"general\", so that every stage runs".to_owned(),
        };
        let Some(KeptResults { folder, earlier }) = &self.kept else { return remedy };
        let kept = format!("{remedy}; the results up to there are in {}", folder.display());
        match earlier {
            0 => kept,
            n => format!("{kept}; its summary.json has {}", counted(*n, "earlier warning")),
        }
    }
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Strain { reached, .. } => write!(f, "strain reached {:.4} % (stop.strain)", reached * 100.0),
            Self::StressFraction { limit, .. } => write!(
                f,
                "stress, in the mean over two passages of a wave, fell to {} % of its peak after a rupture \
                 (stop.stress_fraction)",
                limit * 100.0
            ),
            Self::AfterDrop { limit, .. } => {
                write!(f, "strain went {} % beyond the drop (stop.strain_after_drop)", limit * 100.0)
            }
            Self::Time { reached_s, .. } => write!(f, "time reached {reached_s:.4e} s (stop.time)"),
            Self::Steps { reached, .. } => write!(f, "{} done (stop.steps)", counted(*reached, "step")),
            Self::Interrupted => write!(f, "interrupted"),
            Self::Failed => write!(f, "the simulation failed"),
            Self::Unknown => write!(f, "not known, the run did not end properly"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinals() {
        let said: Vec<String> = [1, 2, 3, 4, 11, 12, 13, 21, 102, 111].into_iter().map(ordinal).collect();
        assert_eq!(said.join(" "), "1st 2nd 3rd 4th 11th 12th 13th 21st 102nd 111th");
    }

    #[test]
    fn one_is_no_plural() {
        assert_eq!([0, 1, 2].map(|n: usize| counted(n, "wire")), ["0 wires", "1 wire", "2 wires"]);
    }

    #[test]
    fn a_failure_counts_the_earlier_warnings() {
        let at = Instant::default();
        let failure = Failure::NotFinite { quantity: Quantity::Torque };
        let stopped = |earlier| Stopped {
            at,
            failure: failure.clone(),
            kept: Some(KeptResults { folder: "out".into(), earlier }),
        };
        assert!(stopped(1).remedy().ends_with("has 1 earlier warning"), "{}", stopped(1).remedy());
        assert!(stopped(2).remedy().ends_with("has 2 earlier warnings"), "{}", stopped(2).remedy());
    }
}
