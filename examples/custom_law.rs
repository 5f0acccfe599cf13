//! A bond law of one's own, without touching the engine: a yarn that stiffens as it is strained, σ = E (ε + c ε²), as aramid
//! does. `cargo run --release --no-default-features --example custom_law`

use std::error::Error;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use strandsnap::base::lanes::Real;
use strandsnap::engine::Engine;
use strandsnap::law::bond::elastic::Elastic;
use strandsnap::law::bond::{BondForce, BondIncrement, BondLaw, BondShape, BondStiffness, Moduli, Section};
use strandsnap::observe::Observer;
use strandsnap::observe::summary::Summariser;
use strandsnap::{run, scene};

/// Elastic in all modes, with an axial stress E (ε + c ε²) over log strain ε ≥ 0.
#[derive(Clone)]
pub struct Stiffening {
    /// The other modes.
    pub linear: Elastic,
    /// c (-).
    pub rise: f64,
}

impl Stiffening {
    /// EA (N).
    fn axial_stiffness<R: Real>(&self, shape: &BondShape<R>) -> R {
        Section::round(shape.radius).area * self.linear.moduli.young
    }
}

/// Laws are written once for numbers and for registers of them (`R`): arithmetic works as on numbers, and a constant is made
/// like a number that is there, `x.splat(1.0)`. The history here is one number, the log strain.
impl BondLaw for Stiffening {
    type State<R: Real> = R;

    const HISTORY: usize = 1;

    #[inline(always)]
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> R {
        numbers(0)
    }

    #[inline(always)]
    fn each_number<R: Real>(strain: &R, mut put: impl FnMut(usize, R)) {
        put(0, *strain);
    }

    fn initial(&self) -> f64 {
        0.0
    }

    #[inline(always)]
    fn response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        strain: &mut R,
        step: &BondIncrement<R>,
        live: R::Mask,
    ) -> R {
        // Shear, bending and torsion are linear; what the linear law says of the axis is replaced.
        self.linear.response(shape, force, &mut (), step, live);
        self.axial_response(shape, force, strain, step, live)
    }

    #[inline(always)]
    fn axial_response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        strain: &mut R,
        step: &BondIncrement<R>,
        _: R::Mask,
    ) -> R {
        *strain = step.log_strain;
        // In compression it is linear.
        let stretched = strain.simd_max(strain.splat(0.0));
        force.axial = self.axial_stiffness(shape) * (*strain + stretched * stretched * self.rise);
        // No plastic work.
        strain.splat(0.0)
    }

    /// The tangent, which the bound on the time step follows.
    #[inline(always)]
    fn stiffness<R: Real>(&self, shape: &BondShape<R>, strain: &R) -> BondStiffness<R> {
        let linear = self.linear.stiffness(shape, &());
        let stretched = strain.simd_max(strain.splat(0.0));
        BondStiffness { axial: linear.axial * (stretched * (2.0 * self.rise) + 1.0), ..linear }
    }

    /// ∫ N dl with dl = l₀ e^ε dε: EA l₀ [(ε − 1) e^ε + 1 + c ((ε² − 2ε + 2) e^ε − 2)], and the linear modes.
    fn elastic_energy(&self, shape: &BondShape, force: &BondForce, strain: &f64) -> f64 {
        let (e, c) = (*strain, if *strain > 0.0 { self.rise } else { 0.0 });
        let axial = (e - 1.0) * e.exp() + 1.0 + c * ((e * e - 2.0 * e + 2.0) * e.exp() - 2.0);
        let others = BondForce { axial: 0.0, ..*force };
        self.axial_stiffness(shape) * shape.rest_length * axial + self.linear.elastic_energy(shape, &others, &())
    }

    #[inline(always)]
    fn section<R: Real>(&self, shape: &BondShape<R>, _: &R) -> Section<R> {
        Section::round(shape.radius)
    }

    #[inline(always)]
    fn plastic_strain<R: Real>(&self, _: &BondShape<R>, strain: &R) -> R {
        strain.splat(0.0)
    }

    #[inline(always)]
    fn thinning<R: Real>(&self, _: &BondShape<R>, strain: &R) -> R {
        strain.splat(1.0)
    }
}

/// A yarn between two grips; what the law does not replace (damping, rupture, contacts) is said here.
const YARN: &str = r#"
about = "A yarn of 0.5 mm, pulled."
material = { density = "1440 kg/m^3", young = "60 GPa", poisson = 0.3 }
bond = { damping = 0.1 }
wire = [{ diameter = "0.5 mm", from = ["0 mm", "0 mm", "0 mm"], to = ["0 mm", "0 mm", "30 mm"] }]
grip = { length = "2 mm", speed = "5 m/s" }
stop = { strain = "3 %" }
"#;

pub fn main() -> Result<(), Box<dyn Error>> {
    let scene = scene::parse(YARN, "yarn.toml", Path::new("."), &[])?;
    let material = scene.spec.material;
    let law = Stiffening { linear: Elastic { moduli: Moduli::new(material.young, material.poisson) }, rise: 12.0 };
    let engine = Engine::with_law(&scene.spec, &scene.plan, run::assemble(&scene)?, law)?;
    let mut summariser = Summariser::new();
    let observers: &mut [&mut dyn Observer] = &mut [&mut summariser];
    let outcome = run::simulate_engine(engine, observers, &AtomicBool::new(false))?;
    let summary = summariser.summary(&scene.spec, 0, Default::default());
    let stress = summary.residual_stress_mpa.ok_or("nothing was pulled")?;
    let strain = outcome.strain.ln_1p();
    let expected = 1e-6 * material.young * (strain + 12.0 * strain * strain);
    println!("{stress:.1} MPa at {:.2} %, by the law {expected:.1} MPa", 100.0 * outcome.strain);
    let residual = summary.energy_residual_percent.ok_or("no work was done")?;
    println!("the energy ledger closes to {residual:.4} % of the work");
    if (stress / expected - 1.0).abs() > 0.02 || residual.abs() > 0.1 {
        return Err("the engine does not follow the law".into());
    }
    Ok(())
}
