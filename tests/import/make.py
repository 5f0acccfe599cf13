#!/usr/bin/env python3
"""Makes the models of this folder with programs that people draw with: CadQuery (OpenCascade) and ezdxf.

    python3 -m venv v && v/bin/pip install cadquery==2.8.0 ezdxf==1.4.5 && v/bin/python make.py

What the files are made with stands here and in ../import.rs, which compares what the import finds with it.
"""

import math
import pathlib
import sys

import cadquery as cq
import ezdxf
from OCP.Geom import Geom_BezierCurve
from OCP.GeomConvert import GeomConvert, GeomConvert_BSplineCurveToBezierCurve
from OCP.Interface import Interface_Static
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TColStd import TColStd_Array1OfReal
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Pnt

here = pathlib.Path(__file__).parent
RADIUS, PITCH, LENGTH, WIRE, CORE = 0.402, 10.0, 12.0, 0.39, 0.41  # mm


def helix(phase, pitch=PITCH, length=LENGTH, radius=RADIUS, left=False):
    """A helix about z that begins at an angle (degrees)."""
    wire = cq.Wire.makeHelix(pitch, length, radius, lefthand=left)
    return wire.rotate(cq.Vector(0, 0, 0), cq.Vector(0, 0, 1), phase)


def core(length=LENGTH):
    return cq.Wire.assembleEdges([cq.Edge.makeLine(cq.Vector(0, 0, 0), cq.Vector(0, 0, length))])


def tube(phase, left=False):
    """A circle swept along a helix."""
    path = helix(phase, left=left)
    a, lay = math.radians(phase), -1 if left else 1
    slope = lay * 2 * math.pi * RADIUS / PITCH
    plane = cq.Plane(
        origin=(RADIUS * math.cos(a), RADIUS * math.sin(a), 0),
        xDir=(math.cos(a), math.sin(a), 0),
        normal=(-slope * math.sin(a), slope * math.cos(a), 1),
    )
    return cq.Workplane(plane).circle(WIRE / 2).sweep(cq.Workplane(obj=path), isFrenet=True).val()


def write(shape, name, schema="AP214IS", unit="MM"):
    Interface_Static.SetCVal_s("write.step.schema", schema)
    shape.exportStep(str(here / name), outputUnit=unit)
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")


def curve_of(edge):
    return BRep_Tool.Curve_s(edge.wrapped, 0.0, 1.0)


def edge(curve):
    return cq.Edge(BRepBuilderAPI_MakeEdge(curve).Edge())


def rational(phase):
    """A helix as rational Bézier pieces: weights q^i leave a curve as it is and change how it is run through."""
    spline = GeomConvert.CurveToBSplineCurve_s(curve_of(helix(phase).Edges()[0]))
    spline.Segment(spline.FirstParameter(), spline.LastParameter())
    for k in range(1, 4):
        at = spline.FirstParameter() + k / 4 * (spline.LastParameter() - spline.FirstParameter())
        spline.InsertKnot(at, spline.Degree(), 1e-9)
    pieces = GeomConvert_BSplineCurveToBezierCurve(spline)
    edges = []
    for k in range(1, pieces.NbArcs() + 1):
        arc = pieces.Arc(k)
        points, weights = TColgp_Array1OfPnt(1, arc.NbPoles()), TColStd_Array1OfReal(1, arc.NbPoles())
        for i in range(1, arc.NbPoles() + 1):
            points.SetValue(i, arc.Pole(i))
            weights.SetValue(i, 1.1 ** (i - 1))
        bezier = Geom_BezierCurve(points, weights)
        edges.append(edge(GeomConvert.CurveToBSplineCurve_s(bezier)))
    # Out of order, as drawings come.
    return cq.Compound.makeCompound(edges[::-1])


def bent():
    """A line, an arc as a rational B-spline, a line: a wire bent over a radius of 5 mm by 60 degrees."""
    c, s = math.cos(math.radians(60)), math.sin(math.radians(60))
    half = math.radians(30)
    centre = (5.0, 0.0, 0.0)
    on = lambda a: gp_Pnt(centre[0] - 5 * math.cos(a), 0.0, 5 * math.sin(a))
    arc = GC_MakeArcOfCircle(on(0.0), on(half), on(2 * half)).Value()
    end = on(2 * half)
    last = cq.Vector(end.X() + 10 * s, 0.0, end.Z() + 10 * c)
    parts = [
        cq.Edge.makeLine(cq.Vector(0, 0, -10), cq.Vector(0, 0, 0)),
        edge(GeomConvert.CurveToBSplineCurve_s(arc)),
        cq.Edge.makeLine(cq.Vector(end.X(), 0.0, end.Z()), last),
    ]
    return cq.Compound.makeCompound(parts)


def bent_tube():
    """The same as a tube: cylinder, torus, cylinder."""
    c = math.radians(60)
    end = (5 - 5 * math.cos(c), 5 * math.sin(c))
    path = (
        cq.Workplane("XZ")
        .moveTo(0, -10)
        .lineTo(0, 0)
        .threePointArc((5 - 5 * math.cos(c / 2), 5 * math.sin(c / 2)), end)
        .lineTo(end[0] + 10 * math.sin(c), end[1] + 10 * math.cos(c))
    )
    return cq.Workplane("XY").workplane(offset=-10).circle(0.5).sweep(path).val()


def step():
    outer = [helix(60 * i) for i in range(6)]
    strand = cq.Compound.makeCompound([core(), *outer])
    write(strand, "curves.step")
    write(strand, "curves-ap203.step", schema="AP203")
    write(strand, "curves-ap242.step", schema="AP242DIS")
    write(strand, "curves-inch.step", unit="INCH")
    write(strand, "curves-metre.step", unit="M")
    write(cq.Compound.makeCompound([core(), *[rational(60 * i) for i in range(6)]]), "rational.step")
    write(bent(), "bent.step")
    write(bent_tube(), "bent-tube.step")
    # A core and one left-laid wire that is set in six times; the whole lies along x, away from the origin.
    strand = cq.Assembly(name="strand")
    strand.add(cq.Solid.makeCylinder(CORE / 2, LENGTH), name="core")
    wire = tube(0, left=True)
    for i in range(6):
        strand.add(wire, name=f"wire {i}", loc=cq.Location(cq.Vector(0, 0, 0), cq.Vector(0, 0, 1), 60 * i))
    whole = cq.Assembly(name="whole")
    whole.add(strand, loc=cq.Location(cq.Plane(origin=(30, -4, 7), xDir=(0, 1, 0), normal=(1, 0, 0))))
    whole.export(str(here / "assembly.step"))
    whole.export(str(here / "assembly-inch.step"), outputUnit="INCH")
    # Tubes without an assembly around them, and the path of one of them left in the drawing.
    tubes = [tube(120 * i) for i in range(3)]
    write(cq.Compound.makeCompound([*tubes, helix(0)]), "tubes.step")
    # What is no wire: a block, a ring, a hollow tube.
    hollow = cq.Workplane("XY").circle(1).circle(0.6).extrude(10).val()
    others = [cq.Solid.makeBox(1, 1, 1), cq.Solid.makeTorus(3, 0.2), hollow, core()]
    write(cq.Compound.makeCompound(others), "others.step")


def points(phase, count=60):
    for k in range(count + 1):
        z = LENGTH * k / count
        a = math.radians(phase) + 2 * math.pi * z / PITCH
        yield (RADIUS * math.cos(a), RADIUS * math.sin(a), z)


def dxf():
    # Splines with weights, and a line in pieces.
    drawing = ezdxf.new("R2013")
    drawing.header["$INSUNITS"] = 4
    model = drawing.modelspace()
    for i in range(6):
        for part in rational(60 * i).Edges():
            curve = GeomConvert.CurveToBSplineCurve_s(curve_of(part))
            poles = [curve.Pole(k) for k in range(1, curve.NbPoles() + 1)]
            weights = [curve.Weight(k) for k in range(1, curve.NbPoles() + 1)]
            spline = model.add_spline()
            spline.dxf.degree = curve.Degree()
            spline.control_points = [(p.X(), p.Y(), p.Z()) for p in poles]
            spline.weights = weights
            knots = []
            for k in range(1, curve.NbKnots() + 1):
                knots += [curve.Knot(k)] * curve.Multiplicity(k)
            spline.knots = knots
    model.add_line((0, 0, 7), (0, 0, 0))
    model.add_line((0, 0, 7), (0, 0, 12))
    model.add_text("1 + 6")
    drawing.saveas(here / "splines.dxf")
    # Polylines of points, in inches, along x.
    drawing = ezdxf.new("R2000")
    drawing.header["$INSUNITS"] = 1
    model = drawing.modelspace()
    turned = lambda ps: [(z / 25.4 + 3, x / 25.4, y / 25.4) for x, y, z in ps]
    for i in range(6):
        model.add_polyline3d(turned(points(60 * i)))
    model.add_polyline3d(turned([(0, 0, 0), (0, 0, LENGTH)]))
    drawing.saveas(here / "polylines-inch.dxf")
    # A block with one HELIX that is set in six times; no unit.
    drawing = ezdxf.new("R2013")
    drawing.header["$INSUNITS"] = 0
    block = drawing.blocks.new("wire", base_point=(1, 2, 3))
    block.add_helix(RADIUS, PITCH, LENGTH / PITCH).translate(1, 2, 3)
    model = drawing.modelspace()
    for i in range(6):
        model.add_blockref("wire", (0, 0, 0), {"rotation": 60 * i})
    model.add_line((0, 0, 0), (0, 0, LENGTH))
    drawing.saveas(here / "helices.dxf")
    # In a plane that stands upright: a polyline with a bulge, an arc, an ellipse as an arc, a circle.
    drawing = ezdxf.new("R2013")
    drawing.header["$INSUNITS"] = 4
    model = drawing.modelspace()
    # Extrusion along y: its x is -x, its y is z.
    upright = {"extrusion": (0, 1, 0)}
    c, s = math.cos(math.radians(60)), math.sin(math.radians(60))
    end = (5 - 5 * c, 5 * s)
    bulge = math.tan(math.radians(60) / 4)
    vertices = [(0, -10, 0), (0, 0, bulge), (-end[0], end[1], 0), (-end[0] - 10 * s, end[1] + 10 * c, 0)]
    model.add_lwpolyline(vertices, format="xyb", dxfattribs=upright)
    model.add_arc((-20, 0), 5, 0, 90, dxfattribs=upright)
    model.add_ellipse((50, 0, 0), (0, 0, 8), 0.5, 0, math.pi / 2, dxfattribs={"extrusion": (0, 1, 0)})
    model.add_circle((0, 0), 3)
    drawing.saveas(here / "plane.dxf")
    thin(here)


def thin(folder):
    """ezdxf writes tables, styles and objects that no wire needs: header, blocks and entities stay."""
    for path in folder.glob("*.dxf"):
        lines = path.read_text().splitlines()
        pairs = list(zip(lines[::2], lines[1::2]))
        kept, section, keep = [], [], False
        for code, value in pairs:
            if code.strip() == "0" and value == "SECTION":
                section = [(code, value)]
                continue
            if section and code.strip() == "2" and len(section) == 1:
                section.append((code, value))
                keep = value in ("HEADER", "BLOCKS", "ENTITIES")
                if keep:
                    kept += section
                continue
            if section:
                if keep:
                    kept.append((code, value))
                if code.strip() == "0" and value == "ENDSEC":
                    section = []
                continue
            kept.append((code, value))
        path.write_text("".join(f"{c}\n{v}\n" for c, v in kept))


if __name__ == "__main__":
    step()
    dxf()
    sizes = {path.name: path.stat().st_size for path in sorted(here.glob("*.step")) + sorted(here.glob("*.dxf"))}
    print(sizes, sum(sizes.values()), file=sys.stderr)
