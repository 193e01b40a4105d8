"""Robot kinematics by the product of exponentials, after F. C. Park (1994).

    f(q) = e^{A_1 q_1} e^{A_2 q_2} ... e^{A_n q_n} M

T_ab is the pose of frame b in frame a; twists are (omega; v), the angular part first; rad, m, s.
"""

from typing import TYPE_CHECKING

from . import errors, sweep
from .analysis.axes import axes
from .analysis.compare.compare import compare
from .analysis.counting.count import count
from .analysis.counting.count_table import count_table
from .analysis.dexterity.manipulability import manipulability, manipulability_gradient
from .analysis.dexterity.singularity import singularity
from .analysis.validate import validate
from .errors import PoekinError, PoekinWarning
from .formats import dh, emit, poses, vendors
from .formats.content.robots import from_text
from .formats.load import load
from .formats.objects import from_object
from .formats.relink import relinked
from .formats.urdf_text import to_urdf
from .formats.vendors import ur
from .formats.xacro import xacro
from .groups import se3, so3
from .model import screw
from .model.chain import Chain
from .model.joint import Joint, Mimic, SafetyController
from .model.methods.peer_names import OF_PACKAGE, no_attribute
from .model.robot import Robot
from .model.tree.link_masses import LinkMass
from .progress_line import ProgressLine
from .solve import calibration, motion
from .solve.calibration import calibrate, choose_poses
from .solve.ik.ik import ik
from .solve.ik_all.ik_all import ik_all
from .solve.ik_structure.ik_structure import ik_structure
from .solve.path.follow import follow
from .version import __version__ as __version__
from .view.view import view

__all__ = [
    "Chain",
    "Joint",
    "LinkMass",
    "Mimic",
    "PoekinError",
    "PoekinWarning",
    "ProgressLine",
    "Robot",
    "SafetyController",
    "axes",
    "calibrate",
    "calibration",
    "choose_poses",
    "compare",
    "count",
    "count_table",
    "dh",
    "emit",
    "errors",
    "follow",
    "from_object",
    "from_text",
    "ik",
    "ik_all",
    "ik_structure",
    "load",
    "manipulability",
    "manipulability_gradient",
    "motion",
    "poses",
    "relinked",
    "screw",
    "se3",
    "singularity",
    "so3",
    "sweep",
    "to_urdf",
    "ur",
    "validate",
    "vendors",
    "view",
    "xacro",
]

if not TYPE_CHECKING:  # which would take any name for an attribute

    def __getattr__(name: str) -> object:
        raise no_attribute("poekin", name, OF_PACKAGE, __all__)
