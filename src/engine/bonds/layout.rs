//! Where what a bond remembers lies in its block.

use crate::base::lanes::{BLOCK, Real};
use crate::law::bond::{BondForce, BondLaw, BondShape};

/// Viscous coefficients of a bond.
pub const MODES: usize = 4;
/// l₀, r₀ and their inverses.
pub const SHAPE: usize = 4;
/// Rows that never change.
pub const CONSTANTS: usize = SHAPE + MODES;

/// Names of the rows that never change, and of the forces across, in formulas.
pub const SHAPE_NAMES: [&str; SHAPE] = ["rest_length", "radius0", "inverse_length", "inverse_radius"];
pub const VISCOSITY: [&str; MODES] = ["viscosity_axial", "viscosity_shear", "viscosity_bend", "viscosity_twist"];
pub const ACROSS: [&str; 5] = ["shear_1", "shear_2", "bend_1", "bend_2", "twist"];
const FRAME: [&str; 3] = ["e1_x", "e1_y", "e1_z"];

/// The row that never changes of a name.
pub fn constant_named(name: &str) -> Option<usize> {
    SHAPE_NAMES.iter().chain(&VISCOSITY).position(|known| *known == name)
}

/// Fields of a bond with law `L`; `TURN` says whether particles turn.
pub struct Layout<L: BondLaw, const TURN: bool>(std::marker::PhantomData<L>);

impl<L: BondLaw, const TURN: bool> Layout<L, TURN> {
    // Places of the fields in a block. A bond that only stretches has no frame and no force but the axial one.
    pub const FRAME: usize = 0;
    pub const AXIAL: usize = if TURN { 3 } else { 0 };
    pub const ACROSS: usize = Self::AXIAL + 1;
    pub const DASHPOT: usize = Self::ACROSS + if TURN { 5 } else { 0 };
    pub const HISTORY: usize = Self::DASHPOT + 1;
    /// 1 where the bond holds, 0 elsewhere.
    pub const LIVE: usize = Self::HISTORY + L::HISTORY;
    pub const FIELDS: usize = Self::LIVE + 1;

    /// The field of a name.
    pub fn named(name: &str) -> Option<usize> {
        let among = |names: &[&str], first: usize| names.iter().position(|known| *known == name).map(|k| first + k);
        let turning = || among(&FRAME, Self::FRAME).or(among(&ACROSS, Self::ACROSS));
        let history = || {
            let k = name.strip_prefix("history_")?.parse::<usize>().ok().filter(|k| *k < L::HISTORY)?;
            Some(Self::HISTORY + k)
        };
        match name {
            "axial" => Some(Self::AXIAL),
            "dashpot" => Some(Self::DASHPOT),
            "live" => Some(Self::LIVE),
            _ if TURN => turning().or_else(history),
            _ => history(),
        }
    }
}

/// Where field `field` of `slot` lies among blocks of `fields` fields.
#[inline(always)]
pub fn place(fields: usize, slot: usize, field: usize) -> usize {
    (slot / BLOCK * fields + field) * BLOCK + slot % BLOCK
}

#[inline(always)]
pub fn shape<R: Real>(number: impl Fn(usize) -> R) -> BondShape<R> {
    BondShape { rest_length: number(0), radius: number(1), inverse_length: number(2), inverse_radius: number(3) }
}

#[inline(always)]
pub fn force<R: Real>(axial: R, across: impl Fn(usize) -> R) -> BondForce<R> {
    BondForce { axial, shear: [across(0), across(1)], bend: [across(2), across(3)], twist: across(4) }
}
