"""What is removed from the cache, and when it is looked through."""

from __future__ import annotations

import os
import time

import pytest

from poekin.engine.jit import cache_size

DAY = 24 * 3600.0
MOST = 1600  # of which a look through leaves 1500, and 750 to arms


@pytest.fixture
def put(tmp_path):
    """Put an entry of so many bytes into the directory, last used so many days ago."""

    def entry(name: str, size: int, days: float = 1.0) -> None:
        path = tmp_path / f"{name}.kernel"
        path.write_bytes(bytes(size))
        used = time.time() - days * DAY
        os.utime(path, (used, used))

    return entry


def left(place) -> set[str]:
    return {path.stem for path in place.iterdir()}


def test_an_arm_and_a_rest_not_used_for_a_month_are_removed_and_kernels_stay(tmp_path, put):
    for days, age in ((29, "younger"), (31, "older")):
        put(f"arm-{age}", 1, days)
        put(age, 1, days)
        put(f"rest-{age}", 1, days)
        (tmp_path / f"rest-{age}.kernel").rename(tmp_path / f"rest-{age}.kernelx")
    cache_size.bound(tmp_path, 1, MOST)
    assert left(tmp_path) == {"arm-younger", "younger", "older", "rest-younger"}


def test_entries_that_just_fit_are_kept_and_the_oldest_that_does_not_is_removed(tmp_path, put):
    for days, name in enumerate("abcdefghijklmnop"):
        put(name, 100, days)
    cache_size.bound(tmp_path, 100, MOST)
    assert left(tmp_path) == set("abcdefghijklmno")  # a sixteenth is free until the next look


def test_arms_that_just_fit_into_half_of_the_room_are_kept(tmp_path, put):
    for days, name in enumerate(["arm-a", "arm-b", "arm-c", "d"]):
        put(name, 375, days)
    cache_size.bound(tmp_path, 375, MOST)
    assert left(tmp_path) == {"arm-a", "arm-b", "d"}


def test_the_directory_is_looked_through_after_each_sixteenth_of_the_bound(tmp_path, put):
    cache_size.bound(tmp_path, 1, MOST)  # the first entry of this process
    looked = []
    for _ in range(8):
        put("arm-old", 1, days=31)
        cache_size.bound(tmp_path, 50, MOST)
        looked.append("arm-old" not in left(tmp_path))
    assert looked == [False, False, True, False, False, True, False, False]


def test_one_byte_more_than_a_sixteenth_is_what_it_takes(tmp_path, put):
    looked = []
    for written in (1, 101, 100, 1, 101):
        put("arm-old", 1, days=31)
        cache_size.bound(tmp_path, written, MOST)
        looked.append("arm-old" not in left(tmp_path))
    assert looked == [True, True, False, True, True]


def test_a_link_takes_no_more_room_than_itself(tmp_path, put):
    place = tmp_path / "place"
    place.mkdir()
    put("large", 5000)
    (place / "link.kernel").symlink_to(tmp_path / "large.kernel")
    cache_size.bound(place, 1, MOST)
    assert left(place) == {"link"}
