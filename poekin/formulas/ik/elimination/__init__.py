"""Six revolute joints of any geometry: two angles of three are eliminated, and the third is a root
of a trigonometric polynomial of degree 8.

The closed form of Raghavan and Roth without half-angle tangents: their determinant is read at
equally spaced angles of the one joint, which tells the polynomial by its Fourier coefficients.
"""
