"""A visual is what it was made of, and is never compared number by number."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from poekin.formats.visuals.visual import Visual, Visuals


def visual():
    return Visual("hook", np.eye(4), "box", (1.0, 2.0, 3.0), None, "arm.urdf:3")


def test_a_visual_is_frozen_and_holds_its_fields_alone():
    with pytest.raises(dataclasses.FrozenInstanceError):
        visual().link = "lamp"  # type: ignore[misc]
    assert not hasattr(visual(), "__dict__")


def test_a_visual_is_equal_only_to_itself():
    one = visual()
    assert one == one
    assert one != visual()


def test_a_shape_out_of_a_text_is_neither_a_mesh_nor_moved_before_it_is_scaled():
    assert (visual().file, visual().triangles, visual().T_mesh) == ("", None, None)
    assert Visuals() == ((), ())
