"""Hot loops, compiled by Numba once and kept beside the source.

Kept on disk (`cache`), so that nothing compiles in theatre; without the interpreter's lock (`nogil`), so that
capture goes on meanwhile; with IEEE division (`error_model="numpy"`), so that a division by zero is inf, not
an exception from a place without a sentence. Sums may be taken in another order (`fastmath`), so that several
are taken at once; what is not a number stays one.

Loops are untyped (their types are those of their calls), live in the `kernels.py` of their package, and
solve their own small linear systems: NumPy's raise an exception in compiled code where a singular matrix is
an ordinary answer, and are slower for so few unknowns.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Function = TypeVar("Function", bound=Callable[..., object])

LOOPS: list[Any] = []
"""Numba's dispatcher of each compiled function that has been imported."""


def compiled(function: Function) -> Function:
    """The same function as machine code. `tracker.warm_up` calls each one, so that none is compiled later."""
    loop = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath={"reassoc", "contract"})(function)
    LOOPS.append(loop)
    return cast("Function", loop)
