"""The compiled loops of uneven light; their types are those of their calls.

`light` is what kind it is, and how many nodes a side its fields have.
"""

import numpy as np

from tracker.appearance.light.kernels import LIGHT, PLANE
from tracker.compiled import compiled
from tracker.geometry.kernels import NO_BAND

# Kinds of light, and what their numbers are from LIGHT on: of an even one dark and contrast, each with its
# slopes; of a shaded one the field of the contrast, what dark is of it, and what is dark without light; of a
# glaring one the field of the dark, and contrast with its slopes; of a free one a field of each.
PLAIN, SHADED, GLARING, FREE = 0, 1, 2, 3
# The fields reach over the square and a quarter of half a side beyond.
NODES_REACH = 1.25
# A point is lit by three nodes each way.
AROUND = 9
# Light changes from node to node by so much of the contrast, unless the image says otherwise.
NODE_STEP_RATIO, SLOPE_RATIO = 0.6, 0.5
# ... and bends by so much, mostly.
BEND_RATIO = 0.07
# What a camera makes of no light at all, by the contrast.
NO_LIGHT_RATIO = 0.05
MAX_SHARES = 2 * AROUND


@compiled
def numbers_of(light):
    """How many numbers a fit in such a light has."""
    kind, nodes = light
    if kind == PLAIN:
        return LIGHT + PLANE
    if kind == SHADED:
        return LIGHT + nodes * nodes + 2
    if kind == GLARING:
        return LIGHT + nodes * nodes + 3
    return LIGHT + 2 * nodes * nodes


@compiled
def fields_first(light):
    """The numbers of a fit (n,), so that neighbours in the light come one after the other.

    Each field's numbers meet only those near to them; all else, which meets everything, comes last.
    """
    kind, nodes = light
    fields = 2 if kind == FREE else (0 if kind == PLAIN else 1)
    both, n, order = nodes * nodes, 0, np.empty(numbers_of(light), np.int64)
    for k in range(both):
        for m in range(fields):
            order[n] = LIGHT + m * both + k
            n += 1
    for k in range(LIGHT + fields * both, len(order)):
        order[n] = k
        n += 1
    for k in range(LIGHT):
        order[n] = k
        n += 1
    return order


@compiled
def band_of(light):
    """How many of the fields' numbers there are, and how far apart in that order those are that meet."""
    kind, nodes = light
    if kind == PLAIN:
        return NO_BAND
    fields = 2 if kind == FREE else 1
    return fields * nodes * nodes, fields * (2 * nodes + 3)


@compiled
def _in_cells(x, y, nodes):
    """A point in half sides, in cells of the net to the right and upwards."""
    cells = nodes - 2
    fx = min(max((x / NODES_REACH + 1.0) * 0.5 * cells, 0.0), cells - 1e-6)
    fy = min(max((y / NODES_REACH + 1.0) * 0.5 * cells, 0.0), cells - 1e-6)
    return fx, fy


@compiled
def by_cells(at, nodes, order, begins):
    """Into `order` (n,): the pixels, cell by cell of the net; where those of each begin into `begins`."""
    cells = nodes - 2
    which = np.empty(len(at), np.int64)
    begins[:] = 0
    for i in range(len(at)):
        fx, fy = _in_cells(at[i, 0], at[i, 1], nodes)
        which[i] = int(fy) * cells + int(fx)
        begins[which[i] + 1] += 1
    for k in range(len(begins) - 1):
        begins[k + 1] += begins[k]
    put = begins.copy()
    for i in range(len(at)):
        order[put[which[i]]] = i
        put[which[i]] += 1


@compiled
def _cell_of(x, y, nodes, weight):
    """The first of the nine nodes around a point in half sides, and into `weight` (9,) what each is of it.

    A quadratic B-spline: glare is round on the scale of its net, and straight lines between nodes were off
    by several grey levels.
    """
    fx, fy = _in_cells(x, y, nodes)
    c, r = int(fx), int(fy)
    fx -= c
    fy -= r
    left, middle, right = 0.5 * (1 - fx) ** 2, 0.5 + fx - fx * fx, 0.5 * fx * fx
    wy = 0.5 * (1 - fy) ** 2
    weight[0], weight[1], weight[2] = wy * left, wy * middle, wy * right
    wy = 0.5 + fy - fy * fy
    weight[3], weight[4], weight[5] = wy * left, wy * middle, wy * right
    wy = 0.5 * fy * fy
    weight[6], weight[7], weight[8] = wy * left, wy * middle, wy * right
    return r * nodes + c


@compiled
def _field_at(field, first, nodes, weight):
    """A field (nodes^2,) between the nine nodes from the first on."""
    upper, middle, lower = field[first:], field[first + nodes :], field[first + 2 * nodes :]
    total = weight[0] * upper[0] + weight[1] * upper[1] + weight[2] * upper[2]
    total += weight[3] * middle[0] + weight[4] * middle[1] + weight[5] * middle[2]
    return total + weight[6] * lower[0] + weight[7] * lower[1] + weight[8] * lower[2]


@compiled
def light_up(at, numbers, light, lit):
    """Into `lit` (n, 2): dark and contrast at each pixel, in grey levels."""
    kind, nodes = light
    if kind == PLAIN:
        d, dx, dy, c, cx, cy = numbers[LIGHT : LIGHT + PLANE]
        for i in range(len(at)):
            lit[i, 0] = d + dx * at[i, 0] + dy * at[i, 1]
            lit[i, 1] = c + cx * at[i, 0] + cy * at[i, 1]
        return
    weight, both = np.empty(AROUND), nodes * nodes
    first_field, rest = numbers[LIGHT : LIGHT + both], numbers[LIGHT + both :]
    for i in range(len(at)):
        x, y = at[i, 0], at[i, 1]
        first = _cell_of(x, y, nodes, weight)
        field = _field_at(first_field, first, nodes, weight)
        second = _field_at(rest, first, nodes, weight) if kind == FREE else 0.0
        if kind == SHADED:
            lit[i, 0], lit[i, 1] = rest[1] + rest[0] * field, field
        elif kind == GLARING:
            lit[i, 0], lit[i, 1] = field, rest[0] + rest[1] * x + rest[2] * y
        else:
            lit[i, 0], lit[i, 1] = field, second


@compiled
def shared_numbers(x, y, light, where):
    """Which numbers of the light light a pixel, and all others in its cell of the net; how many.

    Into `where`, in the order of `shares_of`.
    """
    kind, nodes = light
    if kind == PLAIN:
        for k in range(PLANE):
            where[k] = LIGHT + k
        return PLANE
    fx, fy = _in_cells(x, y, nodes)
    first, rest = LIGHT + int(fy) * nodes + int(fx), LIGHT + nodes * nodes
    for k in range(AROUND):
        where[k] = first + k // 3 * nodes + k % 3
        where[AROUND + k] = where[k] + nodes * nodes if kind == FREE else rest + k
    return AROUND + (AROUND if kind == FREE else (2 if kind == SHADED else 3))


@compiled
def shares_of(x, y, shaped, contrast, numbers, light, weight, share):
    """By how much each of its numbers of the light lights a pixel, into `share`.

    `shaped`: what the pixel sees of the picture, 0..1. `weight` (9,): room.
    """
    kind, nodes = light
    if kind == PLAIN:
        share[0], share[1], share[2] = 1.0, x, y
        share[3], share[4], share[5] = shaped, shaped * x, shaped * y
        return
    _cell_of(x, y, nodes, weight)
    by_field = numbers[LIGHT + nodes * nodes] + shaped if kind == SHADED else 1.0
    for k in range(AROUND):
        share[k] = weight[k] * by_field
    if kind == SHADED:
        share[AROUND], share[AROUND + 1] = contrast, 1.0
    elif kind == GLARING:
        share[AROUND], share[AROUND + 1], share[AROUND + 2] = shaped, shaped * x, shaped * y
    else:
        for k in range(AROUND):
            share[AROUND + k] = weight[k] * shaped


@compiled
def _fill(plane, nodes, field):
    """A plane (3,) over the marker as a field (nodes^2,)."""
    for r in range(nodes):
        for c in range(nodes):
            x = NODES_REACH * (2.0 * (c - 0.5) / (nodes - 2) - 1.0)
            y = NODES_REACH * (2.0 * (r - 0.5) / (nodes - 2) - 1.0)
            field[r * nodes + c] = plane[0] + plane[1] * x + plane[2] * y


@compiled
def from_plain(numbers, light, out):
    """The numbers of a fit in even light as those of one in this light."""
    kind, nodes = light
    out[:LIGHT] = numbers[:LIGHT]
    dark, contrast = numbers[LIGHT : LIGHT + 3], numbers[LIGHT + 3 : LIGHT + 6]
    both = nodes * nodes
    field, rest = out[LIGHT : LIGHT + both], out[LIGHT + both :]
    if kind == SHADED:
        _fill(contrast, nodes, field)
        rest[0], rest[1] = dark[0] / max(contrast[0], 1.0), 0.0
    elif kind == GLARING:
        _fill(dark, nodes, field)
        rest[:] = contrast
    else:
        _fill(dark, nodes, field)
        _fill(contrast, nodes, rest)


@compiled
def typical_contrast(numbers, light):
    """Contrast in the middle of the marker, in grey levels, at least 1."""
    kind, nodes = light
    if kind == PLAIN:
        return max(abs(numbers[LIGHT + 3]), 1.0)
    both = nodes * nodes
    if kind == GLARING:
        return max(abs(numbers[LIGHT + both]), 1.0)
    first = LIGHT + (both if kind == FREE else 0)
    return max(abs(numbers[first : first + both].mean()), 1.0)


@compiled
def _hold_number(a, g, numbers, k, sd, scale):
    """Add to the normal equations that a number is 0 but for this sd; returns its cost."""
    stiff = (scale / sd) ** 2
    a[k, k] += stiff
    g[k] -= stiff * numbers[k]
    return stiff * numbers[k] ** 2


@compiled
def _hold_three(a, g, numbers, three, sd, scale):
    """Add to the normal equations that the middle of three lies between the others, or far off; its cost.

    As Cauchy has it: where light bends much, as at the edge of a shadow, it may bend more.
    """
    i, j, k = three
    bend = numbers[i] - 2.0 * numbers[j] + numbers[k]
    far = 1.0 + (bend / sd) ** 2
    stiff = (scale / sd) ** 2 / far
    for m, by in ((i, 1.0), (j, -2.0), (k, 1.0)):
        g[m] -= stiff * by * bend
        a[m, i] += stiff * by
        a[m, j] -= 2.0 * stiff * by
        a[m, k] += stiff * by
    return scale * scale * np.log(far)


@compiled
def _hold_field(a, g, numbers, first, nodes, contrast, scale):
    """Add to the normal equations that a field is smooth; returns its cost."""
    cost, sd = 0.0, BEND_RATIO * contrast
    stiff = (scale / (NODE_STEP_RATIO * contrast)) ** 2
    for r in range(nodes):
        for c in range(nodes):
            i = first + r * nodes + c
            for way in range(2):
                step = 1 if way == 0 else nodes
                left = nodes - 1 - (c if way == 0 else r)
                if left > 1:
                    cost += _hold_three(a, g, numbers, (i, i + step, i + 2 * step), sd, scale)
                if left > 0:
                    j = i + step
                    apart = numbers[i] - numbers[j]
                    a[i, i] += stiff
                    a[j, j] += stiff
                    a[i, j] -= stiff
                    a[j, i] -= stiff
                    g[i] -= stiff * apart
                    g[j] += stiff * apart
                    cost += stiff * apart * apart
    return cost


@compiled
def hold_light(a, g, numbers, scale, light):
    """Add to the normal equations that light changes little over the marker; returns its cost."""
    kind, nodes = light
    contrast = typical_contrast(numbers, light)
    cost, slope = 0.0, SLOPE_RATIO * contrast
    if kind == PLAIN:
        for k in (1, 2, 4, 5):
            cost += _hold_number(a, g, numbers, LIGHT + k, slope, scale)
        return cost
    rest = LIGHT + nodes * nodes
    cost += _hold_field(a, g, numbers, LIGHT, nodes, contrast, scale)
    if kind == SHADED:
        cost += _hold_number(a, g, numbers, rest + 1, NO_LIGHT_RATIO * contrast, scale)
    elif kind == GLARING:
        cost += _hold_number(a, g, numbers, rest + 1, slope, scale)
        cost += _hold_number(a, g, numbers, rest + 2, slope, scale)
    else:
        cost += _hold_field(a, g, numbers, rest, nodes, contrast, scale)
    return cost
