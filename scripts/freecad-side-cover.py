"""Makes programs/side-cover-freecad.ngc with FreeCAD's Path workbench and its linuxcnc post-processor.

  freecadcmd scripts/freecad-side-cover.py        (Debian package freecad; runs without a screen)

The part is a side cover, 112 x 72 x 14 with rounded corners, a pocket, and six holes; it is cut from
the block in the vise of machines/mill3, whose tools are used. Everything below the header of the
program is what the post-processor wrote. docs/programs.md says more.
"""

import os
import sys

import FreeCAD
import Part
from FreeCAD import Placement, Vector
from PathScripts import PathDrilling, PathJob, PathMillFace, PathPocketShape, PathProfile
from PathScripts import PathStock, PathToolBit, PathToolController, PathUtil, PathUtils
from PathScripts.post import linuxcnc_post

HERE = os.path.dirname(os.path.abspath(__file__))
OUT = os.path.join(os.path.dirname(HERE), "programs", "side-cover-freecad.ngc")

HEADER = """\
; side-cover-freecad.ngc: a side cover, posted by a CAM system.
; machine: mill3, as delivered (vise of the package, G54 = middle of the block's upper face)
; shows:   a program that nobody wrote by hand: FreeCAD 0.20, Path workbench, post-processor linuxcnc.
;          Made by scripts/freecad-side-cover.py; everything below this header is the post's. Verdict pass.
"""


def rounded_box(length, width, radius, bottom, top):
    """Block about the Z axis whose vertical edges are rounded."""
    box = Part.makeBox(length, width, top - bottom, Vector(-length / 2, -width / 2, bottom))
    upright = [e for e in box.Edges if abs(e.tangentAt(e.FirstParameter).z) > 0.9]
    return box.makeFillet(radius, upright)


def make_part(document):
    """The cover; its upper face is at Z -1, since the block is faced by that much."""
    body = rounded_box(112, 72, 9, -15, -1)
    body = body.cut(rounded_box(64, 34, 7, -9, 0))
    for x in (-46, 0, 46):
        for y in (-26, 26):
            body = body.cut(Part.makeCylinder(4.25, 20, Vector(x, y, -18)))
    part = document.addObject("Part::Feature", "SideCover")
    part.Shape = body.removeSplitter()
    return part


def make_tool(job, number, name, shape, diameter, length, flutes, rpm, feed, plunge):
    """A tool controller of the job. Feeds in mm/min."""
    attributes = {"name": name, "shape": shape, "attribute": {},
                  "parameter": {"Diameter": f"{diameter} mm", "Length": f"{length} mm"}}
    if shape == "endmill.fcstd":
        attributes["parameter"]["CuttingEdgeHeight"] = f"{flutes} mm"
        attributes["parameter"]["ShankDiameter"] = f"{min(diameter, 20)} mm"
    tool = PathToolBit.Factory.CreateFromAttrs(attributes, f"Bit{number}")
    controller = PathToolController.Create(f"T{number} {name}", tool, number)
    controller.SpindleSpeed = rpm
    controller.SpindleDir = "Forward"
    controller.HorizFeed = f"{feed} mm/min"
    controller.VertFeed = f"{plunge} mm/min"
    controller.HorizRapid = "18000 mm/min"
    controller.VertRapid = "15000 mm/min"
    job.Proxy.addToolController(controller)
    return controller


def faces(model, wanted):
    """Names of the faces of a shape that `wanted` accepts."""
    return [f"Face{i + 1}" for i, face in enumerate(model.Shape.Faces) if wanted(face)]


def is_level(face, z):
    return face.Surface.TypeId == "Part::GeomPlane" and abs(face.BoundBox.ZMin - z) < 1e-6 and abs(face.BoundBox.ZMax - z) < 1e-6


def set_depths(operation, start, final, step=None):
    """Depths without the expressions that tie them to the job's set-up sheet."""
    for name, value in (("StartDepth", start), ("FinalDepth", final), ("StepDown", step),
                        ("ClearanceHeight", 120), ("SafeHeight", 4)):
        if value is None or not hasattr(operation, name):
            continue
        operation.setExpression(name, None)
        setattr(operation, name, value)


def main():
    document = FreeCAD.newDocument("SideCover")
    part = make_part(document)
    document.recompute()
    job = PathJob.Create("Job", [part], None)
    for controller in list(job.Tools.Group):  # the default tool is not used
        job.Tools.removeObject(controller)
        document.removeObject(controller.Name)
    old_stock = job.Stock
    job.Stock = PathStock.CreateBox(job, Vector(120, 80, 50), Placement(Vector(-60, -40, -50), FreeCAD.Rotation()))
    document.removeObject(old_stock.Name)
    model = job.Model.Group[0]
    document.recompute()

    face_mill = make_tool(job, 5, "50 mm face mill", "endmill.fcstd", 50, 40, 9, 3200, 1100, 400)
    end_mill = make_tool(job, 1, "10 mm end mill", "endmill.fcstd", 10, 36, 22, 7600, 900, 300)
    drill = make_tool(job, 4, "8.5 mm drill", "drill.fcstd", 8.5, 74, 61, 3000, 360, 360)

    # Without a screen nobody can be asked which tool a new operation takes; each gets its own below.
    PathUtils.findToolController = lambda obj, proxy, name=None: face_mill

    face = PathMillFace.Create("Face", parentJob=job)
    face.ToolController = face_mill
    face.BoundaryShape = "Stock"
    face.StepOver = 60
    face.OffsetPattern = "ZigZag"
    set_depths(face, 0, -1, 1)

    profile = PathProfile.Create("Outline", parentJob=job)
    profile.ToolController = end_mill
    profile.Base = []
    profile.processHoles = False
    profile.processPerimeter = True
    set_depths(profile, -1, -15, 5)

    pocket = PathPocketShape.Create("Pocket", parentJob=job)
    pocket.ToolController = end_mill
    pocket.Base = [(model, faces(model, lambda f: is_level(f, -9)))]
    pocket.OffsetPattern = "Offset"
    pocket.StepOver = 45
    set_depths(pocket, -1, -9, 3)

    # Not PathDrilling.Create: it looks for holes by itself, and fails before the first recompute.
    holes = document.addObject("Path::FeaturePython", "Holes")
    holes.Proxy = PathDrilling.ObjectDrilling(holes, "Holes", job)
    holes.ToolController = drill
    holes.Base = [(model, faces(model, lambda f: f.Surface.TypeId == "Part::GeomCylinder"
                                and abs(f.Surface.Radius - 4.25) < 1e-6))]
    holes.PeckEnabled = True
    holes.PeckDepth = 6
    holes.RetractHeight = 2
    set_depths(holes, -1, -18)
    document.recompute()

    for operation in (face, profile, pocket, holes):
        if len(operation.Path.Commands) < 4:
            raise RuntimeError(f"{operation.Label} has no path")
    posted = []
    active = None
    for operation in job.Operations.Group:
        controller = PathUtil.toolControllerForOp(operation)
        if controller is not active:
            posted.append(controller)
            active = controller
        posted.append(operation)
    preamble = "G17 G54 G40 G49 G80 G90 G94\nG64 P0.01\nG53 G0 Z0\n"
    postamble = "M05\nG53 G0 Z0\nG17 G54 G90 G80 G40\nM2\n"
    linuxcnc_post.export(posted, OUT, f'--no-header --no-show-editor --preamble="{preamble}" --postamble="{postamble}"')
    with open(OUT, encoding="utf-8") as file:
        text = file.read()
    with open(OUT, "w", encoding="utf-8") as file:
        file.write(HEADER + text)
    print(f"wrote {OUT}: {len(text.splitlines())} lines")


try:
    main()
except Exception:  # freecadcmd would stay at its prompt
    import traceback
    traceback.print_exc()
    sys.stdout.flush()
    os._exit(1)
os._exit(0)
