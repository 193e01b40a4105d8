"""Scene: all that a page shows and says, as data, before anything is drawn."""

from __future__ import annotations

from dataclasses import dataclass

from ..groups.arrays import Array
from ..solve.path.path_events import PathEvent
from .nodes import Layer, Node


@dataclass(frozen=True, slots=True)
class Slider:
    """A slider: its name, "rad" or "m", and its limits, infinite where there are none."""

    name: str
    unit: str
    lower: float
    upper: float


@dataclass(frozen=True, slots=True)
class SceneTip:
    """A link whose pose and Jacobian the page shows: name, number of the link, the numbers of the
    coordinates that move it, in the order of the Jacobian's columns, and the reach of its chain, m,
    by which rotations and translations are weighed as `singularity` does.
    """

    name: str
    link: int
    coordinates: tuple[int, ...]
    reach: float


@dataclass(frozen=True, slots=True, eq=False)
class SceneArm:
    """One model of the page.

    Attributes
    ----------
    name : str
        Name of the model.
    program : str
        Its kinematics as the text of a JavaScript module (`view.kinematics`).
    links : tuple of str
        Names of the links, in the order of the module's poses.
    coordinates : tuple of Slider
        Coordinates q of the model.
    tips : tuple of SceneTip
        Tips with a Jacobian.
    base : (4, 4) ndarray
        Pose of its base frame in the world, m.
    factors : (m, sliders) ndarray
        Own q = factors · sliders + shift.
    shift : (m,) ndarray
        See factors.
    """

    name: str
    program: str
    links: tuple[str, ...]
    coordinates: tuple[Slider, ...]
    tips: tuple[SceneTip, ...]
    base: Array
    factors: Array
    shift: Array


@dataclass(frozen=True, slots=True, eq=False)
class SceneMotion:
    """Rows q (n, sliders) at times (n,), s, that the page plays, and what happens on the way, first and
    last by these rows.
    """

    q: Array
    times: Array
    marks: tuple[PathEvent, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class SceneChoice:
    """A configuration of the sliders that a reader can choose, and its words."""

    q: Array
    text: str


@dataclass(frozen=True, slots=True)
class PageTable:
    """Table under the numbers of the page: a title, heads, and rows of texts."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A page's contents.

    Attributes
    ----------
    title : str
        Title.
    words : tuple of str
        Sentences below it.
    arms : tuple of SceneArm
        The model, or two; the sliders are the coordinates of the first.
    q : (m,) ndarray
        Configuration of the sliders when the page opens, rad or m.
    nodes : tuple of Node
        What is drawn.
    shown : frozenset of Layer
        Layers that are on when the page opens; those that have nodes can be switched.
    size : float
        Length of the whole, m: glyphs and arrows are drawn by it.
    motion, choices, tables
        What else there is.
    exaggerated : float
        Largest factor k by which the page can enlarge the differences of two arms, 1 for none; k is
        then the last coordinate of the second arm, and the last number of its shift when the page
        opens.
    """

    title: str
    words: tuple[str, ...]
    arms: tuple[SceneArm, ...]
    q: Array
    nodes: tuple[Node, ...]
    shown: frozenset[Layer]
    size: float
    motion: SceneMotion | None = None
    choices: tuple[SceneChoice, ...] = ()
    tables: tuple[PageTable, ...] = ()
    exaggerated: float = 1.0
