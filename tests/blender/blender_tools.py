"""What several Blender tests need: recordings made by formulas, and world poses as Blender evaluates them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from tests.synthetic_motion import synthetic_motion


def make_recording(core: Any, duration: float = 1.0, **changes: Any) -> SimpleNamespace:
    """A synthetic recording made with the extension's own modules; `changes` are dotted keys of the run document."""
    spec = core("spec").RunSpec().with_overrides(changes)
    return synthetic_motion(core("body").build_skeleton(spec.skier), spec, duration=duration)


def skeleton_of(core: Any, recording: SimpleNamespace) -> Any:
    """The skeleton of a recording's skier."""
    return core("body").build_skeleton(core("blender.bake").recorded_skier(recording))


def body_matrices(core: Any, recording: SimpleNamespace, time: float) -> dict[str, np.ndarray]:
    """The world matrix of every body at `time` [s], by forward kinematics."""
    skeleton = skeleton_of(core, recording)
    poses = core("animation.poses").body_poses_at(recording, skeleton, np.array([time]))
    return dict(zip(poses.body_names, poses.matrices()[0], strict=True))


def bone_matrices(core: Any, armature: Any, recording: SimpleNamespace) -> dict[str, np.ndarray]:
    """The world matrix that each body has if it goes with its bone, evaluated by Blender at the current frame."""
    import bpy

    bake = core("blender.bake")
    bone_map = core("animation.bone_map").BoneMap.load(bake.BONE_MAP)
    rest = core("blender.rig").rest_pose(armature, bone_map, skeleton_of(core, recording))
    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    world = np.array(evaluated.matrix_world)
    found = {}
    for entry in bone_map.entries:
        bone = np.array(evaluated.pose.bones[entry.bone].matrix)
        rest_bone = rest.bone_matrix[rest.bones.index(entry.bone)]
        found[entry.body] = world @ bone @ np.linalg.inv(rest_bone) @ rest.body_matrix[entry.body]
    return found


def curves(action: Any) -> dict[tuple[str, int], Any]:
    """All curves of an action's first channelbag by path and index."""
    bag = action.layers[0].strips[0].channelbags[0]
    return {(curve.data_path, curve.array_index): curve for curve in bag.fcurves}


def keys(curve: Any) -> np.ndarray:
    """The keys (n, 2) of a curve."""
    values = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
    curve.keyframe_points.foreach_get("co", values)
    return values.reshape(-1, 2)


class Event:
    """What a modal operator looks at."""

    def __init__(self, kind: str, value: str = "NOTHING") -> None:
        self.type, self.value = kind, value


class WindowManager:
    """Stands for the window manager of a Blender with a window; `open` is what has not been taken away yet."""

    def __init__(self) -> None:
        self.windows: list[Any] = []
        self.open: list[str] = []

    def event_timer_add(self, _step: float, window: object) -> str:
        self.open.append("timer")
        return "timer"

    def event_timer_remove(self, timer: str) -> None:
        self.open.remove(timer)

    def progress_begin(self, _low: int, _high: int) -> None:
        self.open.append("progress")

    def progress_update(self, _value: int) -> None:
        pass

    def progress_end(self) -> None:
        self.open.remove("progress")


class Context:
    """Stands for the context of a Blender with a window."""

    window = None
    workspace: Any = None

    def __init__(self, scene: Any = None) -> None:
        self.scene = scene
        self.window_manager = WindowManager()
