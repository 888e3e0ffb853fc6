"""Chains: edgels joined along their edges, and the straight pieces of them."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.compiled import compiled
from tracker.edges.edgels import Edgels, Int32

# Walked along a chain, the dark side is on the right hand. So the outline of a dark square is walked
# clockwise as seen on the screen, and two outlines of opposite polarity are never joined.

LEAST_CHAIN_EDGELS = 5
# Half of the distance by which an edge that is straight in the world bends in an image: lens, blur at the
# corners, noise.
STRAIGHT_TOLERANCE_PX = 0.9


@dataclass(frozen=True, slots=True, kw_only=True)
class Chains:
    """Edgels in order along their edges.

    Attributes:
        order: (m,), indexes of edgels, chain after chain.
        starts: (c + 1,), where each chain starts in `order`; the last entry is m.
        closed: (c,), whether a chain comes back to its start.
    """

    order: Int32
    starts: Int32
    closed: npt.NDArray[np.bool_]


def chains_of(edgels: Edgels) -> Chains:
    """The chains of at least five edgels."""
    successor, predecessor = _links(edgels.nx, edgels.ny, edgels.at)
    order, starts, closed = _walk(successor, predecessor, edgels.x, edgels.y, LEAST_CHAIN_EDGELS)
    return Chains(order=order, starts=starts, closed=closed)


def segments_of(edgels: Edgels, chains: Chains, *, least_length_px: float) -> npt.NDArray[np.float32]:
    """Straight pieces (s, 4) of the chains: start x, y and end x, y, dark side on the right hand."""
    return np.asarray(
        _segments(
            edgels.x,
            edgels.y,
            chains.order,
            chains.starts,
            np.float32(STRAIGHT_TOLERANCE_PX),
            np.float32(least_length_px),
        ),
        dtype=np.float32,
    )


@compiled
def _links(nx, ny, at):  # type: ignore[no-untyped-def]  # compiled: its types are those of the call
    height, width = at.shape
    count = nx.size
    successor = np.full(count, -1, np.int32)
    predecessor = np.full(count, -1, np.int32)
    claim = np.full(count, -1.0, np.float32)
    for v in range(1, height - 1):
        for u in range(1, width - 1):
            i = at[v, u]
            if i < 0:
                continue
            dx, dy = -ny[i], nx[i]
            best, best_worth = -1, np.float32(0.0)
            for dv in range(-1, 2):
                for du in range(-1, 2):
                    j = at[v + dv, u + du]
                    if j < 0 or j == i:
                        continue
                    ahead = (du * dx + dv * dy) / np.sqrt(np.float32(du * du + dv * dv))
                    alike = nx[i] * nx[j] + ny[i] * ny[j]
                    # Within 67 degrees ahead, and turning by at most 53: a chain may round a blurred
                    # corner, but never jumps to the other side of a line.
                    if ahead < 0.38 or alike < 0.6:
                        continue
                    worth = ahead + alike
                    if worth > best_worth:
                        best, best_worth = j, worth
            if best >= 0 and best_worth > claim[best]:
                if predecessor[best] >= 0:
                    successor[predecessor[best]] = -1
                claim[best] = best_worth
                predecessor[best] = i
                successor[i] = best
    return successor, predecessor


@compiled
def _walk(successor, predecessor, x, y, least):  # type: ignore[no-untyped-def]  # compiled
    count = successor.size
    order = np.empty(count, np.int32)
    starts = np.empty(count // least + 2, np.int32)
    closed = np.zeros(count // least + 2, np.bool_)
    visited = np.zeros(count, np.bool_)
    n, c = 0, 0
    starts[0] = 0
    for turn in range(2):  # first the open chains from their starts, then what is left: the closed ones
        for i in range(count):
            if visited[i] or (turn == 0 and predecessor[i] >= 0):
                continue
            first = i
            if turn == 1:
                # A closed chain starts at the edgel farthest from any one of it: that is a corner, so that
                # no side is cut in two.
                far, j = np.float32(-1.0), i
                while True:
                    d = (x[j] - x[i]) ** 2 + (y[j] - y[i]) ** 2
                    if d > far:
                        far, first = d, j
                    j = successor[j]
                    if j == i or j < 0:
                        break
            begin, j = n, first
            while j >= 0 and not visited[j]:
                visited[j] = True
                order[n] = j
                n += 1
                j = successor[j]
            if n - begin < least:
                n = begin
                continue
            closed[c] = turn == 1
            c += 1
            starts[c] = n
    return order[:n].copy(), starts[: c + 1].copy(), closed[:c].copy()


@compiled
def _fit_line(x, y, order, a, b, out):  # type: ignore[no-untyped-def]  # compiled
    """Least squares line through the edgels a..b of a chain; its ends into `out`, its length returned."""
    # The edgels next to a corner are pulled round it by blur; where there are enough, leave them out.
    trim = min(2, (b - a) // 6)
    lo, hi = a + trim, b - trim
    m = hi - lo + 1
    sx, sy = 0.0, 0.0
    for k in range(lo, hi + 1):
        sx += x[order[k]]
        sy += y[order[k]]
    mx, my = sx / m, sy / m
    sxx, sxy, syy = 0.0, 0.0, 0.0
    for k in range(lo, hi + 1):
        ex, ey = x[order[k]] - mx, y[order[k]] - my
        sxx += ex * ex
        sxy += ex * ey
        syy += ey * ey
    angle = 0.5 * np.arctan2(2.0 * sxy, sxx - syy)
    dx, dy = np.cos(angle), np.sin(angle)
    if (x[order[b]] - x[order[a]]) * dx + (y[order[b]] - y[order[a]]) * dy < 0.0:
        dx, dy = -dx, -dy
    p = (x[order[a]] - mx) * dx + (y[order[a]] - my) * dy
    q = (x[order[b]] - mx) * dx + (y[order[b]] - my) * dy
    out[0], out[1] = mx + p * dx, my + p * dy
    out[2], out[3] = mx + q * dx, my + q * dy
    return q - p


@compiled
def _segments(x, y, order, starts, tolerance, least_length):  # type: ignore[no-untyped-def]  # compiled
    most = order.size // 2 + 1
    found = np.empty((most, 4), np.float32)
    n = 0
    stack = np.empty((order.size + 2, 2), np.int32)
    for c in range(starts.size - 1):
        stack[0, 0], stack[0, 1] = starts[c], starts[c + 1] - 1
        depth = 1
        while depth > 0:
            depth -= 1
            a, b = stack[depth, 0], stack[depth, 1]
            ax, ay = x[order[a]], y[order[a]]
            dx, dy = x[order[b]] - ax, y[order[b]] - ay
            length = np.sqrt(dx * dx + dy * dy)
            if b - a < 3:
                continue
            worst, at = np.float32(0.0), -1
            for k in range(a + 1, b):
                ex, ey = x[order[k]] - ax, y[order[k]] - ay
                if length > 1.0:
                    off = abs(ex * dy - ey * dx) / length
                else:
                    off = np.sqrt(ex * ex + ey * ey)
                if off > worst:
                    worst, at = off, k
            if worst > tolerance:
                stack[depth, 0], stack[depth, 1] = at, b
                stack[depth + 1, 0], stack[depth + 1, 1] = a, at
                depth += 2
                continue
            if length < least_length or n >= most:
                continue
            if _fit_line(x, y, order, a, b, found[n]) >= least_length:
                n += 1
    return found[:n].copy()
