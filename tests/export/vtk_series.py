"""A time series of VTK files in VTK: arrays, broken bonds, times. Writes a picture. Arguments: folder of the run, of the
export, the picture."""

import csv
import sys
import xml.etree.ElementTree as ElementTree

import vtk
from vtk.util.numpy_support import vtk_to_numpy

run, export, picture = sys.argv[1:]


class Errors:
    """VTK tells errors only to observers."""

    told = []

    def __call__(self, _source, _event, message):
        self.told.append(message)

    CallDataType = vtk.VTK_STRING


def read(file):
    reader = vtk.vtkXMLPolyDataReader()
    reader.AddObserver("ErrorEvent", Errors())
    reader.SetFileName(f"{export}/{file}")
    reader.Update()
    assert not Errors.told, Errors.told
    return reader.GetOutput()


def array(data, name):
    found = data.GetArray(name)
    assert found is not None, name
    return vtk_to_numpy(found)


def series(kind):
    sets = ElementTree.parse(f"{export}/{kind}.pvd").getroot().iter("DataSet")
    return [(float(entry.get("timestep")), entry.get("file")) for entry in sets]


def table(name):
    with open(f"{run}/{name}.csv") as file:
        return list(csv.DictReader(file))


curve = {int(row["step"]): row for row in table("curve")}
ruptures = table("ruptures")
wires, bonds = series("wires"), series("bonds")
assert [time for time, _ in wires] == [time for time, _ in bonds] == sorted(time for time, _ in wires)
matched = 0
for time, file in wires:
    fields = read(file).GetFieldData()
    assert abs(array(fields, "TimeValue")[0] - time) < 1e-15
    row = curve.get(int(array(fields, "step")[0]))
    if row is not None:
        matched += 1
        assert abs(float(row["time_s"]) - time) < 1e-8 * time + 1e-15
        assert abs(float(row["strain_percent"]) - array(fields, "strain_percent")[0]) < 1e-6
assert matched > 1

first, last = read(wires[0][1]), read(wires[-1][1])
wire_count = len(table("wires"))
assert first.GetNumberOfLines() == wire_count and first.GetNumberOfVerts() == 0
# Each break takes a wire into one piece more, whether that is a line or a single particle.
assert last.GetNumberOfLines() + last.GetNumberOfVerts() == wire_count + len(ruptures)
assert set(array(last.GetCellData(), "wire")) == set(range(1, wire_count + 1))
names = last.GetFieldData().GetAbstractArray("layers")
layers = [names.GetValue(k) for k in range(names.GetNumberOfValues())]
assert layers and all(layers[int(array(last.GetPointData(), "layer")[0]) - 1] == row["layer"] for row in table("wires")[:1])
assert array(last.GetPointData(), "displacement_mm").shape == (last.GetNumberOfPoints(), 3)

ends = read(bonds[-1][1])
states, of_wire, number = (array(ends.GetCellData(), name) for name in ["state", "wire", "bond"])
assert (states == 2).sum() == len(ruptures) > 0
gone = set(zip(of_wire[states == 2].tolist(), number[states == 2].tolist()))
assert gone == {(int(row["wire"]), int(row["bond"])) for row in ruptures}
assert (array(ends.GetCellData(), "stress_mpa")[states == 2] == 0).all()
assert (array(read(bonds[0][1]).GetCellData(), "state") != 2).all()

# A picture without a screen: tubes of the wires' own radius, coloured by stress; broken bonds red.
tubes = vtk.vtkTubeFilter()
last.GetPointData().SetActiveScalars("radius_mm")
tubes.SetInputData(last)
tubes.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
tubes.SetNumberOfSides(24)
tubes.CappingOn()
mapper = vtk.vtkPolyDataMapper()
mapper.SetInputConnection(tubes.GetOutputPort())
mapper.SetScalarModeToUsePointFieldData()
mapper.SelectColorArray("stress_mpa")
stress = array(last.GetPointData(), "stress_mpa")
mapper.SetScalarRange(0, float(stress.max()))
colours = vtk.vtkColorTransferFunction()
for at, rgb in [(0, (0.23, 0.30, 0.75)), (0.5, (0.87, 0.87, 0.87)), (1, (0.71, 0.02, 0.15))]:
    colours.AddRGBPoint(at * float(stress.max()), *rgb)
mapper.SetLookupTable(colours)
actor = vtk.vtkActor()
actor.SetMapper(mapper)
bar = vtk.vtkScalarBarActor()
bar.SetLookupTable(colours)
bar.SetTitle("stress_mpa")
bar.SetPosition(0.92, 0.1)
bar.SetMaximumWidthInPixels(60)
bar.SetNumberOfLabels(3)
bar.SetLabelFormat("{:.0f}")
bar.UnconstrainedFontSizeOn()
for words, size in [(bar.GetTitleTextProperty(), 14), (bar.GetLabelTextProperty(), 13)]:
    words.SetFontSize(size)
    words.ItalicOff()
    words.BoldOff()
renderer = vtk.vtkRenderer()
renderer.SetBackground(0.09, 0.1, 0.12)
renderer.AddActor(actor)
renderer.AddViewProp(bar)
window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(1200, 300)
window.SetMultiSamples(4)
window.AddRenderer(renderer)
camera = renderer.GetActiveCamera()
low, high = last.GetBounds()[4:]
# Room for the bar on the right.
middle = (low + high) / 2 - 0.05 * (high - low)
camera.SetFocalPoint(0, 0, middle)
camera.SetPosition(3 * (high - low), high - low, middle)
camera.SetViewUp(0, 1, 0)
camera.ParallelProjectionOn()
camera.SetParallelScale(0.15 * (high - low))
renderer.ResetCameraClippingRange()
window.Render()
grab = vtk.vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
writer = vtk.vtkPNGWriter()
writer.SetFileName(picture)
writer.SetInputConnection(grab.GetOutputPort())
writer.Write()
grab.Update()
pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
assert len({tuple(pixel) for pixel in pixels[::7]}) > 100, "the picture is empty"
print(f"{len(wires)} snapshots, {len(ruptures)} broken bonds, picture in {picture}")
