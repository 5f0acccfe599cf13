//! Random small strands: whatever the scene, its files agree.

use crate::{run_into, scene, wrong};
use proptest::prelude::*;

/// A strand of one or two layers, pulled.
#[derive(Debug, Clone)]
struct Random {
    layers: Vec<(usize, f64, bool)>,
    core: bool,
    diameter: f64,
    spacing: f64,
    elastic: bool,
    shape: &'static str,
    tangential: &'static str,
    criterion: &'static str,
    modulus: &'static str,
    speed: f64,
    samples: usize,
    seed: u64,
}

fn random() -> impl Strategy<Value = Random> {
    let layers = (prop::collection::vec((2..6usize, 8.0..20.0f64, any::<bool>()), 1..3), any::<bool>());
    let wire = (0.2..0.6f64, prop_oneof![Just(1.0), Just(0.7)], any::<bool>());
    let words = (
        Just("sphere"),
        prop_oneof![Just("mindlin"), Just("mindlin-deresiewicz"), Just("none")],
        prop_oneof![
            Just("{ criterion = \"plastic-strain\", strain = \"2 %\""),
            Just("{ criterion = \"fibre-strain\", strain = \"3 %\""),
            Just("{ criterion = \"beam-stress\", tensile = \"150 MPa\", shear = \"150 MPa\""),
        ],
        prop_oneof![Just("20"), Just("inf")],
    );
    let drive = (4.0..12.0f64, prop_oneof![Just(60usize), Just(400)], 1..50u64);
    (layers, wire, words, drive).prop_map(
        |(
            (layers, core),
            (diameter, spacing, elastic),
            (shape, tangential, criterion, modulus),
            (speed, samples, seed),
        )| {
            Random {
                layers,
                core,
                diameter,
                spacing,
                elastic,
                shape,
                tangential,
                criterion,
                modulus,
                speed,
                samples,
                seed,
            }
        },
    )
}

impl Random {
    fn text(&self) -> String {
        // Elastic bonds have no plastic strain to break by; the stranding alone bends their fibres by up to 2 %.
        let criterion = if self.elastic && self.criterion.contains("plastic") {
            "{ criterion = \"fibre-strain\", strain = \"3 %\""
        } else {
            self.criterion
        };
        let law = if self.elastic {
            "law = \"elastic\"".to_owned()
        } else {
            "law = \"elasto-plastic\"\nhardening = { form = \"voce\", yield_stress = \"100 MPa\", saturation = \"180 MPa\", \
             rate = 12, linear = \"550 MPa\" }"
                .to_owned()
        };
        let mut text = format!(
            "about = \"A random strand.\"\nseed = {}\nspacing = {}\n[bond]\n{law}\ndamping = 0.05\nrupture = {criterion}, \
             weibull_modulus = {} }}\n[contact]\nnormal = \"thornton\"\nlimiting_pressure = \"500 MPa\"\ntangential = \"{}\"\n\
             friction = 0.2\nshape = \"{}\"\ndamping = 0.1\n[grip]\nlength = \"2 mm\"\nspeed = \"{} m/s\"\n[stop]\n\
             strain = \"4 %\"\n[output]\nsamples = {}\nsnapshots = 12\n[strand]\nlength = \"12 mm\"\nwire_diameter = \"{} mm\"\n",
            self.seed, self.spacing, self.modulus, self.tangential, self.shape, self.speed, self.samples, self.diameter,
        );
        if self.core {
            text += "[[strand.layer]]\nname = \"core\"\nwires = 1\npitch = \"inf\"\n";
        }
        for (k, (wires, pitch, left)) in self.layers.iter().enumerate() {
            let lay = if *left { "left" } else { "right" };
            text += &format!(
                "[[strand.layer]]\nname = \"layer {k}\"\nwires = {wires}\npitch = \"{pitch} mm\"\nlay = \"{lay}\"\n\
                 lay_radius = \"auto\"\n"
            );
        }
        text
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, max_shrink_iters: 20, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn files_of_random_strands_agree(strand in random()) {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        run_into(&scene(&strand.text(), &[]), &out);
        let wrong = wrong(&out);
        prop_assert!(wrong.is_empty(), "{}\n{}", wrong.join("\n"), strand.text());
    }
}
