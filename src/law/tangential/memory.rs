//! What a contact with partial slip remembers, and how slip and a falling normal load change it; the law and its
//! sources stand in [`super::mindlin_deresiewicz`].

use super::curve::Curve;
use glam::DVec3;

/// Branch on which the contact is, with the pulls at which it turned round (k = 0, 1, 2).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Branch {
    /// First loading: no memory.
    #[default]
    Loading,
    /// Unloading.
    Unloading {
        /// Pull F* at which loading ended (N).
        peak: DVec3,
    },
    /// Reloading.
    Reloading {
        /// Pull F* at which loading ended (N).
        peak: DVec3,
        /// Pull F** at which unloading ended (N).
        valley: DVec3,
    },
}

/// History of one contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MindlinDeresiewiczState {
    /// Pull at the last step (N).
    pub pull: DVec3,
    /// Branch and memory.
    pub branch: Branch,
    /// Cap μ F_n at the last step (N).
    pub cap: f64,
    /// Contact radius at the last step (m).
    pub radius: f64,
    /// Unit normal at the last step: pull and memory turn as one body, or their energy would change.
    pub normal: DVec3,
    /// Stored energy at the last step (J).
    pub energy: f64,
}

/// `vector` scaled back to the length `cap` where it is longer.
#[inline(always)]
pub(super) fn held_to(vector: DVec3, cap: f64) -> DVec3 {
    super::held_to(vector.into(), cap).into()
}

/// `vector` without its last `by` (m).
#[inline(always)]
fn shorter(vector: DVec3, by: f64) -> DVec3 {
    let length = vector.length();
    if by < length { vector * (1.0 - by / length) } else { DVec3::ZERO }
}

impl MindlinDeresiewiczState {
    /// Stored energy (J) on the curve of the present load.
    pub(super) fn stored(&self, curve: &Curve) -> f64 {
        match self.branch {
            Branch::Loading => curve.stored(self.pull.length()),
            Branch::Unloading { peak } => curve.stored(peak.length()) + curve.masing_energy(peak, self.pull),
            Branch::Reloading { peak, valley } => {
                let turned = curve.stored(peak.length()) + curve.masing_energy(peak, valley);
                turned + curve.masing_energy(valley, self.pull)
            }
        }
    }

    /// Replaces pull and memory by what `change` makes of them.
    #[inline(always)]
    pub(super) fn map(&mut self, change: impl Fn(DVec3) -> DVec3) {
        self.pull = change(self.pull);
        self.branch = match self.branch {
            Branch::Loading => Branch::Loading,
            Branch::Unloading { peak } => Branch::Unloading { peak: change(peak) },
            Branch::Reloading { peak, valley } => Branch::Reloading { peak: change(peak), valley: change(valley) },
        };
    }

    /// Drops a turning point that the pull has left behind: all memory when it has reached the peak, the valley when
    /// it lies on the unloading side of it.
    pub(super) fn forget_passed_turns(&mut self) {
        if let Branch::Reloading { peak, valley } = self.branch
            && (self.pull - valley).dot(peak - valley) < 0.0
        {
            self.branch = Branch::Unloading { peak };
        }
        if let Branch::Unloading { peak } | Branch::Reloading { peak, .. } = self.branch
            && self.pull.length_squared() >= peak.length_squared()
        {
            self.branch = Branch::Loading;
        }
    }

    /// A turned branch after the load has fallen from the curve `old` to `new`, δ_c by `fall` (m).
    pub(super) fn shed(&mut self, old: &Curve, new: &Curve, mut fall: f64) {
        let since = |from: DVec3, to: DVec3| 2.0 * old.displacement_of(0.5 * (to - from));
        let (peak, down, up) = match self.branch {
            Branch::Loading => (self.pull, DVec3::ZERO, DVec3::ZERO),
            Branch::Unloading { peak } => (peak, since(peak, self.pull), DVec3::ZERO),
            Branch::Reloading { peak, valley } => (peak, since(peak, valley), since(valley, self.pull)),
        };
        let (mut first, mut down, mut up) = (old.displacement_of(peak), down, up);
        if up != DVec3::ZERO {
            // The loop ends where reloading is undone, or where it has caught up with unloading.
            let [back, forth] = [down.length(), up.length()];
            let part = fall.min(forth).min(back - forth).max(0.0);
            (first, down, up) = (shorter(first, part), shorter(down, 2.0 * part), shorter(up, part));
            if part < fall && part < forth {
                (first, down, up) = (first + down + up, DVec3::ZERO, DVec3::ZERO);
            }
            fall -= part;
        }
        if up == DVec3::ZERO && down != DVec3::ZERO {
            let part = fall.min(down.length());
            if part < fall {
                (first, down) = (first + down, DVec3::ZERO);
            } else {
                (first, down) = (shorter(first, part), shorter(down, part));
            }
        }
        let peak = new.force_of(first);
        let valley = peak + 2.0 * new.force_of(0.5 * down);
        self.pull = valley + 2.0 * new.force_of(0.5 * up);
        self.branch = match (down == DVec3::ZERO, up == DVec3::ZERO) {
            (true, _) => Branch::Loading,
            (false, true) => Branch::Unloading { peak },
            (false, false) => Branch::Reloading { peak, valley },
        };
    }

    /// Slip on the branch where the contact is, at constant normal load.
    pub(super) fn slip(&mut self, curve: &Curve, slip: DVec3) {
        match self.branch {
            Branch::Loading => self.slip_loading(curve, slip),
            Branch::Unloading { peak } => {
                let displacement = 2.0 * curve.displacement_of(0.5 * (self.pull - peak));
                if slip.dot(displacement) >= 0.0 {
                    let pull = peak + 2.0 * curve.force_of(0.5 * (displacement + slip));
                    self.continue_to(curve, slip, peak, pull, self.branch);
                } else {
                    let pull = self.pull + 2.0 * curve.force_of(0.5 * slip);
                    let branch = Branch::Reloading { peak, valley: self.pull };
                    self.continue_to(curve, slip, peak, pull, branch);
                }
            }
            Branch::Reloading { peak, valley } => {
                let displacement = 2.0 * curve.displacement_of(0.5 * (self.pull - valley));
                if slip.dot(displacement) >= 0.0 {
                    let pull = valley + 2.0 * curve.force_of(0.5 * (displacement + slip));
                    self.continue_to(curve, slip, peak, pull, self.branch);
                } else {
                    // A reversal within the loop: the older memory is dropped, as in the published law.
                    self.slip_loading(curve, slip);
                }
            }
        }
    }

    /// Whether memory is worth its energy: no state may store less than the virgin one with its pull. That holds by
    /// itself on unloading, and on reloading along one line; not where reloading leaves the line of the loop.
    #[inline(always)]
    pub(super) fn can_hold_memory(&self, curve: &Curve) -> bool {
        !matches!(self.branch, Branch::Reloading { .. }) || self.stored(curve) >= curve.stored(self.pull.length())
    }

    /// Takes the pull that a Masing branch reaches, or drops the memory before the step where the branch ends: at the
    /// peak, or where it can no longer hold its memory.
    fn continue_to(&mut self, curve: &Curve, slip: DVec3, peak: DVec3, pull: DVec3, branch: Branch) {
        let onward = MindlinDeresiewiczState { pull, branch, ..*self };
        if pull.length_squared() < peak.length_squared() && onward.can_hold_memory(curve) {
            *self = onward;
        } else {
            self.slip_loading(curve, slip);
        }
    }

    /// Slip from the virgin state at the present pull.
    fn slip_loading(&mut self, curve: &Curve, slip: DVec3) {
        let start = self.pull;
        let displacement = curve.displacement_of(start);
        let onward = displacement + slip;
        self.branch = Branch::Loading;
        if onward.length_squared() >= displacement.length_squared() {
            self.pull = curve.force_of(onward);
            return;
        }
        let pull = start + 2.0 * curve.force_of(0.5 * slip);
        if pull.length_squared() < start.length_squared() {
            (self.pull, self.branch) = (pull, Branch::Unloading { peak: start });
        } else {
            // A slip nearly square to the pull, slightly inward: it only turns the pull.
            self.pull = held_to(pull, start.length());
        }
    }
}

/// A history as numbers; see [`MindlinDeresiewiczState::numbers`].
pub(super) type Numbers<R> = [R; 16];

impl MindlinDeresiewiczState {
    /// Pull, number of turns, F*, F**, cap, radius, normal, energy.
    pub(super) fn numbers(&self) -> Numbers<f64> {
        let (turns, peak, valley) = match self.branch {
            Branch::Loading => (0.0, DVec3::ZERO, DVec3::ZERO),
            Branch::Unloading { peak } => (1.0, peak, DVec3::ZERO),
            Branch::Reloading { peak, valley } => (2.0, peak, valley),
        };
        let (f, n) = (self.pull, self.normal);
        let [p, v] = [peak, valley];
        [f.x, f.y, f.z, turns, p.x, p.y, p.z, v.x, v.y, v.z, self.cap, self.radius, n.x, n.y, n.z, self.energy]
    }

    pub(super) fn from_numbers(n: &Numbers<f64>) -> Self {
        let vector = |k: usize| DVec3::new(n[k], n[k + 1], n[k + 2]);
        let branch = match n[3] {
            0.0 => Branch::Loading,
            1.0 => Branch::Unloading { peak: vector(4) },
            _ => Branch::Reloading { peak: vector(4), valley: vector(7) },
        };
        Self { pull: vector(0), branch, cap: n[10], radius: n[11], normal: vector(12), energy: n[15] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between the turns a branch goes on; beyond the valley it is unloading, at the peak the virgin curve.
    #[test]
    fn turns_that_the_pull_has_passed_are_forgotten() {
        let (peak, valley) = (DVec3::X, -0.5 * DVec3::X);
        let reloading = Branch::Reloading { peak, valley };
        for (pull, expected) in [
            (0.2, reloading),
            (-0.5, reloading),
            (-0.6, Branch::Unloading { peak }),
            (0.999, reloading),
            (1.0, Branch::Loading),
            (-1.1, Branch::Loading),
        ] {
            let mut state = MindlinDeresiewiczState { pull: pull * DVec3::X, branch: reloading, ..Default::default() };
            state.forget_passed_turns();
            assert_eq!(state.branch, expected, "at {pull}");
        }
        // Off the line of the loop, towards the peak from the valley is what counts.
        let turned = Branch::Reloading { peak, valley: DVec3::new(-0.9, 0.1, 0.0) };
        let pull = DVec3::new(-0.8, -0.1, 0.0);
        let mut state = MindlinDeresiewiczState { pull, branch: turned, ..Default::default() };
        state.forget_passed_turns();
        assert_eq!(state.branch, turned);
    }
}
