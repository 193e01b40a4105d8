"""URDF, MJCF and xacro documents out of nothing: most are nearly right, as only such get past the
first check.
"""

from __future__ import annotations

from .draw import Draw

INCLUDED = (
    ("other.xml", b'<mujoco><worldbody><body name="o"><joint name="oj"/><site name="os"/></body></worldbody></mujoco>'),
    ("other.xacro", b"""<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="m2" params="a">
<link name="${a}"/></xacro:macro><xacro:property name="y" value="0.5"/></robot>"""),
)  # fmt: skip
"""What a document may include."""

KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


def urdf(d: Draw) -> str:
    count, stem = d.size(), "l"
    if d.chance(d.odd / 20):  # many long names that are much alike
        count, stem = 500, d.pick(("x" * 190, "ab" * 90))
        d.odd /= count
    links = [d.text(f"{stem}{i}") for i in range(count)]
    different = d.pick((5, count)) if count > 100 else count
    names = [f"j{i % different}" for i in range(count)]
    following = d.pick((0.05, 0.05, 0.3, 0.8))
    parts = [f'<link name="{link}">{d.maybe(_body(d), 0.1)}</link>' for link in links]
    if count > 40:  # room for them all
        parts = [f'<link name="{link}"/>' for link in links]
    for i in range(1, count):
        parent = (
            links[d.below(i) if d.chance(0.3) else i - 1] if not d.chance(d.odd) else d.pick(links)
        )
        parts.append(_joint(d, names, parent, links[i], i, following))
    name = d.maybe(f' name="{d.text("r")}"', 0.9)
    space = d.maybe(' xmlns:xacro="http://www.ros.org/wiki/xacro"', d.odd)
    if space:
        parts.append(d.maybe('<xacro:m x="1"/>'))
    return (
        f"{_head(d)}<{d.word('robot')}{name}{space}>"
        + d.pick(("", "\n")).join(d.shuffled(parts))
        + "</robot>"
    )


def _head(d: Draw) -> str:
    if d.chance(d.odd):
        return d.pick(
            ('<!DOCTYPE robot [<!ENTITY x "y">]>', '<!DOCTYPE robot SYSTEM "/dev/zero">', "\ufeff", "<!-- x -->",
             '<?xml version="1.1"?>', '<?xml version="1.0" encoding="UTF-16"?>', '<?xml encoding="x"?>', "\n",
             '<?xml version="1.0" encoding="utf-7"?>', '<?xml version="1.0" encoding="EBCDIC-CP-US"?>')
        )  # fmt: skip
    return d.maybe('<?xml version="1.0"?>', 0.3)


def _joint(d: Draw, names: list[str], parent: str, child: str, i: int, following: float) -> str:
    inside = [f'<parent link="{d.text(parent)}"/>', f'<child link="{d.text(child)}"/>']
    if len(names) > 40 and not d.chance(d.odd):
        return f'<joint name="{names[i]}" type="{d.pick(KINDS[:4])}">{"".join(inside)}</joint>'
    if d.chance(0.7):
        xyz, rpy = d.maybe(f' xyz="{d.numbers(3)}"', 0.8), d.maybe(f' rpy="{d.numbers(3)}"', 0.7)
        inside.append(f"<origin{xyz}{rpy}/>")
    if d.chance(0.7):
        inside.append(f'<axis xyz="{d.axis()}"/>')
    if d.chance(0.7):
        lower, upper = (
            d.odd_number() if d.chance(3 * d.odd) else d.pick(usual)
            for usual in (("-2.5", "-2.5", "-1e5", "-inf", "0"), ("2.5", "2.5", "1e16", "inf", "0"))
        )
        bounds = d.maybe(f' lower="{lower}"', 0.9) + d.maybe(f' upper="{upper}"', 0.9)
        inside.append(f'<limit{bounds} effort="1"/>')
    if d.chance(following):
        numbers = d.maybe(f' multiplier="{d.number()}"') + d.maybe(f' offset="{d.number()}"')
        master = (
            d.pick([*names[:i], *names[i + 1 :]])
            if not d.chance(d.odd)
            else d.word(names[i], "gone")
        )
        inside.append(f'<mimic joint="{d.text(master)}"{numbers}/>')
    if d.chance(d.odd):
        inside.append(d.pick(inside))
    kind = KINDS[d.below(4)] if d.chance(0.95) else d.word(*KINDS)
    return f'<joint name="{d.text(names[i])}" type="{d.text(kind)}">{"".join(d.shuffled(inside))}</joint>'


def _body(d: Draw) -> str:
    mesh = '<visual><geometry><mesh filename="package://x/y.stl"/></geometry></visual>'
    return mesh + f'<inertial><mass value="{d.number()}"/><origin xyz="{d.numbers(3)}"/></inertial>'


def mjcf(d: Draw) -> str:
    angle = d.maybe(
        f'<compiler angle="{d.word("radian", "degree")}" eulerseq="{d.word("xyz", "ZYX")}"/>', 0.5
    )
    defaults = (
        '<default><joint axis="0 1 0"/><default class="c"><joint type="slide"/></default></default>'
    )
    joints = ["gone"] if d.chance(d.odd) else []
    bodies = "".join(_mjcf_body(d, f"b{i}", 0, joints) for i in range(d.size(2)))
    extra = (
        "".join(d.pick(EXTRAS).replace("@", d.number()) for _ in range(d.below(3)))
        if d.chance(0.4)
        else ""
    )
    equality = (
        "".join(_equality(d, joints) for _ in range(d.below(5))) if joints and d.chance(0.3) else ""
    )
    world = f"<worldbody>{bodies}</worldbody>"
    return f"{_head(d)}<mujoco>{angle}{d.maybe(defaults, 0.4)}{''.join(d.shuffled([world, equality, extra]))}</mujoco>"


def _equality(d: Draw, joints: list[str]) -> str:
    """Of joints that there are; mostly linear, as others are left out, and now and then of one
    joint alone.
    """
    ends = f'joint1="{d.pick(joints)}"' + d.maybe(f' joint2="{d.pick(joints)}"', 0.8)
    rest = "0 0 0" if d.chance(0.8) else d.numbers(3)
    kind = d.word("joint") if d.chance(0.9) else 'weld body1="b0" body2="world"'
    if kind.startswith("weld"):
        return f"<equality><{kind}/></equality>"
    off = d.maybe(' active="false"', 0.1)
    return f'<equality><{kind} {ends} polycoef="{d.numbers(2)} {rest}"{off}/></equality>'


EXTRAS = (
    '<include file="other.xml"/>', '<worldbody><include file="other.xml"/></worldbody>',
    '<asset><model name="x" file="other.xml"/></asset><worldbody><attach model="x" body="o" prefix="p"/></worldbody>',
    '<asset><model name="y" file="other.xml"/></asset><worldbody><frame euler="@ 0 0"><attach model="y" prefix="@"/>'
    '</frame></worldbody>',
    '<include file="/dev/zero"/>', '<include file="input.xml"/>', '<include file="."/>', '<option timestep="@"/>',
    '<size memory="@"/>', '<size njmax="@" nconmax="@"/>', '<size nuser_body="@"/>', '<size nkey="@"/>',
    '<asset><mesh name="m" file="x.stl"/></asset>', '<asset><mesh name="m" vertex="0 0 0 @"/></asset>',
    '<asset><hfield name="h" nrow="@" ncol="@" size="1 1 1 1"/></asset>',
    '<asset><texture name="t" type="2d" builtin="checker" width="@" height="@"/></asset>',
    '<asset><model name="x" file="input.xml"/></asset>', '<custom><numeric name="n" size="@" data="1"/></custom>',
    '<worldbody><replicate count="@" offset="0 0 @"><body><joint/><geom size=".1"/></body></replicate></worldbody>',
    '<worldbody><replicate count="@"><replicate count="@"><site name="s"/></replicate></replicate></worldbody>',
    '<worldbody><composite type="cable" count="@ 1 1" size="1"><geom size=".1"/></composite></worldbody>',
    '<worldbody><flexcomp name="f" type="grid" count="@ @ @" spacing=".1 .1 .1"/></worldbody>',
    '<worldbody><flexcomp name="f" type="grid" dim="2" count="3 3 1" spacing=".1 .1 .1" mass="@"/></worldbody>',
    '<worldbody><attach model="x" body="b" prefix="p"/></worldbody>', '<visual><map znear="@"/></visual>',
    '<worldbody><body mocap="true" name="m"/></worldbody>',
    '<worldbody><frame euler="@ 0 0"><site/></frame></worldbody>',
    '<worldbody><body><plugin plugin="mujoco.elasticity.cable"/></body></worldbody>',
    "<worldbody><body><plugin/></body><body><geom><plugin/></geom></body></worldbody>",
    '<extension><plugin plugin="x"/></extension>', '<statistic extent="@"/>', '<keyframe><key qpos="@ @"/></keyframe>',
    '<actuator><motor joint="b0j" gear="@"/></actuator>',
    '<tendon><fixed><joint joint="b0j" coef="@"/></fixed></tendon>',
    '<sensor><jointpos joint="b0j"/></sensor>', '<contact><exclude body1="b0" body2="b1"/></contact>',
    '<deformable><skin name="s" vertex="0 0 0" texcoord="@ 0" face="@ 0 0"/></deformable>',
)  # fmt: skip


def _mjcf_body(d: Draw, name: str, depth: int, joints: list[str]) -> str:
    place = d.maybe(f' pos="{d.numbers(3)}"', 0.7)
    place += d.pick(
        (
            "",
            f' euler="{d.numbers(3)}"',
            f' quat="{d.numbers(4)}"',
            f' axisangle="{d.axis()} {d.number()}"',
        )
    )
    place += d.maybe(' euler="0 0 1"', d.odd) + d.maybe(
        ' mocap="true"', 0.02 if depth == 0 else d.odd
    )
    inside = ""
    for i in range(d.pick((0, 1, 1, 1, 2)) if "mocap" not in place else 0):
        kind = d.word(
            "hinge",
            "hinge",
            "slide",
            "ball" if not i else "hinge",
            "free" if depth == i == 0 else "hinge",
        )
        joint = d.maybe(d.text(f"{name}j{i or ''}"), 0.9)
        inside += (
            f'<joint name="{joint}" type="{kind}" axis="{d.axis()}"'
            if joint
            else f'<joint type="{kind}"'
        )
        if kind in ("hinge", "slide"):
            joints += [joint] if joint else []
            inside += d.maybe(
                ' range="-1 0.5"' if not d.chance(d.odd) else f' range="{d.numbers(2)}"', 0.2
            )
        inside += d.maybe(f' ref="{d.number()}"', 0.2) + d.maybe(' class="c"', d.odd)
        inside += d.maybe(f' pos="{d.numbers(3)}"', 0.3) + "/>"
        if kind == "free":
            break
    inside += d.maybe('<geom type="capsule" fromto="0 0 0 0 0 1" size="0.1"/>', 0.2)
    inside += d.maybe(f'<site name="{d.text(name + "s")}" pos="{d.numbers(3)}"/>', 0.2)
    if depth < 3:
        inside += "".join(_mjcf_body(d, f"{name}{i}", depth + 1, joints) for i in range(d.below(3)))
    frame = d.chance(0.1) and "mocap" not in place
    called = d.maybe(f' name="{d.text(name)}"', 0.9)
    body = f"<body{called}{place}>{inside}</body>"
    return f'<frame pos="{d.numbers(3)}">{body}</frame>' if frame else body


def xacro(d: Draw) -> str:
    """Evaluated, a file does what a program can, and as slowly: these have no arithmetic that takes
    for ever, and no file that includes itself."""
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    parts = [
        f'<xacro:property name="{d.text("x")}" value="{d.number()}"/>',
        f'<xacro:arg name="{d.text("n")}" default="{d.number()}"/>',
        '<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        f'<origin xyz="{d.word("${x}", "${pi}", "$(arg n)", "$(eval 1)")} 0 0"/></joint>',
    ]
    if d.chance(0.2):
        block = d.pick(
            (
                '<xacro:insert_block name="c"/>',
                "<link name='${a}'/>",
                '<xacro:m a="z"><origin/></xacro:m>',
            )
        )
        parts += [
            f'<xacro:macro name="{d.text("m")}" params="a b:={d.number()} *c"><a b="${{b}}"/>{block}</xacro:macro>',
            f'<xacro:m a="{d.text("a")}"><origin/></xacro:m>',
        ]
    if d.chance(0.2):
        tag, said = d.pick(("if", "unless")), d.word("true", "${x}", "0", "${x > 1}")
        parts.append(f'<xacro:{tag} value="{said}"><a/></xacro:{tag}>')
    if d.chance(0.2):
        file = d.word("other.xacro", "other.xacro", "other.xacro", "gone.xacro", "/")
        parts.append(f'<xacro:include filename="{file}"/>')
        parts.append(
            d.maybe(
                f'<xacro:m2 a="a"/><xacro:property name="z" value="{d.word("${y}", "${z}", "${1/0}")}"/>'
            )
        )
    if d.chance(d.odd):
        parts.append(f'<link name="{d.text("a")}"/>')
    return f'{_head(d)}<robot name="r" {space}>{"".join(d.shuffled(parts) if d.chance(d.odd) else parts)}</robot>'
