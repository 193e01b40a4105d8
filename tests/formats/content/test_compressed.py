"""Gzip and zip: what is in them is read, and no more of it than is bounded."""

from __future__ import annotations

import gzip
import io
import zipfile

import pytest
from hypothesis import given
from hypothesis import strategies as st

from poekin.errors import FileError
from poekin.formats.content import compressed
from poekin.formats.load import load
from poekin.formats.text import xml
from tests.formats.texts import one_joint

TEXT = one_joint().encode()


def zipped(*files: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as archive:
        for name, content in files:
            archive.writestr(name, content)
    return out.getvalue()


@given(st.lists(st.binary(max_size=50), min_size=1, max_size=3))
def test_gzip_of_several_parts_is_their_content_together(parts):
    content = b"".join(map(gzip.compress, parts))
    whole = b"".join(parts)
    if compressed.is_compressed(whole):
        return
    assert compressed.is_compressed(content)
    assert compressed.decompress(content, "f") == whole
    assert compressed.decompress(content + bytes(100), "f") == whole  # as tapes are filled up


@pytest.mark.parametrize(
    "method", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA]
)
def test_the_only_urdf_in_an_archive_is_the_model(method):
    content = zipped(
        *(
            ("a/", b""),
            ("a/arm.URDF", TEXT),
            ("a/mesh.stl", b"solid"),
            ("__MACOSX/a/arm.urdf", b"x"),
        ),
        method=method,
    )
    assert compressed.decompress(content, "f.zip") == TEXT
    assert compressed.decompress(content, "f.zip", "a/mesh.stl") == b"solid"


def test_a_model_is_loaded_out_of_a_file(tmp_path):
    path = tmp_path / "arm.urdf.gz"
    path.write_bytes(gzip.compress(TEXT))
    (tmp_path / "models.ZIP").write_bytes(zipped(("b/x.urdf", TEXT), ("y.urdf", b"<robot/>")))
    (tmp_path / "arm.zip").write_bytes(zipped(("b/x.urdf", TEXT)))
    plain = tmp_path / "arm.urdf"
    plain.write_bytes(TEXT)
    expected = load(plain)
    for name in (path, tmp_path / "arm.zip", f"{tmp_path}/models.ZIP/b/x.urdf"):
        robot = load(name)
        assert robot == expected
        assert robot.source is not None
        assert (str(robot.source), robot.source.text) == (str(name), TEXT)
        assert load(str(name)) == expected


def test_the_file_in_an_archive_is_named_in_what_is_wrong_with_it(tmp_path):
    (tmp_path / "a.zip").write_bytes(zipped(("x.urdf", b"<robot>\n<"), ("y.urdf", TEXT)))
    with pytest.raises(ValueError, match=r"a\.zip/x\.urdf:2: malformed XML"):
        load(f"{tmp_path}/a.zip/x.urdf")
    with pytest.raises(FileError, match=r"gone\.zip/x\.urdf: no such file"):
        load(f"{tmp_path}/gone.zip/x.urdf")
    (tmp_path / "folder.zip").mkdir()
    (tmp_path / "folder.zip" / "x.urdf").write_bytes(TEXT)
    assert load(f"{tmp_path}/folder.zip/x.urdf").name == "r"


ENCRYPTED = bytearray(zipped(("a.urdf", TEXT)))
for _signature, _flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
    ENCRYPTED[ENCRYPTED.index(_signature) + _flags] |= 1
BROKEN = bytearray(zipped(("a.urdf", TEXT), method=zipfile.ZIP_STORED))
BROKEN[60] ^= 1
UNKNOWN = bytearray(zipped(("a.urdf", TEXT)))
UNKNOWN[UNKNOWN.index(b"PK\x01\x02") + 10] = 99

REFUSED = {
    "gzip, cut": (gzip.compress(TEXT)[:-9], "f: cannot be decompressed: 'Compressed file ended..."),
    "gzip, with something behind it": (
        gzip.compress(TEXT) + b"more",
        "f: cannot be decompressed: 'Not a gzipped file...",
    ),
    "gzip, changed": (
        gzip.compress(TEXT)[:-8] + bytes(8),
        "f: cannot be decompressed: 'CRC check failed...",
    ),
    "gzip, garbage": (b"\x1f\x8b\x08" + b"\xff" * 50, "f: cannot be decompressed: '..."),
    "gzip in gzip": (
        gzip.compress(gzip.compress(TEXT)),
        "f: expected a model in it, got compressed content once more",
    ),
    "an archive in gzip": (
        gzip.compress(zipped(("a.urdf", TEXT))),
        "f: expected a model in it, got compressed content once more",
    ),
    "zip, cut": (zipped(("a.urdf", TEXT))[:-9], "f: cannot be decompressed: 'File is not a zip..."),
    "zip, changed": (bytes(BROKEN), "f: cannot be decompressed: 'Bad CRC-32 for file..."),
    "zip, with a password": (bytes(ENCRYPTED), "f: cannot be decompressed: ..."),
    "zip, by another method": (bytes(UNKNOWN), "f: cannot be decompressed: '..."),
    "zip, empty": (
        zipped(),
        "f: expected one .urdf in the archive, or its name behind the archive's, got none;"
        " its files: none",
    ),
    "zip, without a urdf": (
        zipped(("a.stl", b""), ("__MACOSX/a.urdf", b"")),
        "f: expected one .urdf in the archive, or its name behind the archive's, got none;"
        " its files: 'a.stl'",
    ),
    "zip, with two": (
        zipped(("a.urdf", TEXT), ("b/c.urdf", TEXT)),
        "f: expected one .urdf in the archive, or its name behind the archive's ('f/a.urdf'), got 2:"
        " 'a.urdf', 'b/c.urdf'",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_decompressed_is_refused(case):
    content, message = REFUSED[case]
    with pytest.raises(FileError) as caught:
        compressed.decompress(content, "f")
    assert str(caught.value).startswith(message.removesuffix("..."))
    assert message.endswith("...") or str(caught.value) == message


def test_a_file_that_the_archive_has_not_is_refused_with_the_closest():
    with pytest.raises(FileError, match=r"^f has no file 'arn\.urdf'; did you mean 'arm\.urdf'\?$"):
        compressed.decompress(zipped(("arm.urdf", TEXT), ("y.stl", b"")), "f", "arn.urdf")


def test_a_bomb_is_refused_while_it_is_decompressed(monkeypatch):
    monkeypatch.setattr(xml, "MAX_BYTES", 1000)
    bomb = bytes(100_000_000)
    for content, place in (
        (gzip.compress(bomb), "f"),
        (zipped(("a.urdf", bomb)), "f/a.urdf"),
        (zipped(("a.urdf", bomb), method=zipfile.ZIP_BZIP2), "f/a.urdf"),
    ):
        assert len(content) < 200_000
        with pytest.raises(FileError) as caught:
            compressed.decompress(content, "f")
        message = f"{place}: expected at most 64 MiB of decompressed text, got more"
        assert str(caught.value) == message
    just = bytes(1000)
    assert compressed.decompress(gzip.compress(just), "f") == just


def test_an_archive_of_more_files_than_anybody_has_is_refused_before_they_are_listed(monkeypatch):
    monkeypatch.setattr(compressed, "MOST_ENTRIES", 3)
    files = [(f"{k}.stl", b"") for k in range(3)]
    assert compressed.decompress(zipped(*files[:2], ("a.urdf", TEXT)), "f") == TEXT
    monkeypatch.setattr(zipfile, "ZipFile", None)
    with pytest.raises(FileError, match=r"^f: expected an archive of at most 3 files, got more$"):
        compressed.decompress(_many(files), "f")


def _many(files: list[tuple[str, bytes]]) -> bytes:
    return b"PK\x03\x04" + b"PK\x01\x02" * (len(files) + 1)


def test_ten_thousand_files_are_listed_and_one_more_is_not():
    files = [("", b"")] * 10_000
    with pytest.raises(
        FileError, match=r"^f: expected an archive of at most 10000 files, got more$"
    ):
        compressed.decompress(_many(files), "f")
    with pytest.raises(FileError, match=r"^f: cannot be decompressed"):
        compressed.decompress(_many(files[1:]), "f")
