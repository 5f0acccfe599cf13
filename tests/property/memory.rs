//! What a run keeps: contacts remember something only where they have touched.

use crate::drive::*;

/// Of a strand whose wires touch: bytes that all contacts keep per touching pair, that the bound on the step keeps per
/// particle, and all stages per particle.
#[test]
fn a_strand_in_contact_keeps_little() {
    for (shape, most) in [("sphere", [300, 40, 1000]), ("wire", [900, 40, 1500])] {
        let set = [&format!("contact.shape={shape}"), "strand.length=60 mm", "grip.speed=50 m/s"];
        let mut engine = engine(STRAND, &set);
        run_steps(&mut engine, 600);
        let (particles, (_, candidates, touching)) = (engine.assembly().len(), engine.contact_counts());
        assert!(2 * touching > particles, "{shape}: {touching} of {candidates} candidates touch");
        let bytes = engine.bytes();
        let found = [bytes.contacts.kept / touching, bytes.time_step.kept / particles, bytes.kept() / particles];
        assert!(found.iter().zip(most).all(|(found, most)| *found <= most), "{shape}: {found:?} above {most:?}");
    }
}
