"""Statistics of the field's studies, each test named with its convention."""

from .anova import AnovaRow, AnovaTable, analysis_of_variance
from .design import Predictor, crossed, predictor
from .fisher import ExactTest, fisher_exact
from .linear import LinearModel, linear_model
from .logistic import Coefficient, LogisticFit, logistic_regression
from .regression import Line, regression_line
from .repeated import ClusteredFit, clustered_logistic
from .separation import Separation, separation
from .subsets import Subset, all_subsets
from .t_tests import TTest, t_test
from .tukey import AdjustedMean, Comparison, least_squares_means, letters, tukey_hsd

__all__ = [
    "AdjustedMean",
    "AnovaRow",
    "AnovaTable",
    "ClusteredFit",
    "Coefficient",
    "Comparison",
    "ExactTest",
    "Line",
    "LinearModel",
    "LogisticFit",
    "Predictor",
    "Separation",
    "Subset",
    "TTest",
    "all_subsets",
    "analysis_of_variance",
    "clustered_logistic",
    "crossed",
    "fisher_exact",
    "least_squares_means",
    "letters",
    "linear_model",
    "logistic_regression",
    "predictor",
    "regression_line",
    "separation",
    "t_test",
    "tukey_hsd",
]
