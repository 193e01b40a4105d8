"""Every notebook runs from top to bottom without a warning, and is stored as it was run: small, in
order, no paths.
"""

from __future__ import annotations

import re
import runpy
import sys
from pathlib import Path

import nbclient
import nbformat
import pytest
from jupyter_client.kernelspec import KernelSpec, KernelSpecManager
from jupyter_client.manager import AsyncKernelManager
from nbclient.exceptions import CellExecutionError
from traitlets.config import Config

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))
LARGEST = 1_000_000
# What a new machine says once: no fault of a notebook.
ONCE_A_MACHINE = ("poekin: compiling kernels", "Matplotlib is building the font cache")

# Folders where people and build machines keep their files, and temporary ones.
MACHINE_PATH = re.compile(
    r"(?:/(?:home|root|Users|work|tmp|var|opt|mnt)/|[A-Z]:\\\\?(?:Users|Temp)|site-packages)[^\"\\]*"
)


class ThisInterpreter(KernelSpecManager):
    """One kernel: the interpreter that runs the tests, whatever kernels the user has registered."""

    def get_kernel_spec(self, kernel_name: str) -> KernelSpec:
        command = [sys.executable, "-m", "ipykernel_launcher", "-f", "{connection_file}"]
        return KernelSpec(argv=command, display_name=kernel_name, language="python")


def faults_in_a_run(notebook: nbformat.NotebookNode, place: Path) -> list[str]:
    """Run a notebook in a directory: what it writes to stderr. nbclient's CellExecutionError when a
    cell fails.
    """
    manager = AsyncKernelManager(kernel_name="this", kernel_spec_manager=ThisInterpreter())
    client = nbclient.NotebookClient(
        notebook,
        km=manager,
        timeout=300,
        resources={"metadata": {"path": str(place)}},
        store_widget_state=False,
    )
    client.execute(cleanup_kc=True)
    return [
        f"cell {number} wrote to stderr: {output.text}"
        for number, cell in enumerate(notebook.cells, 1)
        for output in cell.get("outputs", ())
        if output.output_type == "stream" and output.name == "stderr"
        if not all(line.startswith(ONCE_A_MACHINE) for line in output.text.splitlines())
    ]


def faults_in_storage(file: Path) -> list[str]:
    """What is wrong with a notebook as it is stored."""
    text = file.read_text(encoding="utf-8")
    faults = [f"{len(text)} bytes, more than {LARGEST}"] if len(text) > LARGEST else []
    faults += [f"a path of one machine: {found[0]}" for found in MACHINE_PATH.finditer(text)]
    cells = [c for c in nbformat.reads(text, as_version=4).cells if c.cell_type == "code"]
    order = [c.execution_count for c in cells]
    if order != list(range(1, len(cells) + 1)):
        faults.append(f"not run from top to bottom in a new kernel: {order}")
    faults += ["a stored error" for c in cells for o in c.outputs if o.output_type == "error"]
    faults += ["a stored warning" for c in cells for o in c.outputs if o.get("name") == "stderr"]
    return faults


@pytest.fixture
def own_folders(tmp_path, monkeypatch):
    """Nothing of the user's Jupyter, IPython or matplotlib is read or written."""
    for name in (
        "JUPYTER_CONFIG_DIR",
        "JUPYTER_DATA_DIR",
        "JUPYTER_RUNTIME_DIR",
        "IPYTHONDIR",
        "MPLCONFIGDIR",
    ):
        folder = tmp_path / name.lower()
        folder.mkdir()
        monkeypatch.setenv(name, str(folder))
    return tmp_path


@pytest.fixture
def checkout(tmp_path):
    """A source tree without the package: where one has installed it from, and opens a notebook."""
    (tmp_path / "checkout" / "notebooks").mkdir(parents=True)
    (tmp_path / "checkout" / "benchmarks").symlink_to(ROOT / "benchmarks", target_is_directory=True)
    return tmp_path / "checkout"


def code(file: Path) -> str:
    """The sources of a notebook's cells of code, with a NUL between them."""
    cells = nbformat.read(file, as_version=4).cells
    return "\0".join(cell.source for cell in cells if cell.cell_type == "code")


@pytest.mark.usefixtures("own_folders")
@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda f: f.name)
def test_a_notebook_runs_without_a_warning_and_leaves_nothing_behind(file, checkout):
    assert faults_in_a_run(nbformat.read(file, as_version=4), checkout / "notebooks") == []
    assert list((checkout / "notebooks").iterdir()) == []


@pytest.mark.usefixtures("own_folders")
def test_benchmarks_are_those_of_the_notebook_s_own_checkout(checkout):
    books = [code(file).split("\0") for file in NOTEBOOKS if "benchmarks" in code(file)]
    cells = [next(source for source in book if "benchmarks" in source) for book in books]
    book = notebook(*(of_benchmarks(cell.partition("from benchmarks")[0]) for cell in cells))
    assert faults_in_a_run(book, checkout / "notebooks") == []
    assert len(cells) >= 4
    for cell in book.cells:
        assert cell.outputs[0].text.startswith(str(checkout))


def of_benchmarks(finding: str) -> str:
    """A cell that says which benchmarks it finds, and leaves the kernel as one that has found none."""
    return "\n".join(
        [
            "import sys",
            "before = sys.path[:]",
            finding,
            "import benchmarks",
            "print(benchmarks.__file__)",
            "sys.path[:] = before",
            "del sys.modules['benchmarks']",
        ]
    )


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda f: f.name)
def test_the_formulas_of_a_page_need_no_network(file):
    config = Config()
    runpy.run_path(str(ROOT / "notebooks" / "pages.py"), {"get_config": lambda: config})
    (mathml,) = config.HTMLExporter.preprocessors
    before = nbformat.read(file, as_version=4)
    after, _ = mathml(nbformat.read(file, as_version=4), {})
    for old, new in zip(before.cells, after.cells, strict=True):
        if old.cell_type == "code":
            assert new == old
        else:
            assert "$" not in re.sub(r"`[^`]*`", "", new.source)
            drawn = new.source.count("<math"), new.source.count("</math>")
            assert drawn == (old.source.replace("$$", "$").count("$") // 2,) * 2
            # docutils writes both digits of frac12 above the line
            assert not re.search(r"\\[dt]?frac(?!\{)", old.source)
    assert config.HTMLExporter.mathjax_url == ""


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda f: f.name)
def test_a_notebook_is_stored_as_it_was_run(file):
    assert faults_in_storage(file) == []


def notebook(*sources: str) -> nbformat.NotebookNode:
    return nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in sources])


@pytest.mark.usefixtures("own_folders")
def test_a_warning_of_a_cell_is_caught_and_the_interpreter_is_this_one(tmp_path):
    book = notebook(
        "import sys\nprint(sys.executable)", "import warnings\nwarnings.warn('old')", "1 + 1"
    )
    (fault,) = faults_in_a_run(book, tmp_path)
    assert fault.startswith("cell 2 wrote to stderr")
    assert "UserWarning: old" in fault
    assert book.cells[0].outputs[0].text.strip() == sys.executable


@pytest.mark.usefixtures("own_folders")
def test_a_failing_cell_is_caught(tmp_path):
    with pytest.raises(CellExecutionError, match="ZeroDivisionError"):
        faults_in_a_run(notebook("1 / 0"), tmp_path)


def stored(tmp_path: Path, count: int | None = 1, **output) -> Path:
    book = notebook("1 + 1")
    book.cells[0].execution_count = count
    if output:
        book.cells[0].outputs = [nbformat.v4.new_output(**output)]
    nbformat.write(book, tmp_path / "book.ipynb")
    return tmp_path / "book.ipynb"


@pytest.mark.parametrize(
    ("planted", "fault"),
    [
        ({"count": None}, "not run from top to bottom in a new kernel: [None]"),
        ({"count": 7}, "not run from top to bottom in a new kernel: [7]"),
        ({"output_type": "stream", "text": "x" * LARGEST}, "bytes, more than"),
        (
            {"output_type": "stream", "text": "/".join(("", "home", "someone", "arm.urdf"))},
            "a path of one machine",
        ),
        ({"output_type": "stream", "text": "lib/site-packages/poekin"}, "a path of one machine"),
        ({"output_type": "stream", "name": "stderr", "text": "UserWarning"}, "a stored warning"),
        ({"output_type": "error", "ename": "E", "evalue": "e", "traceback": []}, "a stored error"),
    ],
)
def test_a_planted_fault_in_storage_is_caught(planted, fault, tmp_path):
    (found,) = faults_in_storage(stored(tmp_path, **planted))
    assert fault in found


def test_a_sound_notebook_is_accepted(tmp_path):
    assert faults_in_storage(stored(tmp_path, output_type="stream", text="2")) == []
