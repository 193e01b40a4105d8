"""The data of a page: it cannot be changed, and is itself alone."""

from __future__ import annotations

import dataclasses
import inspect
from types import ModuleType
from typing import Any

import pytest

from poekin.view import k3d_objects, nodes, page, scene
from poekin.view.scenes.arm_parts import geometry

HOLDERS = (nodes, scene, page, k3d_objects, geometry)


def records(module: ModuleType) -> list[type]:
    """Data classes of a module."""
    found = [value for _, value in inspect.getmembers(module, inspect.isclass)]
    own = [value for value in found if value.__module__ == module.__name__]
    return [value for value in own if dataclasses.is_dataclass(value)]


RECORDS = [record for module in HOLDERS for record in records(module)]
PLAIN = {"Slider", "SceneTip", "PageTable", "Attachment"}
"""Records of texts and numbers alone; arrays have no equality that is true or false."""


def made(record: type) -> Any:
    """One of them; no field is judged when it is made."""
    return record(*[(field.name,) for field in dataclasses.fields(record)])


def test_there_are_records():
    assert len(RECORDS) >= 17
    assert {record.__name__ for record in RECORDS} >= PLAIN


@pytest.mark.parametrize("record", RECORDS)
def test_a_record_cannot_be_changed_and_holds_nothing_else(record):
    one = made(record)
    for name in (dataclasses.fields(record)[0].name, "another"):
        with pytest.raises((AttributeError, TypeError)):
            setattr(one, name, 1)
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(one, dataclasses.fields(record)[0].name, 1)
    assert not hasattr(one, "__dict__")


@pytest.mark.parametrize("record", RECORDS)
def test_records_with_arrays_are_equal_only_to_themselves(record):
    one, other = made(record), made(record)
    assert one == one
    assert (one == other) is (record.__name__ in PLAIN)
    assert (hash(one) == hash(other)) is (record.__name__ in PLAIN)
