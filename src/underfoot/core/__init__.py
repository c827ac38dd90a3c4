"""Units at the door, sourced values, errors, status, provenance, progress and the cache."""

from .cache import Cache as Cache
from .cache import content_hash as content_hash
from .errors import Cancelled as Cancelled
from .errors import ConvergenceError as ConvergenceError
from .errors import DataError as DataError
from .errors import InputError as InputError
from .errors import MissingExtraError as MissingExtraError
from .errors import RangeError as RangeError
from .errors import UnderfootError as UnderfootError
from .errors import nearest_match as nearest_match
from .errors import unknown_name as unknown_name
from .progress import Progress as Progress
from .progress import silent as silent
from .provenance import Provenance as Provenance
from .status import Status as Status
from .units import display as display
from .units import to_si as to_si
from .validity import Breach as Breach
from .validity import Range as Range
from .validity import breaches as breaches
from .values import SourcedValue as SourcedValue
