"""Denavit-Hartenberg links, and the paper's route from them to the screws of the product of
exponentials.

    f = K_0 e^{P_1 x_1} K_1 e^{P_2 x_2} K_2 ... e^{P_n x_n} K_n,  P = (0, 0, r; 0, 0, s)

K_i = Rz(theta) Tz(d) Tx(a) Rx(alpha) is Paul's (distal) link i; of Craig's (proximal) convention it
is the same expression with a and alpha of the next row; the paper calls it M_i. Then A_i =
Ad(K_0 ... K_{i-1}) P_i and M = K_0 ... K_n.
Accuracy: u n (R + largest |d|, |a|), u = 2^-53 (tests/formats/test_dh.py).
Source: Park 1994, Section II, "Denavit-Hartenberg", with M_i <- e^{P_i x_0} M_i for a joint's
offset x_0.
"""

from ..algebra import adjoint, compose, pose, store_row


def link(sin_theta, cos_theta, d, a, sin_alpha, cos_alpha):
    """Rz(theta) Tz(d) Tx(a) Rx(alpha), sines and cosines given."""
    return (
        *(cos_theta, -sin_theta * cos_alpha, sin_theta * sin_alpha),
        *(sin_theta, cos_theta * cos_alpha, -cos_theta * sin_alpha),
        *(0.0, sin_alpha, cos_alpha),
        *(a * cos_theta, a * sin_theta, d),
    )


def screws(links, rotates, slides, count, A):
    """A_i into the rows of A; returns the home pose M. `links` are K_0 ... K_n."""
    T = pose(links[0])
    for i in range(count):
        store_row(A[i], adjoint(T, (0.0, 0.0, rotates[i], 0.0, 0.0, slides[i])))
        T = compose(T, links[i + 1])
    return T
