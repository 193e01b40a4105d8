"""Tables out of nothing: DH in TOML and CSV, calibrations in YAML, rows of numbers; nearly right,
most of them.
"""

from __future__ import annotations

import re

from . import mutate
from .draw import Draw

COLUMNS = ("theta", "d", "a", "alpha")


def dh_toml(d: Draw) -> str:
    lines = [f"convention = {_quoted(d, d.word('standard', 'modified'))}"]
    lines.append(d.maybe(f"name = {_quoted(d, d.text('arm'))}"))
    for frame in ("base", "tool"):
        if d.chance(0.2):
            rows = ("1.0, 0.0, 0.0, 0.1", "0.0, 1.0, 0.0, 0.0", "0.0, 0.0, 1.0, 0.2", "0, 0, 0, 1")
            rows = [row if not d.chance(d.odd) else d.numbers(4, ", ") for row in rows]
            lines.append(f"{frame} = [[{'], ['.join(rows)}]]")
    for i in range(d.size()):
        lines.append(
            "[[joint]]"
            if not d.chance(d.odd)
            else d.pick(("[joint]", "[[joint.x]]", "[[base]]", "[[joint"))
        )
        row = [f"{column} = {d.number() or 0}" for column in COLUMNS]
        extra = {
            "kind": _quoted(d, d.word("revolute", "prismatic")), "name": _quoted(d, d.text(f"j{i}")),
            "flip": d.word("true", "false"),
            "limits": f"[{d.word('-1.0', '-inf')}, {d.word('2.5', 'inf', d.number())}]",
            d.text("x"): d.number(),
        }  # fmt: skip
        row += [f"{key} = {value}" for key, value in list(extra.items())[: None if d.chance(d.odd) else 4]
                if d.chance(0.3)]  # fmt: skip
        lines += d.shuffled(row)
    if d.chance(d.odd):
        nested = d.pick((50, 400, 3000))
        lines.append(d.pick((
            f"x = {'[' * nested}{']' * nested}", f"x = {'{a=' * nested}1{'}' * nested}",
            f"{'.'.join('a' * 10 * nested)} = 1", "x = 1979-05-27T07:32:00Z", "x = 0x" + "f" * nested,
        )))  # fmt: skip
    return "\n".join(lines)


def _quoted(d: Draw, text: str) -> str:
    if d.chance(0.95):
        return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    return d.pick((f"'{text}'", f'"{text}"', f'"""{text}"""', text))


def dh_csv(d: Draw) -> str:
    header = [
        "convention",
        *COLUMNS,
        *(c for c in ("name", "kind", "flip", "lower", "upper", "pose") if d.chance(0.4)),
    ]
    if d.chance(d.odd):
        header += [d.word(*header, "x")] * d.size(1)
    lines = [",".join(d.shuffled(header))]
    convention = d.pick(("standard", "modified"))
    for i in range(d.size()):
        cells = []
        posed = "pose" in header and d.chance(0.2)
        for column in header:
            if column == "convention":
                cells.append(d.text(convention))
            elif column in ("theta", "d", "a", "alpha"):
                cells.append("" if posed else d.number())
            elif column == "name":
                cells.append(d.maybe(d.text(f"j{i}")))
            elif column == "kind":
                cells.append(
                    d.word("base", "tool") if posed else d.word("revolute", "prismatic", "")
                )
            elif column == "flip":
                cells.append(d.word("true", "false", ""))
            elif column == "pose":
                cells.append(
                    "1 0 0 0 0 1 0 0 0 0 1 0.5"
                    if posed and not d.chance(d.odd)
                    else d.maybe(d.numbers(12), d.odd)
                )
            else:
                cells.append(d.maybe({"lower": "-1", "upper": "1"}.get(column, d.number())))
        lines.append(_line(d, cells))
    return _lines(d, lines)


def _line(d: Draw, cells: list[str]) -> str:
    if d.chance(d.odd):
        cells = cells[: d.below(len(cells) + 1)] if d.chance(0.5) else [*cells, d.number()]
    return ",".join(f'"{cell}"' if d.chance(0.03) else cell for cell in cells)


def _lines(d: Draw, lines: list[str]) -> str:
    if d.chance(d.odd):
        lines.insert(
            d.below(len(lines) + 1),
            d.pick(("", ",", '"', "#", "\0", "a,b", '"a"b', " ", "sep=;", "\r")),
        )
    return d.pick(("\n", "\n", "\n", "\r\n", "\r") if d.chance(0.2) else ("\n",)).join(
        lines
    ) + d.maybe("\n", 0.8)


LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
JOINTS = tuple(f"joint{i}" for i in range(1, 8))
NO_NUMBERS = (
    "    x: [1, 2]", "    x: {a: 1}", "    x: *a", "    x: &a 1", "    x: !!float 1", "\tx: 1", "    ? x", "    <<: *a",
    "    x: |\n      1", "---", "...", "%YAML 9",
)  # fmt: skip


def calibration_yaml(d: Draw) -> str:
    """Of Universal Robots, UFACTORY or Flexiv."""
    lines = [d.maybe("rpy: fixed\n", 0.2) + f"{d.word('kinematics')}:"]
    links = LINKS
    if d.chance(0.5):
        links = d.pick((JOINTS[:4], JOINTS[:5], JOINTS[:6], JOINTS, (*JOINTS, "link7_to_flange")))
    for link in d.shuffled(list(links)):
        lines.append(f"  {d.text(link)}:")
        numbers = [f"    {key}: {d.number()}" for key in ("x", "y", "z", "roll", "pitch", "yaw")]
        if d.chance(d.odd / 3):
            numbers[d.below(6)] = d.pick(NO_NUMBERS)
        lines += d.shuffled(numbers)
        if link in JOINTS and d.chance(0.3):
            lines.append(f"    axis: {d.pick(('0 1 0', '0 0 -1', f'{d.number()} 0 1', '', 'y'))}")
    lines.append(
        d.maybe(f"  hash: {d.text('calib_1')}") if not d.chance(d.odd) else "  hash:\n    a: 1"
    )
    if d.chance(0.2):
        lines.append(f"calibration_metadata:\n  model_name: {d.text('Rizon4s')}")
        lines.append(f"  joints_synced: {d.number()}")
    if d.chance(d.odd):
        return d.pick(
            (
                "kinematics: 1",
                "kinematics:",
                "rpy:\n  a: 1\n" + "\n".join(lines),
                "rpy: x\nkinematics: {}",
            )
        )
    if d.chance(d.odd / 3):
        nested = d.pick((5, 9, 500, 5000))
        lines.append(d.pick((
            "x: " + "[" * nested, "x: " + "{a: " * nested, "\n".join(" " * i + "a:" for i in range(nested // 5)),
            "- " * nested, "? " * nested, "&a " * nested, "x: !<" + "a" * nested,
        )))  # fmt: skip
    return "\n".join(lines)


def ur_conf(d: Draw) -> str:
    lines = ["[mounting]"]
    for name in ("delta_theta", "delta_a", "delta_d", "delta_alpha"):
        lines.append(f"{d.text(name)} = [ {d.numbers(6, ', ')} ]{d.maybe(' # x', 0.1)}")
    return "\n".join(d.shuffled(lines))


ENTRIES = [f"T{i}{j}" for i in range(4) for j in range(4)]
POSES = (
    (ENTRIES[:12], "1,0,0,0.5,0,1,0,0,0,0,1,0.1"), (ENTRIES, "1,0,0,0.5,0,1,0,0,0,0,1,0.1,0,0,0,1"),
    (["x", "y", "z", "qw", "qx", "qy", "qz"], "0.1,0,0.5,1,0,0,0"), (["x", "y", "z"], "0.1,0.2,0.3"),
    (["distance"], "0.5"), (["x1", "y1", "z1", "x2", "y2", "z2"], "1,2,3,4,5,6"),
)  # fmt: skip


def poses_csv(d: Draw) -> str:
    names, row = POSES[d.below(3)]
    return _rows(d, names, row, 0.5)


def joints_csv(d: Draw) -> str:
    names = ["a", "b", "c"] if d.chance(0.6) else ["time", "a", "b", "c"]
    return _rows(d, names, "", 0.6)


def measurements_csv(d: Draw) -> str:
    names, row = POSES[0] if d.chance(0.3) else d.pick(POSES)
    joints = d.pick((["a", "b", "c"], ["q1", "q2", "q3"]))
    return _rows(d, [*joints, *names], f"0.1,0.2,0.3,{row}", 1.0)


def jittered(d: Draw, text: str) -> str:
    """A document with some of its numbers off by a few roundings, and as odd as the rest something
    else for one, or
    for all that a key has.
    """
    if d.chance(3 * d.odd):
        text = mutate.value(d, text.encode()).decode("utf-8", "replace")

    def other(match: re.Match[str]) -> str:
        if d.chance(d.odd / 10):
            return d.number()
        return (
            repr(float(match.group()) * (1 + 2e-16 * d.below(10)))
            if d.chance(0.1)
            else match.group()
        )

    return re.sub(r"-?\d+\.\d+(?:e-?\d+)?", other, text)


def _rows(d: Draw, names: list[str], row: str, headed: float) -> str:
    lines = []
    if d.chance(headed):
        header = [d.text(name) for name in names]
        lines.append(",".join(d.shuffled(header) if not row else header))
    if not row and d.chance(d.odd / 3):  # more lines than are held at once
        lines += [",".join("1" * len(names))] * 10_001
    for _ in range(d.size()):
        lines.append(
            _line(d, row.split(","))
            if row and not d.chance(d.odd)
            else _line(d, [d.number() for _ in names])
        )
    return _lines(d, lines)


def npy(d: Draw) -> bytes:
    rows = d.size()
    last, width = d.pick((("3", 3), ("3", 3), ("4, 4", 16), ("16", 16)))
    shape = (
        f"({d.text(str(rows))}, {last})" if d.chance(0.9) else f"({d.numbers(d.below(4), ', ')})"
    )
    descr = (
        d.word("|O", "<c16", "<U4", "<f16")
        if d.chance(0.1)
        else d.word("<f8", "<f4", ">f8", "<i4", "|u1", "<f2")
    )
    keys = {"descr": f"'{descr}'", "fortran_order": d.word("False", "True"), "shape": shape}
    header = ("{" + ", ".join(f"'{d.text(k)}': {v}" for k, v in keys.items()) + "}").encode(
        "utf-8", "surrogatepass"
    )
    if d.chance(d.odd):
        header = d.pick(
            (
                b"(" * 200,
                b"[" * 5000,
                b"-" * 5000,
                b"{1:" * 900,
                b"1" * 9000,
                b"\\",
                b"\xff",
                b"''" * 2000,
            )
        )
    header = header.ljust(d.pick((118, 54, 0))) + b"\n"
    version = d.pick((b"\1\0", b"\1\0", b"\2\0", b"\3\0")) if not d.chance(d.odd) else b"\0\0"
    size = d.pick((0, 1, 2**16 - 1)) if d.chance(d.odd) else min(len(header), 2**16 - 1)
    magic = b"\x93NUMPY" + version + size.to_bytes(2 if version == b"\1\0" else 4, "little")
    return magic + header + d.source.randbytes(min(rows, 40) * width * d.pick((8, 8, 8, 4, 2, 1)))
