"""The slip as it happens: the foot as a mass, contact and film carried in time, a population."""

from underfoot.core.deprecation import package_names

from .full_model import FullRun as FullRun
from .full_model import Setting as Setting
from .full_model import SoleFoot as SoleFoot
from .full_model import full_run as full_run
from .full_model import full_runs as full_runs
from .gait import GaitHistory as GaitHistory
from .gait import history_text as history_text
from .gait import load_history as load_history
from .gait import packaged_histories as packaged_histories
from .motion import FootContact as FootContact
from .motion import SlipMotion as SlipMotion
from .motion import slip_motion as slip_motion
from .observation import ObservedSlip as ObservedSlip
from .observation import Outcome as Outcome
from .observation import OutcomeLimits as OutcomeLimits
from .observation import judge_slip as judge_slip
from .observation import observe_slip as observe_slip
from .recorded import recorded_histories as recorded_histories
from .recorded import step_history as step_history
from .reduced_model import FitError as FitError
from .reduced_model import ReducedFit as ReducedFit
from .reduced_model import ReducedSole as ReducedSole
from .reduced_model import cof_table as cof_table
from .reduced_model import design as design
from .reduced_model import error_of as error_of
from .reduced_model import error_text as error_text
from .reduced_model import fitted_reduced as fitted_reduced
from .sensors import FloorSensors as FloorSensors
from .sensors import PressureShape as PressureShape
from .sensors import array_pressures as array_pressures
from .sensors import pressure_shape as pressure_shape
from .study import FrictionDraws as FrictionDraws
from .study import SlipStudy as SlipStudy
from .study import SubjectSlip as SubjectSlip
from .study import slip_study as slip_study
from .walker import Population as Population
from .walker import Spread as Spread
from .walker import Walker as Walker

__getattr__ = package_names(__name__, gone="0.5", judged="judge_slip", observed="observe_slip")
