"""det(J Jᵀ), the square of Yoshikawa's manipulability: the product of the squares of J's singular
values.
"""


def determinant(J, rows, columns, G):
    """det(J Jᵀ) of a matrix J (rows, columns), rows <= columns; G (rows, rows) is written to.

    By elimination without square roots: J Jᵀ = L D Lᵀ, whose determinant is the product of the
    pivots D. Where a pivot is 0, so that J has not full rank, it is 0 or NaN.

    Cost: rows - 1 divisions.
    Accuracy: within 4 (rows + columns) u of the product of all |J_i|², i the rows
    (tests/formulas/kinematics/test_gram.py).
    Source: Yoshikawa 1985; Golub and Van Loan 2013, Section 4.1.
    """
    for i in range(rows):
        for j in range(i + 1):
            total = J[i][0] * J[j][0]
            for k in range(1, columns):
                total = total + J[i][k] * J[j][k]
            G[i][j] = total
    product = G[0][0]
    for p in range(rows - 1):
        inverse = 1.0 / G[p][p]
        for i in range(p + 1, rows):
            factor = G[i][p] * inverse
            for j in range(p + 1, i + 1):
                G[i][j] = G[i][j] - factor * G[j][p]
        product = product * G[p + 1][p + 1]
    return product
