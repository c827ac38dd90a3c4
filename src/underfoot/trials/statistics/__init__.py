"""Statistics of the field's studies, each test named with its convention."""

from underfoot.core.deprecation import package_names

from .agreement import bland_altman as bland_altman
from .agreement import intraclass_correlation as intraclass_correlation
from .confounding import Confounded as Confounded
from .confounding import names_persons as names_persons
from .confounding import told_apart as told_apart
from .curves import paired_curve_test as paired_curve_test
from .effects import detectable_difference as detectable_difference
from .effects import effect_size as effect_size
from .effects import equivalence as equivalence
from .effects import persons_needed as persons_needed
from .effects import power as power
from .fisher import ExactTest as ExactTest
from .fisher import fisher_exact as fisher_exact
from .linear import AdjustedMean as AdjustedMean
from .linear import AnovaRow as AnovaRow
from .linear import AnovaTable as AnovaTable
from .linear import LevelDifference as LevelDifference
from .linear import LevelPair as LevelPair
from .linear import LinearModel as LinearModel
from .linear import Predictor as Predictor
from .linear import Subset as Subset
from .linear import all_subsets as all_subsets
from .linear import analysis_of_variance as analysis_of_variance
from .linear import crossed_terms as crossed_terms
from .linear import least_squares_means as least_squares_means
from .linear import letters as letters
from .linear import linear_model as linear_model
from .linear import predictor as predictor
from .linear import tukey_hsd as tukey_hsd
from .logistic import ClusteredFit as ClusteredFit
from .logistic import Coefficient as Coefficient
from .logistic import LogisticFit as LogisticFit
from .logistic import LogisticLine as LogisticLine
from .logistic import RiskCurve as RiskCurve
from .logistic import Separation as Separation
from .logistic import clustered_logistic as clustered_logistic
from .logistic import logistic_regression as logistic_regression
from .logistic import risk_curve as risk_curve
from .logistic import separation as separation
from .mixed import MixedModel as MixedModel
from .mixed import PersonMeans as PersonMeans
from .mixed import RepeatedMeasures as RepeatedMeasures
from .mixed import independence_warning as independence_warning
from .mixed import mixed_model as mixed_model
from .mixed import person_means as person_means
from .mixed import repeated_measures as repeated_measures
from .prediction import person_bootstrap as person_bootstrap
from .prediction import roc_area as roc_area
from .prediction import slip_prediction as slip_prediction
from .ranks import RankTest as RankTest
from .ranks import rank_test as rank_test
from .samples import ROUNDING as ROUNDING
from .samples import Line as Line
from .samples import OutlierTest as OutlierTest
from .samples import Precision as Precision
from .samples import TTest as TTest
from .samples import corrected_p as corrected_p
from .samples import drift as drift
from .samples import mean_interval as mean_interval
from .samples import merge_equal_values as merge_equal_values
from .samples import ordered_levels as ordered_levels
from .samples import precision as precision
from .samples import regression_line as regression_line
from .samples import share_interval as share_interval
from .samples import standard_deviation as standard_deviation
from .samples import t_test as t_test
from .shares import ShareDifference as ShareDifference
from .shares import share_difference as share_difference

__getattr__ = package_names(
    __name__,
    gone="0.5",
    crossed="crossed_terms",
    resolved="merge_equal_values",
    Comparison="LevelDifference",
    Pair="LevelPair",
)
