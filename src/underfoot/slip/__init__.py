"""How likely a person slips: available against required friction."""

from .beschorner_2016 import Beschorner2016
from .chang_2004 import Chang2004
from .model import MODELS, SlipModel, slip_model
from .report_g6 import ReportG6
from .required import ADULTS_LEVEL_WALKING, RcofPopulation
from .risk import SlipRisk, needed_acof, slip_risk

__all__ = [
    "ADULTS_LEVEL_WALKING",
    "MODELS",
    "Beschorner2016",
    "Chang2004",
    "RcofPopulation",
    "ReportG6",
    "SlipModel",
    "SlipRisk",
    "needed_acof",
    "slip_model",
    "slip_risk",
]
