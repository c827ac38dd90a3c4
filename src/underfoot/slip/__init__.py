"""How likely a person slips: available against required friction."""

from .beschorner_2016 import Beschorner2016 as Beschorner2016
from .chang_2004 import Chang2004 as Chang2004
from .model import MODELS as MODELS
from .model import SlipModel as SlipModel
from .model import slip_model as slip_model
from .report_g6 import ReportG6 as ReportG6
from .required import ADULTS_LEVEL_WALKING as ADULTS_LEVEL_WALKING
from .required import RcofPopulation as RcofPopulation
from .risk import SlipRisk as SlipRisk
from .risk import mean_of_draws as mean_of_draws
from .risk import needed_acof as needed_acof
from .risk import slip_chances as slip_chances
from .risk import slip_risk as slip_risk
