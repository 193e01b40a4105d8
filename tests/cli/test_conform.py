"""`poekin conform`: 0 nothing poor or broken, 1 something is, 2 error."""

from __future__ import annotations

import json
import sys
from types import SimpleNamespace

from poekin.testing import conform

HEAD = """
import numpy as np
from poekin.testing.oracles import exact

def exp(x):
    return exact.rounded(exact.exp(x))  # unlike poekin's own it is not compiled

class Sound:
    so3_exp = staticmethod(exp)

class Faulty:
    twist_order = "angular first"
    exp = staticmethod(exp)
    def so3_exp(self, w):
        return exp(w) if np.linalg.norm(w) > 1e-6 else np.eye(3)

"""


def module(tmp_path, monkeypatch, name, text=HEAD):
    (tmp_path / f"{name}.py").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)


def test_a_sound_subject_is_exact(tmp_path, monkeypatch, poekin):
    module(tmp_path, monkeypatch, "sound_subjects")
    code, out, err = poekin("conform", "sound_subjects:Sound", "--examples", "20")
    assert (code, err) == (0, "")
    assert out.startswith("Sound\nexact      so3_exp: ")
    assert "20 examples, which say little" in out


def test_a_faulty_one_is_1_and_its_counterexample_can_be_pasted(tmp_path, monkeypatch, poekin):
    module(tmp_path, monkeypatch, "faulty_subjects")
    arguments = ("conform", "faulty_subjects:Faulty", "--law", "so3_exp", "--examples", "60")
    code, out, err = poekin(*arguments)
    assert (code, err) == (1, "")
    assert "from faulty_subjects import Faulty; print(np.asarray(Faulty().so3_exp(np.array([" in out
    code, out, _ = poekin(*arguments, "--json")
    assert code == 1
    document = json.loads(out)
    assert (document["subject"], document["conforms"], len(document["laws"])) == (
        "Faulty",
        False,
        1,
    )
    assert document["laws"][0]["grade"] in ("poor", "broken")
    assert sum(x != 0 for x in document["laws"][0]["numbers"]) == 1


def test_options_reach_the_function_and_its_report_the_exit_code(monkeypatch, poekin):
    asked = []

    def told(*words, **options):
        asked.append((*words[:4], options))
        return SimpleNamespace(conforms=len(asked) == 1, to_dict=dict, __str__=lambda: "")

    monkeypatch.setattr(conform, "conform", told)
    monkeypatch.setattr(sys, "path", [place for place in sys.path if place])
    words = [
        "--law",
        "exp",
        "--law",
        "log",
        "--except",
        "so3_exp",
        "--examples",
        7,
        "--seconds",
        2.5,
        "--limit",
        3,
    ]
    assert poekin("conform", "m:A", *words, "--at-most", "poor", "--json")[:2] == (0, "{}\n")
    assert poekin("conform", "m:B", "--json")[0] == 1
    assert (sys.path[0], sys.path.count("")) == ("", 1), "modules of this directory come first"
    grades = {
        "leave_out": ["so3_exp"],
        "at_most": conform.Grade.POOR,
        "limits": conform.Limits(3.0),
    }
    usual = {"leave_out": (), "at_most": conform.Grade.GOOD, "limits": conform.Limits(60.0)}
    assert asked == [("m:A", ["exp", "log"], 7, 2.5, grades), ("m:B", (), None, 600.0, usual)]


def test_only_the_laws_that_are_named_are_run(tmp_path, monkeypatch, poekin):
    module(tmp_path, monkeypatch, "named_subjects")
    code, out, _ = poekin(
        "conform", "named_subjects:Faulty", "--law", "exp", "--examples", "10", "--json"
    )
    assert code == 0
    assert [law["law"] for law in json.loads(out)["laws"]] == ["exp"]


def test_a_law_is_left_out_and_another_bar_is_set(tmp_path, monkeypatch, poekin):
    module(tmp_path, monkeypatch, "barred_subjects")
    arguments = ("conform", "barred_subjects:Faulty", "--examples", "60")
    code, out, _ = poekin(*arguments, "--except", "so3_exp", "--examples", "5", "--json")
    document = json.loads(out)
    assert (code, [law["law"] for law in document["laws"]]) == (0, ["exp"])
    assert "left out, as asked for: so3_exp" in document["notes"]
    code, out, _ = poekin(*arguments, "--law", "so3_exp", "--at-most", "poor")
    assert (code, out.split()[1]) == (0, "poor")
    assert "Faulty().so3_exp" in out


def test_what_cannot_be_used_is_refused(tmp_path, monkeypatch, refused):
    module(tmp_path, monkeypatch, "refused_subjects")
    assert "there is no law 'so3'" in refused("conform", "refused_subjects:Sound", "--law", "so3")
    assert "expected MODULE:CLASS" in refused("conform", "refused_subjects")
    assert "has no 'Other'" in refused("conform", "refused_subjects:Other")
    (tmp_path / "broken_subjects.py").write_text(
        "raise RuntimeError('\\x1b[31mred')", encoding="utf-8"
    )
    assert "RuntimeError: \\x1b[31mred" in refused("conform", "broken_subjects:X")
    (tmp_path / "ending_subjects.py").write_text("raise SystemExit(4)", encoding="utf-8")
    assert "cannot be imported: SystemExit: 4" in refused("conform", "ending_subjects:X")
    assert "--seconds" in refused("conform", "refused_subjects:Sound", "--seconds", "0")
