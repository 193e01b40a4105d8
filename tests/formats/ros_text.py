"""Text as the tools of ROS print it of a string: PyYAML by the options that they give it.

Source: rosidl_runtime_py/convert.py (message_to_yaml: yaml.dump with width=sys.maxsize and
allow_unicode), ros2topic/verb/echo.py (a line --- after each message, strings cut to 128 characters
and ...), ros2param/verb/get.py and dump.py, rosparam (yaml.dump of the text, without the `...` behind it).
"""

from __future__ import annotations

import sys

import yaml

KEPT = 128


def dumped(data: object, *, unicode: bool = True) -> str:
    """YAML in the style of ROS 2."""
    return yaml.dump(data, allow_unicode=unicode, width=sys.maxsize, default_flow_style=False)


def echo(text: str, *, unicode: bool = True) -> str:
    """`ros2 topic echo --full-length /robot_description`, one message."""
    return dumped({"data": text}, unicode=unicode) + "---\n"


def echo_cut(text: str, length: int = KEPT) -> str:
    """`ros2 topic echo /robot_description`, which cuts what is longer."""
    if len(text) > length:
        text = text[:length] + "..."
    return echo(text)


def echo_field(text: str) -> str:
    """`ros2 topic echo --full-length --field data /robot_description`."""
    return text + "\n---\n"


def param_get(text: str) -> str:
    """`ros2 param get /robot_state_publisher robot_description`."""
    return f"String value is: {text}\n"


def param_dump(text: str) -> str:
    """`ros2 param dump /robot_state_publisher`, with parameters that the node has besides."""
    parameters = {
        "frame_prefix": "",
        "ignore_timestamp": False,
        "publish_frequency": 20.0,
        "qos_overrides": {"/tf": {"publisher": {"depth": 100, "history": "keep_last"}}},
        "robot_description": text,
        "some_list": ["a", 1],
        "use_sim_time": False,
    }
    return dumped({"/robot_state_publisher": {"ros__parameters": parameters}})


def rosparam_get(text: str) -> str:
    """`rosparam get /robot_description` of ROS 1."""
    return yaml.dump(text, default_flow_style=False).removesuffix("...\n")


PRINTED = {
    "topic echo": echo,
    "topic echo, old": lambda text: echo(text, unicode=False),
    "topic echo, two messages": lambda text: echo(text) * 2,
    "topic echo, a mark first": lambda text: "---\n" + echo(text),
    "topic echo --field data": echo_field,
    "param get": param_get,
    "param get --hide-type": lambda text: text + "\n",
    "param dump": param_dump,
    "rosparam get": rosparam_get,
}
"""Everything that prints a description, by its command."""
