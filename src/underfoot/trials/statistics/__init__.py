"""Statistics of the field's studies, each test named with its convention."""

from .design import Predictor, crossed, predictor
from .fisher import ExactTest, fisher_exact
from .linear import (
    AdjustedMean,
    AnovaRow,
    AnovaTable,
    Comparison,
    LinearModel,
    Subset,
    all_subsets,
    analysis_of_variance,
    least_squares_means,
    letters,
    linear_model,
    tukey_hsd,
)
from .logistic import (
    ClusteredFit,
    Coefficient,
    LogisticFit,
    Separation,
    clustered_logistic,
    logistic_regression,
    separation,
)
from .mixed import (
    MixedModel,
    PersonMeans,
    RepeatedMeasures,
    independence_warning,
    mixed_model,
    person_means,
    repeated_measures,
)
from .precision import OutlierTest, Precision, precision
from .two_samples import Line, TTest, regression_line, t_test

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
    "MixedModel",
    "OutlierTest",
    "PersonMeans",
    "Precision",
    "Predictor",
    "RepeatedMeasures",
    "Separation",
    "Subset",
    "TTest",
    "all_subsets",
    "analysis_of_variance",
    "clustered_logistic",
    "crossed",
    "fisher_exact",
    "independence_warning",
    "least_squares_means",
    "letters",
    "linear_model",
    "logistic_regression",
    "mixed_model",
    "person_means",
    "precision",
    "predictor",
    "regression_line",
    "repeated_measures",
    "separation",
    "t_test",
    "tukey_hsd",
]
