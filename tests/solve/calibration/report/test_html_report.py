"""The report of a calibration: one page that needs nothing else, with all that was found and no
name that is code.
"""

from __future__ import annotations

import dataclasses
import re
import sys
import warnings
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

import poekin as pk
from poekin import html_page
from poekin.errors import FileError, MissingExtra, ShapeError
from poekin.groups import se3
from poekin.solve.calibration import (
    CrossValidation,
    Distances,
    Points,
    Poses,
    Residuals,
    calibrate,
)
from poekin.solve.calibration.diagnostics.effects.diagnosis import SavedEvidence
from poekin.solve.calibration.measurements.simulated import simulated
from poekin.solve.calibration.report import changes, html_report, pendant, plots
from poekin.solve.calibration.result import Outlier

pytest.importorskip("matplotlib")

HOSTILE = [
    "<script>alert(1)</script>",
    "a\u202eb\x1b[31m",
    '"><img src=x onerror=alert(1)>',
    "$\\frac{1}{0}$ & $x^$",
]
ARM = pk.Chain.from_space(
    [
        pk.screw.revolute([0, 0, 1], [0, 0, 0]),
        pk.screw.revolute([0, 1, 0], [0.3, 0, 0.5]),
        pk.screw.prismatic([0, 0.6, 0.8]),
        pk.screw.revolute([1, 0, 0], [0.5, 0.1, 0.4]),
    ],
    se3.exp([0.1, -0.2, 0.3, 0.9, 0.1, 0.4]),
    joint_names=HOSTILE,
    base="<b>base</b>",
    tip="${tip}",
)


@pytest.fixture(scope="module")
def found():
    s = simulated(ARM, 60, kind="eye-in-hand", outliers=0.1, seed=3)
    return calibrate(ARM, s.q, s.measurements, loss="tukey", folds=3)


WORDS = {"title": "<i>title</i> $x", "sources": [f"<u>data</u>.csv:{i + 2}" for i in range(60)]}


@pytest.fixture(scope="module")
def text(found):
    return html_report.html(found, **WORDS)


class Tags(HTMLParser):
    """All tags and attributes of a page, and what is left open at its end."""

    VOID = ("meta", "br", "link", "img", "input")

    def __init__(self, text):
        super().__init__()
        self.found, self.attributes, self.open = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.add(tag)
        self.attributes += attrs
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_startendtag(self, tag, attrs):
        self.found.add(tag)
        self.attributes += attrs


def test_the_page_is_well_formed_runs_nothing_and_fetches_nothing(text):
    tags = Tags(text)
    assert tags.open == []
    assert not tags.found & {
        "script",
        "img",
        "link",
        "iframe",
        "object",
        "image",
        "b",
        "i",
        "u",
        "a",
        "foreignobject",
    }
    assert not [name for name, _ in tags.attributes if name.startswith("on")]
    asked = [value for name, value in tags.attributes if name in ("href", "xlink:href", "src")]
    assert all(value.startswith("#") for value in asked)
    assert "@import" not in text
    assert set(re.findall(r"url\((.)", text)) <= {"#"}


def test_names_out_of_files_stand_there_as_text(text):
    for words in (
        "&lt;script&gt;alert(1)",
        "&lt;u&gt;data&lt;/u&gt;.csv:",
        "&lt;i&gt;title&lt;/i&gt; $x",
        "a\\u202eb\\x1b[31m",
    ):
        assert words in text
    assert "\u202e" not in text
    assert "\x1b" not in text


@pytest.fixture
def undrawn(monkeypatch):
    """No picture is drawn, which takes most of a page's time, where only its words are looked at."""
    monkeypatch.setattr(plots.svg, "svg", lambda *_: "<svg></svg>")


def test_without_a_title_a_page_has_that_of_the_arm_from_base_to_tip(found, undrawn, monkeypatch):
    monkeypatch.setattr(html_report.html_page, "page", lambda title, parts, style: title)
    assert html_report.html(found) == "Calibration: <b>base</b> to ${tip}"
    assert html_report.html(found, title="") == ""


def test_the_page_tells_what_was_found(found, text):
    assert changes.sentence(found) in text
    aside = found.cross_validation
    assert aside is not None
    figures = [
        milli(x)[0] for r in (aside.before, aside.after) for x in (r.median_length, r.median_angle)
    ]
    assert changes.sentence(found) == (
        f"On held-out data, the median position error goes from {figures[0]} to {figures[2]} mm, the rotation error "
        f"from {figures[1]} to {figures[3]} mrad."
    )
    alone = changes.sentence(dataclasses.replace(found, cross_validation=None, success=False))
    figures = [
        milli(x)[0] for r in (found.before, found.after) for x in (r.median_length, r.median_angle)
    ]
    assert alone == (
        "The search did NOT converge: this is the best that was found. On the data it was fitted to, the median "
        f"position error goes from {figures[0]} to {figures[2]} mm, the rotation error from {figures[1]} to "
        f"{figures[3]} mrad."
    )
    assert (
        f"{found.identification.n_equations} equations for {found.identification.size} parameters"
        in text
    )
    assert "Unidentifiable from measurements of this kind, fixed: " in text
    assert text.count("<svg") == 7
    assert "T_base_board" in text
    gross = {o.row for o in found.outliers}
    assert gross
    for row in gross:
        assert f"&lt;u&gt;data&lt;/u&gt;.csv:{row + 2}</td>" in text


def test_a_page_of_many_measurements_is_below_1_mb():
    arm = pk.load("panda").chain(tip="panda_link8")
    s = simulated(arm, 5000, outliers=0.3)
    found = calibrate(arm, s.q, s.measurements, loss="huber", folds=0)
    text = html_report.html(found, title="x" * 10**7, sources=["y" * 10**5] * 5000)
    assert len(text.encode()) < 10**6
    assert (
        f"<p>{len(found.outliers)} of 5000 measurements are off by more than one good one" in text
    )
    assert "in 10 000 would be; the first 60 of them:</p>" in text
    assert len(Tables(text).found["Outliers"][0]) == 61
    assert "No data were held out" in text


def test_lengths_alone_and_several_sets_have_a_page_too():
    rng = np.random.default_rng(0)
    q = ARM.random(rng, 80)
    T = ARM.fk(q)
    first, last = np.arange(40), np.arange(40, 80)
    d = np.linalg.norm(T[40:, :3, 3] - [1, 2, 3], axis=1)
    sets = [
        Points(T[:40, :3, 3] + 1e-4 * rng.normal(size=(40, 3)), rows=first),
        Distances(d, rows=last),
    ]
    found = calibrate(ARM, q, sets, on_rank_deficiency="fix")
    text = html_report.html(found)
    assert "rotation error (mrad)" not in text
    aside = found.cross_validation
    assert aside is not None
    assert [row[:4] for row in Tables(text).found["Residuals"][1][1:]] == [
        [f"set {k}, calibrated", *milli(np.sqrt(np.mean(r**2)), np.median(r), r.max())]
        for k, r in enumerate(aside.after.length[aside.after.set == k] for k in (0, 1))
    ]
    assert "centre of measurement set 1" in text
    assert "mrad" not in changes.sentence(found)


def test_exact_data_have_a_page_too():
    """Residuals, steps and uncertainties of rounding, which logarithms and bins have to survive."""
    q = ARM.random(0, 30)
    found = calibrate(ARM, q, ARM.fk(q), folds=0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        html_report.html(found)
        html_report.html(dataclasses.replace(found, covariance=0 * found.covariance, steps=()))


def test_parameters_without_screws_have_a_page_too(undrawn):
    q = ARM.random(0, 30)
    text = html_report.html(calibrate(ARM, q, ARM.fk(q + 1e-3), parameters="offsets", folds=0))
    assert text.count("<svg") == 7


def test_a_search_that_did_not_converge_is_told_first_and_then_warnings_and_remarks(undrawn):
    s = simulated(ARM, 40, tilt=0.02, shift=0.02)
    found = calibrate(ARM, s.q, s.measurements, folds=0, iterations=1)
    assert not found.success
    text = html_report.html(
        dataclasses.replace(found, warnings=("a <b> tool",), remarks=("another base",))
    )
    assert '<p class="lead">The search did NOT converge: this is the best that was found.' in text
    residuals = text.partition("<h2>Residuals</h2>")[2]
    assert residuals.startswith("\n<p>Warning: a &lt;b&gt; tool.</p>\n<p>another base.</p>\n")


def test_the_report_is_that_page_whole_or_not_at_all(found, text, tmp_path, monkeypatch):
    found.report(tmp_path / "page.html", **WORDS)
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == text
    monkeypatch.setattr(plots.svg, "svg", lambda *_: "<svg></svg>")  # of pages that are not written
    with pytest.raises(FileError, match=r"cannot write"):
        found.report(tmp_path / "none" / "page.html")
    with pytest.raises(
        ShapeError, match=r"sources: expected what each of 60 rows of q came from, got 59"
    ):
        found.report(tmp_path / "other.html", sources=["a"] * 59)
    assert [path.name for path in tmp_path.iterdir()] == ["page.html"]


def test_a_report_without_matplotlib_names_the_extra(monkeypatch, found, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtra, match=r"pip install 'poekin\[report\]'"):
        found.report(tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []


class Tables(HTMLParser):
    """The tables of a page, as rows of words, by the heading that they stand under."""

    def __init__(self, text):
        super().__init__()
        self.found, self._title, self._words = {}, "", None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        if tag in ("h2", "td", "th"):
            self._words = ""
        if tag == "table":
            self.found.setdefault(self._title, []).append([])
        if tag == "tr":
            self.found[self._title][-1].append([])

    def handle_data(self, data):
        if self._words is not None:
            self._words += data

    def handle_endtag(self, tag):
        if tag == "h2":
            self._title = self._words
        if tag in ("td", "th"):
            self.found[self._title][-1][-1].append(self._words)
        if tag in ("h2", "td", "th"):
            self._words = None


@pytest.fixture(scope="module")
def tables(text):
    return Tables(text).found


def milli(*values):
    return [f"{1e3 * value:.3g}" for value in values]


def test_numbers_stand_in_columns_of_numbers_and_words_in_columns_of_words(text):
    for table in re.findall(r"<table>.*?</table>", text, re.DOTALL):
        rows = [
            re.findall(r'<t[hd] class="(\w+)">(.*?)</t[hd]>', row)
            for row in table.split("</tr>")[:-1]
        ]
        for column in zip(*rows, strict=True):
            (kind,) = {kind for kind, _ in column}
            cells = [cell for _, cell in column[1:]]
            numbers = all(re.fullmatch(r"(-?\d\S*)?( mm| °)?", cell) for cell in cells)
            assert numbers == (kind == "number"), cells


def test_lengths_of_the_style_have_units_weights_are_those_of_fonts_and_pictures_fit(text):
    style = text.partition("<style>")[2].partition("</style>")[0]
    declared = re.findall(r"([a-z-]+):\s*([^;{}]+)[;}]", style)
    assert len(declared) > 40
    for name, value in declared:
        if name == "font-weight":
            assert value.strip() in ("400", "600", "700")
        elif name != "line-height":
            assert set(re.findall(r"(?<![#\w.])\d+(?![\w.%])", value)) <= {"0"}, (name, value)
    assert "figure svg { max-width: 100%;" in style
    assert '<meta name="viewport" content="width=device-width, initial-scale=1">' in text


def test_a_figure_that_is_far_below_rounding_is_0():
    seen = [changes._seen(x) for x in (0.9e-9, -0.9e-9, 1.1e-9, -1234.5)]
    assert seen == ["0", "0", "1.1e-09", "-1.23e+03"]
    assert [changes._millimetres(x) for x in (None, 0.0125)] == ["", "12.5"]
    assert changes._degrees(np.pi / 6) == "30"


def test_residuals_stand_under_their_names_in_mm_and_mrad(found, tables):
    (table,) = tables["Residuals"]
    heads, *rows = table
    assert heads == [
        "",
        "position rms (mm)",
        "median",
        "largest",
        "rotation rms (mrad)",
        "median",
        "largest",
    ]
    aside = found.cross_validation
    those = [("nominal, held out", aside.before), ("calibrated, held out", aside.after),
             ("nominal, all data", found.before), ("calibrated, all data", found.after)]  # fmt: skip
    assert rows == [
        [
            name,
            *milli(
                r.rms_length,
                r.median_length,
                r.length.max(),
                r.rms_angle,
                r.median_angle,
                r.angle.max(),
            ),
        ]
        for name, r in those
    ]


class Sized(SimpleNamespace):
    """A set of so many measurements."""

    def __len__(self) -> int:
        return self.size


def test_each_point_of_a_set_has_the_mean_of_its_own_residuals():
    few = {"sees_arm": True, "angular": 0}
    sets = [
        Sized(size=2, width=9, what="points", **few),  # three of each
        Sized(size=5, width=1, what="lengths", sees_arm=False, angular=0),
        Sized(size=3, width=3, what="one point", **few),
    ]
    # row by row the points of the first set 1, 2, 3, 1, 2, 3 mm and 1 more in its second measurement
    x = [1, 2, 3, 2, 3, 4, 7, 8, 9]
    e = 1e-3 * np.outer(x, [1.0, 10.0, 0.0])
    residuals = SimpleNamespace(in_axes=lambda axes: SimpleNamespace(after=e))
    evidence = SimpleNamespace(problem=SimpleNamespace(sets=sets))
    page = "".join(html_report._by_point(residuals, evidence))  # pyright: ignore[reportArgumentType]
    rows = re.findall(r"<tr>(.*?)</tr>", page, re.DOTALL)
    cells = [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in rows if "<td" in row]
    means = {1: 1.5, 2: 2.5, 3: 3.5}
    expected = [["0", "points", str(j), *milli(1e-3 * x, 1e-2 * x, 0.0)] for j, x in means.items()]
    expected.append(["2", "one point", "1", *milli(8e-3, 8e-2, 0.0)])
    assert [row[:6] for row in cells] == expected
    sizes = [np.sqrt(101 * np.mean(np.square(own))) for own in ((1, 2), (2, 3), (3, 4), (7, 8, 9))]
    assert [row[6:] for row in cells] == [milli(1e-3 * size) for size in sizes]


def test_what_was_measured_and_what_it_can_tell_stands_there_in_numbers(found, tables, text):
    sets, frames = tables["What was measured, and what it can tell"]
    (spread,) = found.noise_std
    scatter = (
        "as given"
        if spread is None
        else f"{milli(spread.length)[0]} mm, {milli(spread.angle)[0]} mrad"
    )
    assert sets[1:] == [["0", "60", "positions and rotations", scatter]]
    for (name, T), row in zip(found.frames.items(), frames[1:], strict=True):
        turn = ", ".join(f"{w:.5f}" for w in pk.so3.log(T[:3, :3]))
        assert row == [name, *(f"{x:.6f}" for x in T[:3, 3]), turn]
    can = found.identification
    assert (
        f"Measurements of this kind can identify {can.identifiable} combinations of them, and these identify "
        f"{can.rank}, with "
        f"condition {can.condition:.3g} (angles in rad, lengths in reaches of {ARM.reach:.3g} m; smallest singular "
        f"value {can.smallest:.3g}, O1 {can.O1:.3g}, noise amplification index {can.amplification:.3g})."
    ) in text


def test_what_changed_stands_in_the_row_of_its_joint(found, tables, text):
    (compared,) = tables["What changed"]
    assert compared[0] == [
        "joint",
        "angle of the axes (°)",
        "common normal (mm)",
        "at the arm (mm)",
        "zero",
    ]
    mm = lambda x: 1e3 * (x or 0.0)  # noqa: E731
    lines = sorted(
        changes.aligned_joints(found),
        key=lambda j: -max(mm(j.shift), mm(j.normal), np.degrees(j.angle)),
    )
    seen = lambda x: f"{0.0 if abs(x) < 1e-9 else x:.3g}"  # noqa: E731
    shown = lambda x: "" if x is None else seen(1e3 * x)  # noqa: E731
    assert [row[1:] for row in compared[1:]] == [
        [
            seen(np.degrees(j.angle)),
            shown(j.normal),
            shown(j.shift),
            f"{seen(mm(j.zero_offset))} mm"
            if j.kind_b == "prismatic"
            else f"{seen(np.degrees(j.zero_offset))} °",
        ]
        for j in lines
    ]


def test_what_the_residuals_show_is_said_and_all_tests_stand_in_a_table(found, tables, text):
    tests, points = tables["What the residuals show"]
    diagnosis = found.diagnosis
    assert tests[0] == ["residuals against", "chance", "explains (mm)"]
    assert [row[1:] for row in tests[1:]] == [
        [f"{test.p:.2g}", *milli(test.size)] for test in diagnosis.tests
    ]
    e = found.residuals.in_axes("tool").after
    means = milli(*e.mean(axis=0), np.sqrt(np.mean(np.sum(e**2, axis=1))))
    assert points[1:] == [["0", "EyeInHand", "1", *means]]
    said = diagnosis.findings or [diagnosis]
    for words in said:
        assert html_page.text(f"{words}.") in text


def test_frames_stand_there_as_they_are_typed_in_and_held_ones_say_so(found, tables, text):
    said = "held, these measurements do not tell it.</p>"
    assert text.count(said) == 2
    frames = tables["Base and tool, to be typed in"]
    assert len(frames) == 2
    for frame, table in zip(found.tool_and_base[2:], frames, strict=True):
        columns = [pendant.typed(frame, form) for form in pendant.FORMS.values()]
        assert table[0] == [
            "UR (m, rad)",
            "KUKA (mm, deg)",
            "Fanuc (mm, deg)",
            "ROS xyz rpy (m, rad)",
            "ROS xyz xyzw (m)",
        ]
        for k, column in enumerate(columns):
            assert [row[k] for row in table[1 : 1 + len(column)]] == list(map(str, column))


def test_a_calibration_out_of_a_file_says_that_it_has_no_measurements(found, undrawn):
    kept = SavedEvidence(found.evidence.points, found.diagnosis)
    text = html_report.html(dataclasses.replace(found, residuals=None, evidence=kept))
    assert "A calibration out of a file has no measurements to be looked at." in text
    assert f"{len(found.diagnosis.tests)} tests, chances corrected" in text
    assert "which of their numbers are held" not in text
    text = html_report.html(dataclasses.replace(found, residuals=None, evidence=None))
    assert "A calibration out of a file has no measurements to be looked at." in text
    assert "A calibration out of a file does not say which of their numbers are held." in text


def test_an_outlier_is_from_the_source_of_its_row_of_q():
    q = ARM.random(1, 60)
    rows = np.arange(1, 60, 2)
    T = ARM.fk(q[rows])
    T[:, :3, 3] += np.random.default_rng(1).normal(scale=1e-4, size=(30, 3))
    T[4, 0, 3] += 0.01
    poses = Poses(T, covariance=np.diag([1e-8] * 6), rows=rows)
    found = calibrate(ARM, q, poses, parameters=("home",), loss="huber", folds=0)
    assert found.outliers == (Outlier(0, 4, 9),)
    assert "x.csv:9<" in "".join(html_report._outliers(found, [f"x.csv:{k}" for k in range(60)]))


def two_sets(length):
    return Residuals(np.array(length), np.full(3, np.nan), np.array([0, 1, 1]), np.array([0, 1, 2]))


def test_an_outlier_of_a_second_set_has_its_own_error_there(found):
    after = two_sets([1e-3, 2e-3, 7e-3])
    other = dataclasses.replace(found, after=after, outliers=(Outlier(1, 1, 2),))
    assert '<td class="number">7</td>' in "".join(html_report._outliers(other, None))


def test_each_set_has_the_errors_that_the_calibrated_arm_leaves_on_held_out_data(found, undrawn):
    kept = CrossValidation(two_sets([0.1, 0.2, 0.2]), two_sets([0.01, 0.02, 0.02]), 3)
    all_data = {"before": two_sets([0.3] * 3), "after": two_sets([0.4] * 3)}
    other = dataclasses.replace(
        found, **all_data, cross_validation=kept, noise_std=(None, None), terms=()
    )
    page = "".join(html_report._residuals(other))
    for k, rms in enumerate(("10", "20")):
        assert re.search(rf"set {k}, calibrated</td>\s*<td[^>]*>{rms}</td>", page)


def test_outliers_and_parameters_stand_in_rows_with_their_errors_and_sources(found, tables, text):
    (table,) = tables["Outliers"]
    assert table[0] == ["row", "set", "position error (mm)", "rotation error (mrad)", "from"]
    assert table[1:] == [
        [
            str(o.row),
            "0",
            *milli(found.after.length[o.index], found.after.angle[o.index]),
            WORDS["sources"][o.row],
        ]
        for o in found.outliers
    ]
    assert (
        f"<p>{len(found.outliers)} of 60 measurements are off by more than one good one in 10 000 would be.</p>"
        in text
    )
    (table,) = tables["Other parameters"]
    assert table[0] == ["of", "what", "value", "standard deviation", "unit"]
    assert [row[1:] for row in table[1:]] == [
        [p.what, f"{v:.6g}", f"{d:.2g}", p.unit]
        for p, v, d in zip(
            found.parameters, found.values, np.sqrt(np.diag(found.covariance)), strict=True
        )
        if not p.what.startswith(("tilt about (", "shift along ("))
    ]
    assert f"<summary>{len(table) - 1} parameters</summary>" in text
    assert "tilt about" not in text
    assert (
        f"The search with the loss tukey converged in {len(found.steps)} steps, counted over all its rounds."
        in text
    )


def test_how_well_the_pose_is_known_is_said_in_mm_and_mrad(found, text):
    C = found.pose_covariance(ARM.random(0, 1000))
    sizes = [np.sqrt(np.trace(C[:, k, k], axis1=1, axis2=2)) for k in (slice(3, 6), slice(0, 3))]
    mm, mrad = (milli(np.median(x), x.max()) for x in sizes)
    worst = ", ".join(f"{x:.3g}" for x in ARM.random(0, 1000)[np.argmax(sizes[0])])
    assert (
        f"a standard deviation of {mm[0]} mm in the median and {mm[1]} mm at most, at q = ({worst}), its rotation of "
        f"{mrad[0]} and {mrad[1]} mrad"
    ) in text


def test_print_says_before_and_after_of_all_and_of_what_was_kept_aside(found):
    lines = str(found).split("\n")
    at = next(i for i, line in enumerate(lines) if "median mm" in line)
    assert lines[at].split() == ["median", "mm", "rms", "mm", "median", "mrad", "rms", "mrad"]
    aside = found.cross_validation
    assert aside is not None
    for line, name, r in zip(
        lines[at + 1 : at + 5], ("before", "after", "held out (3 folds), before", "held out, after"),
        (found.before, found.after, aside.before, aside.after), strict=True,
    ):  # fmt: skip
        assert line[:29].strip() == name
        assert line[29:].split() == milli(
            r.median_length, r.rms_length, r.median_angle, r.rms_angle
        )
    assert (
        lines[0]
        == f"{len(found.parameters)} parameters, 60 measurements, converged in {len(found.steps)} steps"
    )
    assert f"outliers: rows {', '.join(str(o.row) for o in found.outliers)}" in lines
    for count, more in ((12, ""), (13, " and 1 more")):
        many = dataclasses.replace(found, outliers=tuple(Outlier(0, k, k) for k in range(count)))
        assert f"outliers: rows {', '.join(map(str, range(12)))}{more}" in str(many).split("\n")


def test_repr_leaves_the_long_arrays_out(found):
    said = repr(found)
    assert not re.search(r"array|Step\(|Residuals|Arm|CrossValidation", said)
