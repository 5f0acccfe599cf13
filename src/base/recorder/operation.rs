//! What can be done to a number while a formula is recorded.

use crate::base::lanes::Real;

/// Place in the list of operations.
pub type Place = u32;

/// An entry of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Node {
    /// An input, by its number.
    Input(u32),
    /// The number that a loop, by its number, refines, as it is in the loop.
    Carried(u32),
    /// What a loop has come to.
    Refined(u32),
    /// A constant, by its bits.
    Number(u64),
    /// A constant answer.
    Truth(bool),
    /// An operation on earlier entries; those that it does not take are 0.
    Apply(Operation, [Place; 3]),
}

/// What an operation gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Number,
    Truth,
}

/// An operation on up to three operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operation {
    Add,
    Sub,
    Mul,
    Div,
    /// Product of the first two plus the third, rounded once.
    MulAdd,
    Neg,
    Abs,
    Sqrt,
    /// To the nearest whole number, of two the even one.
    Round,
    /// See the method of [`Real`] of that name, as the next two.
    PowerOfTwo,
    InverseGuess,
    InverseSqrtGuess,
    /// The two parts of [`Real::split`].
    Mantissa,
    Exponent,
    /// Whether the first is greater than the second.
    Greater,
    And,
    Or,
    Not,
    /// The second where the first, an answer, is yes, else the third.
    Select,
}

impl Operation {
    /// How many operands it takes.
    pub fn count(self) -> usize {
        match self {
            Self::Neg | Self::Abs | Self::Sqrt | Self::Round | Self::PowerOfTwo | Self::Not => 1,
            Self::InverseGuess | Self::InverseSqrtGuess | Self::Mantissa | Self::Exponent => 1,
            Self::Add | Self::Sub | Self::Mul | Self::Div | Self::Greater | Self::And | Self::Or => 2,
            Self::MulAdd | Self::Select => 3,
        }
    }

    /// Those of `operands` that it takes.
    pub fn of(self, operands: &[Place; 3]) -> impl Iterator<Item = Place> {
        operands.iter().copied().take(self.count())
    }

    /// Whether the first two operands may change places without a change of bits.
    pub fn commutes(self) -> bool {
        matches!(self, Self::Add | Self::Mul | Self::MulAdd | Self::And | Self::Or)
    }

    pub fn kind(self) -> Kind {
        match self {
            Self::Greater | Self::And | Self::Or | Self::Not => Kind::Truth,
            _ => Kind::Number,
        }
    }

    /// What it gives, with the bits of `f64`; an answer is 1 or 0.
    pub fn apply(self, [a, b, c]: [f64; 3]) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::MulAdd => a.mul_add(b, c),
            Self::Neg => -a,
            Self::Abs => a.abs(),
            Self::Sqrt => a.sqrt(),
            Self::Round => Real::round_ties_even(a),
            Self::PowerOfTwo => a.power_of_two(),
            Self::InverseGuess => a.inverse_guess(),
            Self::InverseSqrtGuess => a.inverse_sqrt_guess(),
            Self::Mantissa => a.split().0,
            Self::Exponent => a.split().1,
            Self::Greater => f64::from(a > b),
            Self::And => a * b,
            Self::Or => f64::from(a + b > 0.0),
            Self::Not => 1.0 - a,
            Self::Select => Real::select(a != 0.0, b, c),
        }
    }
}
