"""LAMMPS files and extended XYZ in OVITO: trajectories, bonds, broken ones. Writes a picture. Arguments: folder of the run,
of the LAMMPS export, of the XYZ export, the picture. Ends with 3 where all is well but nothing can be drawn."""

import csv
import sys

import numpy
from ovito.io import import_file
from ovito.modifiers import AssignColorModifier, ColorCodingModifier, ExpressionSelectionModifier, LoadTrajectoryModifier
from ovito.vis import TachyonRenderer, Viewport

run, lammps, xyz, picture = sys.argv[1:]


def table(name):
    with open(f"{run}/{name}.csv") as file:
        return list(csv.DictReader(file))


curve = {int(row["step"]): row for row in table("curve")}
ruptures, wires = table("ruptures"), table("wires")

# Topology from the data file, motion and bonds from the dumps.
pipeline = import_file(f"{lammps}/particles.data")
start = pipeline.compute(0)
bonds = start.particles.bonds.count
motion = LoadTrajectoryModifier()
motion.source.load(f"{lammps}/particles.dump")
pipeline.modifiers.append(motion)
history = LoadTrajectoryModifier()
history.source.load(
    f"{lammps}/bonds.dump",
    columns=[None, "Particle Identifiers.1", "Particle Identifiers.2", "Bond Type", "stress", "plastic_strain",
             "utilisation", "state"],
)
pipeline.modifiers.append(history)
frames = motion.source.num_frames
assert frames == history.source.num_frames > 1
matched = 0
for frame in range(frames):
    data = pipeline.compute(frame)
    row = curve.get(data.attributes["Timestep"])
    if row is not None:
        matched += 1
        assert abs(float(row["time_s"]) - data.attributes["Time"]) < 1e-7 * data.attributes["Time"] + 1e-15
assert matched > 1
end = pipeline.compute(frames - 1)
particles = end.particles
assert particles.bonds.count == bonds
state = numpy.asarray(particles.bonds["state"])
assert (state == 2).sum() == len(ruptures) > 0
assert (numpy.asarray(pipeline.compute(0).particles.bonds["state"]) != 2).all()
assert (numpy.asarray(particles.bonds["stress"])[state == 2] == 0).all()
ends = numpy.asarray(particles.bonds.topology)[state == 2]
molecule = numpy.asarray(particles["Molecule Identifier"])
assert sorted(molecule[ends[:, 0]]) == sorted(int(row["wire"]) for row in ruptures)
assert (molecule[ends[:, 0]] == molecule[ends[:, 1]]).all()
radius = numpy.asarray(particles["Radius"])
assert 0.5 < 2e3 * radius.max() / float(wires[0]["diameter_mm"]) < 2, radius.max()
assert len(set(molecule)) == len(wires)

# Extended XYZ: the same particles in mm.
text = import_file(f"{xyz}/particles.xyz")
assert text.num_frames == frames
other = text.compute(frames - 1)
difference = numpy.abs(numpy.asarray(other.particles.positions) - 1e3 * numpy.asarray(particles.positions))
assert difference.max() < 1e-5, difference.max()
assert numpy.abs(numpy.asarray(other.particles["Radius"]) - 1e3 * radius).max() < 1e-6
touched = {int(p) for pair in ends for p in pair}
assert set(numpy.flatnonzero(numpy.asarray(other.particles["broken"]))) == touched
assert abs(other.attributes["time_s"] - end.attributes["Time"]) < 1e-9
assert {kind.name for kind in other.particles.particle_types.types} >= {row["layer"] for row in wires}

# A picture without a screen: bonds as thick as the wires, coloured by stress, the broken ones red.
pipeline.modifiers.append(ColorCodingModifier(operate_on="bonds", property="stress", gradient=ColorCodingModifier.Viridis()))
pipeline.modifiers.append(ExpressionSelectionModifier(operate_on="bonds", expression="state == 2"))
pipeline.modifiers.append(AssignColorModifier(operate_on="bonds", color=(1, 0.1, 0.1)))
shown = pipeline.compute(frames - 1).particles.bonds
assert numpy.count_nonzero(shown.selection) == len(ruptures)
pipeline.source.data.particles.vis.enabled = False
pipeline.source.data.particles.bonds.vis.width = float(2 * radius.max())
pipeline.source.data.cell.vis.enabled = False
pipeline.add_to_scene()
view = Viewport(type=Viewport.Type.Ortho, camera_dir=(-3, -1, 0), camera_up=(0, 1, 0))
view.zoom_all(size=(1200, 300))
# The strand has become longer since the first frame.
view.fov *= 1.15
try:
    view.render_image(
        filename=picture, size=(1200, 300), frame=frames - 1, background=(1, 1, 1), renderer=TachyonRenderer()
    )
except RuntimeError as error:
    # OVITO asks for a Vulkan driver even where Tachyon draws.
    print(f"no picture: {error}")
    sys.exit(3)
print(f"{frames} frames, {len(ruptures)} broken bonds, picture in {picture}")
