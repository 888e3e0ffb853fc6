"""What NumPy raises for a file that is no array, or a damaged archive of arrays."""

import tokenize
import zipfile
import zlib

# The header of an array is a Python literal, and its shape may state more than any memory holds.
BAD_NUMPY_FILE: tuple[type[Exception], ...] = (
    OSError,
    ValueError,
    TypeError,
    LookupError,
    EOFError,
    ArithmeticError,
    MemoryError,
    SyntaxError,
    RuntimeError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)
