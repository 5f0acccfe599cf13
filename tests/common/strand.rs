//! A strand that is over within seconds.

/// Two layers that break, rub and yield within seconds, pulled adaptively.
pub const STRAND: &str = r#"
about = "A strand of six wires that yields, rubs and breaks."
seed = 3
[material]
density = "8960 kg/m^3"
young = "115 GPa"
poisson = 0.34
[bond]
law = "elasto-plastic"
damping = 0.02
hardening = { form = "voce", yield_stress = "100 MPa", saturation = "100 MPa", rate = 12, linear = "500 MPa" }
rupture = { criterion = "plastic-strain", strain = "4 %", weibull_modulus = 8 }
[contact]
normal = "thornton"
tangential = "mindlin"
friction = 0.2
hardness_strain = "8 %"
[strand]
length = "8 mm"
[[strand.layer]]
wires = 1
wire_diameter = "0.39 mm"
pitch = "inf"
[[strand.layer]]
wires = 5
wire_diameter = "0.39 mm"
pitch = "12 mm"
[grip]
length = "0.8 mm"
speed = "2 m/s"
adaptive = { fastest = "6 m/s", kinetic = "10 %", passages = 4 }
[stop]
strain = 0.07
[output]
samples = 60
snapshots = 6
checkpoint = 150
"#;
