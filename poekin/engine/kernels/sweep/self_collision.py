"""Whether spheres on an arm's links touch: those of pairs of links, their hulls first.

Spheres come as their centres (3 K, LANES), x, y and z of each, and radii (K). Pairs come as six whole
numbers each, of either link the number of its hull, a sphere that holds its others, of the first of
those and of the one behind the last.
"""

_OF_PAIR = 6


def collides(pairs, radii, centres, lane):
    """Whether spheres of a pair touch."""
    for k in range(0, len(pairs), _OF_PAIR):
        hull = pairs[k]
        other = pairs[k + 3]
        if not touches(radii, centres, hull, other, lane):
            continue
        for i in range(pairs[k + 1], pairs[k + 2]):
            if not touches(radii, centres, i, other, lane):
                continue
            for j in range(pairs[k + 4], pairs[k + 5]):
                if touches(radii, centres, i, j, lane):
                    return True
    return False


def touches(radii, centres, i, j, lane):
    """Whether two spheres touch."""
    x = centres[3 * i, lane] - centres[3 * j, lane]
    y = centres[3 * i + 1, lane] - centres[3 * j + 1, lane]
    z = centres[3 * i + 2, lane] - centres[3 * j + 2, lane]
    r = radii[i] + radii[j]
    return x * x + y * y + z * z <= r * r
