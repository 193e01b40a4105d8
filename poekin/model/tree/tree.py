"""Tree: the shape of a robot, which joint hangs where, checked without recursion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from ...errors import ModelError, quote, safe_repr, suggest
from ..joint import Joint
from ..provenance import Source


class Tree(NamedTuple):
    """The shape of a robot.

    root: number of the root link. order: the joints' numbers, parents first. parent_joint: for each
    link the number of the joint above it, -1 for the root. parent_link: for each joint the number
    of its parent link, child_link: of its child link.
    """

    root: int
    order: tuple[int, ...]
    parent_joint: tuple[int, ...]
    parent_link: tuple[int, ...]
    child_link: tuple[int, ...]


def tree_of(
    links: Sequence[str],
    joints: Sequence[Joint],
    source: Source,
) -> Tree:
    """The tree that the joints make of the links, in linear time.

    Raises: ModelError, with file and line where the source has them, for no link, a name used
    twice, an unknown link,
    a link with two parents, two roots, a cycle.
    """
    if not links:
        raise ModelError(f"{source.place()}: a robot needs at least one link, this one has none")
    numbers = _unique(links, "link", source.of_link)
    _unique([joint.name for joint in joints], "joint", source.of_joint)
    parent_joint = [-1] * len(links)
    parent_link: list[int] = []
    child_link: list[int] = []
    children: list[list[int]] = [[] for _ in links]
    for index, joint in enumerate(joints):
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in numbers:
                raise ModelError(
                    f"{source.of_joint(index)}: joint {quote(joint.name)}: its {role} link {quote(name)} does not"
                    f" exist; {suggest(name, links)}"
                )
        parent = numbers[joint.parent]
        child = numbers[joint.child]
        if parent_joint[child] >= 0:
            other = parent_joint[child]
            raise ModelError(
                f"{source.of_joint(index)}: link {quote(joint.child)} has two parents: joint {quote(joint.name)} and"
                f" joint {quote(joints[other].name)} ({source.of_joint(other)})"
            )
        parent_joint[child] = index
        children[parent].append(index)
        parent_link.append(parent)
        child_link.append(child)
    roots = [link for link, joint in enumerate(parent_joint) if joint < 0]
    if len(roots) > 1:
        named = ", ".join(f"{quote(links[r])} ({source.of_link(r)})" for r in roots[:5])
        more = f" and {len(roots) - 5} more" if len(roots) > 5 else ""
        raise ModelError(
            f"{source.of_link(roots[1])}: a robot has one root, but {len(roots)} links have no parent: {named}{more}"
        )
    order: list[int] = []
    ahead = [joint for root in roots for joint in reversed(children[root])]
    while ahead:
        joint = ahead.pop()
        order.append(joint)
        ahead.extend(reversed(children[child_link[joint]]))
    if len(order) < len(joints):
        reached = set(order)
        lost = next(joint for joint in range(len(joints)) if joint not in reached)
        raise _cycle(lost, joints, parent_joint, parent_link, source)
    return Tree(roots[0], tuple(order), tuple(parent_joint), tuple(parent_link), tuple(child_link))


def path(tree: Tree, base: int, tip: int) -> list[tuple[int, bool]]:
    """The joints between two links, from base to tip, each with True where it is passed from parent
    to child.
    """
    up = _joints_above(tree, base)
    down = _joints_above(tree, tip)
    while up and down and up[-1] == down[-1]:  # what lies above both links is not on the way
        up.pop()
        down.pop()
    return [(joint, False) for joint in up] + [(joint, True) for joint in reversed(down)]


def _joints_above(tree: Tree, link: int) -> list[int]:
    joints = []
    while (joint := tree.parent_joint[link]) >= 0:
        joints.append(joint)
        link = tree.parent_link[joint]
    return joints


def _unique(
    names: Sequence[str],
    what: str,
    place: Callable[[int], str],
) -> dict[str, int]:
    numbers: dict[str, int] = {}
    for index, name in enumerate(names):
        if not isinstance(name, str) or not name:
            raise ModelError(
                f"{place(index)}: a {what} needs a name that is not empty, got {safe_repr(name)}"
            )
        if name in numbers:
            first = place(numbers[name])
            raise ModelError(
                f"{place(index)}: the {what} name {quote(name)} is used twice (first: {first})"
            )
        numbers[name] = index
    return numbers


def _cycle(
    lost: int,
    joints: Sequence[Joint],
    parent_joint: list[int],
    parent_link: list[int],
    source: Source,
) -> ModelError:
    # Upward from a joint that the root does not reach there is no end, so the walk runs into a
    # cycle.
    walked: dict[int, int] = {}
    joint = lost
    while joint not in walked:
        walked[joint] = len(walked)
        joint = parent_joint[parent_link[joint]]
    circle = [j for j, step in walked.items() if step >= walked[joint]][::-1]
    named = " -> ".join(quote(joints[j].child) for j in circle[:10])
    if len(circle) > 10:
        named += " -> ..."
    first = min(circle)
    return ModelError(
        f"{source.of_joint(first)}: the links form a cycle of {len(circle)} joint(s): {named}"
    )
