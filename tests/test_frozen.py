"""What a dataclass holds cannot be changed by accident, but for those that are made to be filled."""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil

import poekin

FILLED = {
    "Chain",  # refuses by itself, and keeps what it has computed
    "ChainData",
    "ChainDerivatives",
    "ChainEntrances",
    "ChainFrames",
    "ChainPictures",
    "ChainCoordinates",
    "Count",
    "Fields",  # a frozen one takes longer to make, and there are as many as a file has elements
    "Follower",
    "Instance",
    "Kernel",
    "Outputs",
    "Ranges",
    "Traced",  # as Fields: there are as many as operations
    "_Builder",
    "_Joint",
    "_Level",
    "_Run",
    "_Way",
}


def test_every_dataclass_is_frozen_but_for_these():
    found = set()
    for info in pkgutil.walk_packages(poekin.__path__, "poekin."):
        if not info.name.endswith("__main__"):
            module = importlib.import_module(info.name)
            found |= {
                kind.__name__
                for kind in vars(module).values()
                if isinstance(kind, type)
                and kind.__module__ == info.name
                and dataclasses.is_dataclass(kind)
                and not kind.__dataclass_params__.frozen  # type: ignore[attr-defined]
            }
    assert found == FILLED
