"""URDF, MJCF and xacro documents out of nothing: most are nearly right, as only such get past the first check."""

from __future__ import annotations

from .draw import Draw

KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")


def urdf(d: Draw) -> str:
    count, stem = d.size(), "l"
    if d.chance(d.odd / 20):  # many long names that are much alike
        count, stem = 500, d.pick(("x" * 190, "ab" * 90))
    links = [d.text(f"{stem}{i}") for i in range(count)]
    parts = [f'<link name="{link}">{d.maybe(_body(d), 0.1)}</link>' for link in links]
    for i in range(1, count):
        parent = links[d.below(i) if d.chance(0.3) else i - 1] if not d.chance(d.odd) else d.pick(links)
        parts.append(_joint(d, f"j{i}", parent, links[i], i))
    name = d.maybe(f' name="{d.text("r")}"', 0.9)
    space = d.maybe(' xmlns:xacro="http://www.ros.org/wiki/xacro"', d.odd)
    return f"{_head(d)}<{d.word('robot')}{name}{space}>" + d.pick(("", "\n")).join(d.shuffled(parts)) + "</robot>"


def _head(d: Draw) -> str:
    if d.chance(d.odd):
        return d.pick(
            ('<!DOCTYPE robot [<!ENTITY x "y">]>', '<!DOCTYPE robot SYSTEM "/dev/zero">', "\ufeff", "<!-- x -->",
             '<?xml version="1.1"?>', '<?xml version="1.0" encoding="UTF-16"?>', '<?xml encoding="x"?>', "\n",
             '<?xml version="1.0" encoding="utf-7"?>', '<?xml version="1.0" encoding="EBCDIC-CP-US"?>')
        )  # fmt: skip
    return d.maybe('<?xml version="1.0"?>', 0.3)


def _joint(d: Draw, name: str, parent: str, child: str, i: int) -> str:
    inside = [f'<parent link="{d.text(parent)}"/>', f'<child link="{d.text(child)}"/>']
    if d.chance(0.7):
        xyz, rpy = d.maybe(f' xyz="{d.numbers(3)}"', 0.8), d.maybe(f' rpy="{d.numbers(3)}"', 0.7)
        inside.append(f"<origin{xyz}{rpy}/>")
    if d.chance(0.7):
        inside.append(f'<axis xyz="{d.axis()}"/>')
    if d.chance(0.7):
        lower, upper = ("-2.5", "2.5") if not d.chance(d.odd) else (d.number(), d.number())
        inside.append(f'<limit{d.maybe(f" lower={lower!r}", 0.9)}{d.maybe(f" upper={upper!r}", 0.9)} effort="1"/>')
    if d.chance(0.15):
        numbers = d.maybe(f' multiplier="{d.number()}"') + d.maybe(f' offset="{d.number()}"')
        inside.append(f'<mimic joint="{d.text(f"j{d.below(i + 2)}")}"{numbers}/>')
    if d.chance(d.odd):
        inside.append(d.pick(inside))
    kind = KINDS[d.below(4)] if d.chance(0.95) else d.word(*KINDS)
    return f'<joint name="{d.text(name)}" type="{d.text(kind)}">{"".join(d.shuffled(inside))}</joint>'


def _body(d: Draw) -> str:
    mesh = '<visual><geometry><mesh filename="package://x/y.stl"/></geometry></visual>'
    return mesh + f'<inertial><mass value="{d.number()}"/><origin xyz="{d.numbers(3)}"/></inertial>'


def mjcf(d: Draw) -> str:
    angle = d.maybe(f'<compiler angle="{d.word("radian", "degree")}" eulerseq="{d.word("xyz", "ZYX")}"/>', 0.5)
    defaults = '<default><joint axis="0 1 0"/><default class="c"><joint type="slide"/></default></default>'
    bodies = "".join(_mjcf_body(d, f"b{i}", 0) for i in range(d.size(2)))
    extra = "".join(d.pick(EXTRAS).replace("@", d.number()) for _ in range(d.below(3))) if d.chance(0.4) else ""
    equality = d.maybe(
        f'<equality><{d.word("joint", "joint", "weld", "connect")} joint1="b0j" joint2="{d.word("b00j", "b1j")}"'
        f' polycoef="{d.numbers(5)}"/></equality>',
        0.15,
    )
    world = f"<worldbody>{bodies}</worldbody>"
    return f"{_head(d)}<mujoco>{angle}{d.maybe(defaults, 0.4)}{''.join(d.shuffled([world, equality, extra]))}</mujoco>"


EXTRAS = (
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


def _mjcf_body(d: Draw, name: str, depth: int) -> str:
    place = d.maybe(f' pos="{d.numbers(3)}"', 0.7) + d.maybe(f' euler="{d.numbers(3)}"', 0.3)
    place += d.maybe(f' quat="{d.numbers(4)}"', 0.2)
    inside = ""
    if d.chance(0.75):
        kind = d.word("hinge", "hinge", "slide", "ball", "free" if depth == 0 else "hinge")
        inside += f'<joint name="{d.text(name + "j")}" type="{kind}" axis="{d.axis()}"'
        inside += d.maybe(f' range="{d.numbers(2)}"', 0.2) + d.maybe(f' ref="{d.number()}"', 0.2)
        inside += d.maybe(' class="c"', d.odd) + d.maybe(f' pos="{d.numbers(3)}"', 0.3) + "/>"
    inside += d.maybe('<geom type="capsule" fromto="0 0 0 0 0 1" size="0.1"/>', 0.2)
    inside += d.maybe(f'<site name="{d.text(name + "s")}" pos="{d.numbers(3)}"/>', 0.2)
    if depth < 3:
        inside += "".join(_mjcf_body(d, f"{name}{i}", depth + 1) for i in range(d.below(3)))
    frame = d.chance(0.1)
    body = f'<body name="{d.text(name)}"{place}>{inside}</body>'
    return f'<frame pos="{d.numbers(3)}">{body}</frame>' if frame else body


def xacro(d: Draw) -> str:
    """Evaluated, a file does what a program can, and as slowly: these have no arithmetic that takes for ever, and no
    file that includes itself."""
    space = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    parts = [
        f'<xacro:property name="{d.text("x")}" value="{d.number()}"/>',
        f'<xacro:arg name="{d.text("n")}" default="{d.number()}"/>',
        f'<xacro:macro name="{d.text("m")}" params="a b:={d.number()} *c"><link name="${{a}}"/></xacro:macro>',
        f'<xacro:m a="{d.text("l")}"><origin/></xacro:m>',
        f'<xacro:if value="{d.word("true", "${x}", "$(arg n)")}"><link name="i"/></xacro:if>',
        f'<xacro:include filename="{d.word("gone.xacro", "/", "@")}"/>',
        f'<link name="{d.text("a")}"/>',
        '<link name="a"/><link name="b"/><joint name="j" type="continuous"><parent link="a"/><child link="b"/>'
        f'<origin xyz="{d.word("${x}", "${pi}", "$(arg n)", "$(eval 1)")} 0 0"/></joint>',
    ]
    keep = [part for part in parts[:-1] if d.chance(0.2)]
    return f'{_head(d)}<robot name="r" {space}>{"".join(d.shuffled([*keep, *parts[:2], parts[-1]]))}</robot>'
