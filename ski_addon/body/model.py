"""The skier as a MuJoCo model, built in code, with one table of addresses, joint ranges and torque limits."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from ..gravity import GRAVITY
from ..spec import SkierSpec
from .limits import REFERENCE_MASS_TIMES_HEIGHT, hinge_limit
from .skeleton import SIDES, Skeleton, build_skeleton

if TYPE_CHECKING:
    import mujoco


@dataclass(frozen=True)
class SkierModel:
    """MuJoCo model and its addresses; index arrays are read-only.

    `mujoco` has no contacts and no constraints: snow forces and muscle torques are applied as generalised forces.
    `actuated_dof` (31,) and `actuated_qpos` (31,) address the driven hinges, `pole_dof` (4,) the passive ones;
    `body_dof` (37,) is root and driven hinges. `joint_lower`, `joint_upper` [rad] and `torque_lower`, `torque_upper`
    [N m] are (31,). `ski_body` (2,) are MuJoCo body numbers, left first; `leg_dof` (2, 6) each leg's hinges.
    """

    skeleton: Skeleton
    mujoco: mujoco.MjModel
    xml: str
    mass: float
    actuated_dof: np.ndarray
    actuated_qpos: np.ndarray
    pole_dof: np.ndarray
    body_dof: np.ndarray
    joint_lower: np.ndarray
    joint_upper: np.ndarray
    torque_lower: np.ndarray
    torque_upper: np.ndarray
    ski_body: np.ndarray
    leg_dof: np.ndarray

    @property
    def model_hash(self) -> str:
        """Hash of everything that decides the model's dynamics, 16 hex digits."""
        return hashlib.sha256(self.xml.encode()).hexdigest()[:16]

    def new_data(self) -> Any:
        """Return a fresh `mujoco.MjData` of this model."""
        import mujoco

        return mujoco.MjData(self.mujoco)


@lru_cache(maxsize=16)
def build_skier_model(skier: SkierSpec) -> SkierModel:
    """Build the MuJoCo model of a person with boots, skis and poles.

    The same skier always has the same one: runs keep their states in `mujoco.MjData` and never change the model.
    """
    import mujoco

    skeleton = build_skeleton(skier)
    xml = skier_mjcf(skeleton, skier)
    model = mujoco.MjModel.from_xml_string(xml)
    names = np.array(skeleton.joint_names)[skeleton.actuated]
    limits = [hinge_limit(str(name)) for name in names]
    strength = skier.strength * skier.mass * skier.height / REFERENCE_MASS_TIMES_HEIGHT
    is_pole = np.array([name.startswith("pole") for name in skeleton.joint_names])
    arrays = {
        "actuated_dof": skeleton.joint_dof[skeleton.actuated],
        "actuated_qpos": skeleton.joint_qpos[skeleton.actuated],
        "pole_dof": skeleton.joint_dof[is_pole],
        "body_dof": np.concatenate((np.arange(6), skeleton.joint_dof[skeleton.actuated])),
        "joint_lower": np.deg2rad([limit.lower for limit in limits]),
        "joint_upper": np.deg2rad([limit.upper for limit in limits]),
        "torque_lower": -strength * np.array([limit.negative for limit in limits]),
        "torque_upper": strength * np.array([limit.positive for limit in limits]),
        "ski_body": np.array([skeleton.body(f"ski.{side}") + 1 for side in SIDES]),
        "leg_dof": np.array([_leg_dof(skeleton, side) for side in SIDES]),
    }
    for value in arrays.values():
        value.setflags(write=False)
    return SkierModel(skeleton=skeleton, mujoco=model, xml=xml, mass=float(skeleton.mass.sum()), **arrays)


def _leg_dof(skeleton: Skeleton, side: str) -> list[int]:
    names = (f"{hinge}.{side}" for hinge in ("thigh_y", "thigh_x", "thigh_z", "shank_y", "foot_y", "foot_x"))
    return [int(skeleton.joint_dof[skeleton.joint_names.index(name)]) for name in names]


def skier_mjcf(skeleton: Skeleton, skier: SkierSpec) -> str:
    """Return the MJCF text of the skier: bodies, hinges, inertias; pole hinges with spring and damper."""
    root = ElementTree.Element("mujoco", model="skier")
    ElementTree.SubElement(root, "compiler", angle="radian", autolimits="false", inertiafromgeom="false")
    option = ElementTree.SubElement(root, "option", gravity=_text(GRAVITY), integrator="Euler", timestep="0.001")
    ElementTree.SubElement(option, "flag", contact="disable", constraint="disable", eulerdamp="disable")
    elements = [ElementTree.SubElement(root, "worldbody")]
    for index, name in enumerate(skeleton.body_names):
        parent = elements[skeleton.parent[index] + 1]
        element = ElementTree.SubElement(
            parent, "body", name=name, pos=_text(skeleton.offset[index]), quat=_text(skeleton.rotation[index])
        )
        elements.append(element)
        if index == 0:
            ElementTree.SubElement(element, "freejoint", name="root")
        for joint in np.flatnonzero(skeleton.joint_body == index):
            _add_hinge(element, skeleton, int(joint), skier)
        ElementTree.SubElement(
            element,
            "inertial",
            pos=_text(skeleton.com[index]),
            mass=repr(float(skeleton.mass[index])),
            diaginertia=_text(skeleton.inertia[index]),
        )
    return ElementTree.tostring(root, encoding="unicode")


def _add_hinge(element: ElementTree.Element, skeleton: Skeleton, joint: int, skier: SkierSpec) -> None:
    name = skeleton.joint_names[joint]
    passive = name.startswith("pole")
    ElementTree.SubElement(
        element,
        "joint",
        name=name,
        type="hinge",
        axis=_text(skeleton.joint_axis[joint]),
        stiffness=repr(float(skier.pole_stiffness if passive else 0.0)),
        damping=repr(float(skier.pole_damping if passive else 0.0)),
    )


def _text(values: np.ndarray) -> str:
    return " ".join(repr(float(value)) for value in values)
