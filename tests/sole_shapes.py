"""Treads of every pattern and soles of every form, small enough to be held to their answers."""

from dataclasses import replace

from underfoot.shoe.free_land import free_land
from underfoot.shoe.lettering import Lettering
from underfoot.shoe.parametric.sole import ShoeOutline, ToeSpring, WholeSole
from underfoot.shoe.shape import Facet, Heel, Rocker
from underfoot.shoe.tread import PATTERNS, Groove, Sipes, Tread
from underfoot.shoe.worn.forms import WearPlane, WornPatch

BOX = ((0.0, 0.0), (4e-3, 0.0), (4e-3, 7e-3), (0.0, 7e-3))
HOLE = ((1e-3, 1e-3), (3e-3, 1e-3), (3e-3, 6e-3), (1e-3, 6e-3))
BAR = ((6e-3, 0.0), (7e-3, 1e-3), (7e-3, 7e-3), (6e-3, 6e-3))
LETTERS = Lettering((BOX, BAR), (HOLE,), 2e-3)
SINGLE = free_land((("cos1_cos0", 1.0), ("cos0_cos1", 0.6)), (6e-3, 5e-3), 0.6, 1.5e-3, 1.2e-3)
MORE = {
    "blocks": {"lug_length": 7e-3},
    "chevrons": {"arm_length": 9e-3, "angle": 0.5},
    "waves": {"wave_length": 16e-3, "wave_height": 5e-3},
    "rings": {"ring_width": 1.5e-3},
    "graded_circles": {"front_lug_width": 9e-3, "graded_length": 30e-3},
    "lettering": {"letters": LETTERS},
}
TREADS = {name: Tread(name, 6e-3, 3e-3, 4e-3, **MORE.get(name, {})) for name in PATTERNS}
TURNED = {
    f"{name}, moved and turned": replace(
        tread, offset=(1.3e-3, -2.1e-3), yaw=0.4, pivot=(10e-3, 3e-3),
        angle=tread.angle if name == "chevrons" else 0.3,
    )
    for name, tread in TREADS.items()
}  # fmt: skip
CUT = {
    "free land": replace(TREADS["lettering"], letters=SINGLE),
    "sipes": replace(TREADS["grid"], sipes=Sipes(0.5e-3, 2e-3, 4e-3)),
    "sipes of an angle": replace(
        TREADS["bars"], sipes=Sipes(0.5e-3, 2e-3, 4e-3, angle=0.4, offset=1e-3), yaw=0.2,
        offset=(1e-3, 2e-3),
    ),
    "grooves": replace(
        TREADS["grid"],
        grooves=(Groove((20e-3, 3e-3), 2e-3), Groove((9e-3, -4e-3), 3e-3, 9e-3, 0.6)),
    ),
    "larger lugs behind": replace(TREADS["graded_circles"], lug_width=11e-3),
}  # fmt: skip


OUTLINE = ShoeOutline(0.28, 0.066, 0.06, 0.1)
HEEL = Heel(0.06, 0.05, 0.02, 0.012)
FORMS = {
    "plain heel": HEEL,
    "cornered heel": replace(HEEL, rear_radius=0.0),
    "round heel": replace(HEEL, front_radius=8e-3, edge_radius=3e-3, crown_radius=0.4),
    "facet": replace(HEEL, profile=Facet(0.2, 0.02)),
    "rocker": replace(HEEL, profile=Rocker(0.08, 0.03), wear=WearPlane(1e-3, 0.1)),
    "half circles": replace(HEEL, rear_radius=0.025, front_radius=0.025),
    "right sole": WholeSole(OUTLINE, 0.012),
    "left sole": WholeSole(
        replace(OUTLINE, side="left"), 0.012, Facet(0.15, 0.03), ToeSpring(0.015, 0.2, 0.28),
        edge_radius=4e-3, crown_radius=0.5, wear=WornPatch(2e-3, 0.03, 0.02),
    ),
    "narrow sole": WholeSole(ShoeOutline(0.2, 0.05, 0.03, 0.08), 0.02, Rocker(0.2, 0.05)),
}  # fmt: skip
