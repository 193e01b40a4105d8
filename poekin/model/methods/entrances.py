"""Chains from screws in the base frame, in the tool frame, or in the links' own frames."""

from __future__ import annotations

from typing import Self, Unpack

import numpy as np
from numpy.typing import ArrayLike

from ...errors import ShapeError
from ...groups import se3
from ...groups.arrays import numbers
from ..chain_data import ChainData, ChainOptions
from ..checks import one_pose, ordered_names
from ..screw_rows.unit_screws import pitches_of, unit_screws


class ChainEntrances(ChainData):
    """Class methods that make a chain of one of the three forms of the product of exponentials."""

    __slots__ = ()

    @classmethod
    def from_space(
        cls,
        A: ArrayLike,
        M: ArrayLike,
        **options: Unpack[ChainOptions],
    ) -> Self:
        """Chain of screws in the base frame: f = e^{A_1 x_1} ... e^{A_n x_n} M.

        Parameters
        ----------
        A : (n, 6) array_like
            Unit screws A_i = (ω; v) in the base frame at x = 0, a row a joint, per rad or m: the
            transpose of Modern Robotics' Slist.
        M : (4, 4) array_like
            Home pose T_sb, that of the tip in the base frame at x = 0, m.
        **options : ChainOptions
            Names, limits, coupling, offset and pitches, as `Chain` takes them.

        Returns
        -------
        chain : Chain
            Chain of these screws.

        Raises
        ------
        ScrewError
            If a row is no unit screw; the message names the remedy where another reading fits.
        PoseError
            If M is no pose.
        ShapeError
            If an array has another shape.
        InputError
            If a number is not finite, or names or limits cannot be used.

        Notes
        -----
        Accuracy: as given, to the last digit. Source: Park 1994, eq. (1).

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> A = [[0, 0, 1, 0, 0, 0], [0, 0, 1, 0, -0.5, 0]]
        >>> M = pk.se3.pose(np.eye(3), [0.8, 0, 0])
        >>> arm = pk.Chain.from_space(A, M, joint_names=["shoulder", "elbow"])
        >>> print(arm)
        <Chain 'base' -> 'tool': 2 revolute joints, reach 1 m>
        """
        return cls(A, M, frame="space", **options)

    @classmethod
    def from_body(
        cls,
        B: ArrayLike,
        M: ArrayLike,
        **options: Unpack[ChainOptions],
    ) -> Self:
        """Chain of screws in the tool frame: f = M e^{B_1 x_1} ... e^{B_n x_n}.

        Parameters
        ----------
        B : (n, 6) array_like
            Unit screws B_i = (ω; v) in the tool frame at x = 0, a row a joint, per rad or m: the
            transpose of Modern Robotics' Blist.
        M : (4, 4) array_like
            Home pose T_sb, that of the tip in the base frame at x = 0, m.
        **options : ChainOptions
            Names, limits, coupling, offset and pitches, as `Chain` takes them.

        Returns
        -------
        chain : Chain
            Chain of the screws A_i = Ad(M) B_i.

        Raises
        ------
        ScrewError
            If a row is no unit screw; the message names the remedy where another reading fits.
        PoseError
            If M is no pose.
        ShapeError
            If an array has another shape.
        InputError
            If a number is not finite, or names or limits cannot be used.

        Notes
        -----
        Accuracy: A within 10 u (|v| + |p|), u = 2^-53, p the translation of M; pitches are those of
        B (tests/model/methods/test_entrances.py). Source: Park 1994, eq. (2).

        Examples
        --------
        >>> import poekin as pk
        >>> arm = pk.load("ur5e").chain()
        >>> again = pk.Chain.from_body(arm.body.screws, arm.home)
        >>> bool(abs(again.screws - arm.screws).max() < 1e-14)
        True
        """
        return cls(B, M, frame="body", **options)

    @classmethod
    def from_local(
        cls,
        S: ArrayLike,
        M_i: ArrayLike,
        tool: ArrayLike | None = None,
        **options: Unpack[ChainOptions],
    ) -> Self:
        """Chain of screws in the links' frames: f = M_1 e^{S_1 x_1} ... M_n e^{S_n x_n} M_{n+1}.

        Parameters
        ----------
        S : (n, 6) array_like
            Unit screws S_i = (ω; v), each in the frame of its own joint, per rad or m; (0, 0, 1; 0,
            0, 0) turns about the frame's z axis.
        M_i : (n, 4, 4) array_like
            Poses M_1, ..., M_n of each joint's frame in the one before at x = 0, m.
        tool : (4, 4) array_like, optional
            Pose M_{n+1} of the tip in the last joint's frame, m; the identity where it is left out.
        **options : ChainOptions
            Names, limits, coupling, offset and pitches, as `Chain` takes them.

        Returns
        -------
        chain : Chain
            Chain of the screws A_i = Ad(M_1 ... M_i) S_i in the base frame.

        Raises
        ------
        ScrewError
            If a row is no unit screw; the message names the remedy where another reading fits.
        PoseError
            If a matrix is no pose.
        ShapeError
            If an array has another shape.
        InputError
            If a number is not finite, or names or limits cannot be used.

        Notes
        -----
        Accuracy: A within 10 (n + 1) u times the reach, u = 2^-53; pitches are those of S
        (tests/model/methods/test_entrances.py). Source: Park 1994, Section IV.

        Examples
        --------
        >>> import numpy as np
        >>> import poekin as pk
        >>> turn = [0, 0, 1, 0, 0, 0]
        >>> link = pk.se3.pose(np.eye(3), [0.5, 0, 0])
        >>> arm = pk.Chain.from_local([turn, turn], [np.eye(4), link], tool=link)
        >>> print(arm.fk([0.0, 0.0])[:3, 3])
        [1. 0. 0.]
        """
        names = ordered_names(options.get("joint_names"), "joint_names")
        A = unit_screws(S, names, "S")
        h = pitches_of(A, options.get("pitches"), names)
        links = numbers(M_i, "M_i")
        if links.shape != (len(A), 4, 4) and (links.size or len(A)):
            raise ShapeError(
                f"M_i: expected shape ({len(A)}, 4, 4), one pose a joint and M_{{n+1}} as tool=,"
                f" got {links.shape}"
            )
        P = np.eye(4)
        for i, link in enumerate(links):
            P = P @ one_pose(link, f"M_i[{i}]")
            A[i] = se3.adjoint(P) @ A[i]
        home = P if tool is None else P @ one_pose(tool, "tool")
        return cls(A, home, frame="space", **{**options, "pitches": h})
