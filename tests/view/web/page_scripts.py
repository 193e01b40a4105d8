"""The page's own JavaScript files, run by Node."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np

import poekin as pk
from poekin.formats import emit
from tests.nodejs import run_by_node

WEB = Path(pk.__file__).parent / "view" / "web"
HEAD = """
import { readFileSync } from "node:fs";
import * as page from "./mathematics.js";
const given = JSON.parse(readFileSync("given.json", "utf8"));
const print = (x) => console.log(JSON.stringify(x, (_, y) => ArrayBuffer.isView(y) ? [...y] : y));
"""


def run(folder: Path, script: str, given: Any) -> Any:
    """What a script prints, as JSON, that has `page`, the functions of mathematics.js, and `given`."""
    shutil.copytree(WEB, folder, dirs_exist_ok=True)
    (folder / "package.json").write_text('{"type": "module"}')
    (folder / "given.json").write_text(
        json.dumps(given, default=np.ndarray.tolist, allow_nan=False)
    )
    (folder / "run.js").write_text(HEAD + script)
    return json.loads(run_by_node(folder, "run.js"))


def sliders(chain: pk.Chain) -> list[dict[str, Any]]:
    """Coordinates of a chain as a scene has them."""
    return [
        {
            "unit": "rad" if chain.is_angle(k) else "m",
            "lower": lower if np.isfinite(lower) else None,
            "upper": upper if np.isfinite(upper) else None,
        }
        for k, (lower, upper) in enumerate(chain.limits.tolist())
    ]


def write_kinematics(chain: pk.Chain, file: Path) -> None:
    """The module of a chain: fk_jacobian_hybrid(q) gives {T, J}."""
    file.write_text(emit.javascript(chain, "hybrid"), encoding="ascii")
