"""How likely a person slips: available against required friction."""

from .beschorner_2016 import Beschorner2016
from .chang_2004 import Chang2004
from .model import MODELS, SlipModel, slip_model
from .needed import needed_acof
from .report_g6 import ReportG6
from .required import ADULTS_LEVEL_WALKING, RequiredFriction
from .risk import SlipRisk, slip_risk

__all__ = [
    "ADULTS_LEVEL_WALKING",
    "MODELS",
    "Beschorner2016",
    "Chang2004",
    "ReportG6",
    "RequiredFriction",
    "SlipModel",
    "SlipRisk",
    "needed_acof",
    "slip_model",
    "slip_risk",
]
