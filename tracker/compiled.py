"""Numba compilation of the numerical kernels.

Compiled code is cached on disk (`cache`), so that nothing compiles in theatre. It releases the interpreter
lock (`nogil`), so that capture continues. Division by zero gives inf (`error_model="numpy"`) instead of an
exception. Sums may be reordered (`fastmath`), so that they can be vectorised; NaN is preserved. No kernel is
a callback of C, so that none gets the wrapper for it. A kernel whose name begins with an underscore is called
by other kernels only: it gets no wrapper for Python either, and crashes where Python calls it.

Kernels are untyped (Numba infers types from the calls), live in `*_kernels.py` modules, and solve their own
small linear systems: NumPy's solver raises an exception in compiled code where a singular matrix is an
expected case, and is slower for few unknowns.

`python -m tests.benchmarks.compiling` prints how long each one takes to compile. Some habits keep that short:

- An array is not assigned to a part of another one (`a[:] = b`, `a[k] = b`). Numba would compile the error
  message for arrays of different shapes into the kernel and into each of its callers.
- An argument that differs between calls is a literal in none of them. Numba compiles a kernel again for each
  literal; `np.int64(0)` is not one. It does so too for a read-only array, as those of a `Rigid`.
- Sums, extremes and arithmetic of arrays are loops. Numba compiles several functions for each of them.
- What is not a loop over pixels, edges or hypotheses is Python: a kernel contains the code of all kernels
  below it again.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Function = TypeVar("Function", bound=Callable[..., object])

DISPATCHERS: list[Any] = []
"""Numba's dispatcher of each compiled function that has been imported."""


def compiled(function: Function) -> Function:
    """Return the function as compiled machine code. `tracker.warm_up` calls each one ahead of use."""
    loop = numba.njit(
        cache=True,
        nogil=True,
        error_model="numpy",
        fastmath={"reassoc", "contract"},
        no_cfunc_wrapper=True,
        no_cpython_wrapper=function.__name__.startswith("_"),
    )(function)
    DISPATCHERS.append(loop)
    return cast("Function", loop)
