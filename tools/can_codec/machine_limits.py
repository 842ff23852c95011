"""Limits of the machine's joints, read from the model that the planners use. Exact decimals."""
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from decimal import Decimal


@dataclass
class Joint:
    name: str
    unit: str  # of its position
    continuous: bool
    lower: Decimal
    upper: Decimal
    rate: Decimal
    acceleration: Decimal


def load_joints(directory):
    """Name -> Joint of every actuated joint of DIRECTORY/NAME.{urdf,toml}."""
    side_car = tomllib.loads((directory / f"{directory.name}.toml").read_text(),
                             parse_float=Decimal)
    acceleration = {name: group["max_acceleration"]
                    for group in side_car["actuation"].values() for name in group["joints"]}
    joints = {}
    for element in ElementTree.parse(directory / f"{directory.name}.urdf").iter("joint"):
        name = element.get("name")
        if name not in acceleration:
            continue
        limit = element.find("limit")
        joints[name] = Joint(name, "m" if element.get("type") == "prismatic" else "rad",
                             element.get("type") == "continuous",
                             Decimal(limit.get("lower", "0")), Decimal(limit.get("upper", "0")),
                             Decimal(limit.get("velocity")), acceleration[name])
    return joints
