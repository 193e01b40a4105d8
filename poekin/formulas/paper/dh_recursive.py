"""The Jacobian by the recursion of Orin and Schrader on Denavit-Hartenberg frames, the paper's
yardstick.

In Paul's frames joint i moves about the z axis of frame i - 1, before its link's constant part:
A_i = e^{S x_i} N_i. So every column waits for a product: n products (36, 27) and n columns (6, 3),
that is 42 n multiplications and 30 n additions if revolute, with a tool pose behind the last frame.
Accuracy: rounding of the products, u (8 (n + 1) + 4 sum |x|), u = 2^-53, lengths times the reach
(tests/model/test_chain_laws.py).
Source: Park 1994, Section IV, comparing Orin and Schrader 1984.
"""

from ...algebra import compose, pose, set_column
from ..kinematics.recursive import z_column


def body(links, tool, rotates, slides, count, J):
    """Body Jacobian: column i is Ad(A_i ... A_n T)^-1 S_i with the frames' poses A_i (`links`) and
    the tool T.

    Returns A_1 ... A_n T, the pose of the tool in the base frame.
    """
    T = pose(tool)
    for i in range(count - 1, -1, -1):
        T = compose(links[i], T)
        set_column(J, i, z_column(T, rotates[i], slides[i]))
    return T
