"""Interpolation of the texture, its slopes and curvatures."""

from tracker.compiled import compiled


@compiled
def add_texture_samples(texels, start, size, texel, at, begin, count, right, up, weight, workspace, out):
    """Add weighted texture value, slopes and curvatures at shifted points to `out` (6, many).

    `at` (n, 2) in half sides, shift (right, up) in sides. `workspace`: texels (12, many), texel indices
    (many,), fractions (2, many).
    """
    found, index, part = workspace
    half, maximum = 0.5 * (size - 1), size - 1.001
    for k in range(count):
        x = min(max((0.5 * at[begin + k, 0] + right) / texel + half, 0.0), maximum)
        y = min(max(half - (0.5 * at[begin + k, 1] + up) / texel, 0.0), maximum)
        c, r = int(x), int(y)
        part[0, k], part[1, k] = x - c, y - r
        index[k] = start + 3 * (r * size + c)
    row = 3 * size
    # Gather first, so that the interpolation vectorises.
    for k in range(count):
        upper, lower = texels[index[k] : index[k] + 6], texels[index[k] + row : index[k] + row + 6]
        for m in range(6):
            found[m, k], found[6 + m, k] = upper[m], lower[m]
    _interpolate(found, part, count, texel, weight, out)


@compiled
def _interpolate(found, part, count, texel, weight, out):
    """Interpolate value, slopes and curvatures between four texels (12, many); add them to `out`."""
    v0, r0, u0, v1, r1, u1 = found[0], found[1], found[2], found[3], found[4], found[5]
    v2, r2, u2, v3, r3, u3 = found[6], found[7], found[8], found[9], found[10], found[11]
    value, right, up, xx_out, yy_out, xy_out = out[0], out[1], out[2], out[3], out[4], out[5]
    ways, downs = part[0], part[1]
    response_row, scale = 0.5 * texel, weight / texel
    for k in range(count):
        fx, fy = ways[k], downs[k]
        gx, gy = 1.0 - fx, 1.0 - fy
        a, b, d, e = gx * gy, fx * gy, gx * fy, fx * fy
        right[k] += weight * (a * r0[k] + b * r1[k] + d * r2[k] + e * r3[k])
        up[k] += weight * (a * u0[k] + b * u1[k] + d * u2[k] + e * u3[k])
        # Slopes are per side to the right and upwards; rows run downwards.
        xx = gy * (r1[k] - r0[k]) + fy * (r3[k] - r2[k])
        yy = gx * (u0[k] - u2[k]) + fx * (u1[k] - u3[k])
        xy = gx * (r0[k] - r2[k]) + fx * (r1[k] - r3[k])
        xx_out[k] += scale * xx
        yy_out[k] += scale * yy
        xy_out[k] += scale * xy
        # Second-order correction of the bilinear interpolation, which underestimates curvature.
        bends = response_row * (fx * gx * xx + fy * gy * yy)
        value[k] += weight * (a * v0[k] + b * v1[k] + d * v2[k] + e * v3[k] - bends)
