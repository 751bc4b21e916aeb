"""A vehicle as URDF: links with inertia and shapes, joints, and the frames of its sensors."""

from xml.etree import ElementTree

import numpy as np
from scipy.spatial.transform import Rotation

from ..rui.table import Body
from ..vehicle.body_tree import build_body_table
from .bodies import body_parts
from .frames import body_joints, frame_name, sensor_joints
from .shapes import Box, Cylinder, extents

_UNLIMITED = {"effort": "0", "velocity": "0", "lower": "-1", "upper": "1"}  # URDF asks for limits of a slide
_SEE_THROUGH = 0.35
# a cylinder of URDF has its axis along z
_AXIS_TO_Y = Rotation.from_euler("x", 90.0, degrees=True)


def urdf(vehicle, system):
    """Return the URDF text of a vehicle (`parameters.Vehicle`), given a `System` of it.

    Flat faces of teeth are those of the cuboids around them: URDF knows boxes, cylinders and spheres only.
    """
    robot = ElementTree.Element("robot", name=vehicle.name)
    parts = body_parts(vehicle, system)
    for body in build_body_table(vehicle):
        _link(robot, frame_name(body.name), body, parts[body.name])
    for joint in (*body_joints(vehicle), *sensor_joints(vehicle)):
        if joint.child not in {frame_name(name) for name in parts}:
            _link(robot, joint.child)
        _joint(robot, joint)
    ElementTree.indent(robot)
    return ElementTree.tostring(robot, encoding="unicode", xml_declaration=False) + "\n"


def _link(robot, name, body: Body = None, parts=()):
    link = ElementTree.SubElement(robot, "link", name=name)
    if body is not None:
        inertial = ElementTree.SubElement(link, "inertial")
        ElementTree.SubElement(inertial, "origin", xyz=_words(body.centre), rpy="0 0 0")
        ElementTree.SubElement(inertial, "mass", value=_words([body.mass]))
        i = body.inertia
        names = {"ixx": i[0][0], "ixy": i[0][1], "ixz": i[0][2], "iyy": i[1][1], "iyz": i[1][2], "izz": i[2][2]}
        ElementTree.SubElement(inertial, "inertia", {key: _words([value]) for key, value in names.items()})
    for number, part in enumerate(parts):
        _visual(link, f"{name}_{number}", part)


def _visual(link, name, part):
    visual = ElementTree.SubElement(link, "visual", name=name)
    shape, place, turn = part.shape, part.place, Rotation.from_matrix(part.turn)
    if isinstance(shape, Cylinder):
        turn, kind = (
            turn * _AXIS_TO_Y,
            ("cylinder", {"radius": _words([shape.radius]), "length": _words([shape.width])}),
        )
    else:
        sides, middle = (shape.sides, (0.0, 0.0, 0.0)) if isinstance(shape, Box) else extents(shape)
        place, kind = turn.apply(middle) + place, ("box", {"size": _words(sides)})
    ElementTree.SubElement(visual, "origin", xyz=_words(place), rpy=_words(_angles(turn)))
    ElementTree.SubElement(ElementTree.SubElement(visual, "geometry"), *kind)
    colour = "_".join(map(str, part.colour)) + ("_clear" if part.see_through else "")
    material = ElementTree.SubElement(visual, "material", name=colour)
    opacity = _SEE_THROUGH if part.see_through else 1.0
    ElementTree.SubElement(material, "color", rgba=_words([*(value / 255 for value in part.colour), opacity]))


def _joint(robot, joint):
    element = ElementTree.SubElement(robot, "joint", name=joint.name, type=joint.kind)
    angles = _angles(Rotation.from_quat(joint.attitude))
    ElementTree.SubElement(element, "origin", xyz=_words(joint.place), rpy=_words(angles))
    ElementTree.SubElement(element, "parent", link=joint.parent)
    ElementTree.SubElement(element, "child", link=joint.child)
    if joint.moves:
        ElementTree.SubElement(element, "axis", xyz=_words(joint.axis))
    if joint.kind == "prismatic":
        ElementTree.SubElement(element, "limit", _UNLIMITED)


def _angles(turn):
    """Roll, pitch and yaw, applied in this order about fixed axes [rad]."""
    m = turn.as_matrix()
    pitch = np.arctan2(-m[2, 0], np.hypot(m[0, 0], m[1, 0]))
    if abs(m[2, 0]) > 1.0 - 1e-12:  # upright: yaw turns about the same axis as roll
        return np.arctan2(-m[1, 2], m[1, 1]), pitch, 0.0
    return np.arctan2(m[2, 1], m[2, 2]), pitch, np.arctan2(m[1, 0], m[0, 0])


def _words(numbers):
    return " ".join(f"{float(number) + 0.0:.9g}" for number in numbers)
