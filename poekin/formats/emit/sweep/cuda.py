"""Kinematics and sweeps of an arm as CUDA: batches of poses and Jacobians, and maps of a workspace."""

from __future__ import annotations

from typing import Literal, get_args

from ....checks import REQUIRED, choice
from ....engine.kernels.sweep import samples
from ....engine.straight_line.specialise import measured_program
from ....errors import InputError
from ....model.kinematics.arm import Arm
from ....model.kinematics.compiled import CompiledChain
from ....model.kinematics.pose_jacobian import AnyFrame
from ..assignments import comment
from ..c import KINDS, CFunction, Real
from ..messages import (
    EmittedFunction,
    compile_checked,
    header_lines,
    identifier,
    made_by,
    make_tasks,
)
from . import cuda_text
from .device_code import DeviceCode, device_code

Precision = Literal["float64", "float32"]
Measure = Literal["reach", "manipulability"]
_REALS: dict[Precision, Real] = {"float64": "double", "float32": "float"}
_BITS = {
    "double": ("unsigned long long", "__longlong_as_double", "__double_as_longlong"),
    "float": ("unsigned int", "__uint_as_float", "__float_as_uint"),
}
"""Whole numbers of the size of a real, and the functions to and from it."""
_LINKAGE = "static __device__ inline "


def cuda(
    chain: Arm,
    frame: AnyFrame = REQUIRED,
    *,
    name: str = "arm",
    precision: Precision = "float64",
    measure: Measure = "reach",
    origin: str = "",
) -> str:
    """CUDA of a chain: poses and Jacobians of many configurations, and the sweep of its workspace.

    Parameters
    ----------
    chain : Chain or CompiledChain
        Chain to write, with one coordinate at least.
    frame : {"space", "body", "hybrid", "cheapest"} or int
        Frame of the Jacobian, or the index of a joint, as in `CompiledChain.jacobian`.
    name : str, default "arm"
        Name with which those of the kernels begin; only a-z, 0-9 and _ are kept.
    precision : {"float64", "float32"}, default "float64"
        Precision of the numbers.
    measure : {"reach", "manipulability"}, default "reach"
        Whether the sweep only counts, or keeps the best manipulability of each cell too.
    origin : str, default ""
        Words for the head of the text on where the arm is from: a file and its SHA-256, say.

    Returns
    -------
    text : str
        ASCII, a file that needs nothing but CUDA: kernels NAME_fk_batch, NAME_jacobian_FRAME_batch
        and NAME_fk_jacobian_FRAME_batch, NAME_sweep, and NAME_attained with the manipulability.
        The head says what their arguments are.

    Raises
    ------
    InputError
        If `chain` is no Chain or has no coordinate, an option is unknown, `name` or `origin` is no
        text, or the arm needs a number that the precision cannot hold.

    Notes
    -----
    Samples, cells, sines and cosines are the functions that `poekin.sweep` compiles, transpiled. In
    float64, without fused multiplication, counts are those of `poekin.sweep.run` to the last one
    (tests/formats/emit_sweep/test_cuda.py, on the CPU; it was not run on a GPU). In float32
    coordinates are rounded: a pose is within `Chain.fk`'s bound with 2^-24 for 2^-53. Source: Park
    1994, Section IV; Steele, Lea and Flood 2014; Górski et al. 2005.

    Examples
    --------
    >>> import poekin as pk
    >>> arm = pk.load("panda").chain(tip="panda_hand")
    >>> text = pk.emit.cuda(arm, "hybrid", name="panda", precision="float32")
    >>> 'extern "C" __global__ void panda_fk_batch(long long count, const float *q, float *T)' in text
    True
    """
    choice(precision, get_args(Precision), "precision")
    choice(measure, get_args(Measure), "measure")
    word = identifier(name)
    arm = compile_checked(chain, frame)
    if not arm.dof:
        raise InputError(f"emit: expected an arm with a coordinate, {arm.chain!r} has none")
    real = _REALS[precision]
    code = device_code(word, real, arm.dof)
    tasks = list(make_tasks(arm, frame))
    pose = tasks[0]
    if measure == "manipulability":
        pose = EmittedFunction("measured", 1, True, measured_program(arm.structure))
        tasks.append(pose)
    functions = [
        CFunction(word, real, KINDS[real][0], task, arm.dof, _LINKAGE, code.sines) for task in tasks
    ]
    said = [f"{word}_{task.cost}" for task in tasks]
    parts = [
        _head(arm, frame, word, real, measure, origin, said),
        code.text,
        *(function.text() for function in functions),
        cuda_text.THREADS.format(word=word),
        *(_batch(word, function) for function in functions[:3]),
        _sweep(word, real, code, pose, arm.dof),
    ]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _head(
    arm: CompiledChain,
    frame: AnyFrame,
    word: str,
    real: str,
    measure: str,
    origin: str,
    said: list[str],
) -> str:
    is_measured = measure != "reach"
    use = cuda_text.USE + cuda_text.BEST * is_measured
    which = frame if isinstance(frame, str) else f"joint{int(frame)}"
    use = use.format(word=word, frame=which, best=", best" * is_measured)
    use += {"double": cuda_text.EXACT, "float": cuda_text.ROUNDED}[real]
    return comment(
        [
            f"{word}: the kinematics of one serial arm as CUDA, in {real}. Generated: change the arm instead.",
            *made_by(origin),
            "",
            *said,
            "",
            *header_lines(arm, frame),
            *use.splitlines(),
        ]
    )


def _batch(word: str, function: CFunction) -> str:
    """The kernel of many configurations."""
    task = function.task
    return cuda_text.BATCH.format(
        word=word,
        function=function.name,
        real=function.real,
        dof=function.dof,
        parameters="".join(f", {function.real} *{result}" for result in task.results),
        results="".join(f", {result} + {task.sizes[result]} * k" for result in task.results),
    )


def _sweep(word: str, real: Real, code: DeviceCode, pose: EmittedFunction, dof: int) -> str:
    """The kernels of a sweep."""
    bits, to_real, to_bits = _BITS[real]
    results = "T"
    parameter = ""
    rooted = ""
    template = cuda_text.SAMPLE + cuda_text.COUNT
    if pose.jacobian:
        results = "T, measure"
        parameter = f",\n    {real} *measure"
        rooted = f"\n    *measure = {code.names['root']}(*measure);"
        template = cuda_text.SAMPLE + cuda_text.MEASURE
    return template.format(
        word=word,
        real=real,
        dof=dof,
        KIND=samples.KIND,
        GRID=samples.GRID,
        RANDOM=samples.RANDOM,
        SEED=samples.SEED,
        COUNTS=samples.COUNTS,
        rooted=rooted,
        **code.names,
        measure=parameter,
        pose=f"{word}_{pose.name}(q, {results})",
        arguments=cuda_text.ARGUMENTS.format(real=real),
        bits=bits,
        to_real=to_real,
        to_bits=to_bits,
    )
