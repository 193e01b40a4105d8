"""A chain as a figure in print, and as a table in a notebook."""

from __future__ import annotations

from typing import Any

from ..chain_data import ChainData
from ..show import tables
from ..show.plot import plot


class ChainPictures(ChainData):
    """Methods that show a chain."""

    __slots__ = ()

    def plot(self, q: Any = None, *, size: tuple[float, float] = (5.0, 5.0)) -> Any:
        """Figure for print: skeleton, joint axes A_1 ... A_n, base and tool frame.

        Axes of revolute joints are dash-dotted, of prismatic ones dotted, of helical ones dashed;
        the arrow is the positive direction. A page in which the arm moves: `poekin.view`.

        Parameters
        ----------
        q : (m,) array_like or dict, optional
            Configuration, rad or m, as `fk`; zero where it is left out.
        size : tuple of float, default (5.0, 5.0)
            Width and height, inches.

        Returns
        -------
        figure : matplotlib.figure.Figure
            Figure, lengths in m; `figure.savefig("arm.svg")` and the like write it.

        Raises
        ------
        MissingExtra
            If Matplotlib (extra `report`) is not installed.
        ShapeError
            If q has another number of coordinates.
        UnknownName
            If a name is no coordinate.
        InputError
            If q is no single finite configuration.

        Notes
        -----
        The skeleton joins the origins of `joint_poses`: on each axis the point that was nearest
        to the one before.

        Examples
        --------
        >>> import poekin as pk
        >>> figure = pk.load("ur5e").chain().plot()
        >>> [axes.get_zlabel() for axes in figure.axes]
        ['z, m']
        """
        return plot(self, q, size)

    def _repr_html_(self) -> str:
        return tables.chain_table(self)
