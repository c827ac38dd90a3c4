"""Questions that other packages ask of a case."""

from typing import Any

from underfoot.case import Case
from underfoot.core import InputError, unknown_name
from underfoot.core.presentation import Presentable
from underfoot.core.registry import find_offer, offers
from underfoot.core.remark import Message


def ask(question: str, case: Case, **settings: Any) -> Presentable:
    """Return what another package answers to its question (``underfoot.questions``) of a case.

    Parameters:
        question: Its name.
        settings: For the package: ``quick``, ``processes``, ``progress`` from the command line.

    Raises:
        InputError: Nobody offers it, its package is broken, or the answer can't be shown.
    """
    function = find_offer("questions", question)
    if function is None:
        raise unknown_name("question", question, offers("questions"), where="question")
    answer = function(case, **settings)
    if not isinstance(answer, Presentable):
        raise InputError(
            Message(
                "{offer} answers with {name}",
                offer=offers("questions")[question],
                name=type(answer).__name__,
            ),
            allowed="an object derived from underfoot.core.presentation.Presentable",
        )
    return answer
