"""Calibration as plain data, for JSON: everything but the numbers of each measurement."""

from __future__ import annotations

from ....results import plain
from ..model.residuals import Residuals, largest, median
from ..result import CalibrationData


def document(found: CalibrationData) -> dict[str, object]:
    """Dict of a calibration; see `Calibration.to_dict`."""
    held_out = found.cross_validation
    data: dict[str, object] = {
        "base": found.chain.base,
        "tip": found.chain.tip,
        "success": found.success,
        "measurements": len(found.after),
        "steps": len(found.steps),
        "loss": found.loss,
        "identification": found.identification,
        "cross_validation": None,
        "before": _statistics(found.before),
        "after": _statistics(found.after),
        "parameters": parameters(found),
        "frames": found.frames,
        "noise_std": found.noise_std,
        "outliers": found.outliers,
        "terms": found.terms,
        "workspace": _workspace(found),
        "diagnosis": found.diagnosis,
        "tool_and_base": found.tool_and_base,
        "verdict": found.verdict,
        "warnings": found.warnings,
        "remarks": found.remarks,
    }
    if held_out is not None:
        data["cross_validation"] = {
            "folds": held_out.folds,
            "before": _statistics(held_out.before),
            "after": _statistics(held_out.after),
        }
    return {name: plain(value) for name, value in data.items()}


def parameters(found: CalibrationData) -> list[dict[str, object]]:
    """Owner, what, unit, value and deviation of each parameter."""
    columns = (found.values.tolist(), found.deviations.tolist())
    rows = zip(found.parameters, *columns, strict=True)
    return [p._asdict() | {"value": value, "deviation": s} for p, value, s in rows]


def _workspace(found: CalibrationData) -> dict[str, object]:
    """Standard deviations of the tool's pose over the workspace: median and worst."""
    known = found.workspace()
    return {
        "median_length": median(known.length),
        "median_angle": median(known.angle),
        "worst_length": largest(known.length),
        "worst_q": known.worst,
    }


def _statistics(r: Residuals) -> dict[str, float]:
    return {name: getattr(r, name) for name in r.derived}
