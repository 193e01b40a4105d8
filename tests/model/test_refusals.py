"""What a model does not take is refused in whole sentences: where, what was expected, and what
arrived.
"""

# pyright: reportArgumentType=false

from __future__ import annotations

import numpy as np
import pytest

import poekin as pk
import poekin.model.tree.chain_between as between
from poekin.errors import InputError, ModelError, PoseError, ScrewError, ShapeError, UnknownName
from poekin.model import checks, screw
from poekin.model.joint import Joint, Mimic
from poekin.model.provenance import Source
from poekin.model.robot import Robot
from tests.messages import says

TURN, SLIDE = screw.revolute([0, 0, 1], [1, 0, 0]), screw.prismatic([1, 0, 0])
ARM = pk.Chain.from_space([TURN, SLIDE], np.eye(4), joint_names=["pan", "slide"])
ALONE = pk.Chain.from_space([], np.eye(4))
Q, NAN = np.zeros(2), float("nan")
T, J = np.empty((4, 4)), np.empty((6, 2))
FRAMES = "frame: expected 'space', 'body', 'hybrid' or the index of a joint"
SLOW, WRITTEN = np.empty((4, 4), order="F"), "expected a C-contiguous, writable, aligned array"

OF_CALLS = {
    "q": (lambda: ARM.fk([1, 2, 3]), ShapeError,
          "q: expected 2 coordinates on the last axis ('pan', 'slide'), got shape (3,)"),
    "q without names": (lambda: ALONE.fk([1.0]), ShapeError,
                        "q: expected 0 coordinates on the last axis (none), got shape (1,)"),
    "a label": (lambda: ARM.fk({"pan": 0, "slid": 1}), UnknownName,
                "q: no coordinate 'slid'; did you mean 'slide'?"),
    "a value": (lambda: ARM.velocity(Q, {"slide": 1}, "body"), InputError, "dq: no value for 'pan'"),
    "a named value": (lambda: ARM.fk({"pan": "x", "slide": 1}), InputError,
                      "q['pan']: expected real numbers, got text (str)"),
    "values": (lambda: ARM.fk({"pan": [0, 1], "slide": [0, 1, 2]}), ShapeError,
               "q: the values' shapes do not broadcast: (2,), (3,)"),
    "dq": (lambda: ARM.velocity(np.zeros((3, 2)), np.zeros((4, 2)), "body"), ShapeError,
           "q, dq do not broadcast: shapes (3, 2), (4, 2)"),
    "dq of a rate": (lambda: ARM.jacobian_rate(np.zeros((3, 2)), np.zeros((4, 2)), "body"), ShapeError,
                     "q, dq do not broadcast: shapes (3, 2), (4, 2)"),
    "q0": (lambda: ARM.rezeroed([0, NAN]), InputError, "q0: expected one finite configuration (2,), got [0.0, nan]"),
    "q0s": (lambda: ARM.rezeroed([[0, 1]]), InputError, "q0: expected one finite configuration (2,), got [[0.0, 1.0]]"),
    "a frame's name": (lambda: ARM.jacobian(Q, "tool"), InputError, f"{FRAMES}, got 'tool'"),
    "a joint's index": (lambda: ARM.jacobian(Q, 2), InputError, f"{FRAMES}, 0 to 1, got 2"),
    "no joint's index": (lambda: ALONE.jacobian([], 0), InputError,
                         "frame: expected 'space', 'body' or 'hybrid' (the chain has no joint), got 0"),
    "a derivative's frame": (lambda: ARM.hessian(Q, 0), InputError,
                             "frame: expected 'space', 'body' or 'hybrid', got 0"),
    "wrt": (lambda: ARM.screw_derivatives(Q, "eta"), InputError, "wrt: expected 'twist' or 'components', got 'eta'"),
    "at": (lambda: ARM.jacobian(Q, "body", at=[0, NAN, 1]), InputError,
           "at: expected one finite point (3,), got [0, nan, 1]"),
    "at in space": (lambda: ARM.jacobian(Q, 1, at=[0, 0, 1]), InputError,
                    "at: a point of the tool matters in the frames 'body' and 'hybrid' only, got frame 1"),
    "out": (lambda: ARM.fk(Q, out=np.empty((4, 3))), ShapeError,
            "out: expected a float64 array of shape (4, 4), got float64 (4, 3)"),
    "out of another type": (lambda: ARM.fk(Q, out=[[0.0] * 4] * 4), ShapeError,
                            "out: expected a float64 array of shape (4, 4), got list"),
    "out of halves": (lambda: ARM.fk(Q, out=np.empty((4, 4), np.float16)), ShapeError,
                      "out: expected a float64 array of shape (4, 4), got float16 (4, 4)"),
    "out of long doubles": (lambda: ARM.fk(Q, out=np.empty((4, 4), complex)), ShapeError,
                            "out: expected a float64 array of shape (4, 4), got complex128 (4, 4)"),
    "out in columns": (lambda: ARM.fk(Q, out=SLOW), InputError, f"out: {WRITTEN}"),
    "out of many": (lambda: ARM.jacobian(np.zeros((3, 2)), "body", out=np.empty((3, 6, 3))), ShapeError,
                    "out: expected a float64 array of shape (3, 6, 2), got float64 (3, 6, 3)"),
    "the first out": (lambda: ARM.fk_jacobian(Q, "body", out=(SLOW, J)), InputError, f"out[0]: {WRITTEN}"),
    "the second out": (lambda: ARM.fk_jacobian(Q, "body", out=(T, T)), ShapeError,
                       "out[1]: expected a float64 array of shape (6, 2), got float64 (4, 4)"),
    "three outs": (lambda: ARM.fk_jacobian(Q, "body", out=(T, J, J)), InputError,
                   "out: expected a pair of arrays (T, J), got tuple"),
    "a single out": (lambda: ARM.fk_jacobian(Q, "body", out=(T,)), InputError,
                     "out: expected a pair of arrays (T, J), got tuple"),
    "a larger out": (lambda: ARM.fk(Q, out=np.empty((5, 4))), ShapeError,
                     "out: expected a float64 array of shape (4, 4), got float64 (5, 4)"),
    "one out": (lambda: ARM.fk_jacobian(Q, "body", out=T), InputError,
                "out: expected a pair of arrays (T, J), got ndarray"),
    "out and q": (lambda: ARM.fk(T[0, :2], out=T), InputError,
                  "out: it shares memory with q, which would be overwritten while it is read"),
    "T and J": (lambda: (lambda M: ARM.fk_jacobian(Q, "body", out=(M[:16].reshape(4, 4), M[12:24].reshape(6, 2))))(
        np.empty(24)), InputError, "out: T and J share memory"),
    "kind": (lambda: ARM.pose_coordinates(Q, "euler"), InputError,
             "kind: expected 'rotation_vector', 'quaternion_wxyz' or 'rpy', got 'euler'"),
    "to_hp": (lambda: ARM.to_hp(), InputError, "to_hp: expected revolute joints only, 'slide' is prismatic"),
    "to_hp, coupled": (lambda: chain(TURN, TURN, coupling=[[1], [2]], base="b", tip="t").to_hp(), InputError,
                       "to_hp: expected one coordinate a joint, the 2 joints of 'b' -> 't' are coupled to "
                       "1 coordinates"),
    "the middle": (lambda: ALONE.compile().cheapest, InputError, "frame 'cheapest': the chain has no joint"),
}  # fmt: skip


def chain(*screws, home=None, **options):
    return pk.Chain.from_space(
        screws or [TURN, SLIDE], np.eye(4) if home is None else home, **options
    )


def pose(*places):
    M = np.eye(4)
    for (i, k), value in places:
        M[i, k] = value
    return M


OF_DATA = {
    "offset": ({"offset": [1.0]}, ShapeError, "offset: expected shape (2,), one number a joint, got (1,)"),
    "a long offset": ({"offset": [1, 2, 3]}, ShapeError, "offset: expected shape (2,), one number a joint, got (3,)"),
    "an offset": ({"offset": [0, NAN]}, InputError, "offset[1]: expected a finite number, got nan"),
    "limits": ({"limits": [[0, 1]]}, ShapeError,
               "limits: expected shape (2, 2), lower and upper of each coordinate, got (1, 2)"),
    "more limits": ({"limits": [[0, 1]] * 3}, ShapeError,
                    "limits: expected shape (2, 2), lower and upper of each coordinate, got (3, 2)"),
    "crossed limits": ({"limits": [[0, 1], [3, 2]]}, InputError,
                       "limits: expected lower <= upper for 'q2', got 3.0 and 2.0"),
    "limits at no number": ({"limits": [[0, 1], [np.inf, np.inf]]}, InputError,
                            "limits: expected lower <= upper for 'q2', got inf and inf"),
    "limits below all": ({"limits": [[-np.inf, -np.inf], [0, 1]]}, InputError,
                         "limits: expected lower <= upper for 'q1', got -inf and -inf"),
    "joint limits": ({"joint_limits": [[0, 1]]}, ShapeError,
                     "joint_limits: expected shape (2, 2), lower and upper of each joint, got (1, 2)"),
    "joint speeds": ({"joint_velocity_limits": [1]}, ShapeError,
                     "joint_velocity_limits: expected shape (2,), one of each joint, got (1,)"),
    "crossed joint limits": ({"joint_limits": [[0, 1], [3, 2]]}, InputError,
                             "joint_limits: expected lower <= upper for 'joint2', got 3.0 and 2.0"),
    "coupling": ({"coupling": [[1.0]]}, ShapeError, "coupling: expected shape (2, m), one row a joint, got (1, 1)"),
    "a long coupling": ({"coupling": np.eye(3)}, ShapeError,
                        "coupling: expected shape (2, m), one row a joint, got (3, 3)"),
    "couplings": ({"coupling": np.ones((2, 1, 1))}, ShapeError,
                  "coupling: expected shape (2, m), one row a joint, got (2, 1, 1)"),
    "a flat coupling": ({"coupling": [1.0, 2.0]}, ShapeError,
                        "coupling: expected shape (2, m), one row a joint, got (2,)"),
    "an entry": ({"coupling": [[1, 0], [0, np.inf]]}, InputError, "coupling[1, 1]: expected a finite number, got inf"),
    "names": ({"joint_names": ["a"]}, ShapeError, "joint_names: expected 2 names, got 1: 'a'"),
    "more names": ({"joint_names": ["a", "b", "c"]}, ShapeError,
                   "joint_names: expected 2 names, got 3: 'a', 'b', 'c'"),
    "no names": ({"joint_names": []}, ShapeError, "joint_names: expected 2 names, got 0: none"),
    "a name": ({"joint_names": ["a", ""]}, InputError,
               "joint_names[1]: expected a name, a string that is not empty, got ''"),
    "a name twice": ({"joint_names": ["a", "a"]}, InputError, "joint_names: 'a' appears more than once"),
    "names in one text": ({"q_names": "ab"}, InputError, "q_names: expected a list of names, got 'ab'"),
    "base": ({"base": ""}, InputError, "base: expected a name, a string that is not empty, got ''"),
    "tip": ({"tip": 5}, InputError, "tip: expected a name, a string that is not empty, got 5"),
    "pitches": ({"pitches": [0.0]}, ShapeError, "pitches: expected shape (2,), one number a joint, got (1,)"),
    "more pitches": ({"pitches": [0.0] * 3}, ShapeError,
                     "pitches: expected shape (2,), one number a joint, got (3,)"),
    "a long pitch": ({"pitches": [-2e100, 0]}, ScrewError,
                     "pitches[0]: expected at most 1e+100 m per rad, got -2e+100"),
    "a slide's pitch": ({"pitches": [0, 0.5], "joint_names": ["a", "b"]}, ScrewError,
                        "pitches[1] (joint 'b'): expected 0 for a prismatic joint, which has no pitch, got 0.5"),
    "homes": ({"home": np.eye(4)[None]}, ShapeError, "home: expected one pose (4, 4), got shape (1, 4, 4)"),
    "a home without end": ({"home": pose(((1, 3), np.inf))}, PoseError,
                           "home: expected finite numbers, row 1 is [0.0, 1.0, 0.0, inf]"),
    "a far home": ({"home": pose(((2, 3), -2e100))}, InputError,
                   "home: expected lengths of at most 1e+100 m, got -2e+100 in row 2"),
}  # fmt: skip

OF_SCREWS = {
    "rows": ([[0, 0, 1]], {}, ShapeError, "screws: expected shape (n, 6), one row (omega; v) a joint, got (1, 3)"),
    "long rows": ([[0, 0, 1, 0, 0, 0, 0]], {}, ShapeError,
                  "screws: expected shape (n, 6), one row (omega; v) a joint, got (1, 7)"),
    "rows of rows": ([[TURN]], {}, ShapeError,
                     "screws: expected shape (n, 6), one row (omega; v) a joint, got (1, 1, 6)"),
    "one row": (TURN, {}, ShapeError, "screws: expected shape (n, 6), one row (omega; v) a joint, got (6,)"),
    "omega": ([[0, 0, 2, 0, 0, 0]], {"joint_names": ["a"]}, ScrewError,
              "screws[0] (joint 'a'): omega must have length 1 to 1e-09, got 2 in [0.0, 0.0, 2.0, 0.0, 0.0, 0.0]"),
    "v": ([TURN, [0, 0, 0, 0, 0.5, 0]], {}, ScrewError,
          "screws[1]: v, where omega = 0, must have length 1 to 1e-09, got 0.5 in [0.0, 0.0, 0.0, 0.0, 0.5, 0.0]"),
    "far": ([[0, 0, 1, 2e100, 0, 0]], {}, ScrewError,
            "screws[0]: expected finite numbers of at most 1e+100, got [0.0, 0.0, 1.0, 2e+100, 0.0, 0.0]"),
}  # fmt: skip

OF_PARTS = {
    "axis": (lambda: screw.prismatic([0, NAN, 1]), InputError,
             "axis: expected one finite vector (3,), got [0.0, nan, 1.0]"),
    "axes": (lambda: screw.prismatic([[0, 0, 1]]), InputError,
             "axis: expected one finite vector (3,), got [[0.0, 0.0, 1.0]]"),
    "no axis": (lambda: screw.prismatic([0, 0, 0]), ScrewError, "axis: expected a direction, got the zero vector"),
    "a pitch": (lambda: screw.helical([0, 0, 1], [1, 2, 3], np.inf), InputError,
                "expected a finite point (3,) and pitch, got point [1.0, 2.0, 3.0] and pitch inf"),
    "a number": (lambda: checks.finite(NAN, "gain"), InputError, "gain: expected a finite number, got nan"),
}  # fmt: skip


def robot(*joints, source=None):
    links = ["a", *(joint.child for joint in joints)]
    return Robot("r", links, joints, source)


def hung(name, parent, child, kind="revolute", **fields):
    return Joint(name, kind, parent, child, **fields)


BRANCHED = robot(hung("left", "a", "b"), hung("right", "a", "c"))
FLOATING = robot(
    hung("free", "a", "b", "floating"), hung("j", "b", "c"), source=Source("f.urdf", (), (7, 9))
)
OF_ROBOTS = {
    "source": (lambda: Robot("r", ["a"], [], 5), "robot 'r': source must be a Source, a text or None, got 5"),
    "joint": (lambda: BRANCHED.joint("lefd"), "robot 'r': no joint 'lefd'; did you mean 'left'?"),
    "tip": (lambda: BRANCHED.chain(), "robot 'r': tip must be given, there are several leaves: 'b', 'c'"),
    "a link": (lambda: BRANCHED.chain(tip="d"), "robot 'r': no tip link 'd'; available: 'a', 'b', 'c'"),
    "a base": (lambda: BRANCHED.chain("d", "a"), "robot 'r': no base link 'd'; available: 'a', 'b', 'c'"),
    "a way": (lambda: FLOATING.chain(), "f.urdf:7: the way from 'a' to 'c' crosses the floating joint 'free'; a chain "
              "cannot"),
    "q": (lambda: FLOATING.fk([]), "robot 'r': expected 1 coordinates on the last axis ('j'), got shape (0,)"),
    "poses": (lambda: FLOATING.fk([0], 5), "f.urdf: poses must be a dict from joint to pose (..., 4, 4), got 5"),
    "a pose's name": (lambda: FLOATING.fk([0], {"j": np.eye(4)}),
                      "f.urdf: poses names 'j', which is no floating or planar joint; available: 'free'"),
    "a pose": (lambda: FLOATING.fk([0], {"free": np.eye(3)}), "pose of joint 'free': expected shape (..., 4, 4), got "
               "(3, 3): pk.se3.pose(R, p) makes a pose of a rotation and a translation"),
    "batches": (lambda: FLOATING.fk([[0], [0]], {"free": [np.eye(4)] * 3}),
                "f.urdf: the leading axes of q and poses do not broadcast: the pose of joint 'free' has (3,), and what "
                "comes before it (2,)"),
}  # fmt: skip


@pytest.mark.parametrize("call, error, message", [*OF_CALLS.values(), *OF_PARTS.values()],
                         ids=[*OF_CALLS, *OF_PARTS])  # fmt: skip
def test_what_a_call_does_not_take_is_said_whole(call, error, message):
    with pytest.raises(error) as caught:
        call()
    assert says(caught.value, message)


@pytest.mark.parametrize("options, error, message", OF_DATA.values(), ids=OF_DATA)
def test_what_is_no_part_of_a_chain_is_said_whole(options, error, message):
    if "joint_names" not in options and "coupling" not in options:
        options = {"q_names": ["q1", "q2"], **options}
    with pytest.raises(error) as caught:
        chain(**options)
    assert says(caught.value, message)


@pytest.mark.parametrize("screws, options, error, message", OF_SCREWS.values(), ids=OF_SCREWS)
def test_what_is_no_screw_is_said_whole(screws, options, error, message):
    with pytest.raises(error) as caught:
        pk.Chain.from_space(screws, np.eye(4), **options)
    assert says(caught.value, message)


@pytest.mark.parametrize("call, message", OF_ROBOTS.values(), ids=OF_ROBOTS)
def test_what_a_robot_does_not_have_is_said_whole(call, message):
    with pytest.raises(pk.PoekinError) as caught:
        call()
    assert says(caught.value, message)


@pytest.mark.parametrize("followers, more", [(1, ""), (2, " (nor do those of 1 more coordinates)")])
def test_limits_that_contradict_each_other_are_warned_of_whole(followers, more):
    joints, link = [], "a"
    for k in range(followers):
        for name, limits, mimic in ((f"j{k}", (-1, 1), None), (f"f{k}", (5, 6), Mimic(f"j{k}"))):
            joints.append(hung(name, link, name + "_", limits=limits, mimic=mimic))
            link = name + "_"
    with pytest.warns(pk.PoekinWarning) as caught:
        robot(*joints, source="x.urdf")
    (warning,) = caught
    assert str(warning.message) == (
        f"x.urdf: the limits of the joints that follow 'j0' have no interval in common{more}: its own limits"
        " [-1.0, 1.0] stand"
    )


@pytest.mark.parametrize(
    "q, where", [([0, np.pi / 2, 0], "q"), ([[0, 0, 0], [0, np.pi / 2, 0]], "q[1]")]
)
def test_a_gimbal_s_lock_is_said_with_its_place_and_pitch(q, where):
    wrist = pk.Chain.from_space(
        [screw.revolute(z, [0, 0, 0]) for z in ([0, 0, 1], [0, 1, 0], [1, 0, 0])], np.eye(4)
    )
    cosine = np.hypot(*wrist.fk(q)[..., :2, 0].reshape(-1, 2)[-1])
    with pytest.raises(InputError) as caught:
        wrist.analytic_jacobian(q, "rpy")
    assert says(
        caught.value,
        f"{where}: roll and yaw have no rates at pitch ±90°; here pitch = 90°, cos(pitch) = {cosine:.3g}, and at "
        "least 1e-08 is needed; 'rotation_vector' and 'quaternion_wxyz' have no such place",
    )


def test_what_is_shown_of_models_names_their_parts():
    limits = {"base": "floor", "tip": "hand"}
    assert (
        repr(chain(**limits))
        == "<Chain 'floor' -> 'hand': 1 revolute, 1 prismatic joints, reach 3 m>"
    )
    assert repr(chain(TURN, TURN, coupling=[[1], [2]])) == (
        "<Chain 'base' -> 'tool': 2 revolute joints, 1 coordinate, reach 2 m>"
    )
    assert (
        repr(chain(TURN, coupling=[[1, 2]]))
        == "<Chain 'base' -> 'tool': 1 revolute joint, 2 coordinates, reach 2 m>"
    )
    assert repr(ALONE) == "<Chain 'base' -> 'tool': no joints, reach 1 m>"
    assert repr(ALONE.compile()) == f"<CompiledChain of {ALONE!r}>"
    assert repr(ALONE.compile(parallel=True)) == f"<CompiledChain of {ALONE!r}, parallel>"
    assert repr(BRANCHED) == "Robot('r': 3 links, 2 joints, dof 2, root 'a', 2 leaves: 'b', 'c')"
    assert (
        repr(Robot("r", ["a"], [])) == "Robot('r': 1 links, 0 joints, dof 0, root 'a', 1 leaf: 'a')"
    )
    three = Robot("r", ["a", "b", "c", "d"], [hung(x, "a", x) for x in "bcd"])
    assert repr(three).endswith("3 leaves: 'b', 'c', 'd')")
    many = Robot("r", ["a", "b", "c", "d", "e"], [hung(x, "a", x) for x in "bcde"])
    assert repr(many).endswith("4 leaves: 'b', 'c', 'd', ...)")
    assert (
        repr(hung("j", "a", "b", mimic=Mimic("k"))) == "Joint('j', revolute, 'a' -> 'b', mimic='k')"
    )
    assert repr(hung("j", "a", "b", "fixed")) == "Joint('j', fixed, 'a' -> 'b')"


@pytest.mark.parametrize("count, more", [(2, ""), (5, ""), (6, " and 1 more"), (9, " and 4 more")])
def test_of_many_roots_five_are_named(count, more):
    roots = [f"l{k}" for k in range(count)]
    named = ", ".join(f"{root!r} (x.urdf:{k})" for k, root in enumerate(roots[:5]))
    with pytest.raises(ModelError) as caught:
        Robot("r", roots, [], Source("x.urdf", tuple(range(count))))
    assert says(
        caught.value,
        f"x.urdf:1: a robot has one root, but {count} links have no parent: {named}{more}",
    )


@pytest.mark.parametrize("largest, made", [(6, True), (5, False)])
def test_a_coupling_matrix_that_would_be_too_large_is_said_whole(largest, made, monkeypatch):
    monkeypatch.setattr(between, "LARGEST", largest)
    arm = robot(
        hung("i", "a", "b"), hung("j", "b", "c"), hung("k", "c", "d", mimic=Mimic("i", 2.0))
    )
    if made:
        assert arm.chain().coupling.tolist() == [[1, 0], [0, 1], [2, 0]]
        return
    with pytest.raises(InputError) as caught:
        arm.chain()
    assert says(
        caught.value,
        "robot 'r': the chain from 'a' to 'd' has joints that follow others, and its coupling matrix of 3 x 2 would be "
        "too large: at most 5 entries are made (Robot.fk needs none)",
    )


@pytest.mark.parametrize("count", [1, 2, 10, 11, 30])
def test_of_a_long_cycle_ten_links_are_named(count):
    links = [f"l{k}" for k in range(count)]
    joints = [hung(f"j{k}", links[k - 1], links[k]) for k in range(count)]
    around = [*links[1:], *links[:1]]
    named = " -> ".join(map(repr, around[:10])) + " -> ..." * (count > 10)
    with pytest.raises(ModelError) as caught:
        Robot("r", ["root", *links], joints, Source("x.urdf", (), tuple(range(count))))
    assert says(caught.value, f"x.urdf:0: the links form a cycle of {count} joint(s): {named}")


def test_the_longest_length_itself_is_taken():
    far = pose(((0, 3), 1e100))
    assert chain(home=far).home[0, 3] == 1e100
    assert chain([0, 0, 1, 1e100, 0, 0]).screws[0, 3] == 1e100
    assert chain([0, 0, 1, 0, 0, 1e100], pitches=[1e100]).pitches.tolist() == [1e100]
    assert hung("j", "a", "b", "helical", pitch=-1e100).pitch == -1e100


def test_a_joint_is_found_by_its_name_wherever_it_stands():
    arm = robot(hung("m", "a", "b"), hung("z", "b", "c"), hung("a", "c", "d"))
    assert [arm.joint(name).name for name in "zma"] == ["z", "m", "a"]


def test_compiled_arms_are_equal_that_do_the_same_in_the_same_way():
    plain, parallel = ARM.compile(), ARM.compile(parallel=True)
    again = pk.Chain.from_space(ARM.screws, ARM.home, joint_names=ARM.joint_names).compile()
    assert plain == again
    assert hash(plain) == hash(again)
    for one, other in (
        (plain, parallel),
        (parallel, plain),
        (plain, ALONE.compile()),
        (plain, ARM),
    ):
        assert one != other


@pytest.mark.parametrize(
    ("links", "joints", "words"),
    [
        ("base", [], "robot 'r': links must be a list, got 'base'"),
        (7, [], "robot 'r': links must be a list, got 7"),
        ({"base"}, [], "robot 'r': links must be a list, got {'base'}"),
        (["base"], ["pan"], "robot 'r': joints must be Joint objects, got 'pan'"),
    ],
)
def test_a_robot_s_parts_are_lists(links, joints, words):
    with pytest.raises(pk.errors.ModelError) as found:
        pk.Robot("r", links, joints)
    assert str(found.value).startswith(words)
