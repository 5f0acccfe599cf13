//! What an engine keeps between two steps, in bytes.

use super::Engine;
use super::saved::{Reader, Unfit, Writer};

impl Engine {
    /// The state between two steps. Ruptures and notices that nobody has taken yet are part of it.
    pub fn save(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.put(&self.state);
        out.put(&(self.next_dt, self.bound, self.energy, self.rupture_count, self.least_radius));
        out.put(&self.ruptures);
        out.put(&self.monitor);
        self.holds.save(&mut out);
        self.measures.save(&mut out);
        if let Some(bonds) = &self.bonds {
            bonds.save(&mut out);
        }
        out.put(&self.contacts.as_ref().map(|contacts| contacts.stale));
        if let Some(contacts) = &self.contacts {
            contacts.neighbours.save(&mut out);
            contacts.stage.save(&mut out);
        }
        if let Some(rigid) = &self.rigid {
            rigid.save(&mut out);
        }
        out.into_bytes()
    }

    /// Takes up a state of the same scene: what comes after is what came after it there, to the bit, on any number of
    /// threads.
    ///
    /// # Errors
    /// [`Unfit`] when the bytes are no state, or one of another scene. The engine is of no use then.
    pub fn restore(&mut self, bytes: &[u8]) -> std::result::Result<(), Unfit> {
        let mut from = Reader::new(bytes);
        let (particles, slots) = (self.state.len(), self.state.bond.data.len());
        self.state = from.take()?;
        if !self.state.fits(particles) || self.state.bond.data.len() != slots {
            return Err(Unfit(format!("its particles are not the {particles} of this scene")));
        }
        (self.next_dt, self.bound, self.energy, self.rupture_count, self.least_radius) = from.take()?;
        self.ruptures = from.take()?;
        self.monitor = from.take()?;
        self.holds.restore(&mut from)?;
        self.measures.restore(&mut from)?;
        if let Some(bonds) = &mut self.bonds {
            bonds.restore(&mut from)?;
        }
        let stale: Option<bool> = from.take()?;
        // Contacts may have come in later than at the start, but none goes again.
        if stale.is_some() && self.contacts.is_none() {
            let [force, torque] = [self.state.contact_force.clone(), self.state.contact_torque.clone()];
            self.add_contacts();
            (self.state.contact_force, self.state.contact_torque) = (force, torque);
        }
        match (stale, &mut self.contacts) {
            (Some(stale), Some(contacts)) => {
                contacts.stale = stale;
                contacts.neighbours.restore(&mut from)?;
                contacts.stage.restore(&mut from, &self.state)?;
            }
            (None, None) => {}
            _ => return Err(Unfit("it has no contacts, which this scene needs".into())),
        }
        if let Some(rigid) = &mut self.rigid {
            rigid.restore(&mut from, &self.state)?;
        }
        from.end()
    }
}
