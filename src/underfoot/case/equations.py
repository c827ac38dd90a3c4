"""The 27 equations of the report: what each says, where it stands, which code computes it."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ReportEquation:
    """One numbered equation of the report.

    ``place`` is its section; ``code`` names what computes it as import paths, the first one being
    what ``explain`` shows; ``note`` says where the program departs from the print.
    """

    place: str
    title: str
    formula: str
    code: tuple[str, ...]
    note: str = ""


_MODULI = ("underfoot.material.compression_moduli",)
_SPLIT = ("underfoot_trial_analysis.boundary.friction_split",)
_AREA = ("underfoot_block.result.MicroAverages", "underfoot.rough_contact.steady_sliding")
_SOFT_EHL = ("underfoot.film.soft_ehl", "underfoot.reference.soft_ehl_film")
_STRIBECK = "COF = COF_asymptote + (COF_BL - COF_asymptote) exp(-v / tau_hydro)"

EQUATIONS: dict[int, ReportEquation] = {
    1: ReportEquation(
        "E.2",
        "COF of a shoe from asperities and fluid",
        "COF = (COF_asp F_N(asp) + F_fr(fluid)) / F_N(tot)",
        ("underfoot.friction.cof",),
    ),
    2: ReportEquation(
        "E.3.1",
        "friction of asperities: shear strength times contact area (Bowden and Tabor)",
        "F = S_eq A",
        ("underfoot.friction.BowdenTaborLaw", "underfoot.friction.shear_strength_from_cof"),
    ),
    3: ReportEquation(
        "E.3.1",
        "friction of asperities in proportion to the load they carry",
        "F = COF F_N(asp)",
        ("underfoot.friction.ConstantLaw", "underfoot.friction.BoundaryLaw"),
    ),
    4: ReportEquation(
        "E.3.1.2",
        "Reynolds equation: wedge and squeeze",
        "d/dx(h^3/(12 eta) dp/dx) + d/dy(h^3/(12 eta) dp/dy)"
        " = (v_x(a)+v_x(b))/2 dh/dx + (v_y(a)+v_y(b))/2 dh/dy + dh/dt",
        ("underfoot.film.film_pressure", "underfoot.film.film_operator"),
        "conserves mass: cavities are part of it; the report's text calls it Eq. 7 once, and "
        "Eq. 1a in G.4.3",
    ),
    5: ReportEquation(
        "E.3.1.2",
        "gap of geometry, deformation and approach",
        "h(x, y) = G(x, y) + u(x, y) + d_0",
        ("underfoot.sole_contact.SlidingSole",),
    ),
    6: ReportEquation(
        "E.3.2",
        "pressure of a rough surface (Greenwood and Williamson)",
        "sigma = 4 E / (3 (1 - nu^2)) eta R^(1/2) int (z - h)^(3/2) phi(z) dz",
        ("underfoot.rough_contact.greenwood_williamson",),
    ),
    7: ReportEquation(
        "G.1.1",
        "shear modulus that relaxes in one term",
        "G(t) = G_inf + (G_0 - G_inf) exp(-beta t)",
        (
            "underfoot.material.single_exponential_spectrum",
            "underfoot.material.fit_single_exponential",
        ),
    ),
    8: ReportEquation(
        "G.1.1",
        "hysteresis COF of the block",
        "COF_hysteresis = F_hysteresis / F_N",
        _AREA,
        "signed mean shear: the mean of its size is no friction",
    ),
    9: ReportEquation(
        "G.1.1",
        "adhesion: shear strength times real contact area",
        "F_adhesion = S_eq A_c",
        ("underfoot.friction.BowdenTaborLaw", *_AREA),
    ),
    10: ReportEquation(
        "G.1.1",
        "not printed: the numbers go from 9 to 11",
        "-",
        (),
        "nothing is missing between Eq. 9 and 11, which give COF = S_eq A_c / F_N together",
    ),
    11: ReportEquation(
        "G.1.1",
        "COF of adhesion",
        "COF_adhesion = F_adhesion / F_N(asp)",
        ("underfoot.friction.shear_strength_from_cof", *_AREA),
    ),
    12: ReportEquation(
        "G.1.1",
        "COF of adhesion follows real contact area over load",
        "COF_adhesion ~ A_c / F_N(asp)",
        _AREA,
    ),
    13: ReportEquation(
        "G.1.1",
        "stiffness of a compression test at the peak",
        "K_0 = (F_0 - F_0.02) / (0.18 T)",
        _MODULI,
    ),
    14: ReportEquation("G.1.1", "modulus at short times", "E_0 = K_0 2 T / A", _MODULI),
    15: ReportEquation(
        "G.1.1",
        "stiffness of a compression test after relaxation",
        "K_inf = (F_inf - F_0.02) / (0.18 T)",
        _MODULI,
    ),
    16: ReportEquation("G.1.1", "modulus at long times", "E_inf = K_inf 2 T / A", _MODULI),
    17: ReportEquation(
        "G.2.1",
        "fall of COF with speed",
        _STRIBECK,
        ("underfoot.friction.stribeck_cof", "underfoot.friction.StribeckLaw"),
        "the caption of Fig. 14 calls it Eq. 1",
    ),
    18: ReportEquation(
        "G.2.1",
        "thinnest film of a soft point contact (Hamrock and Dowson)",
        "H_min = 7.43 U^0.65 W^-0.21 (1 - 0.85 exp(-0.31 k))",
        _SOFT_EHL,
        "W = w / (E' R'^2): the print has R', which leaves a dimension",
    ),
    19: ReportEquation(
        "G.2.1",
        "profile of a pin",
        "h(r) = B r^2",
        ("underfoot.film.radius_of_parabola",),
    ),
    20: ReportEquation(
        "G.2.1",
        "reduced radius of curvature of a profile",
        "R' = 1 / (2 B)",
        ("underfoot.film.radius_of_parabola",),
        "R' of the report's pin is 23.3 mm, printed in micrometres",
    ),
    21: ReportEquation(
        "G.2.1",
        "film over roughness",
        "lambda = H_min R' / sigma*",
        ("underfoot.film.lambda_ratio", "underfoot.film.film_regime"),
    ),
    22: ReportEquation("G.3.1", "dry friction", "F_dry = F_adhesion + F_hysteresis", _SPLIT),
    23: ReportEquation(
        "G.3.1",
        "hysteresis from friction under gear oil",
        "F_hysteresis = F_SAE75W-140",
        _SPLIT,
        "an upper bound: the oil leaves some adhesion too",
    ),
    24: ReportEquation("G.3.1", "dry adhesion", "F_adhesion = F_dry - F_hysteresis", _SPLIT),
    25: ReportEquation(
        "G.3.1",
        "adhesion left under a fluid",
        "F_adhesion(lubricated) = F_lubricated - F_hysteresis",
        _SPLIT,
        "the sentence above it in the report cites itself as Eq. 25; G.3.2 calls Eq. 26 'Eq. 5'",
    ),
    26: ReportEquation(
        "G.3.1",
        "adhesion left under a fluid, from the dry adhesion",
        "F_adhesion(lubricated) = alpha + beta F_adhesion(dry)",
        (
            "underfoot.fluid.AdhesionBlocking",
            "underfoot.friction.AdhesionBlockingLaw",
            "underfoot_trial_analysis.boundary.alpha_beta",
        ),
    ),
    27: ReportEquation(
        "G.4.1",
        "load of the fluid from scans of a pressure sensor",
        "NF_fluid = sum p dx dy = sum p dx v dt",
        (
            "underfoot.sole_contact.floor_sensor_reading",
            "underfoot.trials.pressure_map.pressure_map",
        ),
    ),
}
