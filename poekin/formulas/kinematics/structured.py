"""Poses and Jacobians by two planar rotations a link: about the joint's axis, and about the common
normal of two axes.

    F_i = F_{i-1} Tx(a) Ty(b) Rx(alpha) Rz(theta_i) Tz(d + s x_i),  theta_i = r x_i + offset_i

F_i is the frame of joint i after its motion, z along the joint's axis. b is 0 where x runs along
the common normal of two axes; where they are nearly parallel the common normal lies far away, and b
takes the place of a large d.
`links` holds sin alpha, cos alpha, a, b of the link that leads to joint i, `d_offsets` the d + s x_i
of the joint.

A walk carries a frame's axes X, Y, Z and its origin o, seen from the frame where it begins: outward
to the tip or inward to the base. So two walks give the Jacobian in the base, in the tool, or in the
frame of any joint between. `parallel` is 1 where joint i's axis is parallel to the one before. X
and Y are turned only where such a run of axes ends: `sines` and `cosines` are those of the sum of
the angles from where the walk enters the run. Each walk writes a row of 12 numbers a joint: X and Y
of its run, Z, and o, a point of its axis.

A column is (Z; o x Z) (`columns.about_point`), or (Z; x Y - y X) with x and y the coordinates of
the frame where the walk began, seen from the joint in the axes of its run. The second way is the
cheaper one where axes are parallel. General links, with columns of the first kind: body Jacobian of
n revolute joints 36 n - 68 and 21 n - 44 at most. Accuracy: as `forward`
(tests/model/kinematics/test_compiled.py).
Source: Park 1994, Section IV, each link's constant pose taken apart as Denavit and Hartenberg do.
"""

from ...algebra import add, scale, set_column, store_row, subtract, turn_axes, twist


def outward(frame, links, d_offsets, parallel, sines, cosines, begin, rows):
    """From the frame before joint `begin` to the frame after the last joint, which is returned as
    (X, Y, Z, o).
    """
    X, Y, Z, o = frame
    run_X = X
    run_Y = Y
    for i in range(begin, len(links)):
        sin_alpha, cos_alpha, a, b = link(links[i])
        o = add(o, scale(a, X))
        o = add(o, scale(b, Y))
        if not parallel[i]:
            Y, Z = turn_axes(Y, Z, sin_alpha, cos_alpha)
            run_X = X
            run_Y = Y
        write(rows[i], run_X, run_Y, Z, o)
        X, Y = turn_axes(run_X, run_Y, sines[i], cosines[i])
        o = add(o, scale(d_offsets[i], Z))
    return X, Y, Z, o


def inward(frame, links, d_offsets, parallel, sines, cosines, begin, rows):
    """From the frame after joint `begin` to the frame before joint 0, which is returned as (X, Y,
    Z, o).
    """
    X, Y, Z, o = frame
    run_X = X
    run_Y = Y
    for i in range(begin, -1, -1):
        write(rows[i], run_X, run_Y, Z, o)
        o = subtract(o, scale(d_offsets[i], Z))
        Y, X = turn_axes(run_Y, run_X, sines[i], cosines[i])
        sin_alpha, cos_alpha, a, b = link(links[i])
        if not parallel[i]:
            Z, Y = turn_axes(Z, Y, sin_alpha, cos_alpha)
            run_X = X
            run_Y = Y
        o = subtract(o, scale(a, X))
        o = subtract(o, scale(b, Y))
    return X, Y, Z, o


def seen_outward(point, links, d_offsets, parallel, sines, cosines, begin, points):
    """A point, given in the frame before joint `begin`, as each joint of an outward walk sees it.

    x and y in the axes of the joint's run into rows of `points`; returned are x, y, z in the frame
    after the last joint.
    """
    x, y, z = point
    sine = 0.0
    cosine = 1.0
    for i in range(begin, len(links)):
        sin_alpha, cos_alpha, a, b = link(links[i])
        x = x - (a * cosine - b * sine)
        y = y - (a * sine + b * cosine)
        if not parallel[i]:
            x, y = turn_coordinates(x, y, sine, cosine)
            y, z = turn_coordinates(y, z, sin_alpha, cos_alpha)
        points[i][0] = x
        points[i][1] = y
        sine = sines[i]
        cosine = cosines[i]
        z = z - d_offsets[i]
    x, y = turn_coordinates(x, y, sine, cosine)
    return x, y, z


def seen_inward(point, links, d_offsets, parallel, sines, cosines, begin, points):
    """A point, given in the frame after joint `begin`, as each joint of an inward walk sees it.

    Returned are x, y, z in the frame before joint 0.
    """
    x, y, z = point
    for i in range(begin, -1, -1):
        points[i][0] = x
        points[i][1] = y
        z = z + d_offsets[i]
        sine = sines[i]
        cosine = cosines[i]
        sin_alpha, cos_alpha, a, b = link(links[i])
        if parallel[i]:
            x = x + (a * cosine + b * sine)
            y = y + (b * cosine - a * sine)
        else:
            y, x = turn_coordinates(y, x, sine, cosine)
            z, y = turn_coordinates(z, y, sin_alpha, cos_alpha)
            x = x + a
            y = y + b
    return x, y, z


def tip_seen(point, links, d_offsets, parallel, sines, cosines, count, points):
    """A point, given in the frame after the last joint, as each joint of an *outward* walk sees it:
    in the axes of its runs, by its angles. Returned are x, y, z in the frame before joint 0.
    """
    x, y, z = point
    for i in range(count - 1, -1, -1):
        if i == count - 1 or not parallel[i + 1]:
            y, x = turn_coordinates(y, x, sines[i], cosines[i])
        z = z + d_offsets[i]
        points[i][0] = x
        points[i][1] = y
        sin_alpha, cos_alpha, a, b = link(links[i])
        if parallel[i]:
            x = x + (a * cosines[i - 1] - b * sines[i - 1])
            y = y + (a * sines[i - 1] + b * cosines[i - 1])
        else:
            z, y = turn_coordinates(z, y, sin_alpha, cos_alpha)
            x = x + a
            y = y + b
    return x, y, z


def columns_of_axes(rows, points, rotates, slides, begin, end, J):
    """Columns (r Z; r (x Y - y X) + s Z) of joints begin ... end - 1: velocity of the point that
    they see at (x, y).
    """
    for i in range(begin, end):
        row = rows[i]
        r = rotates[i]
        s = slides[i]
        X = (row[0], row[1], row[2])
        Y = (row[3], row[4], row[5])
        Z = (row[6], row[7], row[8])
        point = points[i]
        v = subtract(scale(point[0], Y), scale(point[1], X))
        w = scale(r, Z)
        v = add(scale(r, v), scale(s, Z))
        set_column(J, i, twist(w, v))


def link(row):
    """sin alpha, cos alpha, a, b of a row of `links`."""
    return row[0], row[1], row[2], row[3]


def turn_coordinates(a, b, sine, cosine):
    """(cosine a + sine b, cosine b - sine a): two coordinates of a point in axes that are turned
    about the third.
    """
    return cosine * a + sine * b, cosine * b - sine * a


def write(row, X, Y, Z, o):
    """X, Y, Z and o into a row of 12 numbers."""
    store_row(row, (*X, *Y, *Z, *o))
