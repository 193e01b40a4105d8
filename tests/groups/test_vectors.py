import numpy as np

from poekin.groups.vectors import applied, dots, norm, normalised, norms

# Exact in floats: lengths 5 and 13.
VECTORS = np.array([[3.0, 4.0], [5.0, 12.0]])


def test_norms_are_the_lengths_along_the_last_axis():
    assert (norms(VECTORS) == [5.0, 13.0]).all()
    assert norm(VECTORS[0]) == 5.0
    assert isinstance(norm(VECTORS[0]), float)


def test_normalised_vectors_are_divided_by_their_lengths():
    assert (normalised(VECTORS) == VECTORS / [[5.0], [13.0]]).all()


def test_dots_keep_an_axis_of_length_one():
    assert (dots(VECTORS, VECTORS) == [[25.0], [169.0]]).all()


def test_a_matrix_is_applied_to_the_vector_at_its_place():
    matrices = np.array(
        [[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]], [[2.0, 0.0], [0.0, 2.0], [1.0, -1.0]]]
    )
    assert (applied(matrices, VECTORS) == [[3.0, 4.0, 7.0], [10.0, 24.0, -7.0]]).all()
