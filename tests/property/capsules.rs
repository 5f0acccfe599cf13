//! Smooth wires.
