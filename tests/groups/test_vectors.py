import numpy as np

from poekin.groups import se3
from poekin.groups.vectors import (
    angular_part,
    applied,
    directions,
    dots,
    linear_part,
    norm,
    normalised,
    normalised_or_zero,
    norms,
    rotation_part,
    translation_part,
)

# Exact in floats: lengths 5 and 13.
VECTORS = np.array([[3.0, 4.0], [5.0, 12.0]])


def test_norms_are_the_lengths_along_the_last_axis():
    assert (norms(VECTORS) == [5.0, 13.0]).all()
    assert norm(VECTORS[0]) == 5.0
    assert isinstance(norm(VECTORS[0]), float)
    assert (norms(np.stack([VECTORS, 2 * VECTORS])) == [[5.0, 13.0], [10.0, 26.0]]).all()


def test_normalised_vectors_are_divided_by_their_lengths():
    assert (normalised(VECTORS) == VECTORS / [[5.0], [13.0]]).all()


def test_a_vector_of_length_zero_stays_zero():
    x = np.array([[3.0, 4.0], [0.0, 0.0]])
    expected = x / [[5.0], [1.0]]
    assert (normalised_or_zero(x) == expected).all()
    assert (normalised_or_zero(x[0]) == expected[0]).all()
    assert (normalised_or_zero(np.array([x, x])) == expected).all()


def test_dots_keep_an_axis_of_length_one():
    assert (dots(VECTORS, VECTORS) == [[25.0], [169.0]]).all()


def test_a_matrix_is_applied_to_the_vector_at_its_place():
    matrices = np.array(
        [[[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]], [[2.0, 0.0], [0.0, 2.0], [1.0, -1.0]]]
    )
    assert (applied(matrices, VECTORS) == [[3.0, 4.0, 7.0], [10.0, 24.0, -7.0]]).all()


R = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def test_a_pose_has_the_rotation_and_the_translation_that_made_it():
    T = se3.pose(R, [1.0, 2.0, 3.0])
    assert (rotation_part(T) == R).all()
    assert (translation_part(T) == [1.0, 2.0, 3.0]).all()


def test_parts_keep_leading_axes():
    T = np.zeros((5, 2, 4, 4))
    V = np.zeros((5, 2, 6))
    assert rotation_part(T).shape == (5, 2, 3, 3)
    assert translation_part(T).shape == (5, 2, 3)
    assert angular_part(V).shape == linear_part(V).shape == directions(V).shape == (5, 2, 3)


def test_the_angular_part_of_a_twist_comes_first():
    V = np.arange(6.0)
    assert (angular_part(V) == [0.0, 1.0, 2.0]).all()
    assert (linear_part(V) == [3.0, 4.0, 5.0]).all()


def test_a_prismatic_joint_points_along_its_velocity_and_any_other_along_its_axis():
    screws = np.array([[0.0, 0.0, 1.0, 4.0, 5.0, 6.0], [0.0, 0.0, 0.0, 0.0, 1.0, 0.0]])
    assert (directions(screws) == [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]).all()


def test_vectors_stand_along_the_last_axis_of_any_number():
    x = np.arange(24.0).reshape(2, 4, 3)
    assert (dots(x, x)[..., 0] == np.einsum("...i,...i", x, x)).all()
    S = np.zeros((2, 1, 6))
    S[0, 0, 2] = S[1, 0, 4] = 1.0
    S[0, 0, 3] = 9.0
    assert (directions(S)[:, 0] == [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]).all()
