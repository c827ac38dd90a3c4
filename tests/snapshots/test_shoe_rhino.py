"""Files of Rhino as they are read: blocks, layers, names, what is hidden or has no mesh."""

import pytest

import sole_forms as made
from snapshot import held, refusal
from underfoot.shoe.files.read import read_mesh
from underfoot.shoe.files.rhino import read_rhino

FORMS = [name for name, (ending, _) in made.FORMS.items() if ending == "3dm"]


def answer(path):
    try:
        file = read_rhino(path)
    except Exception as error:
        return f"{type(error).__name__}: {error}".replace(str(path), "sole.3dm")
    bodies = [
        (body.label, body.visible, body.kind, body.size, body.placement[:3],
         [tuple(each) for each in (body.vertices.min(axis=0), body.vertices.max(axis=0))])
        for body in file.bodies
    ]  # fmt: skip
    return {"unit": file.unit, "unmet": file.unmet, "bodies": bodies}


@pytest.mark.parametrize("name", FORMS)
def test_forms_of_rhino(file_regression, tmp_path, name):
    pytest.importorskip("rhino3dm")
    path = tmp_path / "sole.3dm"
    path.write_bytes(made.FORMS[name][1](tmp_path))
    mesh = read_mesh(path)
    held(file_regression, {"file": answer(path), "mesh": mesh}, name.replace(": ", " "))


def test_blocks_layers_and_what_has_no_mesh(file_regression, tmp_path):
    rhino = pytest.importorskip("rhino3dm")
    path, answers = tmp_path / "sole.3dm", {}

    def file_of(fill):
        file = rhino.File3dm()
        fill(file)
        assert file.Write(str(path), 7)
        return answer(path)

    def mesh(*bodies):
        return made.rhino_mesh(rhino, bodies or [made.base()])

    def named(name="", layer=None, **more):
        return made.rhino_attributes(rhino, name, layer, **more)

    def instance(file, number, place=None, attributes=None):
        identity = file.InstanceDefinitions.FindIndex(number).Id
        place = place or rhino.Transform.Identity()
        return rhino.InstanceReference(identity, place), attributes or named()

    def blocks(file):
        layers = [made.rhino_layer(rhino, file, name) for name in ("Rubber", "Foam")]
        off = made.rhino_layer(rhino, file, "Off", visible=False)
        below = made.rhino_layer(rhino, file, "Below", parent=off)
        number = made.rhino_block(
            file, rhino, "inner", [mesh(), mesh(made.lug(1, 1)), mesh(made.lug(2, 1))],
            [named("", layers[0]), named("own", layers[1]), named("hidden", below)],
        )  # fmt: skip
        turn = rhino.Transform.Rotation(0.5, rhino.Vector3d(0, 0, 1), rhino.Point3d(0, 0, 0))
        file.Objects.AddInstanceObject(*instance(file, number, None, named("plain")))
        file.Objects.AddInstanceObject(*instance(file, number, turn, named("", layers[1])))
        file.Objects.AddInstanceObject(*instance(file, number, None, named("off", off)))
        file.Objects.AddInstanceObject(
            *instance(file, number, None, named("unseen", visible=False))
        )

    answers["blocks"] = file_of(blocks)

    def quads(file):
        flat = rhino.Mesh()
        for corner in ((0, 0, 0), (4, 0, 0), (1, 1, 0), (0, 4, 0), (9, 9, 0)):
            flat.Vertices.Add(*corner)
        flat.Faces.AddFace(0, 1, 2, 3)
        flat.Faces.AddFace(1, 2, 3, 0)
        flat.Faces.AddFace(1, 4, 3)
        file.Objects.AddMesh(flat, named("dart"))

    file_of(quads)
    (body,) = read_rhino(path).bodies
    # a quadrilateral with a corner that points inward is cut through that corner
    assert sorted(map(sorted, body.faces.tolist())) == [
        [0, 1, 2], [0, 1, 2], [0, 2, 3], [0, 2, 3], [1, 3, 4]
    ]  # fmt: skip

    def surfaces(file):
        sphere = rhino.Sphere(rhino.Point3d(0, 0, 0), 2).ToBrep()
        file.Objects.AddMesh(mesh(), named("sole"))
        file.Objects.AddBrep(sphere, named("ball"))
        file.Objects.AddBrep(sphere, named("unseen", visible=False))
        circle = rhino.Circle(rhino.Point3d(0, 0, 0), 3.0).ToNurbsCurve()
        file.Objects.AddCurve(circle, named("line"))
        file.Objects.AddExtrusion(rhino.Extrusion.Create(circle, 2.0, True), named("drawn out"))

    answers["surfaces"] = file_of(surfaces)

    def far(file):
        one = rhino.Mesh()
        for corner in ((1e6 + 0.1, 0, 0), (1e6 + 4.3, 0, 0), (1e6, 4.7, 0)):
            one.Vertices.Add(*corner)
        one.Faces.AddFace(0, 1, 2)
        file.Objects.AddMesh(one, named("far"))

    answers["far"] = file_of(far)
    for unit in ("Meters", "Centimeters", "Microns", "Feet", "Kilometers", "Yards"):

        def of_unit(file, unit=unit):
            file.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, unit)
            file.Objects.AddMesh(mesh(), named("sole"))

        answers[unit] = file_of(of_unit)["unit"]
    path.write_bytes(b"3D Geometry File Format " + bytes(50))
    answers["damaged"] = refusal(read_rhino, path).replace(str(path), "sole.3dm")
    held(file_regression, answers)
