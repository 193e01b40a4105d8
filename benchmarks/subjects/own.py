"""poekin itself as a subject: its groups, chains and reader of URDFs."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import poekin as pk
from poekin.errors import PoekinWarning
from poekin.formats.urdf import read_text


class Poekin:
    """All that the laws know."""

    name = "poekin"
    version = pk.__version__
    twist_order = "angular first"
    jacobian_frame = "body"
    batch = helical = True
    noise = 1e-8

    exp, log, adjoint = (
        staticmethod(pk.se3.exp),
        staticmethod(pk.se3.log),
        staticmethod(pk.se3.adjoint),
    )
    left_jacobian, right_jacobian = (
        staticmethod(pk.se3.left_jacobian),
        staticmethod(pk.se3.right_jacobian),
    )
    left_jacobian_inverse = staticmethod(pk.se3.left_jacobian_inverse)
    right_jacobian_inverse = staticmethod(pk.se3.right_jacobian_inverse)
    so3_exp, so3_log = staticmethod(pk.so3.exp), staticmethod(pk.so3.log)
    so3_left_jacobian, so3_right_jacobian = (
        staticmethod(pk.so3.left_jacobian),
        staticmethod(pk.so3.right_jacobian),
    )
    so3_left_jacobian_inverse = staticmethod(pk.so3.left_jacobian_inverse)
    so3_right_jacobian_inverse = staticmethod(pk.so3.right_jacobian_inverse)

    def fk(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        return pk.Chain.from_space(screws, home).fk(q)

    def jacobian(self, screws: np.ndarray, home: np.ndarray, q: np.ndarray) -> np.ndarray:
        return pk.Chain.from_space(screws, home).jacobian(q, frame="body")

    def read_urdf(self, text: str, base: str, tip: str) -> Any:
        chain = _read(text).chain(base=base, tip=tip)

        class Arm:
            names = chain.q_names

            def fk(self, q: np.ndarray) -> np.ndarray:
                return chain.fk(q)

            def jacobian(self, q: np.ndarray) -> np.ndarray:
                return chain.jacobian(q, frame="body")

        return Arm()

    def read_robot(self, text: str) -> Any:
        robot = _read(text)

        class Whole:
            names = robot.q_names

            def poses(self, q: np.ndarray) -> dict[str, np.ndarray]:
                return robot.fk(q)

        return Whole()


def _read(text: str) -> pk.Robot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PoekinWarning)
        return read_text(text)
